"""
Report of one run: figures as Charts, the track as KML, and the page.
"""
