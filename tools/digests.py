"""
Print a digest of every array and message of the shipped configurations.

Usage: python tools/digests.py [-o FILE] [--shared-data FOLDER] [--only TEXT]

Each line is ``configuration part digest``. Run it before and after a change of a kernel or of the
structure of the code, and compare the two files: a line that differs is a number that changed.
Only the command line is used, so that versions with another layout can be compared. Digests of
recorded motions and of the signals of the velocity meter depend on the NumPy of the machine;
compare only files made on one machine.
"""

import argparse
from contextlib import redirect_stdout
import gzip
import hashlib
import io
from pathlib import Path
import re
import shutil
import sys
import tempfile

from ins_sim.cli.main import main
import numpy as np

ROOT = Path(__file__).resolve().parents[1]
SHIPPED = ('default', 'aggressive', 'cruise', 'motion_1', 'motion_2', 'motion_2_detuned',
           'racetrack', 'route_flight', 'dtg_motion_2', 'imu_navigation_rlg', 'imu_tactical_dtg',
           'imu_tactical_fog', 'imu_tactical_mems', 'grade_mid', 'grade_navigation',
           'grade_tactical')
# The delays of the studies over these motions.
DELAYS = {'motion_1': 'delay_x_1us', 'motion_2': 'delay_y_1us', 'motion_2_detuned': 'delay_y_1us',
          **dict.fromkeys(('aggressive', 'cruise', 'racetrack', 'recorded_flight'),
                          'delays_2_1_3us')}
# Files without a motion are run with motion 2.
MOVED = ('route_flight', 'dtg_motion_2', *DELAYS)
# Errors that the filter assumes for an IMU if no file gives them.
BELIEVED = tuple(f'imu_model.{name}:={value}' for name, value in (
    ('gyro_bias_sigma_deg_h', 0.05), ('gyro_bias_walk_deg_h_sqrt_h', 0.0),
    ('angle_random_walk_deg_sqrt_h', 0.01), ('gyro_scale_sigma_ppm', 0.0),
    ('accelerometer_bias_sigma_ug', 200.0), ('accelerometer_bias_walk_ug_sqrt_h', 0.0),
    ('velocity_random_walk_m_s_sqrt_h', 0.018)))
LATE = ('gyro.delay_us.x:=1.0', 'gyro.delay_us.y:=2.0', 'gyro.delay_us.z:=3.0')
FLIGHT = ('duration_s:=90.0', 'gnss_model.use:=true', 'window.cycles:=100',
          'outages.start_s:=[60.0]', 'outages.end_s:=[300.0]',
          'antennas.mounting_yaw_arcmin:=20.0', 'meter_model.mounting_sigma_arcmin:=30.0')
FILTERS = ('free', 'conventional', 'paper', 'paper_corrected', 'window_kf', 'eskf')


def words(files, assignments):
    """Return the arguments that name parameter files and assign values."""
    return [word for name in files for word in ('--params-file', name)] + [
        word for text in assignments for word in ('-p', text)]


def with_delays(*names):
    """Return the files, with the delays of its study added after each motion."""
    return [file for name in names for file in (name, DELAYS.get(name)) if file]


def simulations():
    """Yield (name, arguments of simulate)."""
    for name in SHIPPED:
        files = with_delays(name)
        common = ['duration_s:=20.0', *(() if name in MOVED else ['motion.kind:=two_axis'])]
        yield name, words(files, common)
        yield f'{name}-motion', words(files, [*common, 'source:=motion', *LATE])
    for channel in ('truth', 'free', 'damped'):
        for orientation in ('quaternion', 'poisson', 'euler_vector'):
            for output in ('rotation_vector', 'integrated'):
                yield f'strapdown-{channel}-{orientation}-{output}', words(
                    with_delays('imu_tactical_fog', 'aggressive'),
                    ['duration_s:=10.0', f'vertical.channel:={channel}',
                     f'orientation:={orientation}', f'output:={output}', f'input:={output}',
                     'initial.after_s:=1.0', 'initial.position_error_m:=[10.0, -20.0, 5.0]',
                     'initial.velocity_error_m_s:=[0.1, 0.2, -0.3]',
                     'initial.attitude_error_deg:=[0.01, -0.02, 0.1]', 'output_every:=3'])
    for kind in ('static', 'coning', 'sculling', 'sinusoids', 'harmonics'):
        yield f'bench-{kind}', words([], [f'motion.kind:={kind}', 'duration_s:=10.0', *LATE,
                                          'history:=frozen'])
    yield 'drop-outs', words(with_delays('imu_tactical_mems', 'motion_2'), [
        'duration_s:=30.0', 'sampling.drop_out_probability:=0.002'])
    yield 'jitter', words(with_delays('imu_tactical_mems', 'motion_2'), [
        'duration_s:=20.0', 'sampling.jitter_us:=200.0', 'sampling.latency_us:=500.0',
        'imu_time:=nominal', 'imu_latency_us:=500.0'])
    yield 'still-earth', words(with_delays('motion_2'), ['duration_s:=20.0',
                                                         'earth.rotation:=false'])


def aided_simulations():
    """Yield (name, arguments of simulate --aided)."""
    for name in FILTERS:
        gnss = [] if name == 'eskf' else ['gnss_model.use:=false']
        yield f'aided-{name}', words(['gnss_outage_flight', 'grade_mid'],
                                     [*FLIGHT, *gnss, f'filter:={name}'])
    yield 'aided-late', words(['gnss_outage_flight', 'grade_mid'], [
        *FLIGHT, 'window.latency_ms:=700.0', 'gnss.latency_ms:=1300.0'])
    yield 'aided-signal', words(['gnss_outage_flight', 'grade_mid'], [
        *FLIGHT, 'mode:=signal', 'duration_s:=20.0'])
    yield 'aided-free-channel', words(['gnss_outage_flight', 'grade_tactical'], [
        *FLIGHT, 'aided_navigator:vertical.channel:=free', 'output_every:=5'])
    yield 'aided-integrated', words(['gnss_outage_flight', 'imu_tactical_dtg'], [
        *FLIGHT, *BELIEVED, 'aided_navigator:input:=integrated',
        'sampling.drop_out_probability:=0.0005'])
    yield 'aided-straight', words(['gnss_outage_flight', 'grade_mid'], [
        'duration_s:=60.0', 'filter:=paper', 'window.cycles:=100', 'motion.route.weave_deg:=0.0'])
    yield 'aided-guided', words(['guided_flight', 'grade_mid'], [
        'duration_s:=20.0', 'filter:=paper_corrected', 'window.cycles:=100',
        'surrogate.k_z:=0.15'])


def with_gaps(source, target):
    """Copy the CSV file of an IMU without the rows of two spans."""
    with gzip.open(source, 'rt', encoding='utf-8') as stream:
        rows = stream.readlines()
    target.write_text(''.join(rows[:3000] + rows[3040:6000] + rows[6150:]), encoding='utf-8')


def recorded(data, folder):
    """Yield (name, verb, arguments) for recorded data; folder: for a file derived from them."""
    flights, imu, bags = data / 'flights', data / 'imu_ref', data / 'rosbags'
    for name, start in (('cruise_gv_acclip_rf01.csv.gz', 1000.0),
                        ('uavcircuit_umn_thor_fl75.csv.gz', 100.0)):
        yield f'recorded-{name[:6]}', 'simulate', words(with_delays('recorded_flight'), [
            f'motion.recording.path:={flights / name}', f'motion.recording.start_s:={start}',
            'motion.recording.smoothing_s:=0.5', 'motion.recording.on_gap:=cut',
            'duration_s:=20.0'])
    csv = str(imu / 'fogmems_imu.csv.gz')
    with_gaps(csv, folder / 'gaps.csv')
    reference = f'reference.path:={imu / "fogmems_fogins_reference.csv"}'
    given = ['initial.attitude:=reference', reference]
    for kind in ('instant', 'integrated', 'rotation_vector'):
        yield f'navigate-csv-{kind}', 'navigate', [csv, *words([], [*given, f'input:={kind}'])]
    yield 'navigate-damped', 'navigate', [csv, *words([], [*given, 'vertical.channel:=damped'])]
    husky, thor = bags / 'husky_test1_mcap', bags / 'umn_thor_fl75_first90s_sqlite3'
    given = ['initial.heading:=given', 'initial.heading_deg:=0.0', 'mounting.source:=level']
    yield 'navigate-husky', 'navigate', [str(husky), *words([], given)]
    for gap in ('stop', 'restart', 'bridge'):
        yield f'navigate-gaps-{gap}', 'navigate', [str(folder / 'gaps.csv'), *words([], [
            'initial.attitude:=reference', reference, f'on_gap:={gap}'])]
    yield 'navigate-thor', 'navigate', [str(thor)]


def of_arrays(path):
    """Return a digest of the arrays of an .npz file, by name."""
    digest = hashlib.sha256()
    with np.load(path) as arrays:
        for name in sorted(arrays):
            array = arrays[name]
            digest.update(f'{name} {array.dtype} {array.shape}'.encode())
            digest.update(np.ascontiguousarray(array).tobytes())
    return digest.hexdigest()[:16]


def of_text(text):
    """Return a digest of a text."""
    return hashlib.sha256(text.encode()).hexdigest()[:16]


def command(arguments):
    """Run a verb; return the exit code and the output."""
    printed = io.StringIO()
    with redirect_stdout(printed):
        code = main(arguments)
    return code, printed.getvalue()


def run(verb, arguments, folder, bag=False):
    """Yield (part, digest) of one run of a verb that writes into a folder."""
    extra = ['--bag', str(folder / 'bag')] if bag else []
    code, text = command([verb, *arguments, '-o', str(folder / 'run'), *extra])
    if code:
        yield 'refused', str(code)
        return
    for path in sorted((folder / 'run').glob('*.npz')):
        yield path.name, of_arrays(path)
    found = re.search(r'SHA-256 of the messages: (\w+)', text)
    if found:
        yield 'messages', found[1][:16]


def printed(folder):
    """Yield (name, part, digest) of the verbs that only print or write figures."""
    for name in ('motion_1', 'motion_2', 'dtg_motion_2', 'cruise'):
        yield name, 'predict', of_text(command(
            ['predict', *words(with_delays(name), ['duration_s:=600.0'])])[1])
    yield 'dtg_motion_2', 'dtg-report', of_text(command(
        ['dtg-report', *words(['dtg_motion_2'], [])])[1])
    yield 'motion_2', 'truth.csv', of_csv(folder, with_delays('motion_2'))


def of_csv(folder, files):
    """Return the digest of the truth of a run, converted from its bag into CSV."""
    bag, target = folder / 'csv_bag', folder / 'truth.csv.gz'
    command(['simulate', *words(files, ['duration_s:=10.0']), '-o', str(folder / 'csv_run'),
             '--bag', str(bag)])
    command(['convert', str(bag), str(target)])
    return of_text(gzip.decompress(target.read_bytes()).decode())


def lines(data, only):
    """Yield the lines of all digests."""
    runs = [(name, 'simulate', arguments, True) for name, arguments in simulations()]
    runs += [(name, 'simulate', [*arguments, '--aided'], True)
             for name, arguments in aided_simulations()]
    made = Path(tempfile.mkdtemp())
    if data.is_dir():
        runs += [(name, verb, arguments, verb == 'simulate')
                 for name, verb, arguments in recorded(data, made)]
    else:
        print(f'left out: recorded data, for {data} does not exist', file=sys.stderr)
    for name, verb, arguments, bag in runs:
        if only in name:
            folder = Path(tempfile.mkdtemp())
            for part, digest in run(verb, arguments, folder, bag):
                yield f'{name} {part} {digest}'
            shutil.rmtree(folder)
    if only in 'printed':
        for name, part, digest in printed(made):
            yield f'{name} {part} {digest}'
    shutil.rmtree(made)


if __name__ == '__main__':
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[1])
    parser.add_argument('-o', '--output', metavar='FILE', default=None)
    parser.add_argument('--shared-data', metavar='FOLDER', type=Path,
                        default=ROOT.parent / 'shared' / 'data')
    parser.add_argument('--only', metavar='TEXT', default='')
    chosen = parser.parse_args()
    found = []
    for line in lines(chosen.shared_data, chosen.only):
        print(line, flush=True)
        found.append(line)
    if chosen.output:
        Path(chosen.output).write_text('\n'.join(found) + '\n', encoding='utf-8')
