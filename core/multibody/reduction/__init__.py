"""Passes that make a table smaller without changing its motion."""
