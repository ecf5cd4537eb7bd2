"""Motion through recorded poses: spline, faults and quality of the recording."""
