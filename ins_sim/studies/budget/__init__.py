"""
Evaluation of an error budget: its quantities, requirements, and a comparison with an ensemble.

``core.prediction.budget`` propagates. ``quantities`` defines what is shown, ``requirement``
answers a requirement, ``sensitivities`` gives the change of an error with a parameter, and
``beside`` compares with an ensemble.
"""
