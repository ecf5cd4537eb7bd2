"""
Strapdown navigation: mechanization, the strapdown object, its navigators, errors, alignment.

Start with ``mechanization`` (the equations of one interval) and ``strapdown`` (the object that
keeps the state). ``navigator`` and ``recorded`` give it the readings of a simulated and of a
recorded IMU; ``loop`` steps a navigator through samples, ``live`` through two streams. Nothing
here knows how the readings were made.
"""
