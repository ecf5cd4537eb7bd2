"""The line that each node logs at its start: what it simulates, or that it is ideal."""

from ins_sim import parameter_files, resources
from ins_sim.ros.process.told import told
from ins_sim.settings.by_node import AIDING, ALL_NODES, NODES
import pytest


def lines(names=(), *assignments):
    """Return {node: line} of shipped files and assignments."""
    paths = [resources.config(name) for name in names]
    built = parameter_files.read_nodes(paths, assignments, {**NODES, **AIDING}, ALL_NODES)
    return {node: told(node, settings) for node, settings in built.items()}


def test_defaults():
    """With defaults the nodes log a racetrack, and an IMU without any error."""
    said = lines()
    assert said['motion_generator'] == ('motion racetrack, truth at 100 Hz from 0 s to 3600 s, in '
                                        'real time')
    assert said['imu_sensor'] == 'IMU at 100 Hz, rotation_vector: ideal, no delays'
    assert said['strapdown'] == ('strapdown for an IMU at 100 Hz, rotation_vector; vertical '
                                 'channel truth, attitude by quaternion')
    assert said['velocity_meter'].startswith('velocity meter, mode surrogate, windows of 1000 ')
    assert said['gnss'] == ('GNSS at 1 Hz, noise [1.5, 1.5, 3] m and [0.05, 0.05, 0.1] m/s (east, '
                            'north, up)')
    assert said['aided_navigator'] == (
        'filter eskf for an IMU at 100 Hz, aided by the velocity meter (gnss_model.use: true lets '
        'GNSS aid too)')


def test_an_instrument_with_delays():
    """Values are logged in the units of data sheets, as one value if the axes are equal."""
    said = lines(['racetrack', 'delays_2_1_3us', 'imu_tactical_mems'], 'rate_hz:=200.0',
                 'accelerometer.errors.bias_ug:=[1.0, 2.0, -3.0]', 'sampling.jitter_us:=20.0')
    assert said['imu_sensor'] == (
        'IMU at 200 Hz, rotation_vector: gyro ARW 0.04 deg/sqrt(h), turn-on bias 7 deg/h, bias '
        'instability 0.38 deg/h, scale factor 500 ppm, 13 more, delays [2, 1, 3] us; '
        'accelerometer VRW 0.03 m/s/sqrt(h), turn-on bias 1700 ug, bias [1, 2, -3] ug, bias '
        'instability 38 ug, scale factor 300 ppm, 12 more; jitter us 20')


@pytest.mark.parametrize('assignments, node, part', [
    (['pacing.real_time_factor:=10.0'], 'motion_generator', '10 times real time'),
    (['motion.kind:=static', 'duration_s:=0.0', 'pacing.real_time_factor:=0.0'],
     'motion_generator', 'motion static, truth at 100 Hz from 0 s without end, as fast as the '
     'consumers acknowledge, in lock-step'),
    (['gyro.model:=dtg', 'output:=integrated'], 'imu_sensor', 'integrated: two dynamically tuned '
     'gyros (tactical)'),
    (['initial.source:=alignment'], 'strapdown', 'strapdown for any IMU, rotation_vector without '
     'truth, start from alignment; '),
    (['gyro.delay_us.y:=1.0'], 'imu_sensor', 'rotation_vector: gyro delays [0, 1, 0] us'),
    (['gnss_model.use:=true', 'meter_model.use:=false'], 'aided_navigator', 'aided by GNSS'),
    (['outages.start_s:=[1.0]', 'outages.end_s:=[2.0]'], 'gnss', 'up), outages: 1')])
def test_what_is_not_the_default(assignments, node, part):
    """Each of these values is logged if it differs from the default."""
    assert part in lines((), *assignments)[node]


def test_every_node_that_simulates_has_a_line():
    """Every node has a line, except the recorder and the process of all nodes."""
    for node in set(ALL_NODES) - {'recorder', 'simulation'}:
        line = told(node, ALL_NODES[node]())
        assert line and line.isprintable()
