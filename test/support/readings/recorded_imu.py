"""Error-free records of an IMU for the tests of post-processing."""

import numpy as np

from ins_sim.core.postprocessing.sources import Sources
from ins_sim.core.motion.factory import make_motion
from ins_sim.core.postprocessing.navigate import navigate
from ins_sim.settings.navigate import NavigateSettings
from ins_sim.core.postprocessing.imu_record import RecordedImu
from ins_sim.core.postprocessing.reference import Reference, SampledTrack
from ins_sim.settings.catalogue import build
from ins_sim import parameter_files

SETTINGS = parameter_files.read([], ['motion.kind:=sinusoids', 'source:=motion'])
MOTION = make_motion(SETTINGS.motion_generator.motion, SETTINGS.motion_generator.datum,
                     SETTINGS.motion_generator.earth)
AIR = {'initial.attitude': 'reference'}
SECOND = 1_000_000_000


def stamps(rate_hz, length_s=20.0, start_s=1.0):
    """Return stamps at a uniform rate, ns."""
    count = round(length_s * rate_hz)
    return round(start_s * SECOND) + np.arange(count + 1, dtype=np.int64) * round(SECOND / rate_hz)


def recorded(t_ns, motion=MOTION):
    """Return the error-free RecordedImu and Reference of the motion at stamps."""
    truth = motion.at(t_ns)
    position = np.stack([truth.lat, truth.lon, truth.height], -1)
    reference = Reference('truth', SampledTrack(t_ns, position),
                          SampledTrack(t_ns, truth.v_n), SampledTrack(t_ns, truth.q_nb))
    return RecordedImu(t_ns, truth.omega_ib_b, truth.f_ib_b,
                       np.full((len(t_ns), 4), np.nan)), reference


def run(imu, reference, **values):
    """Return the Navigation for settings by dotted name, with __ in place of a dot."""
    chosen = build(NavigateSettings, {**AIR, **{k.replace('__', '.'): v
                                                for k, v in values.items()}})
    return navigate(chosen, Sources('the record', imu, 'base_link', reference))


def end_errors(navigation):
    """Return position error, m, and attitude error, rad, at the end of a navigation."""
    comparison = navigation.comparisons[0]
    return (np.linalg.norm(comparison.position.values[-1]),
            np.linalg.norm(comparison.attitude.values[-1]))
