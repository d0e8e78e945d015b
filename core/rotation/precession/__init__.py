"""Precession rates, periods and cones of a free body."""
