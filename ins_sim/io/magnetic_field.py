"""The magnetic field of the Earth: the World Magnetic Model, by the package pygeomag."""

from functools import lru_cache
import math

NT = 1e-9
# The model is WMM2025, which holds for these years.
FIRST_YEAR, LAST_YEAR = 2025.0, 2030.0


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
