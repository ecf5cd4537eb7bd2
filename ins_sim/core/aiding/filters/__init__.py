"""Filters of the aided navigator; ``base`` is their interface, ``eskf`` the default."""
