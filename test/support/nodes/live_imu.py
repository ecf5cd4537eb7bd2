"""Feed a recorded IMU to the stage, or to the node, that navigates without truth."""

from dataclasses import dataclass, field

import numpy as np

from ins_sim.bags.bag_reader import open_bag
from ins_sim.core.attitude import quaternion
from ins_sim.core.earth import ellipsoid
from ins_sim.core.postprocessing.imu_record import RecordedImu
from ins_sim.core.postprocessing.reference import Reference, SampledTrack
from ins_sim.core.standalone.fixes import PlaceFix
from ins_sim.core.standalone.mounted import LiveMounting
from ins_sim.core.standalone.navigator import StandaloneNavigator
from ins_sim.io import positions
from ins_sim.messages import topics
from ins_sim.messages.cdr import Reader
from ins_sim.settings.catalogue import build
from ins_sim.settings.strapdown import StrapdownSettings

LIVE = {'initial.source': 'alignment', 'input': 'instant', 'vertical.channel': 'free'}
# The same for navigate, whose settings have other names or no counterpart.
OFFLINE = {'reference.odometry': 'none', 'reference.velocity': 'none'}
FIELDS = ('lat', 'lon', 'height', 'v_n', 'q_nb')


@dataclass
class Said:
    """A stage, with the solutions and messages it has produced."""

    stage: StandaloneNavigator
    solved: list = field(default_factory=list)
    sentences: list = field(default_factory=list)

    def take(self, outputs):
        """Store solutions and the messages that came with them."""
        self.solved += outputs
        for said in (self.stage.infos, self.stage.warnings, self.stage.faults):
            self.sentences += said
            said.clear()

    def has(self, part):
        """Return whether a message contains this text."""
        return any(part in sentence for sentence in self.sentences)

    @property
    def t_ns(self):
        """Return the stamps of the solutions."""
        return np.array([s.t_ns for s in self.solved], dtype=np.int64)


def stage_of(values=None, transforms=False, declination=lambda t_ns, place: (0.0, 'as given')):
    """Return Said of a new stage; values: parameters in addition to LIVE."""
    settings = build(StrapdownSettings, {**LIVE, **(values or {})})
    return Said(StandaloneNavigator(settings, LiveMounting(settings.mounting, 'base_link',
                                                           transforms), declination))


def play(said, imu, fixes=(), late_ns=0):
    """
    Pass a RecordedImu and PlaceFixes to a stage in the order of their stamps; return Said.

    late_ns: delay of a fix after its stamp.
    """
    waiting = list(fixes)
    for t_ns, omega, f in zip(imu.t_ns.tolist(), map(tuple, imu.omega.tolist()),
                              map(tuple, imu.f.tolist())):
        while waiting and waiting[0].t_ns + late_ns <= t_ns:
            said.take(said.stage.push_fix(waiting.pop(0)))
        said.take(said.stage.push_imu(t_ns, omega, f))
    for fix in waiting:
        said.take(said.stage.push_fix(fix))
    while said.stage.waiting:
        said.take(said.stage.drain())
    return said


def read(bag, imu, fix):
    """Return a RecordedImu and the PlaceFixes of a bag, in the order they were logged."""
    read_imu, read_fix = Reader(topics.IMU, ((13, 16), (25, 28))), Reader(topics.FIX, ((0, 3),))
    rows, fixes = [], []
    with open_bag(bag) as opened:
        for name, _, data in opened.messages([imu, fix]):
            if name == imu:
                rows.append(read_imu.read(data))
                continue
            t_ns, place = read_fix.read(data)
            lat, lon, height = (np.array([value]) for value in place)
            if positions.usable(lat, lon, height, np.array([read_fix.numbers(data)[0]]))[0][0]:
                fixes.append(PlaceFix(t_ns, *positions.track(lat, lon, height)[0].tolist()))
    t_ns, omega, f = zip(*rows)
    return RecordedImu(np.array(t_ns, dtype=np.int64), np.array(omega), np.array(f),
                       np.full((len(rows), 4), np.nan)), fixes


def same_bits(said, states):
    """Assert that solutions have the stamps and the bits of NavStates."""
    assert np.array_equal(said.t_ns, states.t_ns)
    for k, name in enumerate(FIELDS):
        live = np.array([s.state[k] for s in said.solved])
        assert np.array_equal(live, getattr(states, name)), name


def reference_of(fixes):
    """Return the Reference of PlaceFixes for navigate."""
    return Reference('fix', SampledTrack(np.array([f.t_ns for f in fixes], dtype=np.int64),
                                         np.array([f.place for f in fixes])))


def vehicle(rest_s=20.0, length_s=60.0, rate_hz=50.0, heading=1.2, lat=0.87, noise=(2e-4, 0.01),
            bias=(3e-4, -2e-4, 4e-4), seed=1):
    """
    Return a RecordedImu and PlaceFixes of a level car: at rest, then driving along its heading.

    noise: sigma of rate (rad/s) and specific force (m/s^2) in each sample; bias: of the gyros,
    rad/s.
    """
    rng = np.random.default_rng(seed)
    t = np.arange(round(length_s * rate_hz) + 1) / rate_hz
    pushed = ((t > rest_s) & (t <= rest_s + 8.0)).astype(float)
    speed, n = np.cumsum(pushed) / rate_hz, len(t)
    way = np.cumsum(speed) / rate_hz
    q_nb = quaternion.exponential((0.0, 0.0, np.pi / 2.0 - heading))
    rate = quaternion.rotate_back(q_nb, (0.0, ellipsoid.ROTATION_RATE * np.cos(lat),
                                         ellipsoid.ROTATION_RATE * np.sin(lat)))
    f = np.zeros((n, 3))
    f[:, 0], f[:, 2] = pushed, ellipsoid.gravity(np.sin(lat), 100.0)
    t_ns = 10**18 + np.round(t * 1e9).astype(np.int64)
    imu = RecordedImu(t_ns, rate + np.array(bias) + noise[0] * rng.standard_normal((n, 3)),
                      f + noise[1] * rng.standard_normal((n, 3)), np.full((n, 4), np.nan))
    r_n, r_e = ellipsoid.radii(np.sin(lat))
    some = slice(0, None, round(rate_hz))
    fixes = [PlaceFix(int(stamp) + 3_000_000, float(lat + w * np.cos(heading) / r_n),
                      float(0.1 + w * np.sin(heading) / r_e / np.cos(lat)), 100.0)
             for stamp, w in zip(t_ns[some], way[some])]
    return imu, fixes


def as_sent(fixes):
    """Return PlaceFixes after conversion to messages, which hold degrees."""
    return [f._replace(lat=float(np.radians(np.degrees(f.lat))),
                       lon=float(np.radians(np.degrees(f.lon)))) for f in fixes]
