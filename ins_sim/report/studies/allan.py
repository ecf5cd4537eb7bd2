"""Report of the Allan deviation: a chart of each triad, and the page."""

import numpy as np

from ins_sim.core.sensors.imu.triad_model import FLICKER_FLOOR
from ..charts import palette
from ..charts.chart import (Band, Chart, Curve, DASH_DOT, DASHED, DOTTED, Level, LOG, Markers,
                            Panel)
from ..charts.scales import amount, TIMES
from ..noise_terms import AXES, TRIADS
from ..page.content import Page, PageTable

# For each coefficient: formula of its Allan deviation, colour and dash of its line.
GUIDES = {'Q': ('sqrt(3) Q/tau', palette.GREY, DOTTED),
          'N': ('N/sqrt(tau)', palette.PURPLE, DASHED),
          'B': ('{floor:.3f} B = {level:.3g} {unit}', palette.ORANGE, DASH_DOT),
          'K': ('K sqrt(tau/3)', palette.SKY, DASHED)}
PERCENT = 100.0


def record_words(name, noise):
    """Return a description of the analysed record: name, rate and length."""
    return (f'{name}, {1.0 / noise.allan.tau_s[0]:.4g} Hz, '
            f'{amount(TIMES, noise.allan.length_s)}')


def allan_chart(name, noise):
    """Return the Chart of a Noise; ``name`` is that of the record or of the parameters."""
    return Chart(
        noise.triad, f'Allan deviation of the {noise.triad}: {record_words(name, noise)}',
        (_deviations(noise), _differences(noise)),
        caption='Below: how far the curves above are from the fit. The band is about one standard '
                'deviation of the estimate of one axis, sqrt(tau/T)/2 of a record of length T.')


def _deviations(noise):
    """Return the panel of the axes, the fit, the settings and the coefficients alone."""
    terms = TRIADS[noise.triad]
    unit, si = next((t.unit, t.si) for t in terms if t.symbol == 'B')
    tau, deviation = noise.allan.tau_s, noise.allan.deviation / si
    marks = [_guide(term, row, tau, part / si) for term, row, part in zip(
        terms, noise.rows(), noise.together.parts(tau).T) if row['all'] is not None]
    for axis, channel in zip(noise.axes, deviation.T):
        colour = palette.BODY_AXES[axis]
        marks += [Curve(tau, channel, f'axis {axis}', colour, width=0.8),
                  Markers(tau, channel, None, colour)]
    expected = noise.expected()
    if expected is not None:
        marks.append(Curve(tau, expected / si, 'expected of the settings', palette.BLACK, DASHED))
    marks.append(Curve(tau, noise.fitted() / si, 'fit to all axes', palette.BLACK))
    return Panel(tuple(marks), 'averaging time tau [s]', f'Allan deviation [{unit}]',
                 x_scale=LOG, y_scale=LOG,
                 y_range=(deviation.min() / 2.0, deviation.max() * 2.0), height=2.5)


def _guide(term, row, tau, part):
    """Return the line of one coefficient alone; that of B is at the level in its label."""
    words, colour, dash = GUIDES[term.symbol]
    label = (words.format(floor=FLICKER_FLOOR, level=part[0], unit=term.unit)
             + f', {term.symbol} = {row["all"]:.3g} {term.unit}')
    if row['settings'] is not None:
        label += f' (settings: {_together(row["settings"]):.3g})'
    if term.symbol == 'B':
        return Level(y=float(part[0]), label=label, colour=colour, dash=dash)
    return Curve(tau, part, label, colour, dash, 1.0)


def _differences(noise):
    """Return the panel of the differences of axes and settings from the fit, percent."""
    tau, fitted = noise.allan.tau_s, noise.fitted()
    one_sigma = 0.5 * PERCENT * noise.allan.relative_sigma()
    marks = [Band(tau, -one_sigma, one_sigma, 'one sigma of an axis', palette.GREY),
             Level(y=0.0, colour=palette.BLACK)]
    for axis, channel in zip(noise.axes, noise.allan.deviation.T):
        off, colour = PERCENT * (channel / fitted - 1.0), palette.BODY_AXES[axis]
        marks += [Curve(tau, off, None, colour, width=0.8), Markers(tau, off, None, colour)]
    expected = noise.expected()
    if expected is not None:
        marks.append(Curve(tau, PERCENT * (expected / fitted - 1.0), None, palette.BLACK, DASHED))
    return Panel(tuple(marks), 'averaging time tau [s]', 'off the fit [%]', x_scale=LOG)


def allan_page(name, found, notes, settings, charts):
    """
    Return the Page of the noise found in a record.

    Parameters
    ----------
    name : name of the record
    found : list of Noise
    notes : sentences
    settings : SimulationSettings of the instrument, or None
    charts : Charts of ``found``
    """
    files = {f'{noise.triad}.png': f'Allan deviation of the {noise.triad}' for noise in found}
    return Page(f'Allan deviation: {record_words(name, found[0])}',
                ' '.join(_answer(noise) for noise in found), tuple(charts),
                tuple(_table(noise) for noise in found), tuple(notes), settings,
                files={**files, 'allan.json': 'the noise coefficients by axis'})


def _answer(noise):
    """Return the sentence about a Noise: first its floor, then the other coefficients."""
    found, floor, hidden = [], '', []
    for term, row in zip(TRIADS[noise.triad], noise.rows()):
        name = f'{term.name} {term.symbol}'
        if row['all'] is None:
            hidden.append(name)
        elif term.symbol == 'B':
            floor = (f"The {noise.triad}'s flicker floor is {FLICKER_FLOOR * row['all']:.3g} "
                     f'{term.unit}, {FLICKER_FLOOR:.3f} of its {name} = {row["all"]:.3g} '
                     f'{term.unit}')
        else:
            found.append(f'{name} = {row["all"]:.3g} {term.unit}')
    words = '; '.join([floor or f'The {noise.triad} shows no flicker floor', *found])
    unseen = f' Not seen in this record: {", ".join(hidden)}.' if hidden else ''
    return f'{words}.{unseen}'


def _table(noise):
    """Return the table of the coefficients by axis."""
    known = noise.settings is not None
    rows = [(row['symbol'], row['name'], row['unit'],
             *('-' if row[head] is None else row[head] for head in (*AXES, 'all')),
             *([_together(row['settings'])] if known else [])) for row in noise.rows()]
    return PageTable(
        f'Noise coefficients of the {noise.triad}',
        ('', 'coefficient', 'unit', *AXES, 'all axes', *(['settings'] if known else [])),
        tuple(rows), 'All axes: of the mean variance of the axes; -: not seen in the record.'
        + (' Settings: the rms of the axes.' if known else ''))


def _together(by_axis):
    """Return the rms over the axes, comparable with the fit to the mean variance."""
    return float(np.sqrt(np.mean(np.square(by_axis))))
