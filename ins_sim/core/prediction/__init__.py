"""
Prediction of errors by linear theory, without a simulation.

``predict`` computes the drift and position error caused by delays; ``budget`` is the error
budget: the covariance by source.
"""
