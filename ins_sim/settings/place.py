"""Settings that all nodes share: the datum and the Earth."""

from .field import setting, settings_class, SettingsGroup

# The change from Cartesian coordinates to latitude, longitude and height holds up to here.
HIGHEST_M = 1e6


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
