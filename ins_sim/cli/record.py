"""Verb record: the node recorder, its parameters from the command line."""

import json

from . import arguments

HELP = 'record live topics into a bag'
DESCRIPTION = ('Record live topics into a rosbag2 bag, until Ctrl-C. Behind --ros-args stand '
               'remappings and the namespace.')


def add_arguments(parser):
    """Add the arguments of the verb to its parser."""
    parser.add_argument('topics', nargs='*', metavar='TOPIC', help='topic to record; one that is '
                        'not there yet is waited for')
    parser.add_argument('--all', action='store_true', help='record every topic')
    arguments.add_output(parser, 'ins_sim_bag', 'folder of the bag')
    arguments.add_force(parser, 'the bag in DIR')
    arguments.add_storage(parser)
    parser.add_argument('--max-size', type=float, default=0.0, metavar='MB',
                        help='begin another file where one is as large')
    parser.add_argument('--max-duration', type=float, default=0.0, metavar='S',
                        help='begin another file where one spans as much')
    parser.add_argument('--log-time', choices=('stamp', 'received'), default='stamp',
                        help='log a message at the stamp of its header, or when it came '
                        '(default: %(default)s)')


def run(chosen):
    """Record until a signal comes; return the exit code of the node."""
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
            # JSON is YAML, and quotes what YAML would take for something else.
            words += ['-p', f'{name}:={json.dumps(value, ensure_ascii=False)}']
    return recorder(words)
