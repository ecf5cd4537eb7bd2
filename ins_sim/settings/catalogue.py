"""Convert settings objects to flat {dotted name: value} and back, and check single values."""

from collections.abc import Mapping
from dataclasses import fields, is_dataclass
import math

from .shown import exact, shown
from .suggest import nearest_name, unknown_key

OF_ROS = ('use_sim_time', 'start_type_description_service')


def flatten(cls, prefix=''):
    """Return {dotted name: dataclass field} of a settings class, in the order of declaration."""
    names = {}
    for f in fields(cls):
        if is_dataclass(f.default_factory):
            names.update(flatten(f.default_factory, f'{prefix}{f.name}.'))
        else:
            names[prefix + f.name] = f
    return names


def values_of(settings, prefix=''):
    """Return {dotted name: value} of a settings object."""
    values = {}
    for f in fields(settings):
        value = getattr(settings, f.name)
        if is_dataclass(value):
            values.update(values_of(value, f'{prefix}{f.name}.'))
        else:
            values[prefix + f.name] = value
    return values


def value_text(value):
    """Return a value as YAML that ROS reads with the right type."""
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, tuple):
        return '[' + ', '.join(value_text(v) for v in value) + ']'
    return repr(value) if isinstance(value, float) else f'"{value}"' if value == '' else str(value)


def remark(f, settable=False):
    """Return the description of a field: doc, unit, range, choices, and whether it is settable."""
    m = f.metadata
    parts = [m['doc']]
    if m['unit']:
        parts[0] += f' [{m["unit"]}]'
    if m['low'] is not None:
        parts.append(f'{m["low"]:g} to {m["high"]:g}')
    if m['choices']:
        parts.append('one of ' + ', '.join(m['choices']))
    if settable:
        parts.append('can be set while the node runs')
    return '; '.join(parts)


def groups_of(cls, prefix=''):
    """Return {dotted name: class} of the groups of a settings class, in declaration order."""
    names = {}
    for f in fields(cls):
        if is_dataclass(f.default_factory):
            name = prefix + f.name
            names[name] = f.default_factory
            names.update(groups_of(f.default_factory, f'{name}.'))
    return names


def sentence_of(cls):
    """Return the first line of the docstring of a settings class."""
    return cls.__doc__.strip().splitlines()[0]


def build(cls, values):
    """
    Return the settings object of a class from dotted names; missing names take defaults.

    Parameters
    ----------
    cls : settings class
    values : {dotted name: value}

    Raises
    ------
    ValueError
        On an unknown name, a wrong type, NaN, a value out of range and contradicting values.
        The message names key, value and expectation in one sentence.
    """
    known = flatten(cls)
    checked = {}
    for name, value in values.items():
        if name not in known:
            raise ValueError(unknown_key(name, known))
        checked[name] = check_value(name, value, known[name])
    return _assemble(cls, checked, '')


def _assemble(cls, values, prefix):
    arguments = {}
    for f in fields(cls):
        name = prefix + f.name
        if is_dataclass(f.default_factory):
            arguments[f.name] = _assemble(f.default_factory, values, name + '.')
        elif name in values:
            arguments[f.name] = values[name]
    return cls(**arguments)


def is_of_ros(name):
    """Return whether a parameter is one that ROS declares on every node."""
    return name in OF_ROS or name.startswith('qos_overrides.')


def from_ros(value, f):
    """Convert the value of a ROS parameter to the type of its field f."""
    if value is None and f.type not in _KINDS:
        # ROS reads an empty list as a parameter without a value.
        return ()
    if value is True and 'y' in f.metadata['choices']:
        # ROS reads an unquoted y as true.
        return 'y'
    return value.tolist() if hasattr(value, 'tolist') else value


def for_all_axes(value, f):
    """Repeat a single number for each axis if the field f allows it; else return value."""
    is_number = isinstance(value, (int, float)) and not isinstance(value, bool)
    return (value,) * f.metadata['size'] if is_number and f.metadata['equal_axes'] else value


def check_value(name, value, f):
    """Return the value in the type of its field f; raise ValueError if it does not fit."""
    kind, unit = f.type, f.metadata['unit']
    if kind in (bool, int, float, str):
        value = _scalar(name, value, kind)
        values = (value,)
    else:
        size = f.metadata['size']
        value = for_all_axes(value, f)
        if isinstance(value, (str, bytes, Mapping)) or not hasattr(value, '__iter__'):
            wanted = f'{size} numbers, or one for all' if f.metadata['equal_axes'] else 'a list'
            raise ValueError(f'{name} is {shown(value)}; expected {wanted}')
        element = kind.__args__[0]
        value = values = tuple(_scalar(f'{name}[{k}]', v, element) for k, v in enumerate(value))
        if size is not None and len(value) != size:
            raise ValueError(f'{name} has {len(value)} entries; expected {size}')
    low, high, choices = f.metadata['low'], f.metadata['high'], f.metadata['choices']
    for v in values:
        # Infinity is accepted only if it is the upper bound.
        if isinstance(v, float) and not math.isfinite(v) and v != high:
            raise ValueError(f'{name} is {v}; expected a finite number')
        if choices and v not in choices:
            raise ValueError(f'{name} is {shown(v)}; expected one of {", ".join(choices)} '
                             f'(nearest: {nearest_name(v, choices)})')
        if low is not None and not low <= v <= high:
            unit = ' ' + unit if unit else ''
            raise ValueError(f'{name} is {exact(v)}{unit}; expected {exact(low)} to '
                             f'{exact(high)}{unit}')
    return value


def _scalar(name, value, kind):
    if isinstance(value, bool) != (kind is bool):
        raise ValueError(f'{name} is {shown(value)}; expected {_KINDS[kind]}')
    if kind is float and isinstance(value, (int, float)):
        try:
            return float(value)
        except OverflowError:
            raise ValueError(f'{name} is {shown(value)}; expected a number of at most 308 '
                             'digits') from None
    if not isinstance(value, kind):
        raise ValueError(f'{name} is {shown(value)}; expected {_KINDS[kind]}')
    return value


_KINDS = {bool: 'true or false', int: 'a whole number', float: 'a number', str: 'a text'}
