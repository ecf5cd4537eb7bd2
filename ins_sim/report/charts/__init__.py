"""
Figures as data, and what draws them.

``chart`` says what is drawn, ``palette`` in which colours, ``scales`` in which units. The same
chart is drawn as PNG and in the page of a report.
"""
