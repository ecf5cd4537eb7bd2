"""Late fixes are processed at their own instant; impossible fixes are rejected."""

from dataclasses import replace
import math

from support.aided.flights import circle, perfect_fixes, samples_of, straight
from hypothesis import given, settings as hypothesis_settings, strategies as st
from ins_sim.core.aiding import kalman
from ins_sim.core.aiding.navigator import AidedNavigator, GNSS, METER
from ins_sim.settings.aided_navigator import AidedNavigatorSettings, FILTERS
from ins_sim.settings.catalogue import build
from ins_sim.core.streams.faults import StreamFault
from ins_sim.core.timeseries.fixes import GnssFix, no_gnss_fix
import numpy as np
import pytest

CYCLES = 50
SECONDS = 12
MOTION = circle()
SAMPLES = samples_of(MOTION, 100 * SECONDS + 1, (0.01, -0.02, 0.0))
METER_FIXES = perfect_fixes(MOTION, 2 * SECONDS, CYCLES, (0.3, -0.2), (0.5, 0.6))
# The printed scheme works on straight legs only: it would reject every fix in the turn of the
# other flight.
LEG = straight()
LEG_SAMPLES = samples_of(LEG, 100 * SECONDS + 1, (0.01, -0.02, 0.0))
LEG_FIXES = [(METER, fix) for fix in perfect_fixes(LEG, 2 * SECONDS, CYCLES, (0.3, -0.2),
                                                   (0.5, 0.6))]


def gnss_fixes(off=(1.0, -2.0, 0.5)):
    """Return GNSS fixes every second with a constant error, m."""
    truth = MOTION.at(np.arange(SECONDS + 1) * 1_000_000_000)
    return [GnssFix(t, lat + off[1] / 6.4e6, lon + off[0] / 3.7e6, height + off[2], tuple(v),
                    (2.0, 2.0, 3.0), (0.1, 0.1, 0.2), arrival_ns=t)
            for t, lat, lon, height, v in zip(
                truth.t_ns.tolist(), truth.lat.tolist(), truth.lon.tolist(),
                truth.height.tolist(), truth.v_n.tolist())]


FIXES = [(METER, fix) for fix in METER_FIXES] + [(GNSS, fix) for fix in gnss_fixes()]


def navigator(name='eskf', **more):
    """Return a navigator with short windows."""
    return AidedNavigator(build(AidedNavigatorSettings, {
        'filter': name, 'window.cycles': CYCLES, 'gnss_model.use': name == 'eskf',
        'meter_model.mounting_sigma_arcmin': 20.0, **more}))


def fly(nav, fixes, samples=SAMPLES):
    """Step through the samples; return the judged fixes."""
    for source, fix in fixes:
        nav.take(source, fix)
    return [taken for sample in samples for taken in nav.step(*sample)]


def late(fixes, delays_ns):
    """Return the fixes with individual delays of arrival."""
    return [(source, replace(fix, arrival_ns=fix.t_ns + d))
            for (source, fix), d in zip(fixes, delays_ns)]


@pytest.mark.parametrize('name', [f for f in FILTERS if f != 'free'])
@pytest.mark.parametrize('seed', range(3))
def test_late_fixes_give_the_solution_of_punctual_ones_to_the_bit(name, seed):
    """Delays of up to four seconds, in any order of arrival, change neither solution nor P."""
    punctual, delayed = navigator(name), navigator(name)
    fixes, samples = (LEG_FIXES, LEG_SAMPLES) if name == 'paper' else (FIXES, SAMPLES)
    fixes = [f for f in fixes if f[0] == METER or name == 'eskf']
    fixes = [f for f in fixes if f[1].t_ns <= (SECONDS - 4) * 10**9]
    taken = fly(punctual, fixes, samples)
    delays = np.random.default_rng(seed).integers(0, 4 * 10**9, len(fixes)).tolist()
    fly(delayed, late(fixes, delays), samples)
    assert len(taken) == len(fixes) and sum(t.outcome.taken for t in taken) > len(fixes) // 2
    assert delayed.solution == punctual.solution
    assert delayed.filter.estimates == punctual.filter.estimates
    if name in ('eskf', 'window_kf'):
        np.testing.assert_array_equal(delayed.filter.covariance, punctual.filter.covariance)


def test_an_innovation_is_that_of_the_instant_of_the_fix():
    """A fix processed 2.345 s late has the innovation and NIS of the fix processed on time."""
    one = METER_FIXES[7]
    punctual = fly(navigator(), [(METER, one)])
    delayed = fly(navigator(), late([(METER, one)], [2_345_000_000]))
    assert delayed[0].outcome == punctual[0].outcome
    assert punctual[0].outcome.nis > 0.0


def test_a_fix_older_than_the_buffer_is_not_taken():
    """A fix older than buffer_s is rejected with its age; the solution is unchanged."""
    nav, free = navigator(buffer_s=2.0), navigator(buffer_s=2.0)
    taken = fly(nav, late(FIXES[:1], [5 * 10**9]))
    fly(free, [])
    assert not taken[0].outcome.taken
    assert 'is 5.000 s old; expected at most buffer_s, 2 s' in taken[0].outcome.reason
    assert nav.solution == free.solution


def test_a_fix_that_comes_twice_is_taken_once():
    """A fix delivered twice is used once; the second is refused as already received."""
    nav, once = navigator(), navigator()
    taken = fly(nav, [FIXES[3], FIXES[3]])
    fly(once, [FIXES[3]])
    assert [t.outcome.taken for t in taken] == [True, False]
    assert 'was already received' in taken[1].outcome.reason
    assert nav.solution == once.solution


def test_a_window_that_the_solution_does_not_cover_is_not_taken():
    """A fix whose window begins before the solution is not used."""
    nav = navigator()
    taken = fly(nav, [FIXES[0], FIXES[1]], SAMPLES[10:])
    assert [t.outcome.taken for t in taken] == [False, True]
    assert taken[0].outcome.reason == 'the solution does not cover the window of the fix'


METER_FIX, GNSS_FIX = METER_FIXES[3], gnss_fixes()[2]
NAN = math.nan


@pytest.mark.parametrize('source, fix, sentence', [
    (METER, replace(METER_FIX, cycles=100), 'averages 100 cycles in 0.5 s; expected 50 cycles in '
     '0.5 s (window.cycles and rate_hz must be the same in velocity_meter and aided_navigator)'),
    (METER, replace(METER_FIX, start_ns=METER_FIX.start_ns - 500_000_000), 'averages 50 cycles in '
     '1 s; expected 50 cycles in 0.5 s'),
    (METER, replace(METER_FIX, start_ns=METER_FIX.start_ns + 10_000_000,
                    end_ns=METER_FIX.end_ns + 10_000_000), 'ends inside a window; expected a '
     'multiple of 0.5 s of motion time'),
    (METER, replace(METER_FIX, velocity=(NAN, 0.0)), 'has a velocity of (nan, 0.0, nan); expected '
     'finite numbers'),
    (METER, replace(METER_FIX, sigma=(0.0, 1.0)), 'has standard deviations of velocity (0.0, '
     '1.0); expected positive ones'),
    (METER, replace(METER_FIX, sigma=(-1.0, 1.0)), 'expected positive ones'),
    (METER, replace(METER_FIX, arrival_ns=0), 'arrives at 0.000000000 s, before its own '
     'instant; expected that instant or later'),
    (GNSS, replace(GNSS_FIX, v_n=(NAN, 0.0, 0.0)), 'has a velocity of (nan, 0.0, 0.0); expected '
     'finite numbers'),
    (GNSS, replace(GNSS_FIX, lat=math.inf), 'has a position of (inf,'),
    (GNSS, replace(GNSS_FIX, lat=2.0), 'has a latitude of 114.592 deg; expected -90 to 90'),
    (GNSS, replace(GNSS_FIX, position_sigma=(1.0, 0.0, 1.0)), 'expected positive ones'),
    (GNSS, replace(GNSS_FIX, velocity_sigma=(1.0, NAN, 1.0)), 'expected positive ones'),
])
def test_what_can_be_no_fix_is_refused_in_one_sentence(source, fix, sentence):
    """An impossible fix is dropped with one message; the solution is as if it had not come."""
    nav, without = navigator(), navigator()
    with pytest.raises(StreamFault) as refusal:
        nav.take(source, fix)
    text = str(refusal.value)
    assert sentence in text and text.startswith(f'{source}: fix at ') and '\n' not in text
    assert not refusal.value.restart
    fly(nav, [])
    fly(without, [])
    assert nav.solution == without.solution


def test_a_fix_from_the_future_is_refused():
    """A fix further ahead of the newest reading than the greatest delay of a fix is rejected."""
    nav = navigator(buffer_s=2.0)
    fly(nav, [], SAMPLES[:100])
    with pytest.raises(StreamFault, match='is from the future: the newest IMU sample is at '
                                          '0.990000000 s; expected a fix at most 2.01 s ahead'):
        nav.take(METER, METER_FIXES[9])
    nav.take(METER, METER_FIXES[4])


def test_an_invalid_fix_says_why():
    """Drop-outs and outages reach the navigator as invalid fixes with a reason."""
    invalid = replace(METER_FIX, velocity=(NAN, NAN), sigma=(NAN, NAN), status='calm water')
    outage = no_gnss_fix(2 * 10**9, 'outage', 2 * 10**9)
    taken = fly(navigator(), [(METER, invalid), (GNSS, outage)])
    assert [t.outcome.reason for t in taken] == ['invalid fix: outage',
                                                 'invalid fix: calm water']


def test_a_gnss_jump_of_a_kilometre_is_gated_and_changes_nothing():
    """A GNSS jump of 1 km is beyond the gate and changes nothing; later fixes are used."""
    fixes = gnss_fixes((0.1, 0.1, 0.0))
    jumped = [replace(f, lat=f.lat + 1000.0 / 6.4e6) if 5 <= k <= 8 else f
              for k, f in enumerate(fixes)]
    nav, without = navigator(), navigator()
    taken = fly(nav, [(GNSS, f) for f in jumped])
    fly(without, [(GNSS, f) for k, f in enumerate(fixes) if not 5 <= k <= 8])
    refused = [t.t_ns // 10**9 for t in taken if not t.outcome.taken]
    print(f'NIS of the jump {taken[6].outcome.nis:.3g}')
    assert refused == [5, 6, 7, 8]
    assert taken[6].outcome.reason == 'its innovation is beyond the gate'
    # Equal except for the ends of the covariance propagation steps.
    np.testing.assert_allclose(nav.solution[3], without.solution[3], atol=1e-6)
    off = math.hypot(nav.solution[0] - without.solution[0], nav.solution[1] - without.solution[1])
    assert off * 6.4e6 < 1e-3


def test_gnss_aids_the_eskf_only():
    """The other filters reject gnss_model.use at construction."""
    with pytest.raises(ValueError, match='gnss_model.use is true with filter window_kf; expected '
                                         'a filter that processes GNSS: eskf'):
        navigator('window_kf', **{'gnss_model.use': True})


number = st.floats(-300.0, 300.0)


@hypothesis_settings(max_examples=40, deadline=None)
@given(st.lists(st.tuples(st.sampled_from(FIXES), number, number,
                          st.floats(1e-6, 1e4), st.integers(0, 3 * 10**9)), max_size=12))
def test_the_covariance_stays_positive_and_the_solution_finite(changes):
    """For any velocity, sigma and delay, without a gate, P stays positive and all is finite."""
    nav = navigator(gate_probability=0.0)
    for (source, fix), x, y, sigma, delay in changes:
        if source == METER:
            fix = replace(fix, velocity=(x, y), sigma=(sigma, sigma))
        else:
            fix = replace(fix, v_n=(x, y, 0.0), velocity_sigma=(sigma,) * 3,
                          position_sigma=(sigma,) * 3)
        nav.take(source, replace(fix, arrival_ns=fix.t_ns + delay))
    for sample in SAMPLES[:600]:
        nav.step(*sample)
    assert kalman.is_covariance(nav.filter.covariance)
    lat, lon, height, v, q = nav.solution
    assert all(map(math.isfinite, (lat, lon, height, *v, *q)))
    assert all(map(math.isfinite, sum(nav.filter.sigmas(), ())))
