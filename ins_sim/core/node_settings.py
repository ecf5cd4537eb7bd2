"""
The settings of every node there is.

Apart from settings.py, for a node that starts needs its own alone, and to make the classes of all
takes milliseconds.
"""

from .aided_settings import AidedNavigatorSettings
from .bag_settings import RecorderSettings
from .catalogue import flatten
from .gnss_settings import GnssSettings
from .settings import NODES
from .velocity_meter_settings import VelocityMeterSettings

# the instruments that aid, and the navigator that they aid
AIDING = {'velocity_meter': VelocityMeterSettings, 'gnss': GnssSettings,
          'aided_navigator': AidedNavigatorSettings}
# those of a simulation, and the one that watches it
ALL_NODES = {**NODES, **AIDING, 'recorder': RecorderSettings}
ALL_NAMES = frozenset(name for cls in ALL_NODES.values() for name in flatten(cls))
