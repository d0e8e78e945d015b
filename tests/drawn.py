"""How much of what is drawn at random or listed at length is tested: a sample each time, all of it by `make thorough`.

The sample is the same in every run. What once found a fault is written out, as an example or a test, and always runs.
"""

import os
from collections.abc import Iterable
from random import Random
from typing import TypeVar

ALL = "THOROUGH" in os.environ
SHARE = 4
"""One in so many is tested in each run."""
FEWEST, SHORT = 20, 8
"""Examples of a property, and entries of a list, that are always tested."""

T = TypeVar("T")


def draws(examples: int) -> int:
    """Return how many of so many random examples are drawn."""
    return examples if ALL else min(examples, max(FEWEST, examples // SHARE))


def sampled(listed: Iterable[T], name: str) -> list[T]:
    """Return a part of a list in its order; lists of different names have different parts."""
    entries = list(listed)
    if ALL:
        return entries
    count = min(len(entries), max(SHORT, len(entries) // SHARE))
    chosen = Random(name).sample(range(len(entries)), count)
    return [entries[i] for i in sorted(chosen)]
