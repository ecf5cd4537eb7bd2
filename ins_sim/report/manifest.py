"""Manifest of a run: its random numbers, and on which machines it is bit-identical."""

import platform

import yaml

from ins_sim.core.numerics.noise import NOISE

EVERYWHERE, HERE = 'every x86-64 machine', 'this machine'
PROMISED = ('x86_64', 'AMD64')
RECORDING = 'the splines of a recorded motion are solved by LAPACK'
SIGNAL = 'the signals of the velocity meter are made by Fourier transforms'
OBJECT = 'the motion is an object of the caller'


def manifest(settings, aided=None, own_motion=False, thin=1):
    """
    Return the text of manifest.yaml.

    Parameters
    ----------
    settings : SimulationSettings
    aided : AidedSimulationSettings or None
    own_motion : whether the motion was given as an object instead of by the settings
    thin : the files contain every thin-th output instant
    """
    reasons = []
    if own_motion:
        reasons.append(OBJECT)
    elif settings.motion_generator.motion.kind == 'recording':
        reasons.append(RECORDING)
    if aided is not None and aided.velocity_meter.mode == 'signal':
        reasons.append(SIGNAL)
    if platform.machine() not in PROMISED:
        reasons.append(f'it was made on {platform.machine()}')
    told = {'noise': NOISE, 'bits': HERE if reasons else EVERYWHERE}
    if reasons:
        told['bits_reason'] = '; '.join(reasons)
    if thin > 1:
        told['thin'] = int(thin)
    return yaml.safe_dump(told, sort_keys=False)
