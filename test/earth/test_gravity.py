"""Normal gravity at height compared with the closed form for the level ellipsoid."""

import math

import numpy as np
import pytest
from support.studies import settings, study

from ins_sim.core.earth import ellipsoid

GM, SPIN = 3.986004418e14, 7.292115e-5
A, B = 6378137.0, 6356752.3142
MICRO_G = 9.80665e-6
# Greatest error over the latitudes, ug. According to the documentation the free-air formula errs
# by 14 at 10 km, 183 at 50 km and 2 % at 500 km; the second-order formula by its third-order term,
# 4 (h / a)^3.
EXPECTED = {10e3: (14.0, 0.1), 50e3: (183.0, 4.0), 500e3: (2e4, 2200.0)}


def closed_form(sin_lat, height):
    """
    Return gravity, m/s^2, outside the rotating level ellipsoid.

    Heiskanen and Moritz, "Physical Geodesy", section 2-7, in ellipsoidal coordinates (u, beta).
    """
    cos_lat = math.sqrt(1.0 - sin_lat * sin_lat)
    x, _, z = ellipsoid.ecef(sin_lat, cos_lat, 0.0, 1.0, height)
    e2 = A * A - B * B
    e = math.sqrt(e2)
    d = x * x + z * z - e2
    u = math.sqrt(0.5 * d * (1.0 + math.sqrt(1.0 + 4.0 * e2 * z * z / (d * d))))
    beta = math.atan2(z * math.hypot(u, e), u * x)
    s, c = math.sin(beta), math.cos(beta)

    def q(u):
        return 0.5 * ((1.0 + 3.0 * u * u / e2) * math.atan(e / u) - 3.0 * u / e)

    slope = 3.0 * (1.0 + u * u / e2) * (1.0 - u / e * math.atan(e / u)) - 1.0
    square = u * u + e2
    w = math.sqrt((u * u + e2 * s * s) / square)
    along = -(GM / square + SPIN * SPIN * A * A * e / square * slope / q(B)
              * (0.5 * s * s - 1.0 / 6.0) - SPIN * SPIN * u * c * c) / w
    across = (SPIN * SPIN * A * A / math.sqrt(square) * q(u) / q(B)
              - SPIN * SPIN * math.sqrt(square)) * s * c / w
    return math.hypot(along, across)


def off(height, model):
    """Return the greatest error of a formula over the latitudes, ug."""
    terms = ellipsoid.GRAVITY_TERMS[model]
    return max(abs(ellipsoid.gravity(s, height, terms) - closed_form(s, height))
               for s in np.sin(np.radians(np.arange(0.0, 90.0, 5.0)))) / MICRO_G


def test_both_are_exact_on_the_ellipsoid():
    """At height zero Somigliana's formula is the closed form, to the digits of its constants."""
    for model in ellipsoid.GRAVITY_TERMS:
        assert off(0.0, model) < 1e-3


@pytest.mark.parametrize('height', EXPECTED)
def test_gravity_at_height(height):
    """The free-air formula errs as documented, the second-order one by its third-order term."""
    free, second = (off(height, model) for model in ('free_air', 'second_order'))
    print(f'\n{height:g} m: free air {free:.4g} ug, second order {second:.4g} ug')
    expected, bound = EXPECTED[height]
    assert free == pytest.approx(expected, rel=0.25)
    assert second < bound


HIGH = {'motion.kind': 'racetrack', 'datum.latitude_deg': 55.0, 'datum.longitude_deg': 37.0,
        'duration_s': 60.0, 'vertical.channel': 'free', 'source': 'motion'}


@pytest.mark.parametrize('kind', ['racetrack', 'two_axis'])
def test_truth_and_navigation_have_the_same_gravity(kind):
    """A run closes with either gravity formula, but not if truth and INS use different ones."""
    values = {**HIGH, 'motion.kind': kind, 'datum.height_m': 400e3 if kind == 'two_axis' else 0.0}
    found = {model: np.abs(study({**values, 'earth.gravity': model}, False)[0].position).max()
             for model in ('free_air', 'second_order')}
    assert max(found.values()) < 1e-3, found


def test_gravity_that_differs_makes_the_solution_fall():
    """
    At 400 km the formulas differ by 1 % of g, and the height errs by half of this times t^2.

    This is 0.05 t^2 m.
    """
    from dataclasses import replace
    from ins_sim.core.simulation.inertial import simulate
    from ins_sim.io.motion import read_motion
    values = {**HIGH, 'motion.kind': 'static', 'datum.height_m': 400e3, 'duration_s': 10.0}
    flown, navigated = (settings({**values, 'earth.gravity': model})
                        for model in ('second_order', 'free_air'))
    mixed = replace(flown, strapdown=navigated.strapdown)
    errors = simulate(mixed, read_motion(mixed.motion_generator), twin=False).errors
    s = math.sin(math.radians(55.0))
    first, second = (ellipsoid.gravity(s, 400e3, ellipsoid.GRAVITY_TERMS[m])
                     for m in ('free_air', 'second_order'))
    assert errors.position[-1, 2] == pytest.approx(0.5 * (second - first) * 100.0, rel=1e-3)


@pytest.mark.slow
def test_the_second_order_compiled_gives_the_same_bits(monkeypatch):
    """The second-order formula has the same bits in plain Python and compiled."""
    from support.studies import run_offline
    from ins_sim.core.numerics import compilation
    chosen = settings({**HIGH, 'earth.gravity': 'second_order', 'duration_s': 20.0})
    found = []
    for samples in (10 ** 12, 0):
        monkeypatch.setattr(compilation, 'PLAIN_SAMPLES', samples)
        found.append(run_offline(chosen, twin=False).states)
    assert all(np.array_equal(a, b) for a, b in zip(*(s.arrays().values() for s in found)))
