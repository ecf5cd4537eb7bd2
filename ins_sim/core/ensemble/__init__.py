"""
Ensembles: many runs of one simulation that differ in their random numbers and initial errors.

Run k has the same bits as the single run with ``run=k``. Start with ``many_runs``: it takes groups
of 16 runs (``group``) through the strapdown side by side (``lanes``) and keeps statistics of their
errors (``statistics``) instead of their histories.
"""
