"""Filters with a fixed gain: the conventional one, and those of Ivanov (2015)."""

import math

from ins_sim.core.attitude import quaternion
from ins_sim.core.attitude.interpolation import middle
from ins_sim.core.earth import ellipsoid
from ..velocity_window import DoubleIntegral, Integrals
from .base import FixOutcome, FreeFilter, refused, TURN_LIMIT


class ConventionalFilter(FreeFilter):
    """The mean taken for the velocity at the end of its window, with a fixed gain."""

    def velocity(self, ins, fix):
        """Take away a part of the velocity error that the fix shows."""
        z = ins.v_b[0] - fix.velocity[0], ins.v_b[1] - fix.velocity[1]
        gain = self._settings.gain
        e, n, _ = quaternion.rotate(ins.q_nb, (gain * z[0], gain * z[1], 0.0))
        ins.correct(velocity=(e, n, 0.0))
        return FixOutcome(z)


class MatrixFilter(FreeFilter):
    """A filter that needs the matrices of the window."""

    def __init__(self, settings, ins):
        super().__init__(settings, ins)
        self.integrals = Integrals()

    def copy(self):
        """Return a snapshot."""
        twin = super().copy()
        twin.integrals = self.integrals.copy()
        return twin

    def step(self, ins, before, u, dt):
        """Sum up the window."""
        super().step(ins, before, u, dt)
        self.integrals.add(middle(before[0], ins.q_nb), dt)

    def close(self):
        """Begin a window."""
        super().close()
        self.integrals.clear()


class _ChainedFilter(FreeFilter):
    """A filter that compares each window with the one before it."""

    def __init__(self, settings, ins):
        super().__init__(settings, ins)
        self._last, self._fixed = None, False

    def _follow(self, value):
        """Keep the value of this window and return that of the one before, or None."""
        last, self._last, self._fixed = self._last, value, True
        return last

    def close(self):
        """Begin a window; one without a fix breaks the chain."""
        super().close()
        if not self._fixed:
            self._last = None
        self._fixed = False


FIRST = refused('the first window has none before it')


class PaperFilter(_ChainedFilter):
    """
    The scheme as printed, equations (13) to (20): for straight legs only.

    J = (2 / T^2) times the double integral of the acceleration in b over a window; innovation
    (19): J_k + J_{k-1} - 2 (V_k - V_{k-1}) / T, V the means of the instrument; for constant
    errors e of the acceleration it is e_k + e_{k-1}.  A turn is refused.
    """

    def __init__(self, settings, ins):
        super().__init__(settings, ins)
        self._all = self._turn = DoubleIntegral()

    def step(self, ins, before, u, dt):
        """Integrate the acceleration in b twice, and that part of it which is rate x velocity."""
        super().step(ins, before, u, dt)
        q_start, b_start, v = before
        # in a frame that does not turn about the vertical along a great circle
        _, r_e = ellipsoid.radii(math.sin(ins.lat))
        spin = v[0] * math.tan(ins.lat) / (r_e + ins.height) * dt
        w = quaternion.rotate_back(middle(q_start, ins.q_nb), (
            ins.v[0] - v[0] - spin * v[1], ins.v[1] - v[1] + spin * v[0], ins.v[2] - v[2]))
        turn = w[0] - ins.v_b[0] + b_start[0], w[1] - ins.v_b[1] + b_start[1]
        self._all, self._turn = self._all.after(w, dt), self._turn.after(turn, dt)

    def velocity(self, ins, fix):
        """Correct acceleration, velocity and coordinates (20), unless the windows hold a turn."""
        t = self.mean.time_s
        scale = 2.0 / (t * t)
        now = [(scale * self._all.twice[k], scale * self._turn.twice[k], fix.velocity[k])
               for k in range(2)]
        last = self._follow(now)
        if last is None:
            return FIRST
        innovation = tuple(a[0] + b[0] - 2.0 * (a[2] - b[2]) / t for a, b in zip(now, last))
        turning = math.hypot(*(a[1] + b[1] for a, b in zip(now, last)))
        if turning > TURN_LIMIT:
            return FixOutcome(innovation, taken=False, reason=(
                f'filter paper refuses a window in which the body turns: it would take '
                f'{turning:.3g} m/s^2 of it for an error; expected a straight leg without weave '
                '(paper_corrected and eskf fly turns)'))
        w = tuple(self._settings.gain * x for x in innovation)
        ins.add_biases(accelerometer=(*w, 0.0))
        e, n, _ = quaternion.rotate(ins.q_nb, (*w, 0.0))
        half = 0.5 * t * t
        ins.correct(position=(half * e, half * n, 0.0), velocity=(t * e, t * n, 0.0))
        return FixOutcome(innovation)

    def close(self):
        """Begin a window."""
        super().close()
        self._all = self._turn = DoubleIntegral()


class PaperCorrectedFilter(_ChainedFilter, MatrixFilter):
    """
    The paper's scheme with a residual that is exact under rotation (spec section 4).

    nu = (z_k - z'_{k-1}) / T, dW = K nu in b, V -= A1 dW, position -= T/2 A1 dW, z'_k = z_k - B2
    dW.  The acceleration stays corrected by the sum of dW.
    """

    def velocity(self, ins, fix):
        """Correct acceleration, velocity and position."""
        z, t = self._residual(fix), self.mean.time_s
        a1, _, _, b2 = self.integrals.matrices
        last = self._follow(z)
        if last is None:
            return FIRST
        nu = (z[0] - last[0]) / t, (z[1] - last[1]) / t
        w = tuple(self._settings.gain * x for x in nu)
        e, n = (a1 @ w).tolist()
        half = 0.5 * t
        ins.correct(position=(half * e, half * n, 0.0), velocity=(e, n, 0.0))
        ins.add_biases(accelerometer=(*w, 0.0))
        back = (b2 @ w).tolist()
        self._last = z[0] - back[0], z[1] - back[1]
        return FixOutcome(nu)
