"""
Messages of the topics as CDR bytes, without ROS: layouts, topics, and records as messages.

Start with ``topics`` (the table of topics) and ``cdr`` (the layouts).
"""
