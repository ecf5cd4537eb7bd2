"""Content of a report page: answer, figures, tables, notes, settings and data files."""

from dataclasses import dataclass, field
from typing import Any

from ..charts.chart import Chart


@dataclass(frozen=True)
class PageTable:
    """
    A table: title, heads of the columns, rows of cells, and a note below the table.

    A cell is a text or a number; numbers are written with four digits.
    """

    title: str
    heads: tuple[str, ...]
    rows: tuple[tuple[Any, ...], ...]
    note: str = ''


@dataclass(frozen=True)
class Page:
    """
    A report.

    Attributes
    ----------
    title : what was simulated, in words
    answer : the result in a few sentences
    charts, tables : Charts and PageTables in their order
    notes : sentences on what was dropped, assumed or left out
    settings : SimulationSettings, AidedSimulationSettings, NavigateSettings or None; the page
        shows those that differ from the defaults
    digest : {name: digest of numbers}
    files : {name of a file next to the page: its content in words}
    """

    title: str
    answer: str
    charts: tuple[Chart, ...] = ()
    tables: tuple[PageTable, ...] = ()
    notes: tuple[str, ...] = ()
    settings: Any = None
    digest: dict[str, str] = field(default_factory=dict)
    files: dict[str, str] = field(default_factory=dict)
