"""
Public functions of ``import ins_sim``, and the objects that they return.

``ins_sim`` imports a module of this package when one of its names is first used. Start with
``offline``.
"""
