"""
Strapdown navigation: mechanization, the strapdown object, its navigators, errors, alignment.

Start with ``mechanization`` (the equations of one interval) and ``strapdown`` (the object that
keeps the state). ``navigator`` feeds it the readings of a simulated IMU, ``recorded`` those of a
recorded one; ``loop`` steps a navigator through samples, ``live`` through two live streams.
Nothing in this package depends on how the readings were made.
"""
