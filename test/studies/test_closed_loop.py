"""
The study of the closed loop: flights of the complete simulation, published and reduced ones.

The table takes half an hour and is computed by ``make figures``. The everyday test shows that the
reduced flights, which ``test_error_loop`` compares with published ones, equal complete ones.
"""

from functools import partial
import math

import numpy as np
import pytest
from support.studies import spread

from ins_sim import parameter_files, resources
from ins_sim.core.guidance.error_loop import fly_reduced, ReducedCases
from ins_sim.report.studies.closed_loop import loop_row
from ins_sim.studies.closed_loop import (aiding_of, AT_THE_LIMIT, cases_near, CONDITIONS,
                                         flown_limits, fly_case, growth_of_flight,
                                         lateral_flight, linear_limits, LoopCase, LoopFlight,
                                         QUIET_DEG, study_loop, TABLE, VARIED)
from ins_sim.studies.oscillations import frequency, growth_rate, half_range
from ins_sim.studies.stability_map import map_curves, MapPanel

MOST = math.radians(8.0)


def chosen(*assignments):
    """Return the settings of the study."""
    return parameter_files.read_aided([resources.config('guided_flight')], assignments)


def reduced(loop, case):
    """Return the reduced LoopFlight of a LoopCase with both channels."""
    aiding = aiding_of(case, 100.0)
    cases = ReducedCases(*(np.array([x]) for x in (aiding.gain, case.k_z, case.offset_m)))
    flown = fly_reduced(loop, aiding, cases, case.duration_s, MOST, case.engage_s)
    return LoopFlight(flown.t_s, flown.z[:, 0], flown.beta[:, 0], flown.z[:, 0])


@pytest.mark.parametrize('case, bound', [
    (LoopCase(0.17, 'conventional', 100, 1.0, True, duration_s=20.0), 1e-5),
    (LoopCase(0.15, 'paper_corrected', 100, 0.344, duration_s=20.0), 1e-4)], ids=str)
def test_the_chain_is_the_reduced_loop(case, bound):
    """
    Complete and reduced flights agree to 1e-5 rad in sideslip and 1 cm in offset.

    The flights last 20 s from 100 m. The reduced loop neglects terms of that size: the Coriolis
    force on velocity errors of metres per second, 3e-4 m/s^2, and the curvature of the leg.
    paper_corrected sees both as acceleration errors, ten times as large.
    """
    settings = chosen()
    flight, other = fly_case(settings, case), reduced(study_loop(settings), case)
    beta, z = (np.abs(a - b).max() for a, b in ((flight.beta, other.beta), (flight.z, other.z)))
    print(f'{case.label}: beta within {beta:.1e} rad, z within {1e3 * z:.1f} mm')
    assert len(flight.t_s) == len(other.t_s) == 201
    assert beta < bound and z < 0.01


@pytest.mark.slow
def test_the_map_is_that_of_the_linear_theory_where_nothing_saturates():
    """From 1 m limits are linear within 1 %; from 100 m, with a limited command, not higher."""
    panel = MapPanel('conventional', 100, True, 0.5, 5.0)
    curves = map_curves(study_loop(chosen()), panel, 3, MOST)
    print(curves)
    np.testing.assert_allclose(curves.flown[1.0], curves.linear, rtol=0.01, atol=2.0 ** -9)
    assert (curves.flown[100.0] <= 1.02 * curves.linear).all()


def test_what_is_measured_of_an_oscillation():
    """Range, frequency and growth of a known oscillation are measured."""
    t = np.arange(0.0, 300.0, 0.1)
    x = np.exp(-0.005 * t) * np.cos(0.345 * t + 0.3)
    assert frequency(t, x) == pytest.approx(0.345, rel=1e-3)
    assert growth_rate(t, x) == pytest.approx(-0.005, abs=2e-5)
    assert half_range(np.cos(0.345 * t)) == pytest.approx(1.0, abs=1e-3)
    assert frequency(t, np.zeros(len(t))) is None
    with pytest.raises(ValueError, match='the oscillation has 0 peaks; expected at least 3'):
        growth_rate(t, t)


def case_name(case):
    """Return filter, N and gain of a LoopCase as part of the name of a figure."""
    return f'{"sliding" if case.slides else case.filter}.{case.cycles}.{case.gain:g}'


def figure_name(case):
    """Return the name under which the results of a LoopCase are recorded."""
    others = (('from', case.offset_m, 100.0), ('engaged', case.engage_s, 0.0),
              ('for', case.duration_s, 300.0))
    return '.'.join([f'closed_loop.{case_name(case)}.k_z_{case.k_z:g}', *(
        f'{word}_{value:g}' for word, value, usual in others if value != usual)])


@pytest.mark.figures
def test_the_table(figures):
    """
    Every published row: quiet cases stay below 0.05 deg, others agree within 3 %.

    The published simulation has the lateral channel alone and is compared with that. The filters
    aid the forward velocity as well, which damps conventional a little where beta is large: the
    complete simulation is compared with the reduced flight with both channels.
    """
    settings = chosen()
    loop = study_loop(settings)
    flights = spread(partial(fly_case, settings), TABLE)
    for case, flight in zip(TABLE, flights):
        lateral = lateral_flight(settings, loop, case)
        row = loop_row(case, flight, lateral)
        print(row)
        name = figure_name(case)
        if lateral is not None:
            figures.record(f'{name}.lateral_deg', lateral.beta_deg, 'deg',
                           row.published.get('beta_deg'), f'{case.label}, lateral channel alone')
        for figure, unit in (('beta_deg', 'deg'), ('swing_m', 'm'), ('end_m', 'm')):
            figures.record(f'{name}.{figure}', getattr(row, figure), unit,
                           row.published.get(figure), f'{case.label}, k_z {case.k_z:g}')
        if case.published is None:
            continue
        if case.published.beta_deg == 0.0:
            assert row.beta_deg < QUIET_DEG
        if lateral is None:
            continue
        both = loop_row(case, reduced(loop, case))
        # Over half an hour the Schuler acceleration, which paper_corrected follows some windows
        # late, changes the velocity error by 4 %.
        near = 0.03 if case.duration_s <= 300.0 else 0.05
        for figure, value in row.published.items():
            if value == 0.0 and figure == 'beta_deg':
                assert row.lateral[figure] < QUIET_DEG
                continue
            # Within 5 cm the vehicle is on the leg.
            assert abs(row.lateral[figure]) == pytest.approx(abs(value), rel=0.03, abs=0.05)
            assert getattr(row, figure) == pytest.approx(getattr(both, figure), rel=near, abs=0.05)


@pytest.mark.figures
def test_limits_of_the_chain_are_the_linear_ones(figures):
    """
    Limits by the growth of flights 2 % on either side agree with the linear ones to 1 %.

    The flights start 1 m off the leg.
    """
    settings = chosen()
    linear = linear_limits(study_loop(settings))
    growths = spread(partial(growth_of_flight, settings), cases_near(linear))
    for case, limit, flown in zip(AT_THE_LIMIT, linear, flown_limits(linear, growths)):
        print(f'{case.label}: linear {limit.k_z:.4f}, flown {flown:.4f}')
        figures.record(f'closed_loop.limit.{case_name(case)}', flown / limit.k_z, '', 1.0,
                       'linear theory')
        assert flown == pytest.approx(limit.k_z, rel=0.01)


@pytest.mark.figures
def test_conditions_change_nothing_of_it(figures):
    """Under all conditions fast conventional oscillates by degrees, the others do not."""
    for name, more in CONDITIONS.items():
        flights = spread(partial(fly_case, chosen(*more)), VARIED)
        found = [flight.beta_deg for flight in flights]
        print(name, found)
        figures.record(f'closed_loop.{name}.beta', found, 'deg')
        assert found[0] > 2.5 and found[0] > 2.0 * max(found[1:])
