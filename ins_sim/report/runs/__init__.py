"""
The report of one run: figures as Charts, its track as KML, and its page.
"""
