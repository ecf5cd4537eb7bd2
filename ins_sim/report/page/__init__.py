"""
The report of a run or a study as a page: ``content`` says what is in it, ``html`` writes it.
"""
