"""Definitions of tracks by formula: a surface on which a function of the place is zero, and a curve by a parameter."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import ClassVar

import numpy as np

from core.multibody.audit.bodies import Path, Reader
from core.multibody.audit.definition import Definition
from core.multibody.audit.formula_definitions import value_or_formula
from core.multibody.audit.formulas import FormulaValue, Read, names_of_place
from core.multibody.audit.joints import AXES
from core.multibody.audit.placement import STEP, Motion, Numbers, Place, Placement, dot, length, rate
from core.multibody.language.joints import GuideCurve

COARSE, FINE, MOVING = 128, 16384, 256
"""Parameters at which a curve is looked at for the nearest to a place: at first, at most, and on one that moves."""

WIDEST = 12
"""Doublings of the range of parameters in which that is looked for, from one on."""

ROUNDS = 12
"""Of Gauss and Newton from there: each about doubles the digits, the last ones carry the imaginary step."""

NEAR, BESIDE = 1e-6, 1e-2
"""Share of their size up to which a place is on a curve, and beside it where no other part is nearer."""


@dataclass(frozen=True)
class OnFormula(Definition):
    """A place stays on what formulas say; the force on it is answered in components."""

    kind: ClassVar[str] = "track"
    place: Place

    def apart(self, placement: Placement) -> Numbers:
        """Return what the place misses, shape () or (d,)."""
        raise NotImplementedError

    def efforts(self, placement: Placement, motion: Motion) -> Mapping[str, Numbers]:
        """See `Definition.efforts`."""
        rates = self.place.velocity(placement, motion)
        return {f"{self.name}.{axis}": rates[..., i] for i, axis in zip(range(rates.shape[-1]), AXES, strict=False)}

    @property
    def forces(self) -> tuple[str, ...]:
        """See `Definition.forces`."""
        return tuple(f"{self.name}.{axis}" for axis, _ in zip(AXES, self.place.offset, strict=False))


@dataclass(frozen=True)
class OnSurface(OnFormula):
    """A formula of the place is zero; the force is along its gradient."""

    formula: FormulaValue

    @property
    def driven(self) -> float:
        """See `Definition.driven`."""
        return self.formula.quickness(0.0) if "t" in self.formula.inputs else 0.0

    def works(self) -> bool:
        """See `Definition.works`."""
        return "t" in self.formula.inputs

    def apart(self, placement: Placement) -> Numbers:
        """See `OnFormula.apart`."""
        return self.formula.value(placement, {})

    def held(self, placement: Placement) -> Mapping[str, Numbers]:
        """See `Definition.held`."""
        return {"attitude": self.apart(placement)}

    def holding(self, placement: Placement, motion: Motion) -> Mapping[str, Numbers]:
        """See `Definition.holding`: along the gradient, of which any component may be answered alone."""
        return dict.fromkeys(self.forces, rate(self.apart, placement, motion))

    def derived(self, placement: Placement, motion: Motion, forces: Mapping[str, Numbers]) -> Mapping[str, Numbers]:
        """See `Definition.derived`: the part of the force along the gradient is all of it."""
        slopes = [self.formula.slope(axis, placement) for axis in AXES[: len(self.forces)]]
        normal = np.stack(np.broadcast_arrays(*slopes), axis=-1)
        force = np.stack([forces[name] for name in self.forces], axis=-1)
        along = normal * (dot(force, normal) / dot(normal, normal))[..., None]
        return {name: along[..., i] for i, name in enumerate(self.forces)}


@dataclass(frozen=True)
class OnCurve(OnFormula):
    """A place is on a curve by a parameter; the force is across its direction.

    Attributes
    ----------
    components : tuple of FormulaValue
        Over the name u.
    first : float
        Parameter about which that of the place is looked for.
    """

    components: tuple[FormulaValue, ...]
    first: float

    @property
    def driven(self) -> float:
        """See `Definition.driven`."""
        return max(one.quickness(0.0) for one in self.components) if self.works() else 0.0

    def works(self) -> bool:
        """See `Definition.works`."""
        return any("t" in one.inputs for one in self.components)

    def apart(self, placement: Placement) -> Numbers:
        """See `OnFormula.apart`: from the nearest point of the curve."""
        u = self.parameter(placement)
        return self.place.at(placement) - self._at(u, placement)

    def held(self, placement: Placement) -> Mapping[str, Numbers]:
        """See `Definition.held`."""
        return {"coincidence": self.apart(placement)}

    def holding(self, placement: Placement, motion: Motion) -> Mapping[str, Numbers]:
        """See `Definition.holding`."""
        rates = rate(self.apart, placement, motion)
        return {name: rates[..., i] for i, name in enumerate(self.forces)}

    def derived(self, placement: Placement, motion: Motion, forces: Mapping[str, Numbers]) -> Mapping[str, Numbers]:
        """See `Definition.derived`: the force has no part along the curve."""
        way = self._slope(self.parameter(placement), placement)
        force = np.stack([forces[name] for name in self.forces], axis=-1)
        across = force - way * (dot(force, way) / dot(way, way))[..., None]
        return {name: across[..., i] for i, name in enumerate(self.forces)}

    def _at(self, u: Numbers, placement: Placement) -> Numbers:
        found = [one.value_with({"u": u}, placement) for one in self.components]
        return np.stack(np.broadcast_arrays(u, *found)[1:], axis=-1)

    def _slope(self, u: Numbers, placement: Placement) -> Numbers:
        """Return the change of the curve by its parameter; of the real part alone, where that is moved."""
        return self._at(u.real + 1j * STEP, _without_step(placement)).imag / STEP

    def parameter(self, placement: Placement) -> Numbers:
        """Return the parameter of the point that is nearest to the place, shape ()."""
        place = self.place.at(placement)
        u = self._nearby(np.real(place), _without_step(placement))
        for _ in range(ROUNDS):
            way = self._slope(u, placement)
            u = u + dot(way, place - self._at(u, placement)) / dot(way, way)
        return u

    def _nearby(self, place: Numbers, placement: Placement) -> Numbers:
        """Return the parameter at which a curve passes nearest to each of some places, looking ever farther for it."""
        extent = 1.0 + float(np.abs(place).max(initial=0.0))
        nearest, least = np.full(place.shape[:-1], self.first), np.full(place.shape[:-1], np.inf)
        better = 0
        for k in range(WIDEST):
            count = MOVING if self.works() else min(COARSE * 2**k, FINE)
            found = self._best(self.first + 2.0**k * np.linspace(-1.0, 1.0, count), place, placement)
            for _ in range(ROUNDS):
                way = self._slope(found, placement)
                found = found + dot(way, place - self._at(found, placement)) / dot(way, way)
            off = length(place - self._at(found, placement))
            better = k if bool(np.any(off < least / 2.0)) else better
            nearest, least = np.where(off < least, found, nearest), np.fmin(off, least)
            if bool(np.all(least < NEAR * extent)) or (k > better + 1 and bool(np.all(least < BESIDE * extent))):
                break
        return np.asarray(nearest)

    def _best(self, grid: Numbers, place: Numbers, placement: Placement) -> Numbers:
        """Return the parameters of a grid that are nearest to some places."""
        rows = place.reshape(-1, 1, place.shape[-1])
        if self.works():
            # The curve is another one at each place.
            every = [self._at(np.full(place.shape[:-1], u), placement).reshape(rows.shape) for u in grid]
            points = np.concatenate(every, axis=1)
        else:
            points = self._at(grid, self.components[0].start)[None]
        far = length(points - rows)
        best: Numbers = grid[np.argmin(np.where(np.isfinite(far), far, np.inf), axis=1)]
        return best.reshape(place.shape[:-1])


def _without_step(placement: Placement) -> Placement:
    return {
        name: pose if pose.time is None else pose._replace(time=np.real(pose.time)) for name, pose in placement.items()
    }


def track_by_formula(connection: GuideCurve, reader: Reader, name: str, path: Path) -> Definition | None:
    """Return the definition of a track by formula; None of others."""
    on, where = connection.on, (*path, "on")
    place = reader.place(connection.place, (*path, "place"))
    if "surface" in on:
        own = {axis: read for axis, read in names_of_place(place).items() if axis in AXES}
        return OnSurface(name, place.bodies, place, value_or_formula(reader, on["surface"], own, (*where, "surface")))
    if "curve" not in on:
        return None
    parameter: dict[str, Read] = {"u": lambda placement, _: np.zeros(())}
    components = tuple(
        value_or_formula(reader, value, parameter, (*where, "curve", i)) for i, value in enumerate(on["curve"])
    )
    start = 0.0 if on.get("start") is None else reader.number(on["start"], (*where, "start"))
    found = OnCurve(name, place.bodies, place, components, start)
    return replace(found, first=float(found.parameter(reader.start)))
