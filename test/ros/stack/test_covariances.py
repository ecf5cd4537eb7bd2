"""All published covariances, live and in a bag, are positive definite; no variance is zero."""

from collections import defaultdict

from ins_sim.bags.bag_reader import open_bag
from ins_sim.io import environment
from ins_sim.messages import topics
from ins_sim.messages.cdr import Reader
import numpy as np
import pytest
from support.aided.runs import command

# For each message type: offsets of covariances among its doubles, and their size.
PLACES = {topics.IMU: ((4, 3), (16, 3), (28, 3)), topics.ODOMETRY: ((7, 6), (49, 6)),
          topics.FIX: ((3, 3),), topics.TWIST: ((6, 6),), topics.MAGNETIC: ((3, 3),),
          topics.PRESSURE: ((1, 1),)}
# Topics with covariances, of any node.
KNOWN = (topics.TRUTH_IMU, topics.TRUTH_ODOMETRY, topics.TRUTH_FIX, topics.IMU_RAW,
         topics.IMU_DATA, topics.IMU_MAG, topics.IMU_PRESSURE, topics.INS_ODOMETRY,
         topics.INS_FIX, topics.METER_VELOCITY, topics.GNSS_FIX, topics.GNSS_VELOCITY,
         topics.AIDED_ODOMETRY, topics.AIDED_FIX)
TYPES = {topic.name: topic.type_name for topic in KNOWN}
ASKED = {'magnetometer.publish': True, 'barometer.publish': True}


class Covariances:
    """The covariances of messages, by topic and place."""

    def __init__(self):
        self._readers = {name: Reader(kind) for name, kind in TYPES.items()}
        self._found = defaultdict(list)

    def add(self, name, data):
        """Add a message, if it has covariances."""
        if name not in TYPES:
            return
        reader = self._readers[name]
        doubles = reader.read(data)[1]
        if TYPES[name] == topics.FIX:
            status, _, kind = reader.numbers(data)
            if status < 0 or (kind == 0 and name == topics.AIDED_FIX.name):
                assert kind == 0
                return
            assert kind in (2, 3)
        for first, size in PLACES[TYPES[name]]:
            if doubles[first] == -1.0:
                # REP-145: the quantity is not measured.
                assert name == topics.IMU_RAW.name and first == 4
            else:
                self._found[name, first].append(
                    np.reshape(doubles[first:first + size * size], (size, size)))

    def check(self, expected, least):
        """
        Check all covariances.

        expected: topics that must have been seen; least: number of messages of each.
        """
        assert {name for name, _ in self._found} == expected
        for (name, first), matrices in self._found.items():
            assert len(matrices) >= least
            whole = np.array(matrices)
            sigmas = np.sqrt(np.diagonal(whole, axis1=1, axis2=2))
            assert (sigmas > 0.0).all() and np.isfinite(sigmas).all(), (name, first)
            whole = whole / (sigmas[:, :, None] * sigmas[:, None, :])
            turned = np.swapaxes(whole, 1, 2)
            # Products of rounded rotations are symmetric and positive within a few roundings.
            assert np.abs(whole - turned).max() < 1e-12, (name, first)
            assert np.linalg.eigvalsh(0.5 * (whole + turned)).min() > -1e-12, (name, first)


@pytest.fixture
def magnetic(monkeypatch):
    """Replace the magnetic field by one that needs no package."""
    monkeypatch.setattr(environment, 'magnetic_field', lambda year: lambda *place: (
        1e-6, 2e-5, -4e-5))


@pytest.mark.parametrize('name', ['eskf', 'conventional'])
def test_in_a_bag(name, tmp_path, magnetic):
    """
    In the bag of an aided flight covariances are positive; unknown ones are marked.

    They are unknown for a filter without a covariance.
    """
    path, found = tmp_path / 'bag', Covariances()
    gnss = [f'gnss_model.use:={str(name == "eskf").lower()}', f'filter:={name}']
    assert command(tmp_path, '--bag', str(path), flight=(
        'duration_s:=9.0', 'window.cycles:=100', 'imu_data:=true', *gnss,
        *(f'{key}:=true' for key in ASKED))) == 0
    with open_bag(path) as bag:
        for topic, _, data in bag.messages():
            found.add(topic.lstrip('/'), bytes(data))
    found.check(set(TYPES) - ({'aided/fix'} if name == 'conventional' else set()), 8)


def test_of_live_nodes(ros_domain, magnetic):
    """The covariances of all live nodes, and of the truth, are positive."""
    pytest.importorskip('rclpy')
    from support.hostile.flight import HostileFlight, NODES
    found = Covariances()
    more = {'imu_sensor': {**NODES['imu_sensor'], **ASKED},
            'strapdown': {**NODES['strapdown'], 'imu_data': True,
                          'gyro.errors.turn_on_bias_sigma_deg_h': [1.0, 1.0, 1.0]}}
    with HostileFlight(1, more) as flight:
        flight.fed.bus.listen = found.add
        flight.good(250)
        assert not flight.rescued
    for topic, data in zip(topics.TRUTH, flight._source.messages(5)):
        found.add(topic.name, data)
    found.check(set(TYPES), 1)
