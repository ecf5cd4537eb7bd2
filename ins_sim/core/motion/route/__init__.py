"""Flights along great circles with coordinated turns, wind, gusts and a weaving heading."""
