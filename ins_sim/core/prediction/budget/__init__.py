"""
The error budget of a free strapdown: linear covariance by source, along the motion.

``linear_budget.error_budget`` computes it. ``sources`` and ``fixed_sources`` list what the
settings have of errors, ``time_lanes`` holds the motion; ``interval_responses``, ``accumulation``
and ``propagation`` propagate. What is read from a budget is in ``ins_sim.studies.budget``.
"""
