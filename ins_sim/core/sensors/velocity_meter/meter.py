"""
The correlation velocity meter: windows of truth in, fixes out.

The modes ``signal`` and ``surrogate`` have the same interface. Velocities are exchanged in body
axes FLU. Internally they are resolved in the axes of the antennas: X1 forward, Y1 up, Z1 right,
turned about the vertical axis by the mounting error. Source: Ivanov 2015
(docs/theory/velocity_meter.md).
"""

from collections import deque
import math

import numpy as np

from ins_sim.core.numerics.elementary import atan2, sincos
from ins_sim.core.numerics.instants import period_ns, seconds
from ins_sim.core.streams.faults import (check_finite, check_interval, INTERVAL_TOLERANCE,
                                         StreamFault)
from ins_sim.core.timeseries.fixes import VALID, VelocityFix
from .blocks import pieces
from .ins_means import InsMeans, UNSEEN
from .limits import all_measurable, why_not_measurable
from .reading import Reading
from .surrogate import reported_sigmas, SurrogateWindows
from .windows import OpenWindows

NOTHING = (math.nan, math.nan)
CALM = 'drop-out over calm water'


class VelocityMeter:
    """
    The instrument; neither blocks nor the order of truth and INS change the fixes.

    Windows have N cycles. They end at whole multiples of ``window.slide_cycles`` cycles (or of N)
    in motion time. A window whose start was not seen is not reported.

    With attack_angle ``ins`` a fix is returned when the INS has reached the end of its window,
    with tan(alpha) = -mean(V_y1)/mean(V_x1) over the INS samples inside (equation 8), whatever
    their number. Without any sample the fix is invalid. It is also invalid if the INS has not
    reached the end of the window 60 s of motion time later.

    Parameters
    ----------
    settings : VelocityMeterSettings; ValueError if they are inconsistent
    """

    def __init__(self, settings):
        self._settings = settings
        self._dt_ns = period_ns(settings.rate_hz)
        self._cycles, self._step = settings.window.cycles, settings.window.step_cycles
        self._span_ns = self._cycles * self._dt_ns
        self._latency_ns = round(settings.window.latency_ms * 1e6)
        self._sin, self._cos = sincos(math.radians(settings.antennas.mounting_yaw_arcmin / 60.0))
        self._waits = settings.attack_angle == 'ins'
        self.change(settings)
        if settings.mode == 'signal':
            from .pulses import SignalWindows
            self._method = SignalWindows(settings)
        else:
            self._method = SurrogateWindows(settings)
        self._open = OpenWindows(self._method, self._cycles, self._step)
        self._ins = InsMeans(self._dt_ns, self._span_ns, self._step * self._dt_ns)
        self.reset()

    def reset(self):
        """Forget the open window and those that wait; the velocities of the INS are kept."""
        self._last = None
        self._waiting = deque()
        self._repeatable = False
        self._open.forget()

    def change(self, settings):
        """Use the drop-outs of these VelocityMeterSettings from the next end of a window on."""
        self._calm_ns = [(round(a * 1e9), round(b * 1e9)) for a, b in
                         zip(settings.drop_outs.start_s, settings.drop_outs.end_s)]

    @property
    def next_end_ns(self):
        """Motion time at which the next window ends, None before the first sample."""
        if self._last is None:
            return None
        index = (self._last[0] + self._dt_ns // 2) // self._dt_ns
        return (index // self._step + 1) * self._step * self._dt_ns

    def push_truth(self, t_ns, v_b, height):
        """
        Process the truth at the end of a navigation cycle; return the VelocityFixes it completes.

        The first sample may be repeated.

        Parameters
        ----------
        t_ns : motion time, ns
        v_b : velocity relative to the ground in body axes FLU, m/s
        height : above the ground, m

        Raises
        ------
        StreamFault
            On NaN, gaps, repeated or backwards stamps, and stamps between whole periods.
        """
        check_finite('truth', t_ns, v_b, (height,))
        index = (t_ns + self._dt_ns // 2) // self._dt_ns
        if abs(t_ns - index * self._dt_ns) > INTERVAL_TOLERANCE * self._dt_ns:
            raise StreamFault(f'truth at {seconds(t_ns)} lies between the cycles of rate_hz; '
                              f'expected a multiple of {self._dt_ns * 1e-9:.9g} s; the sample '
                              'was dropped', restart=False)
        self._ins.follow_truth(t_ns)
        v = self._in_antennas(v_b)
        if self._last is None:
            self._repeatable = True
        elif t_ns == self._last[0] and self._repeatable:
            return []
        else:
            check_interval('truth', t_ns, self._last[0], self._dt_ns)
            self._repeatable = False
            self._cycle(index, self._last, v, height)
        self._last = (t_ns, v, height)
        if index >= 0 and index % self._step == 0:
            self._close(index)
            self._open.begin()
        return self._complete()

    def _in_antennas(self, v_b):
        """Return V_x1, V_y1, V_z1 for a velocity in body axes FLU, floats or arrays."""
        forward, left, up = v_b
        return (self._cos * forward + self._sin * left, up,
                self._sin * forward - self._cos * left)

    def push_ins(self, t_ns, v_b):
        """
        Process a body velocity of the INS (FLU, m/s); return the VelocityFixes it completes.

        Any rate is accepted, and gaps are not reported. With attack_angle ``none`` the velocity is
        ignored, and so is a repeated stamp. A stamp that jumps back begins a new run; the fault is
        reported for the truth, which jumps back too. Raises StreamFault on NaN.
        """
        if not self._waits:
            return []
        check_finite('INS velocity', t_ns, v_b)
        self._ins.push(t_ns, v_b)
        return self._complete()

    @property
    def parted(self):
        """Return whether truth or INS has jumped back and the other has not followed."""
        return self._ins.is_parted

    @property
    def ins_reached_ns(self):
        """Return the newest INS stamp in the present run of the truth, or None."""
        return self._ins.reached_ns

    @property
    def waits_for_ns(self):
        """Return the end of the first window that waits for the INS, ns, or None."""
        return self._waiting[0][0] * self._dt_ns if self._waiting else None

    def give_up_ins(self):
        """Return the windows that wait for the INS as invalid VelocityFixes."""
        fixes = [self._fix(index, why_not, total, *UNSEEN)
                 for index, why_not, total in self._waiting]
        self._waiting.clear()
        if self._ins.is_parted:
            self._ins.forget()
        return fixes

    def rejoin(self):
        """Forget everything, including the velocities of the INS, as if both streams began now."""
        self._ins.forget()
        self.reset()

    def advance(self, t_ns, v_b, height, ins_v_b=None):
        """
        Return the VelocityFixes of a block of cycles; same bits as single pushes.

        Parameters
        ----------
        t_ns : (n,) int64 motion times, ns
        v_b : (n, 3) velocities, FLU, m/s
        height : (n,) heights above the ground, m
        ins_v_b : (n, 3) velocities of the INS at the same instants, or None

        Raises
        ------
        StreamFault
            As ``push_truth`` and ``push_ins`` do.
        """
        fixes = []
        index = (t_ns + self._dt_ns // 2) // self._dt_ns
        for a, b in pieces(index % self._step == 0):
            fixes += self._advance_truth(t_ns[a:b], v_b[a:b], height[a:b])
            if ins_v_b is not None:
                fixes += self.advance_ins(t_ns[a:b], ins_v_b[a:b])
        return fixes

    def _advance_truth(self, t_ns, v_b, height):
        """Return the fixes of cycles; only the last cycle may end a window."""
        first = len(t_ns) - 1
        if first < 2 or not self._add_cycles(t_ns[:-1], v_b[:-1], height[:-1]):
            first = 0
        fixes = []
        for t, v, h in zip(t_ns[first:].tolist(), v_b[first:].tolist(), height[first:].tolist()):
            fixes += self.push_truth(t, v, h)
        return fixes

    def _add_cycles(self, t_ns, v_b, height):
        """Add cycles to the open window together; return False if they must be pushed singly."""
        if self._last is None or not self._ins.rises(t_ns[0]):
            return False
        last_ns, v_last, height_last = self._last
        v = np.column_stack((v_last, self._in_antennas(v_b.T)))
        height, most_ns = np.append(height_last, height), INTERVAL_TOLERANCE * self._dt_ns
        off = (t_ns + self._dt_ns // 2) % self._dt_ns - self._dt_ns // 2
        if not ((abs(np.diff(t_ns, prepend=last_ns) - self._dt_ns) <= most_ns).all()
                and (abs(off) <= most_ns).all() and np.isfinite(v).all()
                and np.isfinite(height).all()):
            return False
        if self._open.measures:
            if not (self._open.adds_blocks
                    and all_measurable(self._settings.limits, v, height)):
                return False
            self._open.add_cycles(v)
        self._last = int(t_ns[-1]), tuple(v[:, -1].tolist()), float(height[-1])
        self._ins.skip_truth(self._last[0])
        self._repeatable = False
        return True

    def advance_ins(self, t_ns, v_b):
        """
        Return the VelocityFixes of a block of INS velocities; same bits as single pushes.

        t_ns (n,) int64, ns; v_b (n, 3), FLU, m/s. Raises StreamFault.
        """
        return self._ins.advance(t_ns, v_b, self.push_ins) if self._waits else []

    def _cycle(self, index, last, v, height):
        """Add the cycle that ends at ``index`` periods to the open windows."""
        if not self._open.measures:
            return
        _, v_last, height_last = last
        why_not = why_not_measurable(self._settings.limits, v_last, height_last)
        if why_not == VALID:
            why_not = why_not_measurable(self._settings.limits, v, height)
        if why_not == VALID:
            self._open.add(index, v_last, v)
        self._open.why_not = why_not

    def _close(self, index):
        """End the window at ``index`` periods, if it was seen; it then waits for its angle."""
        window = self._open.end(index)
        if window is None:
            return
        end_ns = index * self._dt_ns
        start_ns = end_ns - self._span_ns
        calm = any(a < end_ns and b > start_ns for a, b in self._calm_ns)
        self._waiting.append((index, CALM if calm else window.why_not, window.total))

    def _complete(self):
        """Return the fixes of the windows whose angle of attack is known."""
        fixes = []
        while self._waiting:
            index, why_not, total = self._waiting[0]
            angle = self._angle(index * self._dt_ns)
            if angle is None:
                break
            self._waiting.popleft()
            fixes.append(self._fix(index, why_not, total, *angle))
        return fixes

    def _angle(self, end_ns):
        """Return status, tan(alpha) and sideslip from the INS; None if not known yet."""
        if not self._waits:
            return VALID, 0.0, None
        return self._ins.angle(end_ns, self._last[0])

    def _fix(self, index, why_not, total, angle_status, tan_alpha, slip):
        """
        Return the fix of the window that ends at ``index`` periods.

        slip: sideslip from the INS, used for sigma. Taken from the fix it would correlate sigma
        with the error of the fix, and weighting would bias the velocities low (V_z by 0.7 m/s at
        N = 10).
        """
        if why_not == VALID:
            why_not = angle_status
        reading = Reading(why_not)
        if why_not == VALID:
            reading = self._method.read(total, index, tan_alpha)
        sigma = NOTHING
        if reading.status == VALID:
            if slip is None:
                slip = atan2(reading.v_z, reading.v_x)
            sigma = reported_sigmas(self._settings.surrogate, self._cycles, slip)
        end_ns = index * self._dt_ns
        return VelocityFix(
            end_ns - self._span_ns, end_ns, self._cycles, (reading.v_x, -reading.v_z), sigma,
            tan_alpha, reading.tau, reading.g, reading.status, end_ns + self._latency_ns)
