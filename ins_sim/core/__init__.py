"""
Numerics of the simulator: no ROS, no files, no command line.

The packages depend on each other in this order: ``numerics``, ``timeseries``, ``attitude``,
``earth``, ``streams``; then ``motion`` and ``sensors`` (the simulator), ``navigation``, ``aiding``
and ``postprocessing`` (algorithms, which never import the simulator); then ``prediction``,
``simulation`` and ``ensemble``, which combine them.
"""
