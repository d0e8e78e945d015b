"""Described scenes: what a whole answer takes, and a double pendulum beside what others make of it."""
