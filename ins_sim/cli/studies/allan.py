"""Verb allan: Allan deviation of both triads, from a run, a bag or simulated noise."""

import json
from pathlib import Path

from .. import arguments

HELP = 'Allan deviation of a record or of simulated noise'
DESCRIPTION = ('Show Allan deviations and the noise coefficients fitted to them: of a run of '
               '"simulate", of the Imu messages of a bag, or, without SOURCE, of the instrument '
               'of the parameters simulated at rest.')
MARK = 'allan.json'
DURATION_S = 10800.0
EXPECTED = 'expected noise, such as that of "--params-file imu_tactical_fog"'


def add_arguments(parser):
    """Add the arguments of the verb to its parser."""
    parser.add_argument('source', nargs='?', default=None, metavar='SOURCE',
                        help='folder of a run or of a rosbag2 bag')
    arguments.add_settings(parser)
    parser.add_argument('--topic', default=None, metavar='NAME',
                        help='topic of the bag, if it has more than one of sensor_msgs/msg/Imu')
    parser.add_argument('--duration', type=float, default=None, metavar='S',
                        help=f'length of the simulated record, s (default: {DURATION_S:.0f})')
    arguments.add_output(parser, 'ins_sim_allan', 'folder of the two figures and the report')
    arguments.add_force(parser, 'the figures in DIR')


def run(chosen):
    """Read or simulate, show and save; return the exit code."""
    from ins_sim.own_folders.own_folder import whole_folder
    with whole_folder(chosen.output, chosen.force, MARK) as work:
        return _analyse(chosen, work)


def _analyse(chosen, work):
    from ins_sim.core.sensors.tuned_gyro.pair import COVARIANCE_FACTORS
    from ins_sim.report import allan_record, noise_terms
    from ins_sim.report.charts.png import save_chart
    from ins_sim.report.console import PlainConsole
    from ins_sim.report.page.html import REPORT, write_page
    from ins_sim.report.studies import allan as report
    from ins_sim.report.titles import instrument_words
    console, notes = PlainConsole(), []

    def note(sentence):
        notes.append(sentence)
        console.print(sentence)

    imu, settings, name = _record(chosen, console, note)
    try:
        record = allan_record.regular_record(imu, _given_rate(chosen, settings))
    except ValueError as error:
        raise ValueError(f'{name}: {error}') from None
    imu, rate_hz = record.imu, record.rate_hz
    for sentence in record.notes:
        note(f'{name}: {sentence}')
    found = []
    for triad, samples in (('gyro', imu.omega), ('accelerometer', imu.f)):
        sensor = settings and getattr(settings.imu_sensor, triad)
        tuned = settings and triad == 'gyro' and sensor.model == 'dtg'
        # An axis of a pair of tuned gyros combines the readings of one channel or two.
        factors = COVARIANCE_FACTORS if tuned else (1.0, 1.0, 1.0)
        noise = noise_terms.analyse_noise(triad, samples, rate_hz, sensor and sensor.errors,
                                          factors)
        if noise is None:
            note(f'{triad}: constant throughout, no noise to show')
        else:
            found.append(noise)
    if not found:
        raise ValueError(f'{name}: both triads are constant throughout; {EXPECTED}')
    words = name if settings is None else f'{instrument_words(settings.imu_sensor)} ({name})'
    charts = [report.allan_chart(words, noise) for noise in found]
    for chart in charts:
        save_chart(work, chart)
    write_page(work, report.allan_page(words, found, notes, settings, charts))
    rows = [row for noise in found for row in noise.rows()]
    (work / MARK).write_text(json.dumps(rows, indent=1) + '\n', encoding='utf-8')
    title = f'{name}, {rate_hz:.6g} Hz, {found[0].allan.length_s:.6g} s'
    for noise in found:
        noise_terms.show_noise(noise, title, console)
        console.print(f'figure: {Path(chosen.output) / noise.triad}.png')
    console.print(f'report: {Path(chosen.output) / REPORT}')
    return 0


def _given_rate(chosen, settings):
    """Return the rate, Hz, that -p gives for SOURCE, or None."""
    given = chosen.source is not None and any(
        text.partition(':=')[0] in ('rate_hz', 'imu_sensor:rate_hz') for text in chosen.param)
    return settings.imu_sensor.rate_hz if given else None


def _record(chosen, console, note):
    """
    Return the ImuSamples, their SimulationSettings or None, and a name.

    note is a function that reports a sentence about the record.
    """
    from ins_sim import parameter_files
    from ins_sim.bags.storages import is_bag
    from ins_sim.core.sensors.imu.with_errors import with_errors
    from ins_sim.io.published import read_imu
    from ins_sim.report import storage
    given = arguments.parameter_paths(chosen)
    if chosen.source is None:
        if chosen.topic is not None:
            raise ValueError(f'--topic is {chosen.topic}, but there is no SOURCE; expected a bag')
        settings = parameter_files.read(given, chosen.param)
        sensor = settings.imu_sensor
        if sensor.gyro.model == 'ideal' and with_errors(sensor) is None:
            raise ValueError(f'the instrument of the parameters has no errors; {EXPECTED}')
        length_s = DURATION_S if chosen.duration is None else chosen.duration
        names = [path.stem for path in given] or ['the default parameters']
        return _simulated(settings, length_s, console), settings, ', '.join(names)
    source = Path(chosen.source)
    if chosen.duration is not None:
        raise ValueError(f'--duration is {chosen.duration:g}, but a SOURCE is given; expected '
                         'only one of them')
    if (source / storage.ARRAYS).is_file():
        if chosen.topic is not None:
            raise ValueError(f'--topic is {chosen.topic}, but {source} is a run; expected a bag')
        settings = parameter_files.read([source / storage.PARAMETERS, *given], chosen.param)
        kind = settings.motion_generator.motion.kind
        if kind != 'static':
            note(f'{source}: the motion is {kind}, not static; the Allan deviation contains the '
                 'motion as well')
        return storage.read_imu(source), settings, source.name
    if not source.exists() or not is_bag(source):
        raise ValueError(f'{source} is neither a run of "ins_sim simulate" ({storage.ARRAYS}) nor '
                         'a rosbag2 bag')
    known = given or chosen.param
    settings = parameter_files.read(given, chosen.param) if known else None
    return read_imu(source, chosen.topic), settings, source.name


def _simulated(settings, length_s, console):
    """Return the ImuSamples of the instrument at rest."""
    from ins_sim.core.numerics.instants import period_ns
    from ins_sim.core.timeseries.histories import ImuSamples
    from ins_sim.report import allan
    from ins_sim.studies.at_rest import resting_record
    from ..progress import progress_bars
    dt_s = period_ns(settings.imu_sensor.rate_hz) * 1e-9
    if not allan.LEAST * dt_s <= length_s <= 1e7:
        raise ValueError(f'--duration is {length_s:g} s; expected {allan.LEAST * dt_s:g} to 1e+07 '
                         's')
    blocks, count = [], 0
    with progress_bars(console) as add_bar:
        show = add_bar('simulating', length_s)
        for block in resting_record(settings, length_s):
            blocks.append(block)
            count += len(block.t_ns)
            show(count * dt_s)
    return ImuSamples.concatenate(blocks)
