"""
Calibration of gyro channels on a bench: delays, biases, scale factors and misalignments.

Start with ``bench_record`` (the readings and the known motion) and ``delays`` (the least squares).
``channel_sums`` forms the normal equations and ``channel_fit`` solves them. ``separability`` tells
which unknowns they cannot distinguish, and ``model_lag`` what the bandwidth of an instrument adds
to a delay.
"""
