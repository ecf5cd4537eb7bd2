"""
The strapdown of 16 runs side by side, in lanes.

The state is one flat array: entry ``i * LANES + l`` is number i of run l, so that the compiler can
process several runs in one instruction. The step is that of the single run, function by function.
If a step is not a small one for every run, or if sines must be recomputed, it is done run by run
with ``mechanization.advance``, as in the single run. Each lane therefore has the bits of its run.
"""

from ins_sim.core.attitude import integration, quaternion
from ins_sim.core.navigation import mechanization
from ins_sim.core.navigation.increments import fixed_rate_increments, integrals
from ins_sim.core.navigation.whole_run import SOLVED

LANES = 16
# Rows of the state of a run: PLACE, q_ib, the integrals of the last sample (up to CARRIED), and
# the increments of the present sample.
PLACES, CARRIED, NUMBERS = 22, 32, 38


def advance(state, spin, start_ns, last_ns, channel, damping, gravity, integrated, t_ns, readings,
            height, v_u, picked, out):
    """
    Advance 16 runs over n samples; return the state.

    Parameters
    ----------
    state : NUMBERS rows of LANES, flat
    spin, start_ns, channel, damping, gravity, integrated, height, v_u : see ``whole_run.solve``
    last_ns : instant of the state, ns
    t_ns : (n,) instants of the samples, ns
    readings : omega and f of each sample, six rows of LANES, flat
    picked : indices of the samples whose solution is written, in ascending order, followed by an
        index that no sample has
    out : SOLVED rows of LANES for each picked sample, flat
    """
    p = 0
    for k in range(len(t_ns)):
        now_ns = t_ns[k]
        dt = (now_ns - last_ns) * 1e-9
        earth_angle = spin * ((last_ns - start_ns) * 1e-9)
        reference = height[k], v_u[k], damping[0], damping[1], damping[2]
        if increments_of(state, readings, 6 * LANES * k, dt, spin, integrated):
            small_steps(state, dt, spin, channel, reference, gravity)
        else:
            for lane in range(LANES):
                any_step(state, lane, dt, spin, earth_angle, channel, reference, gravity)
        last_ns = now_ns
        if k == picked[p]:
            write_solved(state, out, p * SOLVED * LANES)
            p += 1
    return state


def increments_of(state, readings, first, dt, spin, integrated):
    """
    Write rotation vector and velocity increment of a sample, and its integrals, into the state.

    Return whether the next step is a small one for all runs and no sines must be recomputed.

    Parameters
    ----------
    state : NUMBERS rows of LANES, flat
    readings, first : omega and f as in ``advance``, and the index where this sample begins
    dt : length of the interval, s
    spin : rotation rate of the Earth, rad/s
    integrated : whether readings are integrals of the rate (output ``integrated``)
    """
    small, limit = 0, mechanization.TURN / (0.5 * dt)
    for lane in range(LANES):
        i = first + lane
        now = integrals((readings[i], readings[i + LANES], readings[i + 2 * LANES]),
                        (readings[i + 3 * LANES], readings[i + 4 * LANES],
                         readings[i + 5 * LANES]), dt)
        phi, delta_v = now
        if integrated:
            s = 26 * LANES + lane
            last = ((state[s], state[s + LANES], state[s + 2 * LANES]),
                    (state[s + 3 * LANES], state[s + 4 * LANES], state[s + 5 * LANES]))
            phi, delta_v = fixed_rate_increments(integrated, now, last)
            state[s], state[s + LANES], state[s + 2 * LANES] = now[0]
            state[s + 3 * LANES], state[s + 4 * LANES], state[s + 5 * LANES] = now[1]
        s = CARRIED * LANES + lane
        state[s], state[s + LANES], state[s + 2 * LANES] = phi
        state[s + 3 * LANES], state[s + 4 * LANES], state[s + 5 * LANES] = delta_v
        north = state[4 * LANES + lane] * state[15 * LANES + lane]
        east = state[3 * LANES + lane] * state[16 * LANES + lane] + spin
        x, y, z = phi
        small += ((state[7 * LANES + lane] > mechanization.POLAR) & (-limit < north)
                  & (north < limit) & (-limit < east) & (east < limit)
                  & (state[18 * LANES + lane] < mechanization.RENEWED_EVERY)
                  & (x * x + y * y + z * z <= quaternion.SMALL2))
    return small == LANES


def small_steps(state, dt, spin, channel, reference, gravity):
    """Do the step of every run; it must be a small one for all of them."""
    for lane in range(LANES):
        place, q, phi, delta_v = lane_of(state, lane)
        place = mechanization.small_step(place, quaternion.rotate(q, delta_v), dt, spin, channel,
                                         reference, gravity)
        q = quaternion.normalise(quaternion.multiply(q, quaternion.small_exponential(phi)))
        put(state, lane, place, q)


def any_step(state, lane, dt, spin, earth_angle, channel, reference, gravity):
    """Do the step of one run, of any size."""
    place, q, phi, delta_v = lane_of(state, lane)
    place = mechanization.advance(place, q, delta_v, dt, spin, earth_angle, channel, reference,
                                  gravity)
    put(state, lane, place, integration.turn(q, phi))


def lane_of(s, i):
    """Return PLACE, q_ib, rotation vector and velocity increment of run i."""
    return ((s[i], s[LANES + i], s[2 * LANES + i], s[3 * LANES + i], s[4 * LANES + i],
             s[5 * LANES + i], s[6 * LANES + i], s[7 * LANES + i], s[8 * LANES + i],
             s[9 * LANES + i], s[10 * LANES + i], s[11 * LANES + i], s[12 * LANES + i],
             s[13 * LANES + i], s[14 * LANES + i], s[15 * LANES + i], s[16 * LANES + i],
             s[17 * LANES + i], s[18 * LANES + i], s[19 * LANES + i], s[20 * LANES + i],
             s[21 * LANES + i]),
            (s[22 * LANES + i], s[23 * LANES + i], s[24 * LANES + i], s[25 * LANES + i]),
            (s[32 * LANES + i], s[33 * LANES + i], s[34 * LANES + i]),
            (s[35 * LANES + i], s[36 * LANES + i], s[37 * LANES + i]))


def put(s, i, place, q):
    """Write PLACE and q_ib of run i."""
    s[i], s[LANES + i], s[2 * LANES + i] = place[0], place[1], place[2]
    s[3 * LANES + i], s[4 * LANES + i], s[5 * LANES + i] = place[3], place[4], place[5]
    s[6 * LANES + i], s[7 * LANES + i], s[8 * LANES + i] = place[6], place[7], place[8]
    s[9 * LANES + i], s[10 * LANES + i], s[11 * LANES + i] = place[9], place[10], place[11]
    s[12 * LANES + i], s[13 * LANES + i], s[14 * LANES + i] = place[12], place[13], place[14]
    s[15 * LANES + i], s[16 * LANES + i], s[17 * LANES + i] = place[15], place[16], place[17]
    s[18 * LANES + i], s[19 * LANES + i], s[20 * LANES + i] = place[18], place[19], place[20]
    s[21 * LANES + i] = place[21]
    s[22 * LANES + i], s[23 * LANES + i], s[24 * LANES + i], s[25 * LANES + i] = q


def write_solved(state, out, first):
    """Write latitude, longitude, height, velocity and q_ib of every run into out."""
    for lane in range(LANES):
        i = first + lane
        for row in range(6):
            out[i + row * LANES] = state[row * LANES + lane]
        for row in range(4):
            out[i + (6 + row) * LANES] = state[(PLACES + row) * LANES + lane]
