"""
Convert a VelocityFix to messages: the complete record, and the velocity for display.

The record is a DiagnosticArray with one status (docs/design/velocity_record.md), stamped at the
end of the window. Instants are stamps in ns, and floats are written by repr, so that they are
read back bit for bit.
"""

from ins_sim.core.timeseries.fixes import VALID, VelocityFix
from . import diagnostic_array, topics
from .diagnostic_array import Status
from .plausible import check_arrival, check_stamp

NAME = 'velocity_meter'
# Length of foreign texts and statuses in messages.
TEXT, MOST = 80, 3
_FLOATS = (('velocity', ('velocity_x', 'velocity_y')), ('sigma', ('sigma_x', 'sigma_y')),
           ('tau', ('tau12', 'tau23')), ('g', ('g12', 'g23')))


def pack_fix(fix, epoch_ns, names=None):
    """
    Return the message velocity_meter/record of a VelocityFix.

    epoch_ns is the stamp of motion time zero; for names see ``Topic.named``, None for the default
    ones.
    """
    values = [('window_start_ns', str(fix.start_ns + epoch_ns)),
              ('window_end_ns', str(fix.end_ns + epoch_ns)), ('cycles', str(fix.cycles)),
              ('tan_alpha', repr(float(fix.tan_alpha)))]
    values += [(key, repr(float(value))) for field, keys in _FLOATS
               for key, value in zip(keys, getattr(fix, field))]
    values += [('status', fix.status), ('arrival_ns', str(fix.arrival_ns + epoch_ns))]
    level = diagnostic_array.OK if fix.valid else diagnostic_array.WARN
    frame, = topics.METER_RECORD.named(names or {}).frames
    status = Status(level, NAME, fix.status, '', tuple(values))
    return diagnostic_array.pack_diagnostics(fix.end_ns + epoch_ns, frame, [status])


def read_fix(data, epoch_ns):
    """Return the VelocityFix of a message; raise ValueError if it is invalid."""
    _, _, statuses = diagnostic_array.read_diagnostics(data)
    name = topics.METER_RECORD.name
    if len(statuses) != 1 or statuses[0].name != NAME:
        found = [status.name[:TEXT] for status in statuses[:MOST]]
        raise ValueError(f'{name} holds the statuses {found}; expected one of {NAME}')
    values = dict(statuses[0].values)

    def number(key, kind):
        text = values.get(key)
        try:
            return kind(values[key])
        except (KeyError, ValueError):
            raise ValueError(f'{name}: {key} is {text if text is None else repr(text[:TEXT])}; '
                             f'expected {"a whole number" if kind is int else "a number"}'
                             ) from None

    start_ns, end_ns, arrival_ns = (number(key, int) for key in (
        'window_start_ns', 'window_end_ns', 'arrival_ns'))
    for t_ns in (start_ns, end_ns):
        check_stamp(name, t_ns)
    check_arrival(name, end_ns, arrival_ns)
    pairs = {field: tuple(number(key, float) for key in keys) for field, keys in _FLOATS}
    return VelocityFix(start_ns - epoch_ns, end_ns - epoch_ns, number('cycles', int),
                       tan_alpha=number('tan_alpha', float),
                       status=values.get('status', VALID)[:TEXT],
                       arrival_ns=arrival_ns - epoch_ns, **pairs)


def velocity_one(fix):
    """Return motion time (the middle of the window) and the runs of velocity_meter/velocity."""
    (x, y), (sigma_x, sigma_y) = fix.velocity, fix.sigma
    return (fix.start_ns + fix.end_ns) // 2, (x, y, fix.up), (sigma_x * sigma_x,), (
        sigma_y * sigma_y,)
