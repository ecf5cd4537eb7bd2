"""
The command ``ins_sim``: ``main`` selects the verb; each verb has a file of its own.

A verb is a module with HELP (its line in the list of verbs), DESCRIPTION, ``add_arguments`` and
``run``. It imports what ``run`` needs inside functions, so that help texts and errors in arguments
are printed without delay.
"""
