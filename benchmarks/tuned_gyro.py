"""
CPU time of tuned gyros: a step and a block of two gyros, plain and compiled, and the study.

The study is that of Sapegin et al. (2016).

Run: python benchmarks/tuned_gyro.py
"""

from time import process_time

import numpy as np
from parts import EVERY_TERM, timed

from ins_sim import parameter_files, resources
from ins_sim.core.numerics import compilation
from ins_sim.core.sensors.tuned_gyro.instrument import PairInstrument
from ins_sim.settings.catalogue import build
from ins_sim.settings.imu import ImuSensorSettings
from ins_sim.settings.tuned_gyro import TunedGyroStudySettings
from ins_sim.studies.tuned_gyro import study_table

STEPS, BLOCK, PERIOD_NS = 2000, 4096, 10_000_000
PAIR = {'gyro.model': 'dtg', 'output': 'integrated', 'temperature.ramp_c_h': 36.0}
ROTORS = {f'gyro.dtg.errors.{name}': value for name, value in {
    'mass_unbalance_deg_h_g': [0.5] * 4, 'quadrature_unbalance_deg_h_g': [0.1] * 4,
    'spin_axis_deg_h_g': [0.1] * 4, 'anisoelastic_deg_h_g2': [0.01] * 4,
    'pickoff_offset_urad': [1.0] * 4, 'pickoff_noise_urad_sqrt_s': [0.05] * 4,
    'speed_ppm': [5.0, -5.0], 'hunting_ppm': [20.0, 10.0], 'spin_rate_product': 1.0,
    'vibration_2n_deg_s': [1.0, 1.0]}.items()}
READ_OUT = {f'gyro.errors.{name}': [value] * 3 for name, value in EVERY_TERM.items()}
INSTRUMENTS = {'two rotors': {}, 'with every error of rotors and pick-offs': ROTORS,
               'with those of the read-outs too': {**ROTORS, **READ_OUT}}


def step_us(settings):
    """Return CPU microseconds of a step as executed by the live IMU."""
    pair = PairInstrument(settings)
    rates, force = [(0.1, 0.2, 0.3), (0.11, 0.2, 0.3), (0.12, 0.2, 0.3)], (1.0, 2.0, 9.8)

    def work():
        for k in range(STEPS):
            pair.step((k + 1) * PERIOD_NS, rates, force)

    return 1e6 * timed(work) / STEPS


def block_us(settings, plain_samples):
    """Return CPU microseconds of a sample in a block, without the first block, which compiles."""
    before, compilation.PLAIN_SAMPLES = compilation.PLAIN_SAMPLES, plain_samples
    pair, generator = PairInstrument(settings), np.random.default_rng(1)
    rates, force = generator.normal(size=(BLOCK, 3, 3)), generator.normal(size=(BLOCK, 3))
    stamps = PERIOD_NS * np.arange(1, BLOCK + 1)

    def work():
        pair.advance(stamps, rates, force)

    work()
    spent = timed(work)
    compilation.PLAIN_SAMPLES = before
    return 1e6 * spent / BLOCK


def study_s():
    """Return CPU seconds of both tables of the paper."""
    start = process_time()
    for name in ('dtg_study_frequency', 'dtg_study_speed'):
        study_table(parameter_files.read_nodes([resources.config(name)], [], {
            'dtg_study': TunedGyroStudySettings})['dtg_study'])
    return process_time() - start


def main():
    """Print a line for each instrument, and one for the study."""
    for name, values in INSTRUMENTS.items():
        settings = build(ImuSensorSettings, {**PAIR, **values})
        step, plain, fast = (step_us(settings), block_us(settings, 10**12),
                             block_us(settings, 0))
        print(f'{name}: {step:.1f} us a step, {plain:.1f} us in blocks in plain Python, '
              f'{fast:.2f} us compiled ({plain / fast:.0f}x)')
    first = study_s()
    print(f'both tables of the paper: {study_s():.2f} s, the first time {first:.2f} s')


if __name__ == '__main__':
    main()
