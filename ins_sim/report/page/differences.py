"""List the settings of a run that differ from the defaults."""

from collections import Counter
from dataclasses import fields, is_dataclass

from ins_sim.settings.catalogue import flatten, values_of
from ins_sim.settings.field import SettingsGroup


def changed_settings(settings):
    """
    Return rows (name, value, default, unit, nodes) of the settings that differ from the defaults.

    ``settings`` belong to one node, or contain those of several nodes as fields. A setting with
    the same value in several nodes is one row; ``nodes`` lists them, or is 'all' if every node
    that has the setting has this value.
    """
    rows, known = {}, Counter()
    for node, given in settings_by_node(settings).items():
        known.update(values_of(given).keys())
        described, defaults = flatten(type(given)), values_of(type(given)())
        for name, value in values_of(given).items():
            if value != defaults[name]:
                row = (name, _shown(value), _shown(defaults[name]),
                       described[name].metadata['unit'])
                rows.setdefault(row, []).append(node)
    return [(*row, 'all' if len(nodes) == known[row[0]] > 1 else ', '.join(nodes))
            for row, nodes in rows.items()]


def settings_by_node(settings, name=''):
    """Return {node: its settings} for settings that may contain nodes at any depth."""
    if isinstance(settings, SettingsGroup):
        return {name: settings}
    found = {}
    for f in fields(settings):
        value = getattr(settings, f.name)
        if is_dataclass(value):
            found.update(settings_by_node(value, f.name))
    return found


def _shown(value):
    """Return a value as in a parameter file; equal numbers of all axes are shown as 3 × 0.1."""
    if isinstance(value, tuple):
        if len(value) > 1 and len(set(value)) == 1:
            return f'{len(value)} × {_shown(value[0])}'
        return '[' + ', '.join(map(_shown, value)) + ']'
    if isinstance(value, bool):
        return str(value).lower()
    return repr(value) if isinstance(value, float) else str(value) or "''"
