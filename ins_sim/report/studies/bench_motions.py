"""Compare bench motions by how accurately they determine delays: table, charts, page."""

from dataclasses import asdict, dataclass
import math

import numpy as np
from rich.table import Table

from ins_sim.studies.bench_motions import direction_map
from ..charts.chart import Bars, Chart, Curve, LOG, Map, Markers, Panel, TRIANGLE
from ..charts.palette import BLACK
from ..page.content import Page, PageTable

MARK = 'motions.json'
# In the map, sigmas are limited to this multiple of the best one.
CAP = 5.0


@dataclass(frozen=True)
class ForeseenRow:
    """
    A bench motion with the predicted sigma of the delay of each channel, us.

    ``refused`` contains, by axis, the reason why a delay is not observable, or ''.
    """

    motion: str
    sigma_us: tuple
    refused: tuple

    @property
    def shown(self):
        """Names of the channels whose delays are observable."""
        return [axis for axis, why in zip('xyz', self.refused) if not why]

    @property
    def worst_us(self):
        """Largest sigma of the observable channels, or the smallest of all if there are none."""
        shown = [s for s, why in zip(self.sigma_us, self.refused) if not why]
        return max(shown) if shown else min(self.sigma_us)


def foreseen_row(case, foreseen):
    """Return the ForeseenRow of a BenchCase and its ForeseenDelays."""
    return ForeseenRow(case.name, tuple(1e6 * s for s in foreseen.sigmas), foreseen.refused)


def order(rows):
    """Return ForeseenRows sorted by the number of observable channels, then by sigma."""
    return sorted(rows, key=lambda row: (-len(row.shown), row.worst_us))


def answer(rows, duration_s, rate_hz):
    """Return two sentences saying which motion is best."""
    best = order(rows)[0]
    return (f'Of the motions compared, {best.motion} determines delays best: the standard '
            f'deviation is {best.worst_us:.3g} us for a channel ({", ".join(best.shown)}) and '
            f'{best.worst_us * math.sqrt(2.0):.3g} us for the difference of two, in '
            f'{duration_s:g} s at {rate_hz:g} Hz. It falls with the angular acceleration and with '
            'the square root of the time, so rock as fast as the bench allows.')


def motion_charts(rows, sweep, single_sigma, noise):
    """
    Return the Charts of ForeseenRows and of a RockingSweep.

    ``single_sigma`` is the sigma of a channel that is rocked about its own axis, s; ``noise``
    describes the noise of the instrument and the length of the record.
    """
    return _bars(rows, noise), _directions(single_sigma, noise), _speed(sweep, noise)


def _bars(rows, noise):
    rows = order(rows)
    return Chart('bench_motions', f'How well motions of a bench show delays: {noise}', (
        Panel((Bars(np.array([row.worst_us for row in rows]), tuple(
            f'{row.motion} ({", ".join(row.shown) or "not observable"})' for row in rows)),),
            'standard deviation of a delay [us]', '', x_scale=LOG),),
        caption='The channels with an observable delay are in brackets; the bar shows the largest '
        'standard deviation among them.')


def _directions(single_sigma, noise):
    azimuth, elevation = np.linspace(0.0, 180.0, 91), np.linspace(-90.0, 90.0, 91)
    worst = 1e6 * direction_map(single_sigma, azimuth, elevation)
    best = 1e6 * math.sqrt(3.0) * single_sigma
    corner = math.degrees(math.atan(math.sqrt(0.5)))
    return Chart('bench_directions', 'About which axis to rock: the largest standard deviation of '
                 'the three delays, rocking of 5 deg at 1 Hz', (
                     Panel((Map(azimuth, elevation, np.minimum(worst, CAP * best), 'us'),
                            Markers(np.array([45.0, 45.0, 135.0, 135.0]),
                                    np.array([corner, -corner, corner, -corner]),
                                    f'diagonals: {best:.3g} us', BLACK, TRIANGLE, 7.0)),
                           'azimuth of the axis in the body, from forward to the left [deg]',
                           'elevation of the axis [deg]'),),
                 caption=f'{noise}. Axes with {CAP * best:.3g} us or more have the same colour. '
                 'The delay of a channel is not observable if the rocking does not rotate the '
                 'body about the axis of this channel.')


def _speed(sweep, noise):
    by_frequency, by_acceleration = [], []
    for k, amplitude in enumerate(sweep.amplitudes_deg):
        w = 2.0 * math.pi * sweep.frequencies_hz
        sigma = 1e6 * sweep.sigmas[:, k]
        by_frequency.append(Curve(sweep.frequencies_hz, sigma, f'{amplitude:g} deg'))
        by_acceleration.append(Markers(amplitude * w * w, sigma, f'{amplitude:g} deg'))
    return Chart('bench_speed', 'Amplitude and frequency of a rocking about the diagonal', (
        Panel(tuple(by_frequency), 'frequency [Hz]', 'standard deviation of a delay [us]',
              'Against frequency', LOG, LOG),
        Panel(tuple(by_acceleration), 'largest angular acceleration of the bench [deg/s^2]',
              'standard deviation of a delay [us]', 'Against angular acceleration, on which '
              'the standard deviation depends', LOG, LOG)),
        shared=False, caption=f'{noise}. Curves end at the range of the gyros.')


def motions_table(rows):
    """Return the heads and rows of the table of motions, as texts."""
    heads = ('motion', 'x [us]', 'y [us]', 'z [us]')
    return heads, tuple((row.motion, *(f'({s:.3g})' if why else f'{s:.3f}' for s, why in zip(
        row.sigma_us, row.refused))) for row in order(rows))


NOTE = ('in brackets: not observable, because the delay looks like a misalignment or the rate '
        'hardly changes')


def show_motions(title, rows, console):
    """Print the table of motions."""
    heads, cells = motions_table(rows)
    table = Table(title=title, caption=NOTE)
    for head in heads:
        table.add_column(head, justify='right' if '[' in head else 'left')
    for row in cells:
        table.add_row(*row)
    console.print(table)


def motions_page(title, rows, said, charts, settings):
    """Return the Page; ``said`` is the answer, ``settings`` those of the instrument."""
    table = PageTable('Standard deviation of a delay by channel', *motions_table(rows), note=NOTE)
    return Page(f'Motions of a bench for delays: {title}', said, charts, (table,), (
        'Predicted from the linear model with the angle random walk of the instrument and priors '
        'of 1e-3 on scale factors and misalignments; no reading is simulated.',), settings,
        files={MARK: 'the table', **{f'{c.name}.png': c.title for c in charts}})


def as_json(rows, duration_s, rate_hz):
    """Return the document of motions.json."""
    return {'duration_s': duration_s, 'rate_hz': rate_hz, 'motions': [asdict(r) for r in rows]}
