"""Charts of an error budget."""

import numpy as np

from ins_sim.studies.budget.quantities import (ANGLE, LENGTH, LINEAR_UP_TO, QUANTITIES,
                                               second_order, shares, SPEED)
from ins_sim.studies.error_circle import error_circle
from ..charts import scales
from ..charts.chart import (Band, Bars, Chart, Curve, DASHED, Level, LOG, Markers, Panel, Stack,
                            TRIANGLE)
from ..charts.palette import BLACK, BLUE, CYCLE, EAST_NORTH_UP, GREEN, GREY, ORANGE, RED

SCALES = {LENGTH: scales.LENGTHS, SPEED: scales.SPEEDS, ANGLE: scales.ANGLES}
# Number of sources drawn separately; the smaller ones are combined.
SHOWN = 7
SURFACES = tuple(colour for colour in CYCLE if colour not in (BLACK, GREY))
# Colours of the areas of combined sources.
PALE = '#d8d8d8', '#b0b0b0'
# Bars shorter than this part of the longest one are left out.
SHORTEST = 1e-3
FIXED_NAME = 'the same in every run'
DASHED_NOTE = ('Dashed: the axes have turned so far ({:g} rad) that errors of second order show '
               'and the budget is a guide only.')


# Quantities in one figure, in which the requirements on them are marked.
PLACES = ('horizontal', 'north', 'east')


def charts(linear, title, compared, required=()):
    """
    Return the Charts of a LinearBudget.

    ``compared`` are the ComparedQuantities of an ensemble, ``required`` are Requirements.
    """
    found = [_stacked(linear, 'budget_position', f'Sources of the position error: {title}',
                      ('horizontal',)),
             _total(linear, f'Position error of the budget: {title}', required),
             _sources(linear, f'Each source alone: {title}'),
             _ranking(linear, f'Ranking at {linear.t_s[-1]:g} s: {title}'),
             _stacked(linear, 'budget_velocity', f'Sources of the velocity error: {title}',
                      ('velocity',)),
             _stacked(linear, 'budget_attitude', f'Sources of the attitude error: {title}',
                      ('tilt', 'azimuth'))]
    if compared:
        found.append(_beside(linear, compared, f'Budget and ensemble: {title}'))
    return tuple(found)


def _time(linear):
    factor, unit = scales.scale(scales.TIMES, linear.t_s[-1])
    return factor * linear.t_s, f'time of navigation [{unit}]'


def _caption(linear, text=''):
    if (second_order(linear) > LINEAR_UP_TO).any():
        text = f'{text} {DASHED_NOTE.format(LINEAR_UP_TO)}'
    return text.strip()


def parted(linear, t, values, label, colour, width=2.0):
    """Return curves of values: solid while linear theory holds, dashed afterwards."""
    over = second_order(linear) > LINEAR_UP_TO
    if not over.any():
        return (Curve(t, values, label, colour, width=width),)
    k = int(np.argmax(over))
    found = (Curve(t[k:], values[k:], None if k else label, colour, DASHED, width),)
    return (Curve(t[:k + 1], values[:k + 1], label, colour, width=width), *found) if k else found


def _stacked(linear, name, title, names):
    t, x_label = _time(linear)
    panels = []
    for quantity in (QUANTITIES[key] for key in names):
        made = shares(linear, quantity)
        factor, unit = scales.scale(SCALES[quantity.unit], made.rms.max())
        parts, labels, colours = _surfaces(linear, made)
        panels.append(Panel(
            (Stack(t, factor * parts, labels, colours),
             *parted(linear, t, factor * made.rms, 'all together (rms)', BLACK)),
            x_label, f'{quantity.words} [{unit}]'))
    return Chart(name, title, tuple(panels), caption=_caption(
        linear, 'The height of an area is its share of the squared error: removing the source '
        'reduces the squared error by this share.'))


def _surfaces(linear, made):
    """Return the areas of a stack, the largest at the bottom, with labels and colours."""
    whole = np.where(made.rms > 0.0, made.rms, 1.0)[:, None]
    random = (made.random.T / whole)
    order = np.argsort(-made.random[:, -1], kind='stable')
    shown = order[:SHOWN].tolist()
    labels, parts = [linear.random[k].label for k in shown], [random[:, k] for k in shown]
    colours = _colours(linear, shown)
    if len(order) > SHOWN:
        labels.append(f'{len(order) - SHOWN} smaller ones')
        parts.append(random[:, order[SHOWN:]].sum(axis=1))
        colours.append(PALE[0])
    if len(linear.fixed):
        labels.append(FIXED_NAME)
        parts.append(made.fixed.sum(axis=0) / whole[:, 0])
        colours.append(GREY)
    return (np.stack(parts, axis=-1) if parts else np.zeros((len(linear.t_s), 0)),
            tuple(labels), tuple(colours))


def _colours(linear, shown):
    """Return the colours of sources, the same in every figure if possible."""
    ranked = np.argsort(-shares(linear, QUANTITIES['horizontal']).random[:, -1], kind='stable')
    own = dict(zip(ranked.tolist(), SURFACES))
    free = [c for c in SURFACES if c not in [own.get(k) for k in shown]]
    return [own.get(k) or (free.pop(0) if free else PALE[1]) for k in shown]


def _total(linear, title, required):
    t, x_label = _time(linear)
    rms = shares(linear, QUANTITIES['horizontal']).rms
    mean, covariance = linear.total_mean()[:, :2], linear.total_covariance()[:, :2, :2]
    curves = {'horizontal rms': (rms, BLACK),
              'CEP95': (error_circle(mean, covariance, 0.95), GREEN),
              'CEP50': (error_circle(mean, covariance, 0.5), ORANGE),
              'north rms': (shares(linear, QUANTITIES['north']).rms, EAST_NORTH_UP['north']),
              'east rms': (shares(linear, QUANTITIES['east']).rms, EAST_NORTH_UP['east'])}
    factor, unit = scales.scale(scales.LENGTHS, curves['CEP95'][0].max())
    marks = [curve for label, (values, colour) in curves.items()
             for curve in parted(linear, t, factor * values, label, colour, 1.6)]
    marks += [Markers(np.interp([r.t_s], linear.t_s, t), np.array([factor * r.limit]),
                      f'required: {r.text}', BLACK, TRIANGLE, 8.0)
              for r in required if r.quantity in PLACES]
    return Chart('budget_total', title, (Panel(tuple(marks), x_label,
                                               f'position error [{unit}]', height=1.5),),
                 caption=_caption(linear))


def _sources(linear, title):
    t, x_label = _time(linear)
    made = shares(linear, QUANTITIES['horizontal'])
    panels, count = [], len(linear.random)
    contributions = made.contributions()
    for sources, rows, words in (
            (linear.random, contributions[:count], 'differs from run to run: sigma'),
            (linear.fixed, contributions[count:], 'the same in every run: size')):
        if not len(sources):
            continue
        factor, unit = scales.scale(scales.LENGTHS, rows[:, -1].max())
        order = np.argsort(-rows[:, -1], kind='stable')[:SHOWN + 1]
        marks = tuple(Curve(t[1:], np.where(rows[k, 1:] > 0.0, factor * rows[k, 1:], np.nan),
                            sources[k].label, CYCLE[i % len(CYCLE)])
                      for i, k in enumerate(order))
        largest = factor * rows[order[0]].max()
        panels.append(Panel(marks, x_label, f'horizontal error [{unit}]', words, y_scale=LOG,
                            y_range=(1e-4 * largest, 2.0 * largest)))
    return Chart('budget_sources', title, tuple(panels))


def _ranking(linear, title):
    made = shares(linear, QUANTITIES['horizontal'])
    contributions, count = made.contributions()[:, -1], len(linear.random)
    panels = []
    for sources, values, words in ((linear.random, contributions[:count],
                                    'differs from run to run'),
                                   (linear.fixed, contributions[count:], FIXED_NAME)):
        order = [k for k in np.argsort(-values, kind='stable')
                 if values[k] > SHORTEST * values.max()]
        if order:
            factor, unit = scales.scale(scales.LENGTHS, values[order[0]])
            panels.append(Panel(
                (Bars(factor * values[order], tuple(sources[k].label for k in order), BLUE),),
                f'horizontal error of the source alone [{unit}]', '', words,
                height=0.25 + 0.1 * len(order)))
    return Chart('budget_ranking', title, tuple(panels), shared=False)


def _beside(linear, compared, title):
    """Return the Chart of the ensemble's rms and its ratio to the budget (horizontal, azimuth)."""
    t, x_label = _time(linear)
    panels = []
    for found in compared:
        if found.name not in ('horizontal', 'azimuth'):
            continue
        quantity = QUANTITIES[found.name]
        factor, unit = scales.scale(SCALES[quantity.unit], found.budget.max())
        at, differs = t[found.numbers], found.differs
        curve = shares(linear, quantity).rms if len(quantity.axes) > 1 else np.sqrt(
            linear.total_covariance()[:, quantity.axes[0], quantity.axes[0]])
        panels.append(Panel(
            (*parted(linear, t, factor * curve, 'budget', BLACK),
             Markers(at, factor * found.ensemble, 'ensemble', BLUE)),
            x_label, f'{quantity.words} [{unit}]', height=1.6))
        marks = [Band(at, found.low, found.high, '99.9 % of ensembles', BLUE),
                 Level(y=1.0, colour=BLACK),
                 Markers(at, np.where(differs, np.nan, found.ratio), 'inside', BLUE)]
        if differs.any():
            marks.append(Markers(at, np.where(differs, found.ratio, np.nan), 'differs', RED,
                                 'cross', 6.0))
        panels.append(Panel(tuple(marks), x_label, 'ensemble / budget'))
    return Chart('budget_beside', title, tuple(panels), caption=_caption(linear))
