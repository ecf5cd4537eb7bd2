"""
The strapdown of a live IMU without truth: start, order of the samples, gaps, solution.

Read ``navigator`` first.  The rules are those of ``core.postprocessing``, which has the whole
recording at once; here the samples come one by one.
"""
