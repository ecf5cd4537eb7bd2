"""The interface of the aiding filters, see docs/how_to/add_filter.md, and the free solution."""

from collections import namedtuple
import copy

from ..velocity_window import (BodyMean, DoubleIntegral, Force, Integrals, sums_after,
                               WindowSums)

# What the sums that a filter can ask for start from.
EMPTY = {'mean': tuple(BodyMean()), 'integrals': tuple(Integrals()),
         'accelerations': (tuple(DoubleIntegral()),) * 2, 'turned': 0.0, 'force': tuple(Force())}

# Prefix of the reason given for a fix that the instrument itself marks as invalid.
INVALID_FIX = 'the fix is none'


class FixOutcome(namedtuple('FixOutcome', 'innovation nis freedom taken reason',
                            defaults=(None, 0, True, ''))):
    """
    What a filter did with a fix.

    Parameters
    ----------
    innovation : tuple of float
        Prediction less measurement, in the units of the filter; () if it was not computed.
    nis : float or None
        Normalised innovation squared, z' S^-1 z; None for a filter without a covariance.
    freedom : int
        Number of components of the innovation, the expected value of ``nis``.
    taken : bool
        Whether the solution was corrected.
    reason : str
        Why the fix was not taken; '' if it was.
    """

    __slots__ = ()


def refused_fix(reason):
    """Return the FixOutcome of a fix that is rejected before an innovation is computed."""
    return FixOutcome((), taken=False, reason=reason)


class AidingFilter:
    """
    Base class of the aiding filters, a public point of extension.

    `AidedNavigator` makes one object when the solution starts and then calls, for every IMU
    sample, ``step``; before the first sample of a window of the velocity meter,
    ``begin_window``; for every fix to be used, at its own instant, ``update_velocity`` or
    ``update_gnss``. A filter corrects the solution by ``ins.correct`` and ``ins.add_biases``.

    Axes: b is forward, left, up; n is East, North, Up. Errors are computed less true.

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
        What is summed over the samples of the window so far, the fields of ``WindowSums``.
    needs : tuple of str
        The fields of ``WindowSums`` that the filter uses beside the mean, a class attribute.
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
        Of the errors ``states``; None for a filter without one. A filter replaces it and never
        changes it in place.
    given : tuple of str
        The states whose values are given to the filter, so that it does not estimate them.
    observed_at : str
        'end' or 'start' of the window: the instant of the errors which the matrix of
        ``velocity_model`` multiplies.
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
        """Return the sums by name, WindowSums."""
        return WindowSums(*self.sums)

    def clear(self, name):
        """Set one of the sums to where it starts from."""
        self.replace(name, EMPTY[name])

    def replace(self, name, value):
        """Replace one of the sums."""
        self.sums = tuple(self.window._replace(**{name: value}))

    def copy(self):
        """Return a snapshot, which later calls of the methods do not change."""
        return copy.copy(self)

    def step(self, ins, before, delta_v, dt):
        """
        Follow one IMU sample; called after the strapdown has advanced over it.

        A filter that overrides this method is called for every sample, which is slow. The sums
        of a filter that does not are computed for many samples at once.

        Parameters
        ----------
        ins : CorrectedStrapdown
            The solution at the end of the sampling interval.
        before : tuple
            At its start: q_nb (4,), velocity in b (3,), velocity in n (3,), m/s.
        delta_v : tuple of float, (3,)
            Velocity increment in b of the start, biases subtracted, m/s.
        dt : float
            Length of the interval, s.
        """
        _, place, _, q_nb, v_b, rate, _ = ins.carry
        self.sums = sums_after(*self.sums, before, (q_nb, v_b, place[3:6]), place[0:3], rate,
                               delta_v, dt)
        if self.samples_left() == 0:
            self.pause(ins)

    def samples_left(self):
        """Return after how many samples from now ``pause`` is to be called, or None."""
        return None

    def pause(self, ins):
        """
        Do what is not done at every sample, such as to propagate a covariance.

        Parameters
        ----------
        ins : CorrectedStrapdown
            The solution now.
        """

    def begin_window(self, ins):
        """
        Forget the window that has ended.

        Called before the first sample of a new window, hence after the fix of the last one, if
        that came in time. Without a fix it is called all the same.

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
        Process a valid GNSS fix of now or at most one sampling interval ago.

        Called only for filters that the table lists with ``takes_gnss``.

        Parameters
        ----------
        ins : CorrectedStrapdown
            The solution now; to be corrected.
        fix : GnssFix
        rate : tuple of float, (3,)
            Angular rate of b relative to the Earth, in b, rad/s.
        lever : tuple of float, (3,)
            Place of the antenna relative to the IMU, in b, m.

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
            East, North, Up; m, m/s, rad.
        """
        return None

    def estimate_sigmas(self):
        """Return the standard deviations of ``estimates``, or None."""
        return None

    def residual(self, fix):
        """Return mean velocity of the solution less that of a fix, forward and left, m/s."""
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
        Return the transition matrix from where the covariance stands to the present, (n, n).

        For ``observed_at`` 'start', from the start of the window to the present.
        """
        raise NotImplementedError

    def velocity_model(self, ins, fix):
        """
        Return the innovation of a velocity fix, and its matrix; parameters as in update_velocity.

        Returns
        -------
        z : ndarray, (2,)
            Prediction less measurement, forward and left, m/s.
        h : ndarray, (2, n)
            Derivative of z by the errors at ``observed_at``.
        """
        raise NotImplementedError

    def gnss_model(self, ins, fix, rate, lever):
        """
        Return the innovation of a GNSS fix, and its matrix; parameters as in ``update_gnss``.

        Returns
        -------
        z : ndarray, (m,)
            Prediction less measurement: position, m, and velocity, m/s, East, North, Up.
        h : ndarray, (m, n)
            Derivative of z by the present errors.
        """
        raise NotImplementedError


class NoCorrection(AidingFilter):
    """The free solution: no fix is used (the table lists no instrument for it)."""
