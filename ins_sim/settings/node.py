"""Settings of a node that do not affect its computation: epoch, topics and pacing."""

import time

from .field import setting, settings_class, SettingsGroup


@settings_class
class LockStepPacing(SettingsGroup):
    """Lock-step: how the node that sets the pace waits for the consumers of its messages."""

    lock_step: bool = setting(False, 'Whether to wait for the acknowledgements of the required '
                              'consumers')
    window: int = setting(200, 'Number of unacknowledged steps allowed in lock-step', 'steps', 1,
                          2000)
    required: tuple[str, ...] = setting(('strapdown',), 'Names of the consumers that must '
                                        'acknowledge each step in lock-step')
    timeout_s: float = setting(30.0, 'Wall-clock time without an acknowledgement after which the '
                               'run ends with an error that names the missing consumer', 's', 0.1,
                               1e5)

    @property
    def waits(self) -> bool:
        """Whether the node waits for its consumers."""
        return self.lock_step

    def check(self):
        """Raise ValueError if lock-step has no consumer."""
        if not self.required and self.waits:
            raise ValueError('pacing.required is empty; expected at least one consumer in '
                             'lock-step')

    def check_depth(self, depth):
        """Raise ValueError if the window exceeds the queue depth topics.depth."""
        if self.window > depth:
            raise ValueError(f'pacing.window is {self.window}; expected at most topics.depth, '
                             f'{depth}, because a queue must hold a window')


@settings_class
class Pacing(LockStepPacing):
    """Speed of the simulation."""

    real_time_factor: float = setting(1.0, 'Simulated seconds per wall-clock second; 0 = as fast '
                                      'as the slowest required consumer (implies lock_step)', '',
                                      0.0, 1e6)

    @property
    def waits(self) -> bool:
        """Whether the node waits for its consumers."""
        return self.lock_step or self.real_time_factor == 0.0


# 2025-01-01: a plausible date for other tools, and years before the last ROS stamp, in 2038.
EPOCH_S = 1735689600
MILLISECOND = 1_000_000


@settings_class
class Time(SettingsGroup):
    """Stamp of motion time zero; motion_generator announces it on sim/run."""

    epoch: str = setting('auto', 'Stamp of motion time zero. now: chosen so that the first stamp '
                         'is the wall-clock time at the start; fixed: epoch_s; auto: epoch_s if '
                         'it differs from its default, otherwise now in a live run and fixed '
                         'offline, so that offline runs can be repeated',
                         choices=('auto', 'now', 'fixed'))
    epoch_s: int = setting(EPOCH_S, 'Stamp of motion time zero, if time.epoch is fixed or auto',
                           's', 0, 2147483647)

    @property
    def given(self):
        """Whether epoch_s is used, also in a live run."""
        return self.epoch == 'fixed' or self.epoch == 'auto' and self.epoch_s != EPOCH_S

    def epoch_ns(self, first_ns, live):
        """
        Return the stamp of motion time zero, ns.

        Parameters
        ----------
        first_ns : motion time of the first sample, ns
        live : whether this is a live run, whose epoch follows the clock (to whole milliseconds)
        """
        if self.given or self.epoch == 'auto' and not live:
            return 1_000_000_000 * self.epoch_s
        return time.time_ns() // MILLISECOND * MILLISECOND - first_ns


@settings_class
class Topics(SettingsGroup):
    """Quality of service of the data topics (reliable, volatile)."""

    depth: int = setting(10000, 'Queue depth of publishers and subscriptions', 'messages', 1,
                         100000)


@settings_class
class OneProcessSettings(SettingsGroup):
    """Nodes in the process of the executable simulation."""

    aided: bool = setting(False, 'Whether velocity_meter, gnss and aided_navigator run in the '
                          'process as well, besides motion_generator, imu_sensor and strapdown')
