"""Verbs that compute over many runs, or compare with a published table; one file holds each."""
