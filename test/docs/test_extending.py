"""
The examples of docs/how_to/add_motion.md and add_sensor.md run and give the right values.

These are the motion, the autopilot and the sensor of these pages.
"""

import re

import ins_sim
from ins_sim.core.motion.motion import Motion
from ins_sim.core.sensors.gnss import Gnss
from ins_sim.core.sensors.imu.stream import ImuWithErrors, PacedImu, StreamImu
from ins_sim.core.sensors.sensor import Sensor
from ins_sim.settings.guidance import AUTOPILOTS
from ins_sim.settings.motion import MOTIONS
import numpy as np
import pytest
from support.places import ROOT

PAGES = ROOT / 'docs' / 'how_to'


def blocks(page):
    """Return the Python blocks of a page."""
    text = (PAGES / page).read_text(encoding='utf-8')
    return re.findall(r'```python\n(.*?)```', text, re.DOTALL)


CIRCLE, AUTOPILOT = blocks('add_motion.md')[:2], blocks('add_motion.md')[2:]
ALTIMETER = blocks('add_sensor.md')


@pytest.fixture
def example(tmp_path, monkeypatch):
    """Return a function that saves the first block of an example and executes the second."""
    monkeypatch.syspath_prepend(tmp_path)
    # Restores the table after the test.
    monkeypatch.setitem(MOTIONS, 'circle', None)

    def run(example, file):
        code, use = example
        assert len(code.splitlines()) <= 30
        (tmp_path / file).write_text(code, encoding='utf-8')
        names = {}
        exec(compile(use, f'use of {file}', 'exec'), names)
        return names

    return run


def test_the_motion_of_the_page_flies_its_circle(example):
    """The motion of the page has a speed of 2 pi 50 m / 60 s, and its heading along the circle."""
    truth = example(CIRCLE, 'circle.py')['run'].truth
    speed = 2.0 * np.pi * 50.0 / 60.0
    # The radii of the Earth at the datum differ from those 50 m away by a relative 1e-7; the
    # neglected height, that of the datum, is below 200 m: 3e-5.
    np.testing.assert_allclose(np.linalg.norm(truth.v_n, axis=1), speed, rtol=1e-4)
    np.testing.assert_allclose(truth.v_n[0, 1], speed, rtol=1e-4)
    # Level and turning to the left, the lateral accelerometer reads V^2 / R = 0.55 m/s^2; the
    # Coriolis force adds at most 2 Omega V = 0.8 mm/s^2.
    np.testing.assert_allclose(truth.f_ib_b[:, 1], speed ** 2 / 50.0, rtol=2e-3)


def test_a_motion_of_ones_own_is_flown_and_saved_without_published_figures(example, tmp_path):
    """
    A user's motion passed as an object gives the arrays of the same motion in the table.

    The saved run shows no published figures.
    """
    names = example(CIRCLE, 'circle.py')
    motion = ins_sim.open_motion(names['settings'])
    settings = ins_sim.read_settings('motion_2', {'duration_s': 60.0})
    run = ins_sim.simulate(settings, motion=motion)
    np.testing.assert_array_equal(run.errors.position, names['run'].errors.position)
    run.save(tmp_path / 'run')
    assert '"published": null' in (tmp_path / 'run' / 'summary.json').read_text()


def test_the_autopilot_of_the_page_steers(example, monkeypatch):
    """The autopilot of the page returns the vehicle to the leg and overshoots by its integral."""
    monkeypatch.setitem(AUTOPILOTS, 'integral', None)
    steered = example(AUTOPILOT, 'integral.py')['run'].steered
    assert steered.estimates.steers.all()
    assert steered.states.z.min() < -0.03 and abs(steered.states.z[-1]) < 0.1
    commanded = 0.0125 * steered.estimates.z + 0.04 * steered.estimates.v_z
    assert abs(steered.estimates.command - commanded).max() > 5e-4


def test_the_sensor_of_the_page_reads(example):
    """
    The sensor of the page gives ten readings a second with the offset, however blocks are cut.

    A copy after a restart gives the same readings.
    """
    names = example(ALTIMETER, 'altimeter.py')
    run, readings = names['run'], names['readings']
    assert len(readings) == 601
    heights = np.interp([t for t, _ in readings], run.truth.t_ns, run.truth.height)
    errors = np.array([h for _, h in readings]) - heights
    # 601 readings with 0.2 m of noise: the mean is within 0.033 m (four standard deviations).
    assert abs(errors.mean() - 0.5) < 0.033
    sensor = names['Altimeter']()
    sensor.reset()
    cut = sensor.advance(run.truth[:1000]) + sensor.advance(run.truth[1000:])
    assert cut == readings


@pytest.mark.parametrize('cls', [Gnss, StreamImu, PacedImu, ImuWithErrors])
def test_the_sensors_of_the_simulator_have_the_interface(cls):
    """The sensors of the simulator have the interface Sensor."""
    assert issubclass(cls, Sensor)


@pytest.mark.parametrize('kind', [kind for kind in MOTIONS if kind not in ('recording', 'circle')])
def test_every_motion_of_the_table_is_a_motion(kind):
    """For every motion of the table the maker returns a Motion whose truth is finite."""
    motion = ins_sim.open_motion(ins_sim.read_settings(
        'route_flight' if kind == 'route' else [], {'motion.kind': kind}))
    assert isinstance(motion, Motion)
    # A guided motion is known only up to the last command.
    instant = np.array([0 if kind == 'guided' else 10 ** 9])
    assert all(np.isfinite(values).all() for values in motion.at(instant).arrays().values())
