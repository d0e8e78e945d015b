"""Bodies given by exact tensors of inertia."""

from __future__ import annotations

from typing import Any

from core.bodies.exact_inertia import ExactInertia, symmetric


def of_tensor(tensor: Any) -> ExactInertia:
    """Return a body given by its tensor, shape (3, 3), off-diagonal components -(integral of x y dm)."""
    return ExactInertia(symmetric(tensor))
