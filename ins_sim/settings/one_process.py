"""Settings of the executable simulation."""

from .field import setting, settings_class, SettingsGroup


@settings_class
class OneProcessSettings(SettingsGroup):
    """Which nodes one process holds."""

    aided: bool = setting(False, 'velocity_meter, gnss and aided_navigator run beside '
                          'motion_generator, imu_sensor and strapdown')
