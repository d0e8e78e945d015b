"""The faults of a description: of every part that has one, so that its author learns of all of them at once."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

from core.errors import InvalidParameter, SlackAtStart


class FaultsOfParts:
    """Collects the faults of parts that are read or built independently of each other, each fault once."""

    def __init__(self) -> None:
        self._found: list[InvalidParameter] = []

    @contextmanager
    def part(self) -> Iterator[None]:
        """Collect the fault of a part. A string that is slack at the start is none: the scene has phases then."""
        try:
            yield
        except SlackAtStart:
            raise
        except InvalidParameter as fault:
            known = {(one.path, one.rule) for one in self._found}
            self._found += [one for one in (fault, *fault.further) if (one.path, one.rule) not in known]

    def raised(self) -> None:
        """Raise the first fault with the others, if there are any."""
        if self._found:
            first, *others = self._found
            first.further = tuple(others)
            raise first
