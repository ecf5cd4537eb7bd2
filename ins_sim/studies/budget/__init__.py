"""
What is read from an error budget: its quantities, what must improve, and an ensemble beside it.

``core.prediction.budget`` propagates; ``quantities`` names what is shown, ``requirement`` answers
a requirement, ``sensitivities`` has the change of an error with a parameter, and ``beside``
compares with an ensemble.
"""
