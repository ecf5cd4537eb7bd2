"""The verbs for bags: simulate --bag and info."""

import re

from ins_sim import parameter_files, resources
from ins_sim.bags.bag_reader import open_bag
from ins_sim.io.published import read_errors
from ins_sim.io.simulated_topics.covariance import CovarianceSource
from ins_sim.cli.main import main
from ins_sim.core.numerics.instants import period_ns
from ins_sim.core.earth.frames import MapFrame
from ins_sim.core.motion.factory import make_motion
from ins_sim.messages import convert, topics
import numpy as np
import pytest
from support.studies import LATE_MOTION_2, LATE_MOTION_2_WORDS, run_offline

NAMES = {'/' + topic.name for topic in (topics.RUN, *topics.DATA)}
EPOCH_NS = 1735689600 * 10**9
MOTION = [*LATE_MOTION_2_WORDS, '--no-twin', '-p', 'duration_s:=5.0']


def bag_of(tmp_path, *arguments, name='bag', motion=MOTION):
    """Simulate into a bag; return its path."""
    path = tmp_path / name
    assert main(['simulate', *motion, '-o', str(tmp_path / f'{name}_run'), '--bag', str(path),
                 *arguments]) == 0
    return path


@pytest.mark.parametrize('storage', ['mcap', 'sqlite3'])
def test_the_bag_of_a_run_is_the_run(storage, tmp_path, capsys):
    """The bag of a run has every topic at its stamps, with the numbers of the offline run."""
    path = bag_of(tmp_path, '--storage', storage)
    shown = capsys.readouterr().out
    assert 'written: ' in shown and f'{1 + 11 * 501} messages on 12 topics' in shown.replace(
        '\n', ' ')
    settings = parameter_files.read([resources.config(name) for name in LATE_MOTION_2],
                                    ['duration_s:=5.0'])
    run = run_offline(settings, twin=False)
    generator = settings.motion_generator
    motion = make_motion(generator.motion, generator.datum, generator.earth)
    truth = motion.at(
        period_ns(generator.rate_hz) * np.arange(501))
    frame = MapFrame(generator.datum, generator.earth.rotation)
    expected = {**convert.truth_blocks(frame, truth), **convert.imu_block(run.imu),
                **convert.state_blocks(frame, run.states, run.imu, CovarianceSource(
                    settings, run, motion).at(run.states.t_ns)),
                **convert.error_blocks(run.errors)}
    with open_bag(path) as bag:
        assert set(bag.topics) == NAMES and not bag.cut
        for topic, values in expected.items():
            if topic is topics.IMU_DATA:
                # This topic was not requested.
                continue
            # A perfect IMU does not publish this topic.
            writer = (topics.imu_raw((0.0,) * 3, (0.0,) * 3) if topic is topics.IMU_RAW
                      else topic).writer()
            messages = list(bag.messages([topic.name]))
            assert [t for _, t, _ in messages] == (truth.t_ns + EPOCH_NS).tolist()
            assert [d for _, _, d in messages] == writer.pack_block(
                truth.t_ns + EPOCH_NS, values)
        order = [name for name, t_ns, _ in bag.messages() if t_ns == EPOCH_NS + 10**7]
        assert order == ['/' + topic.name for topic in topics.DATA]
    errors = read_errors(path)
    assert np.array_equal(errors.position, run.errors.position)
    assert np.array_equal(errors.drift, run.errors.drift)


@pytest.mark.parametrize('options', [(), ('--compression', 'zstd'), ('--storage', 'sqlite3')])
def test_the_same_seed_gives_the_same_bytes(options, tmp_path, capsys):
    """The printed digests are those of the files, and are equal for equal seeds only."""
    motion = [*MOTION, '--params-file', 'imu_tactical_fog']
    sums = []
    for name, seed in (('a', 1), ('b', 1), ('c', 2)):
        path = bag_of(tmp_path / name, *options, '-p', f'seed:={seed}', motion=motion)
        sums.append(re.findall(r'SHA-256 of .*: ([0-9a-f]{64})', capsys.readouterr().out))
        assert len(sums[-1]) == 2
    assert sums[0] == sums[1] and not set(sums[0]) & set(sums[2])
    # Bag files contain their name: in a folder with another name only the messages are equal.
    bag_of(tmp_path, *options, '-p', 'seed:=1', name='other', motion=motion)
    said = capsys.readouterr().out
    assert re.search(r'SHA-256 of other_0\.\w+, which contains this file name: ', said)
    other = re.findall(r'SHA-256 of .*: ([0-9a-f]{64})', said)
    assert other[0] != sums[0][0] and other[1] == sums[0][1]
    with open_bag(path) as bag:
        # The message contains the noise of the instrument.
        imu = bag.arrays('imu/data_raw')
    assert (imu['angular_velocity_covariance'][:, [0, 4, 8]] > 0).all()
    assert (imu['orientation_covariance'][:, 0] == -1).all()


def test_topics_rates_and_epochs(tmp_path, capsys):
    """Topics, /clock, rates of outputs and the epoch of stamps are those of the options."""
    motion = [*MOTION, '-p', 'output_every:=10', '-p', 'time.epoch_s:=1000', '-p',
              'publish_clock:=true', '-p', 'initial.after_s:=1.0']
    path = bag_of(tmp_path, '--topics', 'truth/imu', '/ins/odometry', 'clock', motion=motion)
    with open_bag(path) as bag:
        assert list(bag.topics) == ['/clock', '/truth/imu', '/ins/odometry']
        spans = bag.spans()
        assert [s.count for s in spans.values()] == [501, 501, 41]
        assert spans['/truth/imu'].first_ns == 1000 * 10**9
        assert spans['/ins/odometry'].first_ns >= 1001 * 10**9
        odometry = bag.arrays('ins/odometry', ('angular',))
        assert np.abs(odometry['angular']).max() > 0.01
    capsys.readouterr()
    assert main(['info', str(path)]) == 0
    shown = capsys.readouterr().out
    for words in ('state     whole', 'storage   mcap, not compressed', 'messages  1043',
                  'start     1000.000000000 s', 'duration  5.000000000 s'):
        assert words in shown
    assert re.search(r'/truth/imu +sensor_msgs/msg/Imu +501 +100\n', shown)
    assert re.search(r'/ins/odometry +nav_msgs/msg/Odometry +41 +10\n', shown)


@pytest.mark.parametrize('arguments, sentence', [
    (['--topics', 'ins/errors'], "publishes the topic 'ins/errors'; the nearest is 'ins/error/"),
    (['--topics', 'clock'], "publishes the topic 'clock'"),
    (['--storage', 'sqlite3', '--compression', 'lz4'], 'sqlite3 cannot be compressed by lz4'),
    (['-p', 'time.epoch_s:=2147483647'], 'which a ROS stamp can hold')])
def test_what_is_refused_before_the_run(arguments, sentence, tmp_path, capsys):
    """Invalid options of a bag give one message and exit code 2 before the run, and no bag."""
    assert main(['simulate', *MOTION, '-o', str(tmp_path / 'run'), '--bag', str(tmp_path / 'bag'),
                 *arguments]) == 2
    said = capsys.readouterr().err
    assert sentence in said and said.count('\n') == 1
    assert not (tmp_path / 'bag').exists()


def test_options_of_a_bag_need_a_bag(tmp_path, capsys):
    """Options of a bag without --bag are refused, because they would have no effect."""
    for option in (['--storage', 'sqlite3'], ['--compression', 'lz4'], ['--topics', 'ins/fix']):
        assert main(['simulate', *MOTION, '-o', str(tmp_path / 'run'), *option]) == 2
        assert 'is given without --bag' in capsys.readouterr().err
    assert not (tmp_path / 'run').exists()


def test_a_bag_is_replaced_with_force_alone(tmp_path, capsys):
    """A bag is replaced with --force only, like a run."""
    path = bag_of(tmp_path)
    before = (path / 'bag_0.mcap').read_bytes()
    arguments = ['simulate', *MOTION, '-p', 'gyro.delay_us.x:=3.0', '-o',
                 str(tmp_path / 'bag_run'),
                 '--bag', str(path)]
    assert main([*arguments[:-3], str(tmp_path / 'other_run'), *arguments[-2:]]) == 2
    assert 'exists; expected a new path for the bag' in capsys.readouterr().err
    assert not (tmp_path / 'other_run').exists()
    assert (path / 'bag_0.mcap').read_bytes() == before
    assert main([*arguments, '--force']) == 0
    assert (path / 'bag_0.mcap').read_bytes() != before


def test_an_interrupted_bag_is_not_there(tmp_path, monkeypatch, capsys):
    """Ctrl-C while a bag is written leaves no bag; exit code 130."""
    from ins_sim.bags import windows

    def interrupt(*arguments):
        raise KeyboardInterrupt

    monkeypatch.setattr(windows.BagWriter, 'write_blocks', interrupt)
    assert main(['simulate', *MOTION, '-o', str(tmp_path / 'run'), '--bag',
                 str(tmp_path / 'bag')]) == 130
    assert not (tmp_path / 'bag').exists()
