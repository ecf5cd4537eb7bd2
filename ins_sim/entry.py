"""
Run the command ``ins_sim`` as a process that Ctrl-C ends with one sentence at any time.

The module is small, because the signal handlers must be set before the other modules, which take
seconds, are imported.
"""

import os
import signal
import sys

# SIGALRM repeats an interruption that could not be raised when the signal arrived.
SIGNALS = (signal.SIGINT, signal.SIGTERM, signal.SIGALRM)
IMPORTING = '<frozen importlib._bootstrap>'
AGAIN_S = 0.002

# The exit codes of the command and of the nodes.
OK = 0
FAILED = 1
BAD_INPUT = 2
FAULT = 3
CONSUMER = 4
INTERRUPTED = 130
# {code: meaning} of the command; its verbs record and play are nodes.
COMMAND_CODES = {
    OK: 'Success.',
    FAILED: 'A run failed: in demo a node did not start or ended with an error.',
    BAD_INPUT: 'Bad input: an unknown option, a parameter out of range, a file that is missing or '
               'cannot be read, a folder that exists already, or too little memory. One sentence '
               'on standard error says what was expected.',
    INTERRUPTED: 'Interrupted by Ctrl-C or SIGTERM.'}
# {code: meaning} of a node.
NODE_CODES = {
    OK: 'The run has ended, or SIGINT or SIGTERM ended the node.',
    BAD_INPUT: 'Bad parameters, arguments or input files, or ROS 2 cannot be imported. The node '
               'has not started.',
    FAULT: 'A fault ended the node: a gap, a backwards stamp or a bad message with on_fault stop; '
           'in recorder a full disk; in player a bag that is damaged.',
    CONSUMER: 'In lock-step a consumer of pacing.required (or --lock-step) has not acknowledged '
              'for pacing.timeout_s (or --timeout).'}


def command():
    """Run the command line of this process, and end it with the exit code."""
    sys.unraisablehook = _on_unraisable
    for number in SIGNALS:
        signal.signal(number, _interrupt)
    try:
        from ins_sim.cli.main import main
        code = main()
    except KeyboardInterrupt:
        print('ins_sim: interrupted; nothing was written', file=sys.stderr)
        code = INTERRUPTED
    for number in SIGNALS:
        signal.signal(number, signal.SIG_IGN)
    try:
        sys.stdout.flush()
    except OSError:
        # The reader of the pipe has closed it, which Python would report again at its exit.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
    sys.exit(code)


def end_at_once():
    """Let signals end this process with code 0 until the imported node sets its own handlers."""
    for number in SIGNALS:
        signal.signal(number, lambda *_: os._exit(OK))


def _interrupt(number, frame):
    """
    Raise KeyboardInterrupt once; the verbs clean up when it is raised.

    During an import the exception might be swallowed or leave a module half imported; it is then
    raised later.
    """
    for each in SIGNALS[:2]:
        signal.signal(each, signal.SIG_IGN)
    while frame is not None:
        if frame.f_code.co_filename == IMPORTING:
            signal.setitimer(signal.ITIMER_REAL, AGAIN_S)
            return
        frame = frame.f_back
    raise KeyboardInterrupt


def _on_unraisable(unraisable):
    """Raise a KeyboardInterrupt again that was raised where it could not be caught."""
    if isinstance(unraisable.exc_value, KeyboardInterrupt):
        signal.setitimer(signal.ITIMER_REAL, AGAIN_S)
    elif 'ignored due to race condition' not in str(unraisable.exc_value):
        sys.__unraisablehook__(unraisable)
