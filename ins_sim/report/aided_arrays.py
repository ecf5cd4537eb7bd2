"""Convert an aided run to named arrays."""

import numpy as np

from ins_sim.core.aiding.navigator import GNSS, METER

VELOCITY_COLUMNS = ('start_ns', 'end_ns', 'cycles', 'velocity', 'sigma', 'tan_alpha', 'tau', 'g',
                    'status', 'arrival_ns')
GNSS_COLUMNS = ('t_ns', 'lat', 'lon', 'height', 'v_n', 'position_sigma', 'velocity_sigma',
                'status', 'arrival_ns')


def aided_records(flown):
    """Return {name: History} of an AidedResult."""
    return {f'aided_{name}': getattr(flown, name) for name in ('truth', 'states', 'errors')}


def aided_arrays(flown):
    """
    Return the arrays of an AidedResult by name.

    * aided_<record>_<field>: see ``core.timeseries.histories``
    * velocity_meter_<field>, gnss_<field>: see ``core.timeseries.fixes``, one row per fix
    * judged_<field>: how the filter used each fix: source, t_ns, nis (NaN: not tested), freedom,
      taken, reason
    """
    found = {f'{name}_{field}': values for name, record in aided_records(flown).items()
             for field, values in record.arrays().items()}
    for source, fixes, columns in ((METER, flown.velocity_fixes, VELOCITY_COLUMNS),
                                   (GNSS, flown.gnss_fixes, GNSS_COLUMNS)):
        found.update({f'{source}_{name}': np.array([getattr(fix, name) for fix in fixes])
                      for name in columns})
    judged = flown.judged
    found.update({
        'judged_source': np.array([t.source for t in judged], dtype=str),
        'judged_t_ns': np.array([t.t_ns for t in judged], dtype=np.int64),
        'judged_nis': np.array([np.nan if t.outcome.nis is None else t.outcome.nis
                                for t in judged]),
        'judged_freedom': np.array([t.outcome.freedom for t in judged], dtype=np.int64),
        'judged_taken': np.array([t.outcome.taken for t in judged], dtype=bool),
        'judged_reason': np.array([t.outcome.reason for t in judged], dtype=str)})
    return found
