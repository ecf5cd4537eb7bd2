"""Verb record: run the node recorder with parameters from the command line."""

import json

from . import arguments

HELP = 'record live topics into a bag'
DESCRIPTION = ('Record live topics into a rosbag2 bag until Ctrl-C. Give remappings and the '
               'namespace after --ros-args.')


def add_arguments(parser):
    """Add the arguments of the verb to its parser."""
    parser.add_argument('topics', nargs='*', metavar='TOPIC', help='topic to record; a topic '
                        'that does not exist yet is recorded once it appears')
    parser.add_argument('--all', action='store_true', help='record every topic')
    arguments.add_output(parser, 'ins_sim_bag', 'folder of the bag')
    arguments.add_force(parser, 'the bag in DIR')
    arguments.add_storage(parser)
    parser.add_argument('--max-size', type=float, default=0.0, metavar='MB',
                        help='file size at which a new file is begun (default: never)')
    parser.add_argument('--max-duration', type=float, default=0.0, metavar='S',
                        help='span of time at which a new file is begun (default: never)')
    parser.add_argument('--log-time', choices=('stamp', 'received'), default='stamp',
                        help='log a message at its header stamp or at the time of reception '
                        '(default: %(default)s)')


def run(chosen):
    """Record until a signal is received; return the exit code of the node."""
    from ins_sim.ros.main import recorder
    parameters = {
        'record.topics': chosen.topics, 'record.all_topics': chosen.all,
        'record.log_time': chosen.log_time, 'storage.path': chosen.output,
        'storage.format': chosen.storage, 'storage.compression': chosen.compression,
        'storage.split_mb': chosen.max_size, 'storage.split_s': chosen.max_duration,
        'storage.replace': chosen.force}
    words = chosen.ros_args or ['--ros-args']
    for name, value in parameters.items():
        if value != []:
            # JSON is valid YAML, and quotes texts that YAML would read as another type.
            words += ['-p', f'{name}:={json.dumps(value, ensure_ascii=False)}']
    return recorder(words)
