"""The aided chain offline: six stages with the same results as the six nodes in lock-step."""

from dataclasses import replace

from ins_sim.core.earth.rates import body_velocity
from ins_sim.core.sensors.gnss import Gnss
from ins_sim.core.sensors.velocity_meter.meter import VelocityMeter
from ins_sim.core.sensors.velocity_meter.over_truth import MeterOnTruth
from .aided_run import navigate_aided, Reported, with_truth
from .inertial import truth_blocks


def make_instruments(settings):
    """
    Return the velocity meter and GNSS of AidedSimulationSettings, before their first fix.

    They measure the truth. Raises ValueError if the settings are invalid: call this before the run
    that needs them.
    """
    return MeterOnTruth(VelocityMeter(settings.velocity_meter)), Gnss(settings.gnss)


def simulate_aided(settings, instruments, motion, run, progress=None):
    """
    Return the AidedResult for a SimulationResult of the first three stages.

    The instruments measure the truth of the generator, even where the IMU loses samples.

    Parameters
    ----------
    settings : AidedSimulationSettings
    instruments : result of ``make_instruments``; can be used only once
    motion : Motion of the run
    run : SimulationResult; its solution, at its output instants, supplies the angle of attack to
        the velocity meter, as ins/odometry does
    progress : called with the fraction done

    Raises
    ------
    ValueError : as the stages do

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
