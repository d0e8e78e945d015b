"""Tests of the elliptic functions and integrals."""
