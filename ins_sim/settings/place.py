"""Settings that all nodes share: the datum and the Earth."""

from .field import setting, settings_class, SettingsGroup


@settings_class
class Datum(SettingsGroup):
    """Origin of ``map``; the bench motions stand there."""

    latitude_deg: float = setting(55.75, 'geodetic latitude', 'deg', -89.9, 89.9)
    longitude_deg: float = setting(37.62, 'longitude', 'deg', -180.0, 180.0)
    height_m: float = setting(0.0, 'height above the WGS-84 ellipsoid', 'm', -500.0, 50000.0)


@settings_class
class Earth(SettingsGroup):
    """The Earth of truth and navigation alike."""

    rotation: bool = setting(True, 'the Earth rotates, in the truth and in the navigation')
