"""Fixtures of the tests of motions."""

import pytest
from support.recorded_flights import load, record

from ins_sim.core.motion.factory import make_motion
from ins_sim.settings.motion import MotionSettings
from ins_sim.settings.place import Datum, Earth


@pytest.fixture(scope='module')
def flown(tmp_path_factory):
    """Return a recorded motion that moves in every degree of freedom, and 20 s of its truth."""
    path = tmp_path_factory.mktemp('flown') / 'aggressive.csv'
    motion = make_motion(MotionSettings(kind='aggressive'), Datum(),
                         Earth())
    return load(record(path, motion, 20.0, 20.0)), motion
