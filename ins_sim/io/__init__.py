"""Files and bags to objects of the core, and back."""
