"""Functions of balls that are recorded as one operation where one of their numbers is recorded.

What records is no ball itself (`core.multibody.members.recorded_balls`). A set-up is computed with balls everywhere,
and with recorded ones for the numbers that members of a study have each of their own.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from functools import wraps
from typing import Any, TypeVar, cast

from flint import arb

F = TypeVar("F", bound=Callable[..., Any])


def recorded_among(values: Iterable[Any]) -> Any:
    """Return a value that is recorded, of values and of sequences of them; None where none is."""
    for value in values:
        kind = type(value)
        if kind is arb:
            continue
        if kind is list or kind is tuple:
            found = recorded_among(value)
            if found is not None:
                return found
        elif hasattr(value, "record"):
            return value
    return None


def recordable(function: F) -> F:
    """Have a function recorded as one operation: its value is another for other numbers."""

    @wraps(function)
    def call(*arguments: Any) -> Any:
        recorded = recorded_among(arguments)
        return function(*arguments) if recorded is None else recorded.applied(function, *arguments)

    return cast(F, call)


def deciding(function: F) -> F:
    """Have the value of a function recorded as a decision by which members are told apart."""

    @wraps(function)
    def call(*arguments: Any) -> Any:
        recorded = recorded_among(arguments)
        return function(*arguments) if recorded is None else recorded.decided(function, *arguments)

    return cast(F, call)
