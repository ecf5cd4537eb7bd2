"""Prediction of drift and position error by the linear theory, without a simulation."""
