"""Fixes of instruments without errors are used, with the smallest sigma that is reported."""

from support.aided import runs as aided_runs

ZEROS = ('surrogate.sigma_x_m_s:=0.0', 'surrogate.sigma_z_m_s:=0.0', 'surrogate.slip_z_m_s:=0.0',
         'surrogate.bias_x_m_s:=0.0', 'errors.position_noise_m:=[0.0, 0.0, 0.0]',
         'errors.velocity_noise_m_s:=[0.0, 0.0, 0.0]')


def test_fixes_without_errors_are_taken():
    """Fixes of error-free instruments are neither dropped nor rejected."""
    settings = aided_runs.settings(*ZEROS)
    _, _, found = aided_runs.flown(settings)
    assert not found.faults
