"""
The command ``ins_sim``: ``main`` finds the verb, and one file holds each verb.

A verb is a module with HELP (its line in the list of verbs), DESCRIPTION, ``add_arguments`` and
``run``. It imports what its work needs inside its functions, so that help and refused arguments
come at once.
"""
