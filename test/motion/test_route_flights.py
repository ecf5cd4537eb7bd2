"""The shipped flights: corners checked with an independent library, length, closure."""

import math

from support.flown import instants, on_legs
import numpy as np
import pytest

from ins_sim import parameter_files, resources
from ins_sim.core.earth import ellipsoid
from ins_sim.core.attitude.angles import to_compass
from ins_sim.core.motion.factory import make_motion
from ins_sim.core.earth.great_circle import AXIS_RATIO2
from ins_sim.settings.by_node import AIDING
from ins_sim.settings.by_node import NODES
from support.studies import run_offline

# File, lengths of the legs (km), turns (deg); all start at 55 N 37 E on a course of 30 deg.
FLIGHTS = [('route_flight', (160, 160, 160, 160), (60, -90, 60)),
           ('gnss_outage_flight', (40, 40, 200, 160, 160, 160), (60, -60, 60, -90, 60))]
COURSE = 30.0


def read(name, *assignments):
    """Return the Settings of a shipped file."""
    return parameter_files.read([resources.config(name)], assignments)


def motion_of(settings):
    """Return the motion of Settings."""
    generator = settings.motion_generator
    return make_motion(generator.motion, generator.datum, generator.earth)


def corners(lengths, turns):
    """Return the turning points (lat, lon), deg with six decimals, as the files were generated."""
    geodesic = pytest.importorskip('geographiclib.geodesic').Geodesic(ellipsoid.MEAN_RADIUS, 0.0)
    points, course = [(55.0, 37.0)], COURSE
    for length, turn in zip(lengths, (*turns, 0)):
        centric = math.degrees(math.atan(AXIS_RATIO2 * math.tan(math.radians(points[-1][0]))))
        end = geodesic.Direct(centric, points[-1][1], course, 1e3 * length)
        lat = math.degrees(math.atan(math.tan(math.radians(end['lat2'])) / AXIS_RATIO2))
        points.append((round(lat, 6), round(end['lon2'], 6)))
        course = end['azi2'] + turn
    return points


@pytest.mark.parametrize('name, lengths, turns', FLIGHTS, ids=('study', 'outage'))
def test_corners_and_length(name, lengths, turns):
    """The points of each file have the given legs and turns; the flight outlasts the run."""
    settings = read(name)
    points = settings.motion_generator.motion.route.points
    assert list(zip(points.latitude_deg, points.longitude_deg)) == corners(lengths, turns)
    motion = motion_of(settings)
    legs = motion.route.legs
    angles = [math.degrees(math.remainder(
        b.course(*_first(b)) - a.course(*_first(b)), 2.0 * math.pi))
        for a, b in zip(legs[:-1], legs[1:])]
    seconds = ', '.join(f'{start:.0f} to {end:.0f}' for start, end in motion.turns)
    print(f'\n{name}: turns {np.round(angles, 5).tolist()} deg at {seconds} s, legs '
          f'{[round(leg.length) for leg in legs]} m, arrival {motion.end_s:.1f} s of '
          f'{settings.motion_generator.duration_s:g}')
    # Six decimals of a degree are 0.06 m, which is 1e-4 deg of course over 40 km.
    assert angles == pytest.approx(turns, abs=2e-4)
    assert [leg.length for leg in legs] == pytest.approx([1e3 * x for x in lengths], abs=0.1)
    assert motion.end_s >= settings.motion_generator.duration_s
    if name == 'gnss_outage_flight':
        assert motion.turns[1][1] < 600.0 < motion.turns[2][0]


def _first(leg):
    """Return lat, lon of the first point, rad."""
    return leg.from_xz(0.0, 0.0)


@pytest.mark.parametrize('name', [f[0] for f in FLIGHTS])
def test_all_nodes_agree_on_the_route(name):
    """The aided navigator reads the points from the same parameter as the generator."""
    nodes = {**NODES, **AIDING}
    built = parameter_files.read_nodes([resources.config(name)], (), nodes)
    motion = built['motion_generator'].motion
    assert motion.kind == 'route' and built['imu_sensor'].motion == motion
    assert built['aided_navigator'].motion.route.points == motion.route.points
    assert len({repr(node.datum) for node in built.values()}) == 1


def test_what_the_study_flight_is():
    """The study flight: 50 minutes at 200 m/s, weave +-1 deg, wind 8 m/s and gusts of 0.5 m/s."""
    settings = read('route_flight')
    motion = motion_of(settings)
    t_ns = instants(motion, 0.1)
    truth, free = motion.at(t_ns), on_legs(motion, t_ns)
    x, z = motion.route.to_xz(truth.lat, truth.lon, motion.route.legs_at(truth.lat, truth.lon))
    ground = np.linalg.norm(truth.v_n[:, :2], axis=1)
    drift = to_compass(truth.q_nb)[2] - np.arctan2(truth.v_n[:, 0], truth.v_n[:, 1])
    drift = np.degrees(np.remainder(drift + math.pi, 2.0 * math.pi) - math.pi)
    print(f'\nground speed {ground.min():.2f} to {ground.max():.2f} m/s, drift {drift.min():.2f} '
          f'to {drift.max():.2f} deg, |Z| on legs {np.abs(z[free]).max():.1f} m, height '
          f'{truth.height.min():.1f} to {truth.height.max():.1f} m')
    assert np.abs(z[free]).max() < 14.0 + 20.0
    assert np.abs(truth.height - 500.0).max() < 20.0
    # Wind, and three axes of gusts with four standard deviations each.
    assert np.abs(ground - 200.0).max() < 8.0 + 2.0 + 0.3


@pytest.mark.slow
def test_the_study_flight_closes():
    """With an ideal IMU at 100 Hz the strapdown closes to 1 cm in fifty minutes."""
    run = run_offline(read('route_flight', 'source:=motion'))
    position, velocity = (np.abs(getattr(run.errors, name)).max(axis=0)
                          for name in ('position', 'velocity'))
    print(f'\n{len(run.errors)} steps: position {position[0]:.1e} m east, {position[1]:.1e} north '
          f'(1e-2), velocity {velocity.max():.1e} m/s')
    assert len(run.errors) == 300001 and position.max() < 1e-2
