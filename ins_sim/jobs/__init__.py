"""
Work that is shared out: blocks of a study over processes of this machine or of a Dask cluster.

``blocks`` hands the blocks out and gives their results in order, whoever finishes first;
``executors`` opens what computes them, and ``store`` keeps the finished ones on disk, so that a
study that was interrupted goes on where it was.
"""
