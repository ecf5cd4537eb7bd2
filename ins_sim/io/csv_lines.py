"""
Split a CSV file of any origin into its header and its rows of texts.

Fields are separated by commas, semicolons or tabs; if not by commas, the decimal point may be a
comma. Lines that begin with # or % are comments, except that the last one before the numbers is
the header if it has the same number of fields (ROS 1: ``%time,field...``; EuRoC: ``#timestamp
[ns],...``). Repeated headers, as in concatenated files, are skipped. Without a header the columns
are named ``column 1``, ``column 2`` and so on.
"""

import csv
from dataclasses import dataclass
import io
from itertools import islice

from .csv_text import read_text

DELIMITERS = {',': 'commas', ';': 'semicolons', '\t': 'tabs'}
_COMMENTS = ('#', '%')
# Number of lines that are examined to find the layout of a file.
_LOOKED_AT = 500


@dataclass(frozen=True)
class CsvLines:
    """
    A table of texts.

    Attributes
    ----------
    header : names of the columns
    header_line : number of the header line, or of the first line of numbers if headless
    headless : whether the columns have no names
    lines : line number of each row
    rows : lists of texts, whose lengths are not checked yet
    notes : sentences about skipped or reinterpreted lines
    """

    header: list
    header_line: int
    lines: list
    rows: list
    notes: tuple
    headless: bool


def read_lines(path):
    """Return the CsvLines of a file; raise ValueError if it is not a table."""
    text = read_text(str(path))
    delimiter, commented = _layout(text)
    source = _Numbered(text, commented)
    reader = csv.reader(source, delimiter=delimiter, skipinitialspace=True)
    lines, rows = [], []
    try:
        for row in reader:
            if len(row) > 1 or any(field.strip() for field in row):
                lines.append(source.line)
                rows.append(row)
    except csv.Error as error:
        raise ValueError(f'{path}, line {source.line}: this is not CSV ({error}); expected '
                         f'fields separated by {DELIMITERS[delimiter]}') from error
    if not rows:
        raise ValueError(f'{path} holds comments only; expected a header line and rows')
    headless, header_line = _is_row(rows[0], delimiter), lines[0]
    header = [f'column {k}' for k in range(1, len(rows[0]) + 1)] if headless else [
        name.strip() for name in rows[0]]
    notes = [] if not source.comments else [f'{path}: {source.comments} comment lines skipped']
    repeated = [k for k, row in enumerate(rows) if k and row[0] == rows[0][0] and row == rows[0]
                and not headless]
    if repeated:
        notes.append(f'{path}: the header is repeated in {len(repeated)} lines, the first of them '
                     f'line {lines[repeated[0]]}: skipped')
        for k in reversed(repeated):
            del rows[k], lines[k]
    first = 0 if headless else 1
    if delimiter != ',' and any(',' in field for row in rows[first:3] for field in row):
        notes.append(f'{path}: fields are separated by {DELIMITERS[delimiter]}, so a comma is '
                     'read as decimal point')
        rows = [[field.replace(',', '.') for field in row] for row in rows]
    return CsvLines(header, header_line, lines[first:], rows[first:], tuple(notes), headless)


class _Numbered:
    """Iterator over the lines that are not comments, with the number of the last one."""

    def __init__(self, text, kept):
        self._lines, self._kept = io.StringIO(text, newline=''), kept
        self.line, self.comments = 0, 0

    def __iter__(self):
        for line in self._lines:
            self.line += 1
            if _is_comment(line) and self.line != self._kept:
                self.comments += 1
            else:
                yield line


def _layout(text):
    """Return the separator, and the number of the comment line that is the header, or 0."""
    comment, number, seen = '', 0, []
    for k, line in enumerate(islice(io.StringIO(text, newline=''), _LOOKED_AT), 1):
        if _is_comment(line):
            if not seen:
                comment, number = line, k
        elif line.strip():
            seen.append(line)
    first = seen[0] if seen else comment
    second = seen[1] if len(seen) > 1 else first
    counts = {mark: len(_fields(first, mark)) for mark in DELIMITERS}
    found = [mark for mark, count in counts.items()
             if count > 1 and count == len(_fields(second, mark))]
    if not found:
        return ',', 0
    # In a line of numbers decimal commas occur as often as separators do.
    delimiter = found[-1] if _is_row(_fields(first, found[-1]), found[-1]) else found[0]
    headed = comment and _is_row(_fields(first, delimiter), delimiter) and (
        len(_fields(comment, delimiter)) == counts[delimiter])
    return delimiter, number if headed else 0


def _is_row(fields, delimiter):
    """Return whether the first field is a number, unlike that of a header."""
    return is_number(fields[0] if delimiter == ',' else fields[0].replace(',', '.'))


def _is_comment(line):
    return line.lstrip().startswith(_COMMENTS)


def _fields(line, delimiter):
    try:
        return next(csv.reader([line], delimiter=delimiter, skipinitialspace=True), [])
    except csv.Error:
        return []


def number(text):
    """Return a text as float; underscores, as in 1_000, are not allowed."""
    if '_' in text:
        raise ValueError(text)
    return float(text)


def is_number(text):
    """Return whether a text is a number."""
    try:
        number(text)
    except ValueError:
        return False
    return True
