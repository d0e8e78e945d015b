"""Elliptic integrals and Jacobian functions to full precision, compiled: the ground floor of every closed form."""
