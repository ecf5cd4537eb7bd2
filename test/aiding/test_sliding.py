"""The conventional filter with sliding windows: punctual and late fixes, offline and live."""

from dataclasses import replace

from support.aided.flights import DT_NS, samples_of, straight
from support.aided.streams import run_stream, scene
import numpy as np
import pytest

from ins_sim.core.aiding.navigator import AidedNavigator, METER
from ins_sim.core.earth.rates import body_velocity
from ins_sim.core.streams.faults import StreamFault
from ins_sim.core.timeseries.fixes import VelocityFix
from ins_sim.settings.aided_navigator import AidedNavigatorSettings, FILTERS
from ins_sim.settings.catalogue import build

CYCLES, STEP, COUNT = 50, 10, 601
LEG = straight()
SAMPLES = samples_of(LEG, COUNT)
SLIDING = (('filter', 'conventional'), ('window.slide_cycles', 50), ('gnss_model.use', False),
           ('gain_per_s', 0.7))


def sliding_fixes(lead=0):
    """Return perfect fixes of the leg, every STEP cycles from the first complete window on."""
    v_b = body_velocity(LEG.at(np.arange(COUNT) * DT_NS))[:, :2]
    return [VelocityFix((end - CYCLES) * DT_NS, end * DT_NS, CYCLES,
                        tuple(v_b[end - CYCLES:end + 1].mean(axis=0).tolist()), (1.0, 1.0),
                        arrival_ns=end * DT_NS)
            for end in range(CYCLES + lead, COUNT, STEP)]


def navigator(**more):
    """Return a conventional navigator with sliding windows."""
    return AidedNavigator(build(AidedNavigatorSettings, {
        'filter': 'conventional', 'window.cycles': CYCLES, 'window.slide_cycles': STEP,
        'initial.velocity_sigma_m_s': 1.0, 'initial.tilt_sigma_mrad': 0.0,
        'initial.azimuth_sigma_mrad': 0.0, 'meter_model.bias_x_m_s': 0.0, **more}))


def fly(nav, fixes, samples=SAMPLES):
    """Return the judged fixes, and the velocity error (n, 2) at every sample."""
    judged, errors = [], []
    for fix in fixes:
        nav.take(METER, fix)
    for sample in samples:
        judged += nav.step(*sample)
        errors.append(np.subtract(nav.solution[3][:2], sample[3][3][:2]))
    return judged, np.array(errors)


@pytest.mark.parametrize('gain', [0.5, 2.0, 15.0])
def test_a_fix_takes_away_its_part_of_the_error(gain):
    """
    Each fix multiplies the error by 1 - K_v T_s, from the first complete window on.

    Bounds: gravity, Coriolis and the rotation of the level axes change 1 m/s by 1e-4 in 6 s.
    """
    judged, errors = fly(navigator(gain_per_s=gain), sliding_fixes())
    assert [j.t_ns // DT_NS for j in judged if j.outcome.taken] == list(range(CYCLES, COUNT, STEP))
    fixes = np.maximum(0, (np.arange(COUNT) - CYCLES) // STEP + 1)
    expected = errors[0] * (1.0 - gain * STEP * 0.01) ** fixes[:, None]
    assert np.abs(errors[0]).min() > 0.1
    np.testing.assert_allclose(errors, expected, atol=5e-4)


def test_a_window_that_began_before_the_solution_is_not_taken():
    """Only windows that begin with the solution or later are used."""
    judged, _ = fly(navigator(), sliding_fixes(), SAMPLES[25:])
    refused = [j.t_ns // DT_NS for j in judged if not j.outcome.taken]
    assert refused == [50, 60, 70]
    assert judged[0].outcome.reason == 'the solution does not cover the window of the fix'


@pytest.mark.parametrize('seed', range(2))
def test_late_fixes_give_the_bits_of_punctual_ones(seed):
    """Delays of up to two seconds, in any order of arrival, give the same bits."""
    fixes = [fix for fix in sliding_fixes() if fix.end_ns <= 400 * DT_NS]
    punctual, delayed = navigator(), navigator()
    judged, _ = fly(punctual, fixes)
    delays = np.random.default_rng(seed).integers(0, 200, len(fixes)) * DT_NS
    fly(delayed, [replace(fix, arrival_ns=fix.end_ns + d)
                  for fix, d in zip(fixes, delays.tolist())])
    assert delayed.solution == punctual.solution
    assert len(judged) == len(fixes) and all(j.outcome.taken for j in judged)


def test_on_streams_it_is_the_offline_run_in_any_order():
    """In any order the live stream gives the offline run; tolerances as in test_stream."""
    chosen, offline, streams = scene(*SLIDING)
    outputs, faults, stream = run_stream(streams, np.random.default_rng(0), chosen)
    again, _, _ = run_stream(streams, np.random.default_rng(1), chosen)
    assert not faults and again == outputs
    assert [o[0] for o in outputs] == offline.states.t_ns.tolist()
    off = np.abs(np.array([o[2] for o in outputs]) - np.stack(
        [offline.errors.attitude, offline.errors.velocity, offline.errors.position],
        axis=1)).max(axis=(0, 2))
    assert off[2] < 8e-9 and off[1] < 1e-11 and off[0] < 1e-14
    # Fixes every 0.5 s from 2 s to 12 s; the last ones arrive after the end.
    taken = [j.t_ns for j in stream.judged if j.outcome.taken]
    assert taken == [j.t_ns for j in offline.judged if j.outcome.taken]
    assert taken == [2_000_000_000 + k * 500_000_000 for k in range(20)]


@pytest.mark.parametrize('name', [n for n, entry in FILTERS.items() if not entry.takes_sliding])
def test_filters_that_follow_a_window_refuse_those_that_overlap(name):
    """A filter that needs whole windows rejects sliding ones and names the parameter."""
    with pytest.raises(ValueError, match=f'window.slide_cycles is 10 with filter {name}, which '
                                         'needs windows that do not overlap; expected 0, or '
                                         'filter free or conventional'):
        navigator(filter=name)
    navigator(filter=name, **{'window.slide_cycles': CYCLES})


def test_an_unstable_gain_is_refused():
    """gain_per_s must be less than 2 divided by the time between fixes; filter free ignores it."""
    with pytest.raises(ValueError, match='gain_per_s is 20 1/s, and window.slide_cycles is 10; '
                                         'expected less than 20 1/s'):
        navigator(gain_per_s=20.0)
    navigator(filter='free', gain_per_s=20.0)


def test_fixes_that_end_between_slides_are_refused():
    """Fixes of a meter that slides by a different step are rejected."""
    nav = navigator()
    with pytest.raises(StreamFault, match='ends inside a window; expected a multiple of 0.1 s of '
                                          'motion time .window.slide_cycles must be the same'):
        nav.take(METER, sliding_fixes(5)[0])
    judged, errors = fly(nav, [])
    assert not judged and np.isfinite(errors).all()
