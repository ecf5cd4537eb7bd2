"""
Ensembles: many runs of one simulation that differ in their random numbers and initial errors.

Run k is the single run with ``run=k``, to the bit. ``many_runs`` is the place to start: it takes
groups of 16 runs (``group``) through the strapdown side by side (``lanes``) and keeps statistics
of their errors (``statistics``) instead of their histories.
"""
