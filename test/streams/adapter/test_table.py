"""Force, rate, closure and path of adapted truth: the table of docs/theory/external_truth.md."""

import pytest
from support.other_simulators import AdaptedRun, MOTIONS, OtherSimulator

# Bounds of a row by rate of the input (Hz), in m/s^2, rad/s, m (own closure) and m (closed form).
# They are the specified bounds of the schemes; measured values are printed.
TWIST = {20: (3e-3, 2e-4, 5e-3, 1.5), 50: (1e-4, 1e-5, 5e-3, 0.05), 100: (1e-4, 2e-6, 5e-3, 0.05),
         400: (1e-4, 2e-6, 5e-3, 0.05)}
POSES = {20: (2e-2, 2e-4, 5e-3, 0.2), 50: (2e-3, 1e-5, 5e-3, 0.2), 100: (3e-4, 2e-6, 5e-3, 0.2),
         400: (1e-3, 2e-6, 0.1, 0.2)}
PLACES = {20: (1e-3, 2e-4, 5e-3, 0.5), 50: (1e-3, 1e-5, 5e-3, 0.5), 100: (1e-3, 2e-6, 5e-3, 0.5),
          400: (1e-3, 2e-6, 5e-3, 0.5)}
NOISE = {20: (0.15, 6e-4, 0.1, None), 50: (0.25, 6e-4, 0.1, None), 100: (0.4, 6e-4, 0.1, None),
         400: (0.4, 6e-4, 0.1, None)}
# Each row: how the exact input is changed, its bounds, and the greatest error of the path, m.
ROWS = {
    'exact twist': (lambda s: s, TWIST, 0.05),
    'no twist': (OtherSimulator.without_twist, POSES, 0.05),
    'mean twist': (OtherSimulator.averaged_twist, POSES, 0.05),
    'noisy places': (lambda s: s.noisy(1e-3), PLACES, 0.05),
    'all noisy': (lambda s: s.noisy(1e-3, 0.01, 1e-3, 0.01), NOISE, 0.05),
    'stamps off by 0.1 ms': (lambda s: s.off_stamps(1e-4), {50: (0.1, 1e-4, 0.1, None)}, 0.05),
    'stamps off by 1 ms': (lambda s: s.off_stamps(1e-3), {50: (1.0, 1e-3, 3.0, None)}, 0.1),
    '32 bits': (OtherSimulator.in_floats, {50: (2e-3, 1e-5, 5e-3, 0.1)}, 0.05)}


def held(row, motion, rate_hz, length_s):
    """Run a row of the table and check its bounds."""
    spoil, bounds, path_m = ROWS[row]
    simulator = spoil(OtherSimulator(motion, rate_hz, length_s))
    adapter, truths = simulator.adapted()
    run = AdaptedRun(simulator, truths)
    own, exact = run.closures()
    found = (run.f, run.w, own, exact, run.farthest())
    print(f'\n{row}, {motion}, {rate_hz} Hz: {found[0]:.2g} m/s^2, {found[1]:.2g} rad/s, '
          f'closure {found[2]:.2g} m, {found[3]:.2g} m, path {found[4]:.2g} m\n{adapter.notes}')
    assert len(adapter.notes) == 1
    # After two seconds of examination, truth is late by at most three periods of the knots.
    assert 2.01e9 >= truths[0].t_ns >= 2e9 - 3.5e9 / min(rate_hz, 100)
    for value, bound in zip(found, (*bounds[rate_hz], path_m)):
        assert bound is None or value <= bound


SHORT = [('exact twist', 'racetrack', 20), ('exact twist', 'motion_2', 50),
         ('exact twist', 'aggressive', 400), ('no twist', 'sinusoids', 20),
         ('no twist', 'racetrack', 100), ('mean twist', 'racetrack', 50),
         ('noisy places', 'racetrack', 50), ('all noisy', 'racetrack', 100),
         ('stamps off by 0.1 ms', 'racetrack', 50), ('stamps off by 1 ms', 'racetrack', 50),
         ('32 bits', 'racetrack', 50)]
LONG = [(row, motion, rate_hz) for row in ROWS for motion in MOTIONS for rate_hz in ROWS[row][1]
        if motion == 'racetrack' or row in ('exact twist', 'no twist', 'mean twist')
        and rate_hz < 400]


@pytest.mark.parametrize('row, motion, rate_hz', SHORT)
def test_a_row_holds_for_ten_seconds(row, motion, rate_hz):
    """Ten seconds of some rows of the table stay within their bounds."""
    held(row, motion, rate_hz, 12.0)


@pytest.mark.slow
@pytest.mark.parametrize('row, motion, rate_hz', LONG)
def test_a_row_holds_for_ten_minutes(row, motion, rate_hz):
    """Ten minutes of each row stay within their bounds, with a free vertical channel."""
    held(row, motion, rate_hz, 602.0)
