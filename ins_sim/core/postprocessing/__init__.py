"""
Navigation with a recorded IMU: clean the record, mount, find a start, navigate, compare.

Start with ``navigate``.
"""
