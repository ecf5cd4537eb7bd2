"""
Truth from the odometry of another simulator: specific force and rate from poses and twists.

Twists are used if they prove reliable, otherwise the poses alone. Start with ``stage``, then see
``judgement`` (quality of the input), ``twist_knots`` and ``pose_knots`` (the two schemes), and
``piece`` (the motion between two knots). See docs/theory/external_truth.md.
"""
