"""A run on disk: arrays, parameters, summary and figure in one folder, whole or not at all."""

from contextlib import contextmanager
from dataclasses import asdict, fields
import json
import os
from pathlib import Path
import shutil
import tempfile

import numpy as np

from . import figure
from .. import parameter_files

MARK = 'summary.json'


def check_free(folder, force, mark=MARK):
    """
    Raise ValueError unless the folder may be written: absent, or a run and force is given.

    mark: the file by which a run is known.
    """
    folder = Path(folder)
    parent = next(p for p in folder.absolute().parents if p.exists())
    if not parent.is_dir() or not os.access(parent, os.W_OK):
        raise ValueError(f'{folder} cannot be made in {parent}; expected a folder that may be '
                         'written')
    if not folder.exists():
        return
    if not force:
        raise ValueError(f'{folder} exists; expected a new folder (or --force)')
    if not folder.is_dir() or (any(folder.iterdir()) and not (folder / mark).exists()):
        raise ValueError(f'{folder} is no run of ins_sim; --force replaces only runs')


@contextmanager
def whole(folder, force=False, mark=MARK):
    """
    Give a folder to write into that takes the place of ``folder`` once the block is through.

    Whatever breaks in the block leaves what was there before.  Raises as check_free does.
    """
    folder = Path(folder)
    check_free(folder, force, mark)
    folder.parent.mkdir(parents=True, exist_ok=True)
    work = Path(tempfile.mkdtemp(prefix=f'.{folder.name}.', dir=folder.parent))
    try:
        yield work
        work.chmod(0o755)
        if folder.exists():
            shutil.rmtree(folder)
        work.rename(folder)
    except BaseException:
        shutil.rmtree(work, ignore_errors=True)
        raise


def write(folder, settings, run, rows, prediction, title, force=False):
    """
    Write a Run and what was predicted of it into a folder that appears only when complete.

    run.npz holds every array as <record>_<field> (SI, shapes as in ``core.records``).
    """
    with whole(folder, force) as work:
        arrays = {}
        for name in ('truth', 'imu', 'states', 'errors', 'twin'):
            record = getattr(run, name)
            if record is not None:
                arrays.update({f'{name}_{f.name}': getattr(record, f.name)
                               for f in fields(record)})
        arrays['predicted_t_s'] = prediction.t_s
        arrays['predicted_position'] = prediction.position
        np.savez(work / 'run.npz', **arrays)
        (work / 'parameters.yaml').write_text(parameter_files.dump(settings), encoding='utf-8')
        figure.save(work / 'errors.png', title, run.errors, prediction)
        (work / MARK).write_text(json.dumps([asdict(r) for r in rows], indent=1) + '\n',
                                 encoding='utf-8')
