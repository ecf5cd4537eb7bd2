"""What a strapdown shows of its position and velocity."""

import copy


class Placed:
    """
    Base class of strapdowns, whose ``place`` is a ``mechanization.PLACE``.

    All their state is replaced, never changed, so that a copy is a snapshot and costs as little
    as one.
    """

    place: tuple

    def copy(self):
        """Return a snapshot."""
        return copy.copy(self)

    @property
    def lat(self):
        """Return the latitude, rad."""
        return self.place[0]

    @property
    def lon(self):
        """Return the longitude, rad."""
        return self.place[1]

    @property
    def height(self):
        """Return the height, m."""
        return self.place[2]

    @property
    def v(self):
        """Return v_n, m/s."""
        return self.place[3:6]
