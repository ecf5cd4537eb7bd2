"""
Aided navigation: a strapdown corrected by fixes of a velocity meter and of GNSS.

Start with ``navigator``; ``filters`` holds the filters, ``filters.base`` their interface.
"""
