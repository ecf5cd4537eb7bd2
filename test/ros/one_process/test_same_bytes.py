"""The nodes in one process publish, byte for byte, what they publish one by one."""

import pytest
from support.aided_streams import VALUES as FLIGHT
from support.one_process import apart, together

pytest.importorskip('rclpy')

FAST = {'pacing.real_time_factor': 0.0, 'rate_hz': 100.0, 'seed': 3}
AIDED = {**{name: list(value) if isinstance(value, tuple) else value
            for name, value in FLIGHT.items()},
         **FAST, 'source': 'stream', 'aided': True, 'duration_s': 5.0, 'outages.start_s': [2.0],
         'outages.end_s': [3.0],
         'pacing.required': ['strapdown', 'velocity_meter', 'gnss', 'aided_navigator']}
GUIDED = {**AIDED, 'motion.kind': 'guided', 'motion.guided.offset_m': 5.0,
          'guidance.latency_s': 0.03, 'surrogate.k_z': 0.15, 'filter': 'paper_corrected',
          'gnss_model.use': False, 'window.latency_ms': 0.0}
RUNS = {
    'plain': {**FAST, 'duration_s': 5.0},
    'late channels, noise, lost readings': {
        **FAST, 'duration_s': 5.0, 'gyro.delay_us.x': 1500.0, 'gyro.delay_us.y': -700.0,
        'gyro.errors.angle_random_walk_deg_sqrt_h': [0.1] * 3,
        'sampling.drop_out_probability': 0.02},
    'fewer outputs': {**FAST, 'duration_s': 2.0, 'output_every': 5},
    'tuned gyros': {**FAST, 'duration_s': 3.0, 'gyro.model': 'dtg', 'output': 'integrated',
                    'input': 'integrated', 'gyro.dtg.arrangement': 'turned'},
    'aided': AIDED,
    'guided': GUIDED,
    'one unanswered step': {**FAST, 'duration_s': 0.5, 'pacing.window': 1},
}


@pytest.mark.parametrize('name', RUNS)
def test_the_bytes_of_separate_nodes(name, ros_domain):
    """Every message of every topic, in lock-step."""
    expected, sent = apart(RUNS[name]), together(RUNS[name])
    for topic, messages in expected.items():
        if topic not in ('sim/ack', '/clock'):
            assert sent[topic] == messages, topic
    print({topic: len(messages) for topic, messages in sent.items()})
