"""What is known of an operation of the service."""

from __future__ import annotations

from typing import NamedTuple


class Operation(NamedTuple):
    """An operation.

    Attributes
    ----------
    method, path, summary : str
    media : str
        Media type of its answer.
    once : bool
        Whether it begins something that a repeated request must not begin again.
    """

    method: str
    path: str
    summary: str
    media: str = "application/json"
    once: bool = False

    def at(self, **places: str) -> Operation:
        """Return the operation with the braces of its path filled."""
        return self._replace(path=self.path.format(**places)) if places else self
