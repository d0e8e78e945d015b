"""Reasons why a quantity of a precession does not exist."""

from __future__ import annotations

NOTHING_TURNS = "nothing turns"
SPHERE = "the three moments are equal, so that every axis is one of symmetry"
TRIAXIAL = "the three moments differ, so that no axis is one of symmetry"
STEADY_ANYHOW = "the angular velocity is constant"
STEADY_BY_AXIS = "the spin lies along a principal axis and is constant"
STEADY_IN_BODY = "the angular velocity is constant in the body"
ON_THE_SEPARATRIX = "on the separatrix the body tends to the middle axis and never returns"
NO_MIDDLE_AXIS = "two moments are equal, so that there is no middle axis"
SAME_DIRECTION = "two of the directions coincide"
