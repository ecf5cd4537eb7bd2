"""
Numerics of the simulator: no ROS, no files, no command line.

The rooms build on each other in this order: ``numerics``, ``timeseries``, ``attitude``, ``earth``,
``streams``; then ``motion`` and ``sensors`` (the simulator), ``navigation``, ``aiding`` and
``postprocessing`` (algorithms, which never import the simulator), and ``prediction``,
``simulation`` and ``ensemble``, which combine them.
"""
