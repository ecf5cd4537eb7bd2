"""The motion that settings name, in closed form."""

from .motion import Motion


def make_motion(motion, datum, earth_settings):
    """
    Return the closed-form motion that the settings name.

    motion: MotionSettings; datum: Datum; earth_settings: Earth.  Raises ValueError on settings
    that no motion can have, a route that cannot be flown, and on a recording, whose poses must
    be read from a file (``ins_sim.io.motion.read_motion``).
    """
    if motion.kind == 'recording':
        raise ValueError('motion.kind is recording, whose poses are in a file; expected a '
                         'closed-form motion here')
    if motion.kind == 'route':
        from .route.motion import RouteMotion
        return RouteMotion(motion.route, earth_settings)
    if motion.kind in ('cruise', 'racetrack', 'aggressive'):
        from .flights import FLIGHTS
        return Motion(FLIGHTS[motion.kind](datum), 3, earth_settings.rotation)
    from .bench import bench_motion
    return bench_motion(motion, datum, earth_settings.rotation)
