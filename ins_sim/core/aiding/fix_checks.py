"""Checks that reject impossible fixes, each with one sentence."""

import math

from ins_sim.core.numerics.instants import seconds
from ins_sim.core.streams.faults import StreamFault
from ins_sim.core.timeseries import bounds


def check_velocity(fix, window, dt_ns):
    """Raise StreamFault (fix dropped) unless a VelocityFix has the window of the settings."""
    where, cycles = f'velocity_meter: fix at {seconds(fix.end_ns)}', window.cycles
    window_ns, step_ns = cycles * dt_ns, window.step_cycles * dt_ns
    if fix.cycles != cycles or fix.end_ns - fix.start_ns != window_ns:
        length = (fix.end_ns - fix.start_ns) * 1e-9
        raise _dropped(f'{where} averages {fix.cycles} cycles in {length:.9g} s; expected '
                       f'{cycles} cycles in {window_ns * 1e-9:.9g} s (window.cycles and rate_hz '
                       'must be the same in velocity_meter and aided_navigator)')
    if fix.end_ns % step_ns:
        raise _dropped(f'{where} ends inside a window; expected a multiple of '
                       f'{step_ns * 1e-9:.9g} s of motion time (window.slide_cycles must be the '
                       'same in velocity_meter and aided_navigator)')
    _check_arrival(where, fix)
    if fix.valid:
        _check(where, 'velocity', (*fix.velocity, fix.up), fix.sigma, bounds.SPEED_M_S)


def check_ahead(source, t_ns, newest_ns, ahead_ns):
    """Raise StreamFault (fix dropped) if a fix is too far ahead of the newest IMU sample."""
    if t_ns > newest_ns + ahead_ns:
        raise _dropped(f'{source}: fix at {seconds(t_ns)} is from the future: the newest IMU '
                       f'sample is at {seconds(newest_ns)}; expected a fix at most '
                       f'{ahead_ns * 1e-9:g} s ahead')


def check_gnss(fix):
    """Raise StreamFault (fix dropped) unless a GnssFix is finite, with positive variances."""
    where = f'gnss: fix at {seconds(fix.t_ns)}'
    _check_arrival(where, fix)
    if fix.valid:
        _check(where, 'position', (fix.lat, fix.lon, fix.height), fix.position_sigma,
               bounds.HEIGHT_M)
        _check(where, 'velocity', fix.v_n, fix.velocity_sigma, bounds.SPEED_M_S)
        if not abs(fix.lat) <= 0.5 * math.pi:
            raise _dropped(f'{where} has a latitude of {math.degrees(fix.lat):g} deg; expected '
                           '-90 to 90')


def _check_arrival(where, fix):
    if fix.arrival_ns < fix.t_ns:
        raise _dropped(f'{where} arrives at {seconds(fix.arrival_ns)}, before its own instant; '
                       'expected that instant or later')


def _check(where, name, values, sigmas, bound):
    if not all(map(math.isfinite, values)):
        raise _dropped(f'{where} has a {name} of {values}; expected finite numbers')
    x, y, z = values
    if not x * x + y * y + z * z < bound * bound:
        raise _dropped(f'{where} has a {name} of {values}; expected less than {bound:g}')
    if not all(s > 0.0 for s in sigmas):
        raise _dropped(f'{where} has standard deviations of {name} {sigmas}; expected positive '
                       'ones')
    if not all(map(bounds.is_sigma, sigmas)):
        raise _dropped(f'{where} has standard deviations of {name} {sigmas}; expected '
                       f'{bounds.LEAST_SIGMA:g} to {bounds.MOST_SIGMA:g}')


def _dropped(sentence):
    return StreamFault(f'{sentence}; it was dropped', restart=False)
