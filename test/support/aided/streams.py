"""The input streams of an aided run, and functions that push them in any order."""

from functools import lru_cache

from ins_sim.core.aiding.navigator import GNSS, METER
from ins_sim.core.simulation.aided_run import with_truth
from ins_sim.core.simulation.aided import make_instruments, simulate_aided
from ins_sim.settings.simulation import AidedSimulationSettings
from ins_sim.core.aiding.live import AidedStream
from ins_sim.settings.catalogue import build, flatten
from ins_sim.core.streams.faults import StreamFault
from ins_sim.core.earth.frames import MapFrame
from ins_sim.core.earth.rates import body_velocity
from ins_sim.core.motion.factory import make_motion
from ins_sim.settings.by_node import AIDING
from ins_sim.settings.by_node import NODES
from ins_sim.core.simulation.inertial import simulate
from support.studies import settings as simulation_settings

VALUES = {'source': 'motion', 'motion.kind': 'route', 'duration_s': 12.0, 'window.cycles': 200,
          'window.latency_ms': 130.0, 'gnss.latency_ms': 70.0, 'gnss_model.use': True,
          'seed': 2, 'datum.latitude_deg': 55.0, 'datum.longitude_deg': 37.0,
          'outages.start_s': (4.5,), 'outages.end_s': (6.5,), 'accelerometer.errors.bias_ug':
          (100.0, 50.0, 0.0)}


def chosen_settings(values):
    """Return AidedSimulationSettings of {dotted name: value}."""
    known = {name: set(flatten(cls)) for name, cls in AIDING.items()}
    simulated = set().union(*(flatten(cls) for cls in NODES.values()))
    return AidedSimulationSettings(
        simulation_settings({k: v for k, v in values.items() if k in simulated}),
        **{name: build(cls, {k: v for k, v in values.items() if k in known[name]})
           for name, cls in AIDING.items()})


@lru_cache(maxsize=None)
def scene(*more):
    """
    Return (AidedSimulationSettings, AidedResult offline, events by stream) of a short flight.

    more: pairs (dotted name, value) in addition to VALUES.
    """
    chosen = chosen_settings({**VALUES, **dict(more)})
    simulation = chosen.simulation
    generator = simulation.motion_generator
    motion = make_motion(generator.motion, generator.datum, generator.earth)
    run = simulate(simulation, twin=False, motion=motion)
    offline = simulate_aided(chosen, make_instruments(chosen), motion, run)
    meter, gnss = make_instruments(chosen)
    meter.follow_ins(run.states.t_ns, body_velocity(run.states))
    truth = [t for _, t in with_truth(motion, [run.imu])][0]
    frame = MapFrame(generator.datum, True)
    poses = frame.pose(truth.lat, truth.lon, truth.height, truth.v_n, truth.q_nb)
    streams = {
        'push_imu': [(t, tuple(w), tuple(f)) for t, w, f in zip(
            run.imu.t_ns.tolist(), run.imu.omega.tolist(), run.imu.f.tolist())],
        'push_truth': [(t, *map(tuple, pose)) for t, pose in zip(truth.t_ns.tolist(), zip(
            *(p.tolist() for p in poses)))],
        METER: [(METER, fix) for fix in meter.advance(truth)],
        GNSS: [(GNSS, fix) for fix in gnss.advance(truth)]}
    return chosen, offline, streams


def push(stream, name, event, faults):
    """
    Push one event as a node does, with a reset after a fault that asks for one; return the
    outputs.
    """
    method = getattr(stream, name if name.startswith('push') else 'push_fix')
    for _ in range(2):
        try:
            return method(*event)
        except StreamFault as fault:
            faults.append(str(fault))
            if not fault.restart:
                return stream.match()
            stream.reset()
    raise AssertionError('twice the same fault')


def mixed(streams, rng):
    """
    Yield (name, event) of all streams in a random order that keeps the order within each stream.
    """
    order = [name for name, events in streams.items() for _ in events]
    rng.shuffle(order)
    places = dict.fromkeys(streams, 0)
    for name in order:
        yield name, streams[name][places[name]]
        places[name] += 1


def run_stream(streams, rng, chosen=None):
    """
    Return outputs, faults and the stream after all events were pushed in random order.

    chosen: AidedSimulationSettings; by default those of ``scene()``.
    """
    chosen = scene()[0] if chosen is None else chosen
    stream, outputs, faults = AidedStream(chosen.aided_navigator), [], []
    for name, event in mixed(streams, rng):
        outputs += push(stream, name, event, faults)
    return outputs, faults + [str(fault) for fault in stream.faults], stream
