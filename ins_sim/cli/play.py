"""Verb play: publish the messages of a bag as live topics."""

HELP = 'publish the topics of a bag'
DESCRIPTION = ('Publish the messages of a rosbag2 bag as they were recorded. Give remappings and '
               'the namespace after --ros-args.')


def add_arguments(parser):
    """Add the arguments of the verb to its parser."""
    parser.add_argument('bag', metavar='BAG', help='folder of the bag, or one of its files')
    parser.add_argument('--topics', nargs='+', metavar='TOPIC', default=None,
                        help='topics to publish (default: all)')
    parser.add_argument('--rate', type=float, default=None, metavar='FACTOR', help='seconds '
                        'of the bag per second; 0 = as fast as the nodes of --lock-step allow '
                        '(default: 1, or 0 with --lock-step)')
    parser.add_argument('--start', type=float, default=0.0, metavar='S', help='start this many '
                        'seconds after the first message (default: %(default)s)')
    parser.add_argument('--duration', type=float, default=None, metavar='S',
                        help='play this many seconds of the bag (default: all)')
    parser.add_argument('--loop', action='store_true', help='start again at the end')
    parser.add_argument('--wait', type=float, default=1.0, metavar='S', help='wait at most this '
                        'long for a subscriber on every topic; not used with --lock-step '
                        '(default: %(default)s s)')
    parser.add_argument('--clock', nargs='?', type=float, const=100.0, default=None, metavar='HZ',
                        help='publish the time of the bag on /clock, at this rate (default: 100)')
    parser.add_argument('--lock-step', nargs='+', default=(), metavar='NODE', help='wait for the '
                        'acknowledgements of these nodes, such as strapdown')
    parser.add_argument('--window', type=int, default=200, metavar='N', help='number of '
                        'unacknowledged samples allowed in lock-step (default: %(default)s)')
    parser.add_argument('--timeout', type=float, default=30.0, metavar='S', help='time '
                        'without an acknowledgement after which the run ends with an error that '
                        'names the missing node (default: %(default)s s)')


def run(chosen):
    """Play; return the exit code of the node."""
    from ins_sim.ros.main import run_node
    from ins_sim.ros.recording.playing import Options
    options = Options(
        None if chosen.topics is None else tuple(chosen.topics), chosen.rate, chosen.start,
        chosen.duration, chosen.loop, chosen.wait, chosen.clock, tuple(chosen.lock_step),
        chosen.window, chosen.timeout)
    return run_node('player', chosen.ros_args, path=chosen.bag, options=options)
