"""The stage that turns the odometry of another simulator into truth."""

import math

from ins_sim.core.attitude import quaternion
from ins_sim.core.earth import ellipsoid
from ins_sim.core.earth.frames import MapFrame
from ins_sim.core.numerics.elementary import sincos
from ins_sim.core.numerics.instants import period_ns
from ..faults import check_finite, check_unit, StreamFault
from .first_look import FirstLook
from .fit import KnotFit
from .knots import Sample
from .pose_knots import PoseKnots
from .sensed import sensed
from .stamps import NominalClock, StampCheck
from .steps import StepCheck
from .twist_knots import TwistKnots
from .watch import Watch


class TruthAdapter:
    """
    Takes poses and twists of another simulator and returns truth at its own rate.

    The first two seconds are only judged and yield no truth. The instants of the truth begin at a
    multiple of the period of rate_hz.

    Parameters
    ----------
    settings : TruthAdapterSettings
    name : str
        Name of the input, for messages.

    Attributes
    ----------
    notes : list of str
        Sentences about the input and how it is used; the owner removes them.
    """

    def __init__(self, settings, name='odom'):
        self._settings, self._name = settings, name
        self._frame = MapFrame(settings.datum, settings.earth.rotation)
        self._terms = ellipsoid.GRAVITY_TERMS[settings.earth.gravity]
        self._imu_ns = period_ns(settings.rate_hz)
        self._dt_ns = period_ns(settings.truth_hz)
        sin, cos = sincos(0.5 * math.radians(settings.world.yaw_deg))
        self._q_mw = (0.0, 0.0, sin, cos)
        self.notes = []
        self.begin()

    def begin(self):
        """Forget everything, including the judgement of the input."""
        self._watch = self._steady = None
        self.reset()

    def reset(self):
        """Forget the stream, but keep the judgement of the input."""
        self._stamps, self._steps = StampCheck(self._name, self._imu_ns), StepCheck(self._name)
        self._look, self._clock, self._next_ns = None, None, None
        if self._watch is None:
            self._look = FirstLook(self._settings, self._name, self._imu_ns)
        else:
            self._watch.restart()
            self._start()

    def _start(self):
        """Set up the knots of the present scheme."""
        scheme = self._watch.scheme
        self._fit = KnotFit(scheme.every, scheme.half_ns, self._steady.period_ns)
        self._knots = TwistKnots(scheme.in_parent, scheme.hold) if scheme.by_twist \
            else PoseKnots()

    @property
    def state(self):
        """A few words on how the input is used."""
        if self._watch is None:
            return 'being judged'
        scheme = self._watch.scheme
        return (f'twist believed, in the {"parent" if scheme.in_parent else "child"} frame'
                if scheme.by_twist else 'poses only')

    def push(self, t_ns, r, q, v, w):
        """
        Process a sample; return a list of the AdaptedTruth that it completes.

        The first sample may be repeated. Raises StreamFault for a sample that cannot be used.

        Parameters
        ----------
        t_ns : int
            Motion time, ns.
        r, q : tuples
            Pose of the child in the world: position, m, and quaternion of either sign.
        v, w : tuples
            Linear and angular velocity, m/s and rad/s.
        """
        if self._look is not None and t_ns == self._look.first_ns:
            return []
        check_finite(self._name, t_ns, r, q, v, w)
        check_unit(self._name, t_ns, q)
        n = 1.0 / math.sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3])
        sample = Sample(t_ns, r, (q[0] * n, q[1] * n, q[2] * n, q[3] * n), v, w)
        try:
            self._stamps.check(t_ns, self._steady)
            return self._taken(sample)
        except StreamFault as fault:
            if fault.restart and self._next_ns is None:
                # No truth came of the judgement, so the input must have changed: judge it again.
                self.begin()
            raise

    def _taken(self, sample):
        if self._look is not None:
            self._begin_with(self._look.push(sample))
            return []
        if self._settings.stamps == 'nominal':
            if self._clock is None:
                self._clock = NominalClock(sample.t_ns, self._steady.period_ns)
            else:
                sample = sample._replace(t_ns=self._clock.instant(sample.t_ns))
        truths = []
        for knot in self._fit.push(sample):
            self._steps.check(knot, self._watch.spread_m)
            truths += self._truths(self._knots.push(knot))
            changed = self._watch.push(knot)
            if changed:
                self.notes.append(changed)
                self._start()
                for known in self._watch.knots:
                    self._knots.push(known)
        return truths

    def _begin_with(self, beginning):
        """Continue after the first look with its samples and its scheme."""
        if beginning is None:
            return
        self._steady, self._clock = beginning.steady, beginning.clock
        self._watch = Watch(self._settings, self._name, self._imu_ns, beginning)
        self._look = None
        self.notes.append(beginning.sentence)
        self._start()
        for sample in beginning.samples:
            for knot in self._fit.push(sample):
                self._steps.check(knot, self._watch.spread_m)
                self._watch.push(knot)
                piece = self._knots.push(knot)
                if piece is not None:
                    self._next_ns = self._first_instant(piece.end_ns)

    def _first_instant(self, t_ns):
        """Return the first multiple of the IMU's period that is not before t_ns."""
        return -(-t_ns // self._imu_ns) * self._imu_ns

    def _truths(self, piece):
        """Return a list of the AdaptedTruth at the instants that a Piece (or None) covers."""
        truths = []
        if piece is None:
            return truths
        if self._next_ns is None:
            self._next_ns = self._first_instant(piece.start_ns)
        while self._next_ns <= piece.end_ns:
            motion = piece.at(self._next_ns)
            if self._settings.world.yaw_deg:
                motion = self._in_map(*motion)
            truths.append(sensed(self._frame, self._terms, self._next_ns, motion))
            self._next_ns += self._dt_ns
        return truths

    def _in_map(self, r, v, a, q, omega):
        turn = self._q_mw
        return (*(quaternion.rotate(turn, x) for x in (r, v, a)), quaternion.multiply(turn, q),
                omega)
