"""Statistics of the aiding fixes for /diagnostics. This module does not import ROS."""

from ins_sim.core.aiding.filters.base import INVALID_FIX
from ins_sim.core.numerics.instants import seconds
from ins_sim.core.numerics.units import DEG

# A sigma of mu, kx or kz below this means that the quantity was set as known; it is not shown.
KNOWN = 1e-8


class AidingHealth:
    """Counts fixes per sensor, and describes what the filter estimates of the velocity meter."""

    def __init__(self, stream):
        self._stream = stream
        self._came = {source: 0 for source in stream.navigator.sources}
        self._taken, self._refused, self._none = (dict(self._came) for _ in range(3))
        self._stuck_ns = None
        self._nis, self._last_ns = {}, {}
        self._reason = self._wrong = ''

    def came(self, source, fix):
        """Count a fix that has arrived."""
        self._came[source] += 1
        if fix.valid:
            self._last_ns[source] = fix.t_ns

    def count(self, judged):
        """Count processed fixes, a list of JudgedFix, and empty the list."""
        for source, t_ns, result in judged:
            if result.reason.startswith(INVALID_FIX):
                self._none[source] += 1
                continue
            (self._taken if result.taken else self._refused)[source] += 1
            if result.nis is not None:
                self._nis[source] = result.nis / result.freedom
            if not result.taken:
                self._reason = f'{source}: {result.reason}'
                if result.innovation:
                    # The filter tested the fix and rejected it; it was not just missing.
                    self._wrong = (f'{source}: the fix at {seconds(t_ns)} was rejected: '
                                   f'{result.reason}')
        judged.clear()

    def describe(self):
        """Return the last fix rejected since the previous call, or '', and the values."""
        values, now_ns = [], self._stream.processed_ns
        for source, count in self._came.items():
            values += [(f'{source} fixes', count), (f'{source} taken', self._taken[source]),
                       (f'{source} refused', self._refused[source]),
                       (f'{source} none', self._none[source])]
            if source in self._nis:
                values.append((f'{source} NIS per degree of freedom', f'{self._nis[source]:.3f}'))
            if source in self._last_ns and now_ns is not None:
                age_s = (now_ns - self._last_ns[source]) * 1e-9
                values.append((f'{source} age s', f'{age_s:.3f}'))
        values.append(('last refusal', self._reason))
        filter_ = self._stream.navigator.filter
        if filter_ is not None:
            known = filter_.estimate_sigmas() or (None,) * 3
            names = ('mounting arcmin', 'scale x', 'scale z')
            for name, factor, value, sigma in zip(names, (60.0 / DEG, 1.0, 1.0), filter_.estimates,
                                                  known):
                values.append((name, f'{value * factor:.6g}'))
                if sigma is not None and sigma > KNOWN:
                    values.append((f'{name} sigma', f'{sigma * factor:.3g}'))
        wrong, self._wrong = self._wrong, ''
        return wrong or self._missing(now_ns), values

    def _missing(self, now_ns):
        """Return a sentence naming the sensors whose fixes are missing, or ''."""
        silent = self._stream.silent
        # Waiting for a moment is normal; report it only without progress since the last call.
        awaited = self._stream.awaited if now_ns == self._stuck_ns else []
        self._stuck_ns = now_ns
        if silent:
            return f'continuing without {" and ".join(silent)}; expected fixes of every aiding ' \
                'sensor'
        return f'waiting for a fix of {" and ".join(awaited)}' if awaited else ''
