"""Equilibria of a free body and their stability."""
