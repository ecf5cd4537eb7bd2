"""Invalid recordings are refused with one message: where, what is wrong, what is expected."""

import gzip
import math
import os

from hypothesis import given, settings as profile, strategies as st
import numpy as np
import pytest

from ins_sim.io.csv_flight import COLUMNS, read_rows, USED, WRAPPED
from support.recorded_flights import accepted, HEADER, refusal, rows, save


@pytest.fixture(scope='module')
def folder(tmp_path_factory):
    return tmp_path_factory.mktemp('recordings')


def test_the_flight_all_others_are_made_of_is_accepted(folder):
    """The valid flight, from which all others here are derived, lasts 4 s without warnings."""
    motion = accepted(save(folder / 'good.csv', rows()))
    assert motion.end_s == pytest.approx(4.0) and motion.warnings == []


# Tests of the file.

def test_no_path_no_file_no_permission(folder):
    """An empty path, a missing file, a folder and an unreadable file are refused."""
    assert "motion.recording.path is ''" in refusal('')
    assert 'does not exist; expected a CSV file' in refusal(folder / 'nowhere.csv')
    assert 'Is a directory' in refusal(folder)
    assert 'cannot read' in refusal('a\0b')
    if os.getuid():
        path = save(folder / 'locked.csv', rows())
        path.chmod(0)
        assert 'Permission denied' in refusal(path)


def test_empty_and_header_only(folder):
    """An empty file, and one with a header only, are refused."""
    path = folder / 'empty.csv'
    for content in ('', '\n\n', ' \r\n', '\ufeff'):
        path.write_text(content, encoding='utf-8')
        assert f'{path} is empty' in refusal(path)
    assert 'has a header but no rows' in refusal(save(folder / 'header.csv', []))


def test_wrong_encoding_and_broken_gzip(folder):
    """Text that is not UTF-8, and corrupt gzip, are refused with line or cause."""
    path = folder / 'coded.csv'
    text = save(folder / 'good.csv', rows()).read_text()
    path.write_bytes((text + '\n°').encode('latin-1'))
    assert 'line 104: byte 0xb0 is not UTF-8' in refusal(path)
    path.write_bytes(text.encode('utf-16'))
    assert 'is not UTF-8' in refusal(path)
    path.write_bytes(text.encode('utf-16-le'))
    assert 'line 1: there is a zero byte' in refusal(path)
    whole = gzip.compress(text.encode())
    for broken in (whole[:-20], whole[:40], whole[:2], whole[:100] + b'\0' * 50 + whole[150:],
                   whole + b'tail'):
        path.write_bytes(broken)
        assert 'damaged gzip' in refusal(path)
    packed = folder / 'text.csv.gz'
    packed.write_text(text)
    assert 'is named .gz and begins with' in refusal(packed)


def test_byte_order_mark_crlf_blank_lines_and_spaces_are_accepted(folder):
    """A byte order mark, CRLF, blank lines and spaces do not change the values."""
    path = folder / 'dressed.csv'
    text = save(folder / 'good.csv', rows()).read_text()
    path.write_bytes(b'\xef\xbb\xbf' + text.replace(',', ' , ').replace('\n', '\r\n\r\n').encode())
    plain = read_rows(folder / 'good.csv')
    assert np.array_equal(read_rows(path).lat_deg, plain.lat_deg)


@profile(max_examples=150, deadline=None)
@given(data=st.one_of(st.binary(max_size=300),
                      st.binary(max_size=300).map(lambda b: (HEADER + '\n').encode() + b),
                      st.text(alphabet='0123456789.,-+e_n"\n\r \ta;', max_size=300).map(
                          lambda s: (HEADER + '\n' + s).encode()),
                      st.binary(max_size=60).map(gzip.compress)))
def test_any_bytes_end_in_a_sentence(folder, data):
    """Any bytes give a message with the path, or about start_s."""
    path = folder / 'fuzz.csv'
    path.write_bytes(data)
    assert str(path) in refusal(path) or 'start_s' in refusal(path)


# Tests of the columns.

def test_columns(folder):
    """Unknown, missing, double and additional columns are reported; any order is read."""
    path = folder / 'columns.csv'
    table = rows()
    sentence = refusal(save(path, table, HEADER.replace('lat_deg', 'lat_degs')))
    assert "line 1: unknown column 'lat_degs' (the nearest known is lat_deg)" in sentence
    assert 'it has no column lat_deg; expected' in sentence
    spare = accepted(save(path, [r + ['1'] for r in table], HEADER + ',wind'))
    assert '1 columns are not used: wind' in spare.warnings[0]
    # Velocities are not used and may be absent.
    assert not accepted(save(path, [r[:-1] for r in table], HEADER[:-7])).warnings
    assert not accepted(save(path, [r[:-3] for r in table], HEADER[:-21])).warnings
    assert 'column t_s occurs 2 times' in refusal(save(path, [r + ['1'] for r in table],
                                                       HEADER + ',t_s'))
    assert 'is a single column' in refusal(save(path, table, HEADER.replace(',', ';')))
    assert 'the header line contains numbers' in refusal(
        save(path, table, ','.join(table[0])))
    accepted(save(path, [r + ['0'] for r in table], HEADER + ',att_gap'))
    reverse = save(path, [r[::-1] for r in table], ','.join(COLUMNS[::-1]))
    assert np.array_equal(read_rows(reverse).lat_deg,
                          read_rows(save(folder / 'good.csv', table)).lat_deg)


@pytest.mark.parametrize('fields', (9, 11, 1))
def test_number_of_fields(folder, fields):
    """A row with 9, 11 or 1 of 10 fields is refused with line and time."""
    table = rows()
    table[40] = (table[40] + ['0'])[:fields]
    assert f"line 42 (t_s = '4.000'): {fields} fields; expected 10" in refusal(
        save(folder / 'fields.csv', table))


# Tests of the values.

@profile(max_examples=60, deadline=None)
@given(row=st.integers(0, 100), name=st.sampled_from(COLUMNS),
       text=st.sampled_from(('x', 'nan', 'NaN', 'inf', '-Infinity', '1_0', '0x10', '--1', '1e999',
                             '1.0.0', '')))
def test_what_is_no_finite_number_is_refused_with_its_place(folder, row, name, text):
    """A field that is not a finite number is refused with line, time and column."""
    if not text and name.startswith('v'):
        return
    table = rows()
    table[row][COLUMNS.index(name)] = text
    sentence = refusal(save(folder / 'number.csv', table))
    assert f'line {row + 2} (t_s = ' in sentence and f'{name} is ' in sentence
    assert 'expected a number' in sentence


@profile(max_examples=80, deadline=None)
@given(row=st.integers(0, 100), name=st.sampled_from(sorted(set(USED) - set(WRAPPED))),
       above=st.booleans(), beyond=st.floats(1e-6, 1e4))
def test_angles_and_heights_out_of_range_are_refused(folder, row, name, above, beyond):
    """An angle or height out of range is refused with line, time, value and range."""
    low, high = USED[name]
    value = high + beyond if above else low - beyond
    table = rows()
    table[row][COLUMNS.index(name)] = repr(value)
    sentence = refusal(save(folder / 'range.csv', table))
    assert f"line {row + 2} (t_s = '{table[row][0]}'): {name} is {repr(value)!r}" in sentence
    assert f'expected a number {low:g}..{high:g}' in sentence


# Tests of the stamps.

@profile(max_examples=40, deadline=None)
@given(row=st.integers(1, 100), back=st.integers(0, 50))
def test_stamps_that_do_not_advance_are_refused_with_their_time(folder, row, back):
    """A stamp that is repeated or goes back is refused with its time."""
    table = rows()
    earlier = table[max(row - 1 - back, 0)][0]
    for k, later in enumerate(table[row:]):
        later[0] = f'{float(earlier) + 0.1 * k:.3f}'
    sentence = refusal(save(folder / 'stamps.csv', table))
    assert '1 stamps that do not advance (' in sentence
    assert f'{float(earlier):.9f} s)' in sentence


def test_stamps_that_all_stand_still(folder):
    """If all stamps are equal, some are listed with the number of the others."""
    table = rows()
    for row in table:
        row[0] = '5'
    path = save(folder / 'still.csv', table)
    assert '100 stamps that do not advance (' in refusal(path) and 'and 92 more' in refusal(path)
    assert 'there is a fault between every two rows' in refusal(path, on_gap='cut')


@profile(max_examples=40, deadline=None)
@given(row=st.integers(1, 100), intervals=st.floats(2.6, 500.0))
def test_gaps_are_refused_with_their_time(folder, row, intervals):
    """A gap of more than 2.5 times the median interval is refused with its time."""
    table = rows()
    for k in range(row, len(table)):
        table[k][0] = f'{0.1 * (k - 1 + intervals):.4f}'
    sentence = refusal(save(folder / 'gap.csv', table))
    assert '1 gaps over 2.5 times the median interval of 0.1 s' in sentence
    assert f'(after t_s = {0.1 * (row - 1):.9f} s' in sentence


def test_missing_row_is_no_gap(folder):
    """One missing row is accepted; two in succession are a gap."""
    table = rows()
    del table[50]
    accepted(save(folder / 'one.csv', table))
    del table[50]
    assert '1 gaps' in refusal(save(folder / 'two.csv', table))


# Tests of jumps.

@profile(max_examples=40, deadline=None)
@given(row=st.integers(1, 100), metres=st.floats(21.0, 1e5), name=st.sampled_from(
    ('lat_deg', 'lon_deg', 'height_m')))
def test_position_jumps_are_refused_with_their_time(folder, row, metres, name):
    """
    A position jump is refused with its time; the limit at 10 Hz is 20 m.

    It is the larger of 20 m and 500 m/s^2 (0.1 s)^2 = 5 m.
    """
    scale = {'lat_deg': 111e3, 'lon_deg': 111e3 * math.cos(math.radians(55.0)), 'height_m': 1.0}
    k = COLUMNS.index(name)
    table = rows()
    for later in table[row:]:
        later[k] = repr(float(later[k]) + min(metres, 9e4) / scale[name])
    sentence = refusal(save(folder / 'jump.csv', table))
    assert '1 impossible jumps (after t_s = ' in sentence
    assert f'{0.1 * (row - 1):.9f} s (' in sentence


def test_spikes_resets_and_turns(folder):
    """Position spikes, heading resets and turns of 150 deg per row are impossible jumps."""
    path = folder / 'turn.csv'
    table = rows()
    table[50][1] = '54.0'
    assert '2 impossible jumps' in refusal(save(path, table))
    table = rows()
    for row in table[50:]:
        row[6] = '60.0'
    assert '1 impossible jumps (after t_s = 4.900000000 s (57' in refusal(save(path, table))
    slow = rows(101, 1.0)
    for k, row in enumerate(slow):
        row[4] = f'{(k * 150.0 + 180.0) % 360.0 - 180.0}'
    assert '100 impossible jumps' in refusal(save(path, slow))


def test_correction_steps_are_reported_not_refused(folder):
    """A step of 15 m in height gives a warning with its size and time."""
    table = rows()
    for row in table[50:]:
        row[3] = '115.0'
    motion = accepted(save(folder / 'step.csv', table))
    assert any('1 position step, the largest 15 m after t_s = 4.9' in w for w in motion.warnings)


@pytest.mark.parametrize('fault', ('gap', 'jump', 'back'))
def test_cut_keeps_the_part_that_holds_start(folder, fault):
    """
    on_gap cut keeps the part of 100 s that contains start_s, less 3 s of padding at both ends.

    The recording has 10 Hz and a fault at 60 s.
    """
    table = rows(1001)
    for k, row in enumerate(table[600:], 600):
        if fault == 'jump':
            row[3] = '900.0'
        else:
            row[0] = f'{0.1 * k + (5.0 if fault == "gap" else -5.0):.3f}'
    path = save(folder / 'cut.csv', table)
    assert 'on_gap' in refusal(path)
    motion = accepted(path, on_gap='cut')
    assert motion.end_s == pytest.approx(59.9 - 6.0, abs=1e-6)
    assert 'cut there' in motion.warnings[0]
    assert accepted(path, on_gap='cut', start_s=80.0).end_s == pytest.approx(
        {'gap': 105.0, 'jump': 100.0, 'back': 95.0}[fault] - 83.0, abs=1e-6)


# Tests of the extent.

def test_too_short(folder):
    """A flight of less than 6.1 s, or of fewer than 8 rows, is refused."""
    path = folder / 'short.csv'
    assert 'holds 61 rows over 6 s' in refusal(save(path, rows(61)))
    accepted(save(path, rows(62)))
    assert 'at least 8 rows' in refusal(save(path, rows(7, 1.1)))
    assert 'holds 1 rows' in refusal(save(path, rows(1)))


def test_start_outside(folder):
    """start_s outside of 3 to 7 s is refused with these limits."""
    path = save(folder / 'good.csv', rows())
    for start_s in (0.0, 2.9, 7.0, 10.0, 1e6, -1.0):
        assert (f'start_s is {start_s:g} s; expected 3 to 7 s'
                in refusal(path, start_s=start_s))
    accepted(path, start_s=6.9)
