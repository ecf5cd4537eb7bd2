"""Verb budget: contribution of each error source to the navigation error."""

from .. import arguments

HELP = 'error budget of a strapdown: contribution of each error source'
DESCRIPTION = ('Propagate each error of the instruments and of the initial state along the motion '
               'by linear covariance, without a simulation: how much each source contributes, how '
               'the error changes with each parameter, and what must improve to meet a '
               'requirement.')


def add_arguments(parser):
    """Add the arguments of the verb to its parser."""
    arguments.add_settings(parser)
    parser.add_argument('--require', action='append', default=[], metavar='TEXT',
                        help="requirement, such as 'horizontal rms 1852 m at 3600 s': the budget "
                        'then says what must improve to meet it; may be repeated')
    beside = parser.add_mutually_exclusive_group()
    beside.add_argument('--runs', type=int, default=0, metavar='N', help='simulate N runs and '
                        'compare them with the budget (default: none)')
    beside.add_argument('--beside', metavar='STUDY', help='compare the budget with a study of '
                        'monte-carlo in the folder STUDY, with the same settings')
    arguments.add_output(parser, 'ins_sim_budget', 'folder of figures, tables and report.html')
    arguments.add_force(parser, 'the budget in DIR')


def run(chosen):
    """Propagate, print and save; return the exit code."""
    from ins_sim.core.prediction.budget.linear_budget import error_budget
    from ins_sim.core.prediction.budget.propagation import navigation_span_s
    from ins_sim.io.motion import read_motion
    from ins_sim.own_folders.own_folder import check_free, whole_folder
    from ins_sim.report.console import PlainConsole
    from ins_sim.report.studies import budget as report
    from ins_sim.report.studies.budget_beside import read_study
    from ins_sim.studies.budget.beside import compared as compared_with, fly_beside
    from ins_sim.studies.budget.requirement import answer, parse_requirement, times_of
    check_free(chosen.output, chosen.force, report.MARK)
    wanted = [parse_requirement(text) for text in chosen.require]
    settings = arguments.read_settings(chosen)
    motion = read_motion(settings.motion_generator)
    linear = error_budget(settings, motion, times_of(wanted, navigation_span_s(settings)))
    answers = [answer(linear, requirement) for requirement in wanted]
    beside = None
    if chosen.beside is not None:
        beside = read_study(chosen.beside, settings)
    elif chosen.runs:
        beside = fly_beside(settings, motion, linear, chosen.runs)
    compared, console = compared_with(linear, beside) if beside else [], PlainConsole()
    with whole_folder(chosen.output, chosen.force, report.MARK) as folder:
        report.write_budget(folder, settings, linear, answers, compared, beside)
    report.show_budget(settings, linear, answers, compared, beside, console)
    console.print(f'report: {chosen.output}/report.html')
    return 0
