"""The declination of the magnetic field: as it is given, or by the World Magnetic Model."""

import math

from ins_sim.core.numerics import elementary
from .magnetic_field import FIRST_YEAR, LAST_YEAR, magnetic_field

_YEAR_NS = 365.2425 * 86400e9


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
