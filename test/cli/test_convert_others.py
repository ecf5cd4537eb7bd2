"""The command convert on CSV files whose columns have other names and units."""

from ins_sim.bags.bag_reader import open_bag
from ins_sim.cli.main import main
from ins_sim.io import csv_imu
import numpy as np
import pytest


def convert(*words):
    """Return the exit code of the command."""
    return main(['convert', *map(str, words)])


def test_an_imu_of_others_by_a_map_of_its_columns(tmp_path, capsys):
    """The parameters columns, units and stamps work as in navigate."""
    rows = '\n'.join(f'{k} {k},{0.1 * k:g},1,2,4,5,9.8'.replace(' ', ',') for k in range(20))
    (tmp_path / 'x.csv').write_text('n,tick,p,q,r,fx,fy,fz,note\n' + rows.replace('\n', ',a\n')
                                    + ',a\n')
    names = dict(zip(('t_s', *csv_imu.IMU), ('tick', 'p', 'q', 'r', 'fx', 'fy', 'fz')))
    words = [word for key, name in names.items() for word in ('-p', f'columns.{key}:={name}')]
    words += ['-p', 'units.time:=ms', '-p', 'units.rate:=deg/s', '-p', 'units.force:=g']
    assert convert(tmp_path / 'x.csv', tmp_path / 'bag', *words) == 0
    said = capsys.readouterr().out
    assert '2 columns are not used: n, note' in said and 'times 9.80665' in said
    with open_bag(tmp_path / 'bag') as bag:
        table = bag.arrays('imu/data_raw')
    assert table['stamp_ns'].tolist() == [k * 10 ** 6 for k in range(20)]
    assert np.allclose(table['linear_acceleration'][3], np.array([4.0, 5.0, 9.8]) * 9.80665)
    assert np.allclose(table['angular_velocity'][4, :1], np.radians(0.4))


def test_a_flight_of_others_by_a_map_of_its_columns(tmp_path):
    """motion.recording.columns reads units in brackets and files without velocities."""
    header = 'clock [us],Lat,Long [deg],Alt [ft],R [rad],P [rad],Course [deg],sats'
    rows = [f'{100_000 * k},{55.0 + 3.6e-5 * k:.7f},37.0,{1000.0},0.01,0.02,3.0,9'
            for k in range(101)]
    (tmp_path / 'x.csv').write_text('\n'.join([header, *rows]))
    names = {'t_s': 'clock', 'lat_deg': 'Lat', 'lon_deg': 'Long', 'height_m': 'Alt',
             'roll_deg': 'R', 'pitch_deg': 'P', 'heading_deg': 'Course'}
    words = [word for key, name in names.items()
             for word in ('-p', f'motion.recording.columns.{key}:={name}')]
    assert convert(tmp_path / 'x.csv', tmp_path / 'bag', *words) == 0
    with open_bag(tmp_path / 'bag') as bag:
        fix = bag.arrays('truth/fix')
    assert np.allclose(fix['altitude'], 304.8, atol=1e-6)
    assert np.allclose(fix['latitude'][[0, -1]], [55.0, 55.0036], atol=1e-9)


@pytest.mark.parametrize('spoil, says', [
    ({7: '0.06,0,0,0,0,0,9.8'}, '1 with the stamp of the one before'),
    ({7: '0.015,0,0,0,0,0,9.8'}, '1 with a stamp that goes back'),
    ({7: '0.07,nan,0,0,0,0,9.8', 8: '0.08,0,0,0,3.2e6,0,9.8'},
     '1 that are not finite, 1 beyond 1e+06 m/s^2 or 10000 rad/s'),
    ({k: f'0.{k:02d},1,0,0,0,0,0' for k in range(10, 20, 2)},
     '5 whose specific force is exactly zero'),
    ({}, '')])
def test_odd_samples_are_kept_and_said(spoil, says, tmp_path, capsys):
    """A conversion keeps odd samples and reports them, in both directions."""
    rows = [spoil.get(k, f'0.{k:02d},0,0,0,0,0,9.8') for k in range(30)]
    (tmp_path / 'imu.csv').write_text('\n'.join(['t_s,' + ','.join(csv_imu.IMU), *rows, '']))
    for words in (['imu.csv', 'bag'], ['bag', 'back.csv']):
        if words[0] == 'bag' and 'goes back' in says:
            # A bag is sorted by log time, which is the stamp here.
            says = ''
        assert main(['convert', *(str(tmp_path / word) for word in words)]) == 0
        said = capsys.readouterr().out
        assert says == '' or f'kept as they are: of 30 samples {says}\n' in said
        assert ('kept as they are' in said) == bool(says)
    assert len((tmp_path / 'back.csv').read_text().splitlines()) == 31
