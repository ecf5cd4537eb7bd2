"""Motion along recorded poses: spline, faults and quality of the recording."""
