"""Quality of service in the form of rosbag2: a YAML list of the offered profiles."""

from functools import lru_cache

from ins_sim.settings.shown import shown
from ins_sim.yaml_text import load
from .bag_yaml import dump_yaml

_FOREVER = {'sec': 9223372036, 'nsec': 854775807}


def profile_yaml(durability='volatile', reliability='reliable'):
    """Return an offered profile as YAML, in the form that a recorder finds by discovery."""
    return dump_yaml([{
        'history': 'unknown', 'depth': 0, 'reliability': reliability, 'durability': durability,
        'deadline': _FOREVER, 'lifespan': _FOREVER, 'liveliness': 'automatic',
        'liveliness_lease_duration': _FOREVER, 'avoid_ros_namespace_conventions': False}])


RELIABLE = profile_yaml()
LATCHED = profile_yaml('transient_local')


@lru_cache(maxsize=100)
def read_profiles(text):
    """Return the profiles of a YAML list; raise ValueError if it is not such a list."""
    try:
        tree = load(text) or []
    except ValueError as error:
        raise ValueError(f'{shown(text)} {error}') from None
    if not isinstance(tree, list) or not all(isinstance(p, dict) for p in tree):
        raise ValueError(f'{shown(text)} is not a list of quality of service profiles')
    return tree
