"""Numbers with a proven enclosure are computed by a library whose precision belongs to the process: one lock guards it.

References
----------
F. Johansson, "Arb: efficient arbitrary-precision midpoint-radius interval arithmetic", IEEE Transactions on Computers
66 (2017).
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from threading import RLock

from flint import ctx

# Whoever changes the precision holds this, so that no thread computes at another's.
_precision_lock = RLock()


@contextmanager
def precision(bits: int) -> Iterator[None]:
    """Compute in balls of so many bits inside the block."""
    with _precision_lock, ctx.workprec(bits):
        yield
