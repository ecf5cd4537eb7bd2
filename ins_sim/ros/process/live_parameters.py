"""Parameters that can be set while a node runs."""

from rcl_interfaces.msg import SetParametersResult
from rclpy.parameter import Parameter

from ins_sim.core.numerics.instants import seconds
from ins_sim.settings.catalogue import build, check_value, flatten, from_ros, values_of
from ins_sim.settings.shown import shown
from .net import described
from .parameter_requests import refused


class LiveParameters:
    """
    Lets the SETTABLE parameters of a node be changed while it runs, from its next sample on.

    A request is checked like the settings at the start; its parameters are applied all together
    or not at all. A single number is accepted for three equal axes, and an integer for a float.
    Spans have two lists, start times and end times. If only the start times are set, missing end
    times become the latest possible instant, and surplus ones are dropped.

    Parameters
    ----------
    node : Node with ``settings`` and ``monitor``
    part : object that applies the changes, by default the node
        ``check_change(settings)`` raises ValueError if settings cannot be applied during a run;
        ``effective_ns(name)`` returns the motion time from which a parameter counts, ns, or None
        for the first sample; ``change(settings)`` applies new settings.
    """

    def __init__(self, node, part=None):
        self._node, self._part, self._count = node, part or node, 0
        cls = type(node.settings)
        fields = flatten(cls)
        self._fields = {name: fields[name] for name in cls.SETTABLE}
        node.add_pre_set_parameters_callback(self._spelt)
        node.add_on_set_parameters_callback(self._judge)
        node.add_post_set_parameters_callback(self._take)
        node.monitor.add(lambda: ('', (('parameter changes', self._count),)))

    def _spelt(self, parameters):
        """Return the parameters converted to their declared types where that is possible."""
        found = {}
        for parameter in parameters:
            f = self._fields.get(parameter.name)
            found[parameter.name] = parameter if f is None else _typed(parameter, f)
        for span in type(self._node.settings).SPANS:
            starts, ends = f'{span}.start_s', f'{span}.end_s'
            if starts in found and ends not in found:
                self._fit_ends(found, starts, ends)
        return list(found.values())

    def _fit_ends(self, found, starts, ends):
        """Adjust the number of end times of spans if only the start times are set."""
        given = values_of(self._node.settings)[ends]
        wanted = found[starts].value
        if found[starts].type_ == Parameter.Type.DOUBLE_ARRAY and len(wanted) != len(given):
            last = [self._fields[ends].metadata['high']] * (len(wanted) - len(given))
            found[ends] = Parameter(ends, Parameter.Type.DOUBLE_ARRAY,
                                    [*given[:len(wanted)], *last])

    def _ours(self, parameters):
        return {p.name: from_ros(p.value, self._fields[p.name]) for p in parameters
                if p.name in self._fields}

    def _settings(self, values):
        return build(type(self._node.settings), {**values_of(self._node.settings), **values})

    def _judge(self, parameters):
        """Return whether the parameters can be applied."""
        try:
            for parameter in parameters:
                if parameter.name in self._fields and parameter.type_ == Parameter.Type.NOT_SET:
                    raise ValueError(f'{parameter.name} cannot be deleted; expected a value')
            ours = self._ours(parameters)
            if ours:
                self._part.check_change(self._settings(ours))
        except ValueError as error:
            self._keep_types(parameters)
            return refused(str(error))
        return SetParametersResult(successful=True)

    def _keep_types(self, parameters):
        """Restore the declared types, which rclpy has replaced by those of the refused values."""
        for parameter in parameters:
            if parameter.name in self._fields:
                kept = self._node.get_parameter(parameter.name)
                self._node.describe_parameter(parameter.name).type = kept.type_.value

    def _take(self, parameters):
        """Apply parameters that passed the check, and log from when on they count."""
        node, ours = self._node, self._ours(parameters)
        if not ours:
            return
        try:
            effective = {name: self._part.effective_ns(name) for name in ours}
            node.settings = self._settings(ours)
            self._part.change(node.settings)
        except Exception as error:
            # The values were checked; an unexpected error must not end the node.
            node.monitor.fault(described(error))
            return
        self._count += 1
        node.get_logger().info('; '.join(
            f'{name} is now {self._shown(name)} {_from(effective[name])}' for name in ours))

    def _shown(self, name):
        value, unit = values_of(self._node.settings)[name], self._fields[name].metadata['unit']
        text = shown(list(value) if isinstance(value, tuple) else value)
        return f'{text} {unit}' if unit else text


def _from(t_ns):
    return 'from the first sample on' if t_ns is None else f'from t = {seconds(t_ns)} on'


def _typed(parameter, f):
    """Return a parameter converted to the type of its field f, unchanged if that fails."""
    try:
        value = check_value(parameter.name, from_ros(parameter.value, f), f)
    except ValueError:
        return parameter
    if parameter.type_ == Parameter.Type.NOT_SET:
        return parameter
    if isinstance(value, tuple):
        return Parameter(parameter.name, Parameter.Type.DOUBLE_ARRAY, list(value))
    return Parameter(parameter.name, value=value)
