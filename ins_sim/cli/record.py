"""Verb record: the node recorder, its parameters from the command line."""

import json

from ins_sim.ros.main import recorder


def run(chosen):
    """Record until a signal comes; return the exit code of the node."""
    parameters = {
        'record.topics': chosen.topics, 'record.all_topics': chosen.all,
        'record.log_time': chosen.log_time, 'storage.path': chosen.output,
        'storage.format': chosen.storage, 'storage.compression': chosen.compression,
        'storage.split_mb': chosen.max_size, 'storage.split_s': chosen.max_duration,
        'storage.replace': chosen.force}
    words = chosen.ros_args or ['--ros-args']
    for name, value in parameters.items():
        if value != []:
            # JSON is YAML, and quotes what YAML would take for something else
            words += ['-p', f'{name}:={json.dumps(value, ensure_ascii=False)}']
    return recorder(words)
