"""
Time one piece of work in a checkout of any layout; prints CPU microseconds.

Run: PYTHONPATH=CHECKOUT python benchmarks/probe.py step | start NODE

Used by paired.py, which compares two checkouts; nothing here may depend on where a checkout keeps
its modules.
"""

import importlib
import sys
from time import process_time

STEPS, REPEATS = 5000, 5
LATE = ['gyro.delay_us.x:=1.0', 'gyro.delay_us.y:=2.0', 'gyro.delay_us.z:=3.0',
        'motion.kind:=two_axis']


def find(name, *modules):
    """Return the object with a name from the first of these modules that has it."""
    for module in modules:
        try:
            return getattr(importlib.import_module('ins_sim.' + module), name)
        except (ImportError, AttributeError):
            continue
    raise ImportError(f'{name} is in none of {", ".join(modules)}')


def step_us():
    """Return CPU microseconds of one step of the live IMU and navigator, the best run."""
    import numpy as np
    parameter_files = importlib.import_module('ins_sim.parameter_files')
    make_motion = find('make_motion', 'core.motion.factory', 'core.motions')
    map_frame = find('MapFrame', 'core.earth.frames', 'core.map_frame')
    make_imu = find('make_imu', 'core.sensors.imu.stream', 'core.imu_stream')
    navigator_class = find('Navigator', 'core.navigation.live', 'core.navigator')
    settings = parameter_files.read([], LATE)
    generator = settings.motion_generator
    motion = make_motion(generator.motion, generator.datum, generator.earth)
    truth = motion.at(10_000_000 * np.arange(STEPS))
    pose = [x.tolist() for x in map_frame(generator.datum, True).pose(
        truth.lat, truth.lon, truth.height, truth.v_n, truth.q_nb)]
    t_ns = truth.t_ns.tolist()
    samples = list(zip(t_ns, pose[1], truth.omega_ib_b.tolist(), truth.f_ib_b.tolist()))
    best = float('inf')
    for _ in range(REPEATS):
        try:
            imu = make_imu(settings.imu_sensor)
        except TypeError:
            imu = make_imu(settings.imu_sensor, None)
        navigator = navigator_class(settings.strapdown)
        start = process_time()
        for sample, *place in zip(samples, t_ns, *pose):
            readings = imu.push(*sample)
            navigator.push_truth(*place)
            for reading in readings:
                navigator.push_imu(*reading[:3])
        best = min(best, process_time() - start)
    return 1e6 * best / STEPS


def start_us(node):
    """
    Return CPU microseconds of importing and making a node, in excess of a plain node.

    The plain node is made first, in the same process, so that the scatter of rclpy itself cancels.
    """
    import rclpy
    rclpy.init()
    from nav_msgs.msg import Odometry
    rclpy.create_node('bare').create_publisher(Odometry, 'anything', 10)
    name = ''.join(word.capitalize() for word in node.split('_')) + 'Node'
    start = process_time()
    find(name, f'ros.nodes.{node}', f'ros.{node}_node')()
    return 1e6 * (process_time() - start)


if __name__ == '__main__':
    print(step_us() if sys.argv[1] == 'step' else start_us(sys.argv[2]), flush=True)
