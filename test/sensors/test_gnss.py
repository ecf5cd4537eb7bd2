"""GNSS: distributions of the errors, position of the antenna, instants of the fixes."""

import math

from hypothesis import given, settings, strategies as st
import numpy as np
import pytest
from scipy.stats import chi2

from ins_sim.settings.catalogue import build
from ins_sim.core.navigation.errors import position_error
from ins_sim.core.streams.faults import StreamFault
from ins_sim.core.timeseries.fixes import VALID
from ins_sim.core.sensors.gnss import Gnss
from ins_sim.core.earth.rates import rate_on_earth
from ins_sim.settings.gnss import GnssSettings
from ins_sim.core.motion.factory import make_motion
from ins_sim.settings.motion import MotionGeneratorSettings

SECOND = 1_000_000_000
DT = SECOND // 100
QUANTILE = 1e-6
PERFECT = {'errors.position_noise_m': (0.0,) * 3, 'errors.velocity_noise_m_s': (0.0,) * 3}
REST = (math.radians(55.75), math.radians(37.62), 150.0, (0.0,) * 3, (0.0, 0.0, 0.0, 1.0),
        (0.0,) * 3)


def gnss(values=None):
    """Return a Gnss with these {dotted name: value}."""
    return Gnss(build(GnssSettings, values or {}))


def truth_of(kind, t_ns, **more):
    """Return the Truth record of a motion at instants."""
    s = build(MotionGeneratorSettings, {'motion.kind': kind, **{
        k.replace('__', '.'): v for k, v in more.items()}})
    return make_motion(s.motion, s.datum, s.earth).at(np.asarray(t_ns, dtype=np.int64))


def samples(truth):
    """Return [(t_ns, truth)], the arguments of ``push``."""
    return [(t_ns, (lat, lon, height, v_n, q_nb, rate_on_earth(lat, q_nb, omega, 7.292115e-5)))
            for t_ns, lat, lon, height, v_n, q_nb, omega in zip(*(
                getattr(truth, name).tolist() for name in ('t_ns', 'lat', 'lon', 'height', 'v_n',
                                                           'q_nb', 'omega_ib_b')))]


def errors_at_rest(receiver, n):
    """Return position and velocity errors of fixes 0 to n - 1 at rest, (n, 3) each."""
    fixes = [receiver.fix(k * receiver.period_ns, REST) for k in range(n)]
    return (np.array([position_error(f.lat, f.lon, f.height, *REST[:3]) for f in fixes]),
            np.array([f.v_n for f in fixes]))


def test_white_noise_has_its_variances(figures):
    """White noise of 20000 fixes passes chi-square at 1e-6 and is uncorrelated within 5 sigma."""
    n = 20000
    noise, slip = (1.5, 2.0, 4.0), (0.05, 0.06, 0.1)
    errors = np.concatenate(errors_at_rest(gnss({
        'errors.position_noise_m': noise, 'errors.velocity_noise_m_s': slip}), n), axis=1)
    sigma = np.array(noise + slip)
    found = np.sqrt((errors ** 2).mean(axis=0))
    print(f'\nsigma {np.round(found, 4)} of {sigma}')
    figures.record('gnss.white.position', found[:3], 'm', noise, 'asked')
    figures.record('gnss.white.velocity', found[3:], 'm/s', slip, 'asked')
    low, high = chi2.ppf(QUANTILE, n), chi2.isf(QUANTILE, n)
    assert ((low < n * (found / sigma) ** 2) & (n * (found / sigma) ** 2 < high)).all()
    u = errors / sigma
    lag = np.abs((u[1:] * u[:-1]).mean(axis=0)).max()
    cross = np.abs(np.corrcoef(u.T)[np.triu_indices(6, 1)]).max()
    print(f'largest lag {lag:.4f}, cross {cross:.4f} (bound {5 / math.sqrt(n):.4f})')
    assert max(lag, cross) < 5.0 / math.sqrt(n)


def test_drift_has_its_correlation_time():
    """
    The drift has the autocorrelation exp(-lag/T) at five lags within 5 standard errors.

    The standard errors are those of Bartlett's formula. The variance of n samples of a Gauss-
    Markov process has the relative error sqrt(2 (1 + a^2) / (n (1 - a^2))), where a is the
    correlation of neighbouring samples.
    """
    n, time = 60000, 30.0
    sigma = np.array([2.0, 1.0, 3.0])
    receiver = gnss({**PERFECT, 'errors.position_drift_m': tuple(sigma.tolist()),
                     'errors.position_drift_time_s': time})
    position, velocity = errors_at_rest(receiver, n)
    assert not velocity.any()
    u, a = position / sigma, math.exp(-1.0 / time)
    ratio = (u ** 2).mean(axis=0)
    most = 5.0 * math.sqrt(2.0 * (1.0 + a * a) / (n * (1.0 - a * a)))
    print(f'\nvariances / nominal {np.round(ratio, 4)} (1 +- {most:.3f})')
    assert np.abs(ratio - 1.0).max() < most
    for lag in (1, 10, 30, 60, 120):
        rho = (u[lag:] * u[:-lag]).mean(axis=0) / ratio
        a2 = a ** (2 * lag)
        error = 5.0 * math.sqrt(((1 + a * a) * (1 - a2) / (1 - a * a) - 2 * lag * a2) / n)
        print(f'lag {lag:3d} s: {np.round(rho, 4)} of {math.exp(-lag / time):.4f} +- {error:.4f}')
        assert np.abs(rho - math.exp(-lag / time)).max() < error
    fix = receiver.fix(0, REST)
    assert fix.position_sigma == (2.0, 1.0, 3.0)
    assert fix.velocity_sigma == (1e-3, 1e-3, 1e-3)


@pytest.mark.parametrize('kind', ['two_axis', 'racetrack'])
def test_the_antenna_moves_as_its_positions_do(kind):
    """
    The velocity of the antenna equals central differences of its positions 10 ms apart.

    Their error is h^2/6 times the third derivative of the position: at most w^3 l with 2 rad/s for
    the lever arm, and 1 m/s^3 for the flight. To this come 2e-9 m of rounding over 2 h, and in
    flight the curvature of the Earth, v l / R = 4e-4 m/s.
    """
    lever, h = np.array([4.0, -3.0, 12.0]), 0.01
    receiver = gnss({**PERFECT, 'lever_arm_m': tuple(lever.tolist()), 'gnss.rate_hz': 100.0})
    t_ns = np.arange(20000, 24000, dtype=np.int64) * DT
    truth = truth_of(kind, t_ns)
    fixes = receiver.advance(truth)
    moved = np.array([position_error(b.lat, b.lon, b.height, a.lat, a.lon, a.height)
                      for a, b in zip(fixes, fixes[2:])]) / (2.0 * h)
    v = np.array([f.v_n for f in fixes])
    off = np.abs(v[1:-1] - moved).max()
    swing = np.linalg.norm(v - truth.v_n, axis=1).max()
    norm = np.linalg.norm(lever)
    most = h * h / 6.0 * (8.0 * norm + 1.0) + 2e-9 / h
    most += np.linalg.norm(truth.v_n, axis=1).max() * norm / 6.3e6
    print(f'\n{kind}: {off:.1e} m/s of at most {most:.1e}; lever arm moves at {swing:.3f} m/s')
    assert off < most and swing > 10.0 * most
    rate = np.array([s[1][5] for s in samples(truth)])
    cross = np.linalg.norm(np.cross(rate, lever), axis=1)
    assert np.abs(np.linalg.norm(v - truth.v_n, axis=1) - cross).max() < 1e-12
    apart = [np.linalg.norm(position_error(f.lat, f.lon, f.height, *p)) for f, p in zip(
        fixes, zip(truth.lat.tolist(), truth.lon.tolist(), truth.height.tolist()))]
    # Neighbouring doubles of a position are 1e-9 m apart.
    assert np.abs(np.array(apart) - norm).max() < 1e-8


def test_outages_by_schedule_and_by_hand():
    """Fixes are invalid from the start of an outage, inclusive, to its end, exclusive."""
    receiver = gnss({'outages.start_s': (3.0, 7.5), 'outages.end_s': (5.0, 8.5),
                     'gnss.latency_ms': 120.0})
    receiver.force_outage(False)
    got = {}
    for k in range(1101):
        if k == 950:
            receiver.force_outage(True)
        if k == 1050:
            receiver.force_outage(False)
        for fix in receiver.push(k * DT, REST):
            got[fix.t_ns // SECOND] = fix
    assert sorted(got) == list(range(12))
    assert [t for t, fix in got.items() if not fix.valid] == [3, 4, 8, 10]
    assert {fix.status for fix in got.values()} == {VALID, 'outage'}
    assert all(math.isnan(x) for x in (got[3].lat, got[3].lon, got[3].height, *got[3].v_n))
    assert all(fix.arrival_ns == t * SECOND + 120_000_000 for t, fix in got.items())
    # A fix after an outage is the same as without the outage.
    assert got[11] == gnss({'gnss.latency_ms': 120.0}).fix(11 * SECOND, REST)


def test_a_jump_moves_the_position_alone():
    """A jump moves the position by its offset between start and end, and not the velocity."""
    offset = (100.0, -50.0, 7.0)
    receiver = gnss({'jump.start_s': 5.0, 'jump.end_s': 8.0, 'jump.offset_m': offset})
    plain = gnss()
    for t in range(12):
        fix, other = receiver.fix(t * SECOND, REST), plain.fix(t * SECOND, REST)
        moved = position_error(fix.lat, fix.lon, fix.height, other.lat, other.lon, other.height)
        # The offset is applied with the radii of curvature at the truth; the noise is 10 m off.
        expected = offset if 5 <= t < 8 else (0.0, 0.0, 0.0)
        assert np.abs(np.subtract(moved, expected)).max() < 100.0 * 30.0 / 6.3e6
        assert fix.v_n == other.v_n and fix.position_sigma == other.position_sigma
        assert 5 <= t < 8 or fix == other


def test_reported_sigmas():
    """Reported sigmas are the root sum square of noise and drift unless they are set."""
    fix = gnss({'errors.position_noise_m': (3.0, 3.0, 6.0), 'errors.position_drift_m':
                (4.0, 0.0, 8.0)}).fix(0, REST)
    assert fix.position_sigma == (5.0, 3.0, 10.0) and fix.velocity_sigma == (0.05, 0.05, 0.1)
    given = gnss({'reported.position_sigma_m': (1.0, -1.0, 0.0),
                  'reported.velocity_sigma_m_s': (-1.0, 2.0, -1.0)}).fix(0, REST)
    assert given.position_sigma == (1.0, 1.5, 0.0) and given.velocity_sigma == (0.05, 2.0, 0.1)


FULL = {'errors.position_drift_m': (2.0, 2.0, 4.0), 'lever_arm_m': (1.0, 0.5, 2.0),
        'outages.start_s': (610.0,), 'outages.end_s': (612.0,), 'jump.start_s': 605.0,
        'jump.end_s': 607.0, 'jump.offset_m': (10.0, 0.0, 0.0), 'seed': 4, 'gnss.rate_hz': 5.0}
T_NS = np.arange(60000, 62001, dtype=np.int64) * DT
FLIGHT = truth_of('aggressive', T_NS)
WHOLE = gnss(FULL).advance(FLIGHT)


@settings(max_examples=20, deadline=None)
@given(cuts=st.lists(st.integers(0, 2001), max_size=5), order=st.randoms())
def test_any_cutting_in_any_order_gives_the_same_bits(cuts, order):
    """A fix depends on seed and index only: in any parts and order it has the same bits."""
    edges = [0, *sorted(cuts), 2001]
    pieces = list(zip(edges, edges[1:]))
    order.shuffle(pieces)
    receiver, found = gnss(FULL), []
    for a, b in pieces:
        found += receiver.advance(FLIGHT[a:b])
    assert repr(sorted(found, key=lambda fix: fix.t_ns)) == repr(WHOLE)


def test_the_stream_gives_the_bits_of_the_block():
    """The stream gives the bits of the block, from any start and with denser truth."""
    assert len(WHOLE) == 101
    for first, values in ((0, {}), (777, {}), (0, {'rate_hz': 50.0})):
        receiver, got = gnss({**FULL, **values}), []
        for sample in samples(FLIGHT[first:]):
            got += receiver.push(*sample)
        assert repr(got) == repr([f for f in WHOLE if f.t_ns >= T_NS[first]])
    for other in (gnss({**FULL, 'run': 1}), gnss({**FULL, 'seed': 5})):
        assert not {f.lat for f in other.advance(FLIGHT) if f.valid} & {f.lat for f in WHOLE}


def test_over_the_date_line():
    """The longitude of a fix near the date line is less than half a turn from the truth."""
    receiver = gnss({'jump.end_s': 10.0, 'jump.offset_m': (1000.0, 0.0, 0.0)})
    fix = receiver.fix(SECOND, (0.5, math.radians(179.999), *REST[2:]))
    assert -math.pi < fix.lon < math.radians(-179.98)


def test_the_first_sample_may_be_repeated():
    """A repeated first sample, as in lock-step, is answered with the same fix."""
    receiver = gnss()
    first = receiver.push(0, REST)
    assert len(first) == 1 and receiver.push(0, REST) == first
    receiver.push(DT, REST)
    with pytest.raises(StreamFault, match='repeats the stamp'):
        receiver.push(DT, REST)


NAN = (math.nan, *REST[1:])


@pytest.mark.parametrize('sample, sentence, restart', [
    ((2 * DT, NAN), 'truth at 0.020000000 s holds .*nan.*expected finite numbers', False),
    ((2 * DT, (*REST[:4], (0.0, 0.0, 0.0, 2.0), REST[5])), 'orientation of norm 2', False),
    ((5 * DT, REST), 'truth has a gap from 0.010000000 s to 0.050000000 s', True),
    ((0, REST), 'truth jumps back from 0.010000000 s to 0.000000000 s', True),
])
def test_bad_samples_are_refused(sample, sentence, restart):
    """A bad sample raises a fault with one message; after a reset the next one is the first."""
    receiver = gnss()
    receiver.push(0, REST)
    receiver.push(DT, REST)
    with pytest.raises(StreamFault, match=sentence) as found:
        receiver.push(*sample)
    assert found.value.restart == restart
    if restart:
        receiver.reset()
        receiver.push(*sample)


def test_truth_that_steps_over_the_instant_of_a_fix_is_refused():
    """Truth at 130 Hz, which has no sample at the instants of 10 Hz fixes, is refused."""
    receiver, step = gnss({'gnss.rate_hz': 10.0}), 7_692_308
    with pytest.raises(StreamFault, match='over 0.100000000 s; expected a sample there'):
        for k in range(20):
            receiver.push(k * step, REST)
    truth = truth_of('static', np.arange(20) * step)
    with pytest.raises(ValueError, match='over the instant of a fix; expected a sample there'):
        gnss({'gnss.rate_hz': 10.0}).advance(truth)
    broken = truth_of('static', np.arange(200) * DT)
    broken.lat[100] = math.nan
    with pytest.raises(ValueError, match='truth at 1.000000000 s holds'):
        gnss().advance(broken)


@pytest.mark.parametrize('values, sentence', [
    ({'gnss.rate_hz': 3.0}, 'gnss.rate_hz is 3 Hz, a period of 0.333333333 s; expected a multiple '
     'of the period of rate_hz, 0.01 s'),
    ({'rate_hz': 0.5}, 'gnss.rate_hz is 1 Hz, a period of 1 s; expected a multiple of the period '
     'of rate_hz, 2 s'),
    ({'outages.start_s': (1.0, 2.0), 'outages.end_s': (3.0,)},
     'outages.start_s has 2 entries and outages.end_s 1; expected equal numbers'),
    ({'outages.start_s': (5.0,), 'outages.end_s': (5.0,)},
     'outages.end_s is 5 s with outages.start_s 5 s; expected a later end'),
    ({'jump.start_s': 5.0, 'jump.offset_m': (1.0, 0.0, 0.0)},
     'jump.end_s is 0 s with jump.start_s 5 s; expected a later end'),
    ({'lever_arm_m': (1.0, 2.0)}, 'lever_arm_m has 2 entries; expected 3'),
    ({'errors.position_noise_m': (-1.0, 0.0, 0.0)}, 'errors.position_noise_m is -1 m; expected 0'),
    ({'errors.position_drift_time_s': 0.0}, 'expected 0.001 to'),
    ({'gnss.latency_ms': math.nan}, 'gnss.latency_ms is nan; expected a finite number'),
    ({'outages.start_s': (math.inf,), 'outages.end_s': (1.0,)}, 'expected a finite number'),
])
def test_bad_settings_are_one_sentence(values, sentence):
    """Each invalid setting gives a message with key, value and expectation."""
    with pytest.raises(ValueError, match=sentence):
        gnss(values)
