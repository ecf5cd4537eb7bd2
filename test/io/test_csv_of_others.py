"""CSV files of other programs: columns, units, separators, headers, clocks."""

import gzip

import numpy as np
import pytest

from ins_sim.cli.main import main
from ins_sim.core.numerics.instants import unwrap_clock
from ins_sim.core.numerics.units import STANDARD_GRAVITY
from ins_sim.io.csv_imu import IMU, read_imu, read_reference
from ins_sim.settings.catalogue import build
from ins_sim.settings.motion import FlightColumns
from ins_sim.settings.recorded_imu import ImuColumns, RecordUnits

N = 40
PLAIN = ('t_s', *IMU)
ROS_1 = ('%time', *(f'field.angular_velocity.{a}' for a in 'xyz'),
         *(f'field.linear_acceleration.{a}' for a in 'xyz'))
EUROC = ('#timestamp [ns]', *(f'w_RS_S_{a} [rad s^-1]' for a in 'xyz'),
         *(f'a_RS_S_{a} [m s^-2]' for a in 'xyz'))
FUSION = ('Time (s)', *(f'Gyroscope {a} (deg/s)' for a in 'XYZ'),
          *(f'Accelerometer {a} (g)' for a in 'XYZ'))
VALUES = np.random.default_rng(5).standard_normal((N, 6)).round(6)
T_NS = 1_403_636_580_000_000_123 + 5_000_000 * np.arange(N)
SECONDS = [f'{t // 10 ** 9}.{t % 10 ** 9:09d}' for t in T_NS.tolist()]


def table(header, times, values=VALUES, mark=','):
    """Return the text of a CSV file."""
    return '\n'.join([mark.join(header), *(mark.join([str(t), *map(repr, row)])
                                           for t, row in zip(times, values.tolist())), ''])


def read(tmp_path, text, name='imu.csv', columns=None, units=None):
    """Return stamps, SI values and notes of a file with this text."""
    path = tmp_path / name
    path.write_bytes(text if isinstance(text, bytes) else text.encode())
    imu, notes = read_imu(path, build(ImuColumns, columns or {}), build(RecordUnits, units or {}))
    return imu.t_ns, np.concatenate([imu.omega, imu.f], axis=1), notes


SHAPES = {
    'plain': (table(PLAIN, SECONDS), 1.0, 1.0),
    'ros 1': (table(ROS_1, T_NS), 1.0, 1.0),
    'euroc': (table(EUROC, T_NS), 1.0, 1.0),
    'fusion': (table(FUSION, SECONDS), np.pi / 180.0, STANDARD_GRAVITY),
    'tabs': (table(PLAIN, SECONDS, mark='\t'), 1.0, 1.0),
    'semicolons': (table(PLAIN, SECONDS, mark=';').replace('.', ','), 1.0, 1.0),
    'quoted': (table([f' "{name}"' for name in PLAIN], SECONDS), 1.0, 1.0),
    'comments': ('# my imu, 100 Hz\n\n% more\n' + table(PLAIN, SECONDS) + '# end\n', 1.0, 1.0),
    'crlf': (table(PLAIN, SECONDS).replace('\n', '\r\n'), 1.0, 1.0),
    'mark': ('\ufeff' + table(PLAIN, SECONDS), 1.0, 1.0)}


@pytest.mark.parametrize('shape', SHAPES)
def test_stamps_and_values_are_those_of_the_file(shape, tmp_path):
    """For any header and separator stamps are exact to 1 ns, and values are in SI units."""
    text, rate, force = SHAPES[shape]
    t_ns, values, _ = read(tmp_path, text)
    assert np.array_equal(t_ns, T_NS)
    assert np.allclose(values, VALUES * np.repeat(
        [rate, force], 3), rtol=1e-15, atol=0.0)


def test_a_map_of_columns_with_units(tmp_path):
    """
    Columns of any name are read by a map, with units in brackets or from units.*.

    Unused columns are noted.
    """
    header = ('tick (us)', 'p', 'q', 'r', 'nx [mg]', 'ny [mg]', 'nz [mg]')
    text = table(header, T_NS // 1000).replace('tick', 'host name,tick').replace('\n', '\nabc,')
    text = text[4:] if text.startswith('abc,') else text
    text = text.rstrip('abc,') + '\n'
    columns = dict(zip(PLAIN, header))
    t_ns, values, notes = read(tmp_path, text, columns=columns, units={'rate': 'deg/s'})
    assert np.array_equal(t_ns, T_NS // 1000 * 1000)
    assert np.allclose(values[:, :3], np.radians(VALUES[:, :3]), rtol=1e-15, atol=0.0)
    assert np.allclose(values[:, 3:], VALUES[:, 3:] * STANDARD_GRAVITY * 1e-3, rtol=1e-15,
                       atol=0.0)
    assert any('1 columns are not used: host name' in note for note in notes)
    assert any('gx_rps from p times 0.0174532925' in note for note in notes)
    with pytest.raises(ValueError, match=r"no column 'P1', the value of columns.gx_rps; the near"):
        read(tmp_path, text, columns={**columns, 'gx_rps': 'P1'})
    with pytest.raises(ValueError, match='furlong/s.; expected one of rad/s.*or units.rate'):
        read(tmp_path, text.replace(',q,', ',q [furlong/s],'),
             columns={**columns, 'gy_rps': 'q'})


def test_a_repeated_header_and_capital_letters(tmp_path):
    """A header repeated in concatenated files is skipped, and names .CSV or .CSV.GZ are read."""
    text = table(PLAIN, SECONDS)
    lines = text.split('\n')
    twice = '\n'.join([*lines[:20], lines[0], *lines[20:]])
    t_ns, _, notes = read(tmp_path, twice)
    assert np.array_equal(t_ns, T_NS) and 'the header is repeated in 1 lines, the first of them ' \
        'line 21' in notes[0]
    for name, data in (('IMU.CSV', text.encode()), ('IMU.CSV.GZ', gzip.compress(text.encode()))):
        (tmp_path / name).write_bytes(data)
        assert main(['convert', str(tmp_path / name), str(tmp_path / name[:-4])]) == 0


@pytest.mark.parametrize('shape', ['plain', 'semicolons', 'tabs'])
def test_a_file_without_a_header_by_the_numbers_of_its_columns(shape, tmp_path):
    """
    A file without a header is refused, and is read if columns are given by number.

    The message names the parameter, and the first line is not lost.
    """
    text = SHAPES[shape][0].partition('\n')[2]
    with pytest.raises(ValueError, match='line 1: the header line contains numbers; '
                       'expected t_s, .*, or columns.t_s "column 1" and so on'):
        read(tmp_path, text)
    columns = {name: f'column {k}' for k, name in enumerate(PLAIN, 1)}
    t_ns, values, notes = read(tmp_path, text, columns=columns, units={'rate': 'deg/s'})
    assert np.array_equal(t_ns, T_NS)
    assert np.allclose(values[:, :3], np.radians(VALUES[:, :3]), rtol=1e-15, atol=0.0)
    assert np.array_equal(values[:, 3:], VALUES[:, 3:])
    assert any('t_s from column 1' in note for note in notes)
    with pytest.raises(ValueError, match="no column 'column 8', the value of columns.az_mps2"):
        read(tmp_path, text, columns={**columns, 'az_mps2': 'column 8'})


@pytest.mark.parametrize('text, sentence', [
    (table(PLAIN, ['1e300'] * N), "t_s is '1e300'; expected a number of seconds within"),
    (table(PLAIN, ['9300000000'] * N), "t_s is '9300000000'; expected"),
    (table(PLAIN, ['9' * 400] * N), 'not finite; expected'),
    (table(ROS_1, ['1e30'] * N), "t_s is '1e30'; expected"),
    (table(PLAIN, SECONDS)[len(','.join(PLAIN)) + 1:], 'the header line contains numbers'),
    (table([*PLAIN[:-1], 'az'], SECONDS), 'it has no column az_mps2; expected'),
    (table(['t_s', *(f'/{b}/angular_velocity/{a}' for b in 'lr' for a in 'xyz')], SECONDS),
     'columns.gx_rps to name one')])
def test_what_is_no_such_table_is_one_sentence(text, sentence, tmp_path, capsys):
    """An invalid table gives one message, the same for both commands that read an IMU."""
    (tmp_path / 'imu.csv').write_text(text)
    for words in (['navigate', 'imu.csv', '-o', 'out'],
                  ['convert', 'imu.csv', 'bag', '-p', 'columns.az_mps2:=az_mps2']):
        words = [str(tmp_path / w) if '.' in w and ':' not in w or w in ('out', 'bag') else w
                 for w in words]
        assert main(words) == 2
        error = capsys.readouterr().err
        assert error.count('\n') == 1 and len(error) < 1000
        assert sentence in error or words[0] == 'convert' and 'az_mps2' in error


def test_a_million_unknown_columns_are_a_few_and_a_number(tmp_path, capsys):
    """The message about 200 000 unknown columns has fewer than 1000 characters."""
    header = ','.join(f'column{k}' for k in range(200_000))
    (tmp_path / 'imu.csv').write_text(header + '\n' + ','.join('0' * 200_000) + '\n')
    assert main(['navigate', str(tmp_path / 'imu.csv'), '-o', str(tmp_path / 'out')]) == 2
    error = capsys.readouterr().err
    assert '199996 more unknown columns' in error and len(error) < 1000


@pytest.mark.parametrize('unit_ns, name', [(1, 'ns'), (1000, 'us'), (10 ** 6, 'ms')])
def test_a_32_bit_clock_that_wraps_is_unwrapped(unit_ns, name):
    """
    A 32-bit clock that wraps around gives increasing stamps; smaller steps back are kept.

    They are dropped later as out of order.
    """
    period, step = 2 ** 32 * unit_ns, 10_000_000
    t_ns = period - 10 * step + 7 * unit_ns + np.arange(60) * step
    wrapped, said = unwrap_clock(t_ns % period)
    assert np.array_equal(wrapped, t_ns)
    assert f'32 bits of {name}) wraps around 1 times' in said
    back = np.array([0, 10, 20, 5, 30]) * step
    assert unwrap_clock(back) == (pytest.approx(back), '')


def test_a_reference_with_other_names_and_bad_rows(tmp_path):
    """A reference in radians and feet is read by its units; rows without position are dropped."""
    rows = [f'{k},{0.96 + 1e-6 * k},{0.65},{1000.0 + k},{370.0}' for k in range(20)]
    rows[0] = '0,0,0,14.2,1'
    rows[5] = '5,0.96,0.65,nan,1'
    rows[6] = '6,700,0.65,1000,1'
    path = tmp_path / 'track.csv'
    header = 'tow (s),latitude [rad],Longitude [rad],Altitude (ft),sats'
    path.write_text('\n'.join([header, *rows]))
    reference, notes = read_reference(path, build(FlightColumns, {'t_s': 'tow (s)'}))
    assert len(reference.position.t_ns) == 17
    assert reference.position.values[0] == pytest.approx([0.960001, 0.65, 1001 * 0.3048])
    assert reference.velocity is None and reference.attitude is None
    assert any('3 of 20 rows dropped: 1 whose height is not a number, 1 outside the range of '
               'latitude, longitude or height, 1 at latitude 0' in note for note in notes)


def test_gzip_that_fills_the_memory_is_refused(tmp_path, capsys):
    """A gzip file of 100 kB with 80 MB of one row is refused."""
    row = b'0,0,0,0,0,0,0\n'
    path = tmp_path / 'bomb.csv.gz'
    path.write_bytes(gzip.compress(','.join(PLAIN).encode() + b'\n' + row * (80_000_000 // 14)))
    assert main(['navigate', str(path), '-o', str(tmp_path / 'out')]) == 2
    assert 'and unpacks to more than 67108864; expected' in capsys.readouterr().err


@pytest.mark.parametrize('name', ['x.csv', 'x.mcap', 'x.db3'])
def test_devices_and_pipes_are_refused(name, tmp_path, capsys):
    """Devices and pipes, which may be endless, are refused."""
    import os
    os.mkfifo(tmp_path / name)
    (tmp_path / f'zero_{name}').symlink_to('/dev/zero')
    for given, kind in ((name, 'a pipe'), (f'zero_{name}', 'a device')):
        assert main(['navigate', str(tmp_path / given), '-o', str(tmp_path / 'out')]) == 2
        error = capsys.readouterr().err
        assert f'{given} is {kind}; expected' in error and error.count('\n') == 1
