"""The shipped figures of the study of delays, and what they show."""

from ins_sim import parameter_files
from ins_sim.io.motion import read_motion
from ins_sim.studies.delays.figure import make_figures
from ins_sim.studies.delays.study import distinct_runs, fly_task, gather
from support.places import ROOT


def figure(name, **values):
    """Return the DelayFigure of config/delay_study_<name>.yaml; __ in keywords are dots."""
    given = {key.replace('__', '.'): value for key, value in values.items()}
    path = ROOT / 'config' / f'delay_study_{name}.yaml'
    made, = make_figures([(path.stem, path, given)], parameter_files.read_nodes, read_motion)
    return made


def results_of(*figures):
    """Return the FigureResults of figures."""
    return gather(figures, [fly_task(task) for task in distinct_runs(figures)])
