"""Metrics, logs and records of requests."""
