"""Verb monte-carlo: statistics of the errors of many runs of a simulation."""

from .. import arguments

HELP = 'statistics of the errors of many runs of a simulation'
DESCRIPTION = ('Simulate many runs, which differ in their random numbers, on all cores or on a '
               'Dask cluster. Writes statistics of their errors over time, the errors of every '
               'run at its end, figures and a report. After an interruption the same command '
               'resumes the study.')


def add_arguments(parser):
    """Add the arguments of the verb to its parser."""
    arguments.add_settings(parser)
    parser.add_argument('--runs', type=int, default=1000, metavar='N', help='number of '
                        'runs; the first one has the number of the parameter run (default: '
                        '%(default)s)')
    parser.add_argument('--aided', action='store_true', help='simulate the aided navigator with '
                        'its instruments; adds NEES and NIS of the filter')
    parser.add_argument('--instants', type=int, default=61, metavar='N', help='number of instants '
                        'of the statistics, evenly over the run (default: %(default)s)')
    arguments.add_jobs(parser)
    arguments.add_output(parser, 'ins_sim_ensemble', 'folder of the study')
    arguments.add_force(parser, 'the study in DIR, and kept blocks of another study')


def run(chosen):
    """Simulate, print and write; return the exit code."""
    from ins_sim.core.ensemble.many_runs import check_runs
    from ins_sim.io.motion import read_motion
    from ins_sim.jobs.executors import check_jobs, open_executor
    from ins_sim.jobs.store import BlockStore
    from ins_sim.own_folders.own_folder import whole_folder
    from ins_sim.report.console import PlainConsole
    from ins_sim.report.studies import ensemble as report
    from ins_sim.studies.aided_ensembles import (AidedPlan, check_aided_flight,
                                                 fly_aided_ensemble)
    from ins_sim.studies.ensembles import EnsemblePlan, fly_ensemble
    from ..progress import progress_bars
    check_jobs(chosen.jobs, chosen.scheduler)
    if chosen.aided:
        plan = AidedPlan(arguments.read_aided_settings(chosen), chosen.runs, chosen.instants)
        check_aided_flight(plan, read_motion(plan.settings.simulation.motion_generator))
        fly = fly_aided_ensemble
    else:
        plan = EnsemblePlan(arguments.read_settings(chosen), chosen.runs, chosen.instants)
        check_runs(plan.settings, read_motion(plan.settings.motion_generator))
        fly = fly_ensemble
    console = PlainConsole()
    with whole_folder(chosen.output, chosen.force, report.ARRAYS) as folder:
        store = BlockStore(f'{chosen.output}.blocks', plan.identity(), chosen.force)
        if store.found:
            console.print(f'{store.found} of {len(plan.blocks())} blocks found in {store.folder}: '
                          'resuming the study')
        try:
            with progress_bars(console) as add_bar, open_executor(
                    chosen.jobs, chosen.scheduler) as executor:
                show = add_bar('flying', max(1, len(plan.blocks()) - store.found))
                result = fly(plan, read_motion, executor, store, show)
        except BaseException:
            if len(store):
                console.print(f'{len(store)} of {len(plan.blocks())} blocks are kept in '
                              f'{store.folder}: the same command resumes from there')
            raise
        found = report.ensemble_report(report.ensemble_title(plan.settings, plan.runs),
                                       plan.settings, result)
        report.write_ensemble(folder, found)
    store.remove()
    report.show(found, console)
    if found.worst is not None:
        console.print(report.flight_command(found, f'{chosen.output}/{report.PARAMETERS}'))
    console.print(f'SHA-256 of the result: {found.digest}')
    console.print(f'written: {chosen.output}')
    return 0
