"""Report of estimated delays: values of each channel in sentences and tables."""

from dataclasses import asdict, dataclass
import math

from rich.table import Table

from ins_sim.core.calibration.channel_fit import PRIOR
from ins_sim.core.calibration.channel_sums import ASYMMETRY, BIAS, DELAY, LAST, NEXT, SCALE
from ins_sim.core.calibration.delays import BY_WALK
from ins_sim.core.numerics.units import DEG_PER_HOUR
from .. import manifest, storage

MARK = 'estimate.json'
OWN_MOTION = ('was simulated with a motion that was given as an object; expected a run whose '
              'motion is in its parameters, or ins_sim.estimate_delays with the run itself')


@dataclass(frozen=True)
class FoundValue:
    """
    One value of one channel with its standard deviation, in a unit.

    ``known`` is the value in the settings of a simulated run, or None. ``told`` is true if the
    record determines the value better than the a-priori standard deviation.
    """

    axis: str
    name: str
    unit: str
    value: float
    sigma: float
    known: float | None
    told: bool


def read_bench_run(folder):
    """Return the ImuSamples of a run; ValueError if its motion is not in its parameters."""
    path = folder / storage.MANIFEST
    if path.is_file() and manifest.OBJECT in path.read_text(encoding='utf-8', errors='replace'):
        raise ValueError(f'{folder} {OWN_MOTION}')
    return storage.read_imu(folder)


def value_names(channel):
    """Return (name, factor from SI, unit) of the values of a ChannelEstimate."""
    biases = len(channel.values) - BIAS
    names = {DELAY: ('delay and lag', 1e6, 'us'), SCALE: ('scale factor', 1e6, 'ppm'),
             NEXT: (f'misalignment towards {channel.towards[0]}', 1e6, 'urad'),
             LAST: (f'misalignment towards {channel.towards[1]}', 1e6, 'urad'),
             ASYMMETRY: ('asymmetry of the scale factor', 1e6, 'ppm')}
    return [names[k] for k in range(BIAS)] + [
        ('bias' if biases == 1 else f'bias in record {k + 1}', DEG_PER_HOUR, 'deg/h')
        for k in range(biases)]


def found_values(triad, known_us=None):
    """
    Return the FoundValues of a TriadEstimate.

    ``known_us`` (3,) are the delays in the settings of a run, us, or None.
    """
    rows = []
    for i, channel in enumerate(triad.channels):
        for k, (name, factor, unit) in enumerate(value_names(channel)):
            sigma = float(channel.sigmas[k])
            known = None
            if k == DELAY and known_us is not None:
                lag = 0.0 if triad.lags is None else float(triad.lags[i])
                known = None if math.isnan(lag) else known_us[i] + 1e6 * lag
            told = not channel.refused if k == DELAY else k >= BIAS or sigma < 0.5 * PRIOR
            rows.append(FoundValue(channel.axis, name, unit, float(channel.values[k]) * factor,
                                   sigma * factor, known, told))
    return rows


def differences(triad):
    """
    Return the differences of the observable delays as (name, difference, sigma), us.

    The noise of the channels is independent, so the variances add.
    """
    shown = [c for c in triad.channels if not c.refused]
    return [(f'{b.axis} - {a.axis}', 1e6 * (b.delay - a.delay),
             1e6 * math.hypot(a.delay_sigma, b.delay_sigma))
            for k, a in enumerate(shown) for b in shown[k + 1:]]


def sentences(triad):
    """Return the notes on a TriadEstimate, one sentence each."""
    told = ['"delay and lag" is the sum of the delay of the channel and the lag of the '
            'instrument, relative to the stamps; a reading is the mean over the sampling interval '
            'before its stamp']
    for channel in triad.channels:
        if channel.refused:
            told.append(f'{channel.axis}: the delay is not observable: {channel.refused}')
    by_walk = [c.axis for c in triad.channels if c.weights == BY_WALK]
    others = [c.axis for c in triad.channels if c.weights != BY_WALK]
    if by_walk:
        told.append(f'the standard deviations of {", ".join(by_walk)} are computed from the angle '
                    'random walk in the settings; the residuals agree with it')
    if others:
        told.append(f'the standard deviations of {", ".join(others)} are computed from the '
                    'scatter of the residuals')
    told += [alike for channel in triad.channels for alike in _alike(channel)]
    return [*told, *triad.notes]


def _alike(channel):
    """Yield sentences on combinations of values that the record does not determine."""
    names = value_names(channel)
    for direction in channel.weak:
        parts = [(k, float(v)) for k, v in enumerate(direction) if v]
        # Scale the first value to a round amount: 1 us, 100 ppm or urad, or 1 deg/h of a bias.
        first, value = parts[0]
        amount = {DELAY: 1.0}.get(first, 1.0 if first >= BIAS else 100.0)
        factor = amount / abs(value * names[first][1])
        if len(parts) == 1:
            if not (first == DELAY and channel.refused):
                yield f'{channel.axis}: this motion does not determine the {names[first][0]}'
            continue
        amounts = ' with '.join(f'{names[k][0]} {v * names[k][1] * factor:.3g} {names[k][2]}'
                                for k, v in parts)
        yield (f'{channel.axis}: these values cannot be distinguished, because together they '
               f'leave the readings unchanged: {amounts}')


def answer(triad, known_us=None):
    """Return the result in a few sentences."""
    shown = [c for c in triad.channels if not c.refused]
    text = 'The delays of the channels, lag included, are ' + ', '.join(
        f'{c.axis} {number(1e6 * c.delay, 1e6 * c.delay_sigma)}' for c in shown) + ' us.'
    if triad.lags is not None:
        lags = {c.axis: 1e6 * lag for c, lag in zip(triad.channels, triad.lags)}
        made = ', '.join(f'{c.axis} {lags[c.axis]:.1f}' for c in shown)
        left = ', '.join(f'{c.axis} {number(1e6 * c.delay - lags[c.axis], 1e6 * c.delay_sigma)}'
                         for c in shown)
        text += (f' The bandwidth causes {made} us of this; {left} us of delay remain.')
    if known_us is not None:
        text += ' The delays in the settings of the run are ' + ', '.join(
            f'{c.axis} {d:g}' for c, d in zip(triad.channels, known_us)) + ' us.'
    return text


def number(value, sigma):
    """Return a value with its standard deviation, rounded to two digits of the latter."""
    places = min(12, max(0, 1 - math.floor(math.log10(sigma)))) if sigma > 0.0 else 6
    return f'{round(value, places) + 0.0:.{places}f} +- {sigma:.{places}f}'


def delay_rows(triad, known_us=None):
    """Return the heads and rows of the table of delays, texts."""
    heads = ['channel', 'delay and lag [us]']
    if triad.lags is not None:
        heads += ['lag of the bandwidth [us]', 'delay alone [us]']
    if known_us is not None:
        heads.append('delay set [us]')
    rows = []
    for k, channel in enumerate(triad.channels):
        sigma = 1e6 * channel.delay_sigma
        row = [channel.axis]
        row.append('not observable' if channel.refused else number(1e6 * channel.delay, sigma))
        if triad.lags is not None:
            lag = 1e6 * float(triad.lags[k])
            blank = channel.refused or math.isnan(lag)
            row += ['-', '-'] if blank else [_hundredths(lag),
                                             number(1e6 * channel.delay - lag, sigma)]
        if known_us is not None:
            row.append(f'{known_us[k]:g}')
        rows.append(row)
    lags = dict(zip('xyz', [0.0] * 3 if triad.lags is None else 1e6 * triad.lags))
    sets = dict(zip('xyz', known_us or (0.0,) * 3))
    for name, value, sigma in differences(triad):
        late, early = name.split(' - ')
        lag = float(lags[late] - lags[early])
        row = [name, number(value, sigma)]
        if triad.lags is not None:
            row += [_hundredths(lag), number(value - lag, sigma)]
        if known_us is not None:
            row.append(f'{sets[late] - sets[early]:g}')
        rows.append(row)
    return tuple(heads), tuple(map(tuple, rows))


def _hundredths(value):
    return f'{round(value, 2) + 0.0:.2f}'


def error_rows(triad):
    """Return the heads and rows of the table of all other values, texts."""
    found = [r for r in found_values(triad) if r.name != 'delay and lag']
    rows = [(r.axis, r.name,
             number(r.value, r.sigma) if r.told else 'not determined by this motion',
             r.unit) for r in found]
    return ('channel', 'error', 'estimate', 'unit'), tuple(rows)


def show_estimate(title, triad, known_us, console):
    """Print both tables and the notes."""
    for name, (heads, rows) in ((title, delay_rows(triad, known_us)),
                                ('other errors of the channels', error_rows(triad))):
        table = Table(title=name)
        for head in heads:
            right = '[' in head or head == 'estimate'
            table.add_column(head, justify='right' if right else 'left')
        for row in rows:
            table.add_row(*row)
        console.print(table)
    for sentence in sentences(triad):
        console.print(sentence)


def as_json(triad, known_us):
    """Return the document of estimate.json."""
    return {'records': list(triad.records), 'notes': sentences(triad),
            'values': [asdict(row) for row in found_values(triad, known_us)],
            'differences_us': [{'name': n, 'value': v, 'sigma': s}
                               for n, v, s in differences(triad)],
            'lag_of_the_bandwidth_us': None if triad.lags is None else [
                None if math.isnan(lag) else 1e6 * float(lag) for lag in triad.lags]}
