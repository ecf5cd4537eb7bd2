"""Recorded flights: what the splines must reproduce, and what must not change them."""

import math

from hypothesis import given, settings as profile, strategies as st
import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from ins_sim.settings.place import Datum, Earth
from ins_sim.settings.motion import MotionSettings
from ins_sim.core.motion.factory import make_motion
from ins_sim.io.csv_flight import read_rows
from support.recorded_flights import load, record, recorder_angles, same, write

FLIGHTS = {'cruise_gv_acclip_rf01.csv.gz': 'refuse', 'uavcircuit_umn_thor_fl75.csv.gz': 'refuse',
           'uavaero_proto_flt09.csv': 'cut'}


@pytest.mark.parametrize('name', FLIGHTS)
def test_spline_passes_through_every_recorded_sample(shared_data, name):
    """The spline interpolates to the rounding of radians, of its offsets and of the stamps."""
    path = shared_data / 'flights' / name
    motion = load(path, on_gap=FLIGHTS[name])
    rows = read_rows(path)
    t_ns = rows.t_ns - rows.t_ns[0] - 3 * 10 ** 9
    used = t_ns <= round((motion.end_s + 3.0) * 1e9)
    x = motion.at(t_ns[used])
    assert np.abs(x.lat - np.radians(rows.lat_deg[used])).max() < 1e-15
    assert np.abs(x.lon - np.radians(rows.lon_deg[used])).max() < 2e-15
    assert np.abs(x.height - rows.height_m[used]).max() < 1e-11
    found = recorder_angles(x.q_nb)
    wanted = (rows.roll_deg, rows.pitch_deg, rows.heading_deg)
    for a, b in zip(found, wanted):
        assert np.abs((a - b[used] + 180.0) % 360.0 - 180.0).max() < 1e-11


@pytest.mark.parametrize('name', FLIGHTS)
def test_rate_and_acceleration_are_continuous_at_the_samples(shared_data, name):
    """The rate is C1 at samples: across 2 ns it changes by its slope, and the slope is equal."""
    motion = load(shared_data / 'flights' / name, on_gap=FLIGHTS[name], rotation=False)
    knots = motion._knots[20:-20]
    d = 1000
    rate = [motion.at(knots + k * d).omega_ib_b for k in (-2, -1, 1, 2)]
    before, after = (rate[1] - rate[0]) / (d * 1e-9), (rate[3] - rate[2]) / (d * 1e-9)
    jerk = np.abs(motion.at(knots[:-1]).omega_ib_b).max() / np.diff(knots).min() ** 2 * 1e18
    # The slopes are 3 us apart, and differences of rates over 1 us round to 1e-16/1e-6 of a rate.
    assert np.abs(after - before).max() < 3.0 * d * 1e-9 * 20.0 * jerk + 1e-8
    assert np.abs(rate[2] - rate[1]).max() < 2.1 * d * 1e-9 * np.abs(before).max() + 1e-9


@pytest.mark.parametrize('name', FLIGHTS)
def test_rate_and_velocity_are_those_of_the_pose(shared_data, name):
    """Rate and velocity agree with central differences of quaternion and position over 2 ms."""
    motion = load(shared_data / 'flights' / name, on_gap=FLIGHTS[name], smoothing_s=2.0,
                  rotation=False)
    t_ns = np.linspace(0.0, motion.end_s * 1e9, 500).astype(np.int64)
    d = 10 ** 6
    a, x, b = (motion.at(t_ns + k * d) for k in (-1, 0, 1))
    moved = (Rotation.from_quat(a.q_nb).inv() * Rotation.from_quat(b.q_nb)).as_rotvec()
    # omega_in for a non-rotating Earth is the transport rate only.
    transport = Rotation.from_quat(x.q_nb).inv().apply(np.stack([
        -(b.lat - a.lat), (b.lon - a.lon) * np.cos(x.lat), (b.lon - a.lon) * np.sin(x.lat)], -1))
    rate = (moved + transport) / (2.0 * d * 1e-9)
    # Truncation d^2/6 times the third derivative. With 2 s of smoothing the steps of the circuit
    # cause jerks of 1500 m/s^3 and less than 100 rad/s^3.
    assert np.abs(rate - x.omega_ib_b).max() < 1e-6 / 6.0 * 100.0
    up = (b.height - a.height) / (2.0 * d * 1e-9)
    assert np.abs(up - x.v_n[:, 2]).max() < 1e-6 / 6.0 * 3000.0


def test_recorded_closed_form_converges(tmp_path):
    """The force errs by h^4 and the rate by h^3: halving h divides the errors by 16 and 8."""
    motion = make_motion(MotionSettings(kind='aggressive'), Datum(),
                         Earth())
    t_ns = np.linspace(0.0, 30e9, 997).astype(np.int64)
    errors = []
    for rate in (2.5, 5.0):
        x = load(record(tmp_path / 'r.csv', motion, rate, 40.0), start_s=4.0).at(t_ns)
        y = motion.at(t_ns + 4 * 10 ** 9)
        errors.append([np.abs(getattr(x, f) - getattr(y, f)).max() for f in
                       ('f_ib_b', 'omega_ib_b')])
        assert np.abs(np.abs((x.q_nb * y.q_nb).sum(1)) - 1.0).max() < 1e-9
    ratio = np.array(errors[0]) / errors[1]
    # The force is resolved with an attitude that errs by h^4 too: both orders, less a tenth.
    assert ratio[0] > 2.0 ** 3.6 and ratio[1] > 2.0 ** 2.7
    assert errors[1][0] < 1e-2 and errors[1][1] < 1e-3


def test_angles_are_the_recorders(tmp_path):
    """Recorded angles: heading clockwise from north, nose up, right wing down; FLU to ENU."""
    t = np.arange(101) * 0.1
    for angles, body, world in (({'heading': 90.0}, (1, 0, 0), (1, 0, 0)),
                                ({'heading': 0.0}, (1, 0, 0), (0, 1, 0)),
                                ({'pitch': 30.0}, (1, 0, 0), (0, math.sqrt(0.75), 0.5)),
                                ({'roll': 30.0}, (0, 1, 0), (-math.sqrt(0.75), 0, 0.5)),
                                ({'roll': 30.0}, (0, 0, 1), (0.5, 0, math.sqrt(0.75)))):
        q = load(write(tmp_path / 'r.csv', t, **angles)).at(np.array([0])).q_nb
        assert np.abs(Rotation.from_quat(q).apply(body) - world).max() < 1e-15


@profile(max_examples=40, deadline=None)
@given(cuts=st.lists(st.integers(0, 400), max_size=8))
def test_any_cutting_gives_the_same_bits(flown, cuts):
    """Truth of a recorded flight computed in random blocks has the bits of the whole."""
    motion = flown[0]
    t_ns = np.linspace(-3e9, 17e9, 401).astype(np.int64)
    whole = motion.at(t_ns)
    parts = [motion.at(p) for p in np.split(t_ns, sorted(cuts))]
    assert same(type(whole).concatenate(parts), whole)


def test_long_runs_are_the_same_bits_as_single_instants(flown):
    """Truth at 40001 instants has the bits of truth at single instants."""
    motion = flown[0]
    t_ns = np.linspace(-3e9, 17e9, 40001).astype(np.int64)
    whole = motion.at(t_ns)
    for k in range(0, 40001, 997):
        assert same(motion.at(t_ns[k:k + 1]), whole[k:k + 1])
