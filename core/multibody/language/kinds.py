"""The catalogue of the kinds of connections."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType

from core.multibody.language.connection import Connection
from core.multibody.language.contacts import Contact, Rolling
from core.multibody.language.forces import (
    AppliedForce,
    Blow,
    Damper,
    Field,
    Gravitation,
    InverseSquare,
    Motor,
    SpinningFrame,
    Spring,
    Torque,
    TorsionSpring,
)
from core.multibody.language.joints import (
    BallJoint,
    Cylindrical,
    GuideCurve,
    Pin,
    Relation,
    Rod,
    Screw,
    Slider,
    Universal,
    Weld,
)
from core.multibody.language.strings import Chain, String

KINDS: Mapping[str, type[Connection]] = MappingProxyType(
    {
        cls.kind: cls
        for cls in (
            Pin,
            BallJoint,
            Weld,
            Slider,
            Cylindrical,
            Screw,
            Universal,
            Rod,
            Relation,
            Rolling,
            GuideCurve,
            Contact,
            String,
            Chain,
            Spring,
            TorsionSpring,
            Gravitation,
            InverseSquare,
            Damper,
            Motor,
            SpinningFrame,
            AppliedForce,
            Torque,
            Field,
            Blow,
        )
    }
)
"""The kinds that a description may name."""
