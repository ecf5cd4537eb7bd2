"""
Truth from the odometry of another simulator: force and rate from poses, and twists if they serve.

``stage`` first; then ``judgement`` (what the input is worth), ``twist_knots`` and ``pose_knots``
(the two schemes), and ``piece`` (the motion between two knots). See docs/theory/external_truth.md.
"""
