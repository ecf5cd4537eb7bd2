"""
Strapdown navigation: mechanization, the strapdown object, errors, alignment.

Start with ``mechanization`` (the equations of one interval) and ``strapdown`` (the object that
keeps
the state). Nothing here knows how the readings were made.
"""
