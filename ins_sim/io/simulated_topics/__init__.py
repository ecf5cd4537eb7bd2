"""Topics of the bag of a simulated run other than truth, readings and solution."""
