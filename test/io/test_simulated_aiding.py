"""The bag of simulate --aided has the topics of all six nodes, as the nodes publish them."""

import re

from support.aided.runs import command, flown, settings
from ins_sim.io import simulated
from ins_sim.bags.bag_reader import open_bag
from ins_sim.bags.bag_writer import BagWriter
from ins_sim.cli.main import main
from ins_sim.core.aiding.navigator import GNSS, METER
from ins_sim.core.aiding.live import AidedStream
from ins_sim.core.aiding.reading_noise import rate_variance
from ins_sim.core.earth.frames import MapFrame
from ins_sim.core.earth.great_circle import GreatCircleRoute
from ins_sim.messages import convert, topics, velocity_record
from ins_sim.messages.cdr import ENCAPSULATION
from ins_sim.messages.gnss_fixes import GnssPairs
import numpy as np
import pytest

EPOCH_S = 1000
EPOCH_NS = EPOCH_S * 10**9
LENGTH = ('duration_s:=60.0', 'outages.start_s:=[40.0]', 'outages.end_s:=[50.0]',
          f'time.epoch_s:={EPOCH_S}')
NAMES = ['/' + topic.name for topic in (topics.RUN, *topics.DATA, *topics.AIDING)]


@pytest.fixture(scope='module')
def run():
    """Return AidedSimulationSettings, Run and AidedResult of a flight."""
    chosen = settings(*LENGTH)
    return chosen, *flown(chosen)[1:]


@pytest.fixture(scope='module', params=['mcap', 'sqlite3'])
def bag_path(request, run, tmp_path_factory):
    """Return the bag of the flight."""
    chosen, free, solution = run
    path = tmp_path_factory.mktemp('aided') / 'bag'
    simulated.write_bag(path, chosen.simulation, free,
                        simulated.select_topics(chosen.simulation, None, True),
                        request.param, aided=(chosen, solution))
    return path


def messages(bag, topic):
    """Return (log times, bytes) of a topic, as lists."""
    found = [(t_ns, bytes(data)) for _, t_ns, data in bag.messages([topic.name])]
    return [t for t, _ in found], [data for _, data in found]


def test_the_messages_of_the_navigator_are_those_of_the_node(run, bag_path):
    """Messages of the navigator in the bag equal to the bit those packed by the node."""
    chosen, free, solution = run
    navigator = chosen.aided_navigator
    frame, route = MapFrame(navigator.datum, navigator.earth.rotation), GreatCircleRoute.of_points(
        navigator.motion.route.points)
    rates = dict(zip(free.imu.t_ns.tolist(), free.imu.omega.tolist()))
    states, errors = solution.states, solution.errors
    expected = {topic: [] for topic in topics.AIDING[4:]}
    pack = {topic: topic.writer().pack for topic in expected}
    leg = 0
    for k, t_ns in enumerate(states.t_ns.tolist()):
        place = (float(states.lat[k]), float(states.lon[k]), float(states.height[k]),
                 tuple(states.v_n[k].tolist()), tuple(states.q_nb[k].tolist()))
        sigmas = (errors.position_sigma[k].tolist(), errors.velocity_sigma[k].tolist(),
                  errors.attitude_sigma[k].tolist())
        leg = route.leg_at(*place[:2], leg)
        x, z = route.to_xz(*place[:2], leg)
        runs = [convert.aided_odometry_one(frame, place, rates[t_ns], sigmas,
                                           rate_variance(navigator)),
                convert.aided_fix_one(place, sigmas),
                *((getattr(errors, kind)[k].tolist(),) for kind in (
                    'attitude', 'velocity', 'position')),
                *(([3.0 * s for s in sigma],) for sigma in sigmas[::-1]), ((x, place[2], z),)]
        for topic, values in zip(expected, runs):
            expected[topic].append(pack[topic](t_ns + EPOCH_NS, *values))
    with open_bag(bag_path) as bag:
        for topic, packed in expected.items():
            stamps, found = messages(bag, topic)
            assert stamps == (states.t_ns + EPOCH_NS).tolist()
            assert found == packed, topic.name


def test_the_fixes_come_back(run, bag_path):
    """The fixes read from record and messages equal the original ones; stamps are mid-window."""
    chosen, _, solution = run
    with open_bag(bag_path) as bag:
        stamps, records = messages(bag, topics.METER_RECORD)
        assert stamps == [fix.end_ns + EPOCH_NS for fix in solution.velocity_fixes]
        assert tuple(velocity_record.read_fix(data, EPOCH_NS) for data in records) == \
            solution.velocity_fixes
        stamps, shown = messages(bag, topics.METER_VELOCITY)
        assert stamps == [(fix.start_ns + fix.end_ns) // 2 + EPOCH_NS
                          for fix in solution.velocity_fixes if fix.valid]
        pack = topics.METER_VELOCITY.writer().pack
        assert shown == [pack(t + EPOCH_NS, *runs) for t, *runs in map(
            velocity_record.velocity_one, solution.velocity_fixes)]
        pairs, found = GnssPairs(EPOCH_NS, 0), []
        for name, _, data in bag.messages([topics.GNSS_FIX.name, topics.GNSS_VELOCITY.name]):
            push = pairs.push_fix if name == '/gnss/fix' else pairs.push_velocity
            found += push(bytes(data))
    assert len(found) == len(solution.gnss_fixes) == 61
    assert sum(not fix.valid for fix in found) == 10
    for fix, own in zip(found, solution.gnss_fixes):
        assert fix.t_ns == own.t_ns and fix.status == own.status
        if own.valid:
            # Conversion to degrees and variances and back: a few roundings.
            assert fix.v_n == own.v_n
            for field in ('lat', 'lon', 'position_sigma', 'velocity_sigma'):
                assert getattr(fix, field) == pytest.approx(getattr(own, field), rel=1e-15)


def test_the_stream_of_the_bag_gives_the_solution_of_the_run(run, bag_path, capsys):
    """
    A live navigator computes the solution in the bag from the messages in the bag.

    Only the truth, which starts the solution and is its altimeter, passes through the map frame:
    1e-8 m there, and its effect on the filter.
    """
    chosen, _, solution = run
    stream, pairs = AidedStream(chosen.aided_navigator), GnssPairs(EPOCH_NS, 0)
    imu = topics.IMU_RAW.reader()
    truth = topics.TRUTH_ODOMETRY.reader(((0, 3), (3, 7), (43, 46)))
    outputs = []

    def push_fixes(source, fixes):
        for fix in fixes:
            outputs.extend(stream.push_fix(source, fix))

    with open_bag(bag_path) as bag:
        for name, _, data in bag.messages():
            if name == '/imu/data_raw':
                t_ns, *sample = imu.read(data)
                outputs += stream.push_imu(t_ns - EPOCH_NS, *sample)
            elif name == '/truth/odometry':
                t_ns, *sample = truth.read(data)
                outputs += stream.push_truth(t_ns - EPOCH_NS, *sample)
            elif name == '/velocity_meter/record':
                push_fixes(METER, [velocity_record.read_fix(bytes(data), EPOCH_NS)])
            elif name == '/gnss/fix':
                push_fixes(GNSS, pairs.push_fix(bytes(data)))
            elif name == '/gnss/velocity':
                push_fixes(GNSS, pairs.push_velocity(bytes(data)))
    assert [t for t, *_ in outputs] == solution.states.t_ns.tolist()
    assert [(t.source, t.t_ns, t.outcome.taken) for t in stream.judged] == [
        (t.source, t.t_ns, t.outcome.taken) for t in solution.judged]
    position = np.array([errors[2] for _, _, errors, _ in outputs])
    off = np.abs(position - solution.errors.position).max()
    sigma = np.array([sigmas[0] for *_, sigmas in outputs])
    off_sigma = np.abs(sigma - solution.errors.position_sigma).max()
    assert off < 1e-6 and off_sigma < 1e-6
    with capsys.disabled():
        print(f'\nthe messages of the bag through AidedStream, {len(outputs)} outputs: position '
              f'{off:.2g} m, its sigma {off_sigma:.2g} m off the offline run')


def test_topics_order_and_every_reader(run, bag_path, capsys):
    """All topics are in the order of stamps, and rosbags decodes each of them."""
    pytest.importorskip('rosbags')
    from rosbags.highlevel import AnyReader
    with open_bag(bag_path) as bag:
        assert list(bag.topics) == NAMES and not bag.cut
        ours = [(name, t_ns, bytes(data)) for name, t_ns, data in bag.messages()]
    times = [t_ns for _, t_ns, _ in ours]
    assert times == sorted(times)
    # A window ends there, and a fix is due.
    at = [name for name, t_ns, _ in ours if t_ns == EPOCH_NS + 10 * 10**9]
    assert at == [name for name in NAMES[1:] if name != '/velocity_meter/velocity']
    with AnyReader([bag_path]) as reader:
        seen = {}
        for connection, t_ns, data in reader.messages():
            message = reader.deserialize(data, connection.msgtype)
            header = message.header
            assert header.stamp.sec * 10**9 + header.stamp.nanosec == t_ns
            seen.setdefault(connection.topic, []).append(message)
    assert sum(map(len, seen.values())) == len(ours)
    record = seen['/velocity_meter/record'][-1].status[0]
    assert record.name == 'velocity_meter' and record.message == 'valid'
    assert [m.status.status for m in seen['/gnss/fix']] == [0] * 40 + [-1] * 10 + [0] * 11
    assert seen['/aided/fix'][-1].position_covariance_type == 2
    assert seen['/aided/sigma/position'][-1].vector.x == \
        3.0 * run[2].errors.position_sigma[-1, 0]
    assert main(['info', str(bag_path)]) == 0
    shown = capsys.readouterr().out
    assert re.search(r'/velocity_meter/record +diagnostic_msgs/msg/DiagnosticArray +60 +1\n',
                     shown)
    assert re.search(r'/gnss/velocity +geometry_msgs/msg/TwistWithCovarianceStamped +51 ', shown)
    assert re.search(r'/aided/odometry +nav_msgs/msg/Odometry +6001 +100\n', shown)


def test_the_command_writes_the_bag(tmp_path, capsys):
    """
    The command writes all topics or some, /clock, and an output every 10th step.

    Equal seeds give equal bytes.
    """
    flight = ('duration_s:=12.0', 'output_every:=10', 'publish_clock:=true', 'window.cycles:=500')
    bags = [tmp_path / name for name in 'ab']
    for bag in bags:
        assert command(tmp_path / f'{bag.name}_of', '--bag', str(bag), flight=flight) == 0
    sums = re.findall(r'SHA-256 of the messages: (\w+)', capsys.readouterr().out)
    assert len(sums) == 2 and sums[0] == sums[1]
    with open_bag(bags[0]) as bag:
        assert list(bag.topics) == [NAMES[0], '/clock', *NAMES[1:]]
        counts = {name: span.count for name, span in bag.spans().items()}
    assert [counts[name] for name in ('/truth/imu', '/ins/fix', '/aided/fix', '/gnss/fix',
                                      '/velocity_meter/record')] == [1201, 121, 121, 13, 2]
    chosen = tmp_path / 'chosen'
    assert command(tmp_path / 'c', '--bag', str(chosen), '--topics', 'aided/fix', 'gnss/fix',
                   'velocity_meter/record', flight=flight) == 0
    with open_bag(chosen) as bag:
        assert list(bag.topics) == ['/velocity_meter/record', '/gnss/fix', '/aided/fix']


def test_a_filter_without_covariance_publishes_no_sigma(tmp_path):
    """A filter without covariance publishes nothing on aided/sigma/*; covariances are unknown."""
    path = tmp_path / 'bag'
    assert command(tmp_path, '--bag', str(path),
                   flight=('duration_s:=5.0', 'filter:=conventional')) == 0
    with open_bag(path) as bag:
        spans = bag.spans()
        assert [spans['/' + topic.name].count for topic in topics.AIDED_SIGMAS] == [0, 0, 0]
        fixes = bag.arrays('aided/fix')
        unknown = bag.arrays('aided/odometry')['pose_covariance']
        assert np.array_equal(unknown, np.tile(1e9 * np.eye(6).ravel(), (501, 1)))
    assert len(fixes) == 501 and not fixes['position_covariance_type'].any()


def test_what_is_refused(tmp_path, capsys):
    """Topics of the three aiding nodes are refused without --aided."""
    assert main(['simulate', '-p', 'duration_s:=5.0', '-o', str(tmp_path / 'run'), '--bag',
                 str(tmp_path / 'bag'), '--topics', 'aided/fix']) == 2
    said = capsys.readouterr().err
    assert "publishes the topic 'aided/fix'" in said and said.count('\n') == 1
    assert list(tmp_path.iterdir()) == []


def test_an_interrupted_bag_is_not_there(tmp_path, monkeypatch):
    """Ctrl-C while fixes are packed leaves no bag; exit code 130."""
    def interrupt(*arguments):
        raise KeyboardInterrupt

    monkeypatch.setattr(convert, 'aided_odometry_one', interrupt)
    assert command(tmp_path, '--bag', str(tmp_path / 'bag'), flight=('duration_s:=5.0',)) == 130
    assert [path.name for path in tmp_path.iterdir()] == ['run']


@pytest.mark.parametrize('storage, compression', [('mcap', 'none'), ('mcap', 'zstd'),
                                                  ('sqlite3', 'none')])
def test_blocks_of_messages_of_any_length(storage, compression, tmp_path):
    """Blocks of messages of any length, unsorted or empty, are written by log time."""
    rng = np.random.default_rng(1)
    texts = np.empty(300, dtype=object)
    texts[:] = [ENCAPSULATION + rng.bytes(int(n)) for n in rng.integers(1, 3000, 300)]
    times = rng.permutation(300) * 10
    fixed = topics.GNSS_VELOCITY.writer().block(np.arange(300) * 10, rng.normal(size=(300, 6)))
    with BagWriter(tmp_path / 'bag', storage, compression) as bag:
        bag.add_topic('a', topics.DIAGNOSTICS)
        bag.add_topic('b', topics.TWIST)
        for first in range(0, 300, 100):
            rows = slice(first, first + 100)
            bag.write_blocks({'b': (np.arange(300)[rows] * 10, fixed[rows]),
                              'a': (times[rows], texts[rows])})
        bag.write_blocks({'a': (times[:0], texts[:0])})
    with open_bag(tmp_path / 'bag') as bag:
        assert messages(bag, topics.Topic('a', topics.DIAGNOSTICS)) == (
            sorted(times.tolist()), texts[np.argsort(times)].tolist())
        assert messages(bag, topics.Topic('b', topics.TWIST))[1] == [m.tobytes() for m in fixed]
