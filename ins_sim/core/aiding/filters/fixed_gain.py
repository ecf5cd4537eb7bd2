"""Filters with a fixed gain: the conventional one, and those after Ivanov (2015)."""

import math

from ins_sim.core.attitude import quaternion
from ins_sim.core.numerics.fixed_order import applied
from ..velocity_window import DoubleIntegral, Integrals
from .base import AidingFilter, FixOutcome, refused_fix

# Ivanov (2015) uses the acceleration in body axes as the derivative of the velocity in body
# axes. A window in which the neglected product rate x velocity is larger than this is refused,
# m/s^2.
TURN_LIMIT = 0.01


class ConventionalFilter(AidingFilter):
    """
    Velocity correction with a fixed gain, as if the fix were the velocity at the window's end.

    The fix is in fact the mean over the window, so that this filter makes an error whenever the
    velocity in body axes changes (docs/theory/aided_navigation.md). With windows that slide by
    T_s it is the scheme of Ivanov (2015), section 1: a fix then removes the fraction
    ``gain_per_s`` T_s of the error instead of ``gain``.
    """

    def __init__(self, settings, ins):
        super().__init__(settings, ins)
        window = settings.window
        self._gain = settings.gain
        if window.slides:
            self._gain = settings.gain_per_s * (window.step_cycles / settings.rate_hz)

    def update_velocity(self, ins, fix):
        """Remove the fraction ``gain`` of the velocity error that the fix shows."""
        z = ins.v_b[0] - fix.velocity[0], ins.v_b[1] - fix.velocity[1]
        e, n, _ = quaternion.rotate(ins.q_nb, (self._gain * z[0], self._gain * z[1], 0.0))
        ins.correct(velocity=(e, n, 0.0))
        return FixOutcome(z)


class MatrixFilter(AidingFilter):
    """Base class of the filters that use the matrices A1, A2, B1, B2 of the window."""

    needs = ('integrals',)

    @property
    def matrices(self):
        """Return a1, a2, b1, b2 of the window so far, see ``velocity_window.Integrals``."""
        return Integrals(*self.window.integrals).matrices(self.mean.time_s)

    def begin_window(self, ins):
        """Clear the matrices."""
        super().begin_window(ins)
        self.clear('integrals')


class _ChainedFilter(AidingFilter):
    """Base class of the filters that compare each window with the one before it."""

    def __init__(self, settings, ins):
        super().__init__(settings, ins)
        self._last, self._fixed = None, False

    def _follow(self, value):
        """Store the value of this window; return that of the previous window, or None."""
        last, self._last, self._fixed = self._last, value, True
        return last

    def begin_window(self, ins):
        """Begin a window; after a window without a fix there is no previous value."""
        super().begin_window(ins)
        if not self._fixed:
            self._last = None
        self._fixed = False


FIRST = refused_fix('this is the first window; the filter also needs the one before it')


class PaperFilter(_ChainedFilter):
    """
    The scheme of Ivanov (2015) as printed, equations (13) to (20); for straight legs only.

    The innovation (19) is J_k + J_{k-1} - 2 (V_k - V_{k-1}) / T. J is 2 / T^2 times the double
    integral of the acceleration in b over a window of length T, and V the mean velocity that the
    velocity meter measures. With constant errors e of the acceleration the innovation is
    e_k + e_{k-1}. Windows in which the vehicle turns are refused
    (docs/theory/aided_navigation.md).
    """

    needs = ('accelerations',)

    def update_velocity(self, ins, fix):
        """Correct acceleration, velocity and position by equation (20); refuse turns."""
        t = self.mean.time_s
        scale = 2.0 / (t * t)
        whole, turning = (DoubleIntegral(*x).twice for x in self.window.accelerations)
        now = [(scale * whole[k], scale * turning[k], fix.velocity[k])
               for k in range(2)]
        last = self._follow(now)
        if last is None:
            return FIRST
        innovation = tuple(a[0] + b[0] - 2.0 * (a[2] - b[2]) / t for a, b in zip(now, last))
        x, y = (a[1] + b[1] for a, b in zip(now, last))
        turning = math.sqrt(x * x + y * y)
        if turning > TURN_LIMIT:
            return FixOutcome(innovation, taken=False, reason=(
                f'filter paper refuses a window in which the body turns: {turning:.3g} m/s^2 of '
                'the turn would count as an error; expected a straight leg without weaving '
                '(paper_corrected and eskf work in turns)'))
        w = tuple(self.settings.gain * x for x in innovation)
        ins.add_biases(accelerometer=(*w, 0.0))
        e, n, _ = quaternion.rotate(ins.q_nb, (*w, 0.0))
        half = 0.5 * t * t
        ins.correct(position=(half * e, half * n, 0.0), velocity=(t * e, t * n, 0.0))
        return FixOutcome(innovation)

    def begin_window(self, ins):
        """Clear the integrals."""
        super().begin_window(ins)
        self.clear('accelerations')


class PaperCorrectedFilter(_ChainedFilter, MatrixFilter):
    """
    The scheme of Ivanov (2015) with a residual that is exact while the vehicle turns.

    nu = (z_k - z'_{k-1}) / T, dW = K nu in b, V -= A1 dW, position -= T/2 A1 dW,
    z'_k = z_k - B2 dW, where z is the residual of the mean velocity
    (docs/theory/aided_navigation.md). The acceleration stays corrected by the sum of all dW.
    """

    def update_velocity(self, ins, fix):
        """Correct acceleration, velocity and position."""
        z, t = self.residual(fix), self.mean.time_s
        a1, _, _, b2 = self.matrices
        last = self._follow(z)
        if last is None:
            return FIRST
        nu = (z[0] - last[0]) / t, (z[1] - last[1]) / t
        w = tuple(self.settings.gain * x for x in nu)
        e, n = applied(a1, w).tolist()
        half = 0.5 * t
        ins.correct(position=(half * e, half * n, 0.0), velocity=(e, n, 0.0))
        ins.add_biases(accelerometer=(*w, 0.0))
        back = applied(b2, w).tolist()
        self._last = z[0] - back[0], z[1] - back[1]
        return FixOutcome(nu)
