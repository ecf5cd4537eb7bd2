"""Executable velocity_meter; the node is imported only after the signals are handled."""

import sys

from .runtime import node_main


def main(args=None):
    """Run the node and return the exit code."""
    return node_main(_load, args)


def _load():
    from .velocity_meter_node import VelocityMeterNode
    return VelocityMeterNode


if __name__ == '__main__':
    sys.exit(main())
