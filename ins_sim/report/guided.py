"""Report of the steering of a guided motion; empty for other motions."""

import math

from ins_sim.core.guidance.steering import LIMITED
from ins_sim.studies.oscillations import half_range
from .summary import SummaryRow

ARRAYS = {'states': 'steered', 'estimates': 'steering'}


def guided_arrays(result):
    """Return {name: array} of a GuidedResult: steered_<field>, true, and steering_<field>."""
    if result is None:
        return {}
    return {f'{prefix}_{name}': values for record, prefix in ARRAYS.items()
            for name, values in getattr(result, record).arrays().items()}


def guided_rows(result):
    """Return the SummaryRows of a GuidedResult."""
    if result is None:
        return []
    states, estimates = result.states, result.estimates
    figures = (('beta, half range of the last 30 %', 'deg', math.degrees(half_range(states.beta))),
               ('z at the end', 'm', float(states.z[-1])),
               ('z at the end, estimated', 'm', float(estimates.z[-1])),
               ('max |z|', 'm', float(abs(states.z).max())))
    return [SummaryRow(f'steered: {name}', unit, None, value, None, None)
            for name, unit, value in figures]


def guided_lines(result):
    """Return sentences about a GuidedResult: its notes, and how often each condition occurred."""
    if result is None:
        return []
    lines, counts = list(result.notes), dict(result.counts)
    steered = int(result.estimates.steers.sum())
    told = [f'the autopilot steered at {steered} of {len(result.estimates)} control instants']
    if LIMITED in counts:
        told.append(f'its command was beyond guidance.limit_deg, and limited, at '
                    f'{counts.pop(LIMITED)} of them')
    if counts:
        told.append('the vehicle flew straight: '
                    + ', '.join(f'{why} at {count}' for why, count in counts.items()))
    return [*lines, '; '.join(told)]
