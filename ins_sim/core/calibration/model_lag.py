"""The apparent delay of a gyro due to its bandwidth, from the model of the instrument."""

from dataclasses import fields, replace

import numpy as np

from ins_sim.core.sensors.imu.sampling import consecutive
from ins_sim.core.sensors.imu.triad_errors import TriadErrors
from ins_sim.settings.instrument_errors import GyroErrors
from .bench_record import TrueRates, usable
from .delays import estimate_triad

BANDWIDTH = ('bandwidth_hz', 'bandwidth_order')


def estimate_with_lag(records, errors):
    """Return the TriadEstimate of BenchRecords with the lags of GyroErrors, if there are any."""
    found = estimate_triad(records)
    return replace(found, lags=model_lags(records, errors)) if any(errors.bandwidth_hz) else found


def model_lags(records, errors):
    """
    Return the apparent delays of the channels due to the bandwidth of GyroErrors, (3,) s.

    This is the result of ``estimate_triad`` for BenchRecords of the same motion whose readings
    have no other error; NaN for a channel whose delay the motion does not show.
    """
    lag = GyroErrors(**{f.name: getattr(errors, f.name) for f in fields(GyroErrors)
                        if f.name in BANDWIDTH})
    found = estimate_triad([_lagged(record, lag) for record in records])
    return np.array([np.nan if c.refused else c.delay for c in found.channels])


def _lagged(record, lag):
    record, _ = usable(record)
    rates = TrueRates(record).at(record.imu.t_ns)
    triad = TriadErrors(lag, 0, 0, 'gyro.errors', record.dt_ns * 1e-9)
    t_ns, omega = record.imu.t_ns, np.empty_like(rates)
    place = (t_ns - t_ns[0] + record.dt_ns // 2) // record.dt_ns
    for part in consecutive(place):
        omega[part] = triad.advance(int(place[part.start]), rates[part], rates[part],
                                    t_ns[part] * 1e-9)
    return replace(record, imu=replace(record.imu, omega=omega))
