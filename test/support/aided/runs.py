"""Short aided runs for the tests: their parameters, and the files that the command line writes."""

from ins_sim import parameter_files, resources
from ins_sim.cli.main import main
from ins_sim.core.simulation.aided import make_instruments, simulate_aided
from ins_sim.core.motion.factory import make_motion
from ins_sim.core.simulation.inertial import simulate

FILES = ('gnss_outage_flight', 'grade_mid')
# GNSS is out for the last of the 90 s. The meter is rotated by 20 arcmin; the filter allows 30.
FLIGHT = ('duration_s:=90.0', 'gnss_model.use:=true', 'window.cycles:=100',
          'outages.start_s:=[60.0]', 'outages.end_s:=[300.0]',
          'antennas.mounting_yaw_arcmin:=20.0', 'meter_model.mounting_sigma_arcmin:=30.0')


def settings(*more, flight=FLIGHT):
    """Return AidedSimulationSettings of the flight with further parameter assignments."""
    return parameter_files.read_aided([resources.config(name) for name in FILES],
                                      [*flight, *more])


def flown(settings):
    """Return motion, Run and AidedResult of AidedSimulationSettings."""
    generator = settings.simulation.motion_generator
    motion = make_motion(generator.motion, generator.datum, generator.earth)
    run = simulate(settings.simulation, twin=False, motion=motion)
    return motion, run, simulate_aided(settings, make_instruments(settings), motion, run)


def command(folder, *arguments, assignments=(), flight=FLIGHT, files=FILES):
    """Run simulate --aided into folder / 'run'; return the exit code."""
    words = [w for name in files for w in ('--params-file', name)]
    words += [w for text in (*flight, *assignments) for w in ('-p', text)]
    return main(['simulate', '--aided', *words, '-o', str(folder / 'run'), *arguments])
