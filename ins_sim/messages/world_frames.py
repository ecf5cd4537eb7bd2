"""The frames that the odometry of another simulator names."""

import re

from . import topics

# Parts of the names of frames whose axes are not East, North, Up and forward, left, up.
NOT_ENU = ('ned', 'frd', 'esd')


class WorldFrames:
    """
    Sees that odometry is in one world, with axis z up.

    name: of the topic. The frames of the first message are those expected of all.
    """

    def __init__(self, name):
        self._name, self._read = name, topics.OTHER_ODOMETRY.reader(()).strings
        self.forget()

    def forget(self):
        """Let the next message name the frames."""
        self._frames = None

    def check(self, data):
        """
        Return a sentence on what is assumed of the first message, else ''.

        Raise ValueError, one sentence, for frames that are not ENU or others than those before.
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
