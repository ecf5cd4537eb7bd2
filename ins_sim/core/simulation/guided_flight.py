"""The closed loop offline: motion, sensors, navigation and autopilot, period by period."""

from dataclasses import dataclass

import numpy as np

from ins_sim.core.guidance.aided_margin import aided_margin_sentence
from ins_sim.core.guidance.steering import margin_sentence, Steering
from ins_sim.core.motion.guided.motion import GuidedMotion
from ins_sim.core.numerics.garbage_collection import paused_in_blocks
from ins_sim.core.numerics.instants import period_ns
from ins_sim.core.timeseries.histories import SteeredStates, SteeringEstimates
from ins_sim.settings.guidance import AIDED_SOLUTION, INS_SOLUTION
from .guided_chain import SteeringChain

# Number of control periods between two calls of progress.
PIECE = 1024


@dataclass(frozen=True)
class GuidedResult:
    """
    History of the steering at the control instants.

    Attributes
    ----------
    estimates : what the autopilot received
    states : true state of the vehicle
    notes : a sentence for each kind of event
    counts : pairs of the reason why the autopilot did not steer, or 'limited', and the number of
        such control instants

    """

    estimates: SteeringEstimates
    states: SteeredStates
    notes: tuple = ()
    counts: tuple = ()


def fly(settings, motion, aided=None, progress=None):
    """
    Steer a guided motion through a whole run and return the GuidedResult.

    Afterwards the motion is known as flown. The usual simulations can then be run on it without
    steering; they give the same bits as the loop.

    Parameters
    ----------
    settings : SimulationSettings
    motion : Motion
        The motion of the settings. If it is not guided, nothing is done and None is returned.
    aided : AidedSimulationSettings, optional
        If given, the aided solution steers, unless guidance.topic is that of the strapdown;
        otherwise the solution of the strapdown steers.
    progress : callable, optional
        Called with the fraction done, 0 to 1.

    Raises
    ------
    ValueError
        If the run ends after the last turning point, if the control instants of the motion are
        not sampling instants, or as the stages do.
    """
    if not isinstance(motion, GuidedMotion):
        return None
    generator = settings.motion_generator
    if generator.duration_s == 0.0:
        raise ValueError('duration_s is 0, endless; expected a length in s for an offline run')
    motion.length_s(generator.start_s, generator.duration_s)
    steering = Steering(generator.guidance, motion.route.legs, motion.turns)
    if motion.period_ns % period_ns(generator.rate_hz):
        raise ValueError(f'the control period of the motion is {motion.period_ns} ns; expected a '
                         f'multiple of the period of rate_hz, {period_ns(generator.rate_hz)} ns')
    aided = _who_steers(settings, aided, steering.notes)
    sentence = margin_sentence(generator.guidance, generator.motion.guided)
    if sentence is None and aided is not None:
        sentence = aided_margin_sentence(generator, aided.aided_navigator)
    if sentence:
        steering.notes.append(sentence)
    commands = []
    for done in _periods(settings, motion, SteeringChain(settings, motion, aided), steering,
                         commands):
        if progress is not None:
            progress(done)
    t_ns, beta, z, v_z, why = (np.array(column) for column in zip(*commands))
    return GuidedResult(SteeringEstimates(t_ns, z, v_z, beta, why == ''), motion.states(t_ns),
                        tuple(steering.notes), tuple(steering.counts.items()))


def _who_steers(settings, aided, notes):
    """Return the AidedSimulationSettings whose solution steers, or None for the strapdown's."""
    topic = settings.motion_generator.guidance.topic
    if topic == INS_SOLUTION:
        aided = None
    steers = INS_SOLUTION if aided is None else AIDED_SOLUTION
    if topic != steers:
        notes.append(f'guidance.topic is {topic}, which this run does not simulate: the vehicle '
                     f'is steered by {steers}')
    return aided


@paused_in_blocks
def _periods(settings, motion, chain, steering, commands):
    """Fly the run, append the SteeringCommands to commands, and yield the fraction done."""
    generator = settings.motion_generator
    dt_ns, period = period_ns(generator.rate_hz), motion.period_ns
    first_ns = round(generator.start_s * 1e9)
    # A channel with negative delay needs the motion this far beyond the last instant.
    span_ns = round(generator.duration_s * 1e9) // dt_ns * dt_ns + settings.lead_ns
    count = -(-span_ns // period)
    motion.begin(first_ns)
    per_period = period // dt_ns
    for step in range(count * per_period + 1):
        t_ns = first_ns + step * dt_ns
        for stamp_ns, solution in chain.push(t_ns, motion.one(t_ns)):
            steering.take(stamp_ns, solution)
        if step % per_period == 0:
            commands.append(steering.command(t_ns))
            if step < count * per_period:
                motion.command(t_ns, commands[-1].beta)
            if len(commands) % PIECE == 0:
                yield step / (count * per_period)
    yield 1.0
