"""
End a process that hangs during its shutdown.

The Fast DDS of the PyPI wheels can wait forever in DomainParticipant::set_listener while holding
the interpreter lock, if another participant disappears at the moment in which ours is destroyed:
its wait_until overflows (eProsima/Fast-DDS 6513). When several nodes end together this happens
once in some thousand times. A Python thread could not run then, so a timer of the C library is
used (timer_create(2), SIGEV_THREAD).
"""

import ctypes

CLOCK_MONOTONIC = 1
SIGEV_THREAD = 2


class _Event(ctypes.Structure):
    """Struct sigevent of 64-bit glibc: the argument of _exit, and the address of _exit."""

    _fields_ = (('value', ctypes.c_int64), ('signal', ctypes.c_int), ('notify', ctypes.c_int),
                ('function', ctypes.c_void_p), ('attributes', ctypes.c_void_p),
                ('rest', ctypes.c_byte * 32))


class _Times(ctypes.Structure):
    """Struct itimerspec: the period (0: fire once) and the delay."""

    _fields_ = tuple((name, ctypes.c_long) for name in (
        'period_s', 'period_ns', 'delay_s', 'delay_ns'))


def exit_within(delay_s, code):
    """End the process with an exit code if it still runs after delay_s (whole seconds)."""
    # Before glibc 2.34 librt contains the timer functions; later it only refers to libc.
    libc = ctypes.CDLL('librt.so.1')
    event = _Event(code, 0, SIGEV_THREAD, ctypes.cast(libc._exit, ctypes.c_void_p))
    timer = ctypes.c_void_p()
    if libc.timer_create(CLOCK_MONOTONIC, ctypes.byref(event), ctypes.byref(timer)) == 0:
        libc.timer_settime(timer, 0, ctypes.byref(_Times(0, 0, delay_s, 0)), None)
