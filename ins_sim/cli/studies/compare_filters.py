"""Verb compare-filters: all filters over the same flights and seeds, on all cores."""

from dataclasses import asdict
import json

from ins_sim.settings.aided_navigator import FILTERS
from .. import arguments
from . import shared_work

HELP = 'all filters of the aided navigator over the same flights'
DESCRIPTION = ('Fly the filters of the aided navigator over the same flights and seeds, on all '
               'cores or a cluster, and show tables and figures of their errors and of their '
               'consistency.')
SHIPPED = ('route_flight', 'grade_mid')
MARK = 'comparison.json'


def add_arguments(parser):
    """Add the arguments of the verb to its parser."""
    arguments.add_settings(parser, ' and '.join(SHIPPED))
    parser.add_argument('--runs', type=int, default=24, metavar='N', help='flights, each with '
                        'seeds of its own (default: %(default)s)')
    parser.add_argument('--filters', nargs='+', choices=FILTERS, default=None, metavar='NAME',
                        help=f'of {", ".join(FILTERS)} (default: all)')
    parser.add_argument('--cycles', nargs='+', type=int, default=None, metavar='N',
                        help='cycles of a fix: the first for all filters, the others for eskf as '
                        'well (default: window.cycles)')
    shared_work.add_arguments(parser)
    arguments.add_output(parser, 'ins_sim_filters', 'folder of report, figures and numbers')
    arguments.add_force(parser, 'what is in DIR')


def run(chosen):
    """Fly, show and save; return the exit code."""
    from ins_sim.core.motion.factory import make_motion
    from ins_sim.core.motion.motion import check_length
    from ins_sim.jobs.fingerprint import array_digest, fingerprint
    from ins_sim.own_folders import whole_folder
    from ins_sim.report.charts.png import save_chart
    from ins_sim.report.console import PlainConsole
    from ins_sim.report.page.html import write_page
    from ins_sim.report.studies import filter_charts, filters
    from ins_sim.studies.filters import FilterStudy, flights_of, run_settings
    settings = arguments.read_aided_settings(chosen, SHIPPED)
    if chosen.runs < 1 or chosen.jobs < 0:
        raise ValueError(f'--runs is {chosen.runs} and --jobs {chosen.jobs}; expected 1 or more '
                         'runs, and 0 (every core) or more jobs')
    cases = _cases(chosen, settings.velocity_meter.window.cycles)
    # Checked here, so that a flight that is refused is reported once and not by every worker.
    generator = run_settings(settings, 0).simulation.motion_generator
    check_length(generator, make_motion(generator.motion, generator.datum, generator.earth))
    console = PlainConsole()
    title = (f'{generator.motion.kind}, {generator.duration_s:g} s, {chosen.runs} flights: '
             + ', '.join(chosen.params_file or SHIPPED))
    nodes = {**vars(settings.simulation), **vars(settings)}
    del nodes['simulation']
    identity = fingerprint(nodes, study='compare-filters', flights=chosen.runs,
                           cases=[f'{c.filter}, N {c.cycles}' for c in cases])
    with whole_folder(chosen.output, chosen.force, MARK) as folder:
        arrays = {}
        with shared_work.computed(FilterStudy(settings, cases), range(chosen.runs), chosen,
                                  identity, console, 'flights') as found:
            flights = []
            for k, one in found:
                flights.append(flights_of(one))
                arrays.update({f'{k}_{name}': array for name, array in one.items()})
            digest = array_digest(arrays)
            flown = [list(f) for f in zip(*flights)]
            rows = [filters.filter_row(case, f) for case, f in zip(cases, flown)]
            page = filter_charts.page_of(title, settings, rows, flown, digest)
            for chart in page.charts:
                save_chart(folder, chart)
            write_page(folder, page)
            (folder / MARK).write_text(json.dumps([asdict(r) for r in rows], indent=1) + '\n',
                                       encoding='utf-8')
    filters.show_filter_study(title, rows, console)
    console.print(page.answer)
    console.print(f'SHA-256 of the flights: {digest}')
    console.print(f'report: {chosen.output}/report.html')
    return 0


def _cases(chosen, cycles):
    from ins_sim.studies.filters import FilterCase
    windows = chosen.cycles or [cycles]
    filters = list(dict.fromkeys(chosen.filters or FILTERS))
    for n in windows:
        if not 1 <= n <= 100000:
            raise ValueError(f'--cycles is {n}; expected 1 to 100000')
    # All filters use the first window; the others are for the eskf alone.
    cases = [FilterCase(name, windows[0]) for name in filters]
    return cases + [FilterCase('eskf', n) for n in windows[1:] if 'eskf' in filters]
