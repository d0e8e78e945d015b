"""How much work a computation does: a count that its loops add to, and a limit that ends it.

A computation that shares a thread with others (an event loop) must end soon whatever it was predicted to cost. So every
loop of core whose length is chosen by the client, or is known only once it has ended, adds what it is about to do to
the count that holds for this thread or task. Beyond the limit it is ended by `WorkLimitReached`, which is no
`MechanicsError`: nothing that handles a refusal may take it for one, and the answer must not depend on the limit.

One unit is at most about ten microseconds: a sample, an evaluation of an equation, a row that is read, a point that is
drawn. What costs more counts for more. Without a limit nothing is counted.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from math import inf


class WorkLimitReached(Exception):
    """The computation needs more work than it may do here; nothing is wrong with what was asked."""


class Meter:
    """The work of one computation.

    Parameters
    ----------
    limit : float
        Units that may be done.

    Attributes
    ----------
    spent : float
        Units done or about to be done.
    """

    __slots__ = ("limit", "spent")

    def __init__(self, limit: float) -> None:
        self.limit, self.spent = limit, 0.0


_meter: ContextVar[Meter | None] = ContextVar("meter", default=None)


@contextmanager
def work_limit(limit: float) -> Iterator[Meter]:
    """Count the work inside of the block, and end it beyond `limit` units.

    Raises
    ------
    WorkLimitReached
        From inside of the block, before the work that would exceed the limit is done.
    """
    meter = Meter(limit)
    token = _meter.set(meter)
    try:
        yield meter
    finally:
        _meter.reset(token)


def spend(units: float) -> None:
    """Count work that is about to be done, or raise `WorkLimitReached`."""
    meter = _meter.get()
    if meter is not None:
        meter.spent += units
        if meter.spent > meter.limit:
            raise WorkLimitReached


def remaining() -> float:
    """Return the units that may still be done; infinite without a limit."""
    meter = _meter.get()
    return inf if meter is None else meter.limit - meter.spent
