"""Reduced flights agree with the published table and, for small angles, with linear theory."""

import math

import numpy as np
import pytest
from support.guided.lateral_loops import flown, loop, MOST, paper, sliding

from ins_sim.core.guidance.error_loop import fly_reduced, ReducedCases
from ins_sim.core.guidance.linear_loop import growth
from ins_sim.studies.oscillations import frequency, half_range

DEG = math.pi / 180.0


def many(aiding, gains, k_z, duration_s):
    """Return half the range of beta for several cases, deg."""
    cases = ReducedCases(np.array(gains), np.array(k_z), np.full(len(gains), 100.0))
    flights = fly_reduced(loop(), aiding, cases, duration_s, MOST)
    return np.array([half_range(beta) for beta in flights.beta.T]) / DEG


@pytest.mark.parametrize('cycles', [10, 100, 1000])
def test_without_errors_of_the_meter_all_is_quiet(cycles):
    """
    With a perfect meter both kinds of aiding keep beta below 0.05 deg.

    They are sliding conventional with K_v up to 50 1/s, and paper_corrected.
    """
    duration_s = 100.0 if cycles == 10 else 300.0
    slid = many(sliding(cycles, 1.0, 1), [0.001, 0.01, 0.05, 0.5], [0.0] * 4, duration_s)
    corrected = many(paper(cycles, 1.0), [0.1, 0.344, 1.0, 1.9], [0.0] * 4, duration_s)
    print(slid, corrected)
    assert slid.max() < 0.05 and corrected.max() < 0.05


@pytest.mark.parametrize('cycles, k_v, k_z, beta, omega, z', [
    (100, 1.0, 0.15, 4.3, 0.345, None), (100, 1.0, 0.17, 8.0, 0.318, 31.0),
    (10, 1.0, 0.15, 8.0, 0.557, 10.0), (100, 5.0, 0.15, 8.0, None, None),
    (100, 1.0, 0.30, 8.0, None, None)])
def test_published_oscillations(cycles, k_v, k_z, beta, omega, z):
    """
    Oscillations agree with the published ones within 3 %.

    Commands are interpolated linearly here, and held in the publication.
    """
    flight = flown(sliding(cycles, k_v), k_z)
    found = half_range(flight.beta[:, 0]) / DEG
    assert found == pytest.approx(beta, rel=0.03)
    if omega is not None:
        assert frequency(flight.t_s, flight.beta[:, 0]) == pytest.approx(omega, rel=0.03)
    if z is not None:
        assert half_range(flight.z[:, 0]) == pytest.approx(z, rel=0.03)


def test_slow_aiding_is_quiet_and_ten_metres_off():
    """With K_v of 0.2 1/s and less beta stays below 0.05 deg and z is -10 m."""
    flight = flown(sliding(100, 0.2), 0.15)
    assert half_range(flight.beta[:, 0]) < 0.05 * DEG
    assert flight.z[-1, 0] == pytest.approx(-10.0, rel=0.03)


def test_paper_corrected_leaves_the_leg_quietly():
    """
    paper_corrected keeps a velocity error of -k_z V mean(beta) of its first window.

    The vehicle ends 347 m off the leg; engaged 20 s later, less than 5 cm.
    """
    aiding = paper(1000, 0.344)
    flight = flown(aiding, 0.15)
    assert half_range(flight.beta[:, 0]) < 0.05 * DEG
    assert abs(flight.error_v[-1, 0]) == pytest.approx(1.25, rel=0.01)
    assert flight.z[-1, 0] == pytest.approx(347.0, rel=0.01)
    late = flown(aiding, 0.15, engaged_s=20.0)
    assert abs(late.z[-1, 0]) < 0.05


def test_a_large_start_diverges_where_a_small_one_is_quiet():
    """
    From z0 = 100 m paper_corrected oscillates at its limit; from 10 m it is quiet.

    The case N = 1000, K = 1, k_z = 0.3 is linearly stable.
    """
    assert half_range(flown(paper(1000, 1.0), 0.30).beta[:, 0]) == pytest.approx(MOST, rel=0.01)
    assert half_range(flown(paper(1000, 1.0), 0.30, 10.0).beta[:, 0]) < 0.05 * DEG


@pytest.mark.parametrize('aiding, k_z', [(sliding(100, 1.0), 0.15), (sliding(10, 1.0, 1), 0.145),
                                         (paper(100, 0.344), 0.19)])
def test_small_flights_grow_as_the_linear_theory_says(aiding, k_z):
    """Flights from 1 cm grow as predicted between two instants 120 s apart, within 1e-3 1/s."""
    mode = growth(loop(), aiding, k_z)
    flight = flown(aiding, k_z, offset=0.01, duration_s=300.0)
    sizes = [np.abs(flight.beta[a:a + 400, 0]).max() for a in (1400, 2600)]
    assert math.log(sizes[1] / sizes[0]) / 120.0 == pytest.approx(mode.growth, abs=1e-3)


def test_latency_that_no_loop_bears():
    """
    With a latency of 0.2 s there is a limit cycle of 4.4 rad/s even with a perfect meter.

    The case is N = 100, K_v = 1.
    """
    flight = flown(sliding(100, 1.0), 0.0, offset=1.0, latency=20)
    assert half_range(flight.beta[:, 0]) > 4.0 * DEG
    quiet = flown(sliding(100, 1.0), 0.0, offset=1.0, latency=10)
    assert half_range(quiet.beta[:, 0]) < 0.01 * DEG
