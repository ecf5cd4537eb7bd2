"""
The settings of every node, by the name of the node.

A node that starts imports only its own settings, because making the classes of all nodes takes
milliseconds.
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
# the instruments that aid, and the navigator that they aid
AIDING = {'velocity_meter': VelocityMeterSettings, 'gnss': GnssSettings,
          'aided_navigator': AidedNavigatorSettings}
# those of a simulation, the one that watches it, and the one that holds them in one process
ALL_NODES = {**NODES, **AIDING, 'truth_adapter': TruthAdapterSettings,
             'recorder': RecorderSettings, 'simulation': OneProcessSettings}
ALL_NAMES = frozenset(name for cls in ALL_NODES.values() for name in flatten(cls))
