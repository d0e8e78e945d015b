"""The coefficients of what is one-sided, as they are written."""

from __future__ import annotations

from collections.abc import Sequence

from core.multibody.audit.bodies import Path, Reader
from core.multibody.audit.definition import Touch
from core.multibody.audit.joints import AXES
from core.multibody.language.written import Number


def touch_of(
    reader: Reader,
    name: str,
    path: Path,
    restitution: Number | None,
    friction: Number | Sequence[Number] | None = None,
    law: str | None = None,
) -> Touch:
    """Return the coefficients of a contact or a string."""
    static = kinetic = 0.0
    if isinstance(friction, Sequence) and not isinstance(friction, str):
        static, kinetic = (reader.number(x, (*path, "friction", i)) for i, x in enumerate(friction))
    elif friction is not None:
        static = kinetic = reader.number(friction, (*path, "friction"))
    names: tuple[str, ...] = ()
    if static and reader.dimension == 2:
        names = (f"{name}.friction",)
    elif static:
        names = tuple(f"{name}.friction.{axis}" for axis in AXES)
    bounces = 0.0 if restitution is None else reader.number(restitution, (*path, "restitution"))
    return Touch(static, kinetic, bounces, names, law or reader.scene.impacts)
