"""Recorded flights in detail: wrapped angles, smoothing, epochs, rounding of the file."""

import gzip
import math

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from ins_sim.core.attitude import quaternion
from ins_sim.core.motion.recorded import quality, spline
from ins_sim.core.numerics.instants import seconds
from ins_sim.io.csv_flight import read_rows, COLUMNS
from support.recorded_flights import load, recorder_angles, same, write

FLIGHTS = {'cruise_gv_acclip_rf01.csv.gz': 'refuse', 'uavcircuit_umn_thor_fl75.csv.gz': 'refuse',
           'uavaero_proto_flt09.csv': 'cut'}


@pytest.mark.parametrize('name', FLIGHTS)
def test_warnings_name_what_the_rounding_does(shared_data, name):
    """Real flights give warnings about rounding, cuts, and position steps of 3.18 m."""
    warnings = ' '.join(load(shared_data / 'flights' / name, on_gap=FLIGHTS[name]).warnings)
    assert 'differentiated twice' in warnings
    assert ('cut there' in warnings) == (FLIGHTS[name] == 'cut')
    if 'circuit' in name:
        assert 'position steps, one about every 1 s, the largest 3.18 m after t_s = 198.94' \
            in warnings


def test_gaps_of_a_real_flight_are_refused_with_their_times(shared_data):
    """Seven gaps of a real flight are refused with their times; on_gap cut flies a part."""
    path = shared_data / 'flights' / 'uavaero_proto_flt09.csv'
    with pytest.raises(ValueError) as refusal:
        load(path)
    for time in ('7 gaps', '31.5273', '118.3921', '199.216', '273.5144', '350.0913', '350.5968',
                 '422.0697', "on_gap = 'cut'"):
        assert time in str(refusal.value)
    assert load(path, on_gap='cut').end_s == pytest.approx(31.5273 - 6.0, abs=1e-9)
    assert load(path, on_gap='cut', start_s=280.0).end_s == pytest.approx(350.0913 - 283.0,
                                                                          abs=1e-9)
    with pytest.raises(ValueError, match='no part between them contains'):
        load(path, on_gap='cut', start_s=32.0)
    with pytest.raises(ValueError, match='start_s is 31 s; expected 3 to 28.5273 s'):
        load(path, on_gap='cut', start_s=31.0)


def test_wraps_of_heading_roll_and_longitude_change_nothing(tmp_path):
    """Through north, a roll of 180 deg and the date line the flight is smooth."""
    t = np.arange(201) * 0.1
    heading, roll, lon = 350.0 + 2.0 * t, 170.0 + t, 179.99 + 0.002 * t
    plain = load(write(tmp_path / 'plain.csv', t, lon=lon, roll=0.0, heading=heading % 360.0))
    x = plain.at(np.arange(0, 14 * 10 ** 9, 10 ** 8))
    assert np.abs(np.diff(x.lon) - math.radians(0.0002)).max() < 1e-12
    wrapped = load(write(tmp_path / 'wrapped.csv', t, lon=(lon + 180.0) % 360.0 - 180.0,
                         heading=(heading + 180.0) % 360.0 - 180.0))
    y = wrapped.at(x.t_ns)
    assert np.abs(x.lon - y.lon).max() < 1e-14
    assert np.abs(x.omega_ib_b - y.omega_ib_b).max() < 1e-12
    rolling = load(write(tmp_path / 'roll.csv', t, roll=(roll + 180.0) % 360.0 - 180.0),
                   rotation=False).at(x.t_ns)
    assert np.abs(rolling.omega_ib_b - [math.radians(1.0), 0.0, 0.0]).max() < 1e-9


@pytest.mark.parametrize('window_s', (0.5, 1.0))
def test_smoothing_is_a_boxcar(tmp_path, window_s):
    """A sinusoid of frequency f is reduced to sin(pi f T) / (pi f T), -3 dB at 0.443 / T."""
    f, t = 0.4429 / window_s, np.arange(3001) * 0.02
    wave = np.sin(2.0 * math.pi * f * t)
    path = write(tmp_path / 'r.csv', t, height=100.0 + wave, roll=wave)
    motion = load(path, smoothing_s=window_s)
    assert f'{window_s:g} s' in motion.warnings[0] and '-3 dB' in motion.warnings[0]
    t_ns = np.arange(0, 50 * 10 ** 9, 7 * 10 ** 6)
    x, y = motion.at(t_ns), load(path).at(t_ns)
    assert np.sinc(f * window_s) == pytest.approx(math.sqrt(0.5), abs=1e-4)
    expected = math.sqrt(0.5) * (y.height - 100.0)
    # Spline errors (2 pi f h)^4 / 720, and 1e-4 of the constant 0.4429.
    assert np.abs(x.height - 100.0 - expected).max() < 1.2e-4
    # The mean of quaternions errs by third order in a degree.
    roll = recorder_angles(x.q_nb)[0]
    assert np.abs(roll - expected).max() < 2.5e-4


def test_smoothing_over_a_whole_turn_is_refused(tmp_path):
    """Smoothing over 6 s at 90 deg/s, more than a whole turn, is refused."""
    t = np.arange(601) * 0.1
    path = write(tmp_path / 'r.csv', t, heading=(90.0 * t) % 360.0)
    with pytest.raises(ValueError, match='smoothing_s is 6 s.*turns more than once'):
        load(path, smoothing_s=6.0)


@pytest.mark.parametrize('largest', (1e-3, 0.1, 1.0, 3.0, 6.0))
def test_exponential_series_is_the_rotation_and_its_rate(largest):
    """The exponential series agrees with SciPy's rotation and the rate with q' = q (0, w) / 2."""
    rng = np.random.default_rng(2)
    r = rng.standard_normal((3, 500))
    r *= largest * rng.random(500) / np.sqrt((r * r).sum(0))
    w = rng.standard_normal((3, 500))
    terms = spline._terms(np.stack([0.0 * r, r]), np.ones(500))
    q = np.array([x.c for x in spline._exponential(r, w, terms)])
    expected = Rotation.from_rotvec(r.T).as_quat()
    expected *= np.sign((expected * q[:, 0].T).sum(1))[:, None]
    assert np.abs(q[:, 0].T - expected).max() < 1e-15
    assert np.abs((q[:, 0] * q[:, 1]).sum(0)).max() < 2e-15
    d = 1e-5
    ends = [Rotation.from_rotvec((r + k * d * w).T) for k in (-1, 1)]
    rate = (ends[0].inv() * ends[1]).as_rotvec() / (2.0 * d)
    mine = 2.0 * np.array(quaternion.multiply(quaternion.conjugate(tuple(q[:, 0])),
                                              tuple(q[:, 1])))[:3].T
    assert np.abs(rate - mine).max() < 1e-8


def test_gzip_is_the_plain_file(tmp_path, flown):
    """A gzipped recording gives the truth of the plain file, to the bit."""
    data = open(flown[0].path, 'rb').read()
    packed = tmp_path / 'aggressive.csv.gz'
    packed.write_bytes(gzip.compress(data))
    t_ns = np.arange(0, 10 ** 10, 10 ** 7)
    assert same(load(packed).at(t_ns), flown[0].at(t_ns))


def test_stamps_of_an_epoch_keep_their_nanoseconds(tmp_path):
    """Stamps are parsed as decimals: as a float 1.7e9 s would resolve only 0.24 us."""
    stamps = [f'17000000{k // 10:02d}.{k % 10}00000001' for k in range(101)]
    lines = [','.join(COLUMNS)] + [f'{s},55,37,100,0,0,0,,,' for s in stamps]
    path = tmp_path / 'r.csv'
    path.write_text('\n'.join(lines))
    assert np.array_equal(np.diff(read_rows(path).t_ns), np.full(100, 10 ** 8))
    assert seconds(read_rows(path).t_ns[0]) == '1700000000.000000001 s'


def test_outside_the_recording_is_a_sentence(flown):
    """An instant outside -3 to 17 s raises a ValueError with these limits."""
    motion = flown[0]
    assert motion.end_s == pytest.approx(14.0) and motion.period_s is None
    assert len(motion.at(np.array([], dtype=np.int64))) == 0
    motion.at(np.array([-3 * 10 ** 9, 17 * 10 ** 9]))
    for t_ns in (-3 * 10 ** 9 - 1, 17 * 10 ** 9 + 1):
        with pytest.raises(ValueError, match='outside the recording .*; expected -3 to 17 s'):
            motion.at(np.array([0, t_ns]))


def test_rounding_noise_is_what_rounding_does(tmp_path):
    """The predicted force noise of rounded heights in level flight is right to 5 % (n = 4000)."""
    rng = np.random.default_rng(1)
    t = np.arange(4000) * 0.1
    # A slow random walk decorrelates the rounding; its own acceleration is 1e-4 m/s^2.
    height = np.round(100.0 + 3.0 * np.sin(0.005 * t) + 2.0 * np.sin(0.0037 * t + 1.0)
                      + 0.3 * rng.standard_normal(4000), 1)
    motion = load(write(tmp_path / 'r.csv', t, height=height, digits='.15g'))
    predicted = quality.rounding_noise((0.0, 0.0, math.sqrt(0.09 * 12.0 + 0.01)), 1.0,
                                       100.0, 0.1, 0.0)[2]
    # Noise and rounding together: 0.09 + 0.01 / 12 m^2 of white height noise.
    up = motion.at(motion._knots[50:-50]).f_ib_b[:, 2]
    assert np.std(up) == pytest.approx(predicted, rel=0.05)
    assert any('rounded to' in w and '0.1 m' in w for w in motion.warnings)
    assert any('scatter from row to row' in w for w in motion.warnings)


def test_unrounded_flight_draws_no_warning(flown, tmp_path):
    """No warning without rounding, nor for few exact decimals: 10 m/s to 0.1 m at 100 Hz."""
    assert flown[0].warnings == []
    t = np.arange(1001) * 0.01
    assert load(write(tmp_path / 'r.csv', t, height=10.0 * t, digits='.12g')).warnings == []


def test_single_precision_is_seen_through_its_decimals(tmp_path):
    """The resolution of float32 latitudes printed in full is found: 2^-18 deg = 0.42 m."""
    t = np.arange(501) * 0.1
    lat = np.float32(55.0 + 3e-4 * np.sin(0.3 * t)).astype(float)
    path = write(tmp_path / 'r.csv', t, lat=lat)
    assert read_rows(path).resolution == (2.0 ** -18, 0.0, 0.0)
    assert any('rounded to 4e-06 deg' in w for w in load(path).warnings)


def test_spline_gain_is_the_gain_of_the_spline():
    """The noise gain of the spline is the root of the sum of squares of its impulse response."""
    from scipy.interpolate import make_interp_spline
    t = np.arange(201.0)
    impulse = make_interp_spline(t, (t == 100.0).astype(float), k=5)
    assert quality.spline_gain() == pytest.approx(
        math.sqrt((impulse(t, nu=2) ** 2).sum()), rel=1e-9)
    assert quality.spline_gain(10.0) < 0.1 * quality.spline_gain()
