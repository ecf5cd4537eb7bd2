"""Settings of the node truth_adapter."""

from .field import group, setting, settings_class, SettingsGroup
from .node import LockStepPacing, Topics
from .place import Datum, Earth, Frames, Tf


@settings_class
class World(SettingsGroup):
    """Flat world of the other simulator: the plane tangent to the Earth at the datum."""

    yaw_deg: float = setting(0.0, 'Angle from East to the x axis of the world, counter-clockwise',
                             'deg', -360.0, 360.0)


@settings_class
class TruthAdapterSettings(SettingsGroup):
    """Settings of the node truth_adapter (odometry of another simulator in, truth out)."""

    datum: Datum = group(Datum)
    earth: Earth = group(Earth)
    frames: Frames = group(Frames)
    tf: Tf = group(Tf)
    topics: Topics = group(Topics)
    pacing: LockStepPacing = group(LockStepPacing)
    world: World = group(World)
    rate_hz: float = setting(100.0, 'Rate of the IMU; denser input is reduced to it by a fit',
                             'Hz', 0.01, 20000.0)
    truth_rate_hz: float = setting(0.0, 'Rate of the published truth, at least twice rate_hz; 0 = '
                                   'exactly twice rate_hz', 'Hz', 0.0, 40000.0)
    twist: str = setting('auto', 'Whether velocity and angular rate of the input are used: use; '
                         'ignore (they are computed from the poses); auto (decided from the first '
                         'two seconds)', choices=('auto', 'use', 'ignore'))
    twist_frame: str = setting('auto', 'Axes in which the twist of the input is resolved. child: '
                               'the child frame, as nav_msgs/Odometry requires; parent: the '
                               'parent frame; auto: the one that fits the poses',
                               choices=('auto', 'child', 'parent'))
    smoothing_s: float = setting(0.0, 'Length over which poses are smoothed when the twist is not '
                                 'used; it delays the truth by half of this time', 's', 0.0, 2.0)
    stamps: str = setting('believed', 'Instant of a sample. believed: its stamp; nominal: the '
                          'instant of a steady rate that follows the stamps',
                          choices=('believed', 'nominal'))
    on_fault: str = setting('reset', 'What the node does after a gap, a backward time stamp or an '
                            'invalid message: start anew (reset) or end (stop)',
                            choices=('reset', 'stop'))

    @property
    def truth_hz(self) -> float:
        """Rate of the truth, Hz."""
        return self.truth_rate_hz or 2.0 * self.rate_hz

    def check(self):
        """Raise ValueError on too low a truth rate or a window above the queue depth."""
        if self.truth_hz < 2.0 * self.rate_hz:
            raise ValueError(f'truth_rate_hz is {self.truth_rate_hz:g} Hz; expected at least '
                             f'twice rate_hz, {2.0 * self.rate_hz:g} Hz, or 0 for exactly that')
        self.pacing.check_depth(self.topics.depth)
