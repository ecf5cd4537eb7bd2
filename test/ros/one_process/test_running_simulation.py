"""`running_simulation` lets tests of a user's filter step a simulation."""

import os
import subprocess
import sys

import ins_sim
from ins_sim.testing import RunningSimulation, start_simulation  # noqa: F401
import numpy as np
import pytest
from support.places import ROOT

pytest.importorskip('rclpy')

# A filter under test, as a process or as a class: it acknowledges each reading.
FILTER = '''
from geometry_msgs.msg import Vector3Stamped
import rclpy
from rclpy.node import Node
from sensor_msgs.msg import Imu


class EchoingFilter(Node):
    def __init__(self, **options):
        super().__init__('echoing_filter', **options)
        self._publisher = self.create_publisher(Vector3Stamped, 'filter/rate', 10)
        self.create_subscription(Imu, 'imu/data_raw', self._on_imu, 10)

    def _on_imu(self, reading):
        self._publisher.publish(Vector3Stamped(header=reading.header,
                                               vector=reading.angular_velocity))


if __name__ == '__main__':
    rclpy.init()
    rclpy.spin(EchoingFilter())
'''
VALUES = {'rate_hz': 100.0, 'duration_s': 1.0, 'gyro.delay_us.y': 1.0}


def vector(v):
    """Return a Vector3 as a list."""
    return [v.x, v.y, v.z]


def test_readings_and_truth_are_those_of_the_offline_run(start_simulation):  # noqa: F811
    """Stamps and readings equal those of the offline run to the bit; then no step remains."""
    sim = start_simulation('motion_2', VALUES, topics=['ins/odometry', 'truth/imu'])
    steps = list(sim.steps())
    run = ins_sim.simulate(ins_sim.read_settings('motion_2', {**VALUES, 'source': 'stream'}))
    stamps = np.array([step.stamp_ns for step in steps])
    assert (stamps - stamps[0]).tolist() == (run.imu.t_ns - run.imu.t_ns[0]).tolist()
    assert [vector(s.imu.angular_velocity) for s in steps] == run.imu.omega.tolist()
    assert [vector(s.imu.linear_acceleration) for s in steps] == run.imu.f.tolist()
    assert all(s.truth.header.stamp == s.newest('ins/odometry').header.stamp for s in steps)
    assert sim.step() is None and len(list(sim.steps())) == 0


def test_two_at_once_do_not_hear_each_other():
    """Two simulations have separate domains; a service call changes only one of them."""
    from std_srvs.srv import SetBool
    values = {'rate_hz': 100.0, 'motion.kind': 'racetrack'}
    options = {'topics': ['gnss/fix'], 'aided': True}
    with RunningSimulation((), values, **options) as one, \
            RunningSimulation((), values, **options, namespace='uav') as other:
        assert one.domain != other.domain
        assert one.call(SetBool, 'gnss/outage', data=True).success
        fixes = [[step.newest('gnss/fix') for step in sim.steps(210) if step['gnss/fix']]
                 for sim in (one, other)]
    assert len(fixes[0]) == len(fixes[1]) == 3
    assert [fix.status.status for fix in fixes[0]] == [-1] * 3
    assert all(fix.status.status >= 0 for fix in fixes[1])


@pytest.mark.live
def test_a_filter_that_is_a_process():
    """A filter process may join at any time; every step then waits for its answer."""
    from geometry_msgs.msg import Vector3Stamped
    with RunningSimulation((), VALUES, answers={'filter/rate': Vector3Stamped}) as sim:
        with subprocess.Popen([sys.executable, '-c', FILTER], env=sim.environment,
                              stderr=subprocess.DEVNULL) as process:
            try:
                steps = list(sim.steps(50))
            finally:
                process.terminate()
        assert [vector(s.newest('filter/rate').vector) for s in steps] == [
            vector(s.imu.angular_velocity) for s in steps]


def test_a_filter_that_is_a_node_of_the_test():
    """
    A filter that is a node of the test is waited for too, with some readings lost.

    A missing filter gives one message.
    """
    from geometry_msgs.msg import Vector3Stamped
    names = {'__name__': 'filter'}
    exec(FILTER, names)
    values = {**VALUES, 'sampling.drop_out_probability': 0.2}
    with RunningSimulation((), values, answers={'filter/rate': Vector3Stamped},
                           timeout_s=5.0) as sim:
        node = names['EchoingFilter'](context=sim.context)
        sim.add_node(node)
        steps = list(sim.steps(60))
        node.destroy_node()
        assert any(s.imu is None for s in steps)
        assert all(s.imu is None or vector(s.newest('filter/rate').vector) == vector(
            s.imu.angular_velocity) for s in steps)
    with RunningSimulation((), VALUES, answers={'filter/rate': Vector3Stamped},
                           timeout_s=0.3) as sim:
        with pytest.raises(TimeoutError, match='no message on filter/rate with the stamp'):
            sim.step()


@pytest.mark.parametrize('arguments, sentence', [
    ({'topics': ['imu/data']}, "unknown topic 'imu/data'; the nearest known one is"),
    ({'topics': ['gnss/fix']}, 'no node of this simulation publishes gnss/fix; expected aided'),
    ({'values': {'rate': 3.0}}, "unknown parameter 'rate'; the nearest known one is 'rate_hz'"),
])
def test_what_is_wrong_is_one_sentence(arguments, sentence):
    """Unknown or unpublished topics and unknown parameters raise a ValueError."""
    with pytest.raises(ValueError, match=sentence):
        with RunningSimulation(**arguments):
            pass
    # No process and no file remain.
    with RunningSimulation((), VALUES) as sim:
        assert sim.step().imu is not None


def test_it_needs_no_pytest():
    """The context manager works with any test framework."""
    code = ('import sys; sys.modules["pytest"] = None\n'
            'from ins_sim.testing import RunningSimulation, start_simulation\n'
            'with RunningSimulation() as sim: print(sim.step().stamp_ns)')
    subprocess.run([sys.executable, '-c', code], check=True,
                   env={**os.environ, 'PYTHONPATH': str(ROOT)})
