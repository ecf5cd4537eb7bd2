"""The first two seconds of an input, from which its quality is judged."""

from typing import NamedTuple

from ..faults import StreamFault
from .fit import KnotFit
from .judgement import FEWEST, judged, Judgement
from .scheme import chosen, knot_count, report, Scheme
from .stamps import gap_fault, NominalClock, round_period_ns, Steadiness, steadiness
from .steps import StepCheck

# Length of the first look, and the largest number of samples in it.
LOOK_NS, MOST = 2_000_000_000, 8192


class Beginning(NamedTuple):
    """
    The result of the first look.

    Attributes
    ----------
    steady : Steadiness of the stamps
    judgement : Judgement of the samples
    scheme : Scheme that is chosen
    samples : the samples, at the instants to which they belong
    clock : NominalClock that continues these instants, or None if stamps are used as they are
    sentence : report for the log
    """

    steady: Steadiness
    judgement: Judgement
    scheme: Scheme
    samples: list
    clock: NominalClock | None
    sentence: str


class FirstLook:
    """
    Collects samples until there are enough to judge the input.

    Parameters
    ----------
    settings : TruthAdapterSettings
    name : name of the input, for messages
    dt_ns : period of the IMU, ns
    """

    def __init__(self, settings, name, dt_ns):
        self._settings, self._name, self._dt_ns = settings, name, dt_ns
        self._samples = []

    @property
    def first_ns(self):
        """The stamp of the only sample so far, or None."""
        return self._samples[0].t_ns if len(self._samples) == 1 else None

    def push(self, sample):
        """
        Process a Sample; return a Beginning, or None if more samples are needed.

        Raises StreamFault if samples before a gap or a jump had to be dropped.
        """
        samples = self._samples
        samples.append(sample)
        count, span_ns = len(samples), sample.t_ns - samples[0].t_ns
        if count < MOST and (span_ns < LOOK_NS or span_ns < FEWEST * self._dt_ns
                             or count < FEWEST):
            return None
        steady, line = steadiness([s.t_ns for s in samples])
        for k in range(count - 1, 0, -1):
            if samples[k].t_ns - samples[k - 1].t_ns > steady.longest_ns:
                self._samples = samples[k:]
                raise gap_fault(self._name, samples[k - 1].t_ns, samples[k].t_ns,
                                steady.longest_ns, restart=False)
        clock = None
        if self._settings.stamps == 'nominal':
            # Instants at the round period, through the middle of the line through the stamps.
            part = round_period_ns(steady, count) / steady.period_ns
            half_ns = 0.5 * float(line[-1])
            base_ns = samples[0].t_ns + half_ns * (1.0 - part)
            samples = [s._replace(t_ns=round(base_ns + part * x))
                       for s, x in zip(samples, line.tolist())]
            clock = NominalClock(samples[-1].t_ns, part * steady.period_ns)
        every = min(knot_count(steady.period_ns, self._dt_ns), count // FEWEST)
        thin = KnotFit(every, 0.0, steady.period_ns)
        knots = [knot for s in samples for knot in thin.push(s)]
        if len(knots) < FEWEST - 2:
            # The stamps are so irregular that hardly any is half a period after another.
            self._samples = []
            raise StreamFault(f'{self._name} has irregular stamps, so that its rate is unknown; '
                              'expected regular stamps; its samples were dropped', restart=False)
        frame = self._settings.twist_frame
        judgement = judged(knots, None if frame == 'auto' else frame == 'parent')
        self._check_steps(knots, judgement.spread_m)
        scheme = chosen(self._settings, judgement, steady, self._dt_ns)
        return Beginning(steady, judgement, scheme, samples, clock,
                         report(self._name, scheme, judgement, steady))

    def _check_steps(self, knots, spread_m):
        """Raise StreamFault if knots jump or turn too far; keep the samples from there on."""
        steps = StepCheck(self._name)
        for knot in knots:
            try:
                steps.check(knot, spread_m)
            except StreamFault as fault:
                self._samples = [s for s in self._samples if s.t_ns >= knot.t_ns]
                raise StreamFault(str(fault), restart=False) from None
