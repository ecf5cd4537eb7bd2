"""Any input file gives a finite result or one message."""

from contextlib import redirect_stderr, redirect_stdout
import io
import time
import warnings

import pytest
from support.hostile.files import Hostile, KINDS

COUNT = 5000
# Found by tools/fuzz_files.py: a gap of decades bridged step by step, and a signalling NaN.
FOUND = (7879, 17899, 40759)
# CPU time of one file that only an endless loop exceeds, s.
GUARD_S = 60.0


@pytest.mark.slow
def test_mutated_files_end_in_a_result_or_a_sentence(tmp_path, capsys):
    """5000 mutations, of all formats in turn, give a result or one message; a seed gives each."""
    hostile, failures = Hostile(tmp_path), []
    with warnings.catch_warnings():
        # A warning of NumPy would be printed to the user.
        warnings.simplefilter('error', RuntimeWarning)
        for seed in (*FOUND, *range(COUNT)):
            start = time.process_time()
            try:
                with redirect_stdout(io.StringIO()), redirect_stderr(io.StringIO()):
                    hostile.attempt(seed)
            except Exception as error:
                failures.append(f'{seed} {KINDS[seed % len(KINDS)]}: {error!r}'[:400])
            assert time.process_time() - start < GUARD_S, seed
    with capsys.disabled():
        print(f'\n{COUNT} hostile files: ' + ', '.join(
            f'{kind} {n["result"]} results and {n["sentence"]} sentences'
            for kind, n in hostile.counts.items()))
    assert not failures, '\n'.join(failures[:20])
