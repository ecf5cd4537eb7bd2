"""
Read and write rosbag2 bags, MCAP and SQLite, without ROS.

Start with ``bag_reader`` and ``bag_writer``. This package handles only the format; ``ins_sim.io``
converts bags to motions and records.
"""
