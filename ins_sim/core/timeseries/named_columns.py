"""Names and units of the components of each field of a history."""

import numpy as np

ENU, BODY, QUATERNION = ('east', 'north', 'up'), ('x', 'y', 'z'), ('x', 'y', 'z', 'w')
METER = ('mounting_rad', 'scale_x', 'scale_z')
# {field of a history: (components, unit as written in names)}
COLUMNS: dict[str, tuple[tuple[str, ...], str]] = {
    'lat': ((), 'rad'), 'lon': ((), 'rad'), 'height': ((), 'm'), 'v_n': (ENU, 'm_s'),
    'q_nb': (QUATERNION, ''), 'omega_ib_b': (BODY, 'rad_s'), 'f_ib_b': (BODY, 'm_s2'),
    'omega': (BODY, 'rad_s'), 'f': (BODY, 'm_s2'), 'parity': ((), 'rad_s'),
    'attitude': (ENU, 'rad'), 'velocity': (ENU, 'm_s'), 'position': (ENU, 'm'),
    'drift': (ENU, 'rad_s'), 'attitude_sigma': (ENU, 'rad'), 'velocity_sigma': (ENU, 'm_s'),
    'position_sigma': (ENU, 'm'), 'estimates': (METER, ''), 'estimates_sigma': (METER, '')}
# {unit as written in names: unit}
UNITS = {'rad': 'rad', 'm': 'm', 'm_s': 'm/s', 'rad_s': 'rad/s', 'm_s2': 'm/s^2', '': '1'}


def columns(field: str, values: np.ndarray) -> dict[str, np.ndarray]:
    """Return {name of a column: (n,) array} for one field of a history."""
    components, unit = COLUMNS[field]
    if not components:
        return {f'{field}_{unit}': values}
    names = ('_'.join(filter(None, (field, component, unit))) for component in components)
    return dict(zip(names, np.moveaxis(values, -1, 0)))


def history_columns(history) -> dict[str, np.ndarray]:
    """Return {name of a column: (n,) array} for a History, without its instants."""
    table: dict[str, np.ndarray] = {}
    for field, values in history.arrays().items():
        if field != 't_ns':
            table.update(columns(field, values))
    return table
