"""The curves of the truth adapter: stencils, fits, pieces, and the readings from them."""

import math

from hypothesis import given, strategies as st
import numpy as np
import pytest
from support.other_simulators import MOTIONS, OtherSimulator

from ins_sim.core.attitude import quaternion
from ins_sim.core.earth.frames import MapFrame
from ins_sim.core.streams.adapter.fit import KnotFit, parabola_weights
from ins_sim.core.streams.adapter.knots import Sample
from ins_sim.core.streams.adapter.piece import derivatives, Piece, rate_of
from ins_sim.core.streams.adapter.pose_knots import PoseKnots, quintic
from ins_sim.core.streams.adapter.sensed import sensed
from ins_sim.core.streams.adapter.stencils import POINTS, stencil, weighted
from ins_sim.core.streams.adapter.twist_knots import TwistKnots

STEP = 20_000_000


@given(st.lists(st.integers(STEP // 2, 2 * STEP), min_size=4, max_size=4), st.integers(0, 4),
       st.lists(st.floats(-10.0, 10.0), min_size=5, max_size=5))
def test_a_stencil_is_exact_for_a_quartic(steps, node, c):
    """Five unevenly spaced samples give both derivatives of a quartic to rounding."""
    t = (np.cumsum([0, *steps]) - sum(steps[:node])) * 1e-9
    values = [(np.polyval(c, x), 0.0, 0.0) for x in t]
    first, second = (weighted(w, values, values[node])[0] for w in stencil(tuple(steps), node))
    # Rounding of a value of at most 50 divided by the square of the shortest step.
    assert first == pytest.approx(c[3], abs=1e-10)
    assert second == pytest.approx(2.0 * c[2], abs=1e-7)


@given(st.lists(st.integers(1, 10), min_size=1, max_size=10),
       st.lists(st.integers(1, 10), min_size=1, max_size=10))
def test_a_parabola_is_fitted_as_by_least_squares(before, behind):
    """The weights of the parabola give the same value at zero as numpy.polyfit."""
    x = np.array([*-np.cumsum(before), 0, *np.cumsum(behind)]) * 1e-3
    values = np.sin(40.0 * x)
    assert np.dot(parabola_weights(x.tolist()), values) == pytest.approx(
        np.polyfit(x, values, 2)[2], abs=1e-9)


@pytest.mark.parametrize('x', [[0.0], [0.0, 0.1], [0.0, 0.1, 0.2], [-0.2, -0.1, 0.0]])
def test_a_value_with_one_side_is_not_fitted(x):
    """With samples on one side only, or too few, the sample itself is used."""
    assert parabola_weights(x) == [float(s == 0.0) for s in x]


def test_a_quintic_has_its_ends():
    """The quintic has the given value, slope and second derivative at both ends."""
    given_values = (1.0, -2.0, 3.0, 1.5, 0.5, -4.0)
    c = quintic(0.05, *given_values)
    assert derivatives(c, 0.0) == pytest.approx(given_values[:3])
    assert derivatives(c, 0.05) == pytest.approx(given_values[3:])


@given(st.lists(st.floats(-1.0, 1.0), min_size=6, max_size=6))
def test_the_rate_is_that_of_the_attitude(numbers):
    """The rate of a rotation vector equals the difference of neighbouring attitudes."""
    phi, phi_rate, d = numbers[:3], numbers[3:], 1e-5
    before, after = (quaternion.exponential(tuple(p + s * d * r for p, r in zip(phi, phi_rate)))
                     for s in (-1.0, 1.0))
    turned = quaternion.logarithm(quaternion.multiply(quaternion.conjugate(before), after))
    # Central differences have an error of d^2 / 6 times a third derivative of at most 10.
    assert rate_of(tuple(phi), tuple(phi_rate)) == pytest.approx(
        [x / (2.0 * d) for x in turned], abs=2e-9)


@pytest.mark.parametrize('make', [PoseKnots, lambda: TwistKnots(False, 0.5)],
                         ids=['poses', 'twist'])
@pytest.mark.parametrize('name', ['aggressive', 'motion_2'])
def test_pieces_join(make, name):
    """Position, velocity, acceleration, attitude and rate are continuous from piece to piece."""
    knots, pieces = make(), []
    for row in OtherSimulator(name, 20.0, 2.0).noisy(1e-3, 0.01, 1e-3, 0.01).samples():
        pieces.append(knots.push(Sample(*row)))
    pieces = [piece for piece in pieces if piece is not None]
    assert isinstance(pieces[0], Piece) and len(pieces) > 30
    for one, other in zip(pieces, pieces[1:]):
        assert one.end_ns == other.start_ns
        for tolerance, a, b in zip((1e-9, 1e-9, 1e-7, 1e-12, 1e-6), one.at(one.end_ns),
                                   other.at(other.start_ns)):
            assert a == pytest.approx(b, abs=tolerance)


@pytest.mark.parametrize('make, rate_hz', [
    (PoseKnots, 20.0), (lambda: TwistKnots(False, 0.5), 20.0),
    (lambda: TwistKnots(True, 0.5), 20.0)])
def test_it_is_late_by_at_most_three_periods(make, rate_hz):
    """A piece is available with the sample three periods after its start."""
    knots = make()
    simulator = OtherSimulator('sinusoids', rate_hz, 2.0)
    for row in simulator.samples():
        piece = knots.push(Sample(*row))
        assert piece is None or row[0] - piece.start_ns == 3 * round(1e9 / rate_hz)
    assert piece is not None


def test_a_dense_input_is_fitted_at_knots():
    """In a dense input every fourth sample is a knot, half a window later and less noisy."""
    simulator = OtherSimulator('motion_1', 400.0, 20.0).noisy(1e-3, 0.01)
    fit = KnotFit(4, 5_000_000, 2_500_000)
    knots = [knot for row in simulator.samples() for knot in fit.push(Sample(*row))]
    stamps = [knot.t_ns for knot in knots]
    assert set(np.diff(stamps)) == {10_000_000}
    exact = np.array(OtherSimulator('motion_1', 400.0, 20.0).r)[::4][:len(knots)]
    noise = np.std(np.array([knot.r for knot in knots])[1:] - exact[1:])
    # A parabola through five samples leaves sqrt(17 / 35) of the noise in the middle.
    assert noise == pytest.approx(1e-3 * math.sqrt(17 / 35), rel=0.05)


@pytest.mark.parametrize('name', MOTIONS)
def test_an_imu_senses_what_the_motion_says(name):
    """Force and rate of an exact pose with exact derivatives equal those of the closed form."""
    simulator = OtherSimulator(name, 1.0, 300.0)
    frame = MapFrame(simulator.settings.motion_generator.datum, True)
    for k in (10, 200):
        t_ns = int(simulator.t_ns[k])
        true = simulator.motion.at(np.array([t_ns]))
        # Acceleration in the map frame from differences of the velocity in the map frame.
        d = 20_000_000
        v = [quaternion.rotate(q.T, tuple(v.T)) for _, q, v, _ in (
            simulator._odometry(np.array([t_ns + s * d])) for s in (-2, -1, 1, 2))]
        a = tuple(float(x) for x in (np.array(v[0]) - 8 * np.array(v[1]) + 8 * np.array(v[2])
                                     - np.array(v[3]))[:, 0] / (12 * d * 1e-9))
        r, q, v_b, w = (tuple(x[k].tolist()) for x in (simulator.r, simulator.q, simulator.v,
                                                       simulator.w))
        found = sensed(frame, None, t_ns, (r, quaternion.rotate(q, v_b), a, q, w))
        assert found.omega_ib_b == pytest.approx(true.omega_ib_b[0].tolist(), abs=1e-15)
        # The differences have an error of d^4 / 30 times a fifth derivative: 1e-6 at 1 m and 0.4
        # Hz.
        assert found.f_ib_b == pytest.approx(true.f_ib_b[0].tolist(), abs=3e-6)
        assert found.height == pytest.approx(float(true.height[0]), abs=1e-8)


def test_a_stencil_is_that_of_five():
    """The middle node of the stencil has the index that the schemes use."""
    assert stencil((STEP,) * (POINTS - 1), 2)[0] == pytest.approx(
        [x / (12 * 0.02) for x in (1, -8, 0, 8, -1)], abs=1e-9)
