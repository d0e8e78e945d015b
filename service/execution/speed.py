"""How long computations take on this machine, as it is loaded now, in proportion to their prices."""

from __future__ import annotations

MEMORY = 20.0
"""About how many of the last computations enter into the estimate."""


class SpeedCorrection:
    """The correction of the prices of one operation."""

    def __init__(self) -> None:
        # One second of what was predicted, as long as nothing is known.
        self._predicted = self._taken = 1.0

    @property
    def ratio(self) -> float:
        """Time over price."""
        return self._taken / self._predicted

    def learn(self, price: float, seconds: float) -> None:
        """Take a computation into account."""
        weight = 1.0 - 1.0 / MEMORY
        self._predicted = weight * self._predicted + price
        self._taken = weight * self._taken + seconds
