"""Convert files and bags to objects of ``ins_sim.core``, and back."""
