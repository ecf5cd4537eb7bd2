"""The comparison of filters: what each was off over all flights, in a table, JSON and a figure."""

from dataclasses import dataclass

import numpy as np
from rich import box
from rich.table import Table

from ..consistency import mean_interval
from ..plotting import new_figure, save_png

COLOURS = {'free': 'tab:gray', 'conventional': 'tab:brown', 'paper': 'tab:red',
           'paper_corrected': 'tab:orange', 'window_kf': 'tab:blue', 'eskf': 'tab:green'}


@dataclass(frozen=True)
class FilterRow:
    """
    One case over all flights: horizontal errors, m, and the consistency of its filter.

    end_m: rms over the flights at their end; flight_m: rms over flights and time; worst_m: the
    largest at the end; sigma_m: rms of the filter's own standard deviation at the end (None:
    none); nis, nis_low, nis_high: mean NIS of the velocity meter and its 95 % chi-square interval
    (None: not weighed); refused: fixes not taken, of all flights; reason: why the last one.
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
    refused: int
    reason: str


def filter_row(case, flown):
    """Return the Row of a Case and its list of Flown, one a flight."""
    ends = np.array([f.horizontal[-1] for f in flown])
    sigmas = np.array([np.hypot(*f.sigma[-1, :2]) for f in flown])
    nis = np.concatenate([f.nis for f in flown])
    mean = low = high = None
    if len(nis):
        mean = float(nis.mean())
        low, high = mean_interval(len(nis), 2)
    refused = [f for f in flown if f.refused]
    return FilterRow(case.filter, case.cycles, len(flown), _rms(ends),
                     _rms(np.concatenate([f.horizontal for f in flown])), float(ends.max()),
                     _rms(sigmas) if np.isfinite(sigmas).all() else None, mean, low, high,
                     sum(f.refused for f in flown), refused[-1].reason if refused else '')


def _rms(values):
    return float(np.sqrt(np.mean(np.square(values))))


def show_filter_study(title, rows, console):
    """Print the table, and below it why fixes were not taken."""
    # as wide as a terminal, with every figure whole
    table = Table(title=title, box=box.SIMPLE_HEAD, pad_edge=False, collapse_padding=True,
                  caption='horizontal error, m: rms of the flights at their end and over their '
                  'time, the worst end, and the end as the filter thinks; NIS, and where it is in '
                  '95 % of consistent filters')
    table.add_column('filter', no_wrap=True)
    for head in ('N', 'end', 'flight', 'worst', 'sigma', 'NIS', 'in 95 %', 'refused'):
        table.add_column(head, justify='right', no_wrap=True)
    for r in rows:
        interval = '-' if r.nis is None else f'{r.nis_low:.2f}-{r.nis_high:.2f}'
        metres = ('-' if m is None else f'{m:.4g}' for m in (r.end_m, r.flight_m, r.worst_m,
                                                             r.sigma_m))
        table.add_row(r.filter, str(r.cycles), *metres,
                      '-' if r.nis is None else f'{r.nis:.2f}', interval, str(r.refused))
    console.print(table)
    for r in rows:
        if r.refused:
            console.print(f'{r.filter}, N {r.cycles}: {r.refused} fixes not taken; the last: '
                          f'{r.reason}')


def save_figure(path, title, cases, flown):
    """
    Save the figure: rms errors over time of every case, and the eskf's errors with its 3 sigma.

    cases: list of Case; flown: for each the list of Flown.
    """
    figure = new_figure(9, 9)
    top, bottom = figure.subplots(2, 1, sharex=True)
    # what coincides shows through: free under paper, and window_kf under eskf for a while
    styles, seen = ('-', '--', ':', '-.'), {'paper': 0, 'window_kf': 0}
    for case, flights in zip(cases, flown):
        count = seen[case.filter] = seen.get(case.filter, -1) + 1
        rms = np.sqrt(np.mean([f.horizontal ** 2 for f in flights], axis=0))
        top.semilogy(flights[0].t_s / 60.0, np.maximum(rms, 1e-2),
                     color=COLOURS.get(case.filter, 'black'), ls=styles[count % len(styles)],
                     label=f'{case.filter}, N {case.cycles}')
    shown = max(range(len(cases)), key=lambda k: (cases[k].filter == 'eskf',
                                                  cases[k].filter == 'window_kf', -k))
    for flight in flown[shown]:
        bottom.plot(flight.t_s / 60.0, flight.error[:, 0], color='tab:red', lw=0.8)
        bottom.plot(flight.t_s / 60.0, flight.error[:, 1], color='tab:blue', lw=0.8)
    for axis, name, colour in ((0, 'east', 'tab:red'), (1, 'north', 'tab:blue')):
        bottom.plot([], [], color=colour, label=name)
        bound = 3.0 * flown[shown][0].sigma[:, axis]
        if np.isfinite(bound).all():
            for sign in (1.0, -1.0):
                bottom.plot(flown[shown][0].t_s / 60.0, sign * bound, color=colour, ls='--',
                            label=f'3 sigma {name}' if sign > 0.0 else None)
    top.set_ylabel(f'rms horizontal error of {len(flown[0])} flights [m]')
    bottom.set_ylabel('position error of each flight [m]')
    bottom.set_title(f'{cases[shown].filter}, N {cases[shown].cycles}')
    bottom.set_xlabel('time [min]')
    for axes in (top, bottom):
        axes.grid(which='both', alpha=0.3)
        axes.legend(fontsize='small', loc='lower right' if axes is top else 'upper left')
    figure.suptitle(title)
    save_png(figure, path)
