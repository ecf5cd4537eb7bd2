"""Check the frames in the odometry of another simulator."""

import re

from . import topics

# Parts of the names of frames whose axes are not East, North, Up and forward, left, up.
NOT_ENU = ('ned', 'frd', 'esd')


class WorldFrames:
    """
    Checks that all odometry messages have the same frames, with z up.

    name is the topic. All messages must have the frames of the first one.
    """

    def __init__(self, name):
        self._name, self._read = name, topics.OTHER_ODOMETRY.reader(()).strings
        self.forget()

    def forget(self):
        """Accept the frames of the next message as the expected ones."""
        self._frames = None

    def check(self, data):
        """
        Return a sentence about assumptions for the first message, else ''.

        Raises ValueError if the frames are not ENU or differ from those of earlier messages.
        """
        frames = self._read(data)
        if frames == self._frames:
            return ''
        for frame in frames:
            if set(re.split('[^a-z]+', frame.lower())) & set(NOT_ENU):
                raise ValueError(f'{self._name} has the frame {frame!r}; expected a world with z '
                                 'up (REP-103: x East, y North, or turned by world.yaw_deg) and '
                                 'a body with x forward, y left, z up; the message was dropped')
        if self._frames is not None:
            raise ValueError(f'{self._name} has the frames {frames[0]!r} and {frames[1]!r}; '
                             f'expected {self._frames[0]!r} and {self._frames[1]!r} as before: '
                             'one publisher of one vehicle; the message was dropped')
        self._frames = frames
        return (f'{self._name}: the world {frames[0]!r} is taken as the plane tangent to the '
                f'Earth at the datum, z up, {frames[1]!r} as the vehicle, x forward, z up')
