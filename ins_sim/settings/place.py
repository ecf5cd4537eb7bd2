"""Settings shared by all nodes: datum, Earth model, frames of the vehicle and transforms."""

from .field import setting, settings_class, SettingsGroup

# The conversion from Cartesian coordinates to latitude, longitude, height is accurate up to here.
HIGHEST_M = 1e6
# The frames whose names are settings.
ROLES = ('map', 'odom', 'base_link', 'imu_link', 'gnss_link', 'velocity_meter_link')
# Axes without a frame setting: East, North, Up at the vehicle, and along a leg.
AXES = ('enu', 'leg')


@settings_class
class Datum(SettingsGroup):
    """Datum: origin of the frame ``map`` and position of the bench motions."""

    latitude_deg: float = setting(55.75, 'Geodetic latitude of the datum', 'deg', -89.9, 89.9)
    longitude_deg: float = setting(37.62, 'Longitude of the datum', 'deg', -180.0, 180.0)
    height_m: float = setting(0.0, 'Height of the datum above the WGS-84 ellipsoid', 'm', -500.0,
                              HIGHEST_M)


@settings_class
class Earth(SettingsGroup):
    """Earth model; set it under ``/**`` so that truth and navigation use the same."""

    rotation: bool = setting(True, 'Whether the Earth rotates, in the truth and in the navigation')
    gravity: str = setting('free_air', 'Model of normal gravity above the ellipsoid. free_air: '
                           'first order in height (error 14 ug at 10 km, 180 ug at 50 km, 1.7 % '
                           'at 500 km); second_order: error 2 ug at 50 km, 0.2 % at 500 km',
                           choices=('free_air', 'second_order'))


@settings_class
class Frames(SettingsGroup):
    """Names of the frames (REP-105); all nodes of a vehicle need the same."""

    prefix: str = setting('', 'Name of the vehicle, put before the name of every frame: uav1 '
                          'gives uav1/map, uav1/base_link, ...')
    map: str = setting('map', 'Frame East, North, Up at the datum, of truth and aided solution')
    odom: str = setting('odom', 'Frame of the free INS solution, which drifts relative to map')
    base_link: str = setting('base_link', 'Frame of the vehicle: forward, left, up')
    imu_link: str = setting('imu_link', 'Frame of the IMU')
    gnss_link: str = setting('gnss_link', 'Frame of the GNSS antenna')
    velocity_meter_link: str = setting('velocity_meter_link', 'Frame of the antennas of the '
                                       'velocity meter')

    def check(self):
        """Raise ValueError on a name that TF does not accept or that occurs twice."""
        given = {name: getattr(self, name) for name in ('prefix', *ROLES)}
        for name, text in given.items():
            if text.startswith('/') or text.endswith('/'):
                plain = 'uav1, which makes uav1/map' if name == 'prefix' else name
                raise ValueError(f'frames.{name} is {text!r}; expected no slash at its ends, as '
                                 f'in {plain}')
            if ' ' in text or not text.isprintable() or '//' in text or (
                    not text and name != 'prefix'):
                raise ValueError(f'frames.{name} is {text!r}; expected a name without spaces or '
                                 f'empty parts, such as {"uav1" if name == "prefix" else name}')
        seen = {text: text for text in AXES}
        for name in ROLES:
            other = seen.setdefault(given[name], f'frames.{name}')
            if other != f'frames.{name}':
                raise ValueError(f'frames.{name} is {given[name]!r}, which is already used for '
                                 f'{other}; expected a different name for every frame')

    def names(self):
        """Return {frame of ``messages.topics``: its name, with the prefix}."""
        before = f'{self.prefix}/' if self.prefix else ''
        return {role: before + getattr(self, role, role) for role in (*ROLES, *AXES)}


@settings_class
class Tf(SettingsGroup):
    """Transforms on /tf and /tf_static; all nodes of a vehicle need the same."""

    source: str = setting('none', 'Source of the vehicle pose on /tf. truth: map -> base_link; '
                          'ins: odom -> base_link by strapdown, and map -> odom fixed at the '
                          'start; aided: odom -> base_link by strapdown, and map -> odom by '
                          'aided_navigator; none: no transforms. Except with none, /tf_static '
                          'holds the frames of the sensors',
                          choices=('none', 'truth', 'ins', 'aided'))
