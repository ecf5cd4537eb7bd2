"""Reports of the studies: rows, tables for the terminal and figures."""
