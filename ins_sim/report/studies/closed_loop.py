"""Report of the closed-loop study: tables, sentences and page."""

from dataclasses import dataclass

from rich import box
from rich.table import Table

from ins_sim.studies.closed_loop import QUIET_DEG
from ..charts.chart import Chart
from ..page.content import Page, PageTable

# Columns that contain text.
TEXTS = ('with', 'filter')


@dataclass(frozen=True)
class LoopRow:
    """
    One flight: half the range of beta, deg, and of z, m, over the last 30 %, and z at the end, m.

    ``frequency`` is in rad/s, or None without oscillation. ``lateral`` contains the same results
    for the lateral channel alone and ``published`` those that are published, both by name.
    """

    condition: str
    case: str
    k_z: float
    offset_m: float
    engage_s: float
    duration_s: float
    beta_deg: float
    frequency: float | None
    swing_m: float
    end_m: float
    lateral: dict
    published: dict


@dataclass(frozen=True)
class LimitRow:
    """Stability limit of k_z: by linear theory, with its frequency (rad/s), and by flights."""

    case: str
    linear: float
    frequency: float
    flown: float


@dataclass(frozen=True)
class LoopPart:
    """
    Results of one part of the study.

    Attributes
    ----------
    numbers : content of the JSON file
    answer : the result in a sentence
    charts, tables : Charts and PageTables
    """

    numbers: list
    answer: str
    charts: tuple[Chart, ...] = ()
    tables: tuple[PageTable, ...] = ()


def loop_row(case, flight, lateral=None, condition=''):
    """Return the LoopRow of a LoopCase, its LoopFlight, and the lateral channel flown alone."""
    published = {} if case.published is None else {
        name: value for name, value in vars(case.published).items() if value is not None}
    return LoopRow(condition, case.label, case.k_z, case.offset_m, case.engage_s, case.duration_s,
                   **_figures(flight), lateral={} if lateral is None else _figures(lateral),
                   published=published)


def _figures(flight):
    quiet = flight.beta_deg < QUIET_DEG
    return {'beta_deg': flight.beta_deg, 'frequency': None if quiet else flight.frequency,
            'swing_m': flight.swing_m, 'end_m': float(flight.z[-1])}


def flights_table(title, rows):
    """Return the PageTable of LoopRows: whole chain, lateral channel alone, and published."""
    varied = any(r.condition for r in rows)
    heads = ('filter', 'k_z', 'z0', 'engaged', 'beta', 'rad/s', 'z', 'z end')
    cells = [(r.case, f'{r.k_z:g}', f'{r.offset_m:g}', f'{r.engage_s:g}',
              *(_cell(r, name) for name in ('beta_deg', 'frequency', 'swing_m', 'end_m')))
             for r in rows]
    return PageTable(
        title, ('with', *heads) if varied else heads,
        tuple((r.condition, *row) if varied else row for r, row in zip(rows, cells)),
        'half the range of beta, deg, and of z, m, over the last 30 %; rad/s; z at the end, m; '
        'the second values are those of the lateral channel alone, the published ones are in '
        f'brackets (<{QUIET_DEG}: quiet)')


def _cell(row, name):
    values = [getattr(row, name), *([row.lateral[name]] if row.lateral else [])]
    text = ' '.join('-' if value is None else f'{value:.3g}' for value in values)
    if name not in row.published:
        return text
    value = row.published[name]
    published = f'<{QUIET_DEG}' if name == 'beta_deg' and value == 0.0 else f'{value:g}'
    return f'{text} ({published})'


def limits_table(rows):
    """Return the PageTable of LimitRows: by the linear theory and by flights of the chain."""
    return PageTable('Limits of stability, k_z', ('filter', 'linear', 'rad/s', 'flown', 'off'),
                     tuple((r.case, f'{r.linear:.4f}', f'{r.frequency:.3f}', f'{r.flown:.4f}',
                            f'{100.0 * (r.flown / r.linear - 1.0):+.2f} %') for r in rows))


def show_table(table, console):
    """Print a PageTable of the study; all columns except the first texts are right-aligned."""
    shown = Table(title=table.title, box=box.SIMPLE_HEAD, pad_edge=False, collapse_padding=True,
                  caption=table.note or None)
    for head in table.heads:
        shown.add_column(head, justify='left' if head in TEXTS else 'right')
    for row in table.rows:
        shown.add_row(*row)
    console.print(shown)


def flights_answer(rows):
    """Return a sentence about LoopRows: how many end quiet, and which oscillates most."""
    quiet = [r for r in rows if r.beta_deg < QUIET_DEG]
    text = (f'{len(quiet)} of {len(rows)} flights end quiet (amplitude of the sideslip below '
            f'{QUIET_DEG} deg)')
    if len(quiet) == len(rows):
        return f'{text}.'
    most = max(rows, key=lambda r: r.beta_deg)
    condition = f', {most.condition}' if most.condition else ''
    return (f'{text}; of the others, {most.case} at k_z = {most.k_z:g}{condition} oscillates '
            f'most, with amplitudes of {most.beta_deg:.2g} deg in sideslip and '
            f'{most.swing_m:.3g} m.')


def limits_answer(rows):
    """Return a sentence about LimitRows."""
    off = max(abs(r.flown / r.linear - 1.0) for r in rows)
    return (f'Flights of the whole chain lose stability within {100.0 * off:.2g} % of the k_z of '
            'the linear theory.')


def loop_page(title, settings, parts):
    """
    Return the Page of the study.

    ``title`` describes the motion; ``settings`` are AidedSimulationSettings, ``parts`` LoopParts.
    """
    charts = tuple(chart for part in parts for chart in part.charts)
    return Page(title, ' '.join(part.answer for part in parts), charts,
                tuple(table for part in parts for table in part.tables), settings=settings,
                files={**{f'{chart.name}.png': chart.title for chart in charts},
                       'loop_study.json': 'the numbers of every flight'})
