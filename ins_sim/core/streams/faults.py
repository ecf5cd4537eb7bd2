"""Faults of a stream of samples, each described in one sentence."""

import math

from ins_sim.core.numerics.instants import seconds

# How far an interval may be off the sampling period, as a fraction of it: jitter of the stamps,
# but no lost sample.
INTERVAL_TOLERANCE = 0.2
# What a stage computes at once: of more sampling periods a step of the truth is a gap.
MOST_PERIODS = 1000
# Bounds of the square of the norm of a quaternion.
UNIT_LOW, UNIT_HIGH = 0.998, 1.002


class StreamFault(ValueError):
    """
    A sample that a stage refuses.

    restart: False when the sample was dropped and the stage is intact; True when the stage must
    be reset before the sample may be given to it again.  index: the number of the sample in the
    block that was given; readings: those that the samples before it have completed, or None.
    """

    index, readings = 0, None

    def __init__(self, sentence, restart):
        super().__init__(sentence)
        self.restart = restart

    def __reduce__(self):
        """Let it cross from one process to another."""
        return type(self), (str(self), self.restart)


def half_turn_sentence(name, t_ns, rate, interval_s):
    """Return the sentence on a rate, rad/s, at which an interval of the IMU turns too far."""
    return (f'{name} at {seconds(t_ns)} turns at {rate:.4g} rad/s, {rate * interval_s:.3g} rad in '
            f'an interval of the IMU; expected less than half a turn, {math.pi:.3g} rad: raise '
            f'rate_hz of imu_sensor above {rate / math.pi:.4g} Hz, or set output integrated')


def check_finite(name, t_ns, *vectors):
    """Raise StreamFault (sample dropped) if a vector of floats holds a NaN or an infinity."""
    for vector in vectors:
        if not math.isfinite(sum(vector)):
            raise StreamFault(f'{name} at {seconds(t_ns)} holds {vector}; expected finite '
                              'numbers; the sample was dropped', restart=False)


def check_unit(name, t_ns, q):
    """Raise StreamFault (sample dropped) unless the quaternion has unit norm within 1e-3."""
    n2 = q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]
    if not UNIT_LOW < n2 < UNIT_HIGH:
        raise StreamFault(f'{name} at {seconds(t_ns)} has an orientation of norm '
                          f'{math.sqrt(n2):.6g}; expected 1; the sample was dropped',
                          restart=False)


def is_regular(step_ns, expected_ns):
    """Return whether steps (integers or an array of them) are within INTERVAL_TOLERANCE."""
    return abs(step_ns - expected_ns) <= INTERVAL_TOLERANCE * expected_ns


def check_later(name, t_ns, last_ns):
    """Raise StreamFault unless t_ns is after last_ns; a repeated stamp calls for no restart."""
    if t_ns == last_ns:
        raise StreamFault(f'{name} repeats the stamp {seconds(t_ns)}; expected a later one; the '
                          'sample was dropped', restart=False)
    if t_ns < last_ns:
        raise StreamFault(f'{name} jumps back from {seconds(last_ns)} to {seconds(t_ns)}; '
                          'expected rising stamps', restart=True)


def check_interval(name, t_ns, last_ns, expected_ns):
    """
    Raise StreamFault unless t_ns follows last_ns by expected_ns within INTERVAL_TOLERANCE.

    A repeated stamp is dropped; a backwards stamp, a gap and another rate call for a restart.
    """
    step = t_ns - last_ns
    if is_regular(step, expected_ns):
        return
    check_later(name, t_ns, last_ns)
    what = 'has a gap' if step > expected_ns else 'comes at another rate'
    advice = '' if step > expected_ns else (': rate_hz must be the same in the node that sends it '
                                            'and in the one that reads it')
    raise StreamFault(f'{name} {what} from {seconds(last_ns)} to {seconds(t_ns)}; expected steps '
                      f'of {expected_ns * 1e-9:.9g} s{advice}', restart=True)


def check_periods(t_ns, last_ns, shortest_ns, longest_ns):
    """Raise StreamFault (restart) unless a step of the truth is one that rate_hz may have."""
    if not shortest_ns <= t_ns - last_ns <= longest_ns:
        raise StreamFault(f'truth steps from {seconds(last_ns)} to {seconds(t_ns)}; expected '
                          f'{shortest_ns * 1e-9:.9g} to {longest_ns * 1e-9:.9g} s, {MOST_PERIODS} '
                          'periods of rate_hz at most', restart=True)
