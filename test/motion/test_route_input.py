"""Routes that cannot be flown are refused with one message; extreme ones that can are flown."""

from support.flown import instants, on_legs, route, WIND
import numpy as np
import pytest

from ins_sim import parameter_files
from support.studies import run_offline


def points(lat, lon):
    """Return settings with turning points in deg."""
    return {'points.latitude_deg': tuple(lat), 'points.longitude_deg': tuple(lon)}


BAD = [
    (points((55, 55), (37, 37)), 'motion.route.points: the leg from 55, 37 deg to 55, 37 deg '
     'joins the same point; expected'),
    (points((55, -55), (37, -143)), 'joins antipodes'),
    (points((55,), (37,)), 'the route has 1 turning points; expected two or more'),
    (points((55, 56), (37, 38, 39)), 'the route has 2 latitudes and 3 longitudes'),
    (points((55, 56, 55), (37, 37, 37)), 'motion.route.points: a turn of 180.0 deg; expected at '
     'most 170 deg at point 2'),
    (points((55, 56, 56.02, 57), (37, 37, 37.02, 36)), 'the leg from point 2 to 3 is 25'),
    (points((55, 55.01, 55.01), (37, 37, 39)), 'the leg from point 1 to 2 is 11'),
    (points((55, 55, 55.01), (37, 39, 39)), 'the leg from point 2 to 3 is 11'),
    (points((89, 89), (0, 180)), 'motion.route.points: the route reaches a latitude of 90.00 deg; '
     'expected at most 89 deg'),
    ({'wind_m_s': 150.0, 'gust_m_s': 20.0}, 'motion.route.wind_m_s and 3 times '
     'motion.route.gust_m_s are 210 m/s; expected less than the airspeed made good, 200 m/s'),
    ({'airspeed_m_s': 10.0, 'wind_m_s': 9.9, 'weave_deg': 20.0, 'turn_rate_deg_s': 1.0},
     'expected less than the airspeed made good, 9.69'),
    ({'turn_rate_deg_s': 5.0}, 'motion.route.turn_rate_deg_s 5 deg/s and the weave need a bank of '
     '60.7 deg at 200 m/s; expected at most 60 deg'),
    ({'turn_rate_deg_s': 3.0, 'weave_deg': 20.0, 'weave_period_s': 25.0}, 'need a bank of 7')]


@pytest.mark.parametrize('values, sentence', BAD)
def test_what_cannot_be_flown(values, sentence):
    """A route that cannot be flown gives one message with key, value and expectation."""
    with pytest.raises(ValueError) as error:
        route(values)
    assert sentence in str(error.value)
    assert str(error.value).startswith('motion.route.') and '\n' not in str(error.value)


def test_no_run_goes_beyond_the_arrival():
    """A run beyond the arrival is refused; the message states the time of the arrival."""
    settings = parameter_files.read([], ['motion.kind:=route', 'duration_s:=2000.0'])
    with pytest.raises(ValueError, match=r'start_s \+ duration_s is 2000 s; expected at most 6.* '
                       's, the arrival at the last turning point'):
        run_offline(settings)


@pytest.mark.parametrize('values', [
    # In the order of the ids: across the date line at high latitude; almost straight and straight;
    # nearly back; slow in wind; fast.
    {**points((87.0, 88.5, 87.0), (150.0, 179.0, -150.0)), **WIND},
    {**points((55.0, 55.9, 56.80001), (37.0, 37.0, 37.0))},
    {**points((55.0, 55.9, 56.8), (37.0, 37.00001, 37.0))},
    {**points((0.0, 0.0, 0.0), (179.0, 180.0, -179.0))},
    {**points((55.0, 57.0, 55.0), (37.0, 37.0, 38.0)), **WIND},
    {**points((55.0, 55.01, 55.01), (37.0, 37.0, 37.02)), 'airspeed_m_s': 12.0, 'wind_m_s': 9.0,
     'wind_from_deg': 300.0, 'turn_rate_deg_s': 20.0, 'roll_in_s': 1.0},
    {**points((55.0, 65.0, 65.0), (37.0, 37.0, 77.0)), 'airspeed_m_s': 1000.0,
     'turn_rate_deg_s': 0.5, 'roll_in_s': 20.0, 'height_m': 20000.0}],
    ids=('date line', 'straight', 'slight bend', 'equator', 'nearly back', 'slow', 'fast'))
def test_what_can_be_flown(values):
    """Extreme routes have great circles, constant airspeed, and their points in order."""
    motion = route(values)
    t_ns = instants(motion, 0.05)
    truth = motion.at(t_ns)
    leg = motion.route.legs_at(truth.lat, truth.lon)
    x, z = motion.route.to_xz(truth.lat, truth.lon, leg)
    free = on_legs(motion, t_ns)
    speed = np.linalg.norm(truth.v_n[:, :2] - motion.wind, axis=1)
    v = np.median(speed)
    rate = np.abs(np.diff(truth.v_n, axis=0)).max() / 0.05
    print(f'\n{len(motion.turns)} turns, {motion.end_s:.0f} s: |Z| {np.abs(z[free]).max():.1e} m, '
          f'airspeed {v:.6f} within {np.abs(speed - v).max():.1e} m/s, slope {rate:.2f} m/s^2')
    # A few roundings of radians.
    assert np.abs(z[free]).max() < 2e-8
    assert np.abs(speed - v).max() < 1e-7 * v
    # The heading turns by no more than its rate, the local axes by V/R0 tan(88.5 deg).
    assert ((truth.q_nb[1:] * truth.q_nb[:-1]).sum(axis=1) > 0.99).all()
    ahead = np.array(motion.route.starts)[leg] + x
    assert (np.diff(ahead[free]) > 0.0).all()
