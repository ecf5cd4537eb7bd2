"""Numbers of an aided run: errors, consistency of the filter, and use of the fixes."""

from collections import Counter, namedtuple
from dataclasses import dataclass

import numpy as np
from rich.table import Table

from ins_sim import parameter_files
from ins_sim.core.aiding.mounting_calibration import calibrate_mounting
from ins_sim.core.aiding.navigator import AidedNavigator, GNSS, METER
from ins_sim.core.numerics.units import DEG
from ins_sim.core.simulation.aided_run import AidedResult
from ins_sim.settings.simulation import AidedSimulationSettings
from .consistency import mean_interval, THREE_SIGMA

# A column of the table: heading, function from a row to its text, meaning of the heading or ''.
_Column = namedtuple('_Column', 'head value meaning')
AIDED = 'aided '
ARCMIN = DEG / 60.0
# Number of reasons for rejected fixes that are listed.
REASONS = 3


@dataclass(frozen=True)
class AidedRow:
    """
    One result of the aided solution; fields that do not apply are None.

    Attributes
    ----------
    measured : value (NIS: mean over all fixes that the filter tested, rejected ones included)
    free : the same for the strapdown solution alone
    sigma : standard deviation according to the filter
    true : true value of an estimated quantity
    low, high : interval that contains the value for 95 % of consistent filters
    source : sensor whose fixes are counted
    note : remark in words
    """

    name: str
    unit: str
    measured: float
    free: float | None = None
    sigma: float | None = None
    true: float | None = None
    low: float | None = None
    high: float | None = None
    source: str = ''
    note: str = ''


@dataclass(frozen=True)
class AidedReport:
    """Results of an aided run that ``storage.write_run`` stores; ``rows`` are AidedRows."""

    settings: AidedSimulationSettings
    flown: AidedResult
    rows: list

    @property
    def title(self):
        """Return a line that names the filter and the aiding sensors."""
        told = [_described(self.settings, source) for source in aiding_sources(self.settings)]
        if not told:
            return 'not aided by any fix'
        return f'aided by {self.settings.aided_navigator.filter}: {", ".join(told)}'

    def parameters(self):
        """Return the text of the parameter file of all six nodes."""
        return parameter_files.dump_aided(self.settings)

    def show(self, console):
        """Print the rows and the faults."""
        show_aided(self.title, self.rows, console)
        for line in fault_lines(self.flown):
            console.print(line)


def aiding_sources(settings):
    """Return the aiding sensors of AidedSimulationSettings."""
    return AidedNavigator(settings.aided_navigator).sources


def _described(settings, source):
    if source == GNSS:
        return f'GNSS at {settings.gnss.gnss.rate_hz:g} Hz'
    meter = settings.velocity_meter
    slide = f', every {meter.window.step_cycles} cycles' if meter.window.slides else ''
    return f'velocity meter ({meter.mode}), N {meter.window.cycles}{slide}'


def aided_rows(settings, flown, states, errors):
    """
    Return the AidedRows of AidedSimulationSettings, their AidedResult and the strapdown's states
    and errors.
    """
    table = _error_rows(flown.errors, errors) + _inside_rows(flown.errors)
    for source in aiding_sources(settings):
        table += _fix_rows(source, flown)
    table += _estimate_rows(settings, flown.errors)
    if len(aiding_sources(settings)) == 2:
        table += _by_hand_rows(settings.velocity_meter, flown, states)
    return table


def _error_rows(aided, free):
    table = [AidedRow(f'{AIDED}max |d{name}|', 'm', _largest(aided, axis), _largest(free, axis))
             for axis, name in ((1, 'N'), (0, 'E'))]
    own, others = _horizontal(aided), _horizontal(free)
    sigma = np.hypot(aided.position_sigma[:, 0], aided.position_sigma[:, 1])
    table.append(AidedRow(f'{AIDED}rms horizontal', 'm',
                 _rms(own), _rms(others), _known(_rms(sigma))))
    table.append(AidedRow(f'{AIDED}horizontal at the end', 'm', float(own[-1]), float(others[-1]),
                          _known(float(sigma[-1]))))
    return table


def _largest(errors, axis):
    return float(np.abs(errors.position[:, axis]).max())


def _horizontal(errors):
    return np.hypot(errors.position[:, 0], errors.position[:, 1])


def _rms(values):
    return float(np.sqrt(np.mean(np.square(values))))


def _known(value):
    return value if np.isfinite(value) else None


def _inside_rows(errors):
    """Return the rows with the share of time that each error is within three sigma."""
    table = []
    for kind in ('position', 'velocity', 'attitude'):
        error, sigma = getattr(errors, kind), getattr(errors, f'{kind}_sigma')
        axes = [axis for axis in range(3) if (sigma[:, axis] > 0.0).any()]
        if axes:
            inside = np.abs(error[:, axes]) <= 3.0 * sigma[:, axes]
            table.append(AidedRow(f'{AIDED}{kind} in 3 sigma', '%', 100.0 * float(inside.mean()),
                                  true=100.0 * THREE_SIGMA))
    return table


def _fix_rows(source, flown):
    fixes = flown.velocity_fixes if source == METER else flown.gnss_fixes
    results = [judged.outcome for judged in flown.judged if judged.source == source]
    weighed = [r for r in results if r.nis is not None]
    table = []
    if weighed:
        # All fixes of a sensor have the same degrees of freedom.
        freedom = weighed[0].freedom
        low, high = mean_interval(len(weighed), freedom)
        mean = float(np.mean([r.nis for r in weighed]))
        table.append(AidedRow(f'{AIDED}NIS of {source}', '', mean,
                              true=float(freedom), low=low, high=high))
    taken = sum(r.taken for r in results)
    for name, number, note in (('reported', len(fixes), ''), ('taken', taken, ''),
                               ('refused', len(results) - taken, _reasons(results))):
        table.append(AidedRow(f'{AIDED}{source} fixes {name}',
                     '', number, source=source, note=note))
    return table


def _reasons(results):
    """Return the reasons for which fixes were rejected, the most frequent first."""
    counts = Counter(r.reason for r in results if not r.taken).most_common()
    texts = [f'{reason} ({count})' for reason, count in counts[:REASONS]]
    rest = sum(count for _, count in counts[REASONS:])
    return '; '.join(texts + ([f'others ({rest})'] if rest else []))


def _estimate_rows(settings, errors):
    """Return the rows of the estimated errors of the velocity meter, with the true values."""
    model, meter = settings.aided_navigator.meter_model, settings.velocity_meter
    if np.isnan(errors.estimates_sigma).any():
        return []
    beam = (meter.beam.sigma_theta_z_rad / meter.beam.sigma_theta_x_rad) ** 2
    surrogate = meter.surrogate if meter.mode == 'surrogate' else None
    k_x, k_z = (surrogate.k_x, surrogate.k_z) if surrogate else (0.0, 0.0)
    table = []
    for k, (name, unit, factor, given, true) in enumerate((
            ('mounting mu', 'arcmin', 1.0 / ARCMIN, model.mounting_sigma_arcmin,
             ARCMIN * meter.antennas.mounting_yaw_arcmin),
            ('scale kx', '%', 100.0, model.scale_x_sigma, k_x),
            ('scale kz', '%', 100.0, model.scale_z_sigma, (1.0 + k_z) * beam - 1.0))):
        if given:
            table.append(AidedRow(f'{AIDED}{name}', unit, factor * float(errors.estimates[-1, k]),
                                  sigma=factor * float(errors.estimates_sigma[-1, k]),
                                  true=factor * true))
    return table


def _by_hand_rows(meter, flown, states):
    """Return azimuth and mounting error found from the two calibration manoeuvres, if flown."""
    try:
        found = calibrate_mounting(states, flown.gnss_fixes, flown.velocity_fixes)
    except ValueError:
        # There are too few fixes of a sensor, or no turn while GNSS works.
        return []
    mu, sigma = found.least_squares
    true = meter.antennas.mounting_yaw_arcmin
    by_hand = found.two_manoeuvres / ARCMIN
    return [AidedRow(f'{AIDED}mounting by (27)', 'arcmin', by_hand, true=true),
            AidedRow(f'{AIDED}mounting, least squares', 'arcmin', mu / ARCMIN,
                     sigma=sigma / ARCMIN, true=true),
            AidedRow(f'{AIDED}azimuth of the strapdown', 'arcmin', found.dpsi / ARCMIN,
                     sigma=found.dpsi_sigma / ARCMIN)]


def show_aided(title, rows, console):
    """Print a table of the rows, and below it a line about the fixes of each instrument."""
    columns = filled_columns(rows)
    table = Table(title=title, caption=column_meanings(columns))
    table.add_column('figure', no_wrap=True)
    table.add_column('unit', no_wrap=True)
    for column in columns:
        table.add_column(column.head, justify='right', no_wrap=True)
    for row in rows:
        if not row.source:
            table.add_row(row.name.removeprefix(AIDED), row.unit,
                          *(column.value(row) or '-' for column in columns))
    console.print(table)
    for line in fix_lines(rows):
        console.print(line)


def fix_lines(rows):
    """Return a line about the fixes of each instrument."""
    lines = []
    for source in dict.fromkeys(row.source for row in rows if row.source):
        counts = [row for row in rows if row.source == source]
        told = ', '.join(f'{row.measured} {row.name.split()[-1]}' for row in counts)
        notes = ''.join(f': {row.note}' for row in counts if row.note)
        lines.append(f'{source} fixes: {told}{notes}')
    return lines


def filled_columns(rows):
    """Return the columns that are not empty."""
    return [column for column in COLUMNS if any(column.value(row) for row in rows)]


def column_meanings(columns):
    """Return explanations of the column heads that need one."""
    return '; '.join(c.meaning for c in columns if c.meaning)


def _short(value):
    return '' if value is None else f'{value:.4g}'


def _expected(row):
    return _short(row.true) if row.low is None else f'{row.low:.2f}-{row.high:.2f}'


COLUMNS = (
    _Column('aided', lambda row: _short(row.measured), ''),
    _Column('alone', lambda row: _short(row.free), 'alone: the unaided strapdown with its own '
            'initial state'),
    _Column('sigma', lambda row: _short(row.sigma), 'sigma: according to the filter'),
    _Column('expected', _expected,
            'expected, for NIS: the interval that contains 95 % of consistent runs'))


def fault_lines(flown):
    """Return the lines about faults that restarted the aided solution or dropped a fix."""
    if not flown.faults:
        return []
    return [f'{len(flown.faults)} faults of the aided navigator; the first: {flown.faults[0]}']
