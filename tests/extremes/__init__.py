"""Every border of every model, approached from both sides, for every endpoint that computes."""
