"""
Prediction of errors by the linear theory, without a simulation.

``predict`` computes the drift and position error that delays cause; ``budget`` computes the error
budget, the covariance by source.
"""
