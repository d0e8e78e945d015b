"""Answers to many digits, in balls."""
