"""Stability limits of the closed loop: compared with published ones, and with eigenvalues."""

from dataclasses import replace
import math

from hypothesis import given, settings as hypothesis_settings, strategies as st
import numpy as np
import pytest
from scipy.integrate import solve_ivp
from support.guided.lateral_loops import block, loop, paper, PERIOD_S, sliding

from ins_sim import parameter_files, resources
from ins_sim.core.guidance.aided_margin import aided_margin, aided_margin_sentence
from ins_sim.core.guidance.linear_loop import growth, limits
from ins_sim.core.guidance.linear_plant import after_period
from ins_sim.core.guidance.margin import phase_margin
from ins_sim.core.guidance.steering import margin_sentence

INF = math.inf
# K_v: k_z and rad/s at N = 10, 100, 1000, as published for commands that are held.
SLIDING = {0.1: (('.819', '.336'), ('.899', '.248'), ('1.31', '.095')),
           0.5: (('.203', '.526'), ('.232', '.326'), ('.534', '.118')),
           1.0: (('.141', '.614'), ('.158', '.345'), ('.440', '.122')),
           5.0: (('.102', '.758'), ('.101', '.364'), ('.366', '.126'))}
# K: positive limit, rad/s, negative limit.
PAPER = {0.1: (('.134', '.720', '-4.39'), ('.734', '.364', '-1.95'), ('inf', None, '-3.17')),
         0.344: (('.104', '.965', '-1.59'), ('.200', '.549', '-.536'), ('1.63', '.092', '-.804')),
         1.0: (('.101', '1.11', '-.717'), ('.086', '.812', '-.160'), ('.382', '.138', '-.167'))}
LENGTHS = (10, 100, 1000)


def meets(value, printed):
    """
    Return whether a number agrees with the printed one within 0.6 of its last digit.

    0.5 is rounding; the mean over a window, by trapezoids or exactly, changes it by 4e-4.
    """
    digits = len(printed.split('.')[1])
    return abs(value - float(printed)) <= 0.6 * 10.0 ** -digits


@pytest.mark.parametrize('k_v', SLIDING)
def test_published_limits_with_windows_that_slide(k_v, figures):
    """Limits for sliding windows agree to all printed digits with a held command."""
    for cycles, (k_z, omega) in zip(LENGTHS, SLIDING[k_v]):
        held, ramped = (limits(loop(ramps=r), sliding(cycles, k_v)) for r in (False, True))
        print(f'N {cycles}, K_v {k_v}: {held.positive}, linear command {ramped.positive}')
        assert meets(held.positive.k_z, k_z) and meets(held.positive.frequency, omega)
        assert held.unstable == ramped.unstable == 0
        assert ramped.positive.k_z == pytest.approx(held.positive.k_z, rel=0.01)
        figures.record(f'loop_limit.sliding.{cycles}.{k_v:g}', ramped.positive.k_z, '',
                       float(k_z), 'simulation and theory of the specification')


@pytest.mark.parametrize('gain', PAPER)
def test_published_limits_of_paper_corrected(gain):
    """
    Positive and negative limits agree with the published ones.

    At N = 1000, K = 0.1 no limit was published; there is one at 7.3, far beyond any real meter.
    """
    for cycles, (k_z, omega, negative) in zip(LENGTHS, PAPER[gain]):
        found = limits(loop(ramps=False), paper(cycles, gain))
        print(f'N {cycles}, K {gain}: {found}')
        assert meets(found.negative.k_z, negative) and found.unstable == 0
        if k_z == 'inf':
            assert found.positive.k_z > 5.0
        else:
            assert meets(found.positive.k_z, k_z) and meets(found.positive.frequency, omega)


@pytest.mark.parametrize('latency, k_z, unstable', [(0, '.158', 0), (5, '.156', 0),
                                                    (20, '.151', 2)])
def test_published_limits_with_latency(latency, k_z, unstable):
    """
    For N = 100, K_v = 1 the limits agree for latencies of 0, 0.05 and 0.2 s.

    At 0.2 s the limit of the slow mode is as published, but a fast mode grows for any k_z: the
    solution used for steering is corrected with a mean of the past.
    """
    found = limits(loop(latency, ramps=False), sliding(100, 1.0))
    assert meets(found.positive.k_z, k_z) and found.unstable == unstable
    assert (growth(loop(latency), sliding(100, 1.0), 0.0).growth > 0.0) is bool(unstable)


def test_a_long_latency_moves_limits_as_a_delay_does():
    """
    With one window per correction and a latency of 1 s, limits are roots of the growth.

    The system has 100 states.
    """
    slow = loop(100, ramps=False)
    found = limits(slow, block(1000, 0.05))
    assert found.unstable == 0
    at = found.positive.k_z
    assert growth(slow, block(1000, 0.05), 0.99 * at).growth < 0.0 < growth(
        slow, block(1000, 0.05), 1.01 * at).growth


def test_windows_every_ten_cycles_suffice_and_every_fifty_do_not():
    """With windows every 10 cycles the limit is 0.153 (0.158); every 50, no loop is stable."""
    assert meets(limits(loop(ramps=False), sliding(100, 1.0, 10)).positive.k_z, '.153')
    assert limits(loop(ramps=False), sliding(100, 1.0, 50)).unstable == 1


@pytest.mark.parametrize('cycles, gain', [(10, '1.02'), (50, '.417'), (100, '.354'),
                                          (200, '.369'), (500, '.339'), (1000, '.932')])
def test_the_block_filter_is_unstable_above_a_gain_without_any_error(cycles, gain, figures):
    """At k_z = 0 the critical gain is as published, by bisection; below it the loop is quiet."""
    low, high = 0.0, 2.0
    assert growth(loop(ramps=False), block(cycles, 0.05), 0.0).growth < 0.0
    while high - low > 1e-5:
        middle = 0.5 * (low + high)
        if growth(loop(ramps=False), block(cycles, middle), 0.0).growth < 0.0:
            low = middle
        else:
            high = middle
    figures.record(f'loop_limit.block_gain.{cycles}', low, '', float(gain))
    assert meets(low, gain)


def test_growth_just_inside_the_limit():
    """At k_z = 0.15 the mode decays at 0.0048 1/s with 0.345 rad/s, as published."""
    mode = growth(loop(ramps=False), sliding(100, 1.0), 0.15)
    assert meets(mode.growth, '-.0048') and meets(mode.frequency, '.345')


@hypothesis_settings(deadline=None, max_examples=10)
@given(cycles=st.sampled_from([10, 40]), step=st.sampled_from([1, 2, 10]),
       k_v=st.floats(0.05, 10.0), kind=st.sampled_from(['sliding', 'paper']),
       latency=st.integers(0, 12), ramps=st.booleans())
def test_limits_are_where_eigenvalues_leave_the_unit_circle(cycles, step, k_v, kind, latency,
                                                            ramps):
    """Inside a limit all modes decay, outside one grows; the number of modes at zero agrees."""
    aiding = sliding(cycles, k_v, step) if kind == 'sliding' else paper(cycles, min(1.9, k_v))
    lateral = loop(latency, ramps)
    found = limits(lateral, aiding)
    assert (growth(lateral, aiding, 0.0).growth > 0.0) is (found.unstable > 0)
    if found.unstable:
        return
    for limit in (found.positive, found.negative):
        if limit is not None and abs(limit.k_z) < 50.0:
            inside, outside = (growth(lateral, aiding, part * limit.k_z) for part in (0.999,
                                                                                      1.001))
            assert inside.growth < 0.0 < outside.growth
            assert inside.frequency == pytest.approx(limit.frequency, rel=0.01)


@pytest.mark.parametrize('ramps', [True, False])
def test_a_period_of_the_plant(ramps):
    """
    Sideslip, rate and offset after a control period agree with integration.

    This holds for both kinds of command.
    """
    lateral = loop(ramps=ramps)._replace(period_s=0.3)
    z, v, beta, old, new = 3.0, -2.0, 0.05, 0.1, -0.07

    def slopes(t, x):
        command = old + (new - old) * t / 0.3 if ramps else new
        return x[1], -lateral.side_force * x[2], (command - x[2]) / lateral.lag_s

    found = solve_ivp(slopes, (0.0, 0.3), (z, v, beta), rtol=1e-11, atol=1e-12).y[:, -1]
    np.testing.assert_allclose(after_period(lateral) @ (z, v, beta, old, new), found, atol=1e-9)


@pytest.mark.parametrize('k_v', [0.3, 1.0, 10.0])
def test_the_phase_margin_is_used_up_where_the_loop_becomes_unstable(k_v):
    """The latency at which modes begin to grow is the phase margin, within one period."""
    aiding = sliding(100, k_v)
    margin = aided_margin(loop(), aiding)
    most = math.floor(margin.delay_s / PERIOD_S)
    print(f'K_v {k_v}: {margin}, {most} periods')
    assert not growth(loop(most), aiding, 0.0).growth > 0.0
    assert growth(loop(most + 1), aiding, 0.0).growth > 0.0
    assert aided_margin(loop(most), aiding).margin > 0.0
    assert aided_margin(loop(most + 1), aiding).margin < 0.0


def test_the_phase_margin_with_a_slow_navigator_is_that_of_the_autopilot():
    """At K_v = 0.001 1/s the margin is ``margin.phase_margin`` with a command a period late."""
    lateral, slow = loop(), aided_margin(loop(), sliding(100, 0.001))
    alone = phase_margin((lateral.k1, lateral.k2), lateral.side_force, lateral.lag_s, PERIOD_S)
    # The crossover is between two of 20001 frequencies, and K_v lowers it slightly.
    assert slow.margin == pytest.approx(alone, abs=5e-3)


@pytest.mark.parametrize('latency_s, gain, said', [(0.15, 1.0, False), (0.2, 1.0, True),
                                                   (0.2, 0.2, False)])
def test_a_latency_that_the_corrections_do_not_bear_is_said(latency_s, gain, said):
    """A warning is given for a latency that exact navigation would tolerate with 1 s to spare."""
    settings = parameter_files.read_aided([resources.config('guided_flight')], [
        'filter:=conventional', 'window.cycles:=100', 'window.slide_cycles:=1',
        f'gain_per_s:={gain}', f'guidance.latency_s:={latency_s}'])
    generator = settings.simulation.motion_generator
    assert margin_sentence(generator.guidance, generator.motion.guided) is None
    sentence = aided_margin_sentence(generator, settings.aided_navigator)
    assert (sentence is not None) is said
    if said:
        assert sentence.startswith('guidance.latency_s is 0.2 s, which with filter conventional '
                                   'and gain_per_s 1 leaves the loop a phase margin of -1')
        assert 'as with 0.15 s or less' in sentence and '\n' not in sentence
    other = replace(settings.aided_navigator, filter='free')
    assert aided_margin_sentence(generator, other) is None
