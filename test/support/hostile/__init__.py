"""What tests and tools/fuzz_nodes.py share: nodes fed by hand, and messages that nobody sends."""
