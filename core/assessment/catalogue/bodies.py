"""Mistakes about mass and inertia: the point, the axis, the shape."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from typing import Any

import numpy as np

from core.assessment.mistakes import Figure, Mistake
from core.errors import Path

ABOUT_CENTER, ABOUT_ORIGIN = "about_center_of_mass", "about_origin"
PRINCIPAL, PRINCIPAL_ABOUT_ORIGIN = "principal", "principal_about_origin"
OTHER_POINT = {
    ABOUT_CENTER: ABOUT_ORIGIN,
    ABOUT_ORIGIN: ABOUT_CENTER,
    PRINCIPAL: PRINCIPAL_ABOUT_ORIGIN,
    PRINCIPAL_ABOUT_ORIGIN: PRINCIPAL,
}
RADII = ("radius", "radii", "hole_radius", "outer_radius", "inner_radius", "ring_radius", "tube_radius")


def with_body(figure: Figure, change: Callable[[Mapping[str, Any]], Mapping[str, Any] | None]) -> Iterator[Any]:
    """Yield the figure of the question with another body, if `change` has one."""
    body = figure.request.get("body") if isinstance(figure.request, dict) else None
    other = change(body) if isinstance(body, dict) else None
    if other is not None:
        yield figure.answered(figure.request | {"body": other})


def _other_point(figure: Figure) -> Path | None:
    path = tuple(OTHER_POINT.get(str(step), step) for step in figure.path)
    return path if path != figure.path else None


def _about_another_point(figure: Figure) -> Iterator[Any]:
    path = _other_point(figure)
    if path is not None:
        yield figure.beside(*path)
    elif figure.subject.startswith("rotation/"):
        yield from with_body(figure, lambda body: None if "about" in body else {**body, "about": "origin"})
        yield from with_body(figure, lambda body: without(body, "about") if body.get("about") == "origin" else None)
        yield from with_body(figure, _moments_about_origin)


def _moments_about_origin(body: Mapping[str, Any]) -> Mapping[str, Any] | None:
    """Return a body with the principal moments of point masses about the origin, each along the body axis nearest."""
    if body.get("kind") != "point-masses" or not isinstance(body.get("positions"), list) or "about" in body:
        return None
    positions = np.array(body["positions"], dtype=np.float64)
    masses = np.broadcast_to(np.array(body.get("masses", 1.0), dtype=np.float64), len(positions))
    second = (masses[:, None] * positions).T @ positions
    moments, axes = np.linalg.eigh(np.trace(second) * np.eye(3) - second)
    order = np.abs(axes).argmax(axis=1)
    if len(set(order.tolist())) < 3:
        return None
    return {"kind": "principal-moments", "moments": moments[order].tolist()}


def without(table: Mapping[str, Any], name: str) -> dict[str, Any]:
    """Return a table without one of its entries."""
    return {key: entry for key, entry in table.items() if key != name}


def _parallel_axis_wrong(figure: Figure) -> Iterator[Any]:
    """Yield the right value with the parallel axis term once more (about the origin) or with the wrong sign."""
    path = _other_point(figure)
    other = None if path is None or figure.reference.form not in ("number", "matrix") else figure.beside(*path)
    if other is not None:
        # About the origin: the term twice, and subtracted. About the centre of mass: not subtracted but added.
        term = figure.right - other
        yield figure.right + term
        yield other - term


def _products_of_inertia(figure: Figure) -> Iterator[Any]:
    if figure.reference.form == "matrix" and figure.right.shape == (3, 3):
        yield 2.0 * np.diag(np.diag(figure.right)) - figure.right
    elif not figure.subject.startswith("bodies/"):
        yield from with_body(figure, _mirrored)


def _mirrored(body: Mapping[str, Any]) -> Mapping[str, Any] | None:
    rows = body.get("tensor")
    if not isinstance(rows, list):
        return None
    return {**body, "tensor": [[x if i == j else -x for j, x in enumerate(row)] for i, row in enumerate(rows)]}


def _distinct_points(body: Mapping[str, Any]) -> Mapping[str, Any] | None:
    positions, masses = body.get("positions"), body.get("masses", 1.0)
    if body.get("kind") != "point-masses" or isinstance(masses, list) or not isinstance(positions, list):
        return None
    # What differs by rounding alone is the same point to who drops repeated ones.
    kept = list({tuple(round(x, 9) + 0.0 for x in point): point for point in positions}.values())
    return {**body, "positions": kept} if len(kept) < len(positions) else None


def _hollow(body: Mapping[str, Any]) -> Mapping[str, Any] | None:
    shells = {"ball": "spherical-shell", "cylinder": "cylindrical-shell"}
    kind = body.get("kind")
    if kind in shells and "mass" in body:
        thin = {"outer_radius": body["radius"], "inner_radius": body["radius"] * (1.0 - 1e-7)}
        return {**without(body, "radius"), "kind": shells[kind], **thin}
    full = {shell: kind for kind, shell in shells.items()}
    if kind in full and "mass" in body:
        rest = without(without(body, "outer_radius"), "inner_radius")
        return {**rest, "kind": full[kind], "radius": body["outer_radius"]}
    return None


def _diameter(figure: Figure) -> Iterator[Any]:
    for factor in (2.0, 0.5):
        changed = _scaled(figure.request, factor)
        if changed != figure.request:
            yield figure.answered(changed)


def _scaled(node: Any, factor: float, inside: bool = False) -> Any:
    if isinstance(node, dict):
        return {name: _scaled(entry, factor, name in RADII) for name, entry in node.items()}
    if isinstance(node, list):
        return [_scaled(entry, factor, inside) for entry in node]
    return node * factor if inside and type(node) in (int, float) else node


OF_BODIES = (
    Mistake(
        "inertia-about-another-point",
        "The inertia about the origin for that about the centre of mass, or the reverse.",
        _about_another_point,
    ),
    Mistake(
        "parallel-axis", "The term of the parallel axis theorem twice, or with the wrong sign.", _parallel_axis_wrong
    ),
    Mistake(
        "products-of-inertia-sign", "Products of inertia with the opposite sign.", _products_of_inertia, credit=0.5
    ),
    Mistake(
        "repeated-points-dropped",
        "Point masses that coincide counted once.",
        lambda figure: with_body(figure, _distinct_points),
        credit=0.5,
    ),
    Mistake(
        "shell-for-solid", "A thin shell for a solid body, or the reverse.", lambda figure: with_body(figure, _hollow)
    ),
    Mistake("diameter-for-radius", "A diameter in the place of a radius, or the reverse.", _diameter),
)
