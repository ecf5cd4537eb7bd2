"""Content of a report: answer, figures, tables, notes, settings and data files."""

from dataclasses import dataclass, field
from typing import Any

from ..charts.chart import Chart


@dataclass(frozen=True)
class PageTable:
    """
    A table: title, heads of the columns, and rows of cells.

    A cell is a text, or a number, which is written with four digits; note: a sentence below it.
    """

    title: str
    heads: tuple[str, ...]
    rows: tuple[tuple[Any, ...], ...]
    note: str = ''


@dataclass(frozen=True)
class Page:
    """
    A report.

    title: what was simulated, in words; answer: the result in a few sentences; charts
    and tables, in their order; notes: sentences on what was dropped, assumed or left out;
    settings: SimulationSettings, AidedSimulationSettings or NavigateSettings, of which those that
    differ from the defaults are shown, or None; digest: of the numbers, by name; files: names of
    the files beside the page, with what is in them.
    """

    title: str
    answer: str
    charts: tuple[Chart, ...] = ()
    tables: tuple[PageTable, ...] = ()
    notes: tuple[str, ...] = ()
    settings: Any = None
    digest: dict[str, str] = field(default_factory=dict)
    files: dict[str, str] = field(default_factory=dict)
