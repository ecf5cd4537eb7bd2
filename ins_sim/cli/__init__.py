"""The command ``ins_sim``: ``main`` chooses the verb, one file holds each verb."""
