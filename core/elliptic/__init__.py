"""Elliptic integrals and Jacobian elliptic functions to full precision, compiled."""
