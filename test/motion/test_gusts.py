"""Gusts: variance, spectrum, independence of seeds and axes, and displacement."""

import math

from support.flown import gust_velocity, GUSTS, instants, route
import numpy as np
from scipy.integrate import quad
from scipy.signal import welch

from ins_sim.core.motion.route.gusts import Gusts, HIGHEST, LINES, LOWEST
from ins_sim.core.numerics import elementary

SIGMA, LENGTH, AIRSPEED = 0.5, 500.0, 200.0
TAU = LENGTH / AIRSPEED
SEEDS = range(200)


def velocity(gusts, t):
    """Return East, North, Up (n, 3), m/s."""
    return np.stack([d.derivative().value for d in gusts.displacement(t)], axis=-1)


def test_variance_and_distance():
    """
    In every hour each axis has its standard deviation within 1/LINES, and moves by 40 m at most.

    This holds for 24 seeds.
    """
    t = np.arange(0.0, 3600.0, 0.1)
    rms, far = [], []
    for seed in range(24):
        gusts = Gusts(SIGMA, LENGTH, AIRSPEED, seed)
        rms.append(np.sqrt((velocity(gusts, t) ** 2).mean(axis=0)))
        far.append([np.abs(d.value).max() for d in gusts.displacement(t)])
        # Bound: the sum of the amplitudes.
        assert (np.array(far[-1]) <= (gusts.amplitude / gusts.rates).sum(axis=1)).all()
    rms, far = np.array(rms), np.array(far)
    print(f'\n24 seeds, one hour: rms {rms.min():.4f} to {rms.max():.4f} m/s (0.5), displaced by '
          f'{far.min():.1f} to {far.max():.1f} m at most')
    # Frequencies are drawn at a distance, except for neighbours: a pair in phase has 2/LINES of
    # the variance in addition, as much as the two lines alone.
    assert np.abs(rms / SIGMA - 1.0).max() < 1.0 / LINES
    assert far.max() < 40.0


def test_spectrum_is_of_first_order():
    """Correlation and spectrum, averaged over seeds, agree with the truncated density."""
    rates = np.array([Gusts(SIGMA, LENGTH, AIRSPEED, s).rates for s in SEEDS]).ravel()
    span = math.atan(HIGHEST) - math.atan(LOWEST)
    worst = 0.0
    for lag in (0.5, 1.0, 2.5, 5.0, 10.0):
        values = np.cos(rates * lag)
        expected = quad(lambda w: math.cos(w * lag) * TAU / (1.0 + (w * TAU) ** 2) / span,
                        LOWEST / TAU, HIGHEST / TAU, limit=500)[0]
        # The frequencies of a seed are stratified: the mean errs less than for independent ones.
        sigmas = abs(values.mean() - expected) / (values.std() / math.sqrt(len(values)))
        print(f'\nlag {lag:g} s: correlation {values.mean():.4f}, density {expected:.4f}, '
              f'exp(-t/tau) {math.exp(-lag / TAU):.4f}', end='')
        worst = max(worst, sigmas)
        # The truncation removes 6 % of the variance.
        assert abs(expected - math.exp(-lag / TAU)) < 0.065
    assert worst < 4.0
    t, dt = np.arange(0.0, 2000.0, 0.1), 0.1
    power = np.mean([welch(velocity(Gusts(SIGMA, LENGTH, AIRSPEED, s), t), 1.0 / dt, nperseg=4000,
                           axis=0)[1].mean(axis=1) for s in range(40)], axis=0)
    f = np.fft.rfftfreq(4000, dt)
    print('\noctave, Hz: simulated over sigma^2 4 tau/(1 + (2 pi f tau)^2)')
    for low in (0.0125, 0.025, 0.05, 0.1, 0.2, 0.4):
        band = (f >= low) & (f < 2.0 * low)
        model = SIGMA ** 2 * 4.0 * TAU / (1.0 + (2.0 * math.pi * f[band] * TAU) ** 2)
        ratio = power[band].sum() / model.sum()
        print(f'{low:g} to {2 * low:g}: {ratio:.3f}')
        # The truncated variance is redistributed inside. The standard deviation is that of half a
        # line of each component of 120, in or out of the octave, because lines are stratified.
        lines = LINES / span * np.diff(np.arctan(2.0 * math.pi * TAU * np.array((1, 2)) * low))[0]
        assert abs(ratio / (0.5 * math.pi / span) - 1.0) < 4.0 * 0.5 / lines / math.sqrt(120)


def test_axes_and_seeds_are_independent():
    """Correlations between axes and between seeds are those of independent processes."""
    t = np.arange(0.0, 3000.0, 0.1)
    flights = [velocity(Gusts(SIGMA, LENGTH, AIRSPEED, seed), t) for seed in range(12)]
    all_axes = np.concatenate(flights, axis=1) / SIGMA
    correlation = all_axes.T @ all_axes / len(t) - np.eye(36)
    off = np.sqrt((correlation[~np.eye(36, dtype=bool)] ** 2).mean())
    # The mean of the product of two has the variance tau/T; the density is raised to replace the
    # truncated part. Bound: four standard deviations of the rms of 630.
    expected = 0.5 * math.pi / (math.atan(HIGHEST) - math.atan(LOWEST)) * math.sqrt(TAU / 3000.0)
    print(f'\nrms correlation of 630 pairs {off:.4f}, independent {expected:.4f}')
    assert off < expected * (1.0 + 4.0 / math.sqrt(2 * 630))


def test_the_flight_has_its_gusts():
    """The seed determines the flight, and the gusts are part of the velocity."""
    motion, calm = route(GUSTS), route()
    t_ns = instants(motion, 1.0)
    truth, still = motion.at(t_ns), calm.at(t_ns)
    other = route(GUSTS, gust_seed=1).at(t_ns)
    assert (route(GUSTS).at(t_ns).v_n == truth.v_n).all()
    assert np.abs(other.v_n - truth.v_n).max() > 0.5
    difference = truth.v_n - still.v_n - gust_velocity(motion, t_ns)
    print(f'\nvelocity less calm velocity less gust: {np.abs(difference).max():.1e} m/s')
    # 40 m of displacement in axes that rotate at 5e-5 rad/s.
    assert np.abs(difference).max() < 2e-3
    rms = np.sqrt((gust_velocity(motion, t_ns) ** 2).mean(axis=0))
    assert np.abs(rms - 0.5).max() < 0.05


def test_any_cutting_gives_the_same_bits():
    """One, two or a thousand instants per call, and separate sinusoids, give the same bits."""
    gusts = Gusts(SIGMA, LENGTH, AIRSPEED, 3)
    t = np.arange(1000) * 0.0137
    whole = np.array([axis.c for axis in gusts.displacement(t)])
    edges = [0, 1, 1, 2, 4, 260, 517, 774, 1000]
    parts = [np.array([axis.c for axis in gusts.displacement(t[a:b])])
             for a, b in zip(edges, edges[1:])]
    np.testing.assert_array_equal(np.concatenate(parts, axis=2), whole)
    alone = np.zeros(1000)
    for w, phase in zip(gusts.rates[1].tolist(), gusts._phases[1].tolist()):
        alone += elementary.sin(t * w + phase) * (gusts.amplitude / w)
    np.testing.assert_array_equal(alone, whole[1, 0])
