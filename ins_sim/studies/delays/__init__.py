"""
The study of Bogdanov and Fomichev (2018): effect of delayed gyro channels on the solution.

``figure`` defines what a figure shows, ``runs`` simulates and predicts one run, ``maps`` computes
the drift over rates and directions, ``study`` assembles the figures.
"""
