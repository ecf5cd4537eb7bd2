"""Settings of flights along great circles."""

from .field import group, setting, settings_class, SettingsGroup
from .place import HIGHEST_M


@settings_class
class TurningPoints(SettingsGroup):
    """The turning points of a route, from the first to the last."""

    latitude_deg: tuple[float, ...] = setting((55.0, 56.0), 'geodetic latitudes', 'deg', -89.9,
                                              89.9)
    longitude_deg: tuple[float, ...] = setting((37.0, 38.0), 'longitudes', 'deg', -180.0, 180.0)

    def check(self):
        """Refuse lists that do not go together."""
        latitudes, longitudes = len(self.latitude_deg), len(self.longitude_deg)
        if latitudes != longitudes:
            raise ValueError(f'motion.route.points: the route has {latitudes} latitudes and '
                             f'{longitudes} longitudes; expected as many of each')
        if latitudes < 2:
            raise ValueError(f'motion.route.points: the route has {latitudes} turning points; '
                             'expected two or more')


@settings_class
class RouteSettings(SettingsGroup):
    """A route by its turning points alone."""

    points: TurningPoints = group(TurningPoints)


@settings_class
class FlownRouteSettings(RouteSettings):
    """A flight along great circles, with turns inside the corners."""

    airspeed_m_s: float = setting(200.0, 'airspeed; the limit is the speed of an orbit',
                                  'm/s', 1.0, 8000.0)
    height_m: float = setting(500.0, 'height above the ellipsoid', 'm', -500.0, HIGHEST_M)
    turn_rate_deg_s: float = setting(1.2, 'rate of the heading in a turn', 'deg/s', 0.01, 100.0)
    roll_in_s: float = setting(5.0, 'time to roll into a turn and out of it', 's', 0.1, 100.0)
    attack_deg: float = setting(3.0, 'attack angle: nose above the velocity relative to the air',
                                'deg', -30.0, 30.0)
    weave: str = setting('flown', 'how the heading weaves: the track with it, banked (flown), or '
                         'to the sides of a straight track (slipping)',
                         choices=('flown', 'slipping'))
    weave_deg: float = setting(0.0, 'amplitude of the weave of the heading; 0 = none', 'deg', 0.0,
                               30.0)
    weave_period_s: float = setting(25.0, 'its period', 's', 0.1, 1e4)
    wind_m_s: float = setting(0.0, 'wind speed', 'm/s', 0.0, 200.0)
    wind_from_deg: float = setting(0.0, 'where the wind blows from, clockwise from north', 'deg',
                                   -360.0, 360.0)
    gust_m_s: float = setting(0.0, 'standard deviation of the gusts, each axis; 0 = none', 'm/s',
                              0.0, 50.0)
    gust_length_m: float = setting(500.0, 'length of the turbulence', 'm', 1.0, 1e5)
    gust_seed: int = setting(0, 'seed of the gusts: the same seed, the same flight', '', 0,
                             2147483647)
