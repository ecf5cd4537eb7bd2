"""The end of ROS stamps, int32 seconds: 2038-01-19."""

import pytest

pytest.importorskip('rclpy')

from ins_sim.messages import topics  # noqa: E402
from ins_sim.ros.lock_step.truth_source import TruthSource  # noqa: E402
from ins_sim.settings.catalogue import build  # noqa: E402
from ins_sim.settings.motion import MotionGeneratorSettings  # noqa: E402


def endless(epoch_s):
    """Return the truth of an endless run."""
    return TruthSource(build(MotionGeneratorSettings, {
        'duration_s': 0.0, 'time.epoch_s': epoch_s, 'motion.kind': 'static'}))


def test_an_endless_run_ends_with_its_stamps():
    """
    The last sample is 10 s before the end of stamps, because readings have later stamps.

    This sample can be packed.
    """
    source = endless(2147483600)
    assert source.endless and source.count == 3801
    index = topics.TRUTH.index(topics.TRUTH_IMU)
    assert topics.TRUTH_IMU.reader().read(source.messages(3800)[index])[0] == \
        (2**31 - 10) * 10**9
    with pytest.raises(ValueError, match='would exceed the largest stamp of ROS'):
        endless(2147483645)
    assert not TruthSource(build(MotionGeneratorSettings, {
        'duration_s': 1.0, 'motion.kind': 'static'})).endless


@pytest.mark.live
def test_the_generator_says_so(chain):
    """At the end of the stamps the generator exits with code 0 and one message."""
    generator = chain.start('motion_generator', {
        'duration_s': 0.0, 'time.epoch_s': 2147483636, 'motion.kind': 'static'})
    assert generator.wait(60.0) == 0, chain.text(generator)
    said = chain.text(generator)
    assert 'the run has reached the largest stamp of ROS, 2147483648 s' in said
    assert 'Traceback' not in said
