"""Settings of the node truth_adapter."""

from .field import group, setting, settings_class, SettingsGroup
from .node import LockStepPacing, Topics
from .place import Datum, Earth, Frames, Tf


@settings_class
class World(SettingsGroup):
    """The flat world of the other simulator: the plane tangent to the Earth at the datum."""

    yaw_deg: float = setting(0.0, 'angle from East to its axis x, counter-clockwise', 'deg',
                             -360.0, 360.0)


@settings_class
class TruthAdapterSettings(SettingsGroup):
    """Node truth_adapter: the odometry of another simulator in, truth out."""

    datum: Datum = group(Datum)
    earth: Earth = group(Earth)
    frames: Frames = group(Frames)
    tf: Tf = group(Tf)
    topics: Topics = group(Topics)
    pacing: LockStepPacing = group(LockStepPacing)
    world: World = group(World)
    rate_hz: float = setting(100.0, 'rate of the IMU; a denser input is fitted down to it', 'Hz',
                             0.01, 20000.0)
    truth_rate_hz: float = setting(0.0, 'rate of the truth, at least twice that of the IMU; 0 = '
                                   'twice that', 'Hz', 0.0, 40000.0)
    twist: str = setting('auto', 'whether velocity and rate of the input are believed (use), '
                         'only its poses serve (ignore), or two seconds of it decide (auto)',
                         choices=('auto', 'use', 'ignore'))
    twist_frame: str = setting('auto', 'axes of the twist of the input: those of the child, as '
                               'nav_msgs/Odometry wants it, those of the parent, or what fits the '
                               'poses (auto)', choices=('auto', 'child', 'parent'))
    smoothing_s: float = setting(0.0, 'length over which poses are smoothed where the twist is '
                                 'not believed; the truth is late by half of it', 's', 0.0, 2.0)
    stamps: str = setting('believed', 'instant of a sample: its stamp (believed), or that of a '
                          'steady rate which follows the stamps (nominal)',
                          choices=('believed', 'nominal'))
    on_fault: str = setting('reset', 'after a gap, a backwards stamp or a bad message: start '
                            'anew (reset) or end the node (stop)', choices=('reset', 'stop'))

    @property
    def truth_hz(self) -> float:
        """Rate of the truth, Hz."""
        return self.truth_rate_hz or 2.0 * self.rate_hz

    def check(self):
        """Refuse a truth too coarse for the IMU, and a window that the queues cannot hold."""
        if self.truth_hz < 2.0 * self.rate_hz:
            raise ValueError(f'truth_rate_hz is {self.truth_rate_hz:g} Hz; expected at least '
                             f'twice rate_hz, {2.0 * self.rate_hz:g} Hz, or 0 for just that')
        self.pacing.check_depth(self.topics.depth)
