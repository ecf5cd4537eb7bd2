"""
Navigation with a live IMU and without truth: start, order of the samples, gaps, solution.

Read ``navigator`` first. The rules are those of ``core.postprocessing``, which has the whole
recording in advance; here the samples arrive one by one.
"""
