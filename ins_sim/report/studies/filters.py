"""Comparison of filters: errors of each over all flights, as a table and as JSON."""

from dataclasses import dataclass

import numpy as np
from ins_sim.core.aiding.consistency import BLOCKS
from ins_sim.core.ensemble.consistency import sums_of
from rich import box
from rich.table import Table

from ..consistency import mean_interval, sum_intervals
from .consistency import judged


@dataclass(frozen=True)
class FilterRow:
    """
    One case over all flights: horizontal errors, m, and the consistency of its filter.

    Attributes
    ----------
    end_m, flight_m, worst_m : rms over the flights at their end; rms over flights and time;
        largest error at the end
    sigma_m : rms of the filter's own standard deviation at the end, or None without covariance
    nis, nis_low, nis_high : mean NIS of the velocity meter and its 95 % chi-square interval, None
        if the filter does not compute it
    nees : {one of core.aiding.consistency.BLOCKS: (mean NEES of the flights at the end, bounds of
        its 95 % interval, degrees of freedom)}
    refused, reason : number of rejected fixes of all flights, and the reason for the last one
    """

    filter: str
    cycles: int
    flights: int
    end_m: float
    flight_m: float
    worst_m: float
    sigma_m: float | None
    nis: float | None
    nis_low: float | None
    nis_high: float | None
    nees: dict
    refused: int
    reason: str

    @property
    def name(self):
        """Return filter and window in words."""
        return f'{self.filter}, N {self.cycles}'

    @property
    def consistency(self):
        """Return in words whether the filter is consistent; '' without a covariance."""
        by = [judged(self.nis, self.nis_low, self.nis_high)] if self.nis is not None else []
        by += [judged(*self.nees['position'][:3])] if 'position' in self.nees else []
        if 'too optimistic' in by:
            return 'too optimistic'
        return next((words for words in by if words != 'consistent'), 'consistent') if by else ''


def filter_row(case, flown):
    """Return the FilterRow of a FilterCase and its list of FilterFlight, one per flight."""
    ends = np.array([f.horizontal[-1] for f in flown])
    sigmas = np.array([np.hypot(*f.sigma[-1, :2]) for f in flown])
    nis = np.concatenate([f.nis for f in flown])
    mean = low = high = None
    if len(nis):
        mean = float(nis.mean())
        low, high = mean_interval(len(nis), 2)
    refused = [f for f in flown if f.refused]
    return FilterRow(
        case.filter, case.cycles, len(flown), _rms(ends),
        _rms(np.concatenate([f.horizontal for f in flown])), float(ends.max()),
        _rms(sigmas) if np.isfinite(sigmas).all() else None, mean, low, high, _nees(flown),
        sum(f.refused for f in flown), refused[-1].reason if refused else '')


def nees_sums(flown):
    """Return the ChiSquareSums (n, BLOCKS) of the NEES of flights at their instants."""
    return sums_of(*(np.stack([getattr(f, name) for f in flown], axis=1)
                     for name in ('nees', 'freedom')))


def _nees(flown):
    """Return {block: (mean, low, high, freedom)} of the NEES at the end."""
    sums = nees_sums(flown)
    low, high = sum_intervals(sums)
    return {block: (float(sums.mean[-1, k]), float(low[-1, k]), float(high[-1, k]),
                    int(flown[0].freedom[-1, k]))
            for k, block in enumerate(BLOCKS) if sums.count[-1, k]}


def _rms(values):
    return float(np.sqrt(np.mean(np.square(values))))


def _with_interval(mean, low, high):
    return ('-', '-') if mean is None else (f'{mean:.2f}', f'{low:.2f}-{high:.2f}')


def show_filter_study(title, rows, console):
    """Print the table, and below it why fixes were rejected."""
    # Fit the table into the width of a terminal without cutting numbers.
    table = Table(title=title, box=box.SIMPLE_HEAD, pad_edge=False, collapse_padding=True,
                  caption='horizontal error, m: rms of the flights at their end and over time, '
                  'the worst end, and the rms at the end according to the filter; NIS, and NEES '
                  'of the position at the end, with the intervals of 95 % of consistent filters')
    table.add_column('filter', no_wrap=True)
    for head in ('N', 'end', 'flight', 'worst', 'sigma', 'NIS', 'in 95 %', 'NEES', 'in 95 %',
                 'refused'):
        table.add_column(head, justify='right', no_wrap=True)
    for r in rows:
        nis = ((None,) * 3 if r.nis is None else (r.nis, r.nis_low, r.nis_high))
        nees = r.nees.get('position', (None,) * 3)[:3]
        metres = ('-' if m is None else f'{m:.4g}' for m in (r.end_m, r.flight_m, r.worst_m,
                                                             r.sigma_m))
        table.add_row(r.filter, str(r.cycles), *metres, *_with_interval(*nis),
                      *_with_interval(*nees), str(r.refused))
    console.print(table)
    for r in rows:
        if r.refused:
            console.print(f'{r.filter}, N {r.cycles}: {r.refused} fixes rejected; the last: '
                          f'{r.reason}')
