"""Verb demo: run the three nodes over DDS, on motion 2 and on a flight, and show the result."""

from dataclasses import replace
import os
from pathlib import Path
import sys

from . import arguments
from ins_sim.entry import FAILED

HELP = 'run the three nodes over DDS and show the result'
DESCRIPTION = ('Start motion_generator, imu_sensor and strapdown, run them in lock-step, record '
               'their topics into a bag and compare the errors with the prediction.')
EVERY = 10
# Shipped parameter files of the parts.
MOTION_2 = ('motion_2', 'delay_y_1us')
CRUISE, RECORDED = ('cruise', 'delays_2_1_3us'), ('recorded_flight', 'delays_2_1_3us')


def add_arguments(parser):
    """Add the arguments of the verb to its parser."""
    arguments.add_output(parser, 'ins_sim_demo', 'folder of bags and figures; an existing one is '
                         'replaced')
    parser.add_argument('--recording', metavar='CSV', default=None, help='recorded flight for '
                        'the second part (default: the closed-form cruise)')
    parser.add_argument('--start', type=float, default=1000.0, metavar='S', help='start in the '
                        'recording, s after its first row (default: %(default)s)')
    parser.add_argument('--duration', type=float, default=3600.0, metavar='S',
                        help='simulated length of each part, s (default: %(default)s)')


def run(chosen):
    """Run both parts and show them; return the exit code."""
    try:
        import rclpy  # noqa: F401
    except ImportError as error:
        raise ValueError(f'rclpy cannot be imported ({error}); source ROS 2 Jazzy or install '
                         'ins_sim[ros]; "ins_sim simulate" works without ROS') from None
    from ins_sim.report.console import PlainConsole
    console = PlainConsole()
    folder = Path(chosen.output)
    parts = [('motion_2', _settings(MOTION_2, chosen.duration))]
    if chosen.recording is None:
        parts.append(('cruise', _settings(CRUISE, chosen.duration)))
        console.print('no recorded flight given (--recording CSV): the second part is the '
                      'closed-form cruise')
    else:
        parts.append(('recorded_flight', _settings(
            RECORDED, chosen.duration,
            [f'motion_generator:motion.recording.path:="{Path(chosen.recording).resolve()}"',
             f'motion_generator:motion.recording.start_s:={chosen.start}'])))
    for name, settings in parts:
        try:
            _part(name, settings, folder / name, console)
        except RuntimeError as error:
            print(f'ins_sim demo: {name}: {error}', file=sys.stderr)
            return FAILED
    return 0


def _settings(names, duration_s, assignments=()):
    """Return the settings of shipped files, changed to lock-step with a recorder."""
    from ins_sim import parameter_files, resources
    from ins_sim.io.motion import read_motion
    from ins_sim.settings.node import Pacing
    settings = parameter_files.read(
        [resources.config(name) for name in names],
        [*assignments, f'strapdown:output_every:={EVERY}',
         f'motion_generator:duration_s:={duration_s}'])
    generator = settings.motion_generator
    if generator.motion.kind == 'recording':
        motion = read_motion(generator)
        generator = replace(generator, duration_s=float(int(min(duration_s, motion.end_s))))
    pacing = Pacing(real_time_factor=0.0, lock_step=True, required=('strapdown', 'recorder'))
    return replace(settings, motion_generator=replace(generator, pacing=pacing))


def _part(name, settings, folder, console):
    from ins_sim.own_folders.own_folder import whole_folder
    # The old folder stays until the new part is complete.
    with whole_folder(folder, replace=True, mark='parameters.yaml') as work:
        _run(name, settings, work, folder, console)


def _run(name, settings, work, folder, console):
    from ins_sim.core.prediction.predict import predict
    from ins_sim.io.motion import read_motion
    from ins_sim.io.published import read_errors
    from ins_sim.report import coverage, summary, table, titles
    from ins_sim.report.runs.page import write_error_report
    from ins_sim.ros.session import Session
    from .progress import progress_bars
    title = titles.title(settings)
    namespace = f'ins_sim_demo_{os.getpid()}'
    length_s = settings.motion_generator.duration_s
    with progress_bars(console, 's') as add_bar:
        show = add_bar(f'{name}: three nodes in lock-step', length_s)
        with Session(settings, work, work / 'bag', namespace) as session:
            counts = session.run(show)
    errors = read_errors(work / 'bag', namespace)
    prediction = predict(settings, read_motion(settings.motion_generator))
    rows = summary.summary_rows(settings, errors, None, prediction)
    write_error_report(work, settings, errors, rows, prediction, title)
    table.show_table(title, rows, console)
    for line in coverage.coverage_lines(settings, prediction):
        console.print(line)
    console.print(f'{sum(counts.values())} messages recorded: {folder / "bag"}\n'
                  f'report: {folder / "report.html"}')
