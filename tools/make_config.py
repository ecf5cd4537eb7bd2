"""Write config/default.yaml, navigate.yaml and the presets from the catalogues of settings."""

from dataclasses import is_dataclass, fields
from pathlib import Path
import textwrap

from ins_sim.settings.aided_navigator import AidedNavigatorSettings
from ins_sim.settings.navigate import NAVIGATE
from ins_sim.settings.by_node import ALL_NODES
from ins_sim.settings.presets import PRESETS, strapdown_values
from ins_sim.settings.motion import MotionGeneratorSettings

SHARED = ('datum', 'earth', 'frames', 'tf', 'time', 'motion', 'topics')
# of an instrument and the navigator: a file over this one sets them in its section /** as well,
# where they would lose against those of a node here
AGREED = ('window', 'gnss')
HEAD = """\
# Every parameter of the nodes with its default.  Written by tools/make_config.py from
# ins_sim/settings; a test keeps it in step.  One number stands for three equal ones in noise,
# biases, scale factors and sigmas by axis.  Overlays beside this file hold the studies:
#   ros2 run ins_sim strapdown --ros-args --params-file default.yaml --params-file motion_1.yaml
"""
FLOOR = ('"In-run" is the lowest Allan deviation, the figure of data sheets: bias_instability, '
         'the B of IEEE Std 952, is that over 0.664.')


def text(value):
    """Return a value as YAML that ROS reads with the right type."""
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, tuple):
        return '[' + ', '.join(text(v) for v in value) + ']'
    return repr(value) if isinstance(value, float) else f'"{value}"' if value == '' else str(value)


def remark(f, settable):
    """Return the comment of a field: doc, unit, range, choices, whether it can be set later."""
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


def lines(cls, indent, skip=(), settable=None, prefix=''):
    """Yield the lines of a settings class; settable: names, by default those of the class."""
    pad, settable = ' ' * indent, cls.SETTABLE if settable is None else settable
    for f in fields(cls):
        if f.name in skip:
            continue
        if is_dataclass(f.default_factory):
            doc = f.default_factory.__doc__.strip().splitlines()[0]
            yield f'{pad}{f.name}:  # {doc}'
            yield from lines(f.default_factory, indent + 2, (), settable, f'{prefix}{f.name}.')
        else:
            for line in textwrap.wrap(remark(f, prefix + f.name in settable), 97 - indent):
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
    out += [f'# {line}' for line in textwrap.wrap(FLOOR, 95)]
    out += ['# Written by tools/make_config.py from ins_sim/settings/presets.py.',
            '/**/imu_sensor:', '  ros__parameters:']
    out += [f'    {key}: {text(value)}' for key, value in preset.values.items()]
    out += ['', '# The covariances of ins/* are of the same instrument.', '/**/strapdown:',
            '  ros__parameters:']
    out += [f'    {key}: {text(value)}' for key, value in strapdown_values(preset).items()]
    if 'output' in preset.values:
        out += [f'    input: {preset.values["output"]}']
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
