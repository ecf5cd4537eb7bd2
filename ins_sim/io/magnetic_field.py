"""The magnetic field of the Earth and its declination: the World Magnetic Model, by pygeomag."""

from functools import lru_cache
import math

from ins_sim.core.numerics import elementary

NT = 1e-9
# The model is WMM2025, which holds for these years.
FIRST_YEAR, LAST_YEAR = 2025.0, 2030.0
_YEAR_NS = 365.2425 * 86400e9


def magnetic_field(year):
    """
    Return a function (lat rad, lon rad, height m) -> field in East, North, Up, T.

    year: decimal year.  Raises ValueError, one sentence, where pygeomag is missing.
    """
    model = _model()

    def field(lat, lon, height):
        found = model.calculate(glat=math.degrees(lat), glon=math.degrees(lon),
                                alt=1e-3 * height, time=year)
        return NT * found.y, NT * found.x, -NT * found.z

    return field


def declination_source(initial):
    """
    Return a function (stamp ns, (lat rad, lon rad, height m)) -> declination, rad, and a text.

    initial: settings of the start. Where the model cannot tell, it is taken for zero, which the
    text says.
    """
    def given(t_ns, place):
        return math.radians(initial.declination_deg), 'as given'

    def modelled(t_ns, place):
        year = 1970.0 + t_ns / _YEAR_NS
        if not FIRST_YEAR <= year <= LAST_YEAR:
            return 0.0, (f'(the model holds from {FIRST_YEAR:g} to {LAST_YEAR:g}, the stamp is of '
                         f'{year:.1f}: taken for 0, expected initial.declination given)')
        try:
            east, north, _ = magnetic_field(year)(*place)
        except ValueError:
            return 0.0, ('(pygeomag cannot be imported: taken for 0, expected it or '
                         'initial.declination given)')
        return elementary.atan2(east, north), 'by the World Magnetic Model'

    return given if initial.declination == 'given' else modelled


@lru_cache(maxsize=1)
def _model():
    try:
        from pygeomag import GeoMag
        from pygeomag.wmm.wmm_2025 import WMM_2025
    except ImportError as error:
        raise ValueError(f'magnetometer.publish is true and pygeomag cannot be imported ({error});'
                         ' expected it for the World Magnetic Model (extra magnetic of '
                         'ins_sim)') from None
    return GeoMag(coefficients_data=WMM_2025)
