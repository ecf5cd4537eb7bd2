"""metadata.yaml of rosbag2, and the quality of service it has of each topic."""

from dataclasses import dataclass
from pathlib import Path, PurePosixPath

import yaml

NAME = 'metadata.yaml'
TOP = 'rosbag2_bagfile_information'
NEWEST = 9


@dataclass(frozen=True)
class Metadata:
    """What a reader needs of metadata.yaml: storage and the names of the files in order."""

    storage: str
    files: tuple


def read(folder):
    """
    Return the Metadata of a bag, or None where it has none.

    Raises ValueError if it cannot be read, is too new, or says that the files are compressed.
    """
    path = Path(folder) / NAME
    try:
        content = path.read_text(encoding='utf-8')
    except FileNotFoundError:
        return None
    except UnicodeDecodeError:
        raise ValueError(f'{path} is no UTF-8') from None
    try:
        tree = yaml.safe_load(content)
    except (yaml.YAMLError, RecursionError, ValueError) as error:
        raise ValueError(f'{path} is no YAML: {" ".join(str(error).split())}') from None
    info = tree.get(TOP) if isinstance(tree, dict) else None
    if not isinstance(info, dict):
        raise ValueError(f'{path} has no {TOP}; expected the metadata of a rosbag2 bag')
    version, storage = info.get('version'), info.get('storage_identifier')
    if not isinstance(version, int) or version > NEWEST:
        raise ValueError(f'{path} has the version {version!r}; expected at most {NEWEST}')
    mode = str(info.get('compression_mode') or 'none').lower()
    if mode != 'none':
        raise ValueError(f'{folder} is compressed by {mode} ({info.get("compression_format")}); '
                         'expected a bag without it, or with compressed MCAP chunks '
                         '("ros2 bag convert" makes one)')
    if storage not in ('mcap', 'sqlite3'):
        raise ValueError(f'{path} has the storage {storage!r}; expected mcap or sqlite3')
    files = info.get('relative_file_paths')
    if not isinstance(files, list) or not files or not all(isinstance(f, str) for f in files):
        raise ValueError(f'{path} has the relative_file_paths {files!r}; expected names of files')
    # rosbag2 once wrote paths from where it was started; the files are beside their metadata
    return Metadata(storage, tuple(PurePosixPath(f).name for f in files))
