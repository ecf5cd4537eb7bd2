"""The messages of a run, of nodes that are fed one by one and of those in one process."""

from collections import defaultdict
from functools import partial

from ins_sim.messages import topics
from ins_sim.messages.cdr import stamp_of

from .hostile.fed_nodes import FedNodes

AIDED = ('aided_navigator', 'velocity_meter', 'gnss')
NODES = ('strapdown', 'imu_sensor', 'motion_generator')
PUBLISHED = (*topics.DATA, *topics.AIDING, *topics.GUIDANCE, topics.IMU_PARITY)
STEP_S = 0.002


def apart(values):
    """Return {topic: {stamp: bytes}} of nodes joined by a bus of the tests, in lock-step."""
    sent = defaultdict(dict)
    names = (*(AIDED if values.get('aided') else ()), *NODES)
    with FedNodes({name: values for name in names}) as fed:
        fed.bus.listen = lambda name, data: sent[name].__setitem__(stamp_of(data), data)
        generator, ended = fed.nodes['motion_generator'], []
        generator._finish = ended.append
        if values.get('aided'):
            # the graph knows no publishers of the bus
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
