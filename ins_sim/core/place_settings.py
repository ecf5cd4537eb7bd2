"""Settings that all nodes share: place, Earth, time and topics."""

from .setting import setting, Settings, settings_class


@settings_class
class Datum(Settings):
    """Origin of ``map``; the bench motions stand there."""

    latitude_deg: float = setting(55.75, 'geodetic latitude', 'deg', -89.9, 89.9)
    longitude_deg: float = setting(37.62, 'longitude', 'deg', -180.0, 180.0)
    height_m: float = setting(0.0, 'height above the WGS-84 ellipsoid', 'm', -500.0, 50000.0)


@settings_class
class Earth(Settings):
    """The Earth of truth and navigation alike."""

    rotation: bool = setting(True, 'the Earth rotates, in the truth and in the navigation')


@settings_class
class Time(Settings):
    """Zero of motion time."""

    epoch_s: int = setting(0, 'stamp of motion time zero', 's', 0, 2147483647)


@settings_class
class Topics(Settings):
    """Quality of service of the data topics (reliable, volatile)."""

    depth: int = setting(10000, 'queue depth of publishers and subscriptions', 'messages', 1,
                         100000)
