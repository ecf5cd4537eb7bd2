"""Read a table of numbers from a CSV file, plain or gzip; errors name the line and the column."""

import csv
from decimal import Decimal
import difflib
import gzip
import io
import zlib

import numpy as np

# What a file is named where bags may be meant too.
SUFFIXES = ('.csv', '.csv.gz')
# int64 nanoseconds end at 9.22e9 s.
LONGEST_STAMP_S = 9.2e9


def read_table(path):
    """
    Return header, line numbers and rows of texts of any CSV file, every row as long as the header.

    Raises ValueError, in one sentence with file and line, on a file that cannot be read.
    """
    path = str(path)
    (_, *lines), (header, *rows) = _lines(path, _text(path))
    for line, row in zip(lines, rows):
        if len(row) != len(header):
            raise ValueError(f'{path}, line {line}: {len(row)} fields; expected {len(header)} as '
                             'in the header')
    return [name.strip() for name in header], lines, rows


def read_header(path):
    """Return the column names of any CSV file; raise ValueError as ``read_table`` does."""
    text = _text(str(path))
    line = next(line for line in text.splitlines() if line.strip())
    return [name.strip() for name in line.split(',')]


def _text(path):
    """Return the decoded content of a plain or gzip file, told apart by their first bytes."""
    if not path:
        raise ValueError("motion.recording.path is ''; expected the path of a CSV file")
    try:
        with open(path, 'rb') as file:
            data = file.read()
    except FileNotFoundError as error:
        raise FileNotFoundError(f'{path} does not exist; expected a CSV file, plain or '
                                'gzip') from error
    except (OSError, ValueError) as error:
        reason = getattr(error, 'strerror', None) or str(error)
        raise ValueError(f'cannot read the recording {path}: {reason}; expected a CSV file, '
                         'plain or gzip') from error
    if data[:2] == b'\x1f\x8b':
        try:
            data = gzip.decompress(data)
        except (OSError, EOFError, zlib.error) as error:
            raise ValueError(f'{path} is a broken gzip file ({error}); expected a whole '
                             'one') from error
    elif path.endswith('.gz') and data:
        raise ValueError(f'{path} is named .gz and begins with {data[:2]!r}; expected a gzip '
                         'file, which begins with 1f 8b')
    try:
        text = data.decode('utf-8-sig')
    except UnicodeDecodeError as error:
        line = data.count(b'\n', 0, error.start) + 1
        raise ValueError(f'{path}, line {line}: byte {data[error.start]:#04x} is not UTF-8; '
                         'expected UTF-8 text') from error
    if '\0' in text:
        line = text.count('\n', 0, text.index('\0')) + 1
        raise ValueError(f'{path}, line {line}: found a zero byte, so this is a binary or UTF-16 '
                         'file; expected UTF-8 text')
    if not text.strip():
        raise ValueError(f'{path} is empty; expected a header line and rows')
    return text


def _lines(path, text):
    """Return line numbers and fields of all lines that are not blank."""
    reader = csv.reader(io.StringIO(text, newline=''))
    lines, rows = [], []
    try:
        for row in reader:
            if any(field.strip() for field in row) or len(row) > 1:
                lines.append(reader.line_num)
                rows.append(row)
    except csv.Error as error:
        raise ValueError(f'{path}, line {reader.line_num}: not a line of CSV ({error}); expected '
                         'fields separated by commas') from error
    return lines, rows


class Table:
    """
    The fields of a CSV file by column name; every error names file, line and time.

    required, optional: names of the columns that the file must have and may have; the first
    required one is the time ``t_s``.
    """

    def __init__(self, path, required, optional=()):
        self.path = path
        self._required, self._optional = required, optional
        lines, rows = _lines(path, _text(path))
        self.header = [name.strip() for name in rows[0]]
        self._check_header(lines[0])
        self.lines, self.rows = lines[1:], rows[1:]
        for line, row in zip(self.lines, self.rows):
            if len(row) != len(self.header):
                raise ValueError(f'{path}, line {line} (t_s = {row[0].strip()!r}): {len(row)} '
                                 f'fields; expected {len(self.header)} as in the header')
        self.columns = dict(zip(self.header, zip(*self.rows)))

    def _check_header(self, line):
        header, expected = self.header, f'expected {", ".join(self._required)}'
        where = f'{self.path}, line {line}'
        if len(header) == 1:
            raise ValueError(f'{where}: {header[0][:60]!r} is a single column; {expected}, '
                             'separated by commas')
        if _is_number(header[0]):
            raise ValueError(f'{where}: found numbers where the column names belong; {expected}')
        known = self._required + self._optional
        found = []
        for name in header:
            if name not in known:
                near = difflib.get_close_matches(name, known, 1, 0.5)
                found.append(f'unknown column {name!r}'
                             + (f' (the nearest known is {near[0]})' if near else ''))
        found += [f'column {name} stands {header.count(name)} times'
                  for name in known if header.count(name) > 1]
        missing = [name for name in self._required if name not in header]
        if missing:
            found.append(f'missing {", ".join(missing)}')
        if found:
            raise ValueError(f'{where}: {"; ".join(found)}; {expected}, and no other but '
                             f'{", ".join(self._optional)}')

    def texts(self, name):
        """Return the fields of a column as they stand in the file."""
        return self.columns.get(name, ())

    def numbers(self, name, bounds, blank=False):
        """Return a column, (n,); blank fields, where allowed, become 0 (they are not used)."""
        texts = self.texts(name)
        if blank:
            texts = ['0' if not text or text.isspace() else text for text in texts]
        try:
            values = np.array(list(map(_number, texts)))
            good = np.ones(len(values), dtype=bool)
        except ValueError:
            good = np.array([_is_number(text) for text in texts])
            values = np.array([float(text) if ok else 0.0 for text, ok in zip(texts, good)])
        low, high = bounds
        # Comparisons with NaN are false, so the last test is also the test of finiteness.
        ok = good & (values >= low) & (values <= high)
        if not ok.all():
            k = int(np.argmin(ok))
            text = texts[k].strip()
            what = 'is blank' if not text else f'is {text[:40]!r}'
            if good[k] and not np.isfinite(values[k]):
                what += ', not finite'
            elif not good[k] and text:
                what += ', not a number'
            raise ValueError(f'{self.path}, line {self.lines[k]} (t_s = '
                             f'{self.texts("t_s")[k].strip()!r}): {name} {what}; expected a '
                             f'number {low:g}..{high:g}' + (' or a blank' if blank else ''))
        return values


def _number(text):
    """Return the float of a text; Python's 1_000 is no number of a CSV file."""
    if '_' in text:
        raise ValueError(text)
    return float(text)


def _is_number(text):
    try:
        _number(text)
    except ValueError:
        return False
    return True


def nanoseconds(texts, t_s):
    """Return stamps in ns from their decimal text: floats of epoch size resolve only 0.24 us."""
    if len(t_s) and np.abs(t_s).max() < 1e5:
        return np.round(t_s * 1e9).astype(np.int64)
    return np.array([int((Decimal(text.strip()) * 1000000000).to_integral_value())
                     for text in texts], dtype=np.int64)
