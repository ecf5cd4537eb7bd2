"""Report of the comparison of filters: charts, sentences, page and files."""

from dataclasses import asdict
import json

import numpy as np

from ins_sim.core.aiding.consistency import BLOCKS
from ins_sim.core.ensemble.consistency import ChiSquareSums
from ..charts.chart import Band, Chart, Curve, DASH_DOT, DASHED, DOTTED, Level, LOG, Panel, SOLID
from ..charts.palette import BLACK, BLUE, EAST_NORTH_UP, GREEN, GREY, ORANGE, PURPLE, RED
from ..charts.png import save_chart
from ..charts.scales import LENGTHS, scale, TIMES
from ..page.content import Page, PageTable
from ..page.html import write_page
from .consistency import consistency_panel, Entry
from .filters import nees_sums

COLOURS = {'free': GREY, 'conventional': PURPLE, 'paper': BLACK, 'paper_corrected': ORANGE,
           'window_kf': BLUE, 'eskf': GREEN}
DASHES = (SOLID, DASHED, DOTTED, DASH_DOT)
MARK = 'comparison.json'
# Cases whose errors differ by less than this are drawn as one curve with all names.
SAME = 1e-9
# Smallest rms error on the logarithmic axis, m; a run may start without error.
LEAST_M = 0.1


def charts_of(rows, flown):
    """
    Return the Charts of a comparison.

    ``rows`` contains the FilterRow and ``flown`` the list of FilterFlights of each case.
    """
    styles = _styles(rows)
    charts = [_errors_chart(rows, flown, styles)]
    known = [k for k, row in enumerate(rows) if 'position' in row.nees]
    if known:
        charts += [_consistency_chart(rows, flown, known, styles),
                   _flights_chart(rows, flown, min(known, key=lambda k: rows[k].end_m))]
    return tuple(charts)


def _time(flight):
    factor, unit = scale(TIMES, flight.t_s[-1])
    return flight.t_s * factor, f'time [{unit}]', factor


def _rms(flights):
    return np.sqrt(np.mean([f.horizontal ** 2 for f in flights], axis=0))


def _styles(rows):
    """Return colour and dash of each case: one colour per filter, one dash per window."""
    seen, found = {}, []
    for row in rows:
        count = seen[row.filter] = seen.get(row.filter, -1) + 1
        found.append((COLOURS.get(row.filter, RED), DASHES[count % len(DASHES)]))
    return found


def _errors_chart(rows, flown, styles):
    """Return the Chart of rms errors over time, also relative to the best filter."""
    time, x_label, _ = _time(flown[0][0])
    errors = [_rms(flights) for flights in flown]
    best = min(range(len(rows)), key=lambda k: rows[k].end_m)
    factor, unit = scale(LENGTHS, max(e.max() for e in errors))
    reference = np.where(errors[best] > 0.0, errors[best], np.nan)
    above, below = [], []
    for names, k in _together(rows, errors):
        style = dict(zip(('colour', 'dash'), styles[k]))
        above.append(Curve(time, np.where(errors[k] >= LEAST_M, errors[k] * factor, np.nan),
                           names, **style))
        below.append(Curve(time, errors[k] / reference, None, **style))
    return Chart(
        'comparison', f'Horizontal error of the filters over {rows[0].flights} flights', (
            Panel(tuple(above), x_label, f'rms error [{unit}]', y_scale=LOG, height=1.6),
            Panel((*below, Level(y=1.0, colour=GREY)), x_label,
                  f'rms error over that of {rows[best].name}', y_scale=LOG)),
        caption='Root mean square over the flights. Filters with the same error have one curve.')


def _together(rows, errors):
    """Return (names, index of the first) of the groups of cases with equal curves."""
    left, found = list(range(len(rows))), []
    while left:
        first, *others = left
        same = [k for k in others
                if np.allclose(errors[k], errors[first], rtol=SAME, atol=0.0)]
        found.append((' and '.join(rows[k].name for k in (first, *same)), first))
        left = [k for k in others if k not in same]
    return found


def _consistency_chart(rows, flown, known, styles):
    """Return the Chart of NEES by block of states and of NIS, for filters with a covariance."""
    time, x_label, factor = _time(flown[known[0]][0])
    nees = {k: nees_sums(flown[k]) for k in known}
    panels = []
    for b, block in enumerate(BLOCKS[:3]):
        entries = [Entry(rows[k].name, time, ChiSquareSums(*(a[:, b] for a in nees[k])),
                         *styles[k]) for k in known if nees[k].count[:, b].any()]
        if entries:
            panels.append(consistency_panel(entries, x_label, f'{block}: NEES over its degrees '
                                            'of freedom', 'NEES / states'))
    weighed = [k for k in known if rows[k].nis is not None]
    if weighed:
        panels.append(consistency_panel(
            [Entry(rows[k].name, *_nis(flown[k], factor), *styles[k]) for k in weighed], x_label,
            'fixes of the velocity meter: NIS over its degrees of freedom', 'NIS / components',
            fixes=True))
    return Chart('consistency', f'Consistency of the filters: mean NEES and NIS of '
                 f'{rows[0].flights} flights', tuple(panels),
                 caption='At one instant a consistent filter lies in the band in 95 of 100 '
                 'studies; errors of one flight at several instants are not independent.')


def _nis(flights, factor):
    """Return the instants of the fixes of flights, and the ChiSquareSums of their NIS."""
    t_s = np.unique(np.concatenate([f.nis_t_s for f in flights]))
    count, total = np.zeros(len(t_s), dtype=np.int64), np.zeros(len(t_s))
    for flight in flights:
        places = np.searchsorted(t_s, flight.nis_t_s)
        count[places] += 1
        total[places] += flight.nis
    return t_s * factor, ChiSquareSums(count, total, 2 * count)


def _flights_chart(rows, flown, shown):
    """Return east and north error of each flight within three sigma of the filter."""
    flights = flown[shown]
    time, x_label, _ = _time(flights[0])
    bounds = np.sqrt(np.mean([f.sigma[:, :2] ** 2 for f in flights], axis=0))
    factor, unit = scale(LENGTHS, max(np.abs(f.error[:, :2]).max() for f in flights))
    panels = []
    for axis, name in enumerate(('east', 'north')):
        colour = EAST_NORTH_UP[name]
        bound = 3.0 * factor * bounds[:, axis]
        curves = [Curve(time, f.error[:, axis] * factor, 'a flight' if not k else None, colour,
                        width=0.7) for k, f in enumerate(flights)]
        band = Band(time, -bound, bound, 'three sigma of the filter', GREY)
        panels.append(Panel((band, *curves), x_label, f'{name} error [{unit}]'))
    return Chart('flights', f'Position error of each flight, filter {rows[shown].name}',
                 tuple(panels))


def answer(rows, duration_s):
    """Return sentences saying which filter is best, by how much, and which are consistent."""
    order = sorted(rows, key=lambda r: r.end_m)
    best = order[0]
    factor, unit = scale(TIMES, duration_s)
    found = [f'Of {_count(len(rows), "filter")} over {_count(best.flights, "flight")} of '
             f'{duration_s * factor:.3g} {unit}, {best.name}, was best: rms horizontal error at '
             f'the end {_length(best.end_m)}']
    # Compare the best filter with another filter, not with itself using another window.
    rivals = [r for r in order if r.filter != best.filter] or order[1:]
    if rivals and best.end_m > 0.0:
        found[0] += (f', {rivals[0].end_m / best.end_m:.3g} times less than {rivals[0].name} '
                     f'({_length(rivals[0].end_m)})')
    found[0] += '.'
    by = {}
    for row in rows:
        if row.consistency:
            by.setdefault(row.consistency, []).append(row.name)
    found += [f'{words[0].upper()}{words[1:]} by NIS and by NEES of the position at the end: '
              f'{"; ".join(names)}.' for words, names in by.items()]
    silent = [row.name for row in rows if not row.consistency]
    if silent:
        found.append(f'No statement is possible without a covariance: {"; ".join(silent)}.')
    return ' '.join(found)


def _count(number, noun):
    return f'{number} {noun}' if number == 1 else f'{number} {noun}s'


def _length(metres):
    factor, unit = scale(LENGTHS, metres)
    return f'{metres * factor:.4g} {unit}'


def comparison_title(settings, flights):
    """Return a line that names motion, length and number of flights."""
    generator = settings.simulation.motion_generator
    return f'{generator.motion.kind}, {generator.duration_s:g} s, {_count(flights, "flight")}'


def write_comparison(folder, page, rows):
    """Write the Page of a comparison, its figures, and its rows as JSON into a folder."""
    for chart in page.charts:
        save_chart(folder, chart)
    write_page(folder, page)
    (folder / MARK).write_text(json.dumps([asdict(r) for r in rows], indent=1) + '\n',
                               encoding='utf-8')


def page_of(title, settings, rows, flown, digest):
    """Return the Page of a comparison; settings: AidedSimulationSettings of the study."""
    errors = PageTable(
        'Errors', ('filter', 'rms at the end [m]', 'rms over the flights [m]', 'worst end [m]',
                   'sigma of the filter at the end [m]', 'fixes refused'),
        tuple((r.name, r.end_m, r.flight_m, r.worst_m, r.sigma_m, r.refused) for r in rows))
    cells = []
    for r in rows:
        if r.nis is not None:
            cells.append((r.name, 'NIS of the velocity meter, all fixes', r.nis, 2,
                          f'{r.nis_low:.3f} to {r.nis_high:.3f}'))
        cells += [(r.name, f'NEES at the end, {block}', mean, freedom, f'{low:.2f} to {high:.2f}')
                  for block, (mean, low, high, freedom) in r.nees.items()]
    tables = [errors]
    if cells:
        tables.append(PageTable('Consistency', ('filter', 'quantity', 'mean', 'expected',
                                                'in 95 % of consistent filters'), tuple(cells)))
    notes = [f'{r.name}: {r.refused} fixes were rejected; the last: {r.reason}.'
             for r in rows if r.refused]
    notes.append('Every filter has the same flights: gusts, instruments and initial errors of '
                 'flight k are drawn from the seeds plus k.')
    charts = charts_of(rows, flown)
    return Page(title, answer(rows, flown[0][0].t_s[-1]), charts, tuple(tables), tuple(notes),
                settings, {'the flights': digest},
                {MARK: 'the tables', **{f'{c.name}.png': c.title for c in charts}})
