"""Read the text of a CSV file, plain or gzip, after a check of its size."""

import gzip
from pathlib import Path
import zlib

from ins_sim.regular_file import check_regular

# Suffixes that distinguish CSV files from bags, in any case.
SUFFIXES = ('.csv', '.csv.gz')
# A day of IMU samples at 100 Hz has about 1 GB.
LARGEST = 2 << 30
# A gzip file may unpack to _FREE bytes or, if that is more, to _RATIO times its size. A recording
# consists of decimal numbers and unpacks to two to ten times its size.
_FREE, _RATIO = 64 << 20, 100
_BLOCK = 1 << 20
GZIP = b'\x1f\x8b'


def is_csv(path):
    """Return whether a path ends in .csv or .csv.gz, in any case."""
    return Path(path).name.lower().endswith(SUFFIXES)


def read_text(path):
    """
    Return the text of a plain or gzip file, distinguished by their first bytes.

    Raises ValueError or FileNotFoundError with a message of one sentence.
    """
    if not path:
        raise ValueError("motion.recording.path is ''; expected the path of a CSV file")
    try:
        check_regular(path, 'a CSV file, plain or gzip')
        size = Path(path).stat().st_size
        if size > LARGEST:
            raise ValueError(f'it has {size} bytes; expected at most {LARGEST}')
        with open(path, 'rb') as file:
            data = file.read()
    except FileNotFoundError as error:
        raise FileNotFoundError(f'{path} does not exist; expected a CSV file, plain or '
                                'gzip') from error
    except (OSError, ValueError) as error:
        reason = getattr(error, 'strerror', None) or str(error)
        if reason.startswith(str(path)):
            raise
        raise ValueError(f'cannot read the recording {path}: {reason}; expected a CSV file, '
                         'plain or gzip') from error
    if data[:2] == GZIP:
        data = _unpacked(path, size)
    elif path.lower().endswith('.gz') and data:
        raise ValueError(f'{path} is named .gz and begins with {data[:2]!r}; expected a gzip '
                         'file, which begins with 1f 8b')
    return _decoded(path, data)


def _unpacked(path, size):
    """Return the content of a gzip file; refuse one that would fill the memory."""
    most = min(LARGEST, max(_FREE, _RATIO * size))
    blocks, count = [], 0
    try:
        with gzip.open(path) as file:
            while block := file.read(_BLOCK):
                blocks.append(block)
                count += len(block)
                if count > most:
                    raise ValueError(f'{path} has {size} bytes and unpacks to more than {most}; '
                                     'expected a CSV file that unpacks to at most a hundred times '
                                     f'its size and {LARGEST} bytes')
    except (OSError, EOFError, zlib.error) as error:
        raise ValueError(f'{path} is a damaged gzip file ({error}); expected a complete '
                         'one') from error
    return b''.join(blocks)


def _decoded(path, data):
    zero = data.find(b'\0')
    try:
        text = data.decode('utf-8-sig') if zero < 0 else data[:zero + 1].decode('utf-8-sig')
    except UnicodeDecodeError as error:
        line = data.count(b'\n', 0, error.start) + 1
        raise ValueError(f'{path}, line {line}: byte {data[error.start]:#04x} is not UTF-8; '
                         'expected UTF-8 text') from error
    if zero >= 0:
        line = data.count(b'\n', 0, zero) + 1
        raise ValueError(f'{path}, line {line}: there is a zero byte, as in a binary or UTF-16 '
                         'file; expected UTF-8 text')
    if not text or text.isspace():
        raise ValueError(f'{path} is empty; expected a header line and rows')
    return text
