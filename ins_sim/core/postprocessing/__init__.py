"""
Navigation with a recorded IMU: clean the record, rotate it into the vehicle, find a start,
navigate, compare with references.

Start with ``navigate``.
"""
