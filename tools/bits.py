"""
Compare the numbers of the shipped configurations between processors, libraries and compilers.

Usage: python tools/bits.py [--write | --lines [--plain | --compiled]]

Every configuration is run for a few seconds, and the digest of all its arrays is compared with
the one in test/packaging/bits.json. This is done with the defaults of this machine, with the loops
that NumPy and the C library choose for an older processor, with three kernels of OpenBLAS, with
and without compiled loops, and with an old and a new NumPy in virtual environments made by pip
(docs/design/bits.md).

--write   write test/packaging/bits.json, after an intended change of numbers
--lines   only print the digests of this process; --plain: without Numba, --compiled: with every
          loop compiled from its first sample on
"""

import hashlib
import json
import os
from pathlib import Path
import platform
import subprocess
import sys
import tempfile
import venv

import digests
from ins_sim import parameter_files, simulate, simulate_aided
from ins_sim.api.inputs import files
from ins_sim.core.numerics import compilation
from ins_sim.core.numerics.noise import NOISE
from ins_sim.core.prediction.drift import NoPrediction
from ins_sim.core.prediction.predict import predict
from ins_sim.report.aided_arrays import aided_arrays
from ins_sim.report.storage import run_arrays
import numpy as np

ROOT = Path(__file__).resolve().parents[1]
REFERENCE = ROOT / 'test' / 'packaging' / 'bits.json'
DURATION = 'duration_s:=2.0'
# Two windows of the velocity meter with a GNSS outage.
AIDED = ('duration_s:=2.5', 'outages.start_s:=[1.5]', 'outages.end_s:=[300.0]')
# In this mode fixes are reproducible on one machine only.
NOT_PROMISED = ('aided-signal',)
# Spelling of the features in glibc 2.33 and later, and before.
TUNABLES = 'glibc.cpu.hwcaps=' + ','.join(
    f'-{name}{usable}' for name in ('AVX2', 'FMA', 'FMA4', 'AVX512F')
    for usable in ('', '_Usable'))
KERNELS = ('Nehalem', 'Haswell', 'SkylakeX')
NUMPY = ('numpy==1.26.4', 'numpy==2.4.6')
NEEDED = ('scipy<2', 'pyyaml<7', 'matplotlib<4', 'rich<16')


def lines():
    """Yield name and digest of each configuration."""
    for name, arguments in digests.simulations():
        settings = _settings(parameter_files.read, arguments, DURATION)
        yield name, _digest(_arrays(simulate(settings)))
    for name, arguments in digests.aided_simulations():
        if name not in NOT_PROMISED:
            run = simulate_aided(_settings(parameter_files.read_aided, arguments, *AIDED))
            yield name, _digest({**_arrays(run.run), **aided_arrays(run.result)})


def _settings(read, arguments, *more):
    """Return the settings of command-line arguments and further assignments."""
    pairs = list(zip(arguments[::2], arguments[1::2]))
    return read(files([value for option, value in pairs if option == '--params-file']),
                [*(value for option, value in pairs if option == '-p'), *more])


def _arrays(run):
    """Return {name: array} of all results and predictions of a run."""
    found = run_arrays(run.result)
    try:
        prediction = predict(run.settings, run.motion)
    except NoPrediction:
        return found
    return {**found, 'drift': prediction.drift, 'predicted': prediction.position}


def _digest(arrays):
    digest = hashlib.sha256()
    for name in sorted(arrays):
        array = np.ascontiguousarray(arrays[name])
        digest.update(f'{name} {array.dtype} {array.shape}'.encode() + array.tobytes())
    return digest.hexdigest()[:16]


def older_processor():
    """Return an environment in which NumPy and the C library use loops for older processors."""
    core = getattr(np, '_core', None) or np.core
    umath = core._multiarray_umath
    found = [name for name in umath.__cpu_dispatch__ if umath.__cpu_features__.get(name)]
    return {'NPY_DISABLE_CPU_FEATURES': ' '.join(found), 'GLIBC_TUNABLES': TUNABLES}


def in_child(environment=(), options=(), python=sys.executable):
    """Return {name: digest} computed by a child process; raise RuntimeError if it fails."""
    ended = subprocess.run(
        [str(python), __file__, '--lines', *options], capture_output=True, text=True, check=False,
        env={**os.environ, 'PYTHONPATH': str(ROOT), **dict(environment)})
    if ended.returncode:
        raise RuntimeError(ended.stderr.strip().splitlines()[-1])
    return dict(line.split() for line in ended.stdout.splitlines())


def reference():
    """Return the stored {name: digest}, which all x86-64 machines reproduce."""
    return json.loads(REFERENCE.read_text(encoding='utf-8'))['digests']


def different(found, expected):
    """Return the names of the configurations whose digests differ."""
    return sorted(name for name in {*found, *expected} if found.get(name) != expected.get(name))


def compare():
    """Print whether each configuration is equal in each environment; return the exit code."""
    cases = [('as it is', {}, (), sys.executable),
             ('an older processor', older_processor(), (), sys.executable),
             ('plain Python', {}, ('--plain',), sys.executable),
             ('compiled', {}, ('--compiled',), sys.executable)]
    cases += [(f'OpenBLAS {kernel}', {'OPENBLAS_CORETYPE': kernel}, (), sys.executable)
              for kernel in KERNELS]
    expected, table = reference(), {}
    with tempfile.TemporaryDirectory() as folder:
        cases += [(version, {}, (), made) for version in NUMPY
                  if (made := _environment(Path(folder) / version, version)) is not None]
        for title, environment, options, python in cases:
            try:
                table[title] = different(in_child(environment, options, python), expected)
            except RuntimeError as error:
                print(f'{title}: could not be run ({error})', flush=True)
            else:
                print(f'{title}: {len(table[title])} of {len(expected)} differ', flush=True)
    for name in sorted({*expected, *(n for names in table.values() for n in names)}):
        differs = [title for title, names in table.items() if name in names]
        print(f'{name}: ' + (f'differs ({", ".join(differs)})' if differs else 'equal'))
    return int(any(table.values()))


def _environment(folder, version):
    """Return the Python of a virtual environment with a version of NumPy, or None."""
    venv.create(folder, with_pip=True)
    python = folder / 'bin' / 'python'
    ended = subprocess.run([python, '-m', 'pip', 'install', '--quiet', version, *NEEDED],
                           capture_output=True, text=True, check=False)
    if ended.returncode:
        print(f'{version}: not installed ({ended.stderr.strip().splitlines()[-1]})', flush=True)
        return None
    return python


def main(words):
    """Run the command line; return the exit code."""
    if words[:1] == ['--lines']:
        if '--plain' in words:
            sys.modules['numba'] = None
        if '--compiled' in words:
            compilation.PLAIN_SAMPLES = 0
        for name, digest in lines():
            print(name, digest, flush=True)
        return 0
    if words == ['--write']:
        REFERENCE.write_text(json.dumps({
            'made_with': {'noise': NOISE, 'numpy': np.__version__,
                          'machine': platform.machine()},
            'digests': in_child()}, indent=1) + '\n', encoding='utf-8')
        print(f'written: {REFERENCE.relative_to(ROOT)}')
        return 0
    if words:
        print(__doc__.strip())
        return 2
    return compare()


if __name__ == '__main__':
    sys.exit(main(sys.argv[1:]))
