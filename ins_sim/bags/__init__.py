"""
rosbag2 bags, MCAP and SQLite, read and written without ROS.

Start with ``bag_reader`` and ``bag_writer``. Only the format stands here; ``ins_sim.io`` turns
bags
into motions and records.
"""
