"""
Simulator of an inertial measurement unit and strapdown inertial navigation, for ROS 2 and Python.

These conventions hold in the whole package.

Frames
------
i
    Inertial frame of the run, aligned with e at motion time zero.
e
    Earth-centred Earth-fixed (WGS-84): x to (0, 0), z to the north pole.
m
    ``map``: the Cartesian plane tangent to the ellipsoid at the datum, axes East, North, Up.
n
    Local level frame at the vehicle, axes East, North, Up (REP-103, not NED).
b
    ``base_link``: Forward, Left, Up. The instrument frame ``imu_link`` coincides with it.

Names
-----
``C_nb`` and ``q_nb`` map b to n.  ``v_n`` is the velocity relative to the Earth in n;
``omega_ib_b`` is the rate of b relative to i, resolved in b; ``f_ib_b`` is specific force in b.

Units and shapes
----------------
SI units and radians inside.  A public name with another unit ends in it (``delay_us``).
Quaternions are unit, scalar last (x, y, z, w), as in ROS and SciPy.  Leading axes are time (and
run), the last axis holds components: ``(3,)`` is one sample, ``(n, 3)`` its history.

Time
----
Instants are int64 nanoseconds; t_j = t_0 + j dt is computed, never accumulated.  Only differences
become float seconds.  *Motion time* is the stamp minus the epoch, which motion_generator announces
(``time.epoch``, ``time.epoch_s``).

Attitude angles
---------------
psi: counter-clockwise from north in the bench motions (as in Bogdanov and Fomichev 2018),
clockwise (true heading) in the flights.  theta: nose up.  gamma: right wing down.  With the body
axes of that paper (right, forward, up), ``C_nb`` is Rz(psi) Rx(theta) Ry(gamma); see
``ins_sim.core.attitude.angles``.

Public names
------------
The public names are in ``__all__``; each is imported when it is first used, so that ``import
ins_sim`` itself loads neither NumPy nor YAML.  Everything else is imported from its module and may
change before version 1.0.
"""

from importlib import import_module
from typing import Any, TYPE_CHECKING

if TYPE_CHECKING:
    from ins_sim.api.budgets import budget, ErrorBudget
    from ins_sim.api.calibration import DelayEstimate, estimate_delays
    from ins_sim.api.comparisons import compare_filters, FilterComparison
    from ins_sim.api.delays import delay_study, DelayStudy
    from ins_sim.api.ensembles import monte_carlo, MonteCarlo
    from ins_sim.api.inputs import presets, read_settings
    from ins_sim.api.offline import predict, simulate, simulate_aided
    from ins_sim.api.readers import open_bag, open_motion
    from ins_sim.api.recorded import ImuRecord, Navigation, navigate
    from ins_sim.api.results import AidedRun, Run
    from ins_sim.bags.bag_reader import BagReader
    from ins_sim.core.motion.motion import Motion
    from ins_sim.core.prediction.predict import Prediction
    from ins_sim.settings.simulation import AidedSimulationSettings, SimulationSettings

__version__ = '0.2.0'

__all__ = ['AidedRun', 'AidedSimulationSettings', 'BagReader', 'DelayEstimate', 'DelayStudy',
           'ErrorBudget', 'FilterComparison', 'ImuRecord', 'MonteCarlo', 'Motion', 'Navigation',
           'Prediction', 'Run', 'SimulationSettings', 'budget', 'compare_filters', 'delay_study',
           'estimate_delays', 'monte_carlo', 'navigate', 'open_bag', 'open_motion', 'predict',
           'presets', 'read_settings', 'simulate', 'simulate_aided']
_MODULES = {
    'api.budgets': ('ErrorBudget', 'budget'),
    'api.calibration': ('DelayEstimate', 'estimate_delays'),
    'api.comparisons': ('FilterComparison', 'compare_filters'),
    'api.delays': ('DelayStudy', 'delay_study'),
    'api.ensembles': ('MonteCarlo', 'monte_carlo'),
    'api.inputs': ('presets', 'read_settings'),
    'api.offline': ('predict', 'simulate', 'simulate_aided'),
    'api.readers': ('open_bag', 'open_motion'),
    'api.recorded': ('ImuRecord', 'Navigation', 'navigate'),
    'api.results': ('AidedRun', 'Run'),
    'bags.bag_reader': ('BagReader',),
    'core.motion.motion': ('Motion',),
    'core.prediction.predict': ('Prediction',),
    'settings.simulation': ('AidedSimulationSettings', 'SimulationSettings')}


def __getattr__(name: str) -> Any:
    """Import a public name when it is first used (PEP 562)."""
    for module, names in _MODULES.items():
        if name in names:
            value = getattr(import_module(f'{__name__}.{module}'), name)
            globals()[name] = value
            return value
    raise AttributeError(f'module {__name__!r} has no attribute {name!r}')


def __dir__() -> list[str]:
    """Return the names of the module, including those not imported yet."""
    return sorted({*globals(), *__all__})
