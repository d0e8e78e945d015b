"""A ball, or a place, and a box in space that do not pass one another."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from core.multibody.audit.contacts import Touching
from core.multibody.audit.placement import Motion, Numbers, Place, Placement, Undefined, dot, rate


@dataclass(frozen=True)
class OnBox(Touching):
    """A ball that does not pass a box.

    Attributes
    ----------
    place : Place
        The centre of the ball.
    middle : Place
        Of the box.
    half : tuple of float
        Half of its sizes along its axes (m).
    radius : float
        Of the ball (m).
    """

    place: Place
    middle: Place
    half: tuple[float, ...]
    radius: float

    @property
    def reach(self) -> float:
        """See `Definition.reach`."""
        return self.radius + max(self.half)

    def gap(self, placement: Placement) -> Numbers:
        """Return the distance of the ball from the box (m), shape (); inside, less than the nearest face."""
        assert self.middle.body is not None, "a box belongs to a body"
        axes = placement[self.middle.body].rotation
        if axes is None:
            raise Undefined("a box whose attitude is not known")
        apart = self.place.at(placement) - self.middle.at(placement)
        x = (np.swapaxes(axes, -1, -2) @ apart[..., None])[..., 0]
        beyond = np.where(x.real < 0.0, -x, x) - np.array(self.half)
        outside = np.where(beyond.real > 0.0, beyond, 0.0)
        square = dot(outside, outside)
        far = square.real > 0.0
        nearest = np.take_along_axis(beyond, np.argmax(beyond.real, axis=-1)[..., None], axis=-1)[..., 0]
        found: Numbers = np.where(far, np.sqrt(np.where(far, square, 1.0)), nearest) - self.radius
        return found

    def gaps(self, placement: Placement) -> Mapping[str, Numbers]:
        """See `Definition.gaps`."""
        return {f"{self.name}.normal": self.gap(placement)}

    def efforts(self, placement: Placement, motion: Motion) -> Mapping[str, Numbers]:
        """See `Definition.efforts`."""
        return {f"{self.name}.normal": rate(self.gap, placement, motion)}
