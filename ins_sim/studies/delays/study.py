"""Compute the figures of the delay study; a run that several figures show is computed once."""

from dataclasses import dataclass

from .figure import DelayFigure
from .maps import rates_map, RatesMap, rocking_map, RockingMap
from .runs import DelayRun, fly_run


@dataclass(frozen=True, eq=False)
class FigureResult:
    """The data of a figure: DelayFigure, DelayRuns, and a RatesMap, a RockingMap or None."""

    figure: DelayFigure
    runs: tuple[DelayRun, ...]
    map: RatesMap | RockingMap | None


def distinct_runs(figures):
    """Return the tasks of ``fly_task`` for all runs that DelayFigures need, each once."""
    return list(_tasks(figures).values())


def fly_task(task):
    """Return the DelayRun of a task; both can be pickled."""
    return fly_run(*task)


def gather(figures, flown):
    """Return a FigureResult for each DelayFigure; flown: DelayRuns of the ``distinct_runs``."""
    by_key = dict(zip(_tasks(figures), flown))
    return tuple(FigureResult(figure, tuple(by_key[_key(figure, settings)]
                                            for settings in figure.runs()), _map(figure))
                 for figure in figures)


def _tasks(figures):
    return {_key(figure, settings): (settings, figure.motion, figure.shows.figure == 'flight')
            for figure in figures for settings in figure.runs()}


def _key(figure, settings):
    return settings, figure.shows.figure == 'flight'


def _map(figure):
    if figure.shows.figure == 'rates':
        return rates_map(figure.simulation)
    if figure.shows.figure == 'rocking':
        return rocking_map(figure.simulation, figure.shows.rocking_psi_deg)
    return None
