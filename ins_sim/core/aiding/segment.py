"""Advance the strapdown and the sums of a filter over uncorrected samples, in one loop."""

from collections.abc import Callable
from typing import NamedTuple

from ins_sim.core.numerics import compilation
from . import corrected_strapdown
from .velocity_window import sums_after

# Number of values per sample that the loop writes: latitude, longitude, height, v_n, q_nb.
ROW = 10


def fly(constants, biases, carry, sums, columns, first, stop, out):
    """
    Advance over the samples from first to stop, stop excluded; return carry and sums.

    Parameters
    ----------
    constants, biases, carry : see ``corrected_strapdown.take_reading``
    sums : a plain tuple of the fields of ``velocity_window.WindowSums``
    columns : see ``Samples``
    first, stop : range of samples
    out : flat array, receives ROW floats for each sample; or None

    """
    t_ns, omega, f, height, up = columns
    for k in range(first, stop):
        last_ns, last, _, q_start, v_start, _, _ = carry
        before, j = (q_start, v_start, (last[3], last[4], last[5])), 3 * k
        carry, delta_v = corrected_strapdown.take_reading(
            constants, biases, carry, t_ns[k], (omega[j], omega[j + 1], omega[j + 2]),
            (f[j], f[j + 1], f[j + 2]), height[k], up[k])
        now_ns, place, _, q_nb, v_b, rate, _ = carry
        v = (place[3], place[4], place[5])
        sums = sums_after(*sums, before, (q_nb, v_b, v), (place[0], place[1], place[2]), rate,
                          delta_v, (now_ns - last_ns) * 1e-9)
        if out is not None:
            i = ROW * k
            out[i], out[i + 1], out[i + 2] = place[0], place[1], place[2]
            out[i + 3], out[i + 4], out[i + 5] = v
            out[i + 6], out[i + 7], out[i + 8], out[i + 9] = q_nb
    return carry, sums


class Samples(NamedTuple):
    """
    Readings of an IMU in columns, and the loop that advances over them.

    Attributes
    ----------
    t_ns : list of the n stamps
    columns : flat arrays or lists of stamps (n,), angular rates (3 n,) rad/s, specific forces
        (3 n,) m/s^2, true heights (n,) m and true vertical velocities (n,) m/s
    fly : ``fly`` or its compiled copy

    """

    t_ns: list
    columns: tuple
    fly: Callable

    def sample(self, k):
        """Return t_ns, omega, f, height and vertical velocity of a sample."""
        _, omega, f, height, up = self.columns
        j = 3 * k
        return (self.t_ns[k], (float(omega[j]), float(omega[j + 1]), float(omega[j + 2])),
                (float(f[j]), float(f[j + 1]), float(f[j + 2])), float(height[k]), float(up[k]))


def samples_of(t_ns, omega, f, height, up):
    """Return Samples from arrays: t_ns (n,) int64, omega and f (n, 3), height and up (n,)."""
    columns = tuple(a.ravel() for a in (t_ns, omega, f, height, up))
    fast = compilation.compiled_if_it_pays(fly, len(t_ns))
    if fast is None:
        return Samples(t_ns.tolist(), tuple(a.tolist() for a in columns), fly)
    return Samples(t_ns.tolist(), columns, fast)


def one_sample(t_ns, omega, f, height, up):
    """Return Samples of a single reading: stamp, tuples of rates and forces, and floats."""
    return Samples([t_ns], ([t_ns], omega, f, (height,), (up,)), fly)
