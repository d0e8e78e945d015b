"""Figures of an answer as functions of the numbers of its question, and their derivatives."""
