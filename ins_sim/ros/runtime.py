"""
How a node process starts, runs and ends: signals, exit codes, the loop.

rclpy's own handlers end the context under a running callback, and a second SIGINT kills Python
while it finalises.  Python's cannot be taken down without a race: a signal in the very moment is
reported as lost, with a traceback.  So no handler is installed: SIGINT and SIGTERM are blocked,
and a thread waits for the first of them and sets a flag; the next ones stay pending for ever.
Nothing heavy is imported before that, and threads made later inherit the mask.
"""

import gc
import signal
import sys
import threading
import warnings

EXIT_OK = 0
EXIT_PARAMETERS = 2
EXIT_FAULT = 3
EXIT_CONSUMER = 4
SIGNALS = (signal.SIGINT, signal.SIGTERM)
POLL_S = 0.2


class Stop:
    """The wish to end: set by a signal or by the node itself; the first one counts."""

    def __init__(self):
        self.code = None

    def __bool__(self):
        return self.code is not None

    def request(self, code=EXIT_OK):
        """Ask the loop to end with an exit code."""
        if self.code is None:
            self.code = code

    def install(self):
        """Let SIGINT and SIGTERM request the end: call from the main thread, before others."""
        signal.pthread_sigmask(signal.SIG_BLOCK, SIGNALS)
        threading.Thread(target=self._wait, daemon=True).start()

    def _wait(self):
        signal.sigwait(SIGNALS)
        self.request()


def node_main(load, args=None, **more):
    """
    Run a node process and return its exit code.

    load: function that imports and returns the node class.  The class is called with ``stop``
    and what else is given, and has ``run(executor, stop)`` if it brings its own loop.
    """
    stop = Stop()
    stop.install()
    try:
        import rclpy
        from rclpy.executors import SingleThreadedExecutor
        node_class = load()
    except ImportError as error:
        print(f'cannot import ROS 2: {error}; source a ROS 2 Jazzy or install ins_sim[ros]',
              file=sys.stderr)
        return EXIT_PARAMETERS
    if stop:
        return stop.code
    warnings.showwarning = lambda sentence, *_: rclpy.logging.get_logger(
        node_class.NAME).warning(str(sentence))
    try:
        rclpy.init(args=args, signal_handler_options=rclpy.SignalHandlerOptions.NO)
        node = node_class(stop=stop, **more)
    except (ValueError, OSError) as error:
        _fatal(rclpy, node_class, error)
        stop.request(EXIT_PARAMETERS)
    except RuntimeError as error:
        # rcl's own view of the arguments: a file that is no YAML, a remapping that is none
        _fatal(rclpy, node_class, ' '.join(str(error).split()))
        stop.request(EXIT_PARAMETERS)
    else:
        executor = SingleThreadedExecutor()
        executor.add_node(node)
        # what the start has made stays: a collector that walks it again and again costs 10 %
        gc.collect()
        gc.freeze()
        getattr(node, 'run', _spin)(executor, stop)
        executor.shutdown()
        node.destroy_node()
    rclpy.try_shutdown()
    return stop.code


def _spin(executor, stop):
    while not stop:
        executor.spin_once(timeout_sec=POLL_S)


def _fatal(rclpy, node_class, sentence):
    rclpy.logging.get_logger(node_class.NAME).fatal(str(sentence))
