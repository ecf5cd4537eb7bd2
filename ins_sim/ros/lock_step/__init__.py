"""Lock-step: the generator sends more samples only when its consumers have acknowledged."""
