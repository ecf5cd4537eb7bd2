"""Verb dtg-report: performance of the tuned gyros that the parameters describe."""

from .. import arguments

HELP = 'show roots, bandwidth and stability margin of the tuned gyros'
DESCRIPTION = ('Show the performance of the tuned gyros of gyro.dtg.*: roots, time constant, '
               'bandwidth, stability margin and the steps for which RK4 is stable.')


def add_arguments(parser):
    """Add the arguments of the verb to its parser."""
    arguments.add_settings(parser)


def run(chosen):
    """Print roots, time constant, bandwidth, margin and RK4 steps; return the exit code."""
    from ins_sim.core.numerics.instants import period_ns
    from ins_sim.core.sensors.tuned_gyro.instrument import rotor_parameters
    from ins_sim.core.sensors.tuned_gyro.report import tuned_gyro_report
    sensor = arguments.read_settings(chosen).imu_sensor
    dtg = sensor.gyro.dtg
    p = rotor_parameters(dtg)
    nominal = tuned_gyro_report(p)
    print(f'tuned gyro {dtg.preset}, {p.loop} loop, rotor at {p.speed_hz:g} Hz')
    print('\n'.join(nominal.lines()))
    for gyro, ppm in enumerate(dtg.errors.speed_ppm, 1):
        if ppm:
            there = tuned_gyro_report(p, p.speed_hz * (1.0 + 1e-6 * ppm))
            print(f'gyro {gyro}, {ppm:g} ppm off: ' + there.lines()[0])
    step_ms = period_ns(sensor.rate_hz) * 1e-6 / dtg.steps_per_sample
    print(f'steps of {step_ms:.4g} ms by the method {dtg.method} at {sensor.rate_hz:g} Hz')
    return 0
