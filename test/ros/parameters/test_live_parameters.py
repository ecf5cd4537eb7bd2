"""Parameters set while nodes run: node objects without DDS, called like the services."""

import math

import pytest
from support.nodes.asked import ask, ask_at_once, value_of
from support.nodes.on_racetrack import Flown, MOTION

from ins_sim.messages import topics

pytest.importorskip('rclpy')

BIAS, FORCE_BIAS = 'gyro.errors.bias_deg_h', 'accelerometer.errors.bias_ug'
LOST, FAULT = 'sampling.drop_out_probability', 'gyro.dtg.fault.'
NOISY = {'gyro.errors.angle_random_walk_deg_sqrt_h': [0.1] * 3,
         'gyro.errors.rate_random_walk_deg_h_sqrt_h': [1.0] * 3,
         'gyro.errors.turn_on_bias_sigma_deg_h': [5.0] * 3,
         'accelerometer.errors.bias_instability_ug': [30.0] * 3}
DTG = {'gyro.model': 'dtg', 'output': 'integrated'}
OURS = {'source': 'motion', **MOTION}


def readings(parameters, at=None, change=None, count=600):
    """Return the IMU messages of a flight in which parameters are set at sample ``at``."""
    with Flown(imu_sensor=parameters) as flown:
        flown.fly(count if at is None else at)
        if at is not None:
            assert ask_at_once(flown.nodes['imu_sensor'], change) == ''
            flown.fly(count - at)
        return flown.heard[topics.IMU_RAW.name], flown.said('imu_sensor')


@pytest.mark.parametrize('more, from_k', [
    ({}, 150), (NOISY, 150), ({**NOISY, **OURS}, 150), ({**DTG, **NOISY}, 150),
    ({**DTG, **NOISY, **OURS}, 256)],
    ids=['perfect', 'noise', 'own motion', 'tuned gyros', 'tuned gyros, own motion'])
def test_a_bias_counts_from_the_instant_that_is_said(more, from_k, ros_domain):
    """
    A new bias applies from exactly the logged instant on; the bytes before are the old ones.

    Tuned gyros that evaluate their own motion are computed 256 readings ahead, which the log
    states.
    """
    old, said = readings(more)
    new, _ = readings({**more, BIAS: [50.0, -50.0, 0.0]})
    got, said = readings(more, 150, {BIAS: [50.0, -50.0, 0.0]})
    assert got[:from_k] == old[:from_k] and got[from_k:] == new[from_k:]
    assert all(a != b for a, b in zip(old, new))
    assert f'{BIAS} is now [50.0, -50.0, 0.0] deg/h from t = {from_k / 100:.9f} s on' in said


def test_biases_and_drop_outs_at_once_and_back(ros_domain):
    """Several parameters are set in one request and set back; the drop-outs have the set rate."""
    change = {BIAS: 7, FORCE_BIAS: [1.0, 2.0, 3.0], LOST: 0.5}
    perfect, _ = readings({})
    with Flown(imu_sensor={}) as flown:
        node = flown.nodes['imu_sensor']
        flown.fly(100)
        assert ask_at_once(node, change) == ''
        flown.fly(100)
        assert ask(node, {BIAS: 0.0, FORCE_BIAS: 0, LOST: 0}) == [''] * 3
        flown.fly(100)
        got, said = flown.heard[topics.IMU_RAW.name], flown.said('imu_sensor')
        assert value_of(node, BIAS) == [0.0] * 3 and node.settings.gyro.errors.bias_deg_h == (
            0.0,) * 3
    assert (f'{BIAS} is now [7.0, 7.0, 7.0] deg/h from t = 1.000000000 s on; {FORCE_BIAS} is now '
            f'[1.0, 2.0, 3.0] ug from t = 1.000000000 s on; {LOST} is now 0.5 from t') in said
    amid, _ = readings({BIAS: [7.0] * 3, FORCE_BIAS: [1.0, 2.0, 3.0], LOST: 0.5})
    lossless, _ = readings({BIAS: [7.0] * 3, FORCE_BIAS: [1.0, 2.0, 3.0]})
    kept = [data for data in lossless[100:200] if data in set(amid)]
    assert 20 < len(kept) < 80 and got == [*perfect[:100], *kept, *perfect[200:300]]


def test_a_fault_is_injected_changed_and_taken_away(ros_domain):
    """Channel and bias of a fault are set by parameters; the service keeps the fault it forced."""
    from support.nodes.asked import service_of
    from types import SimpleNamespace
    with Flown(imu_sensor=DTG) as flown:
        node = flown.nodes['imu_sensor']
        force = service_of(node, 'fault')
        answer = force(SimpleNamespace(data=True), SimpleNamespace(success=False))
        assert not answer.success and answer.message == (
            'gyro.dtg.fault.channel is none; expected the name of the channel to be disturbed')
        pair = node.stage.pair.pair
        flown.fly(100)
        assert ask_at_once(node, {FAULT + 'channel': 'gyro_2_z', FAULT + 'bias_deg_h': 3600.0,
                                  FAULT + 'start_s': 1.5, FAULT + 'end_s': 2.0}) == ''
        on = []
        for _ in range(150):
            flown.fly(1)
            on.append(pair.faults is not None)
        assert on == [False] * 50 + [True] * 50 + [False] * 50
        assert force(SimpleNamespace(data=True), SimpleNamespace()).success
        assert ask(node, {FAULT + 'scale': 0}) == ['']
        flown.fly(1)
        assert pair.faults[3] == (pytest.approx(math.radians(1.0)), 0.0)
        assert ask(node, {FAULT + 'channel': 'gyro_9'})[0].startswith(
            f"{FAULT}channel is 'gyro_9'; expected one of none, gyro_1_y")
        assert ask(node, {FAULT + 'end_s': 2.5}) == ['']
        flown.fly(1)
        assert pair.faults is None
        assert ask(node, {FAULT + 'channel': 'none'}) == ['']


def test_outages_and_a_jump_of_the_receiver(ros_domain):
    """If only the start of an outage is set, it lasts until its end is set."""
    status = topics.GNSS_FIX.reader().numbers
    with Flown(gnss={'gnss.rate_hz': 10.0}) as flown:
        node = flown.nodes['gnss']
        assert value_of(node, 'outages.start_s') == []
        flown.fly(100)
        assert ask(node, {'outages.start_s': [1.45]}) == ['']
        assert value_of(node, 'outages.end_s') == [1e7]
        flown.fly(100)
        assert ask(node, {'outages.end_s': [2.0]}) == ['']
        flown.fly(50)
        assert ask(node, {'jump.offset_m': [100.0, 0.0, 0.0]}) == [
            'jump.offset_m cannot be set: jump.end_s is 0 s with jump.start_s 0 s; expected a '
            'later end']
        assert ask_at_once(node, {'jump.end_s': 1e6, 'jump.offset_m': [0.0, 0.0, 5e4]}) == ''
        flown.fly(50)
        fixes = flown.heard[topics.GNSS_FIX.name]
        lost = [k for k, data in enumerate(fixes) if status(data)[0] < 0]
        assert lost == list(range(15, 20))
        assert 'outages.start_s is now [1.45] s from t = 1.000000000 s on' in flown.said('gnss')
        assert 'outages.end_s is now [2.0] s from t = 2.000000000 s on' in flown.said('gnss')
        heights = [topics.GNSS_FIX.reader().read(data)[1][2] for data in fixes[-10:]]
        assert all(4e4 < h for h in heights[5:]) and all(h < 4e4 for h in heights[:5])
        assert ask(node, {'outages.start_s': []}) == ['']
        assert value_of(node, 'outages.end_s') == []
        assert node.settings.outages.start_s == ()


def test_drop_outs_of_the_velocity_meter(ros_domain):
    """Drop-outs of the meter apply from the next window that ends."""
    own = {'attack_angle': 'none', 'window.cycles': 10, 'limits.height_max_m': 2e4}
    with Flown(velocity_meter=own) as flown:
        node = flown.nodes['velocity_meter']
        flown.fly(105)
        assert node._invalid == 0 and node._windows == 10
        assert ask(node, {'drop_outs.start_s': [0.0]}) == ['']
        assert 'drop_outs.end_s is now [10000000.0] s from t = 1.100000000 s on' in flown.said(
            'velocity_meter')
        flown.fly(100)
        assert node._invalid == node._windows - 10 == 10
        assert ask(node, {'drop_outs.start_s': []}) == ['']
        flown.fly(100)
        assert node._invalid == 10 and node._windows == 30
