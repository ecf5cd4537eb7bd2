"""Settings of flights along great circles."""

from .field import group, setting, settings_class, SettingsGroup
from .place import HIGHEST_M


@settings_class
class TurningPoints(SettingsGroup):
    """Turning points of a route, from the first to the last."""

    latitude_deg: tuple[float, ...] = setting((55.0, 56.0), 'Geodetic latitudes of the turning '
                                              'points', 'deg', -89.9, 89.9)
    longitude_deg: tuple[float, ...] = setting((37.0, 38.0), 'Longitudes of the turning points',
                                               'deg', -180.0, 180.0)

    def check(self):
        """Raise ValueError unless there are two or more points with both coordinates."""
        latitudes, longitudes = len(self.latitude_deg), len(self.longitude_deg)
        if latitudes != longitudes:
            raise ValueError(f'motion.route.points: the route has {latitudes} latitudes and '
                             f'{longitudes} longitudes; expected equal numbers')
        if latitudes < 2:
            raise ValueError(f'motion.route.points: the route has {latitudes} turning points; '
                             'expected two or more')


@settings_class
class RouteSettings(SettingsGroup):
    """Route, defined by its turning points."""

    points: TurningPoints = group(TurningPoints)


@settings_class
class FlownRouteSettings(RouteSettings):
    """Flight along great circles, with turns inside the corners."""

    airspeed_m_s: float = setting(200.0, 'Airspeed; the upper limit is orbital speed', 'm/s', 1.0,
                                  8000.0)
    height_m: float = setting(500.0, 'Height above the ellipsoid', 'm', -500.0, HIGHEST_M)
    turn_rate_deg_s: float = setting(1.2, 'Rate of the heading in a turn', 'deg/s', 0.01, 100.0)
    roll_in_s: float = setting(5.0, 'Time to roll into a turn and out of it', 's', 0.1, 100.0)
    attack_deg: float = setting(3.0, 'Angle of attack, positive with the nose above the velocity '
                                'relative to the air', 'deg', -30.0, 30.0)
    weave: str = setting('flown', 'How the heading weaves. flown: the aircraft banks and the '
                         'track weaves too; slipping: the heading weaves to both sides of a '
                         'straight track', choices=('flown', 'slipping'))
    weave_deg: float = setting(0.0, 'Amplitude of the weave of the heading; 0 = no weave', 'deg',
                               0.0, 30.0)
    weave_period_s: float = setting(25.0, 'Period of the weave', 's', 0.1, 1e4)
    wind_m_s: float = setting(0.0, 'Wind speed', 'm/s', 0.0, 200.0)
    wind_from_deg: float = setting(0.0, 'Direction from which the wind blows, clockwise from '
                                   'north', 'deg', -360.0, 360.0)
    gust_m_s: float = setting(0.0, 'Standard deviation of the gusts, each axis; 0 = no gusts',
                              'm/s', 0.0, 50.0)
    gust_length_m: float = setting(500.0, 'Length scale of the turbulence', 'm', 1.0, 1e5)
    gust_seed: int = setting(0, 'Seed of the gusts; the same seed gives the same flight', '', 0,
                             2147483647)
