"""Angles of a recording that turned on, sentinels among them, and stamps of years."""

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
    """Whole turns are taken off, which is said; the flight is the same."""
    table = rows()
    plain = accepted(save(folder / 'plain.csv', table))
    for row in table[20:30]:
        row[COLUMNS.index(name)] = repr(beyond)
    motion = accepted(save(folder / 'turned.csv', table))
    assert f'10 values of {name} beyond' in motion.warnings[0]
    assert np.abs(motion.at([0]).q_nb - plain.at([0]).q_nb).max() < 1e-12


@pytest.mark.parametrize('name, text', [('roll_deg', '-9999'), ('heading_deg', '99999'),
                                        ('pitch_deg', '100'), ('pitch_deg', '-9999')])
def test_sentinels_and_pitches_beyond_the_vertical_are_refused(folder, name, text):
    """-9999 is no angle, and no turn brings 100 degrees of pitch back."""
    table = rows()
    table[7][COLUMNS.index(name)] = text
    assert f"line 9 (t_s = '0.700'): {name} is '{text}'" in refusal(
        save(folder / 'sentinel.csv', table))


def test_steps_of_years_are_refused_before_anything_is_made_of_them(folder):
    """Rows 1e8 s apart at 100 Hz would take 440 GiB."""
    table = [[f'{k}e8', *row[1:]] for k, row in enumerate(rows(21))]
    assert 'holds a row every 1e+08 s over 2e+09 s' in refusal(save(folder / 'years.csv', table))
