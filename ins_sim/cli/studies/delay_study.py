"""Verb delay-study: the figures and tables of the paper on delays, and what it leaves out."""

import json
from pathlib import Path

from .. import arguments

HELP = 'the figures and tables of the paper on delays of gyro channels'
DESCRIPTION = ('Fly the motions of Bogdanov and Fomichev (2018) with late gyros, and show figures '
               'and tables beside what they publish: position errors of motion 2, tuned and '
               'detuned, three flights, the drift over the rates of motion 2 and over the '
               'direction of rocking, and what each channel contributes.')
SHIPPED = tuple(f'delay_study_{name}' for name in (
    'figure_1', 'figure_2', 'figure_3', 'figure_4', 'figure_5', 'theta_0', 'second_resonance',
    'rates', 'rocking'))
RECORDED = 'delay_study_recorded'
MARK = 'delay_study.json'


def add_arguments(parser):
    """Add the arguments of the verb to its parser."""
    parser.add_argument('--params-file', action='append', default=[], metavar='FILE',
                        help='parameter file of one figure, or the name of a shipped one; may be '
                        f'repeated (default: {", ".join(SHIPPED)})')
    parser.add_argument('--recording', action='append', default=[], metavar='FILE',
                        help='recorded flight, a CSV file or a bag, which is one more figure; may '
                        'be repeated')
    parser.add_argument('-p', '--param', action='append', default=[], metavar='NAME:=VALUE',
                        help='one parameter, for every figure')
    parser.add_argument('--jobs', type=int, default=0, metavar='N', help='processes (default: '
                        'as many as cores)')
    arguments.add_output(parser, 'ins_sim_delay_study', 'folder of figures and numbers')
    arguments.add_force(parser, 'what is in DIR')


def run(chosen):
    """Fly, show and save; return the exit code."""
    from ins_sim.own_folders import whole_folder
    from ins_sim.report.charts.png import save_chart
    from ins_sim.report.console import PlainConsole
    from ins_sim.report.page.html import write_page
    from ins_sim.report.studies import delay_data, delays as report
    from ins_sim.studies.delays.study import distinct_runs, gather
    from ..workers import run_all
    if chosen.jobs < 0:
        raise ValueError(f'--jobs is {chosen.jobs}; expected 0 (every core) or more')
    figures, console = _figures(chosen), PlainConsole()
    with whole_folder(chosen.output, chosen.force, MARK) as folder:
        flown = run_all(distinct_runs(figures), chosen.jobs, console, 'runs')
        results = gather(figures, flown)
        tables, charts = report.study_tables(results), report.study_charts(results)
        files = {MARK: 'the numbers of the tables'}
        for result in results:
            files.update(dict.fromkeys(delay_data.save_csv(folder, result),
                                       f'the curves of {result.figure.name}'))
        for chart in charts:
            save_chart(folder, chart)
            files[f'{chart.name}.png'] = 'a figure'
        (folder / MARK).write_text(json.dumps({
            'figures': [delay_data.figure_numbers(result) for result in results],
            'runs': [delay_data.run_numbers(one) for one in delay_data.all_runs(results)]},
            indent=1) + '\n', encoding='utf-8')
        write_page(folder, report.study_page(results, charts, tables, files))
    report.show_study(results, tables, console)
    console.print(f'report: {chosen.output}/report.html')
    return 0


def _figures(chosen):
    """Return the DelayFigures of the command line."""
    from ins_sim import resources
    paths = arguments.parameter_paths(chosen, () if chosen.recording else SHIPPED)
    figures = [_figure(path.stem, path, chosen.param) for path in paths]
    figures += [_figure(f'recorded_{Path(name).name.partition(".")[0]}',
                        resources.config(RECORDED), [*chosen.param, 'motion_generator:motion.'
                                                     f'recording.path:={json.dumps(name)}'])
                for name in chosen.recording]
    names = [figure.name for figure in figures]
    for name in names:
        if names.count(name) > 1:
            raise ValueError(f'two figures are named {name}; expected files of different names, '
                             'as the figures bear them')
    return figures


def _figure(name, path, assignments):
    from ins_sim import parameter_files
    from ins_sim.io.motion import read_motion
    from ins_sim.studies.delays.figure import KNOWN_NODES, make_figure, READ_NODES
    try:
        return make_figure(name, parameter_files.read_nodes([path], assignments, READ_NODES,
                                                            KNOWN_NODES), read_motion)
    except ValueError as error:
        if str(error).startswith(str(path)):
            raise
        raise ValueError(f'{name}: {error}') from None
