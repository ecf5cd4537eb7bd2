"""
Motions: position and attitude as functions of time, and the truth derived from them.

Start with ``motion`` (the interface) and ``factory`` (the motion that settings name). ``truth``
differentiates a pose; ``bench``, ``flights``, ``route`` and ``recorded`` are the motions.
"""
