"""Consistency of the filter over an ensemble of aided runs: NEES and NIS in figures and tables."""

import numpy as np

from ins_sim.core.aiding.consistency import BLOCKS
from ins_sim.core.aiding.navigator import GNSS, METER
from ins_sim.core.ensemble.consistency import ChiSquareSums
from ..charts.chart import Chart
from ..charts.palette import BLUE, GREEN, ORANGE, RED
from ..charts.scales import scale, TIMES
from ..consistency import sum_intervals
from ..page.content import PageTable
from .consistency import consistency_panel, Entry, inside_share, judged, WORDS

INSTRUMENTS = {METER: 'velocity meter', GNSS: 'GNSS'}
STYLES = dict(zip(BLOCKS, (BLUE, RED, GREEN, ORANGE)))
HEADS = ('quantity', 'mean', 'expected', 'in 95 % of consistent filters', 'instants inside',
         'the filter is')


def quantities(consistency):
    """Return {words: ChiSquareSums (n,)} of a Consistency: NEES by block, NIS by instrument."""
    nees, fixes = consistency
    found = {f'NEES of {WORDS[block]}': ChiSquareSums(*(a[:, k] for a in nees))
             for k, block in enumerate(BLOCKS) if nees.count[:, k].any()}
    found.update({f'NIS of {INSTRUMENTS[source]}': one.sums for source, one in fixes.items()
                  if one.sums.count.any()})
    return found


def consistency_rows(consistency):
    """
    Return the rows of the table of a Consistency, with the columns HEADS.

    Mean and interval refer to the last instant; the share of instants inside refers to all.
    """
    rows = []
    for words, sums in quantities(consistency).items():
        k = int(np.flatnonzero(sums.count)[-1])
        low, high = (float(bound[k]) for bound in sum_intervals(sums))
        share, count = inside_share(sums)
        rows.append((words, float(sums.mean[k]), float(sums.expected[k]),
                     f'{low:.2f} to {high:.2f}', f'{100.0 * share:.1f} % of {count}',
                     judged(sums.mean[k], low, high)))
    return rows


def consistency_table(consistency):
    """Return the PageTable of a Consistency, or None if the filter has no covariance."""
    rows = consistency_rows(consistency)
    if not rows:
        return None
    return PageTable('consistency of the filter at the last instant', HEADS, tuple(rows),
                     'each interval holds for one instant; errors of a run at successive instants '
                     'are correlated, so that NEES stays outside of its interval for a while')


def consistency_chart(t_ns, consistency):
    """Return the Chart of NEES and NIS over t_ns (m,), or None if there are none."""
    nees, fixes = consistency
    last_ns = max([int(t_ns[-1]), *(int(one.t_ns[-1]) for one in fixes.values() if len(one.t_ns))])
    factor, unit = scale(TIMES, last_ns * 1e-9)
    x_label, panels = f'time [{unit}]', []
    entries = [Entry(WORDS[block], t_ns * 1e-9 * factor, ChiSquareSums(*(a[:, k] for a in nees)),
                     STYLES[block]) for k, block in enumerate(BLOCKS) if nees.count[:, k].any()]
    for entry in entries:
        panels.append(consistency_panel([entry], x_label, f'NEES of {entry.label}, over its '
                                        'degrees of freedom', 'NEES / states'))
    for source, one in fixes.items():
        if one.sums.count.any():
            panels.append(consistency_panel(
                [Entry(INSTRUMENTS[source], one.t_ns * 1e-9 * factor, one.sums, BLUE)], x_label,
                f'NIS of {INSTRUMENTS[source]}, over its degrees of freedom', 'NIS / components',
                fixes=True))
    if not panels:
        return None
    runs = int(nees.count.max(initial=0)) or max(int(one.sums.count.max())
                                                 for one in fixes.values())
    return Chart('consistency', f'Consistency of the filter: mean NEES and NIS of {runs} runs',
                 tuple(panels),
                 caption='At each instant, 95 of 100 ensembles of a consistent filter lie in the '
                 'band; errors of a run at successive instants are correlated.')


def consistency_answer(consistency):
    """Return a sentence saying whether the filter is consistent."""
    rows = consistency_rows(consistency)
    if not rows:
        return 'The filter has no covariance, hence neither NEES nor NIS.'
    outside = [row for row in rows if row[5] != 'consistent']
    if not outside:
        return ('The filter is consistent: NEES and NIS at the last instant lie in their 95 % '
                'intervals.')
    return 'At the last instant the filter is ' + ', and '.join(
        f'{row[5]} by {row[0]} ({row[1]:.2f}, expected {row[2]:.2f}, {row[3]} in 95 % of '
        'consistent filters)' for row in outside) + '.'


def consistency_notes(result, filter_name):
    """Return sentences on missing covariances and rejected fixes of an AidedEnsembleResult."""
    notes = []
    if result.errors.statistics.count.any() and not result.consistency.nees.count.any():
        notes.append(f'filter {filter_name} has no covariance, hence no NEES')
    for source, one in result.consistency.fixes.items():
        refused, taken = int(one.refused.sum()), int(one.taken.sum())
        if refused:
            notes.append(f'{INSTRUMENTS[source]}: {refused} of {refused + taken} valid fixes of '
                         'all runs were rejected')
    return notes
