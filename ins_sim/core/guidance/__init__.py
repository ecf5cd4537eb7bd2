"""
Guidance: autopilots, and the steering that passes a navigation solution to them.

``linear_loop`` computes where the closed loop with an aided navigator is stable; ``error_loop``
simulates this loop in a reduced form.
"""
