"""The velocity meter on records of the truth, offline."""

import numpy as np

from ins_sim.core.earth.rates import body_velocity
from .ins_means import WAIT_NS


class MeterOnTruth:
    """
    A VelocityMeter that accepts records of the truth.

    Without `follow_ins` the true angle of attack is used; the angle of a converged INS differs
    from it by milliradians.
    """

    def __init__(self, meter):
        self._meter, self._ins, self._next = meter, None, 0

    def follow_ins(self, t_ns, v_b):
        """
        Use the angle of attack of an INS from now on.

        Parameters
        ----------
        t_ns : (n,) int64 motion times, ns, up to the end of the next ``advance`` or of the run
        v_b : (n, 3) velocity of the INS in body axes, m/s
        """
        self._ins, self._next = (t_ns, v_b), 0

    def advance(self, truth):
        """Return the VelocityFixes that a Truth record completes, in the order of arrival."""
        v_b = body_velocity(truth)
        if self._ins is None:
            return self._meter.advance(truth.t_ns, v_b, truth.height, v_b)
        t_ns, ins_v_b = self._ins
        found = []
        # The meter waits for the INS for WAIT_NS only, so neither stream may run ahead by more.
        step = max(1, int(np.searchsorted(truth.t_ns, truth.t_ns[0] + WAIT_NS // 2)))
        for first in range(0, len(truth), step):
            here = slice(first, first + step)
            found += self._meter.advance(truth.t_ns[here], v_b[here], truth.height[here])
            last = self._next
            self._next = int(np.searchsorted(t_ns, truth.t_ns[here][-1], side='right'))
            found += self._meter.advance_ins(t_ns[last:self._next], ins_v_b[last:self._next])
        return found

    def finish(self):
        """Return the windows whose end the INS did not reach, as invalid VelocityFixes."""
        return self._meter.give_up_ins()
