"""What a study says: its rows, its tables for the terminal and its figures, one module a study."""
