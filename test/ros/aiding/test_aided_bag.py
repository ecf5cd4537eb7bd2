"""The recorded bag of six live nodes in lock-step equals that of ``simulate --aided --bag``."""

from support.aided.runs import command
from ins_sim.bags.bag_reader import open_bag
from ins_sim.messages import topics, velocity_record
from support.live import Chain
import numpy as np
import pytest

pytest.importorskip('rclpy')
pytestmark = pytest.mark.live

NODES = ('strapdown', 'velocity_meter', 'gnss', 'aided_navigator')
FLIGHT = ('duration_s:=20.0', 'time.epoch:=fixed', 'time.epoch_s:=0',
          'gnss_model.use:=true', 'window.cycles:=200',
          'outages.start_s:=[12.0]', 'outages.end_s:=[16.0]', 'pacing.real_time_factor:=0.0',
          f'pacing.required:=[{", ".join(NODES)}, recorder]')
FRAMED = [topic for topic in topics.AIDING if topic is not topics.METER_RECORD]
# One ulp of the radius of the Earth is 1e-9 m, and a position is a sum of a few such terms; the
# effect of the rounding of the truth in a message over 20 s is far smaller.
ROUNDING = {'position': 1e-8, 'altitude': 1e-8, 'vector': 1e-8, 'latitude': 1e-13,
            'longitude': 1e-13}
RELATIVE = 1e-11


def test_live_is_offline_message_for_message(ros_domain, tmp_path, capsys):
    """Stamps agree on every topic, values to rounding; parameters are those of the offline run."""
    assert command(tmp_path, '--bag', str(tmp_path / 'offline'), flight=FLIGHT) == 0
    names = [topic.name for topic in (topics.INS_ODOMETRY, *topics.AIDING)]
    file = str(tmp_path / 'run' / 'parameters.yaml')
    chain = Chain(ros_domain, tmp_path)
    try:
        recorder = chain.start_verb('record', *names, '-o', tmp_path / 'live')
        generator = [chain.start(node, arguments=('--params-file', file))
                     for node in (*NODES, 'imu_sensor', 'motion_generator')][-1]
        assert generator.wait(180.0) == 0, chain.text(generator)
        assert set(chain.end().values()) == {0}, chain.text(recorder)
    finally:
        chain.end()
    largest = {}
    with open_bag(tmp_path / 'live') as live, open_bag(tmp_path / 'offline') as offline:
        records = [[velocity_record.read_fix(bytes(data), 0) for _, _, data in bag.messages(
            [topics.METER_RECORD.name])] for bag in (live, offline)]
        for topic in FRAMED:
            a, b = (bag.arrays(topic.name) for bag in (live, offline))
            assert live.frames(topic.name) == offline.frames(topic.name) == [topic.frames]
            assert a['stamp_ns'].tolist() == b['stamp_ns'].tolist(), topic.name
            for field in a.dtype.names[2:]:
                x, y = (np.nan_to_num(t[field].astype(float)) for t in (a, b))
                difference, scale = np.abs(x - y).max(), np.abs(y).max()
                largest[topic.name, field] = difference
                assert difference <= RELATIVE * scale + ROUNDING.get(field, 0.0), (
                    topic.name, field, difference, scale)
    assert len(records[0]) == len(records[1]) == 10
    for a, b in zip(*records):
        assert (a.start_ns, a.end_ns, a.cycles, a.status, a.arrival_ns) == (
            b.start_ns, b.end_ns, b.cycles, b.status, b.arrival_ns)
        assert np.allclose((*a.velocity, *a.sigma, a.tan_alpha),
                           (*b.velocity, *b.sigma, b.tan_alpha), rtol=RELATIVE, atol=1e-12)
    with capsys.disabled():
        print('\nlive less offline, 20 s with GNSS and its outage: ' + ', '.join(
            f'{name} {largest[name, field]:.1e}' for name, field in (
                ('aided/odometry', 'position'), ('aided/odometry', 'linear'),
                ('aided/error/attitude', 'vector'), ('aided/sigma/position', 'vector'),
                ('gnss/fix', 'latitude'), ('velocity_meter/velocity', 'linear'))))
