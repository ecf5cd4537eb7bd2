"""Readers and linters of other packages; a test is skipped if one is not installed."""

import json
import subprocess
import sys
import time

import pytest
from .foxglove import FoxgloveClient, GUARD_S

# A bag may consist of several files in one folder.
MCAP = '*.mcap'
ERROR, WARNING = 'error', 'warning'


def need(module):
    """Return an imported module of another package; skip the test if it is not installed."""
    return pytest.importorskip(module, reason=f'{module} is not installed (PyPI)')


def mcap_messages(path):
    """
    Yield (schema, channel, message) of a bag, read by the mcap library with its checksums
    verified.
    """
    reader = need('mcap.reader')
    for file in sorted(path.glob(MCAP)):
        with open(file, 'rb') as stream:
            yield from reader.make_reader(stream, validate_crcs=True).iter_messages()


def mcap_counts(path):
    """
    Return {topic: number of messages} as read by mcap; check that the summary holds the same.
    """
    counts, reader = {}, need('mcap.reader')
    for _, channel, _ in mcap_messages(path):
        counts[channel.topic] = counts.get(channel.topic, 0) + 1
    summed = 0
    for file in path.glob(MCAP):
        with open(file, 'rb') as stream:
            summed += reader.make_reader(stream).get_summary().statistics.message_count
    assert summed == sum(counts.values())
    return counts


def evo_trajectories(path, names):
    """Return {topic: PoseTrajectory3D} of a bag read by evo, checked by evo itself."""
    file_interface = need('evo.tools.file_interface')
    from rosbags.rosbag2 import Reader
    with Reader(path) as reader:
        found = {name: file_interface.read_bag_trajectory(reader, name) for name in names}
    for name, trajectory in found.items():
        valid, details = trajectory.check()
        assert valid, (name, details)
    return found


def evo_position_rms(reference, estimate):
    """
    Return the rms of the absolute position error of a trajectory computed by evo, m, unaligned.
    """
    metrics, sync = need('evo.core.metrics'), need('evo.core.sync')
    ape = metrics.APE(metrics.PoseRelation.translation_part)
    ape.process_data(sync.associate_trajectories(reference, estimate))
    return ape.get_statistic(metrics.StatisticsType.rmse)


def served_by_foxglove(path):
    """
    Serve a bag with foxglove-sdk; return the topics that a client receives with unchanged bytes.
    """
    foxglove = need('foxglove')
    first, context = {}, foxglove.Context()
    channels = {}
    for schema, channel, message in mcap_messages(path):
        if channel.topic in first:
            continue
        first[channel.topic] = message
        channels[channel.topic] = foxglove.Channel(
            channel.topic, message_encoding=channel.message_encoding, context=context,
            schema=foxglove.Schema(name=schema.name, encoding=schema.encoding, data=schema.data))
    server = foxglove.start_server(host='127.0.0.1', port=0, context=context)
    try:
        with FoxgloveClient(server.port) as client:
            client.wait_channels(channels)
            client.subscribe(channels)
            # A message that is sent before the client has subscribed is lost.
            end = time.monotonic() + GUARD_S
            while not all(channel.has_sinks() for channel in channels.values()):
                assert time.monotonic() < end, 'subscriptions do not arrive'
                time.sleep(0.01)
            for name, message in first.items():
                channels[name].log(message.data, log_time=message.log_time)
            client.wait_messages(channels)
            return {name for name, (log_ns, data) in client.received.items()
                    if (log_ns, data) == (first[name].log_time, first[name].data)}
    finally:
        server.stop()


def _run(module, *words, codes=(0,)):
    """Run a module with this interpreter; return its output."""
    found = subprocess.run([sys.executable, '-c', f'import sys; from {module} import main; '
                            'sys.exit(main())', *map(str, words)], capture_output=True, text=True,
                           check=False)
    assert found.returncode in codes, found.stdout + found.stderr
    return found.stdout


def stamplint_findings(path):
    """Return the findings of stamplint above the level of information."""
    need('stamplint')
    found = json.loads(_run('stamplint.cli', path, '--json', codes=(0, 1)))
    return [one['message'] for one in found if one['severity'] in (ERROR, WARNING)]


def doctor_findings(path):
    """Return the findings of rosbag-doctor."""
    need('rosbag_doctor')
    found = json.loads(_run('rosbag_doctor.cli', path, '--format', 'json', codes=(0, 1)))
    return [f'{one.get("topic")}: {one["message"]}' for one in found['issues']]


def slam_lint_findings(path):
    """Return the findings of rosbag-slam-lint for a bag that is input of an EKF."""
    need('rosbag_slam_lint')
    # The linter reports bags shorter than 60 s, and the bags of tests are shorter.
    rules = path.with_name('slam_lint.yaml')
    rules.write_text('checks: {short_recording_s: 5.0}')
    found = json.loads(_run('rosbag_slam_lint', path, '--profile', 'ekf', '--json', '--config',
                            rules, codes=(0, 1)))
    return [one['message'] for one in found['issues'] if one['level'] != 'info']


LINTERS = {'stamplint': stamplint_findings, 'rosbag-doctor': doctor_findings,
           'rosbag-slam-lint': slam_lint_findings}
