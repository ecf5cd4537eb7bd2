"""The interface of a sensor: true motion in, readings out, one at a time or in blocks."""

from collections.abc import Iterable
from typing import Any

from ins_sim.core.timeseries.histories import Truth


class Sensor:
    """
    Base class of the sensors. A subclass overrides ``reset``, ``push`` and ``samples``.

    Readings are functions of the settings, the seed and motion time, so neither a restart nor the
    division of the stream into blocks changes them. ``core.numerics.noise.indexed_noise`` gives
    noise with this property.

    The VelocityMeter is not a Sensor: it needs two streams, the truth and the INS, and has a
    ``push_truth`` and a ``push_ins``.
    """

    def reset(self) -> None:
        """Forget the stream; the next sample is the first."""
        raise NotImplementedError

    def push(self, t_ns: int, *sample: Any) -> list[Any]:
        """
        Process one sample of the true motion.

        Parameters
        ----------
        t_ns : int
            Motion time, ns.
        *sample
            The quantities of the motion that the sensor needs, as ``samples`` returns them.

        Returns
        -------
        list
            The readings that this sample completes: zero, one or several.

        Raises
        ------
        StreamFault
            On samples that cannot be used, such as a gap or NaN.
        """
        raise NotImplementedError

    def samples(self, truth: Truth) -> Iterable[tuple[Any, ...]]:
        """Return the arguments of ``push`` for each instant of a Truth record."""
        raise NotImplementedError

    def advance(self, truth: Truth) -> Any:
        """
        Return the readings of a Truth record or of a part of one; same bits as single pushes.

        Parameters
        ----------
        truth : Truth

        Returns
        -------
        list
            A sensor may return a record of arrays instead; an IMU returns ImuSamples.
        """
        return [reading for sample in self.samples(truth) for reading in self.push(*sample)]
