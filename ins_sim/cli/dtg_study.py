"""Verb dtg-study: tables, figures and limits of stability of the DTG paper, one file each."""

from pathlib import Path

from rich.console import Console

from ins_sim import parameter_files, resources
from ins_sim.report import dtg_study as report
from ins_sim.settings.tuned_gyro_study import DtgStudySettings
from ins_sim.studies import tuned_gyro as study
from .progress import ProgressBar

NODE = 'dtg_study'
SHIPPED = ('dtg_study_frequency', 'dtg_study_speed')

DESCRIPTION = ('Recover a rocking base through two dynamically tuned gyros as the paper does, '
               'and compare with what it prints.')


def add_arguments(parser):
    """Add the arguments of the verb."""
    parser.add_argument('--params-file', action='append', default=[], metavar='FILE',
                        help='parameter file of one table, or the name of a shipped one; may be '
                        'repeated (default: dtg_study_frequency and dtg_study_speed)')
    parser.add_argument('-p', '--param', action='append', default=[], metavar='NAME:=VALUE',
                        help='one parameter, for every table')
    parser.add_argument('-o', '--output', default='ins_sim_dtg_study', metavar='DIR',
                        help='folder of the figures (default: %(default)s)')


def run(chosen):
    """Compute, show and save the study of each parameter file; return the exit code."""
    paths = ([resources.parameter_file(name) for name in chosen.params_file]
             or [resources.config(name) for name in SHIPPED])
    studies = {}
    for path in paths:
        if path.stem in studies:
            raise ValueError(f'two parameter files are named {path.stem}; expected different '
                             'names, as the figures bear them')
        studies[path.stem] = parameter_files.read_nodes([path], chosen.param,
                                                        {NODE: DtgStudySettings})[NODE]
    console = Console()
    figures = [(name, settings, *_study(name, settings, console))
               for name, settings in studies.items()]
    folder = Path(chosen.output)
    folder.mkdir(parents=True, exist_ok=True)
    for name, *figure in figures:
        report.save_figure(folder / f'{name}.png', *figure)
        console.print(f'figure: {folder / name}.png', soft_wrap=True)
    return 0


def _study(name, settings, console):
    """Show one table; return the Cells of the curve, those of the table, and the limits."""
    step_s, limits = 1e-3 * settings.step_ms, ()
    if settings.sweep == 'rotor_speed' and settings.method == 'rk4':
        limits = study.stability_limits(study.gyro_at(settings), step_s)
    with ProgressBar(console, 'values') as progress:
        task = progress.add_task(name, total=len(settings.values) + len(settings.curve_values))
        cells = study.study_table(settings, lambda: progress.advance(task))
        curve = study.study_curve(settings, lambda: progress.advance(task)) or cells
    report.show(settings, cells, console)
    if limits:
        report.show_limits(settings, limits, console)
    return curve, cells, limits
