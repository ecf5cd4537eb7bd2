"""
How a node process starts, runs and ends: signals, exit codes, the loop.

rclpy's own handlers end the context under a running callback, and a second SIGINT kills Python
while it finalises.  So the handlers here only set a flag, and the first signal makes the process
deaf to the next ones.  Nothing heavy is imported before they stand.

A signal that falls into the few instructions in which Python changes a handler is reported, with a
traceback, as "ignored due to race condition": ignored is what it shall be, so that is not said.
"""

import gc
import signal
import sys

from ins_sim import entry
from ins_sim.visible_text import visible
from ..transport.repairs import drain_publishers, use_profile

EXIT_OK, EXIT_PARAMETERS = entry.OK, entry.BAD_INPUT
EXIT_FAULT, EXIT_CONSUMER = entry.FAULT, entry.CONSUMER
# the alarm: a signal of the command line that came amid its imports
SIGNALS = (signal.SIGINT, signal.SIGTERM, signal.SIGALRM)
POLL_S = 0.2
# far longer than a node takes to leave the graph
END_S = 5


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
        """Let SIGINT and SIGTERM request the end."""
        sys.unraisablehook = _report
        for number in SIGNALS:
            signal.signal(number, self._handle)

    def _handle(self, number, frame):
        deafen()
        self.request()


def deafen():
    """Ignore further signals: the process is on its way out already."""
    for number in SIGNALS:
        signal.signal(number, signal.SIG_IGN)


def _report(unraisable):
    """Report an exception that nobody can catch, unless it is a signal that came too late."""
    if 'ignored due to race condition' not in str(unraisable.exc_value):
        sys.__unraisablehook__(unraisable)


def node_main(load, args=None, **more):
    """
    Run a node process and return its exit code.

    load: function that imports and returns the node class.  The class is called with ``stop``
    and what else is given, and has ``run(executor, stop)`` if it brings its own loop.
    """
    stop = Stop()
    stop.install()
    use_profile()
    try:
        import rclpy
        from rclpy.exceptions import NameValidationException, ParameterException
        from rclpy.executors import SingleThreadedExecutor

        from ins_sim.core.numerics.compilation import plain_only
        from ins_sim.core.numerics.sentences import tell_warnings
        from .last_resort import exit_within
        node_class = load()
    except ImportError as error:
        print(f'cannot import ROS 2: {error}; source a ROS 2 Jazzy or install ins_sim[ros]',
              file=sys.stderr)
        return EXIT_PARAMETERS
    if stop:
        return stop.code
    tell_warnings(rclpy.logging.get_logger(node_class.NAME).warning)
    node = None
    try:
        rclpy.init(args=args, signal_handler_options=rclpy.SignalHandlerOptions.NO)
        node = node_class(stop=stop, **more)
    except (ValueError, OSError) as error:
        _fatal(rclpy, node_class, error)
        stop.request(EXIT_PARAMETERS)
    except (RuntimeError, NameValidationException, ParameterException) as error:
        # the view of rcl or rclpy: a file that is no YAML, a remapping that is none
        from .refusals import sentence
        unknown = type(error).__name__ == 'UnknownROSArgsError'
        _fatal(rclpy, node_class, ('unknown ROS argument ' if unknown else '')
               + sentence(error, args))
        stop.request(EXIT_PARAMETERS)
    else:
        executor = SingleThreadedExecutor()
        executor.add_node(node)
        # what the start has made stays: a collector that walks it again and again costs 10 %
        gc.collect()
        gc.freeze()
        # a node must not stop for the seconds that a compiler takes
        with plain_only():
            getattr(node, 'run', _spin)(executor, stop)
        executor.shutdown()
    exit_within(END_S, stop.code)
    if node is not None:
        # what has left this process only counts once the readers have it
        drain_publishers(node.publishers)
        node.destroy_node()
    deafen()
    rclpy.try_shutdown()
    return stop.code


def _spin(executor, stop):
    while not stop:
        executor.spin_once(timeout_sec=POLL_S)


def _fatal(rclpy, node_class, sentence):
    rclpy.logging.get_logger(node_class.NAME).fatal(visible(str(sentence)))
