"""
ROS 2 nodes. This is the only package of ins_sim that imports rclpy.

``main`` is the table of executables; ``nodes`` has one module per node; ``process`` starts,
monitors and ends node processes; ``transport`` has queues and quality of service; ``lock_step``
paces a run by acknowledgements; ``recording`` supports the recorder and the player.
"""
