"""Delays of any size and sign on streamed truth, with the zero-delay twin."""

import json

import numpy as np
import pytest
from support.studies import FLIGHT, prediction_of, run_offline, settings

from ins_sim.cli.main import main
from ins_sim.core.simulation.inertial import withheld_readings

EARLY = {'motion.kind': 'two_axis', 'source': 'stream', 'duration_s': 5.0}


@pytest.mark.parametrize('delays', [(-1.0, 0.0, 1.0), (-1e4, 0.0, 0.0), (-2.5e4, 3e4, -1.0),
                                    (0.0, -1e6, 1e6), (-1e6, -1e6, -1e6)])
@pytest.mark.parametrize('where', ['gyro', 'accelerometer'])
def test_any_delay_is_simulated_with_its_twin(delays, where):
    """For any delay the twin has the instants of the run, which ends with the truth."""
    chosen = settings({**EARLY, **{f'{where}.delay_us.{axis}': delay
                                   for axis, delay in zip('xyz', delays)}})
    result = run_offline(chosen)
    assert np.array_equal(result.errors.t_ns, result.twin.t_ns)
    lead = -min(0.0, *delays)
    assert result.errors.t_ns[-1] == 5_000_000_000 - 10_000_000 * int(np.ceil(lead / 1e4))
    assert len(result.imu) == 501 - withheld_readings(chosen)
    assert np.isfinite(result.errors.position).all()


def test_a_lead_longer_than_the_run_leaves_the_first_reading():
    """A lead longer than the run leaves one reading, without an error."""
    chosen = settings({**EARLY, 'duration_s': 0.5, 'gyro.delay_us.x': -1e6})
    result = run_offline(chosen)
    assert len(result.imu) == len(result.twin) == 1 and withheld_readings(chosen) == 50


def test_the_command_writes_the_run_and_says_what_is_missing(tmp_path, capsys):
    """The summary has the twin, and the number of readings that are missing at the end."""
    words = [word for name, value in {**EARLY, 'gyro.delay_us.x': -1.0,
                                      'gyro.delay_us.z': -25000.0}.items()
             for word in ('-p', f'{name}:={value}')]
    assert main(['simulate', *words, '-o', str(tmp_path / 'run')]) == 0
    said = ' '.join(capsys.readouterr().out.split())
    assert ('the last 3 readings are left out, because a channel with a negative delay needs the '
            'truth after the end of the run') in said
    rows = json.loads((tmp_path / 'run' / 'summary.json').read_text())
    assert [row['name'] for row in rows][-2:] == ['max |dN - twin|', 'max |dE - twin|']


@pytest.mark.slow
def test_racetrack_with_a_negative_delay_for_an_hour():
    """
    An hour of racetrack with delays of 0, -1, 1 us of x, y, z errs by 0.389 / 0.244 m.

    In the axes right, forward, up the delays are -1, 0, 1 us.
    """
    values = {**FLIGHT, 'motion.kind': 'racetrack', 'gyro.delay_us.x': 0.0,
              'gyro.delay_us.y': -1.0, 'gyro.delay_us.z': 1.0, 'source': 'stream'}
    result = run_offline(settings(values))
    east, north, _ = np.abs(result.errors.position - result.twin.position).max(axis=0)
    assert (north, east) == (pytest.approx(0.389, abs=5e-4), pytest.approx(0.244, abs=5e-4))
    predicted = prediction_of(settings(values)).largest
    assert predicted[:2] == pytest.approx((east, north), rel=1e-2)
