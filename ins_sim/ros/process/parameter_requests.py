"""
Services that set the parameters of a node; each refusal is explained in one sentence.

They replace those of rclpy, which do not name an unknown parameter, and in which a value of an
invalid type ends the node.
"""

from functools import partial

from rcl_interfaces.msg import SetParametersResult
from rcl_interfaces.srv import SetParameters, SetParametersAtomically
from rclpy.parameter import Parameter

from ins_sim.settings.catalogue import is_of_ros
from ins_sim.settings.shown import listed
from ins_sim.settings.suggest import unknown_key
from .said import short


def answer_requests(node):
    """Replace the callbacks of the services that set the parameters of a node."""
    for service in node.services:
        if service.srv_type is SetParameters:
            service.callback = partial(_set_each, node)
        elif service.srv_type is SetParametersAtomically:
            service.callback = partial(_set_at_once, node)


def _set_each(node, request, response):
    response.results = [_set(node, [message]) for message in request.parameters]
    return response


def _set_at_once(node, request, response):
    response.result = _set(node, request.parameters)
    return response


def _set(node, messages):
    """Set parameters, all or none; return the SetParametersResult."""
    names = node.list_parameters([], 0).names
    for message in messages:
        if message.name not in names:
            return refused(unknown_key(message.name, names))
        if node.describe_parameter(message.name).read_only:
            return refused(_read_only(node, message.name, names))
    if not messages:
        return SetParametersResult(successful=True)
    asked = listed(message.name for message in messages)
    try:
        result = node.set_parameters_atomically([Parameter.from_parameter_msg(message)
                                                 for message in messages])
    except Exception as error:
        return refused(f'{asked} cannot be set: {error}')
    if result.successful or any(message.name in result.reason for message in messages):
        return result
    return refused(f'{asked} cannot be set: {result.reason}')


def _read_only(node, name, names):
    settable = [one for one in names if not is_of_ros(one)
                and not node.describe_parameter(one).read_only]
    expected = f'one of {", ".join(settable)}' if settable else 'no parameter of this node'
    return (f'{name} is read-only, because it is read at the start; can be set while the node '
            f'runs: {expected}')


def refused(sentence):
    """Return the SetParametersResult of a refusal, with its reason."""
    return SetParametersResult(successful=False, reason=short(sentence))
