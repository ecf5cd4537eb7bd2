"""
One hour of strapdown navigation at 100 Hz: ours and pyins on equal samples, one process.

Run: python benchmarks/pyins_peer.py [seconds of flight, by default 3600]

Both use instantaneous rates and specific forces of the closed-form cruise, start from the truth,
and return the whole trajectory. pyins (from PyPI: python-ins, extra bench) steps in compiled code;
compiling is not timed.
"""

import math
from statistics import median
import sys
from time import process_time

import numpy as np

from ins_sim import parameter_files
from ins_sim.core.motion.factory import make_motion
from ins_sim.core.postprocessing.imu_record import RecordedImu
from ins_sim.core.postprocessing.initial_state import Sources
from ins_sim.core.postprocessing.navigate import navigate
from ins_sim.core.postprocessing.reference import Reference, SampledTrack
from ins_sim.settings.catalogue import build
from ins_sim.settings.navigate import NavigateSettings

REPEATS = 3


def flight(seconds):
    """Return the Truth of the cruise at 100 Hz."""
    s = parameter_files.read([], ['motion.kind:=cruise']).motion_generator
    motion = make_motion(s.motion, s.datum, s.earth)
    return motion.at(10_000_000 * np.arange(round(100 * seconds) + 1))


def ours(truth):
    """Return a function that navigates and returns the last latitude, longitude (rad), height."""
    track = np.stack([truth.lat, truth.lon, truth.height], axis=-1)
    reference = Reference('truth', *(SampledTrack(truth.t_ns, values)
                                     for values in (track, truth.v_n, truth.q_nb)))
    imu = RecordedImu(truth.t_ns, truth.omega_ib_b, truth.f_ib_b,
                      np.full((len(truth.t_ns), 4), np.nan))
    settings = build(NavigateSettings, {'initial.attitude': 'reference'})
    sources = Sources('the cruise', imu, 'base_link', reference)

    def run():
        states = navigate(settings, sources).states[-1]
        return states.lat[-1], states.lon[-1], states.height[-1]

    return run


def theirs(truth):
    """Return the same function for pyins, in NED and FRD."""
    import pandas as pd
    from pyins import strapdown, transform, util
    from scipy.spatial.transform import Rotation
    flip = np.array([1.0, -1.0, -1.0])
    ned = np.array([[0.0, 1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, -1.0]])
    imu = pd.DataFrame(np.hstack([truth.omega_ib_b * flip, truth.f_ib_b * flip]),
                       index=truth.t_ns * 1e-9, columns=[*util.GYRO_COLS, *util.ACCEL_COLS])
    attitude = ned @ Rotation.from_quat(truth.q_nb[0]).as_matrix() @ np.diag(flip)
    start = pd.Series(np.hstack([
        np.degrees([truth.lat[0], truth.lon[0]]), truth.height[0], ned @ truth.v_n[0],
        transform.mat_to_rph(attitude)]), index=util.TRAJECTORY_COLS, name=imu.index[0])

    def run():
        increments = strapdown.compute_increments_from_imu(imu, 'rate')
        end = strapdown.Integrator(start).integrate(increments).iloc[-1]
        return math.radians(end.lat), math.radians(end.lon), end.alt

    return run


def main(seconds=3600.0):
    """Print CPU seconds, the errors at the end, and the ratio."""
    truth, times = flight(float(seconds)), {}
    paths = {'ins_sim': ours(truth)}
    try:
        paths['pyins'] = theirs(truth)
        theirs(flight(1.0))()
    except ImportError as error:
        print(f'pyins is not installed ({error}): pip install python-ins')
    for name, run in list(paths.items()) * REPEATS:
        start = process_time()
        lat, lon, _ = run()
        times.setdefault(name, []).append(process_time() - start)
        if len(times[name]) == REPEATS:
            off = math.hypot(lat - truth.lat[-1], (lon - truth.lon[-1]) * math.cos(lat))
            print(f'{name}: {median(times[name]):.3f} s of CPU for {float(seconds):g} s of flight '
                  f'at 100 Hz; off by {6.4e6 * off:.2g} m at the end')
    if len(times) == 2:
        print(f'ratio: {median(times["ins_sim"]) / median(times["pyins"]):.1f}')


if __name__ == '__main__':
    main(*sys.argv[1:])
