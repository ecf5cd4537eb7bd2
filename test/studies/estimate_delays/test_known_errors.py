"""Without noise the set errors are estimated exactly, for each kind of output."""

import math

import numpy as np
import pytest

from ins_sim.core.calibration.bench_record import BenchRecord
from ins_sim.core.calibration.channel_sums import ASYMMETRY, BIAS, LAST, NEXT, SCALE
from ins_sim.core.calibration.delays import estimate_triad
from ins_sim.core.motion.factory import make_motion
from ins_sim.core.numerics.units import DEG_H
from ins_sim.core.sensors.imu.ideal import MotionImu
from support.readings.bench import DIAGONAL, FOG, ideal, read, THREE_ANGLES
from support.studies import settings

ERRORS = {'gyro.errors.scale_factor_ppm': (300.0, -200.0, 100.0),
          'gyro.errors.non_orthogonality_mrad': (0.4, -0.3, 0.2),
          'gyro.errors.scale_asymmetry_ppm': (20.0, -30.0, 10.0),
          'gyro.errors.bias_deg_h': (5.0, -3.0, 1.0)}
DELAYS = {'gyro.delay_us.x': 5000.0, 'gyro.delay_us.y': -300.0, 'gyro.delay_us.z': 1.0}


@pytest.mark.parametrize('output', ['rotation_vector', 'integrated'])
def test_all_errors_come_out_as_they_were_set(output):
    """
    Delays of 5 ms, -0.3 ms and 1 us are found together with all other errors.

    An axis misaligned by 0.4 mrad towards one that is 5.3 ms later or earlier sees 2.1 us of it:
    the linear model neglects this product. The rates change by 0.02 in this time; 0.4 mrad times
    that is neglected too.
    """
    record, chosen = ideal({**THREE_ANGLES, **ERRORS, **DELAYS, 'output': output}, 60.0)
    found = estimate_triad([read(record, chosen, 0)]).channels
    assert [1e6 * c.delay for c in found] == pytest.approx([5000.0, -300.0, 1.0], abs=2.1)
    yx, zx, zy = (math.sin(1e-3 * a) for a in ERRORS['gyro.errors.non_orthogonality_mrad'])
    scale = 1.0 + 1e-6 * np.array(ERRORS['gyro.errors.scale_factor_ppm'])
    rows = np.array([[1.0, 0.0, 0.0], [yx, math.sqrt(1.0 - yx * yx), 0.0],
                     [zx, zy, math.sqrt(1.0 - zx * zx - zy * zy)]])
    for axis, channel in enumerate(found):
        row = scale[axis] * rows[axis]
        expected = [row[axis] - 1.0, row[(axis + 1) % 3], row[(axis + 2) % 3]]
        assert channel.values[[SCALE, NEXT, LAST]] == pytest.approx(expected, abs=8e-6)
        assert channel.values[ASYMMETRY] == pytest.approx(
            1e-6 * ERRORS['gyro.errors.scale_asymmetry_ppm'][axis], abs=8e-6)
        assert channel.values[BIAS] / DEG_H == pytest.approx(
            ERRORS['gyro.errors.bias_deg_h'][axis], abs=0.05)


def test_delays_alone_are_found_to_a_nanosecond():
    """Without other errors a delay is found to 1 ns, the resolution of the time of the motion."""
    record, chosen = ideal({**THREE_ANGLES, **DELAYS}, 60.0)
    found = estimate_triad([record]).channels
    assert [1e6 * c.delay for c in found] == pytest.approx([5000.0, -300.0, 1.0], abs=1e-3)


def test_a_stamp_in_the_middle_of_the_interval_is_a_delay_of_half_of_it():
    """Stamps that are 5 ms early make every channel 5 ms early: the delay is common."""
    chosen = settings(THREE_ANGLES)
    generator = chosen.motion_generator
    motion = make_motion(generator.motion, generator.datum, generator.earth)
    imu = MotionImu(chosen.imu_sensor, motion, 0).advance(2000)
    early = type(imu)(imu.t_ns - 5_000_000, imu.omega, imu.f)
    record = BenchRecord('early', early, 10_000_000, motion, generator.datum, generator.earth)
    found = estimate_triad([record]).channels
    assert [1e6 * c.delay for c in found] == pytest.approx([-5000.0] * 3, abs=1e-3)


def test_records_of_two_instruments_are_not_taken_together():
    """A delay of y that is 20 us longer in the second record is many standard deviations off."""
    first, chosen = ideal({**DIAGONAL, **FOG}, 60.0)
    second, _ = ideal({**DIAGONAL, **FOG, 'gyro.delay_us.y': 20.0}, 60.0, start_s=60.0)
    records = [read(first, chosen, 0), read(second, chosen, 0)]
    with pytest.raises(ValueError, match='delay of y differs .* expected records of one'):
        estimate_triad(records)
