"""Report of an error budget: sentences, tables, figures, numbers and page."""

import json

import numpy as np
from rich.table import Table

from ins_sim import parameter_files
from ins_sim.core.prediction.budget.linear_budget import INTERVALS
from ins_sim.studies.budget.beside import not_compared
from ins_sim.studies.budget.quantities import (ANGLE, LENGTH, linear_until, LINEAR_UP_TO,
                                               QUANTITIES, shares)
from ins_sim.studies.budget.requirement import UNITS
from ins_sim.studies.budget.sensitivities import sensitivities
from ins_sim.studies.error_circle import error_circle
from ..charts import scales
from ..charts.png import save_chart
from ..page.content import Page, PageTable
from ..page.html import write_page
from ..titles import length_words, title
from .budget_charts import charts, SCALES

MARK = 'budget.json'
ARRAYS, SETTINGS = 'budget.npz', 'parameters.yaml'
ARCSEC = 3600.0 * np.degrees(1.0)
# The columns of tables refer to these parts of the run.
PARTS = (1.0 / 6.0, 0.5, 1.0)
# A source is listed in the answer to a requirement if the error without it is below this part.
LITTLE = 0.999
# Maximum number of diverged runs that are listed.
MOST_NAMED = 20
LEFT_OUT = ('Not covered: range and quantisation of the instruments, jitter, latency and loss of '
            'samples, errors of the algorithms, and effects of second order.')


def write_budget(folder, settings, linear, answers, compared, beside):
    """
    Write report, figures, tables and arrays of a LinearBudget into a folder (pathlib.Path).

    ``answers`` are RequirementAnswers, ``compared`` are the ComparedQuantities of the BesideRuns
    ``beside``, or None.
    """
    words = title(settings)
    drawn = charts(linear, words, compared, [a.requirement for a in answers])
    for chart in drawn:
        save_chart(folder, chart)
    tables = budget_tables(linear, answers, compared)
    notes = budget_notes(linear, compared, beside)
    (folder / MARK).write_text(json.dumps(_numbers(linear, answers, tables, notes), indent=1)
                               + '\n', encoding='utf-8')
    np.savez_compressed(folder / ARRAYS, t_s=linear.t_s, covariance=linear.covariance,
                        random=[s.key for s in linear.random], mean=linear.mean,
                        fixed=[s.key for s in linear.fixed])
    (folder / SETTINGS).write_text(parameter_files.dump(settings), encoding='utf-8')
    write_page(folder, Page(
        f'Error budget: {words}', ' '.join([answer_sentence(linear),
                                            *map(requirement_sentence, answers)]),
        drawn, tables, notes, settings, {},
        {MARK: 'tables and answers', ARRAYS: 'covariances and mean errors by source, SI',
         SETTINGS: 'every parameter', **{f'{c.name}.png': c.title for c in drawn}}))


def show_budget(settings, linear, answers, compared, beside, console):
    """Print the answer, the tables and the notes."""
    for table in budget_tables(linear, answers, compared):
        shown = Table(title=table.title, caption=table.note or None)
        for k, head in enumerate(table.heads):
            shown.add_column(head, justify='right' if k and any(
                isinstance(row[k], float) for row in table.rows) else 'left')
        for row in table.rows:
            shown.add_row(*(f'{x:.4g}' if isinstance(x, float) else str(x) for x in row))
        console.print(shown)
    for note in budget_notes(linear, compared, beside):
        console.print(note)
    console.print(f'{title(settings)}: {answer_sentence(linear)}')
    for answer in answers:
        console.print(requirement_sentence(answer))


def answer_sentence(linear):
    """Return a sentence with the horizontal error at the end and its largest source."""
    made = shares(linear, QUANTITIES['horizontal'])
    end, rms = linear.t_s[-1], float(made.rms[-1])
    if not rms > 0.0:
        return 'The settings contain no error that affects the position.'
    parts = made.by_source()[:, -1] / (rms * rms)
    k = int(np.argmax(parts))
    source = (*linear.random, *linear.fixed)[k]
    cep = _cep(linear, 0.5)[-1]
    return (f'After {length_words(end)} the horizontal position error is {_text(LENGTH, rms)} rms '
            f'(CEP50 {_text(LENGTH, cep)}); {100.0 * parts[k]:.0f} % of its mean square comes '
            f'from the {source.label}.')


def requirement_sentence(answer):
    """Return a sentence saying which improvements meet a requirement."""
    r, unit = answer.requirement, QUANTITIES[answer.requirement.quantity].unit
    found = f'{r.text}: the budget gives {_text(unit, answer.found)}'
    if answer.met:
        return f'{found}, which meets it.'
    enough = [i for i in answer.alone if i.factor is not None]
    if enough:
        ways = ', or '.join(_way(i) for i in enough)
        told = f'it is met by improving one source alone: {ways}'
    else:
        best = answer.alone[0]
        told = (f'no single source suffices ({_text(unit, best.without)} remains without the '
                f'{best.source.label})')
    if answer.random is None:
        every = 'improving all random errors does not suffice, as the fixed ones exceed it'
    else:
        every = f'all random errors x {answer.random:.4g} meet it'
    return f'{found}; {told}; {every}; all errors x {answer.everything:.4g} meet it.'


def _way(improvement):
    source, values = improvement.source, improvement.values
    if values is None:
        return f'without the {source.label}'
    text = ', '.join(f'{v:.4g}' for v in dict.fromkeys(values))
    return f'{source.label} x {improvement.factor:.4g} ({text} {source.unit})'


def budget_tables(linear, answers, compared):
    """Return the PageTables of a budget."""
    numbers = [int(np.argmin(np.abs(linear.t_s - part * linear.t_s[-1]))) for part in PARTS]
    tables = [_total_table(linear, numbers)]
    count = len(linear.random)
    for sources, part, words in (
            (linear.random, slice(0, count),
             'Errors that differ from run to run, each alone (standard deviation)'),
            (linear.fixed, slice(count, None),
             'Errors that are the same in every run, each alone')):
        if sources:
            tables.append(_source_table(linear, sources, part, numbers, words))
    if linear.random or linear.fixed:
        tables.append(_sensitivity_table(linear))
    tables += [_answer_table(answer) for answer in answers if not answer.met]
    if compared:
        tables.append(_beside_table(compared))
    return tuple(tables)


def _total_table(linear, numbers):
    rows = [(f'{q.words}, rms', 'arcsec' if q.unit == ANGLE else q.unit,
             *(float(x) for x in (ARCSEC if q.unit == ANGLE else 1.0)
               * shares(linear, q).rms[numbers])) for q in QUANTITIES.values()]
    rows[1:1] = [(f'CEP{100 * part:.0f}', 'm', *(float(x) for x in _cep(linear, part)[numbers]))
                 for part in (0.5, 0.95)]
    return PageTable('All errors together', ('error', 'unit', *_heads(linear, numbers)),
                     tuple(rows))


def _heads(linear, numbers):
    return [f'at {linear.t_s[k]:.6g} s' for k in numbers]


def _source_table(linear, sources, part, numbers, words):
    made = shares(linear, QUANTITIES['horizontal'])
    metres = made.contributions()[part][:, numbers]
    squares = made.by_source()[part, -1] / max(made.rms[-1] * made.rms[-1], 1e-300)
    azimuth, tilt = (ARCSEC * shares(linear, QUANTITIES[name]).contributions()[part, -1]
                     for name in ('azimuth', 'tilt'))
    order = [k for k in np.argsort(-metres[:, -1], kind='stable')
             if metres[k].any() or tilt[k] or azimuth[k]]
    rows = tuple((sources[k].label, _value_text(sources[k]), *(float(x) for x in metres[k]),
                  f'{100.0 * squares[k]:.1f} %', float(tilt[k]), float(azimuth[k]))
                 for k in order)
    heads = [f'{head} [m]' for head in _heads(linear, numbers)]
    return PageTable(words, ('source', 'parameter', *heads, 'share of the mean square',
                             'tilt [arcsec]', 'azimuth [arcsec]'), rows,
                     'Horizontal position error of each source, ranked; tilt, azimuth and share '
                     'of the mean square at the end.' + _silent(sources, order))


def _silent(sources, shown):
    """Return a sentence on the sources that cause no error in this run, or ''."""
    silent = [source.label for k, source in enumerate(sources) if k not in shown]
    return f' No effect on the position here: {", ".join(silent)}.' if silent else ''


def _value_text(source):
    values = ', '.join(f'{v:g}' for v in (source.values if len(set(source.values)) > 1
                                          else source.values[:1]))
    return f'{values} {source.unit}'


def _sensitivity_table(linear):
    found = sensitivities(linear, QUANTITIES['horizontal'], len(linear.t_s) - 1)
    found = sorted((s for s in found if s.alone), key=lambda s: -abs(s.slope * s.value))
    rows = tuple((s.source.key + (f'[{s.axis}]' if s.axis else ''), float(s.value),
                  s.source.unit, float(s.alone), float(s.slope),
                  float(0.01 * s.slope * s.value)) for s in found)
    return PageTable('Sensitivities of the horizontal rms at the end',
                     ('parameter', 'value', 'unit', 'alone [m per unit]', 'd rms [m per unit]',
                      'd rms for + 1 % [m]'), rows,
                     '"alone": error caused by one unit of the parameter by itself; "d rms": '
                     'change of the total rms with the parameter.')


def _answer_table(answer):
    r, unit = answer.requirement, QUANTITIES[answer.requirement.quantity].unit
    name, si = ('arcsec', 1.0 / ARCSEC) if unit == ANGLE else (unit, UNITS[unit][1])
    rows = [(i.source.label, '-' if i.factor is None else float(i.factor),
             '-' if i.values is None else ', '.join(f'{v:.4g}' for v in dict.fromkeys(i.values)),
             i.source.unit, float(i.without / si)) for i in answer.alone
            if i.without < LITTLE * answer.found]
    rows += [('all random errors', '-' if answer.random is None else float(answer.random), '-',
              '', '-'), ('all errors', float(answer.everything), '-', '', '-')]
    return PageTable(f'What must improve: {r.text}',
                     ('source', 'factor', 'required parameter', 'unit', f'without it [{name}]'),
                     tuple(rows), 'A dash: improving this alone does not suffice. Sources that '
                     f'contribute less than {100.0 * (1.0 - LITTLE):.1f} % are left out.')


def _beside_table(compared):
    rows = []
    for found in compared:
        unit = QUANTITIES[found.name].unit
        factor, name = (ARCSEC, 'arcsec') if unit == ANGLE else (1.0, unit)
        for k in dict.fromkeys(int(np.argmin(np.abs(found.t_s - part * found.t_s[-1])))
                               for part in PARTS):
            rows.append((QUANTITIES[found.name].words, name, f'{found.t_s[k]:.6g} s',
                         float(factor * found.budget[k]), float(factor * found.ensemble[k]),
                         float(found.ratio[k]), f'{found.low[k]:.3f} to {found.high[k]:.3f}',
                         ('differs' if found.differs[k] else 'inside')
                         + ('' if found.linear[k] else ', beyond linear theory')))
    return PageTable('Comparison of ensemble and budget',
                     ('error', 'unit', 'at', 'budget', 'ensemble', 'ratio', '99.9 % of ensembles',
                      'verdict'), tuple(rows),
                     'Horizontal quantities: rms; single axes: standard deviation.')


def budget_notes(linear, compared, beside):
    """Return sentences on omitted effects and on the validity of the budget."""
    notes = [LEFT_OUT]
    until = linear_until(linear)
    if until is not None:
        notes.append(f'Linear theory holds until {until:.6g} s: from then on the larger of the '
                     f'azimuth error and the rotation of the axes over the Earth is above '
                     f'{LINEAR_UP_TO:g} rad, and the curves are dashed.')
    for part, name in zip(linear.beyond, ('accelerometers', 'gyros')):
        if part > 0.0:
            notes.append(f'In {100.0 * part:.2g} % of the time the input of the {name} exceeds '
                         'their range, which the budget neglects.')
    if beside is not None:
        notes.append(_ensemble_note(compared, beside))
        left_out = not_compared(linear, beside)
        if left_out:
            notes.append(f'{left_out} of the {len(beside.t_s)} instants of the ensemble are left '
                         'out: they are not among those of the budget, which divides the run into '
                         f'{INTERVALS} intervals, or fewer than 2 runs have not diverged.')
        if any(source.triad is None for source in linear.random):
            notes.append('The runs have no random initial errors: the comparison leaves the '
                         'standard deviations of initial.* out of the budget.')
    return tuple(notes)


def _ensemble_note(compared, beside):
    lost = ''
    if beside.diverged:
        lost = (f' {len(beside.diverged)} of them diverged and are excluded from then on: '
                f'{", ".join(map(str, beside.diverged[:MOST_NAMED]))}'
                + (' and others.' if len(beside.diverged) > MOST_NAMED else '.'))
    if not compared:
        return (f'The ensemble of {beside.runs} runs is not compared, because no quantity of the '
                f'budget has a random error.{lost}')
    off = [found.name for found in compared if found.differs.any()]
    told = ('agrees with the budget: all ratios are inside their 99.9 % interval' if not off else
            f'is outside of the 99.9 % interval of the budget in {", ".join(off)}')
    return f'The ensemble of {beside.runs} runs {told}.{lost}'


def _cep(linear, part):
    return error_circle(linear.total_mean()[:, :2], linear.total_covariance()[:, :2, :2], part)


def _text(unit, value):
    """Return a value in SI as text in a convenient unit."""
    factor, name = scales.scale(((1000.0, 1e-3, 'km'), *scales.LENGTHS[1:]) if unit == LENGTH
                                else SCALES[unit], value)
    return f'{factor * value:.4g} {name}'


def _numbers(linear, answers, tables, notes):
    """Return the document that is written into the file MARK."""
    return {'answer': answer_sentence(linear),
            'requirements': [{'text': a.requirement.text, 'found': a.found, 'met': a.met,
                              'random': a.random, 'everything': a.everything,
                              'sentence': requirement_sentence(a)} for a in answers],
            'linear_until_s': linear_until(linear), 'notes': list(notes),
            'tables': [{'title': t.title, 'heads': list(t.heads),
                        'rows': [list(row) for row in t.rows]} for t in tables]}
