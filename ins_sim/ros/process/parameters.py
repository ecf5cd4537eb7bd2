"""Declare the settings of a node as ROS parameters."""

from rcl_interfaces.msg import FloatingPointRange, IntegerRange, ParameterDescriptor
from rclpy.parameter import Parameter

from ins_sim.settings.catalogue import build, flatten, from_ros, is_of_ros, values_of
from ins_sim.settings.suggest import unknown_key
from .parameter_requests import answer_requests


def declare_settings(node, cls):
    """
    Declare the parameters of a settings class, and return the settings.

    The parameters are read-only except those in ``SETTABLE``, see ``live_parameters``. All values
    are checked by the settings catalogue before they are declared. An integer is therefore
    accepted for a float, and live and offline runs report the same errors in the same words.

    Raises
    ------
    ValueError : unknown parameter, wrong type or bad value; the message is one sentence
    """
    fields = flatten(cls)
    given = {name: parameter.value for name, parameter in node._parameter_overrides.items()}
    strange = [name for name in given if name not in fields and not is_of_ros(name)]
    if strange:
        # A parameter file may serve all nodes, so parameters of other nodes are accepted.
        from ins_sim.settings.by_node import ALL_NAMES
        for name in strange:
            if name not in ALL_NAMES:
                raise ValueError(unknown_key(name, ALL_NAMES))
    settings = build(cls, {name: from_ros(value, fields[name]) for name, value in given.items()
                           if name in fields})
    values = values_of(settings)
    node.declare_parameters('', [(name, list(value) if isinstance(value, tuple) else value,
                                  _descriptor(fields[name], value, name in cls.SETTABLE))
                                 for name, value in values.items()],
                            ignore_override=True)
    empty = [name for name in cls.SETTABLE if values[name] == ()]
    if empty:
        node.set_parameters([Parameter(name, Parameter.Type.DOUBLE_ARRAY, []) for name in empty])
    answer_requests(node)
    return settings


def _descriptor(field, value, settable):
    facts = field.metadata
    text = f"{facts['doc']} [{facts['unit']}]" if facts['unit'] else facts['doc']
    # rclpy takes an empty list for bytes, which only a dynamically typed parameter accepts. For
    # settable parameters dynamic typing lets our own check, which names the parameter, refuse
    # a wrong type.
    descriptor = ParameterDescriptor(description=text, read_only=not settable,
                                     dynamic_typing=settable or value == ())
    if facts['choices']:
        descriptor.additional_constraints = 'one of: ' + ', '.join(facts['choices'])
    if facts['size']:
        one = ', or one number for all' if facts['equal_axes'] else ''
        descriptor.additional_constraints = f"{facts['size']} entries{one}"
    if facts['low'] is not None:
        low, high = facts['low'], facts['high']
        if field.type is int:
            descriptor.integer_range = [IntegerRange(from_value=low, to_value=high, step=1)]
        else:
            descriptor.floating_point_range = [FloatingPointRange(from_value=float(low),
                                                                  to_value=float(high))]
    return descriptor
