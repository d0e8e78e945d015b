"""A running service."""

from tests.examples.conftest import service

__all__ = ["service"]
