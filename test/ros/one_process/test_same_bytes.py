"""The nodes in one process publish the same bytes as separate nodes."""

from collections import defaultdict
from functools import partial

from ins_sim.messages import topics
from ins_sim.messages.cdr import stamp_of
import pytest
from support.aided.streams import VALUES as FLIGHT
from support.hostile.fed_nodes import FedNodes

pytest.importorskip('rclpy')

AIDS = ('aided_navigator', 'velocity_meter', 'gnss')
NODES = ('strapdown', 'imu_sensor', 'motion_generator')
PUBLISHED = (*topics.DATA, *topics.AIDING, *topics.GUIDANCE, topics.IMU_PARITY)
STEP_S = 0.002
FAST = {'pacing.real_time_factor': 0.0, 'rate_hz': 100.0, 'seed': 3, 'time.epoch_s': 0}
AIDED = {**{name: list(value) if isinstance(value, tuple) else value
            for name, value in FLIGHT.items()},
         **FAST, 'source': 'stream', 'aided': True, 'duration_s': 5.0, 'outages.start_s': [2.0],
         'outages.end_s': [3.0],
         'pacing.required': ['strapdown', 'velocity_meter', 'gnss', 'aided_navigator']}
GUIDED = {**AIDED, 'motion.kind': 'guided', 'motion.guided.offset_m': 5.0,
          'guidance.latency_s': 0.03, 'surrogate.k_z': 0.15, 'filter': 'paper_corrected',
          'gnss_model.use': False, 'window.latency_ms': 0.0}
RUNS = {
    'plain': {**FAST, 'duration_s': 5.0},
    'late channels, noise, lost readings': {
        **FAST, 'duration_s': 5.0, 'gyro.delay_us.x': 1500.0, 'gyro.delay_us.y': -700.0,
        'gyro.errors.angle_random_walk_deg_sqrt_h': [0.1] * 3,
        'sampling.drop_out_probability': 0.02},
    'fewer outputs': {**FAST, 'duration_s': 2.0, 'output_every': 5},
    'tuned gyros': {**FAST, 'duration_s': 3.0, 'gyro.model': 'dtg', 'output': 'integrated',
                    'input': 'integrated', 'gyro.dtg.arrangement': 'turned'},
    'aided': AIDED,
    'guided': GUIDED,
    'one unanswered step': {**FAST, 'duration_s': 0.5, 'pacing.window': 1},
}


def apart(values):
    """Return {topic: {stamp: bytes}} of nodes joined by a test bus, in lock-step."""
    sent = defaultdict(dict)
    names = (*(AIDS if values.get('aided') else ()), *NODES)
    with FedNodes({name: values for name in names}) as fed:
        fed.bus.listen = lambda name, data: sent[name].__setitem__(stamp_of(data), data)
        generator, ended = fed.nodes['motion_generator'], []
        generator._finish = ended.append
        if values.get('aided'):
            # The graph does not contain the publishers of the test bus.
            fed.nodes['aided_navigator']._joined = True
        while not ended:
            generator._advance(None)
            fed.bus.drive()
            fed.clock.pass_by(STEP_S)
    return dict(sent)


def together(values):
    """Return {topic: {stamp: bytes}} of the nodes in one process."""
    import rclpy
    from rclpy.executors import SingleThreadedExecutor
    from rclpy.parameter import Parameter
    from ins_sim.core.numerics.compilation import plain_only
    from ins_sim.ros.nodes.simulation import SimulationNode
    from ins_sim.ros.process.runtime import Stop
    context, stop, sent = rclpy.Context(), Stop(), defaultdict(dict)
    context.init()
    executor = SingleThreadedExecutor(context=context)
    node = SimulationNode(stop, context=context, parameter_overrides=[
        Parameter(name, value=value) for name, value in values.items()])
    try:
        for topic in PUBLISHED:
            node.hand_over.listen(node, topic, partial(_keep, sent[topic.name]))
        executor.add_node(node)
        with plain_only():
            node.run(executor, stop)
        assert stop.code == 0
    finally:
        executor.shutdown()
        node.destroy_node()
        context.try_shutdown()
    return {name: messages for name, messages in sent.items() if messages}


def _keep(messages, data):
    messages[stamp_of(data)] = data


@pytest.mark.parametrize('name', RUNS)
def test_the_bytes_of_separate_nodes(name, ros_domain):
    """In lock-step every message on every topic has the bytes of separate nodes."""
    expected, sent = apart(RUNS[name]), together(RUNS[name])
    for topic, messages in expected.items():
        if topic not in ('sim/ack', '/clock'):
            assert sent[topic] == messages, topic
    print({topic: len(messages) for topic, messages in sent.items()})
