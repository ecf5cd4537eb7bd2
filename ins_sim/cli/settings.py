"""Parameter files named on the command line."""

from pathlib import Path

from ins_sim import parameter_files, resources


def read(chosen):
    """Return SimulationSettings of --params-file and -p."""
    return parameter_files.read([resources.parameter_file(name) for name in chosen.params_file],
                                chosen.param)


def read_simulation(chosen):
    """
    Return SimulationSettings, and with --aided the AidedSimulationSettings that they are of, or
    None.
    """
    if not chosen.aided:
        return read(chosen), None
    aided = parameter_files.read_aided(
        [resources.parameter_file(name) for name in chosen.params_file], chosen.param)
    return aided.simulation, aided


def title(settings):
    """Return a line that names motion and delays."""
    motion, sensor = settings.motion_generator.motion, settings.imu_sensor
    d = sensor.gyro.delay_us
    name = motion.kind
    if name == 'recording':
        name = f'recording {Path(motion.recording.path).name}'
    return (f'{name}, gyro delays x {d.x:g}, y {d.y:g}, z {d.z:g} us, {sensor.rate_hz:g} Hz, '
            f'{settings.motion_generator.duration_s:g} s')
