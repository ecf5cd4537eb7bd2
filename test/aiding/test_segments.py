"""Samples in blocks or one by one, with compiled or plain functions, give the same bits."""

from dataclasses import replace

from ins_sim.core.aiding import segment
from ins_sim.core.aiding.filters.base import AidingFilter, FixOutcome
from ins_sim.core.aiding.navigator import AidedNavigator
from ins_sim.core.numerics import compilation
from ins_sim.core.simulation.aided_run import navigate_aided, Reported
from ins_sim.core.timeseries.histories import ImuSamples
from ins_sim.settings.aided_navigator import AidedNavigatorSettings, FilterEntry, FILTERS
from ins_sim.settings.catalogue import build
import numpy as np
import pytest
from support.aided.flights import circle, perfect_fixes, samples_of

CYCLES, SECONDS = 50, 13
MOTION = circle()
SAMPLES = samples_of(MOTION, 100 * SECONDS + 1, (0.01, -0.02, 0.0))
IMU = ImuSamples(np.array([s[0] for s in SAMPLES]), np.array([s[1] for s in SAMPLES]),
                 np.array([s[2] for s in SAMPLES]))
TRUTH = MOTION.at(IMU.t_ns)
# Fixes on time, and fixes so late that the navigator goes back over several snapshots.
FIXES = [replace(fix, arrival_ns=fix.t_ns + late) for fix, late in zip(
    perfect_fixes(MOTION, 2 * SECONDS, CYCLES, (0.3, -0.2), (0.5, 0.6)),
    np.random.default_rng(5).choice((0, 0, 120_000_000, 2_500_000_000), 2 * SECONDS).tolist())]
VARIANTS = {'truth': {}, 'free': {'vertical.channel': 'free'},
            'integrated': {'input': 'integrated', 'output_every': 7}}


def settings_of(name, **values):
    """Return AidedNavigatorSettings with short windows."""
    return build(AidedNavigatorSettings, {'filter': name, 'window.cycles': CYCLES, **values})


def one_by_one(settings):
    """Return states, sigmas and JudgedFixes of samples passed one by one, as in a live run."""
    navigator = AidedNavigator(settings)
    waiting = [(f.arrival_ns, 'velocity_meter', f) for f in FIXES]
    waiting.sort(key=lambda entry: entry[:2])
    rows, sigmas, judged = [], [], []
    for sample in SAMPLES:
        navigator.take_arrived(waiting, sample[0])
        judged += navigator.step(*sample)
        lat, lon, height, v, q_nb = navigator.solution
        rows.append((lat, lon, height, *v, *q_nb))
        sigmas.append(navigator.filter.sigmas() or ((np.nan,) * 3,) * 3)
    return (np.array(rows)[::settings.output_every], np.array(sigmas)[::settings.output_every],
            tuple(judged))


def in_blocks(settings, cuts):
    """Return the states, sigmas and JudgedFixes when samples are passed in blocks."""
    edges = [0, *sorted(cuts), len(IMU)]
    blocks = [(IMU[a:b], TRUTH[a:b]) for a, b in zip(edges[:-1], edges[1:]) if a < b]
    run = navigate_aided(settings, blocks, Reported(FIXES))
    states, errors = run.states, run.errors
    return (np.column_stack((states.lat, states.lon, states.height, states.v_n, states.q_nb)),
            np.stack((errors.position_sigma, errors.velocity_sigma, errors.attitude_sigma),
                     axis=1), run.judged)


@pytest.mark.parametrize('name', FILTERS)
@pytest.mark.parametrize('variant', VARIANTS)
@pytest.mark.parametrize('tier', ('plain', 'compiled'))
def test_blocks_have_the_bits_of_single_samples(name, variant, tier, monkeypatch):
    """Random blocks and late fixes give solutions, sigmas and used fixes with the same bits."""
    if tier == 'compiled':
        if compilation.compiled(segment.fly) is None:
            pytest.skip('Numba is not installed')
        monkeypatch.setattr(compilation, 'PLAIN_SAMPLES', 0)
    else:
        monkeypatch.setattr(compilation, 'numba', lambda: None)
    settings = settings_of(name, **VARIANTS[variant])
    rows, sigmas, judged = one_by_one(settings)
    rng = np.random.default_rng(7)
    for cuts in ((), rng.integers(0, len(IMU), 9).tolist(), range(300, 340)):
        again, sigmas_again, judged_again = in_blocks(settings, cuts)
        np.testing.assert_array_equal(again, rows)
        np.testing.assert_array_equal(sigmas_again, sigmas)
        assert judged_again == judged


class CountingFilter(AidingFilter):
    """Processes every sample itself, as a user's filter may."""

    def __init__(self, settings, ins):
        super().__init__(settings, ins)
        self.steps, self.path = 0, 0.0

    def step(self, ins, before, delta_v, dt):
        """Count the sample, and integrate the forward velocity."""
        super().step(ins, before, delta_v, dt)
        self.steps += 1
        self.path += dt * before[1][0]

    def update_velocity(self, ins, fix):
        """Remove half of the velocity error."""
        forward, left = self.residual(fix)
        ins.correct(velocity=(0.5 * forward, 0.5 * left, 0.0))
        return FixOutcome((forward, left, self.path, self.steps))


def test_a_filter_that_follows_every_sample_is_stepped(monkeypatch):
    """A filter that overrides ``step`` gets every sample, and again after late fixes."""
    monkeypatch.setitem(FILTERS, 'counting', FilterEntry(f'{__name__}:CountingFilter'))
    monkeypatch.setattr('ins_sim.core.aiding.navigator.filter_class', lambda _: CountingFilter)
    settings = replace(settings_of('conventional'), filter='counting')
    rows, _, judged = one_by_one(settings)
    again, _, judged_again = in_blocks(settings, (17, 600))
    np.testing.assert_array_equal(again, rows)
    assert judged_again == judged
    assert judged[3].outcome.innovation[3] == judged[3].t_ns // 10_000_000


@pytest.mark.parametrize('bad', (123, 456))
def test_a_reading_that_is_no_number_is_named_and_the_solution_starts_anew(bad):
    """A reading that is not finite is named anywhere in a block; on_fault reset continues."""
    f = IMU.f.copy()
    f[bad, 1] = np.nan
    imu = ImuSamples(IMU.t_ns, IMU.omega, f)
    run = navigate_aided(settings_of('eskf'), [(imu, TRUTH)], Reported(FIXES))
    assert run.faults[0].startswith(
        f'the solution at {bad / 100:.9f} s is not finite; expected finite readings')
    # The solution starts anew at the bad sample, whose reading is not integrated.
    assert len(run.states) == len(IMU) and np.isfinite(run.states.v_n).all()
