"""How fast the live chain is: loss, latency, steps a second."""

import os
import time

import numpy as np
import pytest

pytest.importorskip('rclpy')
import live  # noqa: E402, F401, I100, I202
from core_step import EVERYTHING  # noqa: E402, I100, I202
from live_chain import run  # noqa: E402, I100, I202

pytestmark = pytest.mark.live


def best(attempts, good, *arguments, **more):
    """Return the first good Result of a few: another load on the machine is no fault of ours."""
    for _ in range(attempts):
        result = run(*arguments, **more)
        percentiles = np.percentile(result.latency_s, (50, 99, 99.9, 100)) * 1e3 \
            if len(result.latency_s) else ()
        print(f'\n{arguments}: {result.received} received, {result.lost} lost, '
              f'{result.steps_per_s:.0f} steps/s, latency ms p50 p99 p99.9 max '
              f'{np.round(percentiles, 2)}, CPU s {result.cpu_s}')
        assert set(result.codes.values()) == {0}
        if good(result):
            break
    return result


@pytest.mark.slow
def test_real_time_1_khz_for_a_minute(ros_domain):
    result = best(3, lambda r: np.percentile(r.latency_s, 99.9) < 0.01 and r.lost == 0,
                  1000, 60, 1, domain=ros_domain)
    assert result.lost == 0
    assert np.percentile(result.latency_s, 99.9) < 0.01


@pytest.mark.slow
def test_real_time_2_khz_for_a_minute(ros_domain):
    assert best(3, lambda r: r.lost == 0, 2000, 60, 1, domain=ros_domain).lost == 0


@pytest.mark.slow
def test_tuned_gyros_with_every_error_1_khz_for_a_minute(ros_domain):
    """Two tuned gyros, every term of the model but drop-outs: no sample is lost."""
    values = {key: list(value) if isinstance(value, tuple) else value
              for key, value in EVERYTHING.items() if 'drop_out' not in key}
    values.update({'input': 'integrated', 'imu_time': 'nominal', 'imu_latency_us': 50.0,
                   'on_fault': 'stop'})
    result = best(3, lambda r: r.lost == 0, 1000, 60, 1, domain=ros_domain, **values)
    assert result.lost == 0


def test_real_time_1_khz_without_loss(ros_domain):
    assert best(2, lambda r: r.lost == 0, 1000, 5, 1, domain=ros_domain).lost == 0


def test_lock_step_speed(ros_domain):
    """At least 5000 steps a second, or the part of it that other programs leave of the cores."""
    for _ in range(6):
        start, before = time.monotonic(), busy()
        result = best(1, lambda r: True, 100, 200, 0, domain=ros_domain)
        wall_s = time.monotonic() - start
        others = (busy() - before - sum(result.cpu_s.values())) / (wall_s * os.cpu_count())
        print(f'other programs: {others:.0%} of the cores')
        if result.steps_per_s >= 5000 * (1.0 - others):
            break
    assert result.lost == 0
    assert result.steps_per_s >= 5000 * (1.0 - others)


def busy():
    """Return the CPU seconds that all programs of the machine have used."""
    with open('/proc/stat') as stream:
        user, nice, system = map(int, stream.readline().split()[1:4])
    return (user + nice + system) / os.sysconf('SC_CLK_TCK')
