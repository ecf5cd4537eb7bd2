"""The real-time factor set while the generator runs: next sample, no burst, no pause."""

import pytest
from support.hostile.fed_nodes import FedNodes
from support.nodes.asked import ask, value_of

from ins_sim.ros.lock_step import pacing

pytest.importorskip('rclpy')

FACTOR = 'pacing.real_time_factor'
DT_S = 0.01
RUN = {'rate_hz': 100.0, 'motion.kind': 'static', 'duration_s': 0.0}
TICK_S = 1e-3


class Generator(FedNodes):
    """A generator with a simulated clock; ``sent(ticks)`` lets time pass, ms."""

    def __init__(self, **parameters):
        super().__init__({'motion_generator': {**RUN, **parameters}})

    def __enter__(self):
        super().__enter__()
        self.node = self.nodes['motion_generator']
        self.node._pace.anchor(0)
        return self

    def sent(self, ticks):
        """Return the number of samples sent in some ms, at most one burst per ms."""
        counts = []
        for _ in range(ticks):
            before = self.node._next
            self.node._advance(None)
            counts.append(self.node._next - before)
            self.clock.pass_by(TICK_S)
        return counts

    def set(self, factor):
        """Set the factor; return '' or the reason for the refusal."""
        return ask(self.node, {FACTOR: factor})[0]


@pytest.mark.parametrize('ticks', [1000, 1003, 1007, 1009])
@pytest.mark.parametrize('factor', [0.1, 0.5, 2, 8.0])
def test_time_goes_on_without_a_burst(factor, ticks, ros_domain):
    """
    After a change at any phase no samples are closer than 1 ms, and none is late.

    The number of samples in a second follows the new factor, and then the old one.
    """
    with Generator() as generator:
        assert sum(generator.sent(ticks)) == 100 + (ticks > 1000)
        assert generator.set(factor) == ''
        counts = generator.sent(1000)
        assert max(counts) == 1 and sum(counts) == pytest.approx(100 * factor, abs=1)
        longest = max(1.0, 1.0 / factor) * DT_S
        assert counts.index(1) * TICK_S <= longest + TICK_S
        assert value_of(generator.node, FACTOR) == float(factor)
        said = '\n'.join(generator.logs['motion_generator'].kept)
        assert f'{FACTOR} is now {float(factor)} from t = {1.0 + DT_S * (ticks > 1000):.9f} s on' \
            in said
        assert said.count(f'with a real_time_factor of {factor:g} the stamps do not follow the '
                          'wall clock: other nodes need use_sim_time: true and /clock') == 1
        assert generator.set(1.0) == ''
        counts = generator.sent(1000)
        assert max(counts) == 1 and sum(counts) == pytest.approx(100, abs=1)


def test_a_generator_that_was_late_does_not_catch_up_at_once(ros_domain):
    """Samples that were due before the change are sent at the new pace."""
    with Generator() as generator:
        generator.sent(100)
        generator.clock.pass_by(5.0)
        assert generator.set(2.0) == ''
        assert generator.sent(11) == [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]


def test_a_factor_of_zero_needs_lock_step(ros_domain):
    """A factor of 0 without lock-step is refused; with it the clock is off, and later on again."""
    with Generator() as generator:
        generator.sent(10)
        assert generator.set(0.0) == (
            f'{FACTOR} is 0 without pacing.lock_step; expected more than 0, because lock-step '
            'cannot be switched on during a run')
        assert value_of(generator.node, FACTOR) == 1.0
    with Generator(**{'pacing.lock_step': True, 'pacing.window': 20}) as generator:
        generator.node._lock._acked['strapdown'] = 0
        generator.sent(10)
        assert generator.node._next == 1
        assert generator.set(0) == ''
        generator.sent(1)
        assert generator.node._next == 21
        generator.node._lock._acked['strapdown'] = 1000
        assert generator.set(0.5) == ''
        assert sum(generator.sent(1000)) == pytest.approx(50, abs=1)


@pytest.mark.parametrize('value', ['fast', -1.0, float('nan'), float('inf'), [1.0], True, 1e7])
def test_nonsense_is_refused(value, ros_domain):
    """An invalid factor gives one message with the parameter; the pace does not change."""
    with Generator() as generator:
        assert sum(generator.sent(100)) == 10
        reason = generator.set(value)
        assert FACTOR in reason and '\n' not in reason and 'Traceback' not in reason
        assert sum(generator.sent(100)) == 10


def test_before_the_run_and_after_a_pause(ros_domain):
    """The factor applies from the first sample on, and nothing is sent during a pause."""
    with Generator() as generator:
        assert generator.set(4) == ''
        assert 'from the first sample on' in generator.logs['motion_generator'].kept[-1]
        assert sum(generator.sent(1000)) == pytest.approx(400, abs=1)
        generator.node.pause(True)
        assert generator.set(2.0) == '' and not any(generator.sent(100))
        generator.node.pause(False)
        assert sum(generator.sent(1000)) == pytest.approx(200, abs=1)


def test_the_pace_of_a_clock(monkeypatch):
    """The rest of a period is stretched: 0.3 of a period stays 0.3 of one at a factor of 10."""
    now = [0.0]
    monkeypatch.setattr(pacing, 'time', type('Clock', (), {'monotonic': lambda: now[0]}))
    pace = pacing.Pace(1.0, DT_S)
    pace.anchor(0)
    now[0] = 0.007
    pace.set_factor(10.0, 1)
    assert pace.wait_s(1) == pytest.approx(0.0003)
    pace.set_factor(0.0, 1)
    assert pace.allowed() == float('inf')
    pace.set_factor(1.0, 7)
    assert pace.wait_s(7) == pytest.approx(0.0, abs=1e-15)
    assert pace.wait_s(8) == pytest.approx(DT_S)
