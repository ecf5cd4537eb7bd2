"""
Elementary functions with the same bits on every machine.

They use only + - * / and square roots, whose results IEEE 754 fixes to the last bit. The sine of a
C library or of NumPy, in contrast, may differ between processors. Every function takes a float or
an array and does the same operations on both; in compiled loops it takes floats. Apart from
shortcuts for single floats there are no branches: a choice is a product with a comparison, so that
the compiler can vectorise it.

Errors are below 1.5 units in the last place (ulp) unless a function states more (test_elementary
compares with mpmath). Coefficients: Sun Microsystems fdlibm 5.3 (sin, cos, exp, log) and
S. Moshier, Cephes 2.8 (atan).
"""

import math

import numpy as np

# x + ROUND - ROUND is x rounded to an integer, ties to even, for |x| below 2^51.
ROUND = 6755399441055744.0
# Angles below this, rad, need no reduction by quarter turns.
SHORT = 0.785
TWO_OVER_PI = 0.6366197723675814
# pi/2 in three parts. The first two have at most 33 bits, so that their products with integers up
# to 2^20 are exact; the third is the remainder.
HALF_PI_1, HALF_PI_2, HALF_PI_3 = (1.5707963267341256, 6.077100506303966e-11,
                                   2.0222662487959506e-21)
# pi/4 in two parts; three times the first is exact.
QUARTER_PI_1, QUARTER_PI_2 = 0.7853981633974456, 2.7193112105566926e-15
# Up to this tangent an angle is computed relative to the axis, above it relative to the diagonal.
FLAT = 0.66
LN_2_1, LN_2_2 = 0.6931471803691238, 1.9082149292705877e-10
ONE_OVER_LN_2 = 1.4426950408889634
SQRT_2 = 1.4142135623730951


def sqrt(x):
    """Return the square root of a float, an array or a Series."""
    if isinstance(x, float):
        return math.sqrt(x)
    if isinstance(x, np.ndarray):
        return np.sqrt(x)
    return x ** 0.5


def as_number(condition):
    """Return 1.0 where a comparison of floats or arrays holds, 0.0 where it does not."""
    return condition * 1.0


def float_as_number(condition):
    """Return ``as_number`` of one comparison, in a form that compilers turn into a selection."""
    return 1.0 if condition else 0.0


def sine_cosine_kernel(r):
    """Return sin r and cos r for r from -pi/4 to pi/4."""
    z = r * r
    s = r + r * z * (-1.66666666666666324348e-01 + z * (8.33333333332248946124e-03 + z * (
        -1.98412698298579493134e-04 + z * (2.75573137070700676789e-06 + z * (
            -2.50507602534068634195e-08 + z * 1.58969099521155010221e-10)))))
    half = 0.5 * z
    w = 1.0 - half
    c = w + (((1.0 - w) - half) + z * z * (4.16666666666666019037e-02 + z * (
        -1.38888888888741095749e-03 + z * (2.48015872894767294178e-05 + z * (
            -2.75573143513906633035e-07 + z * (2.08757232129817482790e-09
                                               - z * 1.13596475577881948265e-11))))))
    return s, c


def sincos(x):
    """
    Return sin x and cos x.

    Errors are within 2.5 ulp from 10 to 1.6e6 rad. Beyond, the rounding of the reduction is added,
    which is at most that of x itself.
    """
    if isinstance(x, float) and -SHORT < x < SHORT:
        # Same result as general_sincos, in a third of the time.
        s, c = sine_cosine_kernel(x)
        return s + 0.0, c
    return general_sincos(x)


def general_sincos(x):
    """Return sin x and cos x without a shortcut for small x."""
    k = (x * TWO_OVER_PI + ROUND) - ROUND
    s, c = sine_cosine_kernel(((x - k * HALF_PI_1) - k * HALF_PI_2) - k * HALF_PI_3)
    return quarters_on(s, c, k)


def sincos_of_quarters(x):
    """Return sine and cosine of an angle x that is given in quarter turns."""
    k = (x + ROUND) - ROUND
    s, c = sine_cosine_kernel((x - k) * (0.5 * math.pi))
    return quarters_on(s, c, k)


def quarters_on(s, c, k):
    """Return sine and cosine of an angle plus k quarter turns, from its sine and cosine."""
    # k = 2 half + odd; each half turn changes both signs.
    half = ((k - 0.5) * 0.5 + ROUND) - ROUND
    odd = k - 2.0 * half
    even = 1.0 - odd
    half = half - 2.0 * (((half - 0.5) * 0.5 + ROUND) - ROUND)
    sign = 1.0 - 2.0 * half
    return sign * (s * even + c * odd), sign * (c * even - s * odd)


def sin(x):
    """Return sin x; for the errors see ``sincos``."""
    return sincos(x)[0]


def cos(x):
    """Return cos x; for the errors see ``sincos``."""
    return sincos(x)[1]


def atan2(y, x):
    """Return the angle of the point (x, y) from the x axis, -pi to pi; zero at the origin."""
    if isinstance(x, float) and isinstance(y, float) and 0.0 < y < FLAT * x:
        # Same result as general_atan2, in half the time.
        t = y / x
        return t + arc_tangent_rest(t)
    return general_atan2(y, x)


def general_atan2(y, x):
    """Return ``atan2`` without a shortcut for small angles."""
    a, b = abs(y), abs(x)
    steep = as_number(a > b)
    # Exact, because each of them is either a or b.
    low, high = a * (1.0 - steep) + b * steep, b * (1.0 - steep) + a * steep
    # Above FLAT the angle is computed relative to the diagonal.
    near = as_number(low > FLAT * high)
    over = high + near * low
    t = (low - near * high) / (over + as_number(over == 0.0))
    r = t + arc_tangent_rest(t)
    # Eighths of a turn from the axis to the reference direction, and the sign of t from there.
    eighths, sense = near + steep * (2.0 - 2.0 * near), 1.0 - steep * 2.0
    back = as_number(x < 0.0)
    eighths, sense = eighths + back * (4.0 - 2.0 * eighths), sense * (1.0 - back * 2.0)
    angle = eighths * QUARTER_PI_1 + (sense * r + eighths * QUARTER_PI_2)
    return angle * (1.0 - as_number(y < 0.0) * 2.0)


def arc_tangent_rest(t):
    """Return arctan t - t for t from -0.66 to 0.66."""
    z = t * t
    p = z * ((((-8.750608600031904122785e-01 * z - 1.615753718733365076637e+01) * z
               - 7.500855792314704667340e+01) * z - 1.228866684490136173410e+02) * z
             - 6.485021904942025371773e+01)
    q = ((((z + 2.485846490142306297962e+01) * z + 1.650270098316988542046e+02) * z
          + 4.328810604912902668951e+02) * z + 4.853903996359136964868e+02) * z \
        + 1.945506571482613964425e+02
    return t * (p / q)


def times_power_of_two(x, k):
    """Return x 2^k for an integer k given as a float; exact unless it leaves the range."""
    if isinstance(x, np.ndarray):
        return np.ldexp(x, np.where(k == k, k, 0.0).astype(np.int64))
    return float_times_power_of_two(x, k)


def float_times_power_of_two(x, k):
    """Return x 2^k for floats; x if k is NaN."""
    return math.ldexp(x, int(k)) if k == k else x


def _reduced_exponential(x):
    """Return e^r - 1 and the integer k for x = k ln 2 + r, |r| <= ln(2)/2."""
    k = (x * ONE_OVER_LN_2 + ROUND) - ROUND
    hi, lo = x - k * LN_2_1, k * LN_2_2
    r = hi - lo
    t = r * r
    c = r - t * (1.66666666666666019037e-01 + t * (-2.77777777770155933842e-03 + t * (
        6.61375632143793436117e-05 + t * (-1.65339022054652515390e-06
                                          + t * 4.13813679705723846039e-08))))
    return hi + (r * c / (2.0 - c) - lo), k


def exp(x):
    """Return e^x, for x from -700 to 700."""
    p, k = _reduced_exponential(x)
    return times_power_of_two(1.0 + p, k)


def expm1(x):
    """Return e^x - 1 without loss for small x, for x from -700 to 700, within 2 ulp."""
    p, k = _reduced_exponential(x)
    return times_power_of_two(p, k) + (times_power_of_two(1.0 + 0.0 * p, k) - 1.0)


def tanh(x):
    """Return tanh x, within 3 ulp."""
    a = abs(x)
    far = as_number(a > 22.0)
    e = expm1(2.0 * (a * (1.0 - far) + 22.0 * far))
    return e / (e + 2.0) * (1.0 - as_number(x < 0.0) * 2.0)


def log_kernel(m, k):
    """Return ln(m 2^k) for m between sqrt(1/2) and sqrt 2 and an integer k, both floats."""
    f = m - 1.0
    s = f / (2.0 + f)
    z = s * s
    r = z * (6.666666666666735130e-01 + z * (3.999999999940941908e-01 + z * (
        2.857142874366239149e-01 + z * (2.222219843214978396e-01 + z * (
            1.818357216161805012e-01 + z * (1.531383769920937332e-01
                                            + z * 1.479819860511658591e-01))))))
    half = 0.5 * f * f
    return k * LN_2_1 - ((half - (s * (half + r) + k * LN_2_2)) - f)


def parts(x):
    """Return m from 0.5 to 1 and the integer k with x = m 2^k."""
    return np.frexp(x) if isinstance(x, np.ndarray) else math.frexp(x)


def log(x):
    """Return the natural logarithm of x > 0."""
    return log_of_parts(*parts(x))


def log_of_parts(m, k):
    """Return ln(m 2^k) for m from 0.5 to 1."""
    small = as_number(m < 0.5 * SQRT_2)
    return log_kernel(m * (1.0 + small), k - small)


def log1p(x):
    """Return ln(1 + x) without loss for small x, for x from 0 to 1."""
    y = 1.0 + x
    return log(y) + (x - (y - 1.0)) / y


def shorter_turn(x):
    """Return an angle, rad, minus whole turns, from -pi to pi; both up to rounding errors."""
    return x - ((x * (0.5 / math.pi) + ROUND) - ROUND) * (2.0 * math.pi)
