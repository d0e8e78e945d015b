"""Polynomials of the coordinates, and linear equations, in balls, in pairs of doubles and in doubles."""
