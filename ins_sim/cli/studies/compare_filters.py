"""Verb compare-filters: all filters over the same flights and seeds, on all cores."""

from dataclasses import asdict
import json

from ins_sim.settings.aided_navigator import FILTERS
from .. import arguments

HELP = 'all filters of the aided navigator over the same flights'
DESCRIPTION = ('Fly the filters of the aided navigator over the same flights and seeds, on all '
               'cores, and show table and figure.')
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
    parser.add_argument('--jobs', type=int, default=0, metavar='N', help='processes (default: '
                        'as many as cores)')
    arguments.add_output(parser, 'ins_sim_filters', 'folder of figure and numbers')
    arguments.add_force(parser, 'what is in DIR')


def run(chosen):
    """Fly, show and save; return the exit code."""
    from ins_sim.core.motion.factory import make_motion
    from ins_sim.core.motion.motion import check_length
    from ins_sim.own_folders import whole_folder
    from ins_sim.report.studies import filters as report
    from ins_sim.report.console import PlainConsole
    from ins_sim.studies.filters import fly_filters, run_settings
    from ..workers import run_all
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
    with whole_folder(chosen.output, chosen.force, MARK) as folder:
        flights = run_all([(fly_filters, settings, cases, k) for k in range(chosen.runs)],
                          chosen.jobs, console, 'flights')
        flown = list(zip(*flights))
        rows = [report.filter_row(case, list(f)) for case, f in zip(cases, flown)]
        report.save_figure(folder / 'comparison.png', title, cases, flown)
        (folder / MARK).write_text(json.dumps([asdict(r) for r in rows], indent=1) + '\n',
                                   encoding='utf-8')
    report.show_filter_study(title, rows, console)
    console.print(f'figure: {chosen.output}/comparison.png')
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
