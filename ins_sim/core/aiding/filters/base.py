"""The interface of the aiding filters, see docs/how_to/add_filter.md, and the free solution."""

from collections import namedtuple
import copy

from ..velocity_window import (BodyMean, DoubleIntegral, Force, Integrals, sums_after,
                               WindowSums)

# Initial values of the sums that a filter can ask for.
EMPTY = {'mean': tuple(BodyMean()), 'integrals': tuple(Integrals()),
         'accelerations': (tuple(DoubleIntegral()),) * 2, 'turned': 0.0, 'force': tuple(Force())}

# Prefix of the reason given for a fix that the instrument itself marks as invalid.
INVALID_FIX = 'invalid fix'


class FixOutcome(namedtuple('FixOutcome', 'innovation nis freedom taken reason',
                            defaults=(None, 0, True, ''))):
    """
    What a filter did with a fix.

    Parameters
    ----------
    innovation : tuple of float
        Prediction minus measurement, in the units of the filter; () if it was not computed.
    nis : float or None
        Normalised innovation squared, z' S^-1 z; None for a filter without a covariance.
    freedom : int
        Number of components of the innovation, the expected value of ``nis``.
    taken : bool
        Whether the solution was corrected.
    reason : str
        Why the solution was not corrected; '' if it was.
    """

    __slots__ = ()


def refused_fix(reason):
    """Return the FixOutcome of a fix that is rejected before an innovation is computed."""
    return FixOutcome((), taken=False, reason=reason)


class AidingFilter:
    """
    Base class of the aiding filters, a public point of extension.

    `AidedNavigator` creates one object when the solution starts. It then calls ``step`` for every
    IMU sample, ``begin_window`` before the first sample of a window of the velocity meter, and
    ``update_velocity`` or ``update_gnss`` for every fix to be used, at the instant of the fix. A
    filter corrects the solution with ``ins.correct`` and ``ins.add_biases``.

    Axes: b is forward, left, up; n is east, north, up. Errors are computed minus true.

    A fix that arrives late is processed at its own instant: the navigator restores a copy of the
    filter and of the strapdown, and repeats the samples since then. All state of a filter must
    therefore be in its attributes, and an attribute must be replaced, never changed in place;
    an attribute that is changed in place has to be copied by an override of ``copy``.

    A filter with a linear error model names its states in ``states`` and overrides ``correct``,
    ``transition`` and ``velocity_model`` (and ``gnss_model``). A test then checks all its matrices
    against differences of the strapdown. Other filters do not need these methods.

    Parameters
    ----------
    settings : AidedNavigatorSettings
    ins : CorrectedStrapdown
        The solution at its start, with its initial errors.

    Attributes
    ----------
    sums : tuple
        Sums over the samples of the window so far, the fields of ``WindowSums``.
    needs : tuple of str
        Fields of ``WindowSums`` that the filter uses besides the mean; a class attribute.
    estimates : tuple of float
        Estimated mounting error of the velocity meter (rad, antennas turned left is positive)
        and its forward and lateral scale errors; constant zero if not estimated.
    healthy : bool
        False if the covariance is no longer positive definite; the solution is then restarted.
    states : tuple of str
        Names of the states of the linear error model, in the order of its matrices; () without
        one. The test knows position_e, velocity_e, attitude_e (also _n, _u), gyro_bias_x,
        accelerometer_bias_x and acceleration_x (also _y, _z; the latter is the error of the
        corrected specific force). The test sees other states, the filter's own, by their effect
        on the innovation.
    covariance : ndarray, (n, n), or None
        Covariance of the errors ``states``, or None. A filter replaces it and never changes it in
        place.
    given : tuple of str
        States that the filter does not estimate, because their values are given in the settings.
    observed_at : str
        'end' or 'start' of the window: the instant to which the errors multiplied by the matrix
        of ``velocity_model`` belong.
    neglected : float
        Largest coefficient that the transition matrix leaves out, in SI units (1/s or 1/s^2).
    """

    needs = ()
    healthy = True
    estimates = (0.0, 0.0, 0.0)
    states = ()
    covariance = None
    given = ()
    observed_at = 'end'
    neglected = 0.0

    def __init__(self, settings, ins):
        self.settings = settings
        self.sums = tuple(EMPTY[name] if name in ('mean', *self.needs) else None
                          for name in WindowSums._fields)

    @property
    def mean(self):
        """Return the BodyMean of the solution over the window so far."""
        return BodyMean(*self.sums[0])

    @property
    def window(self):
        """Return the sums by name, as WindowSums."""
        return WindowSums(*self.sums)

    def clear(self, name):
        """Reset one of the sums to its initial value."""
        self.replace(name, EMPTY[name])

    def replace(self, name, value):
        """Replace one of the sums."""
        self.sums = tuple(self.window._replace(**{name: value}))

    def copy(self):
        """Return a snapshot, which is not affected by later calls of the methods."""
        return copy.copy(self)

    def step(self, ins, before, delta_v, dt):
        """
        Follow one IMU sample; called after the strapdown has advanced over it.

        A filter that overrides this method is called for every sample, which is slow. The sums
        of a filter that does not are computed for several samples in one call.

        Parameters
        ----------
        ins : CorrectedStrapdown
            The solution at the end of the sampling interval.
        before : tuple
            At the start of the interval: q_nb (4,), velocity in b (3,), velocity in n (3,), m/s.
        delta_v : tuple of float, (3,)
            Velocity increment without biases, resolved in b at the start, m/s.
        dt : float
            Length of the interval, s.
        """
        _, place, _, q_nb, v_b, rate, _ = ins.carry
        self.sums = sums_after(*self.sums, before, (q_nb, v_b, place[3:6]), place[0:3], rate,
                               delta_v, dt)
        if self.samples_left() == 0:
            self.pause(ins)

    def samples_left(self):
        """Return the number of samples until ``pause`` must be called, or None for never."""
        return None

    def pause(self, ins):
        """
        Do the work that is not needed at every sample, such as propagating a covariance.

        Parameters
        ----------
        ins : CorrectedStrapdown
            The solution now.
        """

    def begin_window(self, ins):
        """
        Reset what the filter has accumulated over the window that has ended.

        Called before the first sample of a new window, that is, after the fix of the last window
        if it came in time. It is also called if there was no fix.

        Parameters
        ----------
        ins : CorrectedStrapdown
            The solution at the end of the last window.
        """
        self.clear('mean')

    def update_velocity(self, ins, fix):
        """
        Process a valid fix of the velocity meter whose window ends now.

        Parameters
        ----------
        ins : CorrectedStrapdown
            The solution at the end of the window; to be corrected.
        fix : VelocityFix
            Mean velocity over the window, forward and left, m/s, the known bias subtracted.

        Returns
        -------
        FixOutcome
        """
        raise NotImplementedError

    def update_gnss(self, ins, fix, rate, lever):
        """
        Process a valid GNSS fix that is at most one sampling interval old.

        Called only for filters with ``takes_gnss`` in the table of filters.

        Parameters
        ----------
        ins : CorrectedStrapdown
            The solution now; to be corrected.
        fix : GnssFix
        rate : tuple of float, (3,)
            Angular rate of b relative to the Earth, in b, rad/s.
        lever : tuple of float, (3,)
            Position of the antenna relative to the IMU, in b, m.

        Returns
        -------
        FixOutcome
        """
        raise NotImplementedError

    def sigmas(self):
        """
        Return standard deviations of the solution, or None for a filter without a covariance.

        Returns
        -------
        position, velocity, attitude : tuple of float, (3,)
            East, north, up; m, m/s, rad.
        """
        return None

    def estimate_sigmas(self):
        """Return the standard deviations of ``estimates``, or None."""
        return None

    def residual(self, fix):
        """Return the mean velocity of the solution minus that of a fix, forward and left, m/s."""
        x, y = self.mean.value
        return x - fix.velocity[0], y - fix.velocity[1]

    def correct(self, ins, x):
        """
        Subtract estimated errors from the solution and from the filter's own estimates.

        Parameters
        ----------
        ins : CorrectedStrapdown
        x : sequence of float, (n,)
            Errors, in the order of ``states``.
        """
        raise NotImplementedError

    def transition(self, ins):
        """
        Return the transition matrix from the instant of the covariance to the present, (n, n).

        With ``observed_at`` 'start' it begins at the start of the window.

        """
        raise NotImplementedError

    def velocity_model(self, ins, fix):
        """
        Return the innovation of a velocity fix and its matrix; parameters as in update_velocity.

        Returns
        -------
        z : ndarray, (2,)
            Prediction minus measurement, forward and left, m/s.
        h : ndarray, (2, n)
            Derivative of z with respect to the errors at ``observed_at``.
        """
        raise NotImplementedError

    def gnss_model(self, ins, fix, rate, lever):
        """
        Return the innovation of a GNSS fix and its matrix; parameters as in ``update_gnss``.

        Returns
        -------
        z : ndarray, (m,)
            Prediction minus measurement: position (m) and velocity (m/s), east, north, up.
        h : ndarray, (m, n)
            Derivative of z with respect to the present errors.
        """
        raise NotImplementedError


class NoCorrection(AidingFilter):
    """The free solution: it uses no fixes (the table of filters lists no instrument for it)."""
