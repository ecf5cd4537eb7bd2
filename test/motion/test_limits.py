"""Motions beyond the limits of the simulation are refused with one message."""

import math

import numpy as np
import pytest
from support.studies import run_offline, settings, streamed

from ins_sim.cli.main import main
from ins_sim.core.motion.factory import make_motion
from ins_sim.core.sensors.imu.stream import make_imu
from ins_sim.core.streams.faults import StreamFault

SECOND = 1_000_000_000
POLAR = {'motion.kind': 'cruise', 'datum.latitude_deg': 89.9}
SPINNING = {'motion.kind': 'two_axis', 'motion.two_axis.psi_rate_rad_s': 100.0,
            'motion.two_axis.gamma_rate_rad_s': 0.0, 'motion.theta_deg': 0.0, 'rate_hz': 25.0,
            'duration_s': 2.0}


def words(values):
    """Return the command-line arguments that set the values."""
    return [word for name, value in values.items() for word in ('-p', f'{name}:={value}')]


@pytest.mark.parametrize('values, at', [
    # The cruise flies north at half of its 100 m/s or more; 0.1 deg are 11.1 km.
    (POLAR, 'the motion crosses a pole before'),
    ({'motion.kind': 'sinusoids', 'motion.sinusoids.position_m': '[0.0, 50000.0, 0.0]',
      'datum.latitude_deg': -89.9}, 'the motion crosses a pole before')])
@pytest.mark.parametrize('verb', ['simulate', 'predict'])
def test_a_latitude_past_the_pole_is_refused(verb, values, at, tmp_path, capsys):
    """A motion that passes the pole at any time is refused before the run."""
    more = ['-o', str(tmp_path / 'run')] if verb == 'simulate' else []
    assert main([verb, *more, *words(values)]) == 2
    said = capsys.readouterr().err
    assert at in said and ('expected at most 90 deg north or south: choose a datum farther from '
                           'the pole') in said
    assert said.count('\n') == 1 and not (tmp_path / 'run').exists()


def test_a_motion_near_the_pole_is_flown():
    """A motion of 6 km that starts at latitude 89.9 deg, 11 km from the pole, is accepted."""
    chosen = settings({**POLAR, 'motion.kind': 'racetrack'}).motion_generator
    motion = make_motion(chosen.motion, chosen.datum, chosen.earth)
    t_ns = np.arange(400) * SECOND
    assert np.degrees(motion.at(t_ns).lat).max() < 90.0


def test_a_generator_without_an_end_looks_ahead():
    """An endless flight across the pole is rejected before its first message."""
    from ins_sim.ros.lock_step.truth_source import TruthSource
    chosen = settings({**POLAR, 'duration_s': 0.0})
    with pytest.raises(ValueError, match='crosses a pole'):
        TruthSource(chosen.motion_generator)


def test_half_a_turn_a_sample_is_refused(tmp_path, capsys):
    """100 rad/s at 25 Hz is 4 rad per sample, which would be read as 4 - 2 pi: -57 rad/s."""
    sentence = ('turns at 100 rad/s, 4 rad in an interval of the IMU; expected less than half a '
                'turn, 3.14 rad: raise rate_hz of imu_sensor above 31.83 Hz, or set output '
                'integrated')
    given = words({**SPINNING, 'source': 'motion'})
    assert main(['simulate', *given, '-o', str(tmp_path / 'run')]) == 2
    assert sentence in capsys.readouterr().err
    chosen = settings(SPINNING)
    generator = chosen.motion_generator
    with pytest.raises(ValueError, match='turns at 100 rad/s, 4 rad'):
        make_imu(chosen.imu_sensor, make_motion(generator.motion, generator.datum,
                                                generator.earth))


@pytest.mark.parametrize('block', [True, False])
def test_half_a_turn_a_sample_on_a_stream_of_truth(block):
    """A truth at 1000 Hz turns by 0.1 rad per step, but by 4 rad per sample at 25 Hz: refused."""
    chosen = settings({**SPINNING, 'rate_hz': 1000.0, 'duration_s': 0.1}, source='stream')
    slow = settings(SPINNING, source='stream').imu_sensor
    generator = chosen.motion_generator
    imu = make_imu(slow)
    with pytest.raises(StreamFault, match='truth at 0.* turns at 100 rad/s, 4 rad'):
        if block:
            motion = make_motion(generator.motion, generator.datum, generator.earth)
            imu.advance(motion.at(np.arange(101) * (SECOND // 1000)))
        else:
            for sample in streamed(chosen)[1]:
                imu.push(*sample)


def test_a_fast_rotation_is_read_right():
    """At 20 turns per second and 1 kHz the readings are right, for both kinds of output."""
    fast = {**SPINNING, 'motion.two_axis.psi_rate_rad_s': 40.0 * math.pi}
    for rate_hz, output in ((1000.0, 'rotation_vector'), (25.0, 'integrated')):
        chosen = settings({**fast, 'rate_hz': rate_hz, 'output': output, 'input': output},
                          duration_s=0.5)
        from ins_sim.core.simulation.inertial import imu_blocks
        generator = chosen.motion_generator
        motion = make_motion(generator.motion, generator.datum, generator.earth)
        omega = np.concatenate([b.omega for b in imu_blocks(chosen, motion)])[1:]
        # The rotation of the Earth adds at most 7.3e-5 rad/s.
        assert np.abs(omega[:, 2] - 40.0 * math.pi).max() < 1e-4


@pytest.mark.parametrize('gravity', ['free_air', 'second_order'])
def test_the_physics_holds_at_the_limits(gravity):
    """
    A minute at 7.9 km/s, or at 20 turns per second, closes to 1 mm.

    The flights are at 400 km and 500 km of height. The position rule is of second order in the
    step, as for any flight.
    """
    route = {'motion.kind': 'route', 'motion.route.points.latitude_deg': (50.0, 55.0, 56.0),
             'motion.route.points.longitude_deg': (0.0, 20.0, 40.0), 'vertical.channel': 'free',
             'motion.route.airspeed_m_s': 7900.0, 'motion.route.height_m': 400e3,
             'motion.route.turn_rate_deg_s': 0.05}
    rocket = {**SPINNING, 'motion.two_axis.psi_rate_rad_s': 1.0, 'datum.height_m': 500e3,
              'motion.two_axis.gamma_rate_rad_s': 40.0 * math.pi, 'rate_hz': 1000.0}
    for values, length_s in ((route, 60.0), (rocket, 5.0)):
        errors = run_offline(settings({**values, 'earth.gravity': gravity},
                                      duration_s=length_s), twin=False).errors
        assert np.abs(errors.position).max() < 1e-3
        assert np.abs(errors.attitude).max() < 1e-12
