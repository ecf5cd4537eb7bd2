"""The whole aided chain offline: six stages, the numbers of the six nodes in lock-step."""

from dataclasses import dataclass

from .aided_run import aid, with_truth
from .aided_settings import AidedNavigatorSettings
from .gnss import Gnss
from .gnss_settings import GnssSettings
from .meter_on_truth import body_velocity, MeterOnTruth
from .simulation import Settings
from .velocity_meter import VelocityMeter
from .velocity_meter_settings import VelocityMeterSettings

# what both sides of a fix must have alike: (instrument, keys)
AGREED = (('velocity_meter', ('rate_hz', 'window')), ('gnss', ('gnss',)))


@dataclass(frozen=True)
class AidedSettings:
    """Settings of the six stages; raises ValueError where both sides of a fix do not agree."""

    simulation: Settings
    velocity_meter: VelocityMeterSettings
    gnss: GnssSettings
    aided_navigator: AidedNavigatorSettings

    def __post_init__(self):
        """Refuse what a live navigator would report with every fix."""
        navigator, sensor = self.aided_navigator, self.simulation.imu_sensor
        for name, keys in AGREED:
            for key in keys:
                theirs, ours = getattr(getattr(self, name), key), getattr(navigator, key)
                if theirs != ours:
                    raise ValueError(f'aided_navigator: {key} is {ours}; expected that of {name}, '
                                     f'{theirs}: a fix has one schedule on both sides')
        if navigator.rate_hz != sensor.rate_hz:
            raise ValueError(f'aided_navigator: rate_hz is {navigator.rate_hz:g} Hz; expected '
                             f'that of imu_sensor, {sensor.rate_hz:g} Hz')
        if navigator.input != sensor.output:
            raise ValueError(f'aided_navigator: input is {navigator.input}; expected the output '
                             f'of imu_sensor, {sensor.output}')

    def instruments(self, ins=None):
        """Return the velocity meter and GNSS on the truth, new ones; ins: as of MeterOnTruth."""
        return MeterOnTruth(VelocityMeter(self.velocity_meter), ins), Gnss(self.gnss)


def simulate_aided(settings, motion, run):
    """
    Return the AidedRun on a Run of the first three stages.

    settings: AidedSettings; motion: that of the run; run: simulation.Run with every step put out
    (strapdown.output_every 1), whose body velocity gives the angle of attack.
    """
    meter, gnss = settings.instruments((run.states.t_ns, body_velocity(run.states)))
    return aid(settings.aided_navigator, with_truth(motion, _blocks(run.imu)), meter, gnss)


def _blocks(imu, length=4096):
    for first in range(0, len(imu), length):
        yield imu[first:first + length]
