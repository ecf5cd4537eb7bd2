"""Choose a topic of a bag by name or type."""

from ins_sim.settings.shown import listed, shown
from ins_sim.settings.suggest import nearest_name


def choose_topic(bag, types, wanted, key, ending='', needed=False):
    """
    Return the name of a topic of one of the types, or None.

    Parameters
    ----------
    bag : BagReader
    types : accepted message types
    wanted : topic name, 'auto' for the only one whose name ends in ending, or 'none'
    key : parameter that gives wanted, for messages
    ending : end of the name for 'auto'
    needed : whether a topic must be found

    Raises
    ------
    ValueError
        If 'auto' finds several topics, or none though one is needed; if there is no topic of this
        name, or it has another type.
    """
    if wanted == 'none' and not needed:
        return None
    known = sorted(c.name for c in bag.topics.values() if c.type_name in types)
    if wanted == 'auto':
        known = [name for name in known if f'/{name}'.endswith(f'/{ending}' if ending else '')]
        if len(known) > 1:
            raise ValueError(f'{bag.path} has {len(known)} topics of {short_names(types)}: '
                             f'{listed(known)}; expected {key} to name one'
                             + ('' if needed else ', or none'))
        if needed and not known:
            where = f' whose name ends in {ending}' if ending else ''
            raise ValueError(f'{bag.path} has no {short_names(types)}{where}; it has '
                             f'{listed(sorted(bag.topics)) or "no topic"}')
        return known[0] if known else None
    name = wanted if wanted in bag.topics else '/' + wanted.lstrip('/')
    if name not in bag.topics:
        what = f'; the nearest is {nearest_name(name, known)!r}' if known else ''
        raise ValueError(f'{bag.path} has no topic {shown(wanted)}, the value of {key}{what}')
    type_name = bag.topics[name].type_name
    if type_name not in types:
        raise ValueError(f'{bag.path}: {name}, the value of {key}, has type '
                         f'{short_names([type_name])}; expected {short_names(types)}')
    return name


def short_names(types):
    """Return type names in the short form for messages: sensor_msgs/Imu or ..."""
    return ' or '.join(t.replace('/msg/', '/') for t in types)
