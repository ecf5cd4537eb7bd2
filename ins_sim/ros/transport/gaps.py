"""Lost messages, seen as gaps in the numbers that their publishers give them.  No ROS."""

# rising sequences that are told apart
MOST = 100


class Gaps:
    """
    Counts what is missing in the sequence numbers of one topic.

    Each publisher numbers its messages from 1.  What was sent before the first message heard of
    it is not lost but ``before``.  A message does not say whose it is: of several publishers the
    numbers are sorted into as many rising sequences, so that without loss nothing is counted, and
    with loss the count is an estimate.  publishers: how many there have been; the owner keeps it
    up to date.  ``known`` is False where the middleware numbers nothing.
    """

    def __init__(self):
        self.publishers, self.known = 1, True
        self.lost = self.before = 0
        self._next = []

    def take(self, number):
        """Take the number of a message, or None if it has none."""
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
                # of publishers that have left
                del following[:-MOST]
