"""
Start, run and end a node process: signals, exit codes, the loop.

The signal handlers of rclpy shut the context down while a callback is running, and a second SIGINT
kills Python during finalisation. The handlers here only set a flag, and after the first signal
further ones are ignored. They are installed before anything large is imported.

If a signal arrives while Python is replacing a handler, Python prints a traceback, "ignored due to
race condition". The exception is harmless and is suppressed.
"""

import gc
import signal
import sys

from ins_sim import entry
from ins_sim.visible_text import visible
from ..transport.repairs import drain_publishers, use_profile

EXIT_OK, EXIT_PARAMETERS = entry.OK, entry.BAD_INPUT
EXIT_FAULT, EXIT_CONSUMER = entry.FAULT, entry.CONSUMER
# SIGALRM: the command line sends it for a signal that arrived during its imports.
SIGNALS = (signal.SIGINT, signal.SIGTERM, signal.SIGALRM)
POLL_S = 0.2
# Far longer than a node needs to shut down.
END_S = 5


class Stop:
    """Request to end the process, set by a signal or by the node; the first exit code counts."""

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
    """Ignore further signals, because the process is already ending."""
    for number in SIGNALS:
        signal.signal(number, signal.SIG_IGN)


def _report(unraisable):
    """Report an exception that cannot be caught, except the harmless one described above."""
    if 'ignored due to race condition' not in str(unraisable.exc_value):
        sys.__unraisablehook__(unraisable)


def node_main(load, args=None, **more):
    """
    Run a node process and return its exit code.

    Parameters
    ----------
    load : callable
        Imports and returns the node class. A class with its own loop has ``run(executor, stop)``.
    args : command line with ROS arguments, by default ``sys.argv``
    more : keyword arguments of the node class, in addition to ``stop``
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
        print(f'cannot import ROS 2: {error}; source ROS 2 Jazzy or install ins_sim[ros]',
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
        # rcl or rclpy refuses the arguments, for example invalid YAML or an invalid remapping.
        from .refusals import sentence
        unknown = type(error).__name__ == 'UnknownROSArgsError'
        _fatal(rclpy, node_class, ('unknown ROS argument ' if unknown else '')
               + sentence(error, args))
        stop.request(EXIT_PARAMETERS)
    else:
        executor = SingleThreadedExecutor()
        executor.add_node(node)
        # Objects made during start-up live for ever; freezing them saves the garbage collector
        # 10 % of the CPU time.
        gc.collect()
        gc.freeze()
        # Compiling would block the node for seconds, so the loops run in plain Python.
        with plain_only():
            getattr(node, 'run', _spin)(executor, stop)
        executor.shutdown()
    exit_within(END_S, stop.code)
    if node is not None:
        # Wait until the readers have received everything that was published.
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
