"""Arguments that several verbs share, and the settings that they name."""

from ins_sim import parameter_files, resources


def add_settings(parser, default=''):
    """Add --params-file and -p; default: the files that are read where none is named."""
    parser.add_argument('--params-file', action='append', default=[], metavar='FILE',
                        help='ROS parameter file, or the name of a shipped one such as motion_2; '
                        'may be repeated, later ones win'
                        + (f' (default: {default})' if default else ''))
    parser.add_argument('-p', '--param', action='append', default=[], metavar='NAME:=VALUE',
                        help='one parameter, for every node that knows it')


def add_storage(parser):
    """Add --storage and --compression of a bag."""
    parser.add_argument('--storage', choices=('mcap', 'sqlite3'), default='mcap',
                        help='storage of the bag (default: %(default)s)')
    parser.add_argument('--compression', choices=('none', 'lz4', 'zstd'), default='none',
                        help='compression of its chunks, of mcap (default: %(default)s)')


def read(chosen):
    """Return SimulationSettings of --params-file and -p."""
    return parameter_files.read([resources.parameter_file(name) for name in chosen.params_file],
                                chosen.param)


def read_simulation(chosen):
    """
    Return SimulationSettings, and with --aided the AidedSimulationSettings that they are of, or
    None.
    """
    if not chosen.aided:
        return read(chosen), None
    aided = parameter_files.read_aided(
        [resources.parameter_file(name) for name in chosen.params_file], chosen.param)
    return aided.simulation, aided
