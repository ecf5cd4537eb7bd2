"""Delays of milliseconds, and the motion before the first sample: predicted and simulated."""

import numpy as np
import pytest
from support.studies import LATE_MOTION_2_WORDS, MOTION_2, prediction_of, run_offline, settings

from ins_sim.cli.main import main
from ins_sim.core.motion.factory import make_motion
from ins_sim.core.prediction.drift import channel_drift, delay_response
from ins_sim.core.prediction.late_turns import LateTurns

LONG = {**MOTION_2, 'motion.two_axis.detuning_rad_s': 0.1, 'gyro.delay_us.x': 5e3,
        'gyro.delay_us.y': 25e3, 'gyro.delay_us.z': 0.0, 'duration_s': 600.0}


@pytest.fixture(scope='module')
def flown():
    """Return the errors of a run by source and history, and the predictions by history."""
    runs = {(source, history): run_offline(settings(
        {**LONG, 'source': source, 'history': history}), twin=False).errors
        for source in ('motion', 'stream') for history in ('analytic', 'frozen')}
    return runs, {history: prediction_of(settings({**LONG, 'history': history}))
                  for history in ('analytic', 'frozen')}


def largest(errors):
    """Return max |dN| and max |dE|, m."""
    east, north, _ = np.abs(errors.position).max(axis=0)
    return north, east


@pytest.mark.xdist_group('long delays')
def test_delays_of_milliseconds_from_the_motion_itself(flown):
    """
    Delays of 5 ms (x) and 25 ms (y) on detuned motion 2 err by 5869.9 / 85141.9 m in 600 s.

    The detuning is 0.1 rad/s.
    """
    north, east = largest(flown[0]['motion', 'analytic'])
    # 2e-5, because the expected values were computed with another mechanization.
    assert (north, east) == (pytest.approx(5869.9, rel=2e-5), pytest.approx(85141.9, rel=2e-5))


@pytest.mark.xdist_group('long delays')
@pytest.mark.parametrize('history', ['analytic', 'frozen'])
def test_the_stream_continues_the_motion_backwards(flown, history):
    """
    Streamed truth continues the motion before the first sample within 1e-3 of the error.

    With a constant rate it would be 4 %.
    """
    runs = flown[0]
    streamed, itself = (largest(runs[source, history]) for source in ('stream', 'motion'))
    off = np.abs(np.subtract(streamed, itself)) / itself
    print(f'\n{history}: stream off by {off[0]:.1e} North and {off[1]:.1e} East')
    assert off.max() < 1e-3


@pytest.mark.xdist_group('long delays')
@pytest.mark.parametrize('history', ['analytic', 'frozen'])
def test_the_prediction_is_within_its_bound(flown, history):
    """The neglected second-order terms are present and smaller than the stated bound."""
    errors, predicted = flown[0]['motion', history], flown[1][history]
    n = len(predicted.t_s)
    off = np.abs(errors.position[::10][:n] - predicted.position).max(axis=0)
    relative = off.max() / np.abs(errors.position).max()
    bound = predicted.position_bound / np.abs(errors.position).max()
    drift = np.linalg.norm(errors.drift[-1] - predicted.drift)
    print(f'\n{history}: position off by {off[1]:.0f} / {off[0]:.0f} m, {relative:.1e} (bound '
          f'{bound:.1e}); drift by {drift:.2e} rad/s (bound {predicted.drift_bound:.2e})')
    assert relative < 4.4e-3 < bound
    assert off.max() < predicted.position_bound
    assert drift < predicted.drift_bound
    # The bound has the size of the neglected terms, not of the error itself.
    assert bound < 0.1


@pytest.mark.parametrize('source', ['motion', 'stream'])
def test_a_frozen_history_is_predicted(source):
    """
    With a frozen history delays of 1 us err by 0.0023 / 0.0001 m in 600 s.

    An analytic history gives 0.018 / 0.73 m.
    """
    values = {**MOTION_2, 'gyro.delay_us.x': 1.0, 'gyro.delay_us.z': 1.0, 'duration_s': 600.0,
              'source': source}
    frozen = settings({**values, 'history': 'frozen'})
    north, east = largest(run_offline(frozen, twin=False).errors)
    predicted = prediction_of(frozen).largest
    assert (north, east) == (pytest.approx(0.0023, abs=5e-5), pytest.approx(0.0001, abs=5e-5))
    assert predicted[[1, 0]] == pytest.approx((north, east), abs=5e-6)
    analytic = prediction_of(settings(values)).largest
    assert analytic[[1, 0]] == pytest.approx((0.01815, 0.7301), rel=1e-3)


@pytest.mark.parametrize('output, model', [('integrated', 'ideal'), ('integrated', 'dtg'),
                                           ('rotation_vector', 'ideal')])
@pytest.mark.parametrize('history', ['analytic', 'frozen'])
def test_histories_of_every_output_are_predicted(output, model, history):
    """
    Delays of 5 ms, and 7 ms on one accelerometer, stay within the bound of the prediction.

    A frozen history ends within an interval of the grid, 12.5 ms, in which the rotations due to
    both delays at 1.1 rad/s are assumed to grow evenly: at most g times 13 mrad times 12.5 ms, a
    velocity error that adds up over a minute.
    """
    values = {**MOTION_2, 'gyro.delay_us.x': 5e3, 'gyro.delay_us.y': 5e3, 'gyro.delay_us.z': 5e3,
              'duration_s': 60.0, 'output': output, 'input': output, 'gyro.model': model,
              'history': history, 'rate_hz': 400.0, 'accelerometer.delay_us.x': 7e3}
    chosen = settings(values)
    errors, predicted = run_offline(chosen, twin=False).errors, prediction_of(chosen)
    n = len(predicted.t_s)
    off = np.abs(errors.position[::40][:n] - predicted.position).max()
    size = np.abs(errors.position).max()
    print(f'\n{output}, {model}, {history}: {off:.3g} m of {size:.4g} (bound '
          f'{predicted.position_bound:.3g})')
    ending = 9.8 * 1.1 * 12e-3 * 12.5e-3 * 60.0 if history == 'frozen' else 0.0
    assert off < 0.02 * size + ending and off < predicted.position_bound + ending


def test_long_turns_are_the_exact_response_of_the_channel():
    """The mean of R (w x D) over a period is the Fourier sum of exp(-j w tau), to 1e-6."""
    chosen = settings({**LONG, 'earth.rotation': False})
    generator = chosen.motion_generator
    motion = make_motion(generator.motion, generator.datum, generator.earth)
    tau_ns = chosen.imu_sensor.gyro.delay_us.in_ns()
    turns = LateTurns(motion, tau_ns, 0)
    assert turns.long
    from ins_sim.core.prediction.drift import mean_drift
    time = mean_drift(motion, turns.at, False, 0.0, None)
    fourier = channel_drift(motion, [delay_response(1e-9 * t) for t in tau_ns])
    # Instants are multiples of a millisecond, exact in nanoseconds.
    assert np.linalg.norm(fourier - time) <= 1e-6 * np.linalg.norm(time)


def test_predict_says_what_it_covers(capsys):
    """predict states its bound, and which instrument errors are not included."""
    words = ['predict', *LATE_MOTION_2_WORDS, '-p', 'duration_s:=60.0']
    assert main(words) == 0
    said = ' '.join(capsys.readouterr().out.split())
    assert ('the prediction covers delays, tuned gyros and initial errors, linear in the errors; '
            'second-order effects are at most ') in said
    assert 'errors of the instruments' not in said
    assert main([*words, '--params-file', 'imu_tactical_fog']) == 0
    said = ' '.join(capsys.readouterr().out.split())
    assert ('errors of the instruments are enabled (accelerometer.errors, gyro.errors), which the '
            'prediction does not cover: its 0.0575 m North and 0.00414 m East are the error '
            'without them') in said


def test_no_number_stands_beside_an_error_that_it_does_not_cover(tmp_path, capsys, monkeypatch):
    """With instrument errors the prediction is omitted, except in the row of run minus twin."""
    from ins_sim.report.runs import page
    drawn = []
    draw = page.error_chart
    monkeypatch.setattr(page, 'error_chart', lambda title, errors, prediction=None: (
        drawn.append(prediction), draw(title, errors, prediction))[-1])
    import json
    for name, more in (('on', ['--params-file', 'imu_tactical_fog']), ('off', [])):
        assert main(['simulate', *LATE_MOTION_2_WORDS, *more, '-p', 'duration_s:=60.0',
                     '-o', str(tmp_path / name)]) == 0
    capsys.readouterr()
    on, off = ({row['name']: row for row in json.loads(
        (tmp_path / name / 'summary.json').read_text())} for name in ('on', 'off'))
    assert [p is None for p in drawn] == [True, False]
    assert on['max |dN|']['predicted'] is on['mean drift east']['predicted'] is None
    twin = on['max |dN - twin|']
    assert twin['predicted'] == pytest.approx(twin['measured'], rel=0.02)
    assert off['max |dN|']['predicted'] == pytest.approx(off['max |dN|']['measured'], rel=0.02)
    assert off['max |dN - twin|']['predicted'] is None


@pytest.mark.parametrize('more, count', [
    ((), 1), (('source:=motion',), 0), (('history:=frozen',), 0), (('gyro.delay_us.y:=0.0',), 1),
    (('gyro.delay_us.x:=5e4',), 0)])
def test_a_delay_beyond_what_a_stream_is_continued_by_is_said_once(more, count, tmp_path, capsys):
    """A delay of 60 ms, longer than the 50 ms of analytic history on a stream, is noted once."""
    words = ['gyro.delay_us.x:=6e4', 'duration_s:=1.0', *more]
    assert main(['simulate', *LATE_MOTION_2_WORDS, '-o', str(tmp_path / 'run'),
                 *(word for a in words for word in ('-p', a))]) == 0
    said = capsys.readouterr().err
    assert said.count('a channel is delayed by 60 ms, but a stream is continued backwards by 50 '
                      'ms only') == count
