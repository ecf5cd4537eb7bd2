"""Tables for the terminal, figures, and folders of a run."""
