"""Units of data sheets, expressed in SI units."""

import math

STANDARD_GRAVITY = 9.80665
DEG = math.pi / 180.0
DEG_H = DEG / 3600.0
UG = 1e-6 * STANDARD_GRAVITY
SQRT_H = 60.0
DEG_PER_HOUR = math.degrees(3600.0)
