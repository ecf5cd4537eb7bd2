"""Recordings with angles beyond a turn, invalid angles, and stamps years apart."""

import numpy as np
import pytest

from ins_sim.io.csv_flight import COLUMNS
from support.recorded_flights import accepted, refusal, rows, save


@pytest.fixture(scope='module')
def folder(tmp_path_factory):
    return tmp_path_factory.mktemp('angles')


@pytest.mark.parametrize('name, beyond', [('roll_deg', 1.0 + 360.0), ('heading_deg', 3.0 + 720.0),
                                          ('heading_deg', 3.0 - 1080.0), ('pitch_deg', 362.0)])
def test_angles_that_turned_on_are_brought_back(folder, name, beyond):
    """Whole turns are subtracted from angles, with a warning; the flight stays the same."""
    table = rows()
    plain = accepted(save(folder / 'plain.csv', table))
    for row in table[20:30]:
        row[COLUMNS.index(name)] = repr(beyond)
    motion = accepted(save(folder / 'turned.csv', table))
    assert f'10 values of {name} outside' in motion.warnings[0]
    assert np.abs(motion.at([0]).q_nb - plain.at([0]).q_nb).max() < 1e-12


@pytest.mark.parametrize('start', [179.9995, -0.0005])
def test_longitudes_of_0_to_360_are_those_of_180_west_to_east(folder, start):
    """Longitudes of 0 to 360 deg and of +-180 deg give the same flight over 0 and 180 deg."""
    table, column = rows(), COLUMNS.index('lon_deg')
    motions = []
    for name, low in (('west', -180.0), ('east', 0.0)):
        for k, row in enumerate(table):
            row[column] = f'{(start + 1e-4 * k - low) % 360.0 + low:.9f}'
        motions.append(accepted(save(folder / f'{name}.csv', table)))
    t_ns = 1_000_000_000 * np.arange(int(motions[0].end_s))
    a, b = (motion.at(t_ns) for motion in motions)
    # 9 decimals of a degree, and 360 deg in 16 digits.
    assert np.abs((a.lon - b.lon + 1.0) % (2.0 * np.pi) - 1.0).max() < 1e-12
    assert np.abs(a.v_n - b.v_n).max() < 1e-4


@pytest.mark.parametrize('name, text', [('roll_deg', '-9999'), ('heading_deg', '99999'),
                                        ('pitch_deg', '100'), ('pitch_deg', '-9999')])
def test_sentinels_and_pitches_beyond_the_vertical_are_refused(folder, name, text):
    """-9999 as an angle, and a pitch of 100 deg, are refused: no whole turn makes them valid."""
    table = rows()
    table[7][COLUMNS.index(name)] = text
    assert f"line 9 (t_s = '0.700'): {name} is '{text}'" in refusal(
        save(folder / 'sentinel.csv', table))


def test_steps_of_years_are_refused_before_anything_is_made_of_them(folder):
    """Rows 1e8 s apart are refused: at 100 Hz they would need 440 GiB."""
    table = [[f'{k}e8', *row[1:]] for k, row in enumerate(rows(21))]
    assert 'holds a row every 1e+08 s over 2e+09 s' in refusal(save(folder / 'years.csv', table))
