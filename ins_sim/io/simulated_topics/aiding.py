"""Messages of velocity_meter, gnss and aided_navigator for an offline run."""

import numpy as np

from ins_sim.core.aiding.reading_noise import rate_variance
from ins_sim.core.earth.frames import MapFrame
from ins_sim.core.earth.great_circle import GreatCircleRoute
from ins_sim.messages import convert, topics, velocity_record
from ins_sim.messages.gnss_fixes import GnssWriter


class AidingSource:
    """
    Messages of velocity_meter, gnss and aided_navigator, by spans of motion time.

    Parameters
    ----------
    settings : AidedSimulationSettings
    flown : AidedResult of ``simulate_aided``
    omega : (n, 3) gyro readings at the instants of the result, rad/s
    epoch_ns : stamp of motion time zero, ns

    """

    def __init__(self, settings, flown, omega, epoch_ns):
        navigator = settings.aided_navigator
        self._frame = MapFrame(navigator.datum, navigator.earth.rotation)
        self._route = GreatCircleRoute.of_points(navigator.motion.route.points)
        self._flown, self._omega, self._leg = flown, omega, 0
        self._rate_variance = rate_variance(navigator)
        self._knows = not np.isnan(flown.errors.position_sigma).all()
        self._names = navigator.frames.names()
        self._messages = {**_velocity_messages(flown.velocity_fixes, epoch_ns, self._names),
                          **_gnss_messages(flown.gnss_fixes, epoch_ns, self._names)}

    def as_published(self, topic):
        """Return the Topic with the names of the frames and the covariance type of the filter."""
        written = topics.AIDED_FIX_ALONE if topic is topics.AIDED_FIX and not self._knows \
            else topic
        return written.named(self._names)

    def blocks(self, begin, end):
        """Return {Topic: (motion times (n,), values or messages)} of begin <= t < end."""
        found = {}
        for topic, (t_ns, messages) in self._messages.items():
            span = _between(t_ns, begin, end)
            found[topic] = t_ns[span], messages[span]
        span = _between(self._flown.states.t_ns, begin, end)
        states, errors = self._flown.states[span], self._flown.errors[span]
        rows = self._rows(states, errors, self._omega[span])
        for topic, values in rows.items():
            found[topic] = states.t_ns, values
        for topic, values in convert.aided_error_blocks(errors).items():
            # A filter without covariance publishes no standard deviations.
            silent = topic in topics.AIDED_SIGMAS and not self._knows
            found[topic] = (states.t_ns[:0], values[:0]) if silent else (states.t_ns, values)
        return found

    def _rows(self, states, errors, omega):
        """Return {Topic: values (n, k)} of the topics that need the whole solution."""
        columns = zip(zip(states.lat.tolist(), states.lon.tolist(), states.height.tolist(),
                          states.v_n.tolist(), states.q_nb.tolist()), omega.tolist(),
                      errors.position_sigma.tolist(), errors.velocity_sigma.tolist(),
                      errors.attitude_sigma.tolist())
        odometry, fixes, orthodrome = [], [], []
        for solution, rate, *sigmas in columns:
            sigmas = sigmas if self._knows else None
            odometry.append(_joined(convert.aided_odometry_one(self._frame, solution, rate,
                                                               sigmas, self._rate_variance)))
            fixes.append(_joined(convert.aided_fix_one(solution, sigmas)))
            lat, lon, height = solution[:3]
            self._leg = self._route.leg_at(lat, lon, self._leg)
            x, z = self._route.to_xz(lat, lon, self._leg)
            orthodrome.append((x, height, z))
        return {topics.AIDED_ODOMETRY: _table(odometry, 85), topics.AIDED_FIX: _table(fixes, 6),
                topics.AIDED_ORTHODROME: _table(orthodrome, 3)}


def _between(t_ns, begin, end):
    return slice(*np.searchsorted(t_ns, (begin, end)).tolist())


def _joined(runs):
    return [x for run in runs for x in run]


def _table(rows, width):
    return np.array(rows, dtype=float).reshape(-1, width)


def _velocity_messages(fixes, epoch_ns, names):
    """Return {Topic: (motion times (n,), messages (n,))} of VelocityFixes."""
    pack = topics.METER_VELOCITY.named(names).writer().pack
    records, shown = [], []
    for fix in fixes:
        records.append((fix.end_ns, velocity_record.pack_fix(fix, epoch_ns, names)))
        if fix.valid:
            t_ns, *runs = velocity_record.velocity_one(fix)
            shown.append((t_ns, pack(t_ns + epoch_ns, *runs)))
    return {topics.METER_RECORD: message_columns(records),
            topics.METER_VELOCITY: message_columns(shown)}


def _gnss_messages(fixes, epoch_ns, names):
    writer = GnssWriter(epoch_ns, names)
    return {topics.GNSS_FIX: message_columns([(fix.t_ns, writer.fix(fix)) for fix in fixes]),
            topics.GNSS_VELOCITY: message_columns([(fix.t_ns, writer.velocity(fix))
                                                   for fix in fixes if fix.valid])}


def message_columns(stamped):
    """Return motion times (n,) and the messages (n,), bytes as objects, of pairs."""
    t_ns = np.array([t for t, _ in stamped], dtype=np.int64)
    messages = np.empty(len(stamped), dtype=object)
    messages[:] = [message for _, message in stamped]
    return t_ns, messages
