"""
The study of Bogdanov and Fomichev (2018): what delays of gyro channels do to the solution.

``figure`` says what a figure shows, ``runs`` flies and predicts one run, ``maps`` has the drift
over rates and directions, ``study`` puts the figures together.
"""
