"""
Settings classes of all nodes, by node name.

A node imports only its own settings when it starts, because creating the classes of all nodes
takes several milliseconds.
"""

from .aided_navigator import AidedNavigatorSettings
from .catalogue import flatten
from .gnss import GnssSettings
from .imu import ImuSensorSettings
from .motion import MotionGeneratorSettings
from .node import OneProcessSettings
from .recorder import RecorderSettings
from .strapdown import StrapdownSettings
from .truth_adapter import TruthAdapterSettings
from .velocity_meter import VelocityMeterSettings

NODES = {'motion_generator': MotionGeneratorSettings, 'imu_sensor': ImuSensorSettings,
         'strapdown': StrapdownSettings}
# The aiding sensors and the navigator that they aid.
AIDING = {'velocity_meter': VelocityMeterSettings, 'gnss': GnssSettings,
          'aided_navigator': AidedNavigatorSettings}
# All nodes, with the adapter of other simulators, the recorder and the one-process simulation.
ALL_NODES = {**NODES, **AIDING, 'truth_adapter': TruthAdapterSettings,
             'recorder': RecorderSettings, 'simulation': OneProcessSettings}
ALL_NAMES = frozenset(name for cls in ALL_NODES.values() for name in flatten(cls))
