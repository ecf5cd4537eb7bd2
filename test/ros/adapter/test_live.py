"""Another simulator that publishes only Odometry drives an IMU and a strapdown."""

import sys

import numpy as np
import pytest
from support.live import Chain, GUARD_S, Listener
from support.other_simulators import AdaptedRun, OtherSimulator, PLACE
from support.places import ROOT

from ins_sim.core.simulation.inertial import navigate_blocks
from ins_sim.messages import topics
from ins_sim.messages.convert import imu_block, odometry_one, truth_one
from ins_sim.core.earth.frames import MapFrame

pytest.importorskip('rclpy')
pytestmark = pytest.mark.live

WANTED = (topics.TRUTH_IMU, topics.TRUTH_ODOMETRY, topics.TRUTH_FIX, topics.IMU_RAW,
          topics.INS_ODOMETRY)
STAND_IN = ROOT / 'test' / 'ros' / 'adapter' / 'stand_in.py'
MOTION, RATE_HZ, LENGTH_S = 'racetrack', 50.0, 6.0


def expected():
    """Return {topic name: {stamp_ns: doubles}} of the same run without nodes."""
    simulator = OtherSimulator(MOTION, RATE_HZ, LENGTH_S)
    _, truths = simulator.adapted()
    found = {topic.name: {} for topic in WANTED}
    for truth in truths:
        for topic, runs in zip(topics.TRUTH, truth_one(truth)):
            if topic in WANTED:
                found[topic.name][truth.t_ns] = sum(map(tuple, runs), ())
    run, settings = AdaptedRun(simulator, truths), simulator.settings.strapdown
    frame = MapFrame(settings.datum, True)
    for topic, rows in imu_block(run.imu).items():
        found[topic.name].update(zip(run.imu.t_ns.tolist(), map(tuple, rows.tolist())))
    for _, states, _ in navigate_blocks(settings, run, [run.imu]):
        omega = run.imu.omega[np.searchsorted(run.imu.t_ns, states.t_ns)].tolist()
        for t_ns, *solution, rate in zip(*(getattr(states, name).tolist() for name in (
                't_ns', 'lat', 'lon', 'height', 'v_n', 'q_nb')), omega):
            pose, twist = odometry_one(frame, solution, rate)
            found[topics.INS_ODOMETRY.name][t_ns] = (*pose, *twist)
    return found


def without_covariances(numbers):
    """Return pose and twist from the doubles of ins/odometry."""
    return numbers[:7] + numbers[43:49]


@pytest.mark.parametrize('pace', ['lock_step', 'real_time'])
def test_another_simulator_drives_imu_and_strapdown(pace, ros_domain, tmp_path):
    """In lock-step and in real time all numbers equal those of the run without nodes."""
    chain, listener = Chain(ros_domain, tmp_path), Listener(ros_domain, WANTED)
    chain.environment['PYTHONPATH'] += f':{ROOT / "test"}'
    place = {**PLACE, 'vertical.channel': 'free'}
    waits = {'pacing.lock_step': True, 'pacing.required': '[strapdown,listener]'}
    try:
        for node in ('strapdown', 'imu_sensor'):
            chain.wait_text(chain.start(node, place), 'waiting for')
        adapter = chain.start('truth_adapter', {**place, **(waits if pace == 'lock_step' else {})})
        chain.wait_text(adapter, 'waiting for')
        listener.poll_for(1.0)
        stand_in = chain.run('stand_in', [sys.executable, str(STAND_IN), MOTION, str(RATE_HZ),
                                          str(LENGTH_S), pace])
        wanted = expected()
        listener.poll_until(lambda: stand_in.poll() is not None, GUARD_S)
        listener.poll_until(lambda: all(max(wanted[name]) in heard
                                        for name, heard in listener.heard.items()))
        said = chain.text(adapter)
    finally:
        codes = chain.end()
        listener.close()
    assert set(codes.values()) == {0}, codes
    assert 'the twist is believed' in said and 'jump' not in said and 'gap' not in said, said
    for name, values in wanted.items():
        heard = listener.heard[name]
        for t_ns, numbers in values.items():
            got = heard.get(t_ns, ())
            if name == topics.INS_ODOMETRY.name:
                got = without_covariances(got)
            assert got == numbers, (name, t_ns)
        assert set(heard) == set(values), name
