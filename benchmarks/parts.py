"""
CPU time of single parts: error model, route, recorded flight, velocity meter, a whole bag.

Run: python benchmarks/parts.py [seconds of flight for the bag, by default 3600]
"""

from pathlib import Path
import sys
import tempfile
from time import process_time

import numpy as np

from ins_sim import parameter_files, resources
from ins_sim.core.sensors.imu.triad_errors import TriadErrors
from ins_sim.core.sensors.velocity_meter.meter import VelocityMeter
from ins_sim.core.simulation.inertial import simulate
from ins_sim.io import simulated
from ins_sim.io.motion import read_motion
from ins_sim.settings.catalogue import build
from ins_sim.settings.imu import ImuSensorSettings
from ins_sim.settings.velocity_meter import VelocityMeterSettings

ROOT = Path(__file__).resolve().parents[1]
RECORDING = ROOT.parent / 'shared' / 'data' / 'flights' / 'cruise_gv_acclip_rf01.csv.gz'
EVERY_TERM = {
    'turn_on_bias_sigma_deg_h': 1.0, 'gauss_markov_sigma_deg_h': 0.1,
    'angle_random_walk_deg_sqrt_h': 0.01, 'rate_random_walk_deg_h_sqrt_h': 0.1,
    'bias_instability_deg_h': 0.1, 'scale_factor_ppm': 100.0, 'scale_asymmetry_ppm': 10.0,
    'cubic_ppm_s2_deg2': 0.01, 'misalignment_mrad': 0.1, 'non_orthogonality_mrad': 0.1,
    'g_sensitivity_deg_h_g': 0.1, 'g2_sensitivity_deg_h_g2': 0.1, 'bandwidth_hz': 20.0,
    'saturation_deg_s': 300.0, 'quantisation_arcsec': 0.3, 'temperature_bias_deg_h_c': 0.1,
    'temperature_scale_ppm_c': 1.0}


def timed(work, repeats=5):
    """Return the least CPU seconds of a few calls: other load can only increase it."""
    best = float('inf')
    for _ in range(repeats):
        start = process_time()
        work()
        best = min(best, process_time() - start)
    return best


def triad_step_us(steps=2048):
    """Return CPU microseconds of one step of a gyro triad with every error term."""
    sensor = build(ImuSensorSettings, {
        'temperature.ramp_c_h': 36.0,
        **{f'gyro.errors.{name}': [value] * 3 for name, value in EVERY_TERM.items()}})

    def work():
        errors = TriadErrors(sensor.gyro.errors, 1, 0, 'gyro', 0.01, sensor.temperature)
        for k in range(steps):
            errors.step(k, (0.3, -1.7, 0.004), (1.5, -2.5, 9.9), 0.1)

    return 1e6 * timed(work) / steps


def motion_of(*assignments, files=()):
    """Return the motion of shipped files and assignments."""
    return read_motion(parameter_files.read([resources.config(name) for name in files],
                                            assignments).motion_generator)


def main(seconds=3600.0):
    """Print a line for each part."""
    print(f'gyro triad, every term, one step: {triad_step_us():.1f} us')
    route = motion_of(files=('route_flight',))
    block = np.arange(4096, dtype=np.int64) * 10_000_000
    print(f'route with weave and gusts, a block of 4096 instants: '
          f'{1e3 * timed(lambda: route.at(block)):.1f} ms')
    if RECORDING.exists():
        flight = motion_of('motion.kind:=recording', f'motion.recording.path:={RECORDING}')
        instants = np.arange(360_000) * 10**7
        print(f'recorded flight, 360 000 instants: {timed(lambda: flight.at(instants), 2):.2f} s')
    meter = build(VelocityMeterSettings, {'mode': 'signal', 'window.cycles': 1000,
                                          'attack_angle': 'none'})
    t_ns = np.arange(1001) * 10_000_000
    v, height = np.tile(np.array((250.0, 0.0, 0.0)), (1001, 1)), np.full(1001, 500.0)
    spent = timed(lambda: VelocityMeter(meter).advance(t_ns, v, height))
    print(f'velocity meter, mode signal, 10 s of flight: {spent:.3f} s, {10.0 / spent:.0f} times '
          'faster than real time')
    settings = parameter_files.read([resources.config('motion_2')],
                                    [f'duration_s:={float(seconds):.1f}'])
    with tempfile.TemporaryDirectory() as folder:
        start = process_time()
        run = simulate(settings, read_motion(settings.motion_generator), twin=False)
        middle = process_time()
        counts = simulated.write_bag(Path(folder) / 'bag', settings, run,
                                     simulated.select_topics(settings, None))
        end = process_time()
    print(f'{float(seconds):g} s of {len(counts)} topics at 100 Hz: {middle - start:.1f} s to '
          f'simulate, {end - middle:.1f} s to write {sum(counts.values())} messages: '
          f'{float(seconds) / (end - start):.0f} times faster than real time')


if __name__ == '__main__':
    main(*sys.argv[1:])
