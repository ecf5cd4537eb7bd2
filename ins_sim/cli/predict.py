"""Verb predict: predict drift and position error by linear theory."""

from . import arguments

HELP = 'predict drift and position error from gyro channel delays'
DESCRIPTION = ('Predict the mean drift and the position error that delays of the gyro channels '
               'cause, by linear theory and without a simulation.')


def add_arguments(parser):
    """Add the arguments of the verb to its parser."""
    arguments.add_settings(parser)


def run(chosen):
    """Predict and show; return the exit code."""
    from rich.table import Table
    from ins_sim.core.prediction.predict import predict
    from ins_sim.io.motion import read_motion
    from ins_sim.report import coverage, summary, table, titles
    from ins_sim.report.console import PlainConsole
    settings = arguments.read_settings(chosen)
    prediction = predict(settings, read_motion(settings.motion_generator), collect=None)
    key = summary.study_key(settings)
    drift, place = summary.PUBLISHED_DRIFT.get(key), summary.PUBLISHED_POSITION.get(key)
    shown = Table(title=titles.title(settings))
    for head in ('figure', 'unit', 'predicted', 'paper / re-derived'):
        shown.add_column(head, justify='left' if head in ('figure', 'unit') else 'right')
    for axis, name in enumerate(('east', 'north', 'up')):
        shown.add_row(f'mean drift {name}', 'deg/h',
                      table.number_text(prediction.drift[axis] * summary.DEG_PER_HOUR),
                      table.number_text(drift and drift[axis]))
    for axis, name in ((1, 'N'), (0, 'E')):
        shown.add_row(f'max |d{name}|', 'm', table.number_text(prediction.largest[axis]),
                      table.number_text(place and place[1 - axis]))
    console = PlainConsole()
    console.print(shown)
    for line in coverage.coverage_lines(settings, prediction):
        console.print(line)
    table.show_resonances(prediction.resonances, console)
    return 0
