"""
Guidance: autopilots, and the steering that supplies them with a navigation solution.

``linear_loop`` computes where the closed loop with an aided navigator is stable; ``error_loop``
simulates it in a reduced form.
"""
