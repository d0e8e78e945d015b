"""The energy ellipsoid, polhodes on it, and initial states of one energy."""
