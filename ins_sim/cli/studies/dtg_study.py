"""Verb dtg-study: repeat the tables of Sapegin, Romanov and Bugaiov 2016 on tuned gyros."""

from itertools import count
from pathlib import Path

from .. import arguments

HELP = 'repeat the published study of tuned gyros'
DESCRIPTION = ('Measure the rocking of a base with two dynamically tuned gyros, as Sapegin, '
               'Romanov and Bugaiov (2016), and compare the amplitudes and stability limits with '
               'theirs.')
NODE = 'dtg_study'
SHIPPED = ('dtg_study_frequency', 'dtg_study_speed')


def add_arguments(parser):
    """Add the arguments of the verb to its parser."""
    parser.add_argument('--params-file', action='append', default=[], metavar='FILE',
                        help='parameter file of one table, or the name of a shipped one; may be '
                        f'repeated (default: {" and ".join(SHIPPED)})')
    parser.add_argument('-p', '--param', action='append', default=[], metavar='NAME:=VALUE',
                        help='value of a parameter, for every table')
    arguments.add_output(parser, 'ins_sim_dtg_study', 'folder of the figures and the report; '
                         'an existing one is replaced')


def run(chosen):
    """Compute, show and save the study of each parameter file; return the exit code."""
    from ins_sim import parameter_files
    from ins_sim.own_folders.own_folder import whole_folder
    from ins_sim.report.charts.png import save_chart
    from ins_sim.report.console import PlainConsole
    from ins_sim.report.page.html import REPORT, write_page
    from ins_sim.report.studies import tuned_gyro as report
    from ins_sim.settings.tuned_gyro import TunedGyroStudySettings
    studies = {}
    for path in arguments.parameter_paths(chosen, SHIPPED):
        if path.stem in studies:
            raise ValueError(f'two parameter files are named {path.stem}; expected different '
                             'names, as the figures are named after them')
        studies[path.stem] = parameter_files.read_nodes([path], chosen.param,
                                                        {NODE: TunedGyroStudySettings})[NODE]
    console = PlainConsole()
    with whole_folder(chosen.output, replace=True) as work:
        found = [_study(name, settings, console) for name, settings in studies.items()]
        for one in found:
            save_chart(work, one.chart)
        write_page(work, report.study_page(found))
    for name in studies:
        console.print(f'figure: {Path(chosen.output) / name}.png')
    console.print(f'report: {Path(chosen.output) / REPORT}')
    return 0


def _study(name, settings, console):
    """Compute and print one table; return its TunedGyroStudy."""
    from ins_sim.report.studies import tuned_gyro as report
    from ins_sim.studies import tuned_gyro as study
    from ..progress import progress_bars
    step_s, limits = 1e-3 * settings.step_ms, ()
    if settings.sweep == 'rotor_speed' and settings.method == 'rk4':
        limits = study.stability_limits(study.gyro_at(settings), step_s)
    with progress_bars(console, 'points') as add_bar:
        show, done = add_bar(name, len(settings.values) + len(settings.curve_values)), count(1)
        cells = study.study_table(settings, lambda: show(next(done)))
        curve = study.study_curve(settings, lambda: show(next(done))) or cells
    report.show_study(settings, cells, console)
    if limits:
        console.print(report.limits_sentence(settings, limits))
    chart = report.study_chart(name, settings, curve, cells, limits)
    return report.TunedGyroStudy(name, settings, cells, limits, chart)
