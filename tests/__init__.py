"""Tests; they mirror the code file for file."""
