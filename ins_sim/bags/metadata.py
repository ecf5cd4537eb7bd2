"""Read and write metadata.yaml of rosbag2, with the quality of service of each topic."""

from dataclasses import dataclass
from pathlib import Path, PurePosixPath

from ins_sim.settings.shown import cut, shown
from ins_sim.yaml_text import load, read_bytes
from .bag_yaml import dump_yaml
from .qos import read_profiles

NAME = 'metadata.yaml'
TOP = 'rosbag2_bagfile_information'
NEWEST = 9


@dataclass(frozen=True)
class Metadata:
    """The part of metadata.yaml that a reader needs: storage and names of the files in order."""

    storage: str
    files: tuple


def read_metadata(folder):
    """
    Return the Metadata of a bag, or None if it has none.

    Raises ValueError if it cannot be read, has too new a version, or the files are compressed.
    """
    path = Path(folder) / NAME
    try:
        content = read_bytes(path)
    except FileNotFoundError:
        return None
    try:
        tree = load(content)
    except ValueError as error:
        raise ValueError(f'{path} {error}') from None
    info = tree.get(TOP) if isinstance(tree, dict) else None
    if not isinstance(info, dict):
        raise ValueError(f'{path} has no {TOP}; expected the metadata of a rosbag2 bag')
    version, storage = info.get('version'), info.get('storage_identifier')
    if not isinstance(version, int) or version > NEWEST:
        raise ValueError(f'{path} has the version {shown(version)}; expected at most {NEWEST}')
    mode = str(info.get('compression_mode') or 'none').lower()
    if mode != 'none':
        codec = cut(str(info.get('compression_format')))
        raise ValueError(f'{folder} is compressed by {cut(mode)} ({codec}); expected a bag '
                         'without this compression, or with compressed MCAP chunks '
                         '(convert it with "ros2 bag convert")')
    if storage not in ('mcap', 'sqlite3'):
        raise ValueError(f'{path} has the storage {shown(storage)}; expected mcap or sqlite3')
    files = info.get('relative_file_paths')
    if not isinstance(files, list) or not files or not all(isinstance(f, str) for f in files):
        raise ValueError(f'{path} has the relative_file_paths {shown(files)}; expected names of '
                         'files')
    # Old versions of rosbag2 wrote paths relative to where they were started.
    return Metadata(storage, tuple(PurePosixPath(f).name for f in files))


@dataclass(frozen=True)
class FileCounts:
    """A file of a bag: name, number of messages by topic, first and last log time."""

    name: str
    counts: dict
    first_ns: int | None
    last_ns: int | None


def metadata_text(storage, topics, files):
    """
    Return metadata.yaml as rosbag2 of ROS 2 Jazzy writes it (version 9).

    topics are Channels, files the FileCounts in order.
    """
    return dump_yaml({TOP: metadata_tree(storage, topics, files)}) + '\n'


def inner_text(storage, topics, files):
    """Return the part of the metadata that rosbag2 stores inside a file of the bag."""
    return dump_yaml(metadata_tree(storage, topics, files))


def metadata_tree(storage, topics, files):
    """Return metadata.yaml as dicts and lists."""
    firsts = [f.first_ns for f in files if f.first_ns is not None]
    lasts = [f.last_ns for f in files if f.last_ns is not None]
    first, last = min(firsts, default=0), max(lasts, default=0)
    return {
        'version': NEWEST,
        'storage_identifier': storage,
        **_duration(first, last),
        'message_count': sum(sum(f.counts.values()) for f in files),
        'topics_with_message_count': [
            {'topic_metadata': {
                'name': topic.name,
                'type': topic.type_name,
                'serialization_format': topic.encoding,
                'offered_qos_profiles': read_profiles(topic.qos),
                'type_description_hash': topic.type_hash},
             'message_count': sum(f.counts.get(topic.name, 0) for f in files)}
            for topic in topics],
        'compression_format': '',
        'compression_mode': '',
        'relative_file_paths': [f.name for f in files],
        'files': [{'path': f.name, **_start(f), 'message_count': sum(f.counts.values())}
                  for f in files],
        'custom_data': None,
        'ros_distro': 'jazzy',
    }


def _duration(first_ns, last_ns):
    return {'duration': {'nanoseconds': last_ns - first_ns},
            'starting_time': {'nanoseconds_since_epoch': first_ns}}


def _start(file):
    spans = _duration(file.first_ns or 0, file.last_ns or 0)
    return {'starting_time': spans['starting_time'], 'duration': spans['duration']}
