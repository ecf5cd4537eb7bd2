"""Names of the runs and figures of the study of delays in words."""

from pathlib import Path

FLIGHT_NAMES = {'cruise': 'cruise', 'racetrack': 'racetrack', 'aggressive': 'aggressive flight',
                'route': 'route flight'}


def late_gyros(settings):
    """Return which gyros are late, such as 'gyro y 1 us late'."""
    delays = settings.imu_sensor.gyro.delay_us
    late = [f'{axis} {getattr(delays, axis):g}' for axis in 'xyz' if getattr(delays, axis)]
    return f'gyro{"s" * (len(late) > 1)} {", ".join(late)} us late'


def psi_rate(settings):
    """Return the rate of psi of motion 2, rad/s."""
    rates = settings.motion_generator.motion.two_axis
    return rates.psi_rate_rad_s + rates.detuning_rad_s


def motion_name(settings):
    """Return the motion in words, without the settings that differ between the runs."""
    motion = settings.motion_generator.motion
    if motion.kind == 'two_axis':
        return f'motion 2 at theta {motion.theta_deg:g} deg'
    if motion.kind == 'rocking':
        s = motion.rocking
        return f'motion 1, {s.amplitude_deg:g} deg at {s.frequency_hz:g} Hz'
    if motion.kind == 'recording':
        return f'recorded flight {Path(motion.recording.path).name}'
    return FLIGHT_NAMES[motion.kind]


def short_run_name(settings):
    """Return the name of a run within its figure."""
    motion = settings.motion_generator.motion
    if motion.kind == 'two_axis':
        rate = psi_rate(settings)
        tuned = abs(abs(rate) - 2.0 * abs(motion.two_axis.gamma_rate_rad_s)) < 1e-12
        return f"psi' = {rate:g} rad/s{', tuned' * tuned}"
    if motion.kind == 'rocking':
        return f'psi = {motion.psi_deg:g} deg'
    return motion_name(settings)


def run_name(settings):
    """Return the name of a run within the study."""
    motion = settings.motion_generator.motion
    if motion.kind == 'two_axis':
        return f'motion 2, theta {motion.theta_deg:g} deg, {short_run_name(settings)}'
    if motion.kind == 'rocking':
        return f'motion 1, {short_run_name(settings)}'
    return motion_name(settings)


def conditions(settings):
    """Return a sentence with the conditions common to the runs of a figure."""
    motion = settings.motion_generator.motion
    told = {'two_axis': f", gamma' = {motion.two_axis.gamma_rate_rad_s:g} rad/s",
            'rocking': f', rocking about the {motion.rocking.axis} axis'}.get(motion.kind, '')
    return (f'{settings.imu_sensor.rate_hz:g} Hz, {settings.motion_generator.duration_s:g} s'
            f'{told}.')
