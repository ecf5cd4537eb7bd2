"""Requests to set parameters, passed to the services of a node object without DDS."""

from types import SimpleNamespace


def service_of(node, name):
    """Return the callback of the service whose name has this ending."""
    found, = (s.callback for s in node.services if s.srv_name.endswith('/' + name))
    return found


def message_of(name, value):
    """Return the message of a parameter; a message is returned unchanged."""
    from rclpy.parameter import Parameter
    if hasattr(value, 'get_fields_and_field_types'):
        return value
    return Parameter(name, value=value).to_parameter_msg()


def ask(node, values):
    """Set parameters {name: value} one by one; return '' or the reason of the refusal for each."""
    request = SimpleNamespace(parameters=[message_of(*one) for one in values.items()])
    answer = service_of(node, 'set_parameters')(request, SimpleNamespace())
    return [_reason(result) for result in answer.results]


def ask_at_once(node, values):
    """Set parameters {name: value}, all or none; return '' or the reason of the refusal."""
    request = SimpleNamespace(parameters=[message_of(*one) for one in values.items()])
    return _reason(service_of(node, 'set_parameters_atomically')(request,
                                                                 SimpleNamespace()).result)


def _reason(result):
    assert result.successful != bool(result.reason)
    return result.reason


def value_of(node, name):
    """Return the value of a parameter; arrays are converted to lists."""
    value = node.get_parameter(name).value
    return list(value) if hasattr(value, '__len__') and not isinstance(value, str) else value
