"""Tests of integration, on small systems of their own."""
