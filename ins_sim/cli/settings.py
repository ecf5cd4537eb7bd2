"""Parameter files named on the command line."""

from pathlib import Path

from .. import parameter_files, resources


def locate(name):
    """Return the path of a parameter file given by path or by the name of a shipped one."""
    path = Path(name)
    if path.exists() or path.suffix or path.parent != Path('.'):
        return path
    return resources.config(name)


def read(chosen):
    """Return simulation.Settings of --params-file and -p."""
    return parameter_files.read([locate(name) for name in chosen.params_file], chosen.param)


def title(settings):
    """Return a line that names motion and delays."""
    motion, sensor = settings.motion_generator.motion, settings.imu_sensor
    d = sensor.gyro.delay_us
    name = motion.kind
    if name == 'recording':
        name = f'recording {Path(motion.recording.path).name}'
    return (f'{name}, gyro delays x {d.x:g}, y {d.y:g}, z {d.z:g} us, {sensor.rate_hz:g} Hz, '
            f'{settings.motion_generator.duration_s:g} s')
