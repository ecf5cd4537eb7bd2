"""
Live streams of samples: faults, matching by time stamp, restarts, and motion from streamed truth.

A stage raises ``faults.StreamFault`` for a sample that it cannot use.
"""
