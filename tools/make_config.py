"""Write config/default.yaml, navigate.yaml and the presets from the catalogues of settings."""

from dataclasses import is_dataclass, fields
from pathlib import Path
import textwrap

from ins_sim.settings.aided_navigator import AidedNavigatorSettings
from ins_sim.settings.navigate import NAVIGATE
from ins_sim.settings.by_node import ALL_NODES
from ins_sim.settings.presets import PRESETS
from ins_sim.settings.motion import MotionGeneratorSettings

SHARED = ('datum', 'earth', 'frames', 'tf', 'time', 'motion', 'topics')
# of an instrument and the navigator: a file over this one sets them in its section /** as well,
# where they would lose against those of a node here
AGREED = ('window', 'gnss')
HEAD = """\
# Every parameter of the nodes with its default.  Written by tools/make_config.py from
# ins_sim/settings; a test keeps it in step.  Overlays beside this file hold the studies:
#   ros2 run ins_sim strapdown --ros-args --params-file default.yaml --params-file motion_1.yaml
"""


def text(value):
    """Return a value as YAML that ROS reads with the right type."""
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, tuple):
        return '[' + ', '.join(text(v) for v in value) + ']'
    return repr(value) if isinstance(value, float) else f'"{value}"' if value == '' else str(value)


def remark(f):
    """Return the comment of a field: doc, unit, range, choices."""
    m = f.metadata
    parts = [m['doc']]
    if m['unit']:
        parts[0] += f' [{m["unit"]}]'
    if m['low'] is not None:
        parts.append(f'{m["low"]:g} to {m["high"]:g}')
    if m['choices']:
        parts.append('one of ' + ', '.join(m['choices']))
    return '; '.join(parts)


def lines(cls, indent, skip=()):
    """Yield the lines of a settings class."""
    pad = ' ' * indent
    for f in fields(cls):
        if f.name in skip:
            continue
        if is_dataclass(f.default_factory):
            doc = f.default_factory.__doc__.strip().splitlines()[0]
            yield f'{pad}{f.name}:  # {doc}'
            yield from lines(f.default_factory, indent + 2)
        else:
            for line in textwrap.wrap(remark(f), 97 - indent):
                yield f'{pad}# {line}'
            yield f'{pad}{f.name}: {text(f.default)}'


def document():
    """Return the whole file."""
    out = [HEAD.rstrip(), '', '/**:', '  ros__parameters:']
    own = [f.name for f in fields(MotionGeneratorSettings) if f.name not in SHARED]
    out += lines(MotionGeneratorSettings, 4, skip=own)
    out += lines(AidedNavigatorSettings, 4, skip=[f.name for f in fields(AidedNavigatorSettings)
                                                  if f.name not in AGREED])
    for node, cls in ALL_NODES.items():
        out += ['', f'/**/{node}:', '  ros__parameters:', *lines(cls, 4, skip=SHARED + AGREED)]
    return '\n'.join(out) + '\n'


def preset_document(preset):
    """Return the overlay of an instrument preset."""
    out = [f'# Instrument errors of a {preset.datasheet}.', '#']
    out += [f'# {line}' for line in textwrap.wrap(preset.figures, 95)]
    out += ['# Written by tools/make_config.py from ins_sim/settings/presets.py.',
            '/**/imu_sensor:', '  ros__parameters:']
    out += [f'    {key}: {text(value)}' for key, value in preset.values.items()]
    if 'output' in preset.values:
        out += ['', '/**/strapdown:', '  ros__parameters:',
                f'    input: {preset.values["output"]}']
    return '\n'.join(out) + '\n'


def navigate_document():
    """Return the file of the command navigate."""
    out = ['# Every parameter of "ins_sim navigate" with its default.  Written by',
           '# tools/make_config.py from ins_sim/settings/navigate.py.']
    for name, cls in NAVIGATE.items():
        out += [f'/**/{name}:', '  ros__parameters:', *lines(cls, 4)]
    return '\n'.join(out) + '\n'


def documents():
    """Return {file name: text} of every written file."""
    return {'default.yaml': document(), 'navigate.yaml': navigate_document(),
            **{f'imu_{name}.yaml': preset_document(p) for name, p in PRESETS.items()}}


if __name__ == '__main__':
    for name, content in documents().items():
        (Path(__file__).resolve().parents[1] / 'config' / name).write_text(content,
                                                                           encoding='utf-8')
