"""The bag of a live lock-step run equals that written by ``simulate --bag``."""

from ins_sim.bags.bag_reader import open_bag
from ins_sim.cli.main import main
from ins_sim.settings.presets import preset
from ins_sim.messages import topics
from ins_sim.messages.run_announcement import read_announcement
from support.live import Chain
import numpy as np
import pytest

pytest.importorskip('rclpy')
pytestmark = pytest.mark.live

IDEAL = {'time.epoch': 'fixed', 'time.epoch_s': 1735689600, 'rate_hz': 100.0,
         'duration_s': 30.0, 'gyro.delay_us.y': 1.0, 'publish_clock': True}
FOG = {**IDEAL, **{key: list(value) if isinstance(value, tuple) else value
                   for key, value in preset('tactical_fog').items()}, 'seed': 7}
# The live strapdown starts from, and is compared with, a truth that passed through the Cartesian
# coordinates of a message. One ulp of the radius of the Earth is 1e-9 m, and a position is a sum
# of a few such terms. An angle rounds at 1e-15 rad, which in 30 s of gravity is 1e-13 m/s; the
# first slope of an angle rounds at 1e-15 rad over one step. One ulp of a longitude in degrees is
# 7e-15.
ROUNDING = {
    ('ins/odometry', 'position'): 8e-9, ('ins/odometry', 'orientation'): 1e-14,
    ('ins/odometry', 'linear'): 1e-11, ('ins/odometry', 'angular'): 1e-14,
    ('ins/fix', 'latitude'): 1e-13, ('ins/fix', 'longitude'): 1e-13, ('ins/fix', 'altitude'): 8e-9,
    'ins/error/position': 8e-9, 'ins/error/velocity': 1e-11, 'ins/error/attitude': 1e-14,
    'ins/error/drift': 1e-14 / 0.01}
RELATIVE = 1e-12


@pytest.mark.parametrize('values', [IDEAL, FOG], ids=['ideal', 'fog'])
def test_live_is_offline_message_for_message(values, ros_domain, tmp_path):
    """Topics and stamps are equal; values agree to 1e-12 of their scale and the rounding above."""
    wanted = [topic.name for topic in (*topics.DATA, topics.CLOCK_TOPIC)]
    words = [f'{name}:={str(value).lower() if isinstance(value, bool) else value}'
             for name, value in {**values, 'source': 'stream'}.items()]
    assert main(['simulate', '--no-twin', '-o', str(tmp_path / 'run'), '--bag',
                 str(tmp_path / 'offline'), *(w for word in words for w in ('-p', word))]) == 0
    chain = Chain(ros_domain, tmp_path)
    try:
        recorder = chain.start_verb('record', *wanted, topics.RUN.name, '-o', tmp_path / 'live')
        parameters = {name: str(value).lower() if isinstance(value, bool) else value
                      for name, value in values.items()}
        generator = [chain.start(node, {**parameters, 'pacing.real_time_factor': 0.0,
                                        'pacing.required': '[strapdown, recorder]'})
                     for node in ('strapdown', 'imu_sensor', 'motion_generator')][-1]
        assert generator.wait(120.0) == 0, chain.text(generator)
        assert set(chain.end().values()) == {0}, chain.text(recorder)
    finally:
        chain.end()
    with open_bag(tmp_path / 'live') as live, open_bag(tmp_path / 'offline') as offline:
        assert set(live.topics) == set(offline.topics) == {
            '/' + n.lstrip('/') for n in (*wanted, topics.RUN.name)}
        runs = [read_announcement(bytes(data)) for bag in (live, offline)
                for _, _, data in bag.messages([topics.RUN.name])]
        assert len(runs) == 2 and runs[0] == runs[1] and runs[0].epoch_ns == 1735689600 * 10**9
        got, expected = (bag.tables(dict.fromkeys(wanted)) for bag in (live, offline))
        for name in wanted:
            assert live.topics['/' + name.lstrip('/')].type_name == \
                offline.topics['/' + name.lstrip('/')].type_name
            if name != '/clock':
                assert live.frames(name) == offline.frames(name)
    for name in wanted:
        a, b = got[name], expected[name]
        assert np.array_equal(a['log_ns'], b['log_ns'])
        assert np.array_equal(a['stamp_ns'], b['stamp_ns'])
        for field in a.dtype.names[2:]:
            difference, scale = np.abs(a[field] - b[field]).max(), np.abs(b[field]).max()
            rounding = ROUNDING.get((name, field), ROUNDING.get(name, 0.0))
            print(f'{name} {field}: {difference:.1e} of {scale:.1e}')
            assert difference <= RELATIVE * scale + rounding
