"""Settings of a node that no computation depends on: time of the epoch, topics and pacing."""

import time

from .field import setting, settings_class, SettingsGroup


@settings_class
class Pacing(SettingsGroup):
    """How fast the generator goes."""

    real_time_factor: float = setting(1.0, 'simulated seconds per second; 0 = as fast as the '
                                      'slowest required consumer (implies lock_step)', '',
                                      0.0, 1e6)
    lock_step: bool = setting(False, 'wait for the acknowledgements of the required consumers')
    window: int = setting(200, 'unanswered steps allowed in lock-step', 'steps', 1, 2000)
    required: tuple[str, ...] = setting(('strapdown',), 'names of the consumers that must '
                                        'acknowledge')
    timeout_s: float = setting(30.0, 'wall time without an acknowledgement before the missing '
                               'consumer is named and the run ends', 's', 0.1, 1e5)

    def check(self):
        """Refuse lock-step without a consumer."""
        if not self.required and (self.lock_step or self.real_time_factor == 0.0):
            raise ValueError('pacing.required is empty; lock-step expects at least one consumer')


# 2025-01-01: a stamp that tools take for one, and early enough for long runs.
EPOCH_S = 1735689600
MILLISECOND = 1_000_000


@settings_class
class Time(SettingsGroup):
    """Stamp of motion time zero; motion_generator announces it on sim/run."""

    epoch: str = setting('auto', 'now: such that the first stamp is the time of the wall clock at '
                         'the start; fixed: epoch_s; auto: epoch_s where it is not the default, '
                         'else live now, and offline fixed, so that a run can be repeated',
                         choices=('auto', 'now', 'fixed'))
    epoch_s: int = setting(EPOCH_S, 'stamp of motion time zero', 's', 0, 2147483647)

    @property
    def given(self):
        """Whether epoch_s counts, live as well."""
        return self.epoch == 'fixed' or self.epoch == 'auto' and self.epoch_s != EPOCH_S

    def epoch_ns(self, first_ns, live):
        """
        Return the stamp of motion time zero, ns; one that is taken from the clock in whole ms.

        first_ns: motion time of the first sample; live: whether the run goes with the wall clock.
        """
        if self.given or self.epoch == 'auto' and not live:
            return 1_000_000_000 * self.epoch_s
        return time.time_ns() // MILLISECOND * MILLISECOND - first_ns


@settings_class
class Topics(SettingsGroup):
    """Quality of service of the data topics (reliable, volatile)."""

    depth: int = setting(10000, 'queue depth of publishers and subscriptions', 'messages', 1,
                         100000)


@settings_class
class OneProcessSettings(SettingsGroup):
    """Which nodes the executable simulation holds."""

    aided: bool = setting(False, 'velocity_meter, gnss and aided_navigator run beside '
                          'motion_generator, imu_sensor and strapdown')
