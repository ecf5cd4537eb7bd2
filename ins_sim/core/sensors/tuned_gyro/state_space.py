"""
The dynamically tuned gyro as a linear system: state space, transfer function and roots.

Matrices are computed in a fixed order of operations (`core.numerics.fixed_order`), because the
bits of the readings depend on them.
"""

from dataclasses import dataclass
from functools import cached_property
import math

import numpy as np

from ins_sim.core.numerics.fixed_order import product
from .rotor import loop_gains

ITERATIONS = 300


@dataclass(frozen=True)
class StateSpace:
    """
    The gyro as x' = F x + g u, reading = c x + d u, complex; for theta, u and v see ``rotor``.

    Attributes
    ----------
    f, g, c, d : (m, m), (m,), (m,) and a scalar for m states x = (theta, v) or, in closed loop,
        (theta, v, integral of theta plus the pick-off error), in rad, rad/s, rad s
    moment, tilt : (m,) derivative of x per disturbing moment, expressed as a rate (rad/s), and per
        pick-off error (rad)
    tilt_reading : reading per pick-off error
    jump, jump_reading : change of x (m,), and integral of the reading (rad), per jump of the
        pick-off error, to which the derivative gain responds with an impulse
    """

    f: np.ndarray
    g: np.ndarray
    c: np.ndarray
    d: complex
    moment: np.ndarray
    tilt: np.ndarray
    tilt_reading: complex
    jump: np.ndarray
    jump_reading: complex

    @cached_property
    def transfer(self):
        """
        Coefficients of the transfer function without d, highest power of s first.

        Numerator and denominator are tuples of complex numbers (Faddeev-LeVerrier algorithm).
        """
        count, unit = len(self.g), np.eye(len(self.g), dtype=complex)
        adjugate, numerator, denominator = unit, [], [1.0 + 0.0j]
        for k in range(1, count + 1):
            numerator.append(complex(
                product(product(self.c[None], adjugate), self.g[:, None])[0, 0]))
            adjugate = product(self.f, adjugate)
            trace = 0.0j
            for value in adjugate.diagonal().tolist():
                trace += value
            denominator.append(complex(-trace.real / k, -trace.imag / k))
            adjugate = adjugate + denominator[-1] * unit
        return tuple(numerator), tuple(denominator)

    @property
    def roots(self):
        """Characteristic roots, 1/s, least stable first."""
        return tuple(sorted(polynomial_roots(self.transfer[1]), key=lambda s: -s.real))

    def response(self, omega):
        """Return the transfer function at j omega; omega: any shape, rad/s, either sign."""
        omega = np.asarray(omega, dtype=float)
        (a, b), (c, d) = (_along_the_axis(each, omega) for each in self.transfer)
        size = c * c + d * d
        return (a * c + b * d) / size + self.d.real + 1j * ((b * c - a * d) / size + self.d.imag)

    def axis_responses(self, omega):
        """
        Return the responses of an axis to its own rate and to the rate of the other axis.

        For real signals reading_y = direct u_y - cross u_z and reading_z = cross u_y + direct u_z,
        with direct = (G(j w) + conj G(-j w)) / 2 and cross = (G(j w) - conj G(-j w)) / 2j.

        Parameters
        ----------
        omega : frequencies, rad/s, any shape
        """
        omega = np.asarray(omega, dtype=float)
        plus, minus = self.response(omega), np.conj(self.response(-omega))
        return 0.5 * (plus + minus), -0.5j * (plus - minus)


def _along_the_axis(coefficients, omega):
    """Return real and imaginary part of a polynomial at j omega."""
    first, *rest = coefficients
    x, y = first.real, first.imag
    for c in rest:
        x, y = c.real - omega * y, c.imag + omega * x
    return x, y


def polynomial_roots(coefficients):
    """
    Return all roots of a polynomial by the simultaneous iteration of Weierstrass (Durand-Kerner).

    Parameters
    ----------
    coefficients : complex, highest power first; the first must be 1
    """
    size = 1.0 + max(abs(c.real) + abs(c.imag) for c in coefficients[1:])
    roots = [complex(size)]
    for _ in coefficients[2:]:
        # Start from any points that are not symmetric about the axes.
        roots.append(roots[-1] * (0.4 + 0.9j))
    for _ in range(ITERATIONS):
        before = list(roots)
        for k, z in enumerate(roots):
            value = apart = 1.0 + 0.0j
            for c in coefficients[1:]:
                value = value * z + c
            for j, other in enumerate(roots):
                if j != k:
                    apart *= z - other
            if apart:
                roots[k] = z - value / apart
        if roots == before:
            break
    return roots


def state_space(p, speed_hz=None):
    """Return the StateSpace of TunedGyroParameters at a rotor speed, by default the nominal."""
    omega = p.omega if speed_hz is None else 2.0 * math.pi * speed_hz
    a, h, f = p.transverse_inertia, p.axial_inertia * omega, p.damping
    stiffness = complex(p.stiffness(speed_hz),
                        -p.rotating_damping_n_m_s * omega - p.cross_feedback_n_m_rad)
    into = complex(f, p.input_inertia * omega - h)
    scale = 1.0 / (p.input_inertia * p.omega)
    mistaken = 1j * p.input_inertia * omega / a
    if p.loop == 'open':
        rows = [[0.0, 1.0], [-stiffness / a, complex(-f, h) / a]]
        return StateSpace(
            np.array(rows, dtype=complex), np.array([-1.0, into / a]),
            np.array([-p.coupling * scale, 0.0j]), 0.0j, np.array([0.0, mistaken]),
            np.array([0.0, 1j * p.cross_feedback_n_m_rad / a]), complex(-p.coupling * scale),
            np.zeros(2, dtype=complex), 0.0j)
    derivative, proportional, integral = loop_gains(p)
    rows = [[0.0, 1.0, 0.0],
            [-(stiffness + proportional) / a, (complex(-f, h) - derivative) / a, -integral / a],
            [1.0, 0.0, 0.0]]
    return StateSpace(
        np.array(rows, dtype=complex), np.array([-1.0, (into + derivative) / a, 0.0]),
        -1j * scale * np.array([proportional, derivative, integral]), 1j * scale * derivative,
        np.array([0.0, mistaken, 0.0]), np.array([0.0, -proportional / a, 1.0]),
        -1j * scale * proportional, np.array([0.0j, -derivative / a, 0.0]),
        -1j * scale * derivative)
