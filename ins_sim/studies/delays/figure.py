"""Definition of a figure of the delay study: its settings, and the runs that it needs."""

from dataclasses import dataclass, replace
import math
from pathlib import PurePath
from typing import Any

from ins_sim.settings.by_node import ALL_NODES, NODES
from ins_sim.settings.field import setting, settings_class, SettingsGroup
from ins_sim.settings.imu import DelaysUs
from ins_sim.settings.instrument_errors import AccelerometerErrors, GyroErrors, Sampling
from ins_sim.settings.simulation import SimulationSettings
from ins_sim.settings.strapdown import Initial

NODE = 'delay_study'
# Names of the shipped parameter files: those of the study, and that of a recorded flight.
SHIPPED = tuple(f'delay_study_{name}' for name in (
    'figure_1', 'figure_2', 'figure_3', 'figure_4', 'figure_5', 'theta_0', 'second_resonance',
    'rates', 'rocking'))
RECORDED = 'delay_study_recorded'
RECORDING_PATH = 'motion.recording.path'
# {kind of figure: the motions that it can show}
FIGURES = {'errors': ('two_axis',), 'rates': ('two_axis',), 'rocking': ('rocking',),
           'flight': ('cruise', 'racetrack', 'aggressive', 'route', 'recording')}
LEVEL = ('north', 'east')


@settings_class
class DelayFigureSettings(SettingsGroup):
    """One figure of the delay study; motion and delays are those of the simulation."""

    figure: str = setting('errors', 'errors: latitude and longitude error of motion 2 against '
                          'time; rates: drift of motion 2 over the rates of psi and gamma; '
                          'rocking: drift of motion 1 over the direction of its axis; flight: '
                          'track and position error of a flight', choices=tuple(FIGURES))
    shown: str = setting('both', 'which error the figure errors shows',
                         choices=('both', 'latitude', 'longitude'))
    detunings_rad_s: tuple[float, ...] = setting(
        (0.0, 0.001, 0.01, 0.1), 'detuning of each run of motion 2', 'rad/s', -1000.0, 1000.0)
    rocking_psi_deg: tuple[float, ...] = setting(
        (0.0, 22.5, 45.0, 67.5, 90.0, 112.5, 135.0, 157.5), 'psi of each run of motion 1', 'deg',
        -360.0, 360.0)

    def check(self):
        """Refuse a figure without runs, and the same run twice."""
        for name in ('detunings_rad_s', 'rocking_psi_deg'):
            values = getattr(self, name)
            if not values:
                raise ValueError(f'{name} is empty; expected at least one')
            if len(set(values)) < len(values):
                raise ValueError(f'{name} has a value twice; expected different ones')


# The nodes whose sections a parameter file of a figure may contain.
READ_NODES = {**NODES, NODE: DelayFigureSettings}
KNOWN_NODES = {**ALL_NODES, NODE: DelayFigureSettings}


@dataclass(frozen=True)
class DelayFigure:
    """
    A figure to be drawn.

    Attributes
    ----------
    name : name of its files
    shows : DelayFigureSettings
    simulation : SimulationSettings of its runs
    motion : recorded motion, or None if the settings define the motion
    notes : messages about the figure
    """

    name: str
    shows: DelayFigureSettings
    simulation: SimulationSettings
    motion: Any = None
    notes: tuple[str, ...] = ()

    def runs(self):
        """Return the SimulationSettings of each run."""
        if self.shows.figure in ('errors', 'rates'):
            return tuple(_with_motion(self.simulation, two_axis=replace(
                self.simulation.motion_generator.motion.two_axis, detuning_rad_s=detuning))
                for detuning in self.shows.detunings_rad_s)
        if self.shows.figure == 'rocking':
            return tuple(_with_motion(self.simulation, psi_deg=psi)
                         for psi in self.shows.rocking_psi_deg)
        return (self.simulation,)


def recorded_name(path):
    """Return the name of the figure of a recording."""
    return f'recorded_{PurePath(path).name.partition(".")[0]}'


def make_figures(sources, read_nodes, read_motion):
    """
    Return the DelayFigures of parameter files.

    Parameters
    ----------
    sources : list of (name, path of the file, assignments)
    read_nodes : callable
        Function (paths, assignments, nodes, known nodes) that returns {node: its settings}.
    read_motion : callable
        Function of MotionGeneratorSettings that returns the motion of a recording.

    Raises
    ------
    ValueError
        For settings that no figure can have, and for two figures with the same name.
    """
    names = [name for name, _, _ in sources]
    for name in names:
        if names.count(name) > 1:
            raise ValueError(f'two figures are named {name}; expected files of different names, '
                             'because a figure is named after its file')
    figures = []
    for name, path, assignments in sources:
        nodes = read_nodes([path], assignments, READ_NODES, KNOWN_NODES)
        try:
            figures.append(_made(name, nodes, read_motion))
        except ValueError as error:
            raise ValueError(f'{name}: {error}') from None
    return figures


def _made(name, nodes, read_motion):
    """Return the DelayFigure of {node: its settings}."""
    shows = nodes.pop(NODE)
    simulation, motion, notes = SimulationSettings(**nodes), None, ()
    _check(shows, simulation)
    if simulation.motion_generator.motion.kind == 'recording':
        motion = read_motion(simulation.motion_generator)
        simulation, notes = _within(simulation, motion)
    return DelayFigure(name, shows, simulation, motion, notes)


def _with_motion(simulation, **values):
    generator = simulation.motion_generator
    return replace(simulation, motion_generator=replace(
        generator, motion=replace(generator.motion, **values)))


def _within(simulation, motion):
    """Return settings whose run ends with its recording, and a note if it became shorter."""
    generator = simulation.motion_generator
    left_s = math.floor(motion.end_s - generator.start_s)
    if not 0 < left_s < generator.duration_s:
        return simulation, ()
    return (replace(simulation, motion_generator=replace(generator, duration_s=float(left_s))),
            (f'The recording {motion.path} ends after {left_s} s, and so does the run.',))


def _check(shows, simulation):
    """Raise ValueError unless delays of gyros are the only source of errors in the runs."""
    motion, sensor = simulation.motion_generator.motion, simulation.imu_sensor
    kinds = FIGURES[shows.figure]
    if motion.kind not in kinds:
        raise ValueError(f'motion.kind is {motion.kind} with figure {shows.figure}; expected '
                         f'{" or ".join(kinds)}')
    if motion.kind == 'rocking' and motion.rocking.axis not in LEVEL:
        raise ValueError(f'motion.rocking.axis is {motion.rocking.axis} with figure rocking; '
                         f'expected {" or ".join(LEVEL)}, a level axis that does not rotate with '
                         'psi')
    if motion.kind == 'rocking' and not motion.rocking.frequency_hz:
        raise ValueError('motion.rocking.frequency_hz is 0 with figure rocking; expected more '
                         'than 0')
    if sensor.gyro.delay_us == DelaysUs():
        raise ValueError('gyro.delay_us is 0 on every axis; expected a delay on one axis or more')
    initial = simulation.strapdown.initial
    for name, given, none in (
            ('gyro.model', sensor.gyro.model, 'ideal'),
            ('gyro.errors', sensor.gyro.errors, GyroErrors()),
            ('accelerometer.delay_us', sensor.accelerometer.delay_us, DelaysUs()),
            ('accelerometer.errors', sensor.accelerometer.errors, AccelerometerErrors()),
            ('sampling', sensor.sampling, Sampling()),
            ('initial', replace(initial, after_s=0.0), Initial())):
        if given != none:
            raise ValueError(f'{name} is not the default; the study of delays expects '
                             'instruments and a start without other errors')
