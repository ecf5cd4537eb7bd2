"""A bag of a real or synthetic IMU played live into strapdown gives the numbers of navigate."""

import numpy as np
import pytest
from support.live import GUARD_S, Listener
from support.nodes.live_imu import LIVE, OFFLINE, read, vehicle
from support.nodes.real_imu import FIX, IMU, messages_of

import ins_sim
from ins_sim.bags.bag_writer import BagWriter
from ins_sim.core.earth.frames import MapFrame
from ins_sim.messages import topics
from ins_sim.messages.cdr import stamp_of
from ins_sim.messages.convert import fix_one, odometry_one
from ins_sim.settings.place import Datum

pytest.importorskip('rclpy')
pytestmark = pytest.mark.live


def played(chain, domain, bag, last_ns, parameters):
    """Play a bag in lock-step into strapdown; return {topic: {stamp_ns: doubles}}."""
    listener = Listener(domain, (topics.INS_ODOMETRY, topics.INS_FIX))
    node = chain.start('strapdown', {**LIVE, **parameters})
    # Playing takes less than a second: messages before discovery would be lost.
    listener.poll_until(lambda: all(map(listener.node.count_publishers, listener.heard)))
    player = chain.start_verb('play', bag, '--lock-step', 'strapdown', '--topics',
                              parameters.get('inputs.imu', '/' + IMU),
                              parameters.get('inputs.fix', '/' + FIX))
    heard = listener.heard
    listener.poll_until(lambda: last_ns in heard[topics.INS_ODOMETRY.name] or node.poll()
                        is not None or player.poll() is not None, 4.0 * GUARD_S)
    listener.poll_until(lambda: last_ns in heard[topics.INS_ODOMETRY.name] or node.poll()
                        is not None or player.poll(), 0.25 * GUARD_S)
    assert last_ns in heard[topics.INS_ODOMETRY.name], (
        chain.text(player) + chain.text(node))
    listener.poll_for(0.5)
    listener.close()
    assert set(chain.end().values()) == {0}
    assert 'Traceback' not in chain.text(node)
    return heard


def within(heard, segment, datum):
    """Assert that messages agree with the solution within 1e-9 m, m/s, rad."""
    frame = MapFrame(Datum(*datum), True)
    odometry, fix = heard[topics.INS_ODOMETRY.name], heard[topics.INS_FIX.name]
    assert [*odometry] == segment.t_ns.tolist() == [*fix]
    for k, t_ns in enumerate(segment.t_ns.tolist()):
        state = segment.one(k)
        pose, twist = odometry_one(frame, state, (0.0, 0.0, 0.0))
        assert np.abs(np.subtract(odometry[t_ns][:7], pose)).max() < 1e-9
        assert np.abs(np.subtract(odometry[t_ns][43:46], twist[:3])).max() < 1e-9
        assert fix[t_ns][:3] == fix_one(state)


def parameters_of(datum):
    """Return the parameters of a datum."""
    return dict(zip(('datum.latitude_deg', 'datum.longitude_deg', 'datum.height_m'), datum))


def test_a_made_bag(chain, ros_domain, tmp_path):
    """
    A synthetic car that rests and then drives, as imu/data_raw and gnss/fix, is navigated.

    The numbers are those of navigate within 1e-9.
    """
    imu, fixes = vehicle(rest_s=8.0, length_s=25.0, rate_hz=50.0)
    bag, datum = tmp_path / 'bag', (49.9, 5.7, 90.0)
    with BagWriter(bag) as writer:
        writer.add_topic(IMU, topics.IMU)
        writer.add_topic(FIX, topics.FIX)
        for name, data in messages_of(imu, fixes):
            writer.write('/' + name, stamp_of(data), data)
    result = ins_sim.navigate(bag, OFFLINE)
    heard = played(chain, ros_domain, bag, int(imu.t_ns[-1]), parameters_of(datum))
    within(heard, result.segments[0], datum)


@pytest.mark.slow
@pytest.mark.parametrize('name, imu, fix, datum, values', [
    ('husky_test1_mcap', '/imu/data', '/fix', (42.3768, -71.1472, -26.0),
     {'mounting.rpy_deg': [90.0, 0.0, -90.0]}),
    ('umn_thor_fl75_first90s_sqlite3', '/imu/data', '/gps/fix', (45.3, -93.2, 250.0), {})])
def test_the_recorded_bags(name, imu, fix, datum, values, shared_data, chain, ros_domain):
    """Bags of two real robots give the numbers of navigate over DDS within 1e-9."""
    bag = shared_data / 'rosbags' / name
    result = ins_sim.navigate(bag, {**OFFLINE, **values})
    record, _ = read(bag, imu, fix)
    heard = played(chain, ros_domain, bag, int(record.t_ns[-1]), {
        **parameters_of(datum), **values, 'inputs.imu': imu, 'inputs.fix': fix})
    within(heard, result.segments[0], datum)
