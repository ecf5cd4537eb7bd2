"""
HTML page with the report of a run or a study: ``content`` describes it, ``html`` writes it.
"""
