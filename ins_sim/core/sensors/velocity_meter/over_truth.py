"""The velocity meter over records of the truth, offline."""

import numpy as np

from ins_sim.core.earth.rates import body_velocity


class MeterOnTruth:
    """
    A VelocityMeter that is given truth in blocks.

    Without an INS the true angle of attack is used; that of a converged INS differs from it by
    milliradians.
    """

    def __init__(self, meter):
        self._meter, self._ins = meter, None

    def follow_ins(self, t_ns, v_b):
        """Take the angle of attack from an INS: t_ns (n,) int64, velocity in b (n, 3), m/s."""
        self._ins = t_ns, v_b

    def advance(self, truth):
        """Return the VelocityFixes that a Truth record completes, in the order of arrival."""
        v_b = body_velocity(truth)
        if self._ins is None:
            return self._meter.advance(truth.t_ns, v_b, truth.height, v_b)
        found = self._meter.advance(truth.t_ns, v_b, truth.height)
        t_ns, ins_v_b = self._ins
        span = slice(*np.searchsorted(t_ns, (truth.t_ns[0], truth.t_ns[-1] + 1)).tolist())
        for now_ns, v in zip(t_ns[span].tolist(), ins_v_b[span].tolist()):
            found += self._meter.push_ins(now_ns, v)
        return found

    def finish(self):
        """Return the VelocityFixes, invalid, of windows to whose end the INS never came."""
        return self._meter.give_up_ins()
