"""One simulation as processes: start the nodes, record their topics, end them all."""

import os
import signal
import subprocess

from ins_sim import graph, parameter_files
from ins_sim.messages import topics

RECORDED = (topics.TRUTH_FIX, topics.IMU_RAW, topics.INS_ODOMETRY, topics.INS_FIX,
            *topics.ERRORS)
RECORDER = 'recorder'
END_S = 10.0


class Session:
    """
    The processes of ``graph.PROCESSES`` in a namespace of their own, and a recorder here.

    settings: simulation.Settings, whose pacing must require RECORDER; folder: where parameters
    and logs go; bag: path of the bag.  Use as a context manager: leaving it ends every process,
    and drops the bag unless ``run`` came to its end.
    """

    def __init__(self, settings, folder, bag, namespace):
        self._settings, self._folder, self._bag = settings, folder, bag
        self.namespace = namespace
        self._processes = {}
        self._recorder = None

    def __enter__(self):
        import rclpy
        from rclpy.executors import SingleThreadedExecutor

        from .bag_recorder import BagRecorder
        os.environ.setdefault('ROS_AUTOMATIC_DISCOVERY_RANGE', 'LOCALHOST')
        self._context = rclpy.Context()
        # Ctrl-C belongs to the caller, as KeyboardInterrupt
        rclpy.init(context=self._context, signal_handler_options=rclpy.SignalHandlerOptions.NO)
        try:
            self._recorder = BagRecorder(self._bag, RECORDED, namespace=self.namespace,
                                         acknowledge=topics.ERROR_DRIFT.name,
                                         context=self._context)
            self._executor = SingleThreadedExecutor(context=self._context)
            self._executor.add_node(self._recorder)
            parameters = self._folder / 'parameters.yaml'
            parameters.write_text(parameter_files.dump(self._settings), encoding='utf-8')
            for process in graph.PROCESSES:
                with open(self._log(process.name), 'wb') as log:
                    self._processes[process.name] = subprocess.Popen(
                        graph.command(process, [parameters], namespace=self.namespace),
                        stdout=log, stderr=log, stdin=subprocess.DEVNULL)
        except BaseException:
            self.__exit__()
            raise
        return self

    def _log(self, name):
        return self._folder / f'{name}.log'

    def run(self, progress):
        """
        Record until the generator has ended; progress is called with the last stamp, s.

        Return the number of messages by topic.  Raises RuntimeError with what a node said last
        if one ends with an exit code.
        """
        master = self._processes[graph.MASTER]
        while master.poll() is None:
            self._executor.spin_once(timeout_sec=0.1)
            progress(self._recorder.last_s)
            for name, process in self._processes.items():
                if process.poll():
                    raise RuntimeError(self._obituary(name, process.returncode))
        if master.returncode:
            raise RuntimeError(self._obituary(graph.MASTER, master.returncode))
        self._recorder.close()
        self._bag = None
        return dict(self._recorder.counts)

    def _obituary(self, name, code):
        lines = self._log(name).read_text(errors='replace').strip().splitlines()
        return f'{name} ended with exit code {code}: {lines[-1] if lines else "it said nothing"}'

    def __exit__(self, *exception):
        for process in self._processes.values():
            if process.poll() is None:
                process.send_signal(signal.SIGINT)
        for process in self._processes.values():
            try:
                process.wait(END_S)
            except subprocess.TimeoutExpired:
                process.kill()
                process.wait()
        if self._recorder is not None:
            if self._bag is not None:
                self._recorder.discard()
            self._recorder.destroy_node()
        self._context.try_shutdown()
