"""Verb simulate: simulate offline and write the run into a folder."""

from pathlib import Path

from . import arguments

HELP = 'simulate offline and write the run into a folder'
DESCRIPTION = ('Simulate motion, IMU and strapdown offline, also without delays (the zero-delay '
               'twin), and write the run with figures and a report into a folder.')


def add_arguments(parser):
    """Add the arguments of the verb to its parser."""
    arguments.add_settings(parser)
    arguments.add_output(parser, 'ins_sim_run', 'folder of the run')
    arguments.add_force(parser, 'the run in DIR')
    parser.add_argument('--no-twin', action='store_true', help='do not simulate the zero-delay '
                        'twin')
    parser.add_argument('--aided', action='store_true', help='also simulate velocity meter, '
                        'GNSS and aided navigator with the same IMU samples')
    arguments.add_thin(parser)
    arguments.add_tables(parser)
    parser.add_argument('--bag', metavar='DIR', default=None, help='also write the topics that '
                        'the nodes would publish into a rosbag2 bag')
    arguments.add_storage(parser)
    parser.add_argument('--topics', nargs='+', metavar='TOPIC', default=None,
                        help='topics of the bag (default: all)')


def run(chosen):
    """Run, write and show; return the exit code."""
    from ins_sim.core.prediction.drift import NoPrediction
    from ins_sim.core.prediction.predict import predict
    from ins_sim.core.simulation.guided_flight import fly
    from ins_sim.core.simulation.inertial import simulate
    from ins_sim.core.timeseries.collecting import Collected
    from ins_sim.io.motion import read_motion
    from ins_sim.own_folders.own_folder import existing_parent, whole_folder
    from ins_sim.report import guided, spool, storage, summary, table, titles
    from ins_sim.report.console import PlainConsole
    from ins_sim.report.files.wanted import WantedFiles
    from ins_sim.report.runs.page import run_notes
    from .progress import progress_bars
    if chosen.aided:
        from ins_sim.core.simulation.aided import make_instruments, simulate_aided
    wanted = WantedFiles(chosen.thin, chosen.csv, chosen.tum)
    aided = arguments.read_aided_settings(chosen) if chosen.aided else None
    settings = aided.simulation if aided else arguments.read_settings(chosen)
    write_bag = _bag_writer(chosen, settings)
    title = titles.title(settings)
    console = PlainConsole()
    motion = read_motion(settings.motion_generator)
    # Created before the run, so that contradicting settings are reported before it.
    instruments = None if aided is None else make_instruments(aided)
    with spool.Spool(existing_parent(chosen.output)) as spooled:
        with whole_folder(chosen.output, chosen.force, storage.MARK) as work:
            steered = None
            if settings.motion_generator.motion.kind == 'guided':
                with progress_bars(console) as add_bar:
                    steered = fly(settings, motion, aided, add_bar('steering'))
            try:
                prediction = predict(settings, motion, spooled.store)
            except NoPrediction as reason:
                prediction = None
                console.print(str(reason))
            with progress_bars(console) as add_bar:
                # The aided part needs whole histories in memory.
                result = simulate(settings, motion, not chosen.no_twin, add_bar('simulating'),
                                  spooled.store if aided is None else Collected)
                flown = None if aided is None else simulate_aided(aided, instruments, motion,
                                                                  result, add_bar('aiding'))
            rows = [*summary.summary_rows(settings, result.errors, result.twin, prediction),
                    *guided.guided_rows(steered)]
            report = None if aided is None else _report(aided, flown, result)
            notes = run_notes(settings, result, prediction, steered)
            storage.write_run(work, settings, result, rows, prediction, title, report,
                              steered=steered, notes=notes, wanted=wanted)
        table.show_table(title, rows, console)
        for line in notes:
            console.print(line)
        if report is not None:
            report.show(console)
        for line in wanted.lines(result):
            console.print(line)
        console.print(f'written: {chosen.output}')
        if write_bag is not None:
            write_bag(result, motion, steered, console,
                      None if aided is None else (aided, flown))
    return 0


def _report(settings, flown, result):
    from ins_sim.report import aided
    rows = aided.aided_rows(settings, flown, result.states, result.errors)
    return aided.AidedReport(settings, flown, rows)


def _bag_writer(chosen, settings):
    """Return the function that writes the bag of a run, or None; check its arguments now."""
    if chosen.bag is None:
        for name in ('topics', 'storage', 'compression'):
            if getattr(chosen, name) not in (None, 'mcap', 'none'):
                raise ValueError(f'--{name} is given without --bag; expected the folder of a bag')
        return None
    from ins_sim.bags import bag_writer, digest
    from ins_sim.io import simulated
    wanted = simulated.select_topics(settings, chosen.topics, chosen.aided)
    bag_writer.check_target(chosen.bag, chosen.storage, chosen.compression, chosen.force)

    def write_bag(result, motion, steered, console, aided):
        counts = simulated.write_bag(chosen.bag, settings, result, wanted, chosen.storage,
                                     chosen.compression, chosen.force, aided=aided,
                                     motion=motion, steered=steered)
        console.print(f'written: {chosen.bag} with {sum(counts.values())} messages on '
                      f'{len(counts)} topics')
        for file in sorted(Path(chosen.bag).glob(f'{Path(chosen.bag).name}_*')):
            console.print(f'SHA-256 of {file.name}, which contains this file name: '
                          f'{digest.file_digest(file)}')
        console.print(f'SHA-256 of the messages: {digest.payload_digest(chosen.bag)}')

    return write_bag
