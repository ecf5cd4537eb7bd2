"""Find the columns of a CSV file and their units, by settings or by their names."""

import math
import re

from ins_sim.core.numerics.units import STANDARD_GRAVITY
from ins_sim.settings.shown import listed, shown
from ins_sim.settings.suggest import nearest_name

_DEG, _FOOT, _KNOT = math.pi / 180.0, 0.3048, 1852.0 / 3600.0
# Factors to the internal unit by kind of quantity and unit, in lower case without blanks.
UNITS = {
    'time': {'s': 1.0, 'sec': 1.0, 'secs': 1.0, 'second': 1.0, 'seconds': 1.0, 'ms': 1e-3,
             'us': 1e-6, 'microseconds': 1e-6, 'ns': 1e-9, 'nsec': 1e-9, 'nanoseconds': 1e-9},
    'rate': {'rad/s': 1.0, 'rads^-1': 1.0, 'rads-1': 1.0, 'rad/sec': 1.0, 'deg/s': _DEG,
             'degs^-1': _DEG, 'dps': _DEG, 'deg/sec': _DEG, 'mdps': 1e-3 * _DEG,
             'mrad/s': 1e-3},
    'force': {'m/s^2': 1.0, 'm/s2': 1.0, 'ms^-2': 1.0, 'ms-2': 1.0, 'm/s/s': 1.0,
              'm/sec^2': 1.0, 'g': STANDARD_GRAVITY, 'gn': STANDARD_GRAVITY,
              'mg': 1e-3 * STANDARD_GRAVITY},
    'angle': {'deg': 1.0, 'degree': 1.0, 'degrees': 1.0, 'rad': 1.0 / _DEG,
              'radians': 1.0 / _DEG},
    'length': {'m': 1.0, 'metres': 1.0, 'meters': 1.0, 'km': 1e3, 'mm': 1e-3, 'ft': _FOOT,
               'feet': _FOOT},
    'speed': {'m/s': 1.0, 'ms^-1': 1.0, 'km/h': 1.0 / 3.6, 'kn': _KNOT, 'kt': _KNOT,
              'kts': _KNOT, 'knots': _KNOT, 'ft/s': _FOOT},
}
_SPELLINGS = (('\u00b5', 'u'), ('\u03bc', 'u'), ('\u00b2', '^2'), ('\u207b\u00b9', '^-1'),
              ('**', '^'), ('\u00b0', 'deg'), ('\u00b7', ''), ('*', ''), ('{', ''), ('}', ''))
_BRACKETS = re.compile(r'\s*[(\[]([^()\[\]]*)[)\]]\s*$')


def _imu(kind, axis):
    """Return patterns of common names for an axis of an IMU, with the unit that they imply."""
    if kind == 'rate':
        return ((rf'(.*[./])?angular_velocity[./_]{axis}', 'rad/s'),
                (rf'w_rs_s_{axis}|omega_{axis}_rad_s', 'rad/s'),
                (rf'(gyr|gyro|gyroscope)[ _.]?{axis}', None))
    return ((rf'(.*[./])?linear_acceleration[./_]{axis}', 'm/s^2'),
            (rf'a_rs_s_{axis}|f_{axis}_m_s2', 'm/s^2'),
            (rf'(acc|accel|accelerometer)[ _.]?{axis}', None))


_TIME = ((r'field\.header\.stamp', 'ns'), (r'%time', 'ns'), (r'#?timestamp', None),
         (r'time|t', None), (r't_ns', 'ns'), (r'__time', 's'))
# Kind of each column, and patterns of other names with the unit that they imply; None if the unit
# must be given in brackets or by the settings.
KNOWN = {
    't_s': ('time', _TIME),
    **{f'g{axis}_rps': ('rate', _imu('rate', axis)) for axis in 'xyz'},
    **{f'a{axis}_mps2': ('force', _imu('force', axis)) for axis in 'xyz'},
    'lat_deg': ('angle', ((r'lat|latitude', None),)),
    'lon_deg': ('angle', ((r'lon|lng|longitude', None),)),
    'height_m': ('length', ((r'height|altitude|alt', None),)),
    'roll_deg': ('angle', ((r'roll', None),)),
    'pitch_deg': ('angle', ((r'pitch', None),)),
    'heading_deg': ('angle', ((r'heading', None),)),
    **{f'v{axis}_mps': ('speed', ((rf'v{axis}', None),)) for axis in 'ned'},
}


class ColumnFinder:
    """
    Finds columns in a header.

    where gives file and line of the header for messages. columns {name: header or ''} and units
    {kind: unit or 'auto'} are the settings, whose keys are key and units.
    """

    def __init__(self, where, header, columns=None, units=None, columns_key='columns'):
        self._where, self._header = where, header
        self._columns, self._units, self._key = columns or {}, units or {}, columns_key
        self._bare = [_normal(name) for name in header]

    def find(self, name):
        """
        Return the index of a column and the factor of its unit, or None if it is missing.

        Raises ValueError if several columns match, or if the unit is unknown.
        """
        kind, patterns = KNOWN[name]
        k, habit = self._index(name, patterns)
        if k is None:
            return None
        if self._header.count(self._header[k]) > 1:
            raise ValueError(f'{self._where}: column {self._header[k]} occurs '
                             f'{self._header.count(self._header[k])} times; expected it once')
        unit = self._units.get(kind, 'auto')
        if unit == 'auto':
            written = _BRACKETS.search(self._header[k])
            unit = written.group(1) if written else habit
        return k, self._factor(name, k, kind, unit)

    def _index(self, name, patterns):
        wanted = self._columns.get(name, '')
        if wanted:
            for names, text in ((self._header, wanted), (self._bare, _normal(wanted))):
                if text in names:
                    return names.index(text), ''
            raise ValueError(f'{self._where}: there is no column {shown(wanted)}, the value of '
                             f'{self._key}.{name}; the nearest is '
                             f'{shown(nearest_name(wanted, self._header))}')
        if name in self._header:
            return self._header.index(name), ''
        for pattern, unit in patterns:
            found = [k for k, bare in enumerate(self._bare) if re.fullmatch(pattern, bare)
                     and (unit or _BRACKETS.search(self._header[k])
                          or self._units.get(KNOWN[name][0], 'auto') != 'auto')]
            if len(found) > 1:
                raise ValueError(f'{self._where}: {len(found)} columns match {name}: '
                                 f'{listed(self._header[k] for k in found)}; expected '
                                 f'{self._key}.{name} to name one')
            if found:
                return found[0], unit or ''
        return None, ''

    def _factor(self, name, k, kind, unit):
        if not unit:
            return 1.0
        text = ''.join(unit.lower().split())
        for spelling, plain in _SPELLINGS:
            text = text.replace(spelling, plain)
        factor = UNITS[kind].get(text)
        if factor is None:
            raise ValueError(f'{self._where}: the unit of column {shown(self._header[k])} is '
                             f'{shown(unit)}; expected one of {listed(UNITS[kind], 20)}'
                             + (f', or units.{kind}' if kind in self._units else ''))
        return factor

    def is_known(self, name):
        """Return whether a column exists."""
        return self._index(name, KNOWN[name][1])[0] is not None


def _normal(name):
    """Return a header without its unit, in lower case and with single blanks."""
    return ' '.join(_BRACKETS.sub('', name).lower().split())
