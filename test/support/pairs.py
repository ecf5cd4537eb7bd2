"""A pair of dynamically tuned gyros with its errors, and its steady output."""

from support.studies import settings

from ins_sim.core.sensors.tuned_gyro.instrument import PairInstrument

DTG = {'gyro.model': 'dtg', 'output': 'integrated', 'input': 'integrated'}


def instrument(values=(), **more):
    """Return the PairInstrument built from settings at 100 Hz."""
    return PairInstrument(settings({**DTG, **dict(values)}, **more).imu_sensor)
