"""
Live streams of samples: their faults, matching by stamp, restarts, and truth as a motion.

A stage raises ``faults.StreamFault`` for a sample that it refuses.
"""
