"""Blocks of a pair of tuned gyros give the bits of single steps, however they are cut."""

import numpy as np
import pytest
from support.pairs import instrument

from ins_sim.core.numerics import compilation
from ins_sim.core.streams.faults import StreamFault

ERRORS, OUT, FAULT = 'gyro.dtg.errors.', 'gyro.errors.', 'gyro.dtg.fault.'
ROTORS = {
    ERRORS + 'mass_unbalance_deg_h_g': [0.5, 0.4, 0.3, 0.2],
    ERRORS + 'quadrature_unbalance_deg_h_g': [0.1] * 4, ERRORS + 'spin_axis_deg_h_g': [0.2] * 4,
    ERRORS + 'anisoelastic_deg_h_g2': [0.01] * 4, ERRORS + 'speed_ppm': [5.0, -5.0],
    ERRORS + 'pickoff_offset_urad': [1.0, 2.0, 3.0, 4.0],
    ERRORS + 'pickoff_noise_urad_sqrt_s': [0.05] * 4, ERRORS + 'hunting_ppm': [20.0, 10.0],
    ERRORS + 'spin_rate_product': 1.0, ERRORS + 'vibration_2n_deg_s': [1.0, 0.5]}
READ_OUT = {
    OUT + 'angle_random_walk_deg_sqrt_h': [0.01] * 3, OUT + 'quantisation_arcsec': [0.3] * 3,
    OUT + 'bandwidth_hz': [80.0] * 3, OUT + 'gauss_markov_sigma_deg_h': [0.1] * 3,
    OUT + 'misalignment_sigma_mrad': [0.2] * 3, OUT + 'g_sensitivity_deg_h_g': [0.1] * 3}
BROKEN = {FAULT + 'channel': 'gyro_1_y', FAULT + 'bias_deg_h': 100.0, FAULT + 'scale': 0.5,
          FAULT + 'start_s': 1.0, FAULT + 'end_s': 2.5}
SETTINGS = {
    'bare': {}, 'open loop': {'gyro.dtg.preset': 'sapegin_2016_damped'}, 'rotors': ROTORS,
    'product alone': {ERRORS + 'spin_rate_product': 1.0},
    'hunting alone': {ERRORS + 'hunting_ppm': [20.0, 10.0]},
    'everything, turned': {**ROTORS, **READ_OUT, **BROKEN, 'gyro.dtg.arrangement': 'turned'},
    'three steps': {**ROTORS, **READ_OUT, **BROKEN, 'gyro.dtg.steps_per_sample': 3},
    'RK4': {**ROTORS, 'gyro.dtg.preset': 'sapegin_2016', 'gyro.dtg.method': 'rk4',
            'gyro.dtg.steps_per_sample': 13}}
COUNT = 300


@pytest.fixture(params=['plain', 'compiled'])
def loops(request, monkeypatch):
    """Run the loops in plain Python, or compiled from the first sample on."""
    if request.param == 'compiled':
        pytest.importorskip('numba')
    monkeypatch.setattr(compilation, 'PLAIN_SAMPLES', 0 if request.param == 'compiled' else 10**9)


def inputs(nodes):
    """Return stamps, rates at the nodes, and specific forces for COUNT sampling periods."""
    rng = np.random.default_rng(5)
    return (10_000_000 * np.arange(1, COUNT + 1), rng.normal(size=(COUNT, nodes, 3)),
            10.0 * rng.normal(size=(COUNT, 3)))


def stepped(one, t_ns, rates, force):
    """Return rates and parities computed sample by sample."""
    found = [one.step(*sample) for sample in zip(
        t_ns.tolist(), [list(map(tuple, w)) for w in rates.tolist()],
        map(tuple, force.tolist()))]
    return np.array([w for w, _ in found]), np.array([parity for _, parity in found])


@pytest.mark.parametrize('name', SETTINGS)
def test_blocks_are_the_steps(name, loops):
    """Rates, parity and final state of random blocks equal those of single steps."""
    one, other = instrument(SETTINGS[name]), instrument(SETTINGS[name])
    t_ns, rates, force = inputs(len(one.nodes))
    for each in (one, other):
        each.settle(tuple(rates[0, 0].tolist()))
    omega, parity = stepped(one, t_ns, rates, force)
    cuts = [0, *sorted(set(np.random.default_rng(2).integers(1, COUNT, 6).tolist())), COUNT]
    parts = [other.advance(t_ns[a:b], rates[a:b], force[a:b]) for a, b in zip(cuts, cuts[1:])]
    assert np.array_equal(np.concatenate([part[0] for part in parts]), omega)
    assert np.array_equal(np.concatenate([part[1] for part in parts]), parity)
    assert one.pair.state == other.pair.state
    # A step after the blocks continues from their final state.
    last = 10_000_000 * (COUNT + 1), [(0.1, 0.2, 0.3)] * len(one.nodes), (1.0, 2.0, 3.0)
    assert one.step(*last) == other.step(*last)


def test_a_forced_fault_holds_through_a_block(loops):
    """A fault that was forced persists through a block, whatever its schedule."""
    one, other = instrument(BROKEN), instrument(BROKEN)
    t_ns, rates, force = inputs(3)
    for on in (True, False):
        one.force_fault(on)
        other.force_fault(on)
        omega, parity = stepped(one, t_ns, rates, force)
        block = other.advance(t_ns, rates, force)
        assert np.array_equal(block[0], omega) and np.array_equal(block[1], parity)


def test_a_block_ends_where_the_rotors_run_away(loops):
    """A block ends before the sample at which the rotors diverge, with the fault of a step."""
    unstable = {**READ_OUT, 'gyro.dtg.preset': 'sapegin_2016', 'gyro.dtg.on_unstable': 'warn'}
    with pytest.warns(UserWarning, match='unstable'):
        one, other = instrument(unstable), instrument(unstable)
    t_ns, rates, force = inputs(3)
    # The nutation grows by exp(0.0745) per sample.
    one.pair.state = other.pair.state = ((1e303, 0.0, 1e303, 0.0),) * 2
    omega, parity, fault = other.advance(t_ns, rates, force)
    count = len(omega)
    assert 0 < count < COUNT and len(parity) == count and fault.restart
    expected = stepped(one, t_ns[:count], rates[:count], force[:count])
    assert np.array_equal(omega, expected[0]) and np.array_equal(parity, expected[1])
    for _ in range(2):
        with pytest.raises(StreamFault) as raised:
            stepped(one, t_ns[count:], rates[count:], force[count:])
        assert str(raised.value) == str(fault)
        omega, parity, fault = other.advance(t_ns[count:], rates[count:], force[count:])
        assert omega.shape == (0, 3) and parity.shape == (0,)
