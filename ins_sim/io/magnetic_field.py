"""Magnetic field of the Earth and its declination by the World Magnetic Model (pygeomag)."""

from functools import lru_cache
import math

from ins_sim.core.numerics import elementary

NT = 1e-9
# Years for which WMM2025 is valid.
FIRST_YEAR, LAST_YEAR = 2025.0, 2030.0
_YEAR_NS = 365.2425 * 86400e9


def magnetic_field(year):
    """
    Return a function of latitude (rad), longitude (rad), height (m) that gives the field.

    The field is in East, North, Up, T, at the decimal year.  Raises ValueError if pygeomag is not
    installed.
    """
    model = _model()

    def field(lat, lon, height):
        found = model.calculate(glat=math.degrees(lat), glon=math.degrees(lon),
                                alt=1e-3 * height, time=year)
        return NT * found.y, NT * found.x, -NT * found.z

    return field


def declination_source(initial):
    """
    Return a function of stamp (ns) and position (rad, rad, m) that gives the declination.

    It returns the declination, rad, and a text for messages. If the model is not available, the
    declination is zero and the text says so. initial holds the settings of the start.
    """
    def given(t_ns, place):
        return math.radians(initial.declination_deg), 'as given'

    def modelled(t_ns, place):
        year = 1970.0 + t_ns / _YEAR_NS
        if not FIRST_YEAR <= year <= LAST_YEAR:
            return 0.0, (f'(the model is valid from {FIRST_YEAR:g} to {LAST_YEAR:g}, but the '
                         f'stamp is of {year:.1f}: 0 is used, expected initial.declination given)')
        try:
            east, north, _ = magnetic_field(year)(*place)
        except ValueError:
            return 0.0, ('(pygeomag cannot be imported: 0 is used, expected pygeomag or '
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
                         ' expected this package for the World Magnetic Model (extra magnetic of '
                         'ins_sim)') from None
    return GeoMag(coefficients_data=WMM_2025)
