"""Open motions and bags."""

from __future__ import annotations

import os

from ins_sim import parameter_files
from ins_sim.bags import bag_reader
from ins_sim.bags.bag_reader import BagReader
from ins_sim.core.motion.motion import Motion
from ins_sim.io.motion import read_motion
from ins_sim.settings.motion import MotionGeneratorSettings
from ins_sim.settings.simulation import AidedSimulationSettings, SimulationSettings
from .inputs import checked_path, Name, plain, Values


def open_motion(source: Name | SimulationSettings | AidedSimulationSettings,
                values: Values | None = None) -> Motion:
    """
    Return a motion, which can be evaluated at any instant.

    Parameters
    ----------
    source : str, path, SimulationSettings or AidedSimulationSettings
        A recorded flight (a CSV file, or a bag with odometry), or settings that name a motion.
    values : mapping, optional
        With a recording: values of the parameters of ``motion_generator`` by name, such as
        ``{'motion.recording.start_s': 100.0}``.

    Returns
    -------
    Motion
        ``at(t_ns)`` returns the Truth at motion times (n,), int64 ns: position, velocity,
        attitude, angular rate and specific force.

    Raises
    ------
    ValueError
        If the recording or the settings cannot be used.
    FileNotFoundError
        If the recording does not exist.

    Examples
    --------
    >>> import ins_sim, numpy as np
    >>> motion = ins_sim.open_motion(ins_sim.read_settings('cruise'))
    >>> truth = motion.at(np.array([0, 1_000_000_000]))
    >>> truth.v_n.shape
    (2, 3)
    """
    if isinstance(source, (SimulationSettings, AidedSimulationSettings)):
        if values is not None:
            raise ValueError('values are given with settings; expected values only with a '
                             'recording: pass them to read_settings instead')
        simulation = source if isinstance(source, SimulationSettings) else source.simulation
        return read_motion(simulation.motion_generator)
    if not isinstance(source, (str, os.PathLike)):
        raise ValueError(f'source is {type(source).__name__}; expected the path of a CSV file or '
                         'a bag, or settings of read_settings')
    named = {'motion.kind': 'recording', 'motion.recording.path': os.fspath(source)}
    built = parameter_files.read_nodes([], {**named, **plain(values)},
                                       {'motion_generator': MotionGeneratorSettings})
    return read_motion(built['motion_generator'])


def open_bag(path: Name) -> BagReader:
    """
    Open a rosbag2 bag for reading, without ROS.

    Parameters
    ----------
    path : str or path
        The folder of the bag, or one of its files (MCAP or SQLite).

    Returns
    -------
    BagReader
        A context manager. ``topics`` holds the channels by name; ``arrays(topic, fields)``
        returns the messages as one structured array.

    Raises
    ------
    ValueError
        If it is not a bag, or a bag that cannot be read.
    OSError
        If it does not exist or access is denied.

    Examples
    --------
    >>> import ins_sim
    >>> with ins_sim.open_bag('motion_2_bag') as bag:
    ...     imu = bag.arrays('imu/data_raw', ('angular_velocity',))
    >>> imu['angular_velocity'].shape
    (201, 3)
    """
    return bag_reader.open_bag(checked_path('path', path))
