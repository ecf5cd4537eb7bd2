"""Verb estimate-delays: gyro channel delays from a bench test, or a comparison of motions."""

import json
from pathlib import Path

from .. import arguments

HELP = 'estimate delays of gyro channels from readings under a known motion'
DESCRIPTION = ('Estimate delays, biases, scale factors and misalignments of the gyro channels '
               'from readings under a known motion: folders of "simulate", bags with Imu '
               'messages and the truth, or CSV files of an IMU with the motion in motion.*. '
               'Several SOURCEs are records of one instrument. Without SOURCE: compare bench '
               'motions by the standard deviation of the delays that they would give.')
DURATION_S = 600.0
INSTRUMENT = 'imu_tactical_fog'


def add_arguments(parser):
    """Add the arguments of the verb to its parser."""
    parser.add_argument('sources', nargs='*', default=[], metavar='SOURCE',
                        help='folder of a run or of a rosbag2 bag, or CSV file of an IMU')
    arguments.add_settings(parser, f'without SOURCE {INSTRUMENT}')
    parser.add_argument('--topic', default=None, metavar='NAME',
                        help='topic in a bag, if it has more than one of sensor_msgs/msg/Imu')
    parser.add_argument('--duration', type=float, default=None, metavar='S',
                        help=f'without SOURCE: length of a motion, s (default: {DURATION_S:g})')
    arguments.add_output(parser, 'ins_sim_delays', 'folder of figures, numbers and report')
    arguments.add_force(parser, 'what is in DIR')


def run(chosen):
    """Estimate or compare, print and save; return the exit code."""
    from ins_sim.report.console import PlainConsole
    console = PlainConsole()
    if chosen.sources:
        return _estimate(chosen, console)
    if chosen.topic is not None:
        raise ValueError(f'--topic is {chosen.topic}, but there is no SOURCE; expected a bag')
    return _compare(chosen, console)


def _estimate(chosen, console):
    from ins_sim.core.calibration.model_lag import estimate_with_lag
    from ins_sim.own_folders.own_folder import whole_folder
    from ins_sim.report.charts.png import save_chart
    from ins_sim.report.page.html import write_page
    from ins_sim.report.studies import delay_estimate as report, delay_estimate_charts
    if chosen.duration is not None:
        raise ValueError(f'--duration is {chosen.duration:g}, but a SOURCE is given; expected '
                         'only one of them, as --duration is for comparing motions')
    with whole_folder(chosen.output, chosen.force, report.MARK) as work:
        records, notes, settings, is_run = [], [], [], []
        for source in chosen.sources:
            record, said, of_record, simulated = _read(Path(source), chosen)
            records.append(record)
            notes += said
            settings.append(of_record)
            is_run.append(simulated)
        gyro = settings[0].imu_sensor.gyro
        triad = estimate_with_lag(records, gyro.errors)
        delays = gyro.delay_us
        one = all(s.imu_sensor.gyro.delay_us == delays for s in settings)
        known = (delays.x, delays.y, delays.z) if all(is_run) and one else None
        title = ', '.join(triad.records)
        charts = delay_estimate_charts.estimate_charts(title, triad)
        page = delay_estimate_charts.estimate_page(title, triad, known, charts, settings[0],
                                                   tuple(dict.fromkeys(notes)))
        for chart in charts:
            save_chart(work, chart)
        (work / report.MARK).write_text(json.dumps(report.as_json(triad, known), indent=1) + '\n',
                                        encoding='utf-8')
        write_page(work, page)
    for note in dict.fromkeys(notes):
        console.print(note)
    report.show_estimate(f'delays of gyro channels: {title}', triad, known, console)
    console.print(report.answer(triad, known))
    _tell_files(chosen.output, charts, console)
    return 0


def _read(source, chosen):
    """Return BenchRecord, notes, SimulationSettings, and whether it is a run of simulate."""
    from ins_sim import parameter_files
    from ins_sim.io import bench
    from ins_sim.report import storage
    from ins_sim.report.studies.delay_estimate import read_bench_run
    from ins_sim.settings.by_node import ALL_NODES, NODES
    from ins_sim.settings.recorded_imu import CONVERT
    from ins_sim.settings.simulation import SimulationSettings
    given = arguments.parameter_paths(chosen)
    if (source / storage.ARRAYS).is_file():
        if chosen.topic is not None:
            raise ValueError(f'--topic is {chosen.topic}, but {source} is a run; expected a bag')
        settings = parameter_files.read([source / storage.PARAMETERS, *given], chosen.param)
        record, notes = bench.record_of_run(source.name, settings, read_bench_run(source))
        return record, notes, settings, True
    built = parameter_files.read_nodes(given, chosen.param, {**NODES, **CONVERT},
                                       {**ALL_NODES, **CONVERT})
    settings = SimulationSettings(**{node: built[node] for node in NODES})
    names = [text.partition(':=')[0] for text in chosen.param]
    record, notes = bench.read_record(source, settings, built['convert'], names, chosen.topic)
    return record, notes, settings, False


def _compare(chosen, console):
    import numpy as np
    from ins_sim.core.numerics.instants import period_ns
    from ins_sim.core.sensors.imu.triad_model import triad_model
    from ins_sim.io.bench import is_named
    from ins_sim.own_folders.own_folder import whole_folder
    from ins_sim.report.charts.png import save_chart
    from ins_sim.report.page.html import write_page
    from ins_sim.report.studies import bench_motions as report
    from ins_sim.settings.motion import MotionSettings
    from ins_sim.studies import bench_motions as study
    from ins_sim import parameter_files
    settings = parameter_files.read(arguments.parameter_paths(chosen, [INSTRUMENT]), chosen.param)
    sensor, duration_s = settings.imu_sensor, chosen.duration
    if duration_s is None:
        duration_s = DURATION_S
    dt_s = period_ns(sensor.rate_hz) * 1e-9
    white = triad_model(sensor.gyro.errors, dt_s, 'gyro.errors').white
    if sensor.gyro.model != 'ideal' or not all(white):
        raise ValueError('the gyros have no white noise on at least one axis; expected '
                         'gyro.errors.angle_random_walk_deg_sqrt_h above 0 on all axes, as in '
                         f'"--params-file {INSTRUMENT}"')
    if not 0.0 < duration_s <= 1e6:
        raise ValueError(f'--duration is {duration_s:g} s; expected more than 0 and at most 1e+06')
    cases, motion = study.bench_cases(), settings.motion_generator.motion
    names = [text.partition(':=')[0] for text in chosen.param]
    if is_named('motion.', names, motion, MotionSettings()):
        cases.append(study.BenchCase(f'{motion.kind} of the parameters', (motion,)))
    with whole_folder(chosen.output, chosen.force, report.MARK) as work:
        rows = [report.foreseen_row(case, study.foresee_case(case, settings, white, duration_s))
                for case in cases]
        sweep = study.sweep_rocking(settings, white, duration_s,
                                    np.geomspace(0.1, 0.2 * sensor.rate_hz, 24))
        single = study.BenchCase('one axis', (study.single_rocking(),))
        single_sigma = study.foresee_case(single, settings, white, duration_s).sigmas[0]
        title = f'{duration_s:g} s at {sensor.rate_hz:g} Hz, ' + ', '.join(
            path.stem for path in arguments.parameter_paths(chosen, [INSTRUMENT]))
        charts = report.motion_charts(rows, sweep, single_sigma, title)
        said = report.answer(rows, duration_s, sensor.rate_hz)
        for chart in charts:
            save_chart(work, chart)
        (work / report.MARK).write_text(json.dumps(report.as_json(
            rows, duration_s, sensor.rate_hz), indent=1) + '\n', encoding='utf-8')
        write_page(work, report.motions_page(title, rows, said, charts, settings))
    report.show_motions(f'standard deviation of a delay: {title}', rows, console)
    console.print(said)
    _tell_files(chosen.output, charts, console)
    return 0


def _tell_files(folder, charts, console):
    for chart in charts:
        console.print(f'figure: {Path(folder) / chart.name}.png')
    console.print(f'report: {Path(folder) / "report.html"}')
