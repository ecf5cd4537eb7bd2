"""
ROS 2 nodes. This is the only room that imports rclpy.

``main`` is the table of executables; ``nodes`` holds one node a file, ``process`` what a node
process
needs to start and end, ``transport`` queues and quality of service, ``lock_step`` pacing by
acknowledgements, ``recording`` recorder and player.
"""
