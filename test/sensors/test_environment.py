"""Magnetometer and barometer: published values, noise by index, and their messages in a bag."""

import math
import sys

from ins_sim.bags.bag_reader import open_bag
from ins_sim.cli.main import main
from ins_sim.core.attitude import quaternion
from ins_sim.core.earth.atmosphere import pressure
from ins_sim.core.sensors.environment import Barometer, Magnetometer
from ins_sim.io import environment, magnetic_field
from ins_sim.messages import topics
from ins_sim.settings.catalogue import build
from ins_sim.settings.imu import ImuSensorSettings
from ins_sim.settings.node import EPOCH_S
import numpy as np
import pytest

# WMM2025 test values, NCEI: year, height km, latitude and longitude deg, X, Y, Z in nT.
PUBLISHED = [(2025.0, 0.0, 80.0, 0.0, 6521.6, 145.9, 54791.5),
             (2025.0, 0.0, 0.0, 120.0, 39677.8, -109.6, -10580.2),
             (2025.0, 0.0, -80.0, 240.0, 6117.5, 15751.9, -52022.5),
             (2027.5, 100.0, 80.0, 0.0, 6196.7, 233.8, 52670.5),
             (2027.5, 100.0, -80.0, 240.0, 5984.0, 14760.1, -49317.7)]


@pytest.mark.parametrize('year, height, lat, lon, north, east, down', PUBLISHED)
def test_the_field_is_the_published_one(year, height, lat, lon, north, east, down):
    """The magnetic field has the published WMM2025 values to the last digit, in ENU and tesla."""
    pytest.importorskip('pygeomag')
    field = magnetic_field.magnetic_field(year)
    found = field(math.radians(lat), math.radians(lon), 1e3 * height)
    assert np.multiply(found, 1e9) == pytest.approx([east, north, -down], abs=0.0501)


def test_a_missing_model_is_said_in_one_sentence(monkeypatch):
    """If the magnetic model is missing, one message names the package and how to get it."""
    monkeypatch.setitem(sys.modules, 'pygeomag', None)
    magnetic_field._model.cache_clear()
    with pytest.raises(ValueError, match='magnetometer.publish is true and pygeomag cannot be '
                       r'imported \(.*\); expected this package .*extra magnetic of ins_sim'):
        environment.EnvironmentSensors(build(ImuSensorSettings, {'magnetometer.publish': True}))


@pytest.mark.parametrize('height, expected', [
    # U.S. Standard Atmosphere 1976, at geopotential heights.
    (0.0, 101325.0), (1000.0, 89874.6), (11000.0, 22632.06), (20000.0, 5474.889),
    (32000.0, 868.0187), (47000.0, 110.9063), (51000.0, 66.93887), (71000.0, 3.956420)])
def test_the_pressure_is_that_of_the_standard_atmosphere(height, expected):
    """The pressure is that of the U.S. Standard Atmosphere 1976 to the digits of the table."""
    assert pressure(height) == pytest.approx(expected, rel=1e-6)
    assert pressure(height - 1.0) > pressure(height) > pressure(height + 1.0)


def test_there_is_a_pressure_everywhere():
    """The pressure is positive from the deepest datum to the highest."""
    assert 0.0 < pressure(1e6) < pressure(9e4) < pressure(-500.0) < 1.08e5


def test_each_run_has_noise_of_its_own():
    """Magnetometer and barometer repeat their noise for the same run and differ for other runs."""
    settings = [build(ImuSensorSettings, {'run': run}) for run in (0, 1, 1)]
    for make in (Barometer, lambda s: Magnetometer(s, east)):
        zero, one, again = (np.ravel(make(s).due(0)).tolist() for s in settings)
        assert one == again != zero


def east(lat, lon, height):
    """Return a field of 50 uT to the east."""
    return 5e-5, 0.0, 0.0


def test_noise_is_by_index_and_seed():
    """The first sample of each period is used; its noise depends on index and seed only."""
    values = {'magnetometer.rate_hz': 20.0, 'barometer.rate_hz': 10.0, 'seed': 3}
    settings = build(ImuSensorSettings, values)
    turned = quaternion.exponential((0.0, 0.0, 0.5 * math.pi))
    place = 0.9, 0.6, 1000.0, (0.0, 0.0, 0.0), turned
    readings = []
    for step_ns in (10_000_000, 50_000_000):
        meter, found = Magnetometer(settings, east), {}
        for t_ns in range(0, 200_000_000_000, step_ns):
            noise = meter.due(t_ns)
            if noise is not None:
                found[t_ns] = meter.read(place, noise)
                assert meter.due(t_ns) == noise
        readings.append(found)
    assert readings[0] == readings[1] and len(readings[0]) == 4000
    rows = np.array(list(readings[0].values()))
    # Forward is north, so that east is to the right; the second axis is to the left.
    assert rows.mean(axis=0) == pytest.approx([0.0, -5e-5, 0.0], abs=6e-9)
    assert rows.std(axis=0) == pytest.approx([1e-7] * 3, rel=0.05)
    barometer, other = Barometer(settings), Barometer(build(ImuSensorSettings,
                                                            {**values, 'seed': 4}))
    one, two = (np.array([b.read(place, b.due(t))[0] for t in range(0, 10**11, 10**8)])
                for b in (barometer, other))
    assert one.std() == pytest.approx(2.0, rel=0.1) and not np.array_equal(one, two)
    assert one.mean() == pytest.approx(89874.6, abs=0.25)


def test_the_bag_of_a_run_holds_them_where_they_are_asked_for(tmp_path, monkeypatch):
    """
    The bag of a run contains both sensors at their own rates, with their variances.

    A perfect sensor reports a small variance.
    """
    monkeypatch.setattr(environment, 'magnetic_field', lambda year: east)
    path = tmp_path / 'bag'
    assert main(['simulate', '--params-file', 'racetrack', '--no-twin', '-p', 'duration_s:=100.0',
                 '-p', 'magnetometer.publish:=true', '-p', 'magnetometer.rate_hz:=40.0', '-p',
                 'barometer.publish:=true', '-p', 'barometer.rate_hz:=5.0', '-p',
                 'barometer.noise_pa:=0.0', '-p', 'imu_data:=true', '-o', str(tmp_path / 'run'),
                 '--bag', str(path)]) == 0
    with open_bag(path) as bag:
        field, air = (bag.arrays(topic.name) for topic in (topics.IMU_MAG, topics.IMU_PRESSURE))
        data, raw = (bag.arrays(topic.name) for topic in (topics.IMU_DATA, topics.IMU_RAW))
        odometry = bag.arrays('ins/odometry')
    # The truth has 10 ms; the first sample in each 25 ms is used.
    assert (field['stamp_ns'][:5] - 10**9 * EPOCH_S).tolist() == [
        0, 30_000_000, 50_000_000, 80_000_000, 100_000_000]
    assert len(field) == 4001 and len(air) == 501
    assert np.linalg.norm(field['magnetic_field'], axis=1) == pytest.approx(5e-5, rel=0.02)
    assert field['magnetic_field_covariance'] == pytest.approx(
        np.tile(np.diag([1e-14] * 3).ravel(), (4001, 1)), rel=1e-12)
    assert (air['variance'] == 1e-4).all() and np.ptp(air['fluid_pressure']) < 1e-3
    # The IMU message with the orientation of the INS, and its covariance.
    for name in ('angular_velocity', 'linear_acceleration', 'linear_acceleration_covariance'):
        assert np.array_equal(data[name], raw[name])
    assert np.array_equal(data['orientation'], odometry['orientation'])
    assert np.array_equal(data['orientation_covariance'].reshape(-1, 3, 3),
                          odometry['pose_covariance'].reshape(-1, 6, 6)[:, 3:, 3:])


def test_live_nodes_send_the_bytes_of_the_bag(ros_domain, tmp_path, monkeypatch):
    """Live nodes and the offline bag have identical messages for the same seed and motion."""
    pytest.importorskip('rclpy')
    from support.hostile.flight import HostileFlight, NODES
    monkeypatch.setattr(environment, 'magnetic_field', lambda year: east)
    asked = {'magnetometer.publish': True, 'barometer.publish': True, 'barometer.rate_hz': 30.0,
             'seed': 9}
    heard = {'imu/mag': [], 'imu/pressure': []}
    with HostileFlight(1, {'imu_sensor': {**NODES['imu_sensor'], **asked}}) as flight:
        flight.fed.bus.listen = lambda name, data: name in heard and heard[name].append(data)
        flight.good(101)
    path = tmp_path / 'bag'
    words = [word for key, value in asked.items()
             for word in ('-p', f'imu_sensor:{key}:={str(value).lower()}')]
    assert main(['simulate', '-p', 'motion.kind:=racetrack', '--no-twin', '-p', 'duration_s:=1.0',
                 '-p', 'time.epoch:=fixed', '-p', 'time.epoch_s:=0', '-o',
                 str(tmp_path / 'run'), '--bag', str(path), *words]) == 0
    with open_bag(path) as bag:
        for name, messages in heard.items():
            assert [bytes(data) for _, _, data in bag.messages([name])] == messages
    assert (len(heard['imu/mag']), len(heard['imu/pressure'])) == (51, 31)
