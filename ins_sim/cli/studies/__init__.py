"""Verbs that evaluate many runs or compare with published results, one file for each."""
