"""Verb delay-study: repeat the study of gyro channel delays of Bogdanov and Fomichev 2018."""

import json

from .. import arguments

HELP = 'repeat the published study of gyro channel delays'
DESCRIPTION = ('Simulate the motions of Bogdanov and Fomichev (2018) with delayed gyro channels, '
               'and compare the errors with the published ones: position errors of motion 2, '
               'tuned and detuned, and of three flights; maps of the drift over the rates of '
               'motion 2 and over the direction of rocking; the contribution of each channel.')


def add_arguments(parser):
    """Add the arguments of the verb to its parser."""
    parser.add_argument('--params-file', action='append', default=[], metavar='FILE',
                        help='parameter file of one figure, or the name of a shipped one; may be '
                        'repeated (default: the nine shipped ones named delay_study_*)')
    parser.add_argument('--recording', action='append', default=[], metavar='FILE',
                        help='recorded flight, a CSV file or a bag, as a figure; may be repeated. '
                        'Without --params-file only these figures are made')
    parser.add_argument('-p', '--param', action='append', default=[], metavar='NAME:=VALUE',
                        help='value of a parameter, for every figure')
    parser.add_argument('--jobs', type=int, default=0, metavar='N', help='number of processes '
                        '(default: one for each core)')
    arguments.add_output(parser, 'ins_sim_delay_study', 'folder of figures and numbers')
    arguments.add_force(parser, 'what is in DIR')


def run(chosen):
    """Simulate, print and save; return the exit code."""
    from ins_sim.own_folders.own_folder import whole_folder
    from ins_sim.report.console import PlainConsole
    from ins_sim.report.studies.delay_folder import MARK, write_study
    from ins_sim.report.studies.delays import show_study
    from ins_sim.studies.delays.study import distinct_runs, fly_task, gather
    from ..workers import run_all
    figures, console = _figures(chosen), PlainConsole()
    with whole_folder(chosen.output, chosen.force, MARK) as folder:
        results = gather(figures, run_all([(fly_task, task) for task in distinct_runs(figures)],
                                          chosen.jobs, console, 'runs'))
        tables = write_study(folder, results)
    show_study(results, tables, console)
    console.print(f'report: {chosen.output}/report.html')
    return 0


def _figures(chosen):
    """Return the DelayFigures of the command line."""
    from ins_sim import parameter_files, resources
    from ins_sim.io.motion import read_motion
    from ins_sim.studies.delays.figure import (make_figures, RECORDED, recorded_name,
                                               RECORDING_PATH, SHIPPED)
    paths = arguments.parameter_paths(chosen, () if chosen.recording else SHIPPED)
    sources = [(path.stem, path, chosen.param) for path in paths]
    sources += [(recorded_name(name), resources.config(RECORDED),
                 [*chosen.param, f'{RECORDING_PATH}:={json.dumps(name)}'])
                for name in chosen.recording]
    return make_figures(sources, parameter_files.read_nodes, read_motion)
