"""Write a run into a folder: arrays, parameters, summary, figures; complete or not at all."""

from dataclasses import asdict
import json
from pathlib import Path

from ins_sim import parameter_files
from ins_sim.core.earth.frames import MapFrame
from ins_sim.core.timeseries.histories import ImuSamples
from .aided_arrays import aided_arrays, aided_records
from .files.packed_arrays import write_arrays
from .files.stored_arrays import read_arrays
from .files.tables import write_tables
from .files.trajectories import write_trajectories
from .files.wanted import WantedFiles
from .guided import guided_arrays
from .manifest import manifest
from .runs.page import write_report

MARK = 'summary.json'
ARRAYS = 'run.npz'
PARAMETERS = 'parameters.yaml'
MANIFEST = 'manifest.yaml'
# {name of a trajectory: record}
TRAJECTORIES = {'truth': 'truth', 'ins': 'states', 'aided': 'aided_states'}
_IMU = {'imu_t_ns': ('i', (None,)), 'imu_omega': ('f', (None, 3)), 'imu_f': ('f', (None, 3)),
        'imu_parity': ('f', (None,))}


def write_run(work, settings, run, rows, prediction, title, aided=None, own_motion=False,
              steered=None, notes=(), wanted=WantedFiles()):
    """
    Write a SimulationResult into a folder.

    run.npz contains every array as <record>_<field> (SI units, shapes as in
    ``core.timeseries.histories``).

    Parameters
    ----------
    work : folder
    settings, run, rows, prediction, title : SimulationSettings, SimulationResult, SummaryRows,
        Prediction or None, and a title of the run
    aided : ``aided.AidedReport`` of this run, written into the same files, or None
    own_motion : whether the motion was given as an object instead of by the settings
    steered : GuidedResult of a guided motion, or None
    notes : sentences for the page (``runs.page.run_notes``)
    wanted : WantedFiles, optional files and thinning
    """
    records = run_records(wanted.kept(run))
    arrays = {**_arrays_of(records), **guided_arrays(steered)}
    if prediction is not None:
        arrays['predicted_t_s'] = prediction.t_s
        arrays['predicted_position'] = prediction.position
    parameters = parameter_files.dump(settings)
    if aided is not None:
        solution = wanted.kept(aided.flown)
        arrays.update(aided_arrays(solution))
        records.update(aided_records(solution))
        parameters = aided.parameters()
    write_arrays(work / ARRAYS, arrays)
    if wanted.csv:
        write_tables(work, records)
    if wanted.tum:
        generator = settings.motion_generator
        write_trajectories(work, MapFrame(generator.datum, generator.earth.rotation), {
            name: records[record] for name, record in TRAJECTORIES.items() if record in records})
    (work / PARAMETERS).write_text(parameters, encoding='utf-8')
    (work / MANIFEST).write_text(
        manifest(settings, aided and aided.settings, own_motion, wanted.thin), encoding='utf-8')
    told = [*rows, *(aided.rows if aided else ())]
    (work / MARK).write_text(json.dumps([asdict(r) for r in told], indent=1) + '\n',
                             encoding='utf-8')
    write_report(work, settings, run, rows, prediction, title, aided,
                 [*notes, *wanted.lines(run)], own_motion)


def run_arrays(run):
    """Return the arrays of a SimulationResult as {<record>_<field>: array}."""
    return _arrays_of(run_records(run))


def run_records(run):
    """Return {name: History} of a SimulationResult."""
    records = {name: getattr(run, name) for name in ('truth', 'imu', 'states', 'errors', 'twin')}
    return {name: record for name, record in records.items() if record is not None}


def _arrays_of(records):
    return {f'{name}_{field}': values for name, record in records.items()
            for field, values in record.arrays().items()}


def read_imu(folder):
    """
    Return the ImuSamples of a run in a folder.

    Raises ValueError if run.npz was not written by ``write_run``.
    """
    path = Path(folder) / ARRAYS
    try:
        # Only runs with tuned gyros contain the parity.
        arrays = read_arrays(path, _IMU, optional=('imu_parity',))
    except ValueError as error:
        raise ValueError(f'{path} holds no IMU record ({error}); expected the arrays of '
                         '"ins_sim simulate"') from None
    return ImuSamples(**{name.removeprefix('imu_'): array for name, array in arrays.items()})
