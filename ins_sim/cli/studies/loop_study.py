"""Verb loop-study: stability of a vehicle that is steered by its own aided solution."""

from dataclasses import asdict
import json

from .. import arguments

HELP = 'study a vehicle that is steered by its own aided solution'
DESCRIPTION = ('Steer a vehicle by a solution that is aided by a velocity meter with a lateral '
               'scale error. Shows a table of simulated flights, stability limits compared with '
               'linear theory, a stability map, and flights with noise, wind, gusts and the '
               'signals of the meter. The study sets filter, gain, windows, lateral scale error, '
               'initial offset, length and engagement of the autopilot; everything else is taken '
               'from the parameters.')
SHIPPED = ('guided_flight',)
MARK = 'loop_study.json'
TITLE = 'Flight steered by its own aided solution'
PARTS = ('table', 'limits', 'conditions', 'map')


def add_arguments(parser):
    """Add the arguments of the verb to its parser."""
    arguments.add_settings(parser, ' and '.join(SHIPPED))
    parser.add_argument('--parts', nargs='+', choices=PARTS, default=list(PARTS), metavar='PART',
                        help=f'one or more of {", ".join(PARTS)} (default: all)')
    parser.add_argument('--gains', type=int, default=15, metavar='N', help='number of gains in '
                        'each panel of the map (default: %(default)s)')
    parser.add_argument('--jobs', type=int, default=0, metavar='N', help='number of processes '
                        '(default: one for each core)')
    arguments.add_output(parser, 'ins_sim_loop', 'folder of figures, numbers and report')
    arguments.add_force(parser, 'what is in DIR')


def run(chosen):
    """Simulate, print and save; return the exit code."""
    from ins_sim.core.guidance.steering import margin_sentence
    from ins_sim.own_folders.own_folder import whole_folder
    from ins_sim.report.charts.png import save_chart
    from ins_sim.report.console import PlainConsole
    from ins_sim.report.page.html import REPORT, write_page
    from ins_sim.report.studies import closed_loop as report
    from ins_sim.report.titles import instrument_words
    from ins_sim.studies.closed_loop import study_loop
    if chosen.gains < 1 or chosen.jobs < 0:
        raise ValueError(f'--gains is {chosen.gains} and --jobs {chosen.jobs}; expected 1 or more '
                         'gains, and 0 (every core) or more jobs')
    settings = arguments.read_aided_settings(chosen, SHIPPED)
    kind = settings.simulation.motion_generator.motion.kind
    if kind != 'guided':
        raise ValueError(f'motion.kind is {kind}; expected guided, a motion steered by the '
                         'solution')
    loop, console = study_loop(settings), PlainConsole()
    generator = settings.simulation.motion_generator
    if warning := margin_sentence(generator.guidance, generator.motion.guided):
        console.print(warning)
    with whole_folder(chosen.output, chosen.force, MARK) as folder:
        found = {part: _MAKERS[part](chosen, settings, loop, console)
                 for part in dict.fromkeys(chosen.parts)}
        numbers = {name: part.numbers for name, part in found.items()}
        (folder / MARK).write_text(json.dumps(numbers, indent=1) + '\n', encoding='utf-8')
        sensor = settings.simulation.imu_sensor
        page = report.loop_page(f'{TITLE}: {instrument_words(sensor)}, {sensor.rate_hz:g} Hz',
                                settings, list(found.values()))
        for chart in page.charts:
            save_chart(folder, chart)
        write_page(folder, page)
    console.print(f'figures, numbers and {REPORT}: {chosen.output}')
    return 0


def _show(rows, title, console):
    """Print the table of LoopRows; return it."""
    from ins_sim.report.studies import closed_loop as report
    table = report.flights_table(title, rows)
    report.show_table(table, console)
    return table


def _table(chosen, settings, loop, console):
    from ins_sim.report.studies import closed_loop as report
    from ins_sim.report.studies.closed_loop_charts import histories_chart
    from ins_sim.studies.closed_loop import fly_case, lateral_flight, TABLE
    from ..workers import run_all
    flights = run_all([(fly_case, settings, case) for case in TABLE], chosen.jobs, console,
                      'flights')
    alone = run_all([(lateral_flight, settings, loop, case) for case in TABLE], chosen.jobs,
                    console, 'flights of the lateral channel alone')
    rows = [report.loop_row(*row) for row in zip(TABLE, flights, alone)]
    table = _show(rows, 'Closed loop', console)
    charts = []
    for k_z in dict.fromkeys(case.k_z for case in TABLE):
        shown = [k for k, case in enumerate(TABLE) if case.k_z == k_z and case.duration_s <= 300.0]
        charts.append(histories_chart(
            f'histories_{k_z:g}', f'{TITLE}: lateral scale error of the meter k_z = {k_z:g}',
            [_name(TABLE[k]) for k in shown], [flights[k] for k in shown]))
    return report.LoopPart([asdict(row) for row in rows], report.flights_answer(rows),
                           tuple(charts), (table,))


def _name(case):
    engaged = f', engaged at {case.engage_s:g} s' if case.engage_s else ''
    offset = f', from {case.offset_m:g} m' if case.offset_m != 100.0 else ''
    return case.label + engaged + offset


def _limits(chosen, settings, loop, console):
    from ins_sim.report.studies import closed_loop as report
    from ins_sim.studies.closed_loop import (AT_THE_LIMIT, cases_near, flown_limits,
                                             growth_of_flight, linear_limits)
    from ..workers import run_all
    linear = linear_limits(loop)
    growths = run_all([(growth_of_flight, settings, case) for case in cases_near(linear)],
                      chosen.jobs, console, 'flights')
    rows = [report.LimitRow(case.label, limit.k_z, limit.frequency, flown) for case, limit, flown
            in zip(AT_THE_LIMIT, linear, flown_limits(linear, growths))]
    table = report.limits_table(rows)
    report.show_table(table, console)
    return report.LoopPart([asdict(row) for row in rows], report.limits_answer(rows),
                           tables=(table,))


def _conditions(chosen, settings, loop, console):
    from ins_sim import parameter_files
    from ins_sim.report.studies import closed_loop as report
    from ins_sim.report.studies.closed_loop_charts import histories_chart
    from ins_sim.studies.closed_loop import CONDITIONS, fly_case, VARIED
    from ..workers import run_all
    paths = arguments.parameter_paths(chosen, SHIPPED)
    flown = [(name, case, parameter_files.read_aided(paths, [*chosen.param, *more]))
             for name, more in CONDITIONS.items() for case in VARIED]
    flights = run_all([(fly_case, one, case) for _, case, one in flown], chosen.jobs, console,
                      'flights')
    rows = [report.loop_row(case, flight, condition=name)
            for (name, case, _), flight in zip(flown, flights)]
    table = _show(rows, 'Closed loop under conditions', console)
    charts = []
    for case in VARIED:
        shown = [k for k, (_, other, _) in enumerate(flown) if other is case]
        charts.append(histories_chart(
            f'{case.filter}_{case.cycles}_{case.gain:g}',
            f'{TITLE}: {case.label}, lateral scale error of the meter k_z = {case.k_z:g}',
            [flown[k][0] for k in shown], [flights[k] for k in shown]))
    return report.LoopPart([asdict(row) for row in rows],
                           f'Under conditions {report.flights_answer(rows)}', tuple(charts),
                           (table,))


def _map(chosen, settings, loop, console):
    import math
    from ins_sim.report.studies.closed_loop import LoopPart
    from ins_sim.report.studies.closed_loop_charts import map_answer, map_chart
    from ins_sim.studies.stability_map import map_curves, PANELS
    from ..workers import run_all
    most = math.radians(settings.simulation.motion_generator.guidance.limit_deg)
    curves = run_all([(map_curves, loop, panel, chosen.gains, most) for panel in PANELS],
                     chosen.jobs, console, 'panels')
    numbers = [{'filter': panel.label, 'gains': found.gains.tolist(),
                'linear': found.linear.tolist(),
                'flown': {f'{start:g} m': values.tolist()
                          for start, values in found.flown.items()}}
               for panel, found in zip(PANELS, curves)]
    return LoopPart(numbers, map_answer(curves), (map_chart(PANELS, curves),))


_MAKERS = {'table': _table, 'limits': _limits, 'conditions': _conditions, 'map': _map}
