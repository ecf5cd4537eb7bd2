"""
Parallel computation: blocks of a study on processes of this machine or on a Dask cluster.

``blocks`` distributes the blocks and yields their results in order, whichever finishes first;
``executors`` opens the workers, and ``store`` keeps finished blocks on disk, so that an
interrupted study resumes where it stopped.
"""
