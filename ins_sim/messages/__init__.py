"""
Pack and read the messages of all topics as CDR bytes, without ROS.

Start with ``topics`` (the table of topics) and ``cdr`` (the layouts).
"""
