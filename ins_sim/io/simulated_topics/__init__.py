"""What a bag of a simulated run holds beside truth, readings and solution."""
