"""The closed loop over DDS: six nodes in lock-step reproduce the offline run."""

import ins_sim
from ins_sim import graph, resources
from ins_sim.core.earth.frames import MapFrame
from ins_sim.messages import topics
import numpy as np
import pytest
from support.live import Chain, Listener, warnings_of_loss

pytest.importorskip('rclpy')
pytestmark = pytest.mark.live

FILES = ('default', 'guided_flight')
LENGTH_S = 4.0
# A meter with errors, so that the guidance loop has errors to correct.
VALUES = {'filter': 'paper_corrected', 'velocity_meter:surrogate.k_z': 0.15,
          'duration_s': LENGTH_S, 'guidance.latency_s': 0.03, 'motion.guided.offset_m': 5.0}
# Set for each node, because a node section of a file overrides what is set for all nodes.
LIVE = {'motion.guided.offset_m': 5.0, 'aided_navigator:filter': 'paper_corrected',
        'velocity_meter:surrogate.k_z': 0.15,
        'motion_generator:duration_s': LENGTH_S, 'motion_generator:guidance.latency_s': 0.03,
        'velocity_meter:window.cycles': 100, 'aided_navigator:window.cycles': 100}
HEARD = (topics.TRUTH_ODOMETRY, topics.AIDED_ODOMETRY)
REQUIRED = '[strapdown, velocity_meter, gnss, aided_navigator, listener]'
ORDER = tuple(process.name for process in (*graph.AIDING, *graph.PROCESSES))


def lock_step(domain, folder, order):
    """Run six processes; return {topic: {stamp: doubles}} and their log messages."""
    folder.mkdir()
    files = [word for name in FILES for word in ('--params-file', str(resources.config(name)))]
    listener, chain = Listener(domain, HEARD, later=topics.GUIDANCE), Chain(domain, folder)
    try:
        nodes = {name: chain.start(name, {**LIVE, 'motion_generator:pacing.real_time_factor': 0.0,
                                          'motion_generator:pacing.required': REQUIRED}, files)
                 for name in order}
        generator = nodes[graph.MASTER]
        listener.poll_until(lambda: generator.poll() is not None)
        last_ns = round(LENGTH_S * 1e9)
        listener.poll_until(lambda: last_ns in listener.heard[topics.AIDED_ODOMETRY.name])
        texts = [chain.text(process) for process in nodes.values()]
        assert set(chain.end().values()) == {0}, texts
        warnings = warnings_of_loss(texts)
        assert not warnings, warnings
    finally:
        chain.end()
        listener.close()
    return listener.heard


def test_lock_step_is_the_offline_run(ros_domain, tmp_path):
    """
    Command, truth and solution agree with the offline run to rounding, twice with equal bits.

    A position is a sum of a few terms of the radius of the Earth, each rounded to 1e-9 m; the
    command changes by 0.0125 rad/m times that, and the solution follows the changed truth.
    """
    heard = lock_step(ros_domain, tmp_path / 'first', ORDER)
    run = ins_sim.simulate_aided(
        ins_sim.read_settings('guided_flight', {**VALUES, 'window.cycles': 100}, aided=True),
        twin=False)
    seen = run.run.steered.estimates
    commands = heard[topics.GUIDANCE_COMMAND.name]
    got = np.array([commands[t] for t in sorted(commands)])
    # The last period is not flown.
    assert sorted(commands) == seen.t_ns[:-1].tolist()
    expected = np.stack([seen.command, seen.z, seen.v_z], axis=1)[:-1]
    off = np.abs(got - expected).max(axis=0)
    print(f'\ncommand, z and v_z off by {off}; largest {np.abs(expected).max(axis=0)}')
    assert off[0] < 2e-10 and off[1] < 1.6e-8 and off[2] < 1e-9
    # The command stays below its limit of 8 deg and reaches at least half a degree.
    assert 0.01 < np.abs(expected[-1, 0]) and np.abs(expected[:, 0]).max() < 0.13
    frame = MapFrame(run.run.settings.motion_generator.datum, True)
    for record, topic in ((run.run.truth, topics.TRUTH_ODOMETRY), (run.states,
                                                                   topics.AIDED_ODOMETRY)):
        r_m, q_mb, v_b = frame.pose(record.lat, record.lon, record.height, record.v_n,
                                    record.q_nb)
        stamps = heard[topic.name]
        assert sorted(stamps) == record.t_ns.tolist()
        got = np.array([stamps[t] for t in sorted(stamps)])
        at = sum(b - a for a, b in topic.writer().runs if b <= 43)
        place, turn, speed = (np.abs(got[:, a:b] - wanted).max() for (a, b), wanted in zip(
            ((0, 3), (3, 7), (at, at + 3)), (r_m, q_mb, v_b)))
        print(f'{topic.name}: {place:.1e} m, {turn:.1e}, {speed:.1e} m/s')
        assert place < 1.6e-8 and turn < 1e-10 and speed < 1e-8
    again = lock_step(ros_domain, tmp_path / 'again', ORDER[::-1])
    assert again == heard
