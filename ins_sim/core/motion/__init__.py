"""
Motions: position and attitude as functions of time, and the truth derived from them.

Start with ``motion`` (the interface) and ``factory`` (makes the motion that the settings name).
``truth`` differentiates a pose; ``bench``, ``flights``, ``route``, ``guided`` and ``recorded`` are
the motions.
"""
