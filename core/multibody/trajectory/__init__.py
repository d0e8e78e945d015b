"""Columns of a trajectory with their errors; events, integrals and searches along a smooth motion."""
