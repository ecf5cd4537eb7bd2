"""A run on disk: arrays, parameters, summary and figure in one folder, whole or not at all."""

from dataclasses import asdict
import json
from pathlib import Path
from zipfile import ZipFile

import numpy as np
from numpy.lib import format as npy_format

from ins_sim import parameter_files
from ins_sim.core.timeseries.histories import BLOCK, ImuSamples
from .guided import guided_arrays
from .manifest import manifest
from .runs.page import write_report
from .stored_arrays import read_arrays

MARK = 'summary.json'
ARRAYS = 'run.npz'
PARAMETERS = 'parameters.yaml'
MANIFEST = 'manifest.yaml'
_IMU = {'imu_t_ns': ('i', (None,)), 'imu_omega': ('f', (None, 3)), 'imu_f': ('f', (None, 3)),
        'imu_parity': ('f', (None,))}


def write_run(work, settings, run, rows, prediction, title, aided=None, own_motion=False,
              steered=None, notes=()):
    """
    Write a SimulationResult, and what was predicted of it or None, into a folder.

    run.npz holds every array as <record>_<field> (SI, shapes as in ``core.timeseries.histories``).
    aided: the ``aided.AidedReport`` on this run, which goes into the same files, or None;
    own_motion: whether the motion is not that of the settings; steered: GuidedResult of a guided
    motion, or None; notes: sentences for the page (``runs.page.run_notes``).
    """
    arrays = {**run_arrays(run), **guided_arrays(steered)}
    if prediction is not None:
        arrays['predicted_t_s'] = prediction.t_s
        arrays['predicted_position'] = prediction.position
    parameters = parameter_files.dump(settings)
    if aided is not None:
        arrays.update(aided.arrays())
        parameters = aided.parameters()
    write_arrays(work / ARRAYS, arrays)
    (work / PARAMETERS).write_text(parameters, encoding='utf-8')
    (work / MANIFEST).write_text(
        manifest(settings, aided and aided.settings, own_motion), encoding='utf-8')
    told = [*rows, *(aided.rows if aided else ())]
    (work / MARK).write_text(json.dumps([asdict(r) for r in told], indent=1) + '\n',
                             encoding='utf-8')
    write_report(work, settings, run, rows, prediction, title, aided, notes, own_motion)


def run_arrays(run):
    """Return the arrays of a SimulationResult as {<record>_<field>: array}."""
    arrays = {}
    for name in ('truth', 'imu', 'states', 'errors', 'twin'):
        record = getattr(run, name)
        if record is not None:
            arrays.update({f'{name}_{k}': v for k, v in record.arrays().items()})
    return arrays


def write_arrays(path, arrays):
    """Write arrays by name, or SpooledColumns, as ``numpy.savez`` does, block by block."""
    with ZipFile(path, 'w') as archive:
        for name, array in arrays.items():
            # The size is known only afterwards: it may be beyond what a small header can hold.
            with archive.open(f'{name}.npy', 'w', force_zip64=True) as member:
                if isinstance(array, np.ndarray):
                    npy_format.write_array(member, array, allow_pickle=False)
                    continue
                npy_format.write_array_header_1_0(member, {
                    'descr': npy_format.dtype_to_descr(array.dtype), 'fortran_order': False,
                    'shape': array.shape})
                for first in range(0, len(array), BLOCK):
                    member.write(array[first:first + BLOCK].data)


def read_imu(folder):
    """
    Return the ImuSamples of a run in a folder.

    Raises ValueError where run.npz is none that ``write`` made.
    """
    path = Path(folder) / ARRAYS
    try:
        # the parity is there of tuned gyros alone
        arrays = read_arrays(path, _IMU, optional=('imu_parity',))
    except ValueError as error:
        raise ValueError(f'{path} holds no IMU record ({error}); expected the arrays of '
                         '"ins_sim simulate"') from None
    return ImuSamples(**{name.removeprefix('imu_'): array for name, array in arrays.items()})
