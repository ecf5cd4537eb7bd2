"""The nodes and verbs that read parameters, and descriptions of parameters and groups."""

from dataclasses import dataclass
from functools import cache

from ins_sim.settings.by_node import ALL_NODES
from ins_sim.settings.catalogue import flatten, groups_of, remark, sentence_of, value_text
from ins_sim.settings.navigate import NAVIGATE
from ins_sim.settings.recorded_imu import CONVERT
from ins_sim.settings.tuned_gyro import TunedGyroStudySettings
from ins_sim.studies.delays.figure import DelayFigureSettings

# The verbs that have parameters of their own, by the name of their section.
VERBS = {**NAVIGATE, **CONVERT, 'delay_study': DelayFigureSettings,
         'dtg_study': TunedGyroStudySettings}
READERS = {**ALL_NODES, **VERBS}


@dataclass(frozen=True)
class KnownParameter:
    """
    A parameter, as it is defined for some nodes or verbs.

    Attributes
    ----------
    name : dotted name
    default : default value as YAML
    words : description, unit, range and choices
    readers : the nodes and verbs that have it, in the order of READERS
    """

    name: str
    default: str
    words: str
    readers: tuple


@dataclass(frozen=True)
class KnownGroup:
    """A group of parameters: dotted name, description, and the nodes and verbs that have it."""

    name: str
    words: str
    readers: tuple


@cache
def known_parameters():
    """Return a list of KnownParameters; a name with several definitions is listed repeatedly."""
    found = {}
    for reader, cls in READERS.items():
        for name, f in flatten(cls).items():
            key = name, value_text(f.default), remark(f)
            found.setdefault(key, []).append(reader)
    return [KnownParameter(name, default, words + _settable(name, readers), tuple(readers))
            for (name, default, words), readers in found.items()]


def _settable(name, readers):
    """Return a remark on the nodes that accept a parameter while they run, or ''."""
    takers = [reader for reader in readers if name in READERS[reader].SETTABLE]
    return f'; can be set while {" or ".join(takers)} runs' if takers else ''


@cache
def known_groups():
    """Return a list of KnownGroups; a name with several definitions is listed repeatedly."""
    found = {}
    for reader, cls in READERS.items():
        for name, group in groups_of(cls).items():
            words = sentence_of(group).replace('``', '')
            found.setdefault((name, words), []).append(reader)
    return [KnownGroup(*key, tuple(readers)) for key, readers in found.items()]
