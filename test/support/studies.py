"""Settings of studies shared by tests, and their runs."""

from concurrent.futures import ProcessPoolExecutor
from functools import lru_cache
import multiprocessing
import os

from ins_sim.settings.catalogue import build, flatten
from ins_sim.core.earth.frames import MapFrame
from ins_sim.core.motion.factory import make_motion
from ins_sim.core.prediction.predict import predict
from ins_sim.core.timeseries.histories import ImuSamples
from ins_sim.io.motion import read_motion
from ins_sim import parameter_files
from ins_sim.settings.by_node import NODES
from ins_sim.core.simulation.guided_flight import fly
from ins_sim.core.simulation.inertial import imu_blocks, simulate
from ins_sim.settings.simulation import SimulationSettings
from ins_sim.studies.delays.figure import make_figures
from ins_sim.studies.delays.study import distinct_runs, fly_task, gather
from support.places import ROOT

DEG_PER_HOUR = 206264.806

MOTION_1 = {'motion.kind': 'rocking', 'motion.psi_deg': 45.0, 'motion.theta_deg': 0.0,
            'gyro.delay_us.x': 1.0}
# Shipped files of motion 2 with its delay, and their options on the command line.
LATE_MOTION_2 = ['motion_2', 'delay_y_1us']
LATE_MOTION_2_WORDS = [word for name in LATE_MOTION_2 for word in ('--params-file', name)]
MOTION_2 = {'motion.kind': 'two_axis', 'gyro.delay_us.y': 1.0}
FLIGHT = {'datum.latitude_deg': 55.0, 'datum.longitude_deg': 37.0, 'gyro.delay_us.y': 1.0,
          'gyro.delay_us.x': 2.0, 'gyro.delay_us.z': 3.0}


def settings(values=None, **more):
    """Return Settings from {dotted name: value}, based on motion 2; __ in keywords are dots."""
    values = {'source': 'motion', 'motion.kind': 'two_axis', **(values or {}),
              **{k.replace('__', '.'): v for k, v in more.items()}}
    known = {node: flatten(cls) for node, cls in NODES.items()}
    unused = set(values) - set().union(*known.values())
    assert not unused, unused
    return SimulationSettings(**{
        node: build(cls, {k: v for k, v in values.items() if k in known[node]})
        for node, cls in NODES.items()})


def streamed(s):
    """Return the ImuSamples of a run through the stream, and its truth as arguments of push."""
    generator = s.motion_generator
    motion = make_motion(generator.motion, generator.datum, generator.earth)
    expected = ImuSamples.concatenate(imu_blocks(s, motion))
    frame, truth = MapFrame(generator.datum, True), motion.at(expected.t_ns)
    return expected, list(zip(truth.t_ns.tolist(), frame.attitude(truth).tolist(),
                              truth.omega_ib_b.tolist(), truth.f_ib_b.tolist()))


def run_offline(chosen, twin=True):
    """Return the SimulationResult of SimulationSettings."""
    motion = read_motion(chosen.motion_generator)
    fly(chosen, motion)
    return simulate(chosen, motion, twin)


def prediction_of(chosen):
    """Return the Prediction for SimulationSettings."""
    return predict(chosen, read_motion(chosen.motion_generator))


def study(values, twin=True):
    """
    Return errors and twin errors (or None) of the run with {dotted name: value}.

    The last few results are cached: tests of one run have the same xdist_group and compute it
    once.
    """
    return _study(tuple(sorted(values.items())), twin)


@lru_cache(maxsize=3)
def _study(values, twin):
    chosen = settings(dict(values))
    result = run_offline(chosen, twin)
    return result.errors, result.twin


def spread(function, *arguments):
    """
    Return the values of a function for each argument, computed on all cores.

    A worker of pytest-xdist computes them one by one, because other workers use the other cores.
    """
    if 'PYTEST_XDIST_WORKER' in os.environ:
        return list(map(function, *arguments))
    # Forked processes, because a new process could not import the function of a test module.
    with ProcessPoolExecutor(mp_context=multiprocessing.get_context('fork')) as pool:
        return list(pool.map(function, *arguments))


def delay_figure(name, **values):
    """Return the DelayFigure of config/delay_study_<name>.yaml; __ in keywords are dots."""
    given = {key.replace('__', '.'): value for key, value in values.items()}
    path = ROOT / 'config' / f'delay_study_{name}.yaml'
    made, = make_figures([(path.stem, path, given)], parameter_files.read_nodes, read_motion)
    return made


def delay_results(*figures):
    """Return the FigureResults of DelayFigures."""
    return gather(figures, [fly_task(task) for task in distinct_runs(figures)])
