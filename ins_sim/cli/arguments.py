"""Command-line arguments shared by several verbs, and the settings read from them."""


def add_settings(parser, default=''):
    """Add --params-file and -p; default names the files that are read if none is given."""
    parser.add_argument('--params-file', action='append', default=[], metavar='FILE',
                        help='ROS parameter file, or the name of a shipped one such as motion_2; '
                        'may be repeated; a section of a later file overrides the same '
                        'section of an earlier one'
                        + (f' (default: {default})' if default else ''))
    parser.add_argument('-p', '--param', action='append', default=[], metavar='NAME:=VALUE',
                        help='value of a parameter, for every node that has it. As in ROS 2, the '
                        'section of a node in a parameter file overrides it; '
                        'NODE:NAME:=VALUE overrides that too')


def add_output(parser, default, content):
    """Add -o; ``default`` is a folder, ``content`` describes it, such as 'folder of the run'."""
    parser.add_argument('-o', '--output', default=default, metavar='DIR',
                        help=f'{content} (default: %(default)s)')


def add_force(parser, replaced):
    """Add --force; ``replaced`` describes what it replaces, such as 'the run in DIR'."""
    parser.add_argument('--force', action='store_true', help=f'replace {replaced}')


def add_jobs(parser):
    """Add --jobs and --scheduler."""
    parser.add_argument('--jobs', type=int, default=0, metavar='N', help='number of '
                        'processes (default: one for each core)')
    parser.add_argument('--scheduler', metavar='ADDRESS', default=None, help='compute on the Dask '
                        'cluster of this scheduler, such as tcp://host:8786 (needs the pip extra '
                        'cluster)')


def add_tables(parser):
    """Add --csv and --tum, which write further files."""
    parser.add_argument('--csv', action='store_true', help='also write every record as a CSV '
                        'table, for pandas, MATLAB or a spreadsheet')
    parser.add_argument('--tum', action='store_true', help='also write the trajectories as TUM '
                        'files, for evo')


def add_thin(parser):
    """Add --thin."""
    parser.add_argument('--thin', type=int, default=1, metavar='N', help='write only every '
                        'N-th output instant of truth, solution and errors; the IMU record is '
                        'not thinned, and figures and printed tables use all instants '
                        '(default: %(default)s)')


def add_storage(parser):
    """Add --storage and --compression of a bag."""
    parser.add_argument('--storage', choices=('mcap', 'sqlite3'), default='mcap',
                        help='storage of the bag (default: %(default)s)')
    parser.add_argument('--compression', choices=('none', 'lz4', 'zstd'), default='none',
                        help='compression of the chunks of an mcap bag (default: %(default)s)')


def parameter_paths(chosen, default=()):
    """Return the paths of --params-file, or of the shipped files named by default."""
    from ins_sim import resources
    return ([resources.parameter_file(name) for name in chosen.params_file]
            or [resources.config(name) for name in default])


def read_settings(chosen):
    """Return SimulationSettings of --params-file and -p."""
    from ins_sim import parameter_files
    return parameter_files.read(parameter_paths(chosen), chosen.param)


def read_aided_settings(chosen, default=()):
    """Return AidedSimulationSettings of --params-file, or the default files, and -p."""
    from ins_sim import parameter_files
    return parameter_files.read_aided(parameter_paths(chosen, default), chosen.param)
