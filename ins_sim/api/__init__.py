"""
The public functions of ``import ins_sim``, and the objects they return.

``ins_sim`` imports a module of this room when one of its names is used first. Start with
``offline``.
"""
