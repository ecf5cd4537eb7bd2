"""Lock-step: the generator goes on only when its consumers have acknowledged."""
