"""
What rcl makes of parameter files and assignments: a process that asks rclpy for a table of them.

Standard input: JSON, a list of [arguments of a node behind --ros-args, full name of the node];
standard output: JSON, for each {name: [type, value]}, or the text of its refusal.
"""

import json
import sys

import rclpy
from rclpy.context import Context
from rclpy.impl.implementation_singleton import rclpy_implementation
from rclpy.parameter import Parameter


def ask(arguments, name):
    """Return the parameters that a node of a full name gets."""
    context = Context()
    namespace, _, node = name.rpartition('/')
    try:
        rclpy.init(args=['node', '--ros-args', *arguments], context=context,
                   signal_handler_options=rclpy.SignalHandlerOptions.NO)
    except RuntimeError as error:
        return str(error)
    try:
        with context.handle:
            handle = rclpy_implementation.Node(node, namespace or '/', context.handle, None, True,
                                               False)
            with handle:
                got = handle.get_parameters(Parameter)
    finally:
        context.try_shutdown()
    return {key: [parameter.type_.name, plain(parameter.value)]
            for key, parameter in got.items()}


def plain(value):
    """Return a value as JSON has it; numbers that are none as texts."""
    if hasattr(value, 'tolist'):
        value = value.tolist()
    if isinstance(value, (list, tuple)):
        return [plain(v) for v in value]
    return repr(value) if isinstance(value, float) else value


if __name__ == '__main__':
    json.dump([ask(*case) for case in json.load(sys.stdin)], sys.stdout)
