"""Annotations that are formed while the program runs, which no type checker can follow."""

from __future__ import annotations

from typing import Annotated, Any, Union

ANNOTATED: Any = Annotated
UNION: Any = Union
"""The forms themselves, to be subscribed; by which methods that is done differs among versions of Python."""
