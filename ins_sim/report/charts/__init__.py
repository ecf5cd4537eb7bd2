"""
Charts as data, and the code that draws them.

``chart`` describes the content of a figure, ``palette`` the colours, ``scales`` the units. The
same chart is drawn as PNG and in the page of a report.
"""
