"""Read columns of numbers from a CSV file by name; errors give the line and the column."""

from decimal import Decimal
import difflib

import numpy as np

from ins_sim.settings.shown import listed, shown
from .csv_lines import number, read_lines
from .csv_names import ColumnFinder

# int64 nanoseconds end at 9.22e9 s.
LONGEST_STAMP_S = 9.2e9


class CsvTable:
    """
    The fields of a CSV file by column name; every error gives file, line and time.

    required and optional are the names of the columns that the file must and may have; the first
    required one is the time ``t_s``. For columns, units and key see ``ColumnFinder``. notes are
    sentences about skipped or unused data.
    """

    def __init__(self, path, required, optional=(), columns=None, units=None, key='columns'):
        self.path = path
        table = read_lines(path)
        where = f'{path}, line {table.header_line}'
        self._finder = ColumnFinder(where, table.header, columns, units, key)
        self._check_header(where, table, required, optional, key)
        found = {name: self._finder.find(name) for name in (*required, *optional)}
        self._found = {name: place for name, place in found.items() if place is not None}
        self.lines, self.rows = table.lines, table.rows
        t_s = self._found['t_s'][0]
        for line, row in zip(self.lines, self.rows):
            if len(row) != len(table.header):
                at = row[t_s].strip() if t_s < len(row) else ''
                raise ValueError(f'{path}, line {line} (t_s = {shown(at)}): {len(row)} '
                                 f'fields; expected {len(table.header)} as in the header')
        self._texts = {name: [row[k] for row in self.rows] for name, (k, _) in self._found.items()}
        used = {k for k, _ in self._found.values()}
        spare = [name for k, name in enumerate(table.header) if k not in used and name]
        self.notes = list(table.notes)
        if spare:
            self.notes.append(f'{path}: {len(spare)} columns are not used: {listed(spare)}')
        self.notes += self._renamed(table.header)

    def _renamed(self, header):
        """Return a note about columns with names other than those of ins_sim, if any."""
        other = [f'{name} from {header[k]}' + (f' times {factor:.9g}' if factor != 1.0 else '')
                 for name, (k, factor) in self._found.items() if header[k] != name or (
                     factor != 1.0)]
        return [f'{self.path}: {listed(other, 10)}'] if other else []

    def _check_header(self, where, table, required, optional, key):
        header, expected = table.header, f'expected {", ".join(required)}'
        if len(header) == 1:
            raise ValueError(f'{where}: {shown(header[0])} is a single column; {expected}, '
                             'separated by commas, semicolons or tabs')
        missing = [name for name in required if not self._finder.is_known(name)]
        known = (*required, *optional)
        twice = [f'column {name} occurs {header.count(name)} times'
                 for name in known if header.count(name) > 1]
        if not missing and not twice:
            return
        if table.headless:
            raise ValueError(f'{where}: the header line contains numbers; {expected}, '
                             f'or {key}.{missing[0]} "column 1" and so on, which selects columns '
                             'by their numbers')
        unknown = [name for name in header if name not in known]
        found = [_unknown(name, known) for name in unknown[:4] if missing]
        if missing and len(unknown) > 4:
            found.append(f'{len(unknown) - 4} more unknown columns')
        found += twice
        if missing:
            found.append(f'it has no column {listed(missing, 10)}')
            expected += f'; {key}.{missing[0]} selects a column with another name'
        raise ValueError(f'{where}: {"; ".join(found)}; {expected}')

    def __contains__(self, name):
        return name in self._found

    def factor(self, name):
        """Return the factor from the unit of a column to the internal unit."""
        return self._found[name][1]

    def texts(self, name):
        """Return the fields of a column as texts of the file."""
        return self._texts.get(name, ())

    def numbers(self, name, bounds, blank=False):
        """Return a column, (n,), within bounds; blank fields, where allowed, become NaN."""
        values = self.floats(name, blank)
        low, high = bounds
        # Comparisons with NaN are false, so this also tests finiteness.
        ok = (values >= low) & (values <= high)
        if blank:
            ok |= np.array([not text or text.isspace() for text in self.texts(name)], dtype=bool)
        if not ok.all():
            k = int(np.argmin(ok))
            self._refuse(name, k, '' if np.isfinite(values[k]) else ', not finite',
                         f'a number {low:g}..{high:g}' + (' or a blank' if blank else ''))
        return values

    def floats(self, name, blank=True):
        """Return a column in its SI or canonical unit, (n,); blank fields are NaN if allowed."""
        texts, factor = self.texts(name), self._found[name][1]
        try:
            # Python accepts 1_000, but in a CSV file it is not a number.
            values = np.array(list(map(float, texts)))
            plain = not any('_' in text for text in texts)
        except ValueError:
            plain = False
        if not plain:
            values = np.full(len(texts), np.nan)
            for k, text in enumerate(texts):
                try:
                    if not blank or text and not text.isspace():
                        values[k] = number(text)
                except ValueError:
                    self._refuse(name, k, ', not a number' if text.strip() else '',
                                 'a number' + (' or a blank' if blank else ''))
        return values if factor == 1.0 else values * factor

    def _refuse(self, name, k, why, expected):
        text = self.texts(name)[k].strip()
        what = 'blank' if not text else shown(text, 40)
        raise ValueError(f'{self.path}, line {self.lines[k]} (t_s = '
                         f'{shown(self.texts("t_s")[k].strip(), 40)}): {name} is {what}{why}; '
                         f'expected {expected}')

    def stamps_ns(self):
        """Return the stamps, (n,) int64 ns; raise ValueError if one does not fit int64."""
        t_s = self.floats('t_s')
        # Comparisons with NaN are false.
        ok = np.abs(t_s) <= LONGEST_STAMP_S
        if not ok.all():
            k = int(np.argmin(ok))
            self._refuse('t_s', k, '' if np.isfinite(t_s[k]) else ', not finite',
                         f'a number of seconds within +-{LONGEST_STAMP_S:g}')
        return nanoseconds(self.texts('t_s'), t_s, self._found['t_s'][1])


def _unknown(name, known):
    near = difflib.get_close_matches(name[:100], known, 1, 0.5)
    return f'unknown column {shown(name)}' + (f' (the nearest known is {near[0]})' if near else '')


def nanoseconds(texts, t_s, factor=1.0):
    """
    Return stamps in ns from decimal texts, because floats since 1970 resolve only 0.24 us.

    factor is the unit of the texts, s.
    """
    if len(t_s) and np.abs(t_s).max() < 1e5:
        return np.round(t_s * 1e9).astype(np.int64)
    scale = Decimal(round(1e9 * factor))
    return np.array([int((Decimal(text.strip()) * scale).to_integral_value())
                     for text in texts], dtype=np.int64)
