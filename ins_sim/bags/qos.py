"""Quality of service as rosbag2 keeps it: a YAML list of the profiles that were offered."""

import yaml

_FOREVER = {'sec': 9223372036, 'nsec': 854775807}


class _Dumper(yaml.SafeDumper):
    """Indents lists and writes empty strings and nothing as yaml-cpp does."""

    def increase_indent(self, flow=False, indentless=False):
        return super().increase_indent(flow, False)

    def ignore_aliases(self, data):
        return True


_Dumper.add_representer(type(None), lambda d, _: d.represent_scalar('tag:yaml.org,2002:null',
                                                                    '~'))
_Dumper.add_representer(str, lambda d, value: d.represent_scalar(
    'tag:yaml.org,2002:str', value, style=None if value else '"'))


def dump(tree):
    """Return YAML in the style of rosbag2."""
    return yaml.dump(tree, Dumper=_Dumper, sort_keys=False, width=10**6, allow_unicode=True,
                     default_flow_style=False)


def profile(durability='volatile', reliability='reliable'):
    """Return one offered profile, as a recorder finds it by discovery."""
    return dump([{
        'history': 'unknown', 'depth': 0, 'reliability': reliability, 'durability': durability,
        'deadline': _FOREVER, 'lifespan': _FOREVER, 'liveliness': 'automatic',
        'liveliness_lease_duration': _FOREVER, 'avoid_ros_namespace_conventions': False}]).rstrip()


RELIABLE = profile()
LATCHED = profile('transient_local')


def profiles(text):
    """Return the profiles of a YAML list; ValueError if it is none."""
    try:
        tree = yaml.safe_load(text) or []
    except (yaml.YAMLError, RecursionError, ValueError) as error:
        raise ValueError(f'{text!r} is no YAML: {" ".join(str(error).split())}') from None
    if not isinstance(tree, list) or not all(isinstance(p, dict) for p in tree):
        raise ValueError(f'{text!r} is no list of quality of service profiles')
    return tree
