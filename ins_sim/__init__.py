"""
Inertial measurement unit and strapdown navigation simulator for ROS 2.

The conventions of the whole package stand here and nowhere else.

Frames
------
i
    Inertial frame of the run, aligned with e at motion time zero.
e
    Earth-centred Earth-fixed (WGS-84): x to (0, 0), z to the north pole.
m
    ``map``: the Cartesian plane tangent to the ellipsoid at the datum, axes East, North, Up.
n
    Local level frame at the vehicle, axes East, North, Up (REP-103, not NED).
b
    ``base_link``: Forward, Left, Up. The instrument frame ``imu_link`` coincides with it.

Names
-----
``C_nb`` and ``q_nb`` map b to n.  ``v_n`` is the velocity relative to the Earth in n;
``omega_ib_b`` is the rate of b relative to i, resolved in b; ``f_ib_b`` is specific force in b.

Units and shapes
----------------
SI and radians inside.  A public name that holds another unit carries it (``delay_us``).
Quaternions are unit, scalar last (x, y, z, w), as in ROS and SciPy.  Leading axes are time (and
run), the trailing axis is physics, so that ``(3,)`` is a sample and ``(n, 3)`` its history.

Time
----
Instants are int64 nanoseconds; t_j = t_0 + j dt is computed, never accumulated.  Only differences
become float seconds.  *Motion time* is the stamp less ``time.epoch_s``.

Angles of attitude
------------------
psi: counter-clockwise from north in the bench motions (the paper's +psi), clockwise (true
heading) in the flights.  theta: nose up.  gamma: right wing down.  ``C_nb`` of the paper's
(right, forward, up) axes is Rz(psi) Rx(theta) Ry(gamma); see ``ins_sim.core.attitude.angles``.
"""

__version__ = '0.1.0'
