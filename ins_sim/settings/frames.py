"""Settings of the frames: their names, and which of their transforms are published."""

from .field import setting, settings_class, SettingsGroup

# The frames that have a name of their own among the settings.
ROLES = ('map', 'odom', 'base_link', 'imu_link', 'gnss_link', 'velocity_meter_link')
# Axes in which some topics are resolved: East, North, Up at the vehicle, and along a leg.
AXES = ('enu', 'leg')
# Characters that no name of a frame holds.
_FOREIGN = ' \t\r\n'


@settings_class
class Frames(SettingsGroup):
    """Names of the frames (REP-105), the same in all nodes of a vehicle."""

    prefix: str = setting('', 'name of the vehicle, put before every frame with a slash: uav1 '
                          'makes uav1/map, uav1/base_link, ...')
    map: str = setting('map', 'East, North, Up at the datum: truth and the aided solution')
    odom: str = setting('odom', 'the same axes as the free INS has them, which drift')
    base_link: str = setting('base_link', 'the vehicle: forward, left, up')
    imu_link: str = setting('imu_link', 'the IMU')
    gnss_link: str = setting('gnss_link', 'the antenna of GNSS')
    velocity_meter_link: str = setting('velocity_meter_link', 'the antennas of the velocity meter')

    def check(self):
        """Refuse names that TF does not take, and two frames of one name."""
        given = {name: getattr(self, name) for name in ('prefix', *ROLES)}
        for name, text in given.items():
            if text.startswith('/') or text.endswith('/'):
                raise ValueError(f'frames.{name} is {text!r}; expected no slash at its ends, as in '
                                 + ("'uav1', which makes uav1/map" if name == 'prefix' else
                                    repr(name)))
            if any(c in text for c in _FOREIGN) or not text.isprintable() or '//' in text or (
                    not text and name != 'prefix'):
                raise ValueError(f'frames.{name} is {text!r}; expected a name without spaces and '
                                 f'empty parts, such as {"uav1" if name == "prefix" else name}')
        seen = {text: text for text in AXES}
        for name in ROLES:
            other = seen.setdefault(given[name], f'frames.{name}')
            if other != f'frames.{name}':
                raise ValueError(f'frames.{name} is {given[name]!r}, which is {other} too; '
                                 'expected another name for every frame')

    def names(self):
        """Return {frame of ``messages.topics``: its name, with the prefix}."""
        before = f'{self.prefix}/' if self.prefix else ''
        return {role: before + getattr(self, role, role) for role in (*ROLES, *AXES)}


TF_SOURCES = ('none', 'truth', 'ins', 'aided')


@settings_class
class Tf(SettingsGroup):
    """Transforms on /tf and /tf_static, the same in all nodes of a vehicle."""

    source: str = setting('none', 'who places the vehicle on /tf. truth: map -> base_link; ins: '
                          'odom -> base_link by strapdown, map -> odom fixed at the start; aided: '
                          'odom -> base_link by strapdown, map -> odom by aided_navigator; none: '
                          'no transforms. With all others /tf_static holds the instruments',
                          choices=TF_SOURCES)
