"""Find the parameter files and launch files of the package in any kind of installation."""

from pathlib import Path
import sys

from ins_sim.settings.suggest import nearest_name

PACKAGE = 'ins_sim'


def share_directories():
    """
    Return the directories that may hold ``config`` and ``launch``, in the order of preference.

    They are the share directory of the ament index (colcon), that of the interpreter (pip) and
    the source tree (``pip install -e`` does not install data files).
    """
    directories = [Path(sys.prefix) / 'share' / PACKAGE, Path(__file__).resolve().parents[1]]
    try:
        from ament_index_python.packages import get_package_share_directory
        directories.insert(0, Path(get_package_share_directory(PACKAGE)))
    except (ImportError, OSError, LookupError):
        # ROS is missing, AMENT_PREFIX_PATH is not set, or the package is not in the index.
        pass
    return directories


def config(name):
    """Return the path of the parameter file ``name``, such as 'motion_2'."""
    return _find('config', name, '.yaml')


def config_names():
    """Return the names of the parameter files, sorted."""
    return _names('config', '.yaml')


def parameter_file(name):
    """
    Return the path of a parameter file given by path or by the name of a shipped one.

    Raises FileNotFoundError if it does not exist.
    """
    path = Path(name)
    if path.exists() and not path.is_dir():
        # Anything but a regular file is refused when it is read.
        return path
    if path.suffix or path.parent != Path('.'):
        raise FileNotFoundError(f'the parameter file {name} does not exist')
    return config(name)


def launch(name):
    """Return the path of the launch file ``name``, such as 'simulation'."""
    return _find('launch', name, '.launch.py')


def middleware_profile(name):
    """Return the path of the XML profile of a middleware, such as 'fastdds'."""
    return _find('config', name, '.xml')


def _find(folder, name, suffix):
    for directory in share_directories():
        path = directory / folder / f'{name}{suffix}'
        if path.is_file():
            return path
    known = _names(folder, suffix)
    if not known:
        raise FileNotFoundError(f'no {folder} named {name!r}; none was installed in '
                                + ', '.join(str(path) for path in share_directories()))
    raise FileNotFoundError(f'no {folder} named {name!r}; expected one of {", ".join(known)} '
                            f'(nearest: {nearest_name(name, known)})')


def _names(folder, suffix):
    return sorted({path.name.removesuffix(suffix) for directory in share_directories()
                   for path in (directory / folder).glob(f'*{suffix}')})
