"""Settings of flights along great circles."""

from .setting import group, setting, Settings, settings_class


@settings_class
class TurningPoints(Settings):
    """The turning points of a route, from the first to the last."""

    latitude_deg: tuple[float, ...] = setting((55.0, 56.0), 'geodetic latitudes', 'deg', -89.9,
                                              89.9)
    longitude_deg: tuple[float, ...] = setting((37.0, 38.0), 'longitudes', 'deg', -180.0, 180.0)


@settings_class
class RoutePoints(Settings):
    """A route by its turning points alone."""

    points: TurningPoints = group(TurningPoints)


@settings_class
class FlownRoute(Settings):
    """The route that orthodromic coordinates refer to, under the names of the motion's."""

    route: RoutePoints = group(RoutePoints)
