"""
Offline simulation: motion, sensors, navigation and their errors in one process.

``inertial`` runs the unaided chain; ``aided`` adds velocity meter, GNSS and the aided navigator.
"""
