"""Run one simulation as processes: start the nodes, record their topics, end all processes."""

import os
import signal
import subprocess
import time

from ins_sim import graph, parameter_files
from ins_sim.bags.bag_writer import BagWriter
from ins_sim.messages import topics
from .transport.repairs import use_profile

RECORDED = (topics.RUN, topics.TRUTH_FIX, topics.IMU_RAW, topics.INS_ODOMETRY, topics.INS_FIX,
            *topics.ERRORS)
SIGNALS = (signal.SIGINT, signal.SIGTERM)
END_S = 10.0
NAP_S = 0.002
LOOK_S = 0.1


class Session:
    """
    The processes of ``graph.PROCESSES`` in their own namespace, with a recorder in this process.

    Use it as a context manager: leaving it ends every process, and discards the bag unless
    ``run`` has returned. The processes end with this one, even if it is killed.

    Parameters
    ----------
    settings : SimulationSettings, whose pacing must require the recorder
    folder : directory for the parameter file and the logs
    bag : path of the bag
    namespace : ROS namespace of the nodes
    """

    def __init__(self, settings, folder, bag, namespace):
        self._settings, self._folder, self._bag = settings, folder, bag
        self.namespace = namespace
        self._processes = {}
        self._writer = self._node = self._context = None

    def __enter__(self):
        # The signal handler sets this flag; an exception raised in it could be swallowed by
        # whatever code the main thread is executing.
        self._interrupted = False
        self._before = {number: signal.signal(number, self._on_signal) for number in SIGNALS}
        try:
            return self._start()
        except BaseException as error:
            self.__exit__(error)
            raise

    def _on_signal(self, number, frame):
        self._interrupted = True

    def _start(self):
        import rclpy

        from .recording.bag_recorder import BagRecorder
        use_profile()
        os.environ.setdefault('ROS_AUTOMATIC_DISCOVERY_RANGE', 'LOCALHOST')
        self._context = rclpy.Context()
        # The caller receives Ctrl-C as KeyboardInterrupt, so rclpy must not handle it.
        rclpy.init(context=self._context, signal_handler_options=rclpy.SignalHandlerOptions.NO)
        self._writer = BagWriter(self._bag, 'sqlite3')
        self._node = rclpy.create_node(graph.RECORDER.name, namespace=self.namespace,
                                       context=self._context)
        self._recorder = BagRecorder(self._node, self._writer)
        for topic in RECORDED:
            self._recorder.add(topic)
        parameters = self._folder / 'parameters.yaml'
        parameters.write_text(parameter_files.dump(self._settings), encoding='utf-8')
        for process in graph.PROCESSES:
            with open(self._log(process.name), 'wb') as log:
                self._processes[process.name] = subprocess.Popen(
                    graph.process_command(process, [parameters], namespace=self.namespace,
                                          parent=os.getpid()),
                    stdout=log, stderr=log, stdin=subprocess.DEVNULL)
        return self

    def _log(self, name):
        return self._folder / f'{name}.log'

    def run(self, progress):
        """
        Record until the generator has ended.

        Parameters
        ----------
        progress : callable, called repeatedly with the length of the recording, s

        Returns
        -------
        dict : number of recorded messages by topic

        Raises
        ------
        RuntimeError : a node failed; the message contains its exit code and its last log line
        KeyboardInterrupt : after SIGINT or SIGTERM
        """
        master = self._processes[graph.MASTER]
        looked = 0.0
        while master.returncode is None:
            if self._interrupted:
                raise KeyboardInterrupt
            if not self._recorder.poll():
                time.sleep(NAP_S)
            if time.monotonic() - looked < LOOK_S:
                continue
            looked = time.monotonic()
            progress(self._recorder.length_s)
            for name, process in self._processes.items():
                if process.poll():
                    raise RuntimeError(self._obituary(name, process.returncode))
        self._recorder.finish()
        self._writer.close()
        self._writer = None
        return {topic.name: count for topic, count in zip(RECORDED,
                                                          self._recorder.counts.values())}

    def _obituary(self, name, code):
        lines = self._log(name).read_text(errors='replace').strip().splitlines()
        return f'{name} ended with exit code {code}: {lines[-1] if lines else "no output"}'

    def __exit__(self, *exception):
        # Destroy our own node first: it could hang if other participants vanish at the same time
        # (see process.last_resort).
        if self._node is not None:
            self._node.destroy_node()
        if self._context is not None:
            self._context.try_shutdown()
        for process in self._processes.values():
            if process.poll() is None:
                process.send_signal(signal.SIGINT)
        for process in self._processes.values():
            try:
                process.wait(END_S)
            except subprocess.TimeoutExpired:
                process.kill()
                process.wait()
        if self._writer is not None:
            self._writer.discard()
        for number, handler in self._before.items():
            signal.signal(number, handler)
        if self._interrupted and not any(exception):
            raise KeyboardInterrupt
