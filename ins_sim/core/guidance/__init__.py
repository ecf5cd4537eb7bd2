"""
Guidance: autopilots, and the steering that gives them a navigation solution.

``linear_loop`` tells where the loop with an aided navigator is stable, ``error_loop`` flies it in
a reduced form.
"""
