"""Names that nothing has yet."""

from __future__ import annotations

from collections.abc import Container
from itertools import count


def unused(stem: str, taken: Container[str], first: str = "") -> str:
    """Return the first name that is not taken: the stem with `first` at its end, else with 2, 3, ...

    Parameters
    ----------
    stem : str
    taken : container of str
    first : str
        The number of the first of several names; empty where a name that is alone has none.
    """
    names = (stem + (first if number == 1 else str(number)) for number in count(1))
    return next(name for name in names if name not in taken)
