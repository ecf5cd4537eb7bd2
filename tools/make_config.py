"""Write config/default.yaml, navigate.yaml and the presets from the catalogues of settings."""

from dataclasses import is_dataclass, fields
from pathlib import Path
import textwrap

from ins_sim.settings.navigate import NAVIGATE
from ins_sim.settings.by_node import ALL_NODES
from ins_sim.settings.catalogue import flatten, remark, sentence_of, value_text
from ins_sim.settings.presets import navigator_values, PRESETS

HEAD = """\
# Every parameter of the nodes with its default, to look up and to copy from.  It need not be
# loaded, because the nodes have the same defaults.  Written by tools/make_config.py from
# ins_sim/settings; a test keeps it in step.  Under /** is whatever has one default in all nodes
# that know it, under the node the rest.  One number stands for three equal ones in noise, biases,
# scale factors and sigmas by axis.  The files beside this one hold motions, delays, instruments
# and studies.
"""
FLOOR = ('"In-run" is the lowest Allan deviation, the figure of data sheets: bias_instability, '
         'the B of IEEE Std 952, is that over 0.664.')


def lines(cls, indent):
    """Yield the lines of a settings class."""
    yield from written(tree(cls), indent)


def tree(cls, settable=None, prefix=''):
    """
    Return {name: (field, whether it can be set later), or (doc, tree) of a group} of a class.

    settable: names, by default those of the class.
    """
    settable = cls.SETTABLE if settable is None else settable
    return {f.name: (sentence_of(f.default_factory),
                     tree(f.default_factory, settable, f'{prefix}{f.name}.'))
            if is_dataclass(f.default_factory) else (f, prefix + f.name in settable)
            for f in fields(cls)}


def merged(one, other):
    """Return the tree with the names of both; what can be set later in one of them is so."""
    found = dict(one)
    for name, (head, rest) in other.items():
        if name in found:
            head, before = found[name]
            rest = merged(before, rest) if isinstance(rest, dict) else before or rest
        found[name] = head, rest
    return found


def written(names, indent):
    """Yield the lines of a tree."""
    pad = ' ' * indent
    for name, (head, rest) in names.items():
        if isinstance(rest, dict):
            yield f'{pad}{name}:  # {head}'
            yield from written(rest, indent + 2)
        else:
            for line in textwrap.wrap(remark(head, rest), 97 - indent):
                yield f'{pad}# {line}'
            yield f'{pad}{name}: {value_text(head.default)}'


def of_nodes_alone():
    """Return the names, groups as a whole, that have another default in another node."""
    defaults = {}
    for cls in ALL_NODES.values():
        for name, f in flatten(cls).items():
            defaults.setdefault(name, set()).add(repr(f.default))
    return {name.partition('.')[0] for name, found in defaults.items() if len(found) > 1}


def document():
    """Return the whole file."""
    alone, common = of_nodes_alone(), {}
    for cls in ALL_NODES.values():
        common = merged(common, tree(cls))
    out = [HEAD.rstrip(), '', '/**:', '  ros__parameters:']
    before = None
    for name, entry in common.items():
        if name not in alone:
            knowing = [node for node, cls in ALL_NODES.items() if name in tree(cls)]
            if knowing != before:
                out += [f'    # --- {line}' for line in textwrap.wrap(', '.join(knowing), 90)]
            out += written({name: entry}, 4)
            before = knowing
    for node, cls in ALL_NODES.items():
        own = {name: entry for name, entry in tree(cls).items() if name in alone}
        if own:
            out += ['', f'/**/{node}:', '  ros__parameters:', *written(own, 4)]
    return '\n'.join(out) + '\n'


def preset_document(preset):
    """Return the overlay of an instrument preset."""
    out = [f'# Errors of a {preset.datasheet}.', '#']
    out += [f'# {line}' for line in textwrap.wrap(preset.figures, 95)]
    out += [f'# {line}' for line in textwrap.wrap(FLOOR, 95)]
    out += ['# Written by tools/make_config.py from ins_sim/settings/presets.py.',
            '/**:', '  ros__parameters:',
            '    # of imu_sensor, and of strapdown for its covariances']
    out += [f'    {key}: {value_text(value)}' for key, value in preset.values.items()]
    if 'output' in preset.values:
        out += [f'    input: {preset.values["output"]}']
    out += ['    # of aided_navigator']
    out += [f'    {key}: {value_text(value)}' for key, value in navigator_values(preset).items()]
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
