"""Settings that all nodes share: the datum, the Earth, and the frames of the vehicle."""

from .field import setting, settings_class, SettingsGroup

# The change from Cartesian coordinates to latitude, longitude and height holds up to here.
HIGHEST_M = 1e6
# The frames that have a name of their own among the settings.
ROLES = ('map', 'odom', 'base_link', 'imu_link', 'gnss_link', 'velocity_meter_link')
# Axes in which some topics are resolved: East, North, Up at the vehicle, and along a leg.
AXES = ('enu', 'leg')


@settings_class
class Datum(SettingsGroup):
    """Origin of ``map``; the bench motions stand there."""

    latitude_deg: float = setting(55.75, 'geodetic latitude', 'deg', -89.9, 89.9)
    longitude_deg: float = setting(37.62, 'longitude', 'deg', -180.0, 180.0)
    height_m: float = setting(0.0, 'height above the WGS-84 ellipsoid', 'm', -500.0, HIGHEST_M)


@settings_class
class Earth(SettingsGroup):
    """The Earth of the truth and of the navigation; a node has its own."""

    rotation: bool = setting(True, 'the Earth rotates, in the truth and in the navigation')
    gravity: str = setting('free_air', 'normal gravity by height: free_air, of first order (off '
                           'by 14 ug at 10 km, 180 ug at 50 km, 1.7 % at 500 km), or '
                           'second_order (off by 2 ug at 50 km, 0.2 % at 500 km)',
                           choices=('free_air', 'second_order'))


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
                plain = 'uav1, which makes uav1/map' if name == 'prefix' else name
                raise ValueError(f'frames.{name} is {text!r}; expected no slash at its ends, as '
                                 f'in {plain}')
            if ' ' in text or not text.isprintable() or '//' in text or (
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


@settings_class
class Tf(SettingsGroup):
    """Transforms on /tf and /tf_static, the same in all nodes of a vehicle."""

    source: str = setting('none', 'who places the vehicle on /tf. truth: map -> base_link; ins: '
                          'odom -> base_link by strapdown, map -> odom fixed at the start; aided: '
                          'odom -> base_link by strapdown, map -> odom by aided_navigator; none: '
                          'no transforms. With all others /tf_static holds the instruments',
                          choices=('none', 'truth', 'ins', 'aided'))
