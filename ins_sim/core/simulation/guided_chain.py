"""Sensors and navigators of a closed loop, fed with the truth of one instant at a time."""

from functools import partial

from ins_sim.core.aiding.navigator import AidedNavigator, GNSS, METER
from ins_sim.core.attitude import quaternion
from ins_sim.core.earth import ellipsoid
from ins_sim.core.earth.frames import MapFrame
from ins_sim.core.earth.rates import rate_on_earth
from ins_sim.core.navigation.loop import NavigationLoop
from ins_sim.core.navigation.navigator import InertialNavigator
from ins_sim.core.numerics.instants import period_ns
from ins_sim.core.sensors.gnss import Gnss
from ins_sim.core.sensors.imu.ideal import MotionImu
from ins_sim.core.sensors.imu.sampling import Sampler
from ins_sim.core.sensors.imu.stream import StreamImu
from ins_sim.core.sensors.imu.with_errors import with_errors
from ins_sim.core.sensors.velocity_meter.meter import VelocityMeter
from .aided_loop import AidedLoop


class _ImuOfMotion:
    """The IMU that evaluates the motion itself, as far as the truth is known."""

    def __init__(self, settings, motion, first_ns, lead_ns):
        self._imu, self._lead_ns = MotionImu(settings, motion, first_ns), lead_ns

    def push(self, t_ns, *_):
        """Return the readings that depend on nothing after t_ns, as StreamImu.push does."""
        readings = []
        while self._imu.next_ns + self._lead_ns <= t_ns:
            block = self._imu.advance(1)
            parity = None if block.parity is None else float(block.parity[0])
            readings.append((int(block.t_ns[0]), tuple(block.omega[0].tolist()),
                             tuple(block.f[0].tolist()), parity))
        return readings


class SteeringChain:
    """
    IMU and strapdown; in aided runs also velocity meter, GNSS and aided navigator.

    The stages are those of ``simulate`` and ``simulate_aided``, and the solutions have the same
    bits. Stages that do not affect the solution used for steering are left out.
    Parameters
    ----------
    settings : SimulationSettings
    motion : GuidedMotion
    aided : AidedSimulationSettings, optional
        If given, the aided solution steers; otherwise that of the strapdown.
    """

    def __init__(self, settings, motion, aided=None):
        generator, sensor = settings.motion_generator, settings.imu_sensor
        self._motion, self._dt_ns = motion, period_ns(sensor.rate_hz)
        self._frame = MapFrame(sensor.datum, sensor.earth.rotation)
        self._spin = ellipsoid.rotation_rate(sensor.earth.rotation)
        if sensor.source == 'motion':
            self._imu = _ImuOfMotion(sensor, motion, round(generator.start_s * 1e9),
                                     settings.lead_ns)
        else:
            self._imu = StreamImu(sensor)
        self._errors = with_errors(sensor)
        self._sampler = Sampler(sensor.sampling, sensor.seed, sensor.run, 'sampling', self._dt_ns)
        self._meter = self._gnss = self._strapdown = self._aided = None
        strapdown = settings.strapdown
        if aided is not None:
            navigator = aided.aided_navigator
            make = partial(AidedNavigator, navigator)
            self._aided = AidedLoop(make, self._dt_ns, navigator.output_every, navigator.on_fault)
            self._aided.waiting, sources = [], self._aided.navigator.sources
            if METER in sources:
                self._meter = VelocityMeter(aided.velocity_meter)
            if GNSS in sources:
                self._gnss = Gnss(aided.gnss)
        if aided is None or self._meter is not None and \
                aided.velocity_meter.attack_angle == 'ins':
            self._strapdown = NavigationLoop(
                partial(InertialNavigator, strapdown), self._dt_ns, strapdown.output_every,
                strapdown.on_fault)

    def push(self, t_ns, truth):
        """
        Process the truth of one instant.

        Parameters
        ----------
        t_ns : int
            Motion time, ns.
        truth : tuple
            See ``GuidedMotion.one``.

        Returns
        -------
        list of (int, tuple)
            The solutions completed by it: instant, and lat, lon, height, v_n, q_nb.
        """
        lat, lon, height, v_n, q_nb, omega, f = truth
        if self._meter is not None:
            self._arrived(METER, self._meter.push_truth(
                t_ns, quaternion.rotate_back(q_nb, v_n), height))
        if self._gnss is not None:
            rate = rate_on_earth(lat, q_nb, omega, self._spin)
            self._arrived(GNSS, self._gnss.push(t_ns, (lat, lon, height, v_n, q_nb, rate)))
        q_mb = quaternion.multiply(self._frame.q_mn(lat, lon), q_nb)
        found = []
        for reading in self._imu.push(t_ns, q_mb, omega, f):
            found += self._navigate(reading, t_ns, truth)
        return found

    def _arrived(self, source, fixes):
        """Keep fixes until the samples reach their arrival."""
        if fixes:
            waiting = self._aided.waiting
            waiting += [(fix.arrival_ns, source, fix) for fix in fixes]
            waiting.sort(key=lambda entry: entry[:2])

    def _navigate(self, reading, now_ns, truth):
        """Process a reading unless it is lost; return a list of solutions to steer by."""
        t_ns, omega, f, _ = reading
        if self._errors is not None:
            omega, f = self._errors.step(t_ns, omega, f)
        if self._sampler.stamp(t_ns // self._dt_ns, t_ns) is None:
            return []
        if t_ns != now_ns:
            truth = self._motion.one(t_ns)
        sample = (t_ns, tuple(omega), tuple(f), truth[:5])
        found = self._published(self._strapdown, sample)
        if self._aided is None:
            return found
        if self._meter is not None:
            for _, (_, _, _, v_n, q_nb) in found:
                self._arrived(METER, self._meter.push_ins(
                    t_ns, quaternion.rotate_back(q_nb, v_n)))
        return self._published(self._aided, sample)

    @staticmethod
    def _published(loop, sample):
        """Return [(instant, solution)] that a NavigationLoop (or None) publishes, or []."""
        if loop is None:
            return []
        return [(sample[0], loop.navigator.solution) for *_, due in loop.run([sample]) if due]
