"""Find the definitions of message types that are installed in ROS but unknown to ins_sim."""

from pathlib import Path
import re
import sys

_FIELD = re.compile(r'^\s*([A-Za-z]\w*(?:/\w+)*)(?:<=\d+)?(?:\[[^\]]*\])?\s+\w+', re.MULTILINE)
_BUILT_IN = {'bool', 'byte', 'char', 'float32', 'float64', 'int8', 'uint8', 'int16', 'uint16',
             'int32', 'uint32', 'int64', 'uint64', 'string', 'wstring'}


def installed_definition(type_name):
    """
    Return the definition of a type and of the types that it contains, in the format ros2msg.

    It is read from the .msg files in the share directories. Raises ValueError if one is missing.
    """
    texts, waiting = {}, [type_name]
    while waiting:
        name = waiting.pop(0)
        if name not in texts:
            texts[name] = _read(name)
            waiting += _parts(name, texts[name])
    first, *others = texts.items()
    return first[1] + ''.join(
        f'\n{"=" * 80}\nMSG: {name.replace("/msg/", "/")}\n{text}' for name, text in others)


def _parts(type_name, text):
    """Return the names of the types of the fields of a definition."""
    package = type_name.partition('/')[0]
    code = re.sub(r'#.*', '', text)
    for word in dict.fromkeys(_FIELD.findall(code)):
        if word in _BUILT_IN:
            continue
        parts = word.split('/')
        yield f'{parts[0] if len(parts) > 1 else package}/msg/{parts[-1]}'


def _read(type_name):
    package, _, name = type_name.split('/')
    directories = [Path(sys.prefix) / 'share' / package]
    try:
        from ament_index_python.packages import get_package_share_directory
        directories.insert(0, Path(get_package_share_directory(package)))
    except (ImportError, OSError, LookupError):
        # AMENT_PREFIX_PATH is not set, or the package is not in the index.
        pass
    for directory in directories:
        path = directory / 'msg' / f'{name}.msg'
        if path.is_file():
            return path.read_text(encoding='utf-8')
    raise ValueError(f'the definition of {type_name} is not installed; expected '
                     f'{directories[0] / "msg" / name}.msg')
