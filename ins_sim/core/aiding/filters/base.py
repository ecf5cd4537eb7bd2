"""What every filter of the aided navigator has, and the result of giving it a fix."""

from collections import namedtuple
import copy

from ..velocity_window import BodyMean

# What became of a fix: innovation (its components), their normalised square, how many they are
# (nis None without a covariance), whether it was taken, and why not.
FixOutcome = namedtuple('Result', 'innovation nis freedom taken reason',
                        defaults=(None, 0, True, ''))
# The paper takes the acceleration in body axes for the derivative of the velocity in body axes:
# a turn whose product rate x velocity adds more than this to its innovation, m/s^2, is refused.
TURN_LIMIT = 0.01
# how the reason of a fix begins that its instrument reports as none
NO_FIX = 'the fix is none'


def refused(reason):
    """Return the Result of a fix that is not taken."""
    return FixOutcome((), taken=False, reason=reason)


class FreeFilter:
    """No correction at all."""

    healthy = True
    # mounting mu (rad), kx, kz of the velocity meter
    estimates = (0.0, 0.0, 0.0)

    def __init__(self, settings, ins):
        self._settings = settings
        self.mean = BodyMean()

    def copy(self):
        """Return a snapshot."""
        twin = copy.copy(self)
        twin.mean = self.mean.copy()
        return twin

    def step(self, ins, before, u, dt):
        """Follow a step of the strapdown; before: its q_nb, v_b, v_n before; u: increment."""
        self.mean.add(before[1], ins.v_b, dt)

    def velocity(self, ins, fix):
        """Take a fix of the velocity meter whose window ends now; return the Result."""
        return refused('the free solution takes no fix')

    def close(self):
        """Begin a window."""
        self.mean.clear()

    def sigmas(self):
        """Return the standard deviations of position, velocity and attitude, or None."""
        return None

    def estimate_sigmas(self):
        """Return the standard deviations of the estimates, or None."""
        return None

    def _residual(self, fix):
        x, y = self.mean.value
        return x - fix.velocity[0], y - fix.velocity[1]
