"""Settings of a node that no computation depends on: time of the epoch, topics and pacing."""

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


@settings_class
class Time(SettingsGroup):
    """Zero of motion time."""

    epoch_s: int = setting(0, 'stamp of motion time zero', 's', 0, 2147483647)


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
