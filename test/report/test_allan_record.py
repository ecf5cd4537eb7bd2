"""
The regular part of a recorded IMU: lost, repeated, late and invalid samples; true noise.

Every record is white noise of known density, whatever happened to its stamps: the Allan deviation
at one interval and the fitted N agree with it within four standard deviations.
"""

import numpy as np
import pytest

from ins_sim.core.timeseries.histories import ImuSamples
from ins_sim.report import allan
from ins_sim.report.allan_record import regular_record

COUNT, RATE = 20_000, 100.0
EVEN = 1_700_000_000_000_000_000 + 10_000_000 * np.arange(COUNT)
NUMBER = np.arange(COUNT)
# Ten readings are sent together, at the end of their tenth of a second.
TENS = EVEN[NUMBER // 10 * 10 + 9] + NUMBER % 10 * 100_000


def record(t_ns, seed=1):
    """Return readings of white noise, 1 rad/s and 2 m/s^2 a sample."""
    rng = np.random.default_rng(seed)
    return ImuSamples(np.asarray(t_ns, dtype=np.int64), rng.normal(size=(len(t_ns), 3)),
                      2.0 * rng.normal(size=(len(t_ns), 3)))


def jitter(sigma_s):
    """Return even stamps with a white deviation."""
    return EVEN + np.round(1e9 * np.random.default_rng(2).normal(scale=sigma_s, size=COUNT)
                           ).astype(np.int64)


def check_density(found):
    """Compare N with the truth: its relative standard deviation is at least 0.6/sqrt(readings)."""
    for samples, size in ((found.imu.omega, 1.0), (found.imu.f, 2.0)):
        fitted = allan.fit_coefficients(allan.estimate_deviation(samples, found.rate_hz))
        ratio = fitted.random_walk * np.sqrt(found.rate_hz) / size
        bound = 4.0 * 1.2 / np.sqrt(3 * len(found.imu))
        print(f'{len(found.imu)} readings: N {ratio:.4f} of the truth, bound {bound:.4f}')
        assert abs(ratio - 1.0) < bound


CASES = {
    'even': (EVEN, COUNT, ()),
    'a jitter of 5 %': (jitter(0.0005), COUNT, ()),
    'a jitter of 30 %': (jitter(0.003), COUNT, ('the stamps are evened out, by at most 0.01',)),
    'one lost': (np.delete(EVEN, 7000), 12_999, (
        '1 reading is lost, the first at 69.99 s', 'the longest part between them is used: 12999 '
        'of 19999 readings, from 70.01 s after the start')),
    'four lost': (np.delete(EVEN, [7000, 7001, 7002, 15000]), 7997, (
        '4 readings are lost, the first at 69.99 s', '7997 of 19996 readings')),
    'a repeated stamp': (np.where(NUMBER == 500, EVEN - 10_000_000, EVEN), COUNT, (
        '2 of 19999 intervals differ from 0.01 s by more than half of it: the stamps are evened '
        'out, by at most 0.01 s',)),
    'two in the wrong order': (EVEN[np.r_[:500, 501, 500, 502:COUNT]], COUNT, ('evened out',)),
    'a step back': (np.where(NUMBER >= 3000, EVEN - 1_000_000_000, EVEN), 17_000, (
        'the stamps fall behind at 1 place, the first at 29.99 s', '17000 of 20000 readings')),
    'a second late for half a minute': (
        np.where((NUMBER >= 3000) & (NUMBER < 6000), EVEN + 10**9, EVEN), 14_000, (
            'the stamps fall behind at 1 place and jump forward by 100 intervals in all, the '
            'first at 29.99 s', '14000 of 20000 readings')),
    'bursts': (TENS, COUNT, ('19999 of 19999 intervals differ from 0.01 s by more than half of '
                             'it: the stamps are evened out, by at most 0.04',)),
    'bursts of one stamp': (EVEN[NUMBER // 10 * 10], COUNT, ('evened out, by at most 0.045 s',)),
    'five lost in bursts': (np.delete(TENS, range(9000, 9005)), None, ('5 readings are lost',)),
    '3.6 % off its name': (EVEN[0] + (EVEN - EVEN[0]) * 1000 // 1036, COUNT, ()),
    'a clock of milliseconds': (EVEN[0] + NUMBER * 970_000 // 1_000_000 * 1_000_000, COUNT, (
        '600 of 19999 intervals differ from 0.00097 s',)),
    'another rate': (np.concatenate([EVEN, EVEN[-1] + 9_000_000 * np.arange(1, 3001)]), None, (
        'the rate changes, from 100 to 111.111 Hz: the longest part within 2 % of one rate',))}


@pytest.mark.parametrize('name', CASES)
def test_the_noise_of_a_record_with_faults(name):
    """Each fault is reported once with its count, and the density is that of the readings."""
    t_ns, left, says = CASES[name]
    found = regular_record(record(t_ns))
    rate = {'3.6 % off its name': 103.6, 'a clock of milliseconds': 1e9 / 970_000}.get(name, RATE)
    assert found.rate_hz == pytest.approx(rate, rel=1e-4)
    assert len(found.imu) == left or left is None and len(found.imu) > 10_000
    said = '\n'.join(found.notes)
    assert all(part in said for part in says) and (says or not said)
    check_density(found)


def test_readings_that_are_no_numbers_count_as_lost():
    """Invalid readings are counted, and the longest part without them is used."""
    imu = record(EVEN)
    imu.omega[700], imu.f[9000, 1] = np.nan, np.inf
    found = regular_record(imu)
    assert found.notes[0] == ('2 of 20000 readings hold a value that is not a number and counts '
                              'as lost')
    assert len(found.imu) == 10_999 and len(found.notes) == 3
    check_density(found)
    imu.omega[:] = np.nan
    with pytest.raises(ValueError, match=r'0 are left \(20000 of 20000 readings hold a value'):
        regular_record(imu)


def test_a_message_that_is_there_twice():
    """A message with the stamp and values of the one before is left out, others are not."""
    found = regular_record(record(EVEN)[np.insert(NUMBER, 500, 500)])
    assert found.notes == ('1 reading is present twice, with the same stamp and values; the '
                           'copies are removed',)
    assert len(found.imu) == COUNT
    found = regular_record(record(np.insert(EVEN, 500, EVEN[500])))
    assert 'the stamps fall behind at 1 place, the first at 5 s' in found.notes[0]


def test_the_rate_may_be_given():
    """If all messages have one stamp, the rate given by the user is used."""
    imu = record(np.full(COUNT, 7))
    with pytest.raises(ValueError, match=r'of 19999 intervals 19999 are not positive; '
                                         r'"-p rate_hz:=HZ" uses all readings in their order'):
        regular_record(imu)
    found = regular_record(imu, RATE)
    assert found.notes == ('20000 readings are assumed to be spaced evenly at 100 Hz (rate_hz); '
                           'the rate of their stamps is not defined',)
    check_density(found)
    assert 'the rate of their stamps is 100 Hz' in regular_record(record(EVEN), 50.0).notes[0]


@pytest.mark.parametrize('count', [0, 1, 2, 39])
def test_too_few(count):
    """Too few readings give one message, not an exception."""
    with pytest.raises(ValueError, match=f'has {count} readings, of which {count} are left; '
                                         'expected at least 40'):
        regular_record(record(EVEN[:count]))


@pytest.mark.parametrize('lost', [0.01, 0.2])
def test_many_lost_at_random(lost):
    """The remaining part has the true rate, or is reported as too short."""
    keep = np.random.default_rng(3).random(COUNT) >= lost
    try:
        found = regular_record(record(EVEN)[keep])
    except ValueError as error:
        assert 'readings are lost' in str(error) and '-p rate_hz:=HZ' in str(error)
    else:
        assert found.rate_hz == pytest.approx(RATE, rel=1e-6)
        check_density(found)
