"""The mounting of a live IMU in the vehicle: from angles, from /tf_static, or levelled at rest."""

import math

from ins_sim.core.attitude import angles, quaternion
from ins_sim.core.postprocessing.mounting import chained_mounting
from .samples import ImuSample

# How long samples wait for /tf_static, s.
PATIENCE_S = 2.0


def turned_samples(samples, q):
    """Return ImuSamples turned by a quaternion."""
    return [ImuSample(s.t_ns, quaternion.rotate(q, s.omega), quaternion.rotate(q, s.f), s.tag)
            for s in samples]


class LiveMounting:
    """
    Finds the quaternion from the frame of the IMU to base_link.

    Parameters
    ----------
    settings : MountingAngles
    base : name of the frame of the vehicle
    has_transforms : whether /tf_static can be received

    Attributes
    ----------
    q_bs : quaternion, or None if not known yet
    notes : sentences on its source; the owner removes them
    faults : sentences on what is missing; the owner removes them

    """

    def __init__(self, settings, base, has_transforms):
        self._settings, self._base = settings, base
        self._asks = has_transforms and (
            settings.source == 'tf' or settings.source == 'auto' and not any(settings.rpy_deg))
        if settings.source == 'tf' and not has_transforms:
            raise ValueError('mounting.source is tf, but tf2_msgs cannot be imported; expected '
                             'mounting.source given with mounting.rpy_deg, or that ROS package '
                             '(apt: ros-jazzy-tf2-msgs)')
        self._transforms, self._first_ns, self._complained = {}, None, False
        self.q_bs, self.notes, self.faults = None, [], []
        if not self._asks:
            self._as_given()

    def _as_given(self):
        roll, pitch, yaw = map(math.radians, self._settings.rpy_deg)
        if self._settings.source == 'level':
            roll = pitch = yaw = 0.0
        self.q_bs = angles.from_rpy(roll, pitch, yaw)

    def add(self, transforms):
        """Add transforms {(parent, child): q from child to parent}."""
        self._transforms.update(transforms)
        self._complained = False

    def find(self, frame, t_ns):
        """
        Return q_bs for an IMU with this frame, or None while the transform is not known.

        t_ns is the stamp of the sample that needs it.
        """
        if self.q_bs is not None:
            return self.q_bs
        self._first_ns = t_ns if self._first_ns is None else self._first_ns
        frame, base = frame.lstrip('/'), self._base.lstrip('/')
        late = t_ns - self._first_ns > PATIENCE_S * 1e9
        if frame == base:
            self._as_given()
        elif self._transforms:
            try:
                self.q_bs = chained_mounting(self._transforms, base, frame, self.notes)
                self.notes.append(f'mounting: /tf_static from {base} to {frame}')
            except ValueError as error:
                if late:
                    self._complain(str(error))
        elif late and self._settings.source == 'auto':
            self.notes.append(f'mounting: no /tf_static in {PATIENCE_S:g} s, so the frame '
                              f'{frame!r} of the IMU is assumed to be {base}: set '
                              'mounting.rpy_deg if the IMU is rotated')
            self._as_given()
        elif late:
            self._complain(f'no message on /tf_static in {PATIENCE_S:g} s (mounting.source tf); '
                           f'expected a transform from {base} to {frame!r}')
        return self.q_bs

    def _complain(self, sentence):
        if not self._complained:
            self._complained = True
            self.faults.append(f'mounting: {sentence}; navigation waits for it')
