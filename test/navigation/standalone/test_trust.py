"""The stated uncertainty of a self-alignment compared with its true error."""

import math

import numpy as np
import pytest

from ins_sim import parameter_files, resources
from ins_sim.core.attitude import quaternion
from ins_sim.core.motion.factory import make_motion
from ins_sim.core.navigation import alignment
from ins_sim.core.postprocessing.standstill import find_standstill
from ins_sim.core.numerics.units import DEG_PER_HOUR
from ins_sim.core.postprocessing.imu_record import RecordedImu
from ins_sim.core.simulation.inertial import imu_blocks
from ins_sim.settings.recorded_imu import AlignmentSettings

# Turn-on bias of the gyro presets, deg/h.
BIAS_DEG_H = {'imu_tactical_fog': 1.0, 'imu_tactical_mems': 7.0, 'imu_navigation_rlg': 0.0035}


def at_rest(preset, seed, length_s, heading_deg):
    """Return the RecordedImu of a preset at rest, 100 Hz, with latitude (rad) and true q_nb."""
    chosen = parameter_files.read([resources.config(preset)], [
        'motion.kind:=static', f'motion.psi_deg:={-heading_deg}', f'duration_s:={length_s}',
        f'seed:={seed}', 'source:=motion', 'output:=integrated', 'input:=integrated'])
    generator = chosen.motion_generator
    motion = make_motion(generator.motion, generator.datum, generator.earth)
    blocks = list(imu_blocks(chosen, motion))
    t_ns, omega, f = (np.concatenate([getattr(block, name) for block in blocks])
                      for name in ('t_ns', 'omega', 'f'))
    truth = motion.at(t_ns[:1])
    return (RecordedImu(t_ns, omega, f, np.full((len(t_ns), 4), np.nan)), float(truth.lat[0]),
            tuple(truth.q_nb[0].tolist()))


def heading_error(q_nb, true):
    """Return the error of the heading, rad."""
    return quaternion.logarithm(quaternion.multiply(q_nb, quaternion.conjugate(true)))[2]


@pytest.mark.parametrize('preset', ['imu_tactical_fog', 'imu_tactical_mems'])
def test_no_draw_is_trusted_that_is_out_by_three_sigma(preset, capsys):
    """
    No trusted heading is wrong by more than three sigma, in 24 draws of 30 s at rest.

    With the default sigma of the bias, and with the true one, no heading is trusted, because the
    bias alone causes 6.8 deg and more. If headings with a sigma of up to 10 deg are accepted, some
    of the FOG are trusted with the true sigma; of these, too, none is wrong by more than three
    sigma.
    """
    true_sigma, trusted = BIAS_DEG_H[preset], dict.fromkeys(('default', 'true', 'wide'), 0)
    for seed in range(24):
        imu, lat, true = at_rest(preset, seed, 30.0, 15.0 * seed)
        still = find_standstill(imu, AlignmentSettings())
        for name, values in (('default', {}), ('true', {'gyro_bias_sigma_deg_h': true_sigma}),
                             ('wide', {'gyro_bias_sigma_deg_h': true_sigma,
                                       'heading_sigma_deg': 10.0})):
            compass, _ = alignment.trusted_gyrocompass(still, lat, AlignmentSettings(**values))
            if compass is not None:
                trusted[name] += 1
                assert abs(heading_error(compass.q_nb, true)) <= 3.0 * compass.sigma, seed
    with capsys.disabled():
        print(f'\n{preset}, 24 draws at rest for 30 s: trusted by {trusted}')
    assert not trusted['default'] and not trusted['true']
    assert trusted['wide'] > 5 if preset == 'imu_tactical_fog' else not trusted['wide']


def test_the_sigma_is_noise_and_bias_together():
    """The sigma is hypot(noise, bias sigma / (15.04 deg/h cos(latitude)))."""
    imu, lat, _ = at_rest('imu_tactical_fog', 1, 10.0, 40.0)
    still = find_standstill(imu, AlignmentSettings())
    compass = alignment.gyrocompass(still, lat, 1.0 / DEG_PER_HOUR)
    by_bias = 1.0 / (15.041 * math.cos(lat))
    assert math.isclose(compass.sigma, math.hypot(compass.noise_sigma, by_bias), rel_tol=1e-5)
    assert math.isclose(math.degrees(by_bias), 6.77, abs_tol=0.01)


def test_what_two_instruments_reach(capsys):
    """
    The heading errors of RLG, FOG and MEMS over 8 draws are as specified.

    The RLG reaches 1 deg after 5 s and 0.1 deg after 60 s (here with the bias of its data sheet,
    and to the 15 % of an estimate from 15 frequencies). The noise of the FOG gives less than 1 deg
    after 25 s, and its bias of 1 deg/h leaves 6.8 deg at latitude 55.75 deg. The MEMS has 3 deg
    from noise after 30 s, and 47 deg from its bias. The errors of the RLG are within three of its
    sigmas.
    """
    rows = {}
    for preset, lengths in (('imu_navigation_rlg', (5.0, 60.0)), ('imu_tactical_fog', (25.0,)),
                            ('imu_tactical_mems', (30.0,))):
        sigma = BIAS_DEG_H[preset]
        for seed in range(8):
            imu, lat, true = at_rest(preset, seed, max(lengths) + 1.0, 77.0)
            for length_s in lengths:
                limits = AlignmentSettings(longest_s=length_s, gyro_bias_sigma_deg_h=sigma)
                still = find_standstill(imu, limits)
                compass, _ = alignment.trusted_gyrocompass(still, lat, limits)
                if preset == 'imu_navigation_rlg':
                    assert abs(heading_error(compass.q_nb, true)) < 3.0 * compass.sigma
                compass = alignment.gyrocompass(still, lat, sigma / DEG_PER_HOUR)
                rows.setdefault((preset, length_s), []).append(
                    (math.degrees(compass.noise_sigma), math.degrees(compass.sigma)))
    mean = {key: np.sqrt(np.mean(np.square(found), axis=0)) for key, found in rows.items()}
    with capsys.disabled():
        for (preset, length_s), (noise, whole) in mean.items():
            print(f'\n{preset} after {length_s:g} s at rest: noise {noise:.3f} deg, with its bias '
                  f'{whole:.3f} deg', end='')
        print()
    assert mean['imu_navigation_rlg', 5.0][1] < 1.0
    assert mean['imu_navigation_rlg', 60.0][1] < 0.115
    assert mean['imu_tactical_fog', 25.0][0] < 1.0
    assert math.isclose(mean['imu_tactical_fog', 25.0][1], 6.8, abs_tol=0.15)
    assert np.allclose(mean['imu_tactical_mems', 30.0], (3.0, 47.4), rtol=0.0, atol=0.5)
