"""
Valid files of every format that is read, and seeded mutations of them.

Mutations: bytes flipped, removed, inserted and repeated; lines and fields lost, doubled and
exchanged; numbers replaced by nan, inf, 1e300, 400 digits or an empty field; headers changed;
messages changed before they are written into a bag, where no checksum detects it; arrays of other
types. ``Hostile.attempt`` reads a mutation as the commands do: it must give a result with finite
values only, or one error message.
"""

import gzip
import io
import math
from pathlib import Path
import random
import shutil
import struct

import numpy as np

from ins_sim import parameter_files
from ins_sim.bags.bag_reader import open_bag
from ins_sim.bags.bag_writer import BagWriter
from ins_sim.core.motion.recorded.spline import RecordedMotion
from ins_sim.core.postprocessing.navigate import navigate
from ins_sim.core.timeseries.fixes import VelocityFix
from ins_sim.io.convert import convert_recording
from ins_sim.io.csv_flight import COLUMNS, read_poses
from ins_sim.io.csv_imu import IMU
from ins_sim.io.imu import read_imu
from ins_sim.messages import topics, velocity_record
from ins_sim.messages.cdr import LAYOUTS, Writer
from ins_sim.report import storage
from ins_sim.settings.catalogue import build
from ins_sim.settings.motion import MotionGeneratorSettings, Recording
from ins_sim.settings.navigate import NavigateSettings
from ins_sim.settings.place import Earth
from .mutations import BYTES, flip_bytes, TEXT

KINDS = ('flight.csv', 'imu.csv', 'imu.csv.gz', 'imu_to_bag.csv', 'reference.csv', 'bag.mcap',
         'bag.db3', 'messages', 'metadata.yaml', 'parameters.yaml', 'run.npz', 'record')
LONGEST_SENTENCE = 6000
_DOUBLES = [math.nan, math.inf, -math.inf, 1e300, -1e300, 5e-324, 0.0, 1e18, -1.0, 90.0, 180.0,
            1e7, 9.8, 1e6]
START = {'initial.position': 'given', 'initial.latitude_deg': 55.0, 'initial.heading': 'given',
         'initial.heading_deg': 10.0, 'alignment.longest_s': 5.0}
AT_REST = {**START, 'accept.frames': True, 'accept.unmeasured': True, 'accept.orientations': True,
           'accept.zero_readings': 'fill', 'alignment.gravity_m_s2': 1e3, 'on_gap': 'bridge'}


def _at_rest(count=400, rate_hz=50):
    """Return t_s, rate and force of an IMU at rest with noise: (n,), (n, 3), (n, 3)."""
    noise = np.random.default_rng(3).standard_normal((count, 6))
    return (np.arange(count) / rate_hz, 1e-3 * noise[:, :3],
            [0.0, 0.0, 9.8] + 2e-2 * noise[:, 3:])


def _table(names, rows):
    return '\n'.join([','.join(names), *(','.join(map(str, row)) for row in rows), '']).encode()


def _transform():
    """Return a TFMessage with one rotation as CDR bytes."""
    body = struct.pack('<IiI', 1, 0, 0)
    for name in (b'base_link\0', b'imu_link\0'):
        body += bytes(-len(body) % 4) + struct.pack('<I', len(name)) + name
    body += bytes(-len(body) % 8) + struct.pack('<7d', 0, 0, 0, 0, 0, 0.6, 0.8)
    return b'\0\1\0\0' + body


class Hostile:
    """
    Mutations of files of all kinds; folder: where they are written; counts: number by outcome.
    """

    def __init__(self, folder):
        self._folder = Path(folder)
        self.counts = {kind: {'result': 0, 'sentence': 0} for kind in KINDS}
        t_s, rate, force = _at_rest()
        imu = _table(('t_s', *IMU), ([f'{t:.3f}', *map(repr, w.tolist()), *map(repr, f.tolist())]
                                     for t, w, f in zip(t_s, rate, force)))
        flight = _table(COLUMNS, ([f'{0.1 * k:.1f}', f'{55 + 4e-5 * k:.7f}', '37.0', '100.0',
                                   '1.0', '2.0', f'{3 + 0.1 * k:.2f}', '40', '', '0']
                                  for k in range(101)))
        self._messages = self._good_messages(t_s, rate, force)
        self._base = {
            'flight.csv': flight, 'imu.csv': imu, 'imu.csv.gz': imu, 'imu_to_bag.csv': imu,
            'reference.csv': flight, 'parameters.yaml': self._parameters(),
            'run.npz': self._arrays(t_s, rate, force), 'record': self._record()}
        for kind, store in (('bag.mcap', 'mcap'), ('bag.db3', 'sqlite3')):
            made = self._bag(self._messages, store)
            self._base[kind] = next(made.glob('*_0.*')).read_bytes()
            if store == 'mcap':
                self._base['metadata.yaml'] = (made / 'metadata.yaml').read_bytes()
        self._imu_path = self._folder / 'sound_imu.csv'
        self._imu_path.write_bytes(imu)

    @staticmethod
    def _good_messages(t_s, rate, force):
        imu, fix = topics.IMU_RAW.writer(), topics.GNSS_FIX.writer()
        messages = [('/imu', topics.IMU, int(t * 1e9), imu.pack(int(t * 1e9), w, f))
                    for t, w, f in zip(t_s, rate.tolist(), force.tolist())]
        messages += [('/fix', topics.FIX, k * 10 ** 9, fix.pack(
            k * 10 ** 9, (55.0, 37.0, 100.0), (1.0,), (1.0,), (1.0,))) for k in range(8)]
        odometry = Writer(topics.ODOMETRY, 'odom', 'base_link')
        messages += [('/odom', topics.ODOMETRY, k * 10 ** 9, odometry.pack(
            k * 10 ** 9, (0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0), [0.0] * 6)) for k in range(8)]
        return [*messages, ('/tf_static', 'tf2_msgs/msg/TFMessage', 0, _transform())]

    def _bag(self, messages, store='mcap'):
        path = self._folder / 'made'
        shutil.rmtree(path, ignore_errors=True)
        with BagWriter(path, store) as bag:
            for name, type_name in dict.fromkeys((m[0], m[1]) for m in messages):
                bag.add_topic(name, type_name)
            for name, _, log_ns, data in messages:
                bag.write(name, log_ns, data)
        return path

    @staticmethod
    def _parameters():
        return (parameter_files.dump(parameter_files.read([]))
                + parameter_files.dump_nodes({'gnss': parameter_files.read_aided([]).gnss})
                ).encode()

    @staticmethod
    def _arrays(t_s, rate, force):
        buffer = io.BytesIO()
        np.savez(buffer, imu_t_ns=(t_s * 1e9).astype(np.int64), imu_omega=rate, imu_f=force)
        return buffer.getvalue()

    @staticmethod
    def _record():
        fix = VelocityFix(0, 10 ** 9, 100, (40.0, 0.1), (0.1, 0.2), 0.01, (0.1, 0.2), (1.0, 2.0))
        return velocity_record.pack_fix(fix, 10 ** 9)

    def mutation(self, seed):
        """Return the kind of a mutation and its bytes, or its messages if it is a bag."""
        rng = random.Random(seed)
        kind = KINDS[seed % len(KINDS)]
        if kind == 'messages':
            return kind, [self._changed(rng, m) for m in self._messages if rng.random() > 0.001]
        if kind == 'run.npz' and rng.random() < 0.4:
            return kind, self._other_arrays(rng)
        data = self._base[kind]
        text = kind.endswith(('.csv', '.gz', '.yaml'))
        for _ in range(rng.choice((1, 1, 1, 2, 4))):
            data = rng.choice(TEXT if text and rng.random() < 0.8 else BYTES)(rng, data)
        if kind.endswith('.gz'):
            data = gzip.compress(data, 1)
            if rng.random() < 0.3:
                data = rng.choice(BYTES)(rng, data)
        return kind, data

    @staticmethod
    def _changed(rng, message):
        """Return a message for a bag; one in twenty is changed."""
        name, type_name, log_ns, data = message
        if rng.random() > 0.05:
            return message
        data = bytearray(data)
        how = rng.random()
        if how < 0.5 and len(data) > 20:
            # Doubles lie at multiples of eight bytes behind the encapsulation header.
            place = 4 + 8 * rng.randrange(1, max(2, (len(data) - 4) // 8))
            if place + 8 <= len(data):
                struct.pack_into('<d', data, place, rng.choice(_DOUBLES))
        elif how < 0.7:
            struct.pack_into('<iI', data, 4, rng.choice((-2 ** 31, -1, 0, 2 ** 31 - 1)),
                             rng.choice((0, 999_999_999, 10 ** 9, 2 ** 32 - 1)))
        elif how < 0.8:
            log_ns = rng.choice((0, 2 ** 62, log_ns + 10 ** 9))
        elif how < 0.82:
            data = flip_bytes(rng, bytes(data))
        return name, type_name, log_ns, bytes(data)

    def _other_arrays(self, rng):
        arrays = dict(np.load(io.BytesIO(self._base['run.npz'])))
        name = rng.choice(sorted(arrays))
        array = arrays[name]
        other = rng.choice((array[:5], array[:, None], array.astype('f4'), array.astype(complex),
                            array.astype('U8'), np.zeros(0), np.array(1.0), array[::-1],
                            np.full(array.shape, np.nan), np.full(array.shape, np.inf),
                            np.array([{}], dtype=object), array.T, array.astype('>f8')))
        arrays[name] = other
        if rng.random() < 0.2:
            del arrays[name]
        buffer = io.BytesIO()
        rng.choice((np.savez, np.savez_compressed))(buffer, **arrays)
        return buffer.getvalue()

    def attempt(self, seed):
        """
        Read a mutation; return its kind and 'result' or 'sentence'; other outcomes raise
        AssertionError.
        """
        kind, data = self.mutation(seed)
        path = self._folder / f'try.{kind.partition(".")[2] or "bin"}'
        if kind == 'messages':
            path = self._bag(data, 'sqlite3' if seed % 5 == 0 else 'mcap')
        elif kind == 'metadata.yaml':
            path = self._bag_folder(data)
        elif kind != 'record':
            path.write_bytes(data)
        try:
            self._read(kind, path, data, seed)
            outcome = 'result'
        except (ValueError, OSError) as error:
            sentence = str(error)
            assert type(error) is ValueError or isinstance(error, OSError), repr(error)[:300]
            assert sentence and '\n' not in sentence, sentence[:300]
            assert len(sentence) < LONGEST_SENTENCE, sentence[:300]
            outcome = 'sentence'
        self.counts[kind][outcome] += 1
        return kind, outcome

    def _bag_folder(self, data):
        folder = self._folder / 'folder'
        folder.mkdir(exist_ok=True)
        (folder / 'made_0.mcap').write_bytes(self._base['bag.mcap'])
        (folder / 'metadata.yaml').write_bytes(data)
        return folder

    def _read(self, kind, path, data, seed):
        """Read a file of a kind as the commands do, and check the result."""
        if kind == 'flight.csv':
            motion = RecordedMotion(read_poses(path), Recording(path=str(path)), Earth())
            _finite(motion.at([0, 10 ** 9]).arrays())
        elif kind == 'imu_to_bag.csv':
            convert_recording(path, self._folder / 'converted', MotionGeneratorSettings(),
                              force=True)
        elif kind == 'reference.csv':
            self._navigate(self._imu_path, {**START, 'reference.path': str(path),
                                            'initial.position': 'reference',
                                            'initial.latitude_deg': 0.0})
        elif kind in ('imu.csv', 'imu.csv.gz', 'bag.mcap', 'bag.db3', 'messages'):
            if seed % 3 == 0 and 'csv' not in kind:
                self._read_all(path)
            self._navigate(path, AT_REST if seed % 2 else START)
        elif kind == 'metadata.yaml':
            self._read_all(path)
        elif kind == 'parameters.yaml':
            if seed % 2:
                parameter_files.read_aided([path])
            else:
                parameter_files.read([path])
        elif kind == 'run.npz':
            (self._folder / 'run').mkdir(exist_ok=True)
            (self._folder / 'run' / storage.ARRAYS).write_bytes(data)
            imu = storage.read_imu(self._folder / 'run')
            assert imu.omega.shape == imu.f.shape == (len(imu.t_ns), 3)
        else:
            velocity_record.read_fix(data, 0)

    def _navigate(self, path, values):
        chosen = build(NavigateSettings, values)
        result = navigate(chosen, read_imu(path, chosen))
        for states in result.states:
            _finite(states.arrays())

    def _read_all(self, path):
        with open_bag(path) as bag:
            bag.spans()
            for name, channel in bag.topics.items():
                if channel.type_name in LAYOUTS and channel.encoding == 'cdr':
                    bag.arrays(name)
            for _ in bag.messages():
                pass


def _finite(arrays):
    for name, array in arrays.items():
        assert np.isfinite(array).all(), f'{name} is not finite'
