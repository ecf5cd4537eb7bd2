"""Charts with every kind of mark, for the tests of the renderers."""

from ins_sim.report.charts.chart import (Band, Bars, Chart, CIRCLE, CROSS, Curve, DASH_DOT, DASHED,
                                         DOT, DOTTED, Level, LOG, Map, Markers, Panel, Stack,
                                         Stretch, TRIANGLE)
import numpy as np

T = np.linspace(0.0, 60.0, 500)


def every_mark():
    """Return Charts in which each mark, scale and layout occurs."""
    over_time = Chart('over_time', 'A title <of> & "many"', (
        Panel((Stretch(10.0, 20.0, 'shaded'), Band(T, -T, T, '3 sigma'),
               Curve(T, np.sin(T) * T, 'east'), Curve(T, np.cos(T) * T, 'north', dash=DASHED),
               Level(y=5.0, label='level', dash=DOTTED)), 'time [min]', 'error [m]'),
        Panel((Markers(T[::20], T[::20], 'taken', marker=DOT),
               Markers(T[::20], 2.0 * T[::20], 'refused <x>', marker=CROSS),
               Markers(T[::20], 3.0 * T[::20], 'open', marker=CIRCLE),
               Markers(T[::20], 4.0 * T[::20], 'start', marker=TRIANGLE, size=8.0),
               Stretch(np.array([1.0, 30.0]), np.array([2.0, 31.0])), Level(x=45.0)),
              'time [min]', 'count', title='a panel')), caption='What is seen.')
    logarithmic = Chart('logarithmic', 'Logarithmic axes', (Panel(
        (Curve(np.geomspace(0.01, 1e3, 50), np.geomspace(10.0, 1e-2, 50), 'slope', dash=DASH_DOT),
         Curve(np.array([0.0, 1.0, 10.0]), np.array([1.0, -1.0, 1.0]), 'partly negative')),
        'tau [s]', 'deviation [deg/h]', x_scale=LOG, y_scale=LOG),))
    track = Chart('track', 'A track', (Panel(
        (Curve(20.0 * np.cos(T), 10.0 * np.sin(T), 'truth'),), 'east [km]', 'north [km]',
        equal=True),))
    ranked = Chart('ranked', 'Bars', (Panel(
        (Bars(np.array([5.0, 3.0, 1.0]), ('bias of the gyros', 'walk', 'scale factor')),),
        'rms [m]', ''),))
    stack = Chart('stack', 'A stack', (Panel(
        (Stack(T, np.stack([T, 2.0 * T], axis=1), ('lower', 'upper')), Curve(T, 3.0 * T, 'sum')),
        'time [s]', 'variance [m^2]'),))
    x, y = np.linspace(-1.0, 1.0, 40), np.linspace(0.0, 2.0, 20)
    maps = Chart('map', 'A map', (Panel(
        (Map(x, y, x * y[:, None], 'deg/h'), Level(x=0.5, dash=DASHED)), 'x', 'y'),))
    grid = Chart('grid', 'A grid', tuple(
        Panel((Curve(T, np.sin(T + k), f'case {k}'),), 'gain', 'delay [s]', title=f'panel {k}')
        for k in range(4)), columns=2)
    empty = Chart('empty', 'Nothing', (Panel((), 'time [s]', 'error [m]', note='no reference'),))
    return over_time, logarithmic, track, ranked, stack, maps, grid, empty
