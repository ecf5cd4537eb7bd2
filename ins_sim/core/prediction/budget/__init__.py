"""
The error budget of a free strapdown: linear covariance by source, along the motion.

``linear_budget.error_budget`` computes it. ``sources`` and ``fixed_sources`` list the error
sources in the settings, ``time_lanes`` holds the motion; ``interval_responses``, ``accumulation``
and ``propagation`` propagate the errors. ``ins_sim.studies.budget`` evaluates a budget.
"""
