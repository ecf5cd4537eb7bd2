"""Faults of a stream of samples; each has a message of one sentence."""

import math

from ins_sim.core.numerics.instants import seconds

# Largest deviation of an interval from the sampling period, as a fraction of it: it allows for
# jitter of the stamps but not for a lost sample.
INTERVAL_TOLERANCE = 0.2
# Largest step of the truth in sampling periods; it limits what a stage computes in one call.
MOST_PERIODS = 1000
# Bounds of the square of the norm of a quaternion.
UNIT_LOW, UNIT_HIGH = 0.998, 1.002


class StreamFault(ValueError):
    """
    Raised for a sample that a stage cannot use.

    Attributes
    ----------
    restart : False if the sample was dropped and the stage is unaffected; True if the stage must
        be reset before it can take the sample again
    index : number of the sample in the block in which it came
    readings : readings completed by the samples before it, or None
    """

    index, readings = 0, None

    def __init__(self, sentence, restart):
        super().__init__(sentence)
        self.restart = restart

    def __reduce__(self):
        """Support pickling, so that the fault can be passed to another process."""
        return type(self), (str(self), self.restart)


def half_turn_sentence(name, t_ns, rate, interval_s):
    """Return the message for a rate (rad/s) of half a turn or more within an IMU interval."""
    return (f'{name} at {seconds(t_ns)} turns at {rate:.4g} rad/s, {rate * interval_s:.3g} rad in '
            f'an interval of the IMU; expected less than half a turn, {math.pi:.3g} rad: raise '
            f'rate_hz of imu_sensor above {rate / math.pi:.4g} Hz, or set output integrated')


def check_finite(name, t_ns, *vectors):
    """Raise StreamFault (sample dropped) if a vector of floats contains NaN or infinity."""
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
    """Return whether steps (an integer or an array) equal expected_ns within the tolerance."""
    return abs(step_ns - expected_ns) <= INTERVAL_TOLERANCE * expected_ns


def check_later(name, t_ns, last_ns):
    """Raise StreamFault unless t_ns is after last_ns; a repeated stamp needs no restart."""
    if t_ns == last_ns:
        raise StreamFault(f'{name} repeats the stamp {seconds(t_ns)}; expected a later one; the '
                          'sample was dropped', restart=False)
    if t_ns < last_ns:
        raise StreamFault(f'{name} jumps back from {seconds(last_ns)} to {seconds(t_ns)}; '
                          'expected rising stamps', restart=True)


def check_interval(name, t_ns, last_ns, expected_ns):
    """
    Raise StreamFault unless t_ns follows last_ns by expected_ns within INTERVAL_TOLERANCE.

    A sample with a repeated stamp is dropped; a backwards stamp, a gap or another rate needs a
    restart.

    Parameters
    ----------
    name : name of the stream, for the message
    t_ns, last_ns : stamps of this sample and of the one before, ns
    expected_ns : expected step, ns
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
    """Raise StreamFault (restart) if a step of the truth is outside the limits for rate_hz."""
    if not shortest_ns <= t_ns - last_ns <= longest_ns:
        raise StreamFault(f'truth steps from {seconds(last_ns)} to {seconds(t_ns)}; expected '
                          f'{shortest_ns * 1e-9:.9g} to {longest_ns * 1e-9:.9g} s, {MOST_PERIODS} '
                          'periods of rate_hz at most', restart=True)
