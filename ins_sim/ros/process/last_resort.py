"""
The end of a process that cannot end.

Fast DDS of the PyPI wheels waits for ever in DomainParticipant::set_listener, the interpreter
locked, when another participant is seen to vanish in the instant in which ours is destroyed: its
wait_until overflows (eProsima/Fast-DDS 6513).  Where nodes end together that is once in some
thousand times.  No thread of Python could help, hence a timer of the C library (timer_create(2),
SIGEV_THREAD).
"""

import ctypes

CLOCK_MONOTONIC = 1
SIGEV_THREAD = 2


class _Event(ctypes.Structure):
    """Struct sigevent of glibc on 64 bits: what _exit is called with, and _exit."""

    _fields_ = (('value', ctypes.c_int64), ('signal', ctypes.c_int), ('notify', ctypes.c_int),
                ('function', ctypes.c_void_p), ('attributes', ctypes.c_void_p),
                ('rest', ctypes.c_byte * 32))


class _Times(ctypes.Structure):
    """Struct itimerspec: the period, 0 for once, and the delay."""

    _fields_ = tuple((name, ctypes.c_long) for name in (
        'period_s', 'period_ns', 'delay_s', 'delay_ns'))


def exit_within(delay_s, code):
    """Let the process end with an exit code after so many whole seconds if it still runs then."""
    # the timers of glibc before 2.34 are there; of later ones it leads to libc itself
    libc = ctypes.CDLL('librt.so.1')
    event = _Event(code, 0, SIGEV_THREAD, ctypes.cast(libc._exit, ctypes.c_void_p))
    timer = ctypes.c_void_p()
    if libc.timer_create(CLOCK_MONOTONIC, ctypes.byref(event), ctypes.byref(timer)) == 0:
        libc.timer_settime(timer, 0, ctypes.byref(_Times(0, 0, delay_s, 0)), None)
