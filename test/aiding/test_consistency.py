"""The covariance of the eskf compared with Monte Carlo: errors (NEES) and innovations (NIS)."""

from ins_sim import parameter_files, resources
from ins_sim.core.aiding import kalman, navigator
from ins_sim.core.aiding.filters import eskf_model
from ins_sim.core.attitude import matrix
from ins_sim.core.aiding.navigator import AidedNavigator, GNSS, METER
from ins_sim.core.navigation.errors import level_errors
from ins_sim.core.aiding.filters.eskf import ErrorStateFilter
from ins_sim.studies.filters import FilterCase, fly_filters, run_settings
from ins_sim.core.motion.factory import make_motion
from ins_sim.core.simulation.aided import make_instruments
from ins_sim.core.simulation.inertial import imu_blocks
import numpy as np
import pytest
from scipy.stats import chi2
from support.studies import spread

RUNS = 16
EVERY_NS = 60 * 10**9
# Horizontal position and velocity, and attitude: the states that the aiding affects.
STATES = [0, 1, 3, 4, 6, 7, 8]
# Only errors that the filter models: biases, and white noise.
IMU = ('gyro.errors.turn_on_bias_sigma_deg_h:=[0.05, 0.05, 0.05]',
       'gyro.errors.angle_random_walk_deg_sqrt_h:=[0.01, 0.01, 0.01]',
       'accelerometer.errors.turn_on_bias_sigma_ug:=[200.0, 200.0, 200.0]',
       'accelerometer.errors.velocity_random_walk_m_s_sqrt_h:=[0.018, 0.018, 0.018]')
CASES = {'velocity meter': ('window.cycles:=100',),
         'velocity meter and GNSS': ('window.cycles:=1000', 'gnss_model.use:=true',
                                     'antennas.mounting_yaw_arcmin:=0.0',
                                     'meter_model.mounting_sigma_arcmin:=1.0',
                                     'lever_arm_m:=[1.0, 0.5, 0.3]',
                                     'gnss_model.lever_arm_m:=[1.0, 0.5, 0.3]',
                                     'gnss.latency_ms:=150.0')}


class StampedAtItsEnd(ErrorStateFilter):
    """Uses the mean over the window as the velocity at its end, as conventional filters do."""

    def velocity_model(self, ins, fix):
        """Compare the fix with the present velocity, on which eta has no effect."""
        read, of_mean, columns = eskf_model.meter(ins.v_b[:2], *self.estimates)
        h = np.zeros((2, eskf_model.SIZE))
        c = matrix.attitude_matrix(ins.q_nb)
        h[:, eskf_model.V] = of_mean @ c.T[:2]
        h[:, eskf_model.PHI] = of_mean @ (c.T[:2] @ matrix.skew(ins.v))
        h[:, eskf_model.MU:] = columns
        return read - fix.velocity, h


def test_a_mean_stamped_at_its_end_is_forty_times_too_far_off(monkeypatch, figures):
    """
    The mean NIS is 2 with the exact model, and 82 if the mean is used as the velocity at the end.

    Ten minutes on a straight leg with weaving heading. The NIS of 60 fixes is within the 95 %
    chi-square interval; that of the wrong filter is within a quarter of the value caused by the
    weave of the lateral velocity in a window, 1.05 V A / sqrt 2.
    """
    points = ('motion.route.points.latitude_deg:=[55.0, 57.0]',
              'motion.route.points.longitude_deg:=[37.0, 39.0]', 'motion.route.wind_m_s:=0.0')
    exact, _ = consistency_of(points)
    monkeypatch.setattr(navigator, 'filter_class', lambda name: StampedAtItsEnd)
    stamped, sigma = consistency_of((*points, 'gate_probability:=0.0'))
    low, high = (chi2.ppf(p, 2 * len(exact)) / len(exact) for p in (0.025, 0.975))
    off = 1.05 * 200.0 * np.radians(1.0) / np.sqrt(2.0)
    expected = 2.0 + (off / sigma) ** 2
    print(f'NIS of the mean {exact.mean():.2f} ({low:.2f} to {high:.2f}), stamped at its end '
          f'{stamped.mean():.0f}; expected {expected:.0f}')
    figures.record('consistency.mean.nis', exact.mean(), '', 2.0)
    figures.record('consistency.stamped_at_its_end.nis', stamped.mean(), '', expected)
    assert low < exact.mean() < high
    assert stamped.mean() == pytest.approx(expected, rel=0.25)
    assert stamped.mean() > 40.0


def consistency_of(assignments):
    """Return NIS of the fixes in ten minutes of the study flight, and their lateral sigma, m/s."""
    settings = parameter_files.read_aided(
        [resources.config(name) for name in ('route_flight',)],
        ['duration_s:=600.0', *IMU, *assignments])
    flown, = fly_filters(settings, [FilterCase('eskf', 1000)], 3)
    return flown.nis, 8.7 / np.sqrt(1000.0)


def by_time(entry):
    """Return the sort key of a fix: its instant and its source."""
    return entry[:2]


def consistency(assignments, run):
    """
    Return the results of one run of ten minutes.

    NEES (n,) is taken every minute; NIS, with its degrees of freedom, at every fix.
    """
    settings = parameter_files.read_aided(
        [resources.config(name) for name in ('gnss_outage_flight',)],
        ['duration_s:=600.0', *IMU, *assignments])
    settings = run_settings(settings, run)
    generator = settings.simulation.motion_generator
    motion = make_motion(generator.motion, generator.datum, generator.earth)
    nav, (meter, gnss) = AidedNavigator(settings.aided_navigator), make_instruments(settings)
    nees, nis = [], []
    for imu in imu_blocks(settings.simulation, motion):
        truth = motion.at(imu.t_ns)
        fixes = sorted(((fix.t_ns, source, fix) for source, instrument in (
            (METER, meter), (GNSS, gnss)) for fix in instrument.advance(truth)), key=by_time)
        places = zip(truth.lat.tolist(), truth.lon.tolist(), truth.height.tolist(),
                     truth.v_n.tolist(), truth.q_nb.tolist())
        for t_ns, omega, f, place in zip(imu.t_ns.tolist(), imu.omega.tolist(), imu.f.tolist(),
                                         places):
            while fixes and fixes[0][0] <= t_ns:
                nav.take(*fixes.pop(0)[1:])
            nis += [(t.outcome.nis, t.outcome.freedom) for t in nav.step(t_ns, omega, f, place)
                    if t.outcome.nis is not None]
            if t_ns and t_ns % EVERY_NS == 0:
                turned, velocity, position = level_errors(nav.solution, place)
                error = np.concatenate([position, velocity, turned])[[0, 1, 3, 4, 6, 7, 8]]
                p = nav.filter.covariance[np.ix_(STATES, STATES)]
                nees.append(kalman.normalised_square(error, p))
    return np.array(nees), np.array(nis)


@pytest.mark.slow
@pytest.mark.parametrize('case', CASES)
def test_errors_and_innovations_are_as_large_as_the_filter_says(case, figures):
    """
    NEES of 16 runs at each minute, and NIS of all fixes, are in their 95 % chi-square intervals.

    One of the ten minutes may be outside by chance, as 1 in 20 are. The mean over the minutes must
    be in the interval of a single one, because the errors of successive minutes are correlated.
    """
    found = spread(consistency, [CASES[case]] * RUNS, range(RUNS))
    nees = np.mean([f[0] for f in found], axis=0)
    freedom = len(STATES) * RUNS
    low, high = (chi2.ppf(p, freedom) / RUNS for p in (0.025, 0.975))
    print(f'NEES by minute {np.round(nees, 2)}, mean {nees.mean():.2f}; expected '
          f'{len(STATES)}, interval {low:.2f} to {high:.2f}')
    nis = np.concatenate([f[1] for f in found])
    total, many = nis[:, 0].sum(), nis[:, 1].sum()
    edges = [chi2.ppf(p, many) / many for p in (0.025, 0.975)]
    print(f'NIS per freedom {total / many:.4f} of {len(nis)} fixes, interval {edges[0]:.4f} to '
          f'{edges[1]:.4f}')
    name = f'consistency.{case.replace(" ", "_")}'
    figures.record(f'{name}.nees', nees.mean(), '', len(STATES))
    figures.record(f'{name}.nis', (total / many, *edges))
    outside = ((nees < low) | (nees > high)).sum()
    assert outside <= 1
    assert low < nees.mean() < high
    assert edges[0] < total / many < edges[1]
