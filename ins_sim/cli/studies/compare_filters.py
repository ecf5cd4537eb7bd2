"""Verb compare-filters: compare the aiding filters on the same flights."""

from ins_sim.settings.aided_navigator import FILTERS
from .. import arguments

HELP = 'compare the filters of the aided navigator on the same flights'
DESCRIPTION = ('Simulate the same flights with each filter of the aided navigator, on all cores '
               'or a cluster, and show tables and figures of their errors and their consistency.')
SHIPPED = ('route_flight', 'grade_mid')


def add_arguments(parser):
    """Add the arguments of the verb to its parser."""
    arguments.add_settings(parser, ' and '.join(SHIPPED))
    parser.add_argument('--runs', type=int, default=24, metavar='N', help='number of '
                        'flights, each with other seeds (default: %(default)s)')
    parser.add_argument('--filters', nargs='+', choices=FILTERS, default=None, metavar='NAME',
                        help=f'one or more of {", ".join(FILTERS)} (default: all)')
    parser.add_argument('--cycles', nargs='+', type=int, default=None, metavar='N',
                        help='number of navigation cycles in a fix of the velocity meter; the '
                        'first is used for all filters, the others in addition for eskf '
                        '(default: window.cycles)')
    arguments.add_jobs(parser)
    arguments.add_output(parser, 'ins_sim_filters', 'folder of report, figures and numbers')
    arguments.add_force(parser, 'the comparison in DIR, and kept flights of another one')


def run(chosen):
    """Simulate, print and save; return the exit code."""
    from ins_sim.core.motion.factory import make_motion
    from ins_sim.core.motion.motion import check_length
    from ins_sim.jobs.executors import check_jobs, open_executor
    from ins_sim.jobs.store import BlockStore
    from ins_sim.own_folders.own_folder import whole_folder
    from ins_sim.report.console import PlainConsole
    from ins_sim.report.studies import filter_charts, filters
    from ins_sim.studies.filters import cases_of, compare, FilterPlan, run_settings
    from ..progress import progress_bars
    settings = arguments.read_aided_settings(chosen, SHIPPED)
    check_jobs(chosen.jobs, chosen.scheduler)
    plan = FilterPlan(settings, chosen.runs, cases_of(
        chosen.filters, chosen.cycles or [settings.velocity_meter.window.cycles]))
    # Checked here, so that an invalid flight is reported once and not by every worker.
    generator = run_settings(settings, 0).simulation.motion_generator
    check_length(generator, make_motion(generator.motion, generator.datum, generator.earth))
    console = PlainConsole()
    title = f'{filter_charts.comparison_title(settings, plan.flights)}: ' + ', '.join(
        chosen.params_file or SHIPPED)
    with whole_folder(chosen.output, chosen.force, filter_charts.MARK) as folder:
        store = BlockStore(f'{chosen.output}.blocks', plan.identity(), chosen.force)
        if store.found:
            console.print(f'{store.found} of {plan.flights} flights found in {store.folder}')
        try:
            with progress_bars(console, 'flights') as add_bar, open_executor(
                    chosen.jobs, chosen.scheduler) as executor:
                show = add_bar('flying', max(1, plan.flights - store.found))
                found = compare(plan, executor, store, show)
        except BaseException:
            if len(store):
                console.print(f'{len(store)} of {plan.flights} flights are kept in '
                              f'{store.folder}: the same command resumes from there')
            raise
        rows = [filters.filter_row(case, list(f)) for case, f in zip(plan.cases, found.flown)]
        page = filter_charts.page_of(title, settings, rows, found.flown, found.digest)
        filter_charts.write_comparison(folder, page, rows)
    store.remove()
    filters.show_filter_study(title, rows, console)
    console.print(page.answer)
    console.print(f'SHA-256 of the flights: {found.digest}')
    console.print(f'report: {chosen.output}/report.html')
    return 0
