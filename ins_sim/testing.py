"""
Simulate an IMU with truth step by step, to test a filter (docs/how_to/test_your_filter.md).

The simulation runs in the process of the test and in a separate ROS domain. The filter can be a
function, a node of the same process, or another process that subscribes to the topics.
"""

from collections import deque
from contextlib import ExitStack
from functools import partial
import os
from pathlib import Path
import tempfile
import time

from ins_sim import parameter_files
from ins_sim.api.inputs import read_settings
from ins_sim.messages import topics
from ins_sim.messages.cdr import stamp_of
from ins_sim.settings.suggest import nearest_name

try:
    from pytest import fixture
except ImportError:
    # The context manager works without pytest.
    def fixture(function):
        """Return the function itself."""
        return function

PUBLISHED = {topic.name: topic for topic in (*topics.DATA, *topics.AIDING, *topics.GUIDANCE,
                                             topics.IMU_PARITY)}
ALWAYS = (topics.TRUTH_ODOMETRY.name, topics.IMU_RAW.name)
# Interval at which sample 0 is sent again until it is answered, s.
REPEAT_S = 0.1
DEPTH = 1000


class Step:
    """
    One sample of the truth, and the messages that followed from it.

    Attributes
    ----------
    stamp_ns : int
        Stamp of the truth, ns.
    truth : nav_msgs.msg.Odometry
        Pose in map, twist in base_link.
    readings : list of sensor_msgs.msg.Imu
        IMU messages of this step, oldest first: one if truth and IMU have the same rate, none if
        a sample was lost or is late.
    """

    def __init__(self, stamp_ns, messages):
        self.stamp_ns = stamp_ns
        self._messages = messages
        self.truth = self.newest(ALWAYS[0])
        self.readings = self[ALWAYS[1]]

    @property
    def imu(self):
        """Return the last reading of this step, or None."""
        return self.readings[-1] if self.readings else None

    def __getitem__(self, name):
        """Return the messages of a topic in this step, oldest first."""
        return self._messages[name]

    def newest(self, name):
        """Return the last message of a topic in this step, or None."""
        return self._messages[name][-1] if self._messages[name] else None


class RunningSimulation:
    """
    A simulation that advances when ``step`` is called; use it as a context manager.

    Parameters
    ----------
    names : str, path or list of these
        Parameter files, as for ``ins_sim.read_settings``.
    values : mapping, optional
        Values by the name of the parameter, which override the files.
    topics : sequence of str
        Names of topics to collect in addition to truth/odometry and imu/data_raw.
    answers : mapping of str to message class, optional
        Output topics of the filter under test: each step waits for the message that has the stamp
        of the last IMU message.
    aided : bool
        Whether velocity meter, GNSS and aided navigator run as well.
    namespace : str
        Namespace of the nodes.
    timeout_s : float
        Longest time to wait for an answer.

    Attributes
    ----------
    domain : int
        The ROS domain.
    environment : dict
        Environment variables for other processes that take part.
    context : rclpy.Context
        Context for nodes of this process that take part.

    Raises
    ------
    ValueError
        If a parameter or a topic does not exist.
    TimeoutError
        If an answer does not arrive; the message names the topic.
    RuntimeError
        If a node ends the simulation, as with on_fault: stop.
    """

    def __init__(self, names=(), values=None, topics=(), answers=None, aided=False, namespace='',
                 timeout_s=30.0):
        # With a fixed epoch each run of a test has the same stamps.
        self._settings = read_settings(names, {'time.epoch': 'fixed', **(values or {})}, aided)
        self._aided, self._namespace, self._timeout_s = aided, namespace.strip('/'), timeout_s
        self._answers = dict(answers or {})
        for name in topics:
            if name not in PUBLISHED:
                raise ValueError(f'topics: unknown topic {name!r}; the nearest known one is '
                                 f'{nearest_name(name, PUBLISHED)!r}')
        self._names = (*ALWAYS, *(name for name in topics if name not in ALWAYS))
        self._count = 0

    def __enter__(self):
        with ExitStack() as stack:
            self._start(stack)
            self._stack = stack.pop_all()
        return self

    def __exit__(self, *exception):
        self._stack.close()

    def _start(self, stack):
        from ins_sim.ros.process.domains import own_domain
        from ins_sim.ros.process.serving import serve_ready
        from ins_sim.ros.transport.repairs import use_profile
        use_profile()
        os.environ.setdefault('ROS_AUTOMATIC_DISCOVERY_RANGE', 'LOCALHOST')
        self.domain = stack.enter_context(own_domain())
        self.environment = {**os.environ, 'ROS_DOMAIN_ID': str(self.domain)}
        import rclpy
        from rclpy.executors import SingleThreadedExecutor
        self.context = rclpy.Context()
        folder = Path(stack.enter_context(tempfile.TemporaryDirectory()))
        self.context.init(self._arguments(folder), domain_id=self.domain)
        stack.callback(self.context.try_shutdown)
        self._executor = SingleThreadedExecutor(context=self.context)
        stack.callback(self._executor.shutdown)
        self._serve = partial(serve_ready, self._executor)
        self._make_nodes(stack)

    def _arguments(self, folder):
        dump = parameter_files.dump_aided if self._aided else parameter_files.dump
        (folder / 'parameters.yaml').write_text(dump(self._settings), encoding='utf-8')
        words = ['--ros-args', '--params-file', str(folder / 'parameters.yaml')]
        if self._aided:
            words += ['-p', 'aided:=true']
        return words + (['-r', f'__ns:=/{self._namespace}'] if self._namespace else [])

    def _make_nodes(self, stack):
        import rclpy
        from ins_sim.ros.nodes.simulation import SimulationNode
        from ins_sim.ros.process.runtime import Stop
        self._stop = Stop()
        self._simulation = simulation = SimulationNode(self._stop, context=self.context)
        stack.callback(simulation.destroy_node)
        self.node = rclpy.create_node('tester', context=self.context)
        stack.callback(self.node.destroy_node)
        for node in (self.node, simulation, *simulation.members):
            self._executor.add_node(node)
        self._came = {name: deque(maxlen=DEPTH) for name in self._names}
        listen = simulation.hand_over.listen
        for name, came in self._came.items():
            if not listen(self.node, PUBLISHED[name], came.append):
                raise ValueError(f'topics: no node of this simulation publishes {name}; expected '
                                 'aided=True for the topics of the aiding nodes, or settings that '
                                 'enable the topic')
        self._answered = {name: {} for name in self._answers}
        for name, message_class in self._answers.items():
            self.node.create_subscription(message_class, name,
                                          partial(self._take, self._answered[name]), DEPTH)

    @staticmethod
    def _take(answered, message):
        stamp = message.header.stamp
        answered[stamp.sec * 1_000_000_000 + stamp.nanosec] = message

    def add_node(self, node):
        """Add a node of this process, created with ``context``; the caller destroys it."""
        self._executor.add_node(node)

    def step(self):
        """
        Send the next sample of the truth and return its Step, or None at the end of the run.

        Subscribers in this process have then received the messages; ``answers`` are waited for.
        """
        for messages in (*self._came.values(), *self._answered.values()):
            messages.clear()
        stamp_ns = self._simulation.step()
        if stamp_ns is None:
            return None
        self._serve()
        if self._stop:
            faults = [node.monitor.last_fault for node in self._simulation.members]
            raise RuntimeError('a node ended the simulation: '
                               + next(filter(None, faults), 'stopped'))
        read = {name: list(messages) for name, messages in self._came.items()}
        found = {name: [_message(PUBLISHED[name], data) for data in messages]
                 for name, messages in read.items()}
        if self._answers and read[ALWAYS[1]]:
            self._await(stamp_of(read[ALWAYS[1]][-1]))
        for name, answered in self._answered.items():
            found[name] = list(answered.values())
        self._count += 1
        return Step(stamp_ns, found)

    def _await(self, stamp_ns):
        end_s = time.monotonic() + self._timeout_s
        repeat_s = time.monotonic() + REPEAT_S
        while missing := [name for name, came in self._answered.items() if stamp_ns not in came]:
            now = time.monotonic()
            if now > end_s:
                raise TimeoutError(f'no message on {missing[0]} with the stamp {stamp_ns} ns in '
                                   f'{self._timeout_s:g} s; expected the filter under test to '
                                   'answer each IMU message with the same stamp')
            if not self._count and now > repeat_s:
                # The filter may have subscribed in the meantime.
                self._simulation.repeat_first()
                repeat_s = now + REPEAT_S
            self._executor.spin_once(timeout_sec=0.01)

    def steps(self, count=None):
        """Yield steps until the end of the run, at most count of them."""
        while count is None or count > 0:
            step = self.step()
            if step is None:
                return
            yield step
            count = None if count is None else count - 1

    def call(self, service_class, name, **request):
        """Call a service of a node, such as 'gnss/outage', and return the response."""
        client = self.node.create_client(service_class, name)
        try:
            end_s = time.monotonic() + self._timeout_s
            future = None
            while future is None or not future.done():
                if time.monotonic() > end_s:
                    raise TimeoutError(f'no response of the service {name} in '
                                       f'{self._timeout_s:g} s; expected a node that offers it')
                if future is None and client.service_is_ready():
                    future = client.call_async(service_class.Request(**request))
                self._executor.spin_once(timeout_sec=0.01)
            return future.result()
        finally:
            self.node.destroy_client(client)


def _message(topic, data):
    from rclpy.serialization import deserialize_message
    from ins_sim.ros.transport.qos import message_class
    return deserialize_message(data, message_class(topic))


@fixture
def start_simulation():
    """Yield a function like RunningSimulation; the simulations it starts end with the test."""
    with ExitStack() as stack:
        yield lambda *args, **options: stack.enter_context(RunningSimulation(*args, **options))
