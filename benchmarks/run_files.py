"""
Size and CPU time of the files of a run of an hour at 100 Hz, as ratios.

Run: python benchmarks/run_files.py
"""

from pathlib import Path
import tempfile
import time

import ins_sim
from ins_sim.report import storage
from ins_sim.report.files import packed_arrays
from ins_sim.report.files.tables import write_tables
import numpy as np


def timed(call, *arguments):
    """Return the CPU seconds of a call."""
    start = time.process_time()
    call(*arguments)
    return time.process_time() - start


def main():
    """Print a line for each way of writing."""
    settings = ins_sim.read_settings(['racetrack', 'imu_tactical_fog'], {'duration_s': 3600.0})
    flown = timed(ins_sim.simulate, settings)
    run = ins_sim.simulate(settings)
    arrays, records = storage.run_arrays(run.result), storage.run_records(run.result)
    size = sum(values.nbytes for values in arrays.values())
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / 'run.npz'
        plain = timed(lambda: np.savez(path, **arrays))
        print(f'plain: {size / 1e6:.1f} MB, {plain / flown:.2f} of the time of the run')
        for name, worth in (('where it shrinks by a quarter', packed_arrays.WORTH),
                            ('all arrays', np.inf)):
            packed_arrays.WORTH = worth
            seconds = timed(packed_arrays.write_arrays, path, arrays)
            print(f'deflate {packed_arrays.LEVEL}, {name}: {path.stat().st_size / size:.2f} of '
                  f'the bytes, {seconds / flown:.2f} of the time of the run')
        seconds = timed(write_tables, Path(folder), records)
        tables = sum(file.stat().st_size for file in Path(folder).glob('*.csv'))
        print(f'CSV: {tables / size:.2f} of the bytes, {seconds / flown:.2f} of the time of the '
              'run')


if __name__ == '__main__':
    main()
