"""Zeros in time: of everything that is watched or searched for, on Taylor polynomials with a band of error."""
