"""The strapdown and its three users: simulated, recorded and aided navigation."""

import random

from ins_sim.core.aiding.corrected_strapdown import CorrectedStrapdown
from ins_sim.core.attitude import quaternion
from ins_sim.core.attitude.integration import KINDS
from ins_sim.core.earth import ellipsoid
from ins_sim.core.navigation.increments import (fixed_rate_increments, integrals,
                                                uneven_increments)
from ins_sim.core.navigation.navigator import InertialNavigator
from ins_sim.core.navigation.recorded import RecordedNavigator
from ins_sim.core.navigation.strapdown import Strapdown
from ins_sim.core.navigation.vertical_channel import (DAMPED, damping, FREE, FROM_TRUTH,
                                                      NO_DAMPING)
from ins_sim.settings.catalogue import build
from ins_sim.settings.strapdown import StrapdownSettings
import pytest

SPIN = ellipsoid.ROTATION_RATE
DT_NS = 10_000_000
PLACE = (0.95, 0.6, 300.0, (50.0, 100.0, 1.0), quaternion.normalise((0.1, 0.2, 0.3, 0.9)))
CHANNELS = {'free': ((FREE, NO_DAMPING), ()),
            'truth': ((FROM_TRUTH, NO_DAMPING), (301.0, 0.5)),
            'damped': ((DAMPED, damping(100.0)), (301.0,))}


def samples(count):
    """Yield stamps, rates and specific forces of a flight with changing motion."""
    draw = random.Random(1)
    for k in range(count):
        yield (5_000_000_000 + k * DT_NS, tuple(draw.gauss(0.0, 0.3) for _ in range(3)),
               (draw.gauss(0.0, 1.0), draw.gauss(0.0, 1.0), draw.gauss(9.8, 1.0)))


def of_increments(count, integrated):
    """Yield stamps, rotation vectors and velocity increments of ``samples``, without the first."""
    last = None
    for t_ns, omega, f in samples(count):
        now = integrals(omega, f, DT_NS * 1e-9)
        if last is not None:
            yield t_ns, *fixed_rate_increments(integrated, now, last)
        last = now


@pytest.mark.parametrize('kind', KINDS)
@pytest.mark.parametrize('channel', CHANNELS)
def test_a_copy_is_a_snapshot(kind, channel):
    """A copy does not change when the original advances, and continues with the same bits."""
    chosen, reference = CHANNELS[channel]
    steps = list(of_increments(200, True))
    whole = Strapdown(5_000_000_000, PLACE, SPIN, *chosen, orientation=kind)
    for step in steps[:100]:
        whole.advance(*step, *reference)
    kept = whole.copy()
    at_copy = kept.solution
    for step in steps[100:]:
        whole.advance(*step, *reference)
    assert kept.solution == at_copy != whole.solution
    for step in steps[100:]:
        kept.advance(*step, *reference)
    assert kept.solution == whole.solution


@pytest.mark.parametrize('integrated', (False, True))
@pytest.mark.parametrize('channel', ('free', 'truth'))
def test_simulated_and_aided_navigation_share_the_strapdown(channel, integrated):
    """Without errors and corrections both have the bits of the strapdown alone."""
    form = 'integrated' if integrated else 'rotation_vector'
    navigator = InertialNavigator(build(StrapdownSettings, {
        'vertical.channel': channel, 'input': form}))
    (options, reference), truth = CHANNELS[channel], (*PLACE[:2], 301.0, (0.0, 0.0, 0.5), PLACE[4])
    (t_ns, omega, f), *rest = samples(300)
    navigator.step(t_ns, omega, f, PLACE)
    aided = CorrectedStrapdown(t_ns, omega, f, DT_NS * 1e-9, PLACE, SPIN, integrated, options[0])
    alone = Strapdown(t_ns, PLACE, SPIN, *options)
    for sample, increment in zip(rest, of_increments(300, integrated)):
        navigator.step(*sample, truth)
        aided.take(*sample, *reference)
        alone.advance(*increment, *reference)
        assert navigator.solution == aided.solution == alone.solution


@pytest.mark.parametrize('channel', ('free', 'damped'))
def test_recorded_navigation_shares_the_strapdown(channel):
    """Readings that are increments give the bits of the strapdown without a second sample."""
    options, reference = CHANNELS[channel]
    (t_ns, omega, f), *rest = samples(300)
    recorded = RecordedNavigator('rotation_vector', SPIN, PLACE,
                                 100.0 if channel == 'damped' else None)
    recorded.step(t_ns, omega, f)
    alone = Strapdown(t_ns, PLACE, SPIN, *options)
    for sample, increment in zip(rest, of_increments(300, False)):
        alone.advance(*increment, *reference)
        assert recorded.step(*sample, 301.0) == alone.solution


def test_even_and_uneven_increments_agree():
    """At a fixed rate both functions differ by rounding only."""
    last, now = ((o, f) for _, o, f in samples(2))
    dt = 0.01
    even = fixed_rate_increments(True, integrals(*now, dt), integrals(*last, dt))
    uneven = uneven_increments('integrated', last, now, dt, dt)
    for a, b in zip(even, uneven):
        assert a == pytest.approx(b, rel=1e-14, abs=1e-16)


def test_a_correction_keeps_the_attitude_that_it_sets():
    """The solution keeps an attitude that was set, to the bit, until the next interval."""
    (t_ns, omega, f), *rest = samples(50)
    ins = CorrectedStrapdown(t_ns, omega, f, 0.01, PLACE, SPIN, True)
    assert ins.solution == PLACE
    for sample in rest:
        ins.take(*sample)
    before = ins.solution
    ins.correct(position=(1.0, 2.0, 3.0), velocity=(0.1, 0.2, 0.3))
    assert ins.solution[3] == tuple(a - b for a, b in zip(before[3], (0.1, 0.2, 0.3)))
    assert ellipsoid.offset(*ins.solution[:3], before[:3]) == pytest.approx((1.0, 2.0, 3.0),
                                                                            abs=1e-6)
    assert ins.solution[4] == pytest.approx(before[4], abs=1e-15)
    assert ins.v_b == quaternion.rotate_back(ins.q_nb, ins.v)
