"""The complete aided chain offline: six stages, with the numbers of the six nodes in lock-step."""

from dataclasses import replace

from ins_sim.core.earth.rates import body_velocity
from ins_sim.core.sensors.gnss import Gnss
from ins_sim.core.sensors.velocity_meter.meter import VelocityMeter
from ins_sim.core.sensors.velocity_meter.over_truth import MeterOnTruth
from .aided_run import navigate_aided, Reported, with_truth
from .inertial import truth_blocks


def make_instruments(settings):
    """
    Return velocity meter and GNSS of AidedSimulationSettings, before their first fix.

    Make them before the run that they serve.

    Raises
    ------
    ValueError
        If the settings of an instrument are invalid.
    """
    return MeterOnTruth(VelocityMeter(settings.velocity_meter)), Gnss(settings.gnss)


def simulate_aided(settings, instruments, motion, run, progress=None):
    """
    Run velocity meter, GNSS and aided navigator on the result of the first three stages.

    The instruments see the truth of the generator even where the IMU loses samples.

    Parameters
    ----------
    settings : AidedSimulationSettings
    instruments
        Result of ``make_instruments``; they can be used for one run only.
    motion : Motion
        The motion of the run.
    run : SimulationResult
        Its solution, at its output rate, gives the velocity meter the angle of attack, as
        ins/odometry does for the nodes.
    progress : callable, optional
        Called with the fraction done.

    Returns
    -------
    AidedResult

    Raises
    ------
    ValueError
        As the stages do.
    """
    meter, gnss = instruments
    meter.follow_ins(run.states.t_ns, body_velocity(run.states))
    generator = settings.simulation.motion_generator
    velocity_fixes, gnss_fixes = [], []
    done, total = 0, 2 * len(run.imu)

    def went(count):
        nonlocal done
        done += count
        if progress is not None:
            progress(min(1.0, done / total))

    for truth in truth_blocks(generator, motion):
        velocity_fixes += meter.advance(truth)
        gnss_fixes += gnss.advance(truth)
        went(len(truth))
    velocity_fixes += meter.finish()

    def blocks():
        for imu in _blocks(run.imu):
            yield imu
            went(len(imu))

    flown = navigate_aided(settings.aided_navigator, with_truth(motion, blocks()),
                           Reported(velocity_fixes), Reported(gnss_fixes))
    return replace(flown, velocity_fixes=tuple(velocity_fixes), gnss_fixes=tuple(gnss_fixes))


def _blocks(imu, length=4096):
    for first in range(0, len(imu), length):
        yield imu[first:first + length]
