"""Charts of estimated delays: the fit, its residuals over time, and the standard deviations."""

import numpy as np

from ins_sim.core.numerics.units import DEG, DEG_PER_HOUR
from ..charts.chart import Band, Bars, Chart, CIRCLE, Curve, DASHED, Level, Markers, Panel
from ..charts.palette import BODY_AXES, GREY
from ..page.content import Page, PageTable
from . import delay_estimate


def estimate_charts(title, triad):
    """Return the Charts of a TriadEstimate; ``title`` describes the records."""
    return _fit(title, triad), _residuals(title, triad), _sigmas(title, triad)


def _shown(triad):
    return [c for c in triad.channels if not c.refused]


def _fit(title, triad):
    """Return the Chart of delay effects and residuals over the angular acceleration."""
    shown = _shown(triad)
    # Each delay includes the lag of the instrument. The lags are nearly equal and much larger than
    # the differences of the delays, so the mean is subtracted to make the differences visible.
    common = sum(c.delay for c in shown) / len(shown) if len(shown) > 1 else 0.0
    top, bottom, widest = [], [], max(shown, key=lambda c: float(c.bins[3].max()))
    x, sigma = widest.bins[0] / DEG, 2.0 * widest.bins[3] * DEG_PER_HOUR
    bottom = [Band(x, -sigma, sigma, '2 sigma', GREY), Level(y=0.0, colour=GREY)]
    for channel in shown:
        change, late, left, _ = channel.bins
        x, colour = change / DEG, BODY_AXES[channel.axis]
        top.append(Curve(x, (common - channel.delay) * change * DEG_PER_HOUR,
                         f'{channel.axis}: {1e6 * channel.delay:.2f} us', colour))
        top.append(Markers(x, (late + common * change) * DEG_PER_HOUR, None, colour, CIRCLE))
        bottom.append(Markers(x, left * DEG_PER_HOUR, channel.axis, colour, CIRCLE))
    label = 'angular acceleration of the axis [deg/s^2]'
    less = f'; a common {1e6 * common:.2f} us is subtracted' if common else ''
    return Chart('delay_fit', f'Effect of the delay: {title}', (
        Panel(tuple(top), label, 'rate without other errors [deg/h]',
              f'The slope against the angular acceleration is minus the delay{less}'),
        Panel(tuple(bottom), label, 'residual [deg/h]', 'Residual of the fit', height=0.7)),
        caption='Lines: effect of the delay in the legend. Points: means of the readings over '
        'intervals of the angular acceleration.')


def _residuals(title, triad):
    """Return the Chart of mean residuals of parts of the records, in standard deviations."""
    marks, most = [], 4.0
    for channel in triad.channels:
        before, times = 0.0, []
        for t_s, _ in channel.blocks:
            times.append(t_s - t_s[0] + before)
            before = times[-1][-1] + (t_s[-1] - t_s[0]) / max(1, len(t_s) - 1)
        left = np.concatenate([values for _, values in channel.blocks])
        most = max(most, 1.1 * float(np.abs(left).max()))
        marks.append(Markers(np.concatenate(times), left, channel.axis, BODY_AXES[channel.axis]))
    levels = [Level(y=y, colour=GREY, dash=DASHED, label='3 sigma' if y > 0.0 else None)
              for y in (3.0, -3.0)]
    several = ' in the records, one after the other' if len(triad.records) > 1 else ''
    return Chart('delay_residuals', f'Residuals over time: {title}', (
        Panel((*levels, *marks), f'time{several} [s]', 'mean residual over its sigma',
              y_range=(-most, most)),),
        caption='Each point is the mean over a 64th of a record. White noise stays within three '
        'sigma; a wave or a step is an error that the model does not include.')


def _sigmas(title, triad):
    """Return the Chart of the standard deviations of the delays and of their differences."""
    found = [(c.axis, 1e6 * c.delay_sigma) for c in _shown(triad)]
    found += [(name, sigma) for name, _, sigma in delay_estimate.differences(triad)]
    return Chart('delay_sigma', f'Standard deviations of the delays: {title}', (
        Panel((Bars(np.array([s for _, s in found]), tuple(
            f'{"delay of " if len(name) == 1 else "difference "}{name}' for name, _ in found)),),
            'standard deviation [us]', ''),))


def estimate_page(title, triad, known_us, charts, settings, notes):
    """
    Return the Page of a TriadEstimate.

    ``settings`` are the SimulationSettings of the first record; ``notes`` are sentences on how the
    records were read.
    """
    delays = PageTable('Delays', *delay_estimate.delay_rows(triad, known_us))
    errors = PageTable('Other errors', *delay_estimate.error_rows(triad))
    return Page(f'Delays of gyro channels: {title}', delay_estimate.answer(triad, known_us),
                charts, (delays, errors), (*notes, *delay_estimate.sentences(triad)), settings,
                files={delay_estimate.MARK: 'all values with their standard deviations',
                       **{f'{chart.name}.png': chart.title for chart in charts}})
