"""Tests of the methods, on the small systems of `tests.core.systems.systems`."""
