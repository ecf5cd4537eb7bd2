"""
Prediction of errors by the linear theory, without a simulation.

``predict`` has the drift and position error that delays cause; ``budget`` the error budget, the
covariance by source.
"""
