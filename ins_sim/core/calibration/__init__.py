"""
Calibration of gyro channels on a bench: delays, biases, scale factors and misalignments.

Start with ``bench_record`` (the readings and the known motion) and ``delays`` (the least squares).
``channel_sums`` makes the normal equations, ``channel_fit`` solves them, ``separability`` says
what they cannot tell apart, and ``model_lag`` what the bandwidth of an instrument adds to a delay.
"""
