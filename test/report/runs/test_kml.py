"""Tracks as KML can be parsed and are right on both sides of the 180th meridian."""

import xml.etree.ElementTree as ElementTree

from ins_sim.cli.main import main
from ins_sim.report.charts.thinning import STRETCHES
from ins_sim.report.runs.kml import FILE, unbroken, write_tracks
from ins_sim.report.runs.track import Track
import numpy as np
import pytest
from support.aided.runs import command

SPACE = '{http://www.opengis.net/kml/2.2}'


def placemarks(folder):
    """Return {name: [array (n, 3) of each line or point, deg and m]} of track.kml."""
    root = ElementTree.parse(folder / FILE).getroot()
    assert root.tag == f'{SPACE}kml'
    found = {}
    for place in root.iter(f'{SPACE}Placemark'):
        assert {mode.text for mode in place.iter(f'{SPACE}altitudeMode')} == {'absolute'}
        found[place.findtext(f'{SPACE}name')] = [
            np.array([row.split(',') for row in one.text.split()], dtype=float)
            for one in place.iter(f'{SPACE}coordinates')]
    return found


def test_an_aided_flight_writes_its_tracks(tmp_path):
    """Truth, solutions and fixes are written with 1e-8 deg, about 1 mm."""
    assert command(tmp_path) == 0
    found = placemarks(tmp_path / 'run')
    assert list(found) == ['truth', 'aided solution', 'strapdown alone', 'GNSS fixes']
    with np.load(tmp_path / 'run' / 'run.npz') as arrays:
        for name, prefix in (('truth', 'truth'), ('aided solution', 'aided_states'),
                             ('strapdown alone', 'states')):
            line, = found[name]
            assert len(line) <= 7 * 2 * STRETCHES
            for end in (0, -1):
                expected = [np.degrees(arrays[f'{prefix}_lon'][end]),
                            np.degrees(arrays[f'{prefix}_lat'][end]),
                            arrays[f'{prefix}_height'][end]]
                assert line[end] == pytest.approx(expected, abs=0.0051)
                assert line[end][:2] == pytest.approx(expected[:2], abs=0.51e-8)
        assert len(found['GNSS fixes']) == (arrays['gnss_status'] == 'valid').sum()


def test_what_stays_at_its_place_has_no_track(tmp_path):
    """A bench motion has neither a track nor a figure of it."""
    assert main(['simulate', '--params-file', 'motion_2', '-p', 'duration_s:=2.0', '-o',
                 str(tmp_path / 'run')]) == 0
    assert not (tmp_path / 'run' / FILE).exists()
    assert not (tmp_path / 'run' / 'track.png').exists()


def test_a_line_over_the_antimeridian_is_cut_there(tmp_path):
    """A line from 179 deg east to 179 deg west and back has three pieces that meet at 180 deg."""
    lon = np.radians([178.0, 179.0, 181.0, 182.0, 179.5])
    lat = np.radians([10.0, 11.0, 13.0, 14.0, 19.0])
    height = np.array([0.0, 10.0, 30.0, 40.0, 90.0])
    write_tracks(tmp_path, 'over <the> \udce9 line', [Track('truth', lat, lon, height)])
    first, second, third = placemarks(tmp_path)['truth']
    assert first.tolist() == [[178.0, 10.0, 0.0], [179.0, 11.0, 10.0], [180.0, 12.0, 20.0]]
    assert second.tolist() == [[-180.0, 12.0, 20.0], [-179.0, 13.0, 30.0], [-178.0, 14.0, 40.0],
                               [-180.0, 18.0, 80.0]]
    assert third.tolist() == [[180.0, 18.0, 80.0], [179.5, 19.0, 90.0]]


@pytest.mark.parametrize('lon', [[180.0, -180.0], [-180.0, 180.0], [179.9, -180.0], [10.0]])
def test_a_point_on_the_antimeridian_divides_by_nothing(lon):
    """With a point on the 180th meridian all numbers are finite and no position is lost."""
    lon = np.array(lon)
    pieces = unbroken(lon, np.zeros(len(lon)), np.zeros(len(lon)))
    assert all(np.isfinite(piece).all() for piece in pieces)
    assert {float(x) for piece in pieces for x in piece[0]} >= set(lon.tolist())
