"""
Count lost messages from gaps in the sequence numbers of their publishers.

This module does not import ROS.
"""

# Maximum number of rising sequences that are distinguished.
MOST = 100


class Gaps:
    """
    Counts missing sequence numbers of one topic.

    Each publisher numbers its messages from 1. Messages sent before the first one received from
    a publisher count as ``before``, not as ``lost``. A message does not identify its publisher,
    so the numbers of several publishers are sorted into as many rising sequences: without loss
    the count is exactly zero, with loss it is an estimate.

    Attributes
    ----------
    publishers : number of publishers there have been; the owner keeps it up to date
    known : False if the middleware does not number messages
    lost, before : counts of messages
    """

    def __init__(self):
        self.publishers, self.known = 1, True
        self.lost = self.before = 0
        self._next = []

    def take(self, number):
        """Process the sequence number of a message, or None if it has no number."""
        following = self._next
        if len(following) == 1 and following[0] == number:
            following[0] = number + 1
        elif number is None:
            self.known = False
        elif number in following:
            following[following.index(number)] = number + 1
        else:
            earlier = [n for n in following if n < number]
            if earlier and len(following) >= self.publishers:
                nearest = max(earlier)
                self.lost += number - nearest
                following[following.index(nearest)] = number + 1
            else:
                if len(following) < self.publishers:
                    self.before += number - 1
                following.append(number + 1)
                # Drop the sequences of publishers that have left.
                del following[:-MOST]
