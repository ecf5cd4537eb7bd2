"""Purpose and values of the shipped parameter files."""

from dataclasses import dataclass
from pathlib import Path

from ins_sim import resources
from ins_sim.ros_parameters import Parameters
from ins_sim.yaml_text import read_bytes
from .known_settings import VERBS

# The kinds, with the heading of each list.
MOTIONS, INSTRUMENTS, STUDIES, OTHERS = 'motions', 'instruments', 'studies', 'others'
HEADS = {
    MOTIONS: 'motions, for simulate, predict and the nodes: --params-file NAME',
    INSTRUMENTS: 'instruments, added to a motion: --params-file MOTION --params-file NAME',
    STUDIES: 'studies, for the verb before the colon: --params-file NAME',
    OTHERS: 'others, for reference and for the nodes'}
# The files that hold every parameter with its default.
DEFAULTS = ('default', 'navigate')


@dataclass(frozen=True)
class ShippedFile:
    """
    A shipped parameter file.

    Attributes
    ----------
    name, path : name without suffix, and path
    head : list of the lines of the comment at the beginning of the file
    values : list of (node or '**' for all nodes, name of the parameter, value), in order
    """

    name: str
    path: Path
    head: list
    values: list

    @property
    def kind(self):
        """Return the kind of the file, a key of HEADS."""
        names = {name.partition('.')[0] for _, name, _ in self.values}
        if self.name in DEFAULTS:
            return OTHERS
        if self.verb:
            return STUDIES
        if 'motion' in names:
            return MOTIONS
        return INSTRUMENTS if names & {'gyro', 'accelerometer'} else OTHERS

    @property
    def verb(self):
        """Return the verb for which the file has a section, or ''."""
        return next((node.replace('_', '-') for node, _, _ in self.values if node in VERBS), '')

    @property
    def words(self):
        """Return the first sentence of the head; for a study, after the name of its verb."""
        told = []
        for line in self.head:
            if not line or line.startswith(' '):
                break
            told.append(line)
        text = ' '.join(told).partition('. ')[0].rstrip('.:,')
        return f'{self.verb}: {text}' if self.kind == STUDIES else text


def shipped_file(name):
    """Return the ShippedFile with a name; FileNotFoundError if no file has it."""
    path = resources.config(name)
    content, parameters = read_bytes(path), Parameters()
    parameters.add_file(content, str(path))
    head = []
    for line in content.decode('utf-8').splitlines():
        if not line.startswith('#'):
            break
        head.append(line[1:].removeprefix(' '))
    values = [(section.rpartition('/')[2], key, one.value)
              for section, key, one, _ in parameters.given()]
    return ShippedFile(name, path, head, values)


def shipped_files():
    """Return {kind: list of ShippedFiles sorted by name}; each file has one kind."""
    found = {kind: [] for kind in HEADS}
    for name in resources.config_names():
        file = shipped_file(name)
        found[file.kind].append(file)
    return found
