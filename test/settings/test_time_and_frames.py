"""Epoch and frames: what the settings mean and what they refuse."""

import time

from ins_sim import parameter_files
from ins_sim.settings.by_node import AIDING, NODES
from ins_sim.settings.catalogue import build, flatten
from ins_sim.settings.motion import MotionGeneratorSettings
from ins_sim.settings.node import EPOCH_S, Time
from ins_sim.settings.place import Frames, ROLES
import pytest

SECOND = 10**9


@pytest.mark.parametrize('values, live, epoch_s', [
    ({}, False, 1735689600), ({'epoch': 'fixed'}, True, 1735689600),
    ({'epoch': 'fixed', 'epoch_s': 0}, True, 0), ({'epoch_s': 5}, True, 5),
    ({'epoch_s': 5}, False, 5)])
def test_a_fixed_epoch(values, live, epoch_s):
    """The epoch is fixed offline by default, and live on request or if epoch_s is given."""
    assert build(Time, values).epoch_ns(3 * SECOND, live) == epoch_s * SECOND
    assert EPOCH_S == 1735689600


@pytest.mark.parametrize('values, live', [({}, True), ({'epoch': 'now'}, True),
                                          ({'epoch': 'now', 'epoch_s': 5}, False)])
def test_the_epoch_of_now(values, live):
    """With epoch now the first sample, at motion time 100 s, has the clock time in whole ms."""
    before = time.time_ns()
    first_ns = build(Time, values).epoch_ns(100 * SECOND, live) + 100 * SECOND
    assert before - 10**6 <= first_ns <= time.time_ns() and first_ns % 10**6 == 0


def test_only_the_generator_has_an_epoch():
    """Only motion_generator has time.epoch; every node has frames and tf.source."""
    for name, settings in {**NODES, **AIDING}.items():
        names = flatten(settings)
        assert ('time.epoch_s' in names) == (name == 'motion_generator')
        assert {'tf.source', 'frames.prefix', *(f'frames.{role}' for role in ROLES)} <= set(names)


def test_names_of_frames():
    """The prefix is put before every frame, including those without a setting."""
    names = build(Frames, {'prefix': 'uav1', 'base_link': 'body'}).names()
    assert names['map'] == 'uav1/map' and names['base_link'] == 'uav1/body'
    assert names['enu'] == 'uav1/enu' and names['leg'] == 'uav1/leg'
    assert set(map(str, Frames().names().values())) == {*ROLES, 'enu', 'leg'}
    # Names may have several parts.
    assert build(Frames, {'imu_link': 'nose/imu'}).names()['imu_link'] == 'nose/imu'


@pytest.mark.parametrize('values, sentence', [
    ({'prefix': '/uav1'}, "frames.prefix is '/uav1'; expected no slash at its ends, as in uav1, "
     'which makes uav1/map'),
    ({'prefix': 'uav1/'}, "frames.prefix is 'uav1/'; expected no slash at its ends"),
    ({'map': '/map'}, "frames.map is '/map'; expected no slash at its ends, as in map"),
    ({'odom': 'map'}, "frames.odom is 'map', which is already used for frames.map; expected a "
     'different name for every frame'),
    ({'gnss_link': 'imu_link'}, "frames.gnss_link is 'imu_link', which is already used for "
     'frames.imu_link; expected'),
    ({'base_link': 'enu'}, "frames.base_link is 'enu', which is already used for enu; expected"),
    ({'base_link': ''}, "frames.base_link is ''; expected a name without spaces or empty parts"),
    ({'base_link': 'a b'}, "frames.base_link is 'a b'; expected a name without spaces"),
    ({'prefix': 'a\nb'}, r"frames.prefix is 'a\\nb'; expected a name without spaces or empty "
     'parts, such as uav1'),
    ({'imu_link': 'a//b'}, "frames.imu_link is 'a//b'; expected a name without spaces")])
def test_frames_that_tf_does_not_take(values, sentence):
    """Frame names with slashes, spaces or repetitions are refused with key and value."""
    with pytest.raises(ValueError, match=sentence):
        build(Frames, values)


@pytest.mark.parametrize('word, sentence', [
    ('strapdown:frames.prefix:=a', "strapdown: frames.prefix is 'a'; expected the value of "
     "motion_generator, '', because all nodes share one TF tree"),
    ('gnss:frames.map:=world', "gnss: frames.map is 'world'; expected the value of "
     "motion_generator, 'map', because"),
    ('imu_sensor:tf.source:=ins', "imu_sensor: tf.source is 'ins'; expected the value of "
     "motion_generator, 'none'"),
    ('tf.source:=inss', r"tf.source is 'inss'; expected one of none, truth, ins, aided "
     r'\(nearest: ins\)')])
def test_nodes_of_one_vehicle_agree(word, sentence):
    """Frames and tf.source must be equal in all nodes of a vehicle."""
    with pytest.raises(ValueError, match=sentence):
        parameter_files.read_aided([], [word])
    both = parameter_files.read_aided([], ['frames.prefix:=uav1', 'tf.source:=aided'])
    assert both.aided_navigator.frames.names()['odom'] == 'uav1/odom'
    assert both.simulation.motion_generator == build(MotionGeneratorSettings, {
        'frames.prefix': 'uav1', 'tf.source': 'aided'})
