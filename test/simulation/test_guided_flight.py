"""The closed loop offline has the bits of an open run on the truth as flown; refusals."""

from dataclasses import replace
import math

import ins_sim
from ins_sim.cli.main import main
from ins_sim.core.guidance.steering import Steering
from ins_sim.core.motion.factory import make_motion
from ins_sim.core.prediction.predict import predict
from ins_sim.core.simulation.guided_flight import fly
from ins_sim.core.simulation.inertial import simulate
from ins_sim.settings.node import EPOCH_S
from ins_sim.studies.oscillations import half_range
import numpy as np
import pytest
from support.guided.flights import fly as commanded, stirring

FILE = 'guided_flight'


def settings(aided=True, **more):
    """Return the settings of the shipped flight; double underscores in keywords are dots."""
    values = {'duration_s': 6.0, 'window.cycles': 100,
              **{k.replace('__', '.'): v for k, v in more.items()}}
    return ins_sim.read_settings(FILE, values, aided=aided)


def flown(chosen, aided=None):
    """Return the steered motion of SimulationSettings and the GuidedResult."""
    generator = chosen.motion_generator
    motion = make_motion(generator.motion, generator.datum, generator.earth)
    return motion, fly(chosen, motion, aided)


@pytest.mark.parametrize('more', [
    {}, {'filter': 'paper_corrected', 'surrogate__k_z': 0.15},
    {'velocity_meter:attack_angle': 'ins', 'surrogate__sigma_z_m_s': 8.7,
     'gyro__errors__angle_random_walk_deg_sqrt_h': [0.01] * 3, 'gnss_model__use': True},
    {'source': 'motion', 'accelerometer__delay_us__x': -30.0, 'guidance__latency_s': 0.02},
    {'sampling__drop_out_probability': 0.01, 'filter': 'window_kf'}],
    ids=('eskf', 'paper_corrected', 'noise and gnss', 'from the motion, ahead', 'drop-outs'))
def test_the_loop_steers_by_the_solution_of_the_open_run(more):
    """The estimates equal, to the bit, those of ``simulate_aided`` on the motion as flown."""
    run = ins_sim.simulate_aided(settings(**more), twin=False)
    seen, motion = run.run.steered.estimates, run.run.motion
    states, generator = run.states, run.run.settings.motion_generator
    latency_ns = round(1e9 * generator.guidance.latency_s)
    steering = Steering(generator.guidance, motion.route.legs)
    known = dict(zip(states.t_ns.tolist(), zip(states.lat.tolist(), states.lon.tolist(),
                                               states.height.tolist(), states.v_n.tolist())))
    checked = 0
    for k, t_ns in enumerate(seen.t_ns.tolist()):
        if t_ns - latency_ns in known:
            steering.take(t_ns - latency_ns, known[t_ns - latency_ns])
            command = steering.command(t_ns)
            assert (command.z, command.v_z, command.beta) == (
                seen.z[k], seen.v_z[k], seen.command[k])
            checked += 1
    assert checked > 580
    assert np.array_equal(run.run.steered.states.command[1:], seen.command[:-1])


def test_the_strapdown_steers_without_aiding():
    """Without aiding the strapdown solution steers; it drifts by less than 1 mm here."""
    run = ins_sim.simulate(settings(False))
    seen, states = run.steered.estimates, run.steered.states
    assert seen.steers.all()
    assert seen.z == pytest.approx(states.z, abs=2e-3)
    assert run.truth.t_ns[-1] == 6_000_000_000


def test_the_topic_says_which_solution_steers():
    """guidance.topic selects the steering solution; a topic that is not simulated is reported."""
    aided = settings(guidance__topic='ins/odometry', surrogate__k_z=0.5, filter='conventional',
                     duration_s=3.0)
    free, alone = (flown(aided.simulation, chosen)[1] for chosen in (aided, None))
    assert free.notes == alone.notes == ()
    assert np.array_equal(free.states.beta, alone.states.beta)
    other = flown(settings(False, guidance__topic='fused/odometry', duration_s=3.0))[1]
    assert np.array_equal(other.states.beta, alone.states.beta)
    assert other.notes == ('guidance.topic is fused/odometry, which this run does not simulate: '
                           'the vehicle is steered by ins/odometry',)


@pytest.mark.parametrize('aids', [False, True])
def test_a_navigator_that_skips_steps_steers_by_those_it_publishes(aids):
    """With every fifth solution published, the input of the autopilot changes every 50 ms."""
    name = 'aided_navigator' if aids else 'strapdown'
    chosen = settings(aids, duration_s=3.0, **{f'{name}:output_every': 5})
    _, result = flown(chosen.simulation, chosen) if aids else flown(chosen)
    seen = result.estimates
    assert seen.steers.all()
    assert (np.flatnonzero(np.diff(seen.z)) % 5 == 4).all() and len(set(seen.z.tolist())) > 50


def test_a_motion_of_ones_own_fits_the_samples():
    """The control instants of a user's motion are samples of the truth."""
    motion, _ = flown(settings(False, duration_s=1.0))
    chosen = settings(False, duration_s=1.0, rate_hz=75.0, motion__guided__control_rate_hz=75.0)
    with pytest.raises(ValueError, match='the control period of the motion is 10000000 ns; '
                       'expected a multiple of the period of rate_hz, 13333333 ns'):
        fly(chosen, motion)


def test_rates_of_truth_and_control_may_differ():
    """200 Hz with commands at 50 Hz that are 10 ms later give the flight within 0.5 %."""
    fast = flown(settings(False, rate_hz=200.0, motion__guided__control_rate_hz=50.0))[1]
    usual = flown(settings(False))[1]
    assert len(fast.states) == 301
    assert fast.states.z[-1] == pytest.approx(usual.states.z[-1], rel=5e-3)
    assert math.degrees(half_range(usual.states.beta)) > 0.1


def test_turns_are_flown_straight_and_left_behind():
    """In a turn the autopilot is off; on the next leg it reduces the offset to zero."""
    chosen = settings(False, duration_s=42.0, start_s=270.0, motion__route__turn_rate_deg_s=3.0,
                      motion__route__points__latitude_deg=[55.0, 55.5, 55.6],
                      motion__route__points__longitude_deg=[37.0, 37.3, 38.2],
                      motion__guided__offset_m=5.0)
    motion, result = flown(chosen)
    (start, end), = motion.turns
    t = result.estimates.t_ns * 1e-9
    turning = (t >= start) & (t < end)
    assert 271.0 < start and end < 311.0
    assert not result.estimates.command[turning].any()
    assert not result.estimates.steers[turning].any()
    assert result.estimates.steers[~turning].all()
    assert dict(result.counts)['in a turn'] == np.count_nonzero(turning)
    assert result.estimates.z[~turning] == pytest.approx(result.states.z[~turning], abs=5e-3)


def test_delays_are_predicted_on_the_truth_as_flown():
    """
    Twin and prediction hold for delays of 3, 6, 9 us on a motion with command jumps.

    The strapdown rotates the velocity increment of an interval by the attitude at its start, while
    the theory is continuous. The position error is therefore half an interval of exp(-t/0.4)
    behind, 5 ms of 400 at 100 Hz; this falls with the interval. The attitude error has no such
    part.
    """
    off = {}
    for rate_hz in (100.0, 500.0):
        chosen = settings(False, source='motion', gyro__delay_us__x=3.0, gyro__delay_us__y=6.0,
                          gyro__delay_us__z=9.0, duration_s=60.0)
        chosen = replace(chosen, imu_sensor=replace(chosen.imu_sensor, rate_hz=rate_hz),
                         strapdown=replace(chosen.strapdown, rate_hz=rate_hz))
        generator = chosen.motion_generator
        motion = commanded(make_motion(generator.motion, generator.datum, generator.earth), 60.0,
                           stirring)
        run, predicted = simulate(chosen, motion), predict(chosen, motion)
        rows = slice(None, None, round(0.1 * rate_hz))
        for name in ('attitude', 'position'):
            added = (getattr(run.errors, name) - getattr(run.twin, name))[rows]
            wanted = getattr(predicted, name)
            off[name, rate_hz] = (np.abs(added - wanted)[:, :2].max()
                                  / np.abs(added)[:, :2].max())
    print(f'\n{off}')
    assert off['attitude', 500.0] < 1e-3
    assert off['position', 500.0] < 0.25 * off['position', 100.0] < 0.25 * 0.02


@pytest.mark.slow
def test_closure_of_an_hour(figures):
    """
    Ideal readings of the motion at 100 Hz close to 1 cm in an hour.

    The closure through the stream is recorded but not checked.
    """
    for source in ('motion', 'stream'):
        chosen = settings(False, duration_s=3600.0, source=source,
                          motion__route__points__latitude_deg=[55.0, 60.0],
                          motion__route__points__longitude_deg=[37.0, 50.0])
        generator = chosen.motion_generator
        motion = commanded(make_motion(generator.motion, generator.datum, generator.earth), 3600.0)
        closure = np.abs(simulate(chosen, motion).errors.position[:, :2]).max()
        print(f'\nsource {source}: closure {closure:.2e} m')
        figures.record(f'closure.guided.{source}', closure, 'm',
                       *((1e-2, 'asked') if source == 'motion' else ()))
        assert source == 'stream' or closure <= 1e-2


@pytest.mark.parametrize('values, sentence', [
    ({'accelerometer.delay_us.x': -20.0}, 'guidance.latency_s is 0 s with a channel of imu_sensor '
     'that reads 2e-05 s ahead; expected at least 0.01002 s'),
    ({'motion.guided.control_rate_hz': 30.0}, 'control_rate_hz is 30 Hz; expected rate_hz of '
     'motion_generator, 100 Hz, divided by a whole number'),
    ({'sampling.latency_us': 100.0}, 'sampling.latency_us is 100 us; expected 0 with motion.kind '
     'guided'),
    ({'velocity_meter:attack_angle': 'ins', 'strapdown:output_every': 2}, 'output_every is 2 with '
     'motion.kind guided and attack_angle ins; expected 1')], ids=lambda v: '')
def test_what_cannot_be_closed_is_refused_by_the_settings(values, sentence):
    """Settings for which the loop cannot be closed are refused before the start."""
    with pytest.raises(ValueError, match=sentence):
        ins_sim.read_settings(FILE, values, aided=True)


@pytest.mark.parametrize('command, sentence', [
    (['predict'], 'motion.kind is guided; expected another kind: a guided motion depends on '
     'the navigation'),
    (['simulate', '-p', 'duration_s:=5000.0'], 'duration_s is 5000 s; expected at most '),
    (['simulate', '-p', 'duration_s:=0.0'], 'duration_s is 0, endless')], ids=lambda v: v[0])
def test_commands_refuse_in_one_sentence(command, sentence, tmp_path, capsys):
    """Commands refuse such settings with exit code 2 and one message."""
    folder = ['-o', str(tmp_path / 'run')] if command[0] == 'simulate' else []
    assert main([*command[:1], '--params-file', FILE, *command[1:], *folder]) == 2
    assert sentence in capsys.readouterr().err.replace('\n', ' ')


def test_the_command_writes_the_histories(tmp_path, capsys):
    """The command writes histories with the truth as flown, and notes on the loop."""
    assert main(['simulate', '--aided', '--params-file', FILE, '-p', 'duration_s:=3.0', '-p',
                 'window.cycles:=100', '-p', 'guidance.latency_s:=2.0', '-o',
                 str(tmp_path / 'run'), '--bag', str(tmp_path / 'bag')]) == 0
    told = capsys.readouterr().out
    assert 'phase margin of -' in told and 'no solution at 200' in told
    arrays = np.load(tmp_path / 'run' / 'run.npz')
    assert arrays['steered_t_ns'].shape == arrays['steering_z'].shape == (301,)
    assert arrays['steered_z'][0] == 100.0 and arrays['steering_steers'].dtype == bool
    assert ins_sim.open_motion(ins_sim.read_settings(FILE)).known_ns == 0
    with ins_sim.open_bag(tmp_path / 'bag') as bag:
        commands = bag.arrays('guidance/command')
    # The last sample needs no further command.
    assert np.array_equal(commands['stamp_ns'] - 10**9 * EPOCH_S, arrays['steering_t_ns'][:-1])
    assert np.array_equal(commands['vector'], np.stack(
        [arrays[f'steering_{name}'][:-1] for name in ('command', 'z', 'v_z')], axis=1))
