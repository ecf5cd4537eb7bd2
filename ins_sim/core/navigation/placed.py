"""Read access to position and velocity, common to all strapdowns."""

import copy


class Placed:
    """
    Base class of the strapdowns that keep position and velocity as ``mechanization.PLACE``.

    The members are immutable and are replaced as a whole, so that a shallow copy is a snapshot.
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
