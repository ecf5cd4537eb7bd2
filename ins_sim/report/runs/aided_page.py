"""Part of the page of a run that describes the aided solution."""

from ..aided import AIDED, aiding_sources, column_meanings, fault_lines, filled_columns, fix_lines
from ..charts.scales import distance
from ..page.content import PageTable
from .aided_charts import aided_chart


def report_chart(title, report):
    """Return the Chart of an AidedReport; ``title`` is that of the run."""
    return aided_chart(f'{title}: {report.title}', report.flown, aiding_sources(report.settings),
                       report.settings.aided_navigator.gate_probability)


def report_table(report):
    """Return the rows of an AidedReport as a PageTable."""
    columns = filled_columns(report.rows)
    return PageTable(
        f'Aided solution, {report.title}', ('figure', 'unit', *(c.head for c in columns)),
        tuple((row.name.removeprefix(AIDED), row.unit, *(c.value(row) or None for c in columns))
              for row in report.rows if not row.source), column_meanings(columns))


def report_notes(report):
    """Return sentences about the fixes and about faults."""
    return [*fix_lines(report.rows), *fault_lines(report.flown)]


def report_answer(report):
    """Return sentences about the error of the aided solution and the consistency of its filter."""
    rows = {row.name.removeprefix(AIDED): row for row in report.rows}
    rms, end = rows['rms horizontal'], rows['horizontal at the end']
    inside = rows.get('position in 3 sigma')
    knows = '' if inside is None else (
        f' Its position error is within three sigma of the filter in {inside.measured:.1f} % of '
        'the instants.')
    return (f'The aided solution is {distance(rms.measured)} from the truth horizontally (rms), '
            f'{distance(end.measured)} at the end; the strapdown alone {distance(rms.free)} and '
            f'{distance(end.free)}.{knows}')
