"""The arguments of the launch files, and the checks of their values that do not need ROS."""

from dataclasses import dataclass
from pathlib import Path
import re

from ins_sim import resources
from ins_sim.settings.shown import shown
from ins_sim.settings.suggest import nearest_name

# Shipped parameter files that contain only a motion; a test compares them with the files.
MOTIONS = ('aggressive', 'cruise', 'gnss_outage_flight', 'guided_flight', 'motion_1', 'motion_2',
           'motion_2_detuned', 'racetrack', 'recorded_flight', 'route_flight')
INSTRUMENTS = ('imu_navigation_rlg', 'imu_tactical_dtg', 'imu_tactical_fog', 'imu_tactical_mems')
# Arguments that launch itself adds to every launch file.
OF_LAUNCH = ('launch-prefix', 'launch-prefix-filter', 'emulate_tty', 'sigterm_timeout',
             'sigkill_timeout')
BOOLEANS = {'true': True, 'false': False}


@dataclass(frozen=True)
class Argument:
    """
    An argument of a launch file.

    Attributes
    ----------
    default : None if the argument is required
    kind : str, float or bool; for the last two '' means None (not given)
    choices : allowed values, if there are few
    """

    name: str
    default: str | None
    doc: str
    kind: type = str
    choices: tuple[str, ...] = ()


_FILES = Argument('params_file', '', 'parameter files, separated by commas or spaces: paths, or '
                  'names of shipped files; a later file overrides the same section of an earlier '
                  'one')
_IMU = Argument('imu', '', 'instrument errors: ' + ', '.join(INSTRUMENTS) + ', or a path; empty = '
                'as in the parameter files, or an ideal IMU')
_NAMESPACE = Argument('namespace', '', 'namespace of the nodes')
_RATE = Argument('rate_hz', '', 'rate of the truth and of the IMU in all nodes, Hz; empty = as '
                 'in the parameter files, or 100', float)
_PREFIX = Argument('prefix', '', 'prefix of all frames, such as uav1; empty = as in the parameter '
                   'files')
_SHUTDOWN = Argument('shutdown', 'true', 'true or false: the end of the run ends the whole '
                     'launch (true) or only the nodes of this file (false). A node that fails '
                     'always ends the launch',
                     bool)

SIMULATION = (
    Argument('motion', '', 'motion: ' + ', '.join(MOTIONS) + ', or a path; empty = as in the '
             'parameter files, or the racetrack'),
    _IMU, _FILES, _RATE,
    Argument('aided', 'false', 'true or false: also start velocity_meter, gnss and '
             'aided_navigator', bool),
    Argument('one_process', 'false', 'true or false: run all nodes except the recorder in one '
             'process, the executable simulation', bool),
    _NAMESPACE, _PREFIX,
    Argument('tf', '', 'source of the transforms on /tf: none, truth, ins or aided; empty = as in '
             'the parameter files, or ins (aided with aided:=true)',
             choices=('none', 'truth', 'ins', 'aided')),
    Argument('real_time_factor', '', 'simulated seconds per second, 0 = as fast as possible; '
             'empty = as in the parameter files, or 1', float),
    Argument('lock_step', '', 'true or false: wait for the consumers, so that nothing is lost; '
             'empty = true with record, else as in the parameter files, or false', bool),
    Argument('record', '', 'folder of a new bag for the topics of the nodes; empty = none'),
    Argument('use_sim_time', 'false', 'true or false: the nodes take their time from /clock, '
             'which the generator then publishes', bool),
    _SHUTDOWN)

REPLAY = (
    Argument('bag', None, 'folder of the bag; it must contain truth/odometry, and truth/imu '
             'or imu/data_raw'),
    Argument('source', 'imu', 'imu: play the readings into the strapdown; truth: play the truth '
             'into the IMU, which feeds the strapdown', choices=('imu', 'truth')),
    _IMU, _FILES, _RATE, _NAMESPACE, _PREFIX,
    Argument('tf', '', 'source of the transforms on /tf: none or ins; empty = as in the '
             'parameter files, or ins', choices=('none', 'ins')),
    Argument('rate', '', 'seconds of the bag per second, 0 = as fast as possible; empty = 1, and '
             '0 in lock-step', float),
    Argument('lock_step', 'true', 'true or false: wait for the strapdown, so that nothing is '
             'lost', bool),
    Argument('loop', 'false', 'true or false: start again at the end', bool),
    Argument('use_sim_time', 'false', 'true or false: the nodes take their time from /clock, '
             'which is then played or published', bool),
    _SHUTDOWN)

# Arguments of each launch file of the package.
LAUNCH_FILES = {'simulation.launch.py': SIMULATION, 'replay.launch.py': REPLAY}


def check_names(given, arguments):
    """Raise ValueError for a name that is not one of the arguments."""
    known = {argument.name for argument in arguments}
    for name in given:
        if name not in known and name not in OF_LAUNCH:
            raise ValueError(f'unknown launch argument {shown(name)}; the nearest known one is '
                             f'{nearest_name(name, known)!r}')


def read_values(texts, arguments):
    """
    Convert {name: text} to {name: value}; values that were not given are None or ''.

    Raises ValueError with a message that names argument, value and expectation.
    """
    return {argument.name: _value(argument, texts[argument.name]) for argument in arguments}


def _value(argument, text):
    name = argument.name
    if argument.kind is str:
        if argument.choices and text and text not in argument.choices:
            raise ValueError(f'{name} is {shown(text)}; expected one of '
                             f'{", ".join(argument.choices)} (nearest: '
                             f'{nearest_name(text, argument.choices)})')
        return text
    if not text:
        return None
    if argument.kind is bool:
        if text.lower() not in BOOLEANS:
            raise ValueError(f'{name} is {shown(text)}; expected true or false')
        return BOOLEANS[text.lower()]
    try:
        return float(text)
    except ValueError:
        raise ValueError(f'{name} is {shown(text)}; expected a number') from None


def preset_file(argument, name, presets):
    """
    Return the path of a preset, given by its name or by its path.

    ``presets`` are the known names. Raises ValueError, which names the nearest one, or
    FileNotFoundError.
    """
    if name in presets or _is_path(name):
        return str(resources.parameter_file(name))
    raise ValueError(f'{argument} is {shown(name)}; expected a path or one of '
                     f'{", ".join(presets)} (nearest: {nearest_name(name, presets)})')


def parameter_files(text):
    """
    Return the paths of the parameter files in the text of params_file.

    If a file with the complete text as its name exists, the text is one path, even with commas and
    spaces.
    """
    names = [text] if Path(text).is_file() else re.split(r'[,\s]+', text)
    return [str(resources.parameter_file(name)) for name in names if name]


def _is_path(name):
    return bool(Path(name).suffix) or Path(name).parent != Path('.') or Path(name).is_file()
