"""Example bodies: those of the source questions, and real ones with the sources of their data."""

from __future__ import annotations

import math
from collections.abc import Mapping
from types import MappingProxyType

import numpy as np

from core.bodies import Body
from core.bodies.composite import Composite, Part
from core.bodies.measured import PointMasses, PrincipalMoments
from core.bodies.solids import Cuboid, Cylinder, Ellipsoid

INCH = 0.0254
STEEL = 7850.0
"""Density of carbon steel, EN 1993-1-1, section 3.2.6 (kg m^-3)."""


def t_handle_points() -> PointMasses:
    """Return the T-handle of the source questions: 300 unit masses on a tube along z and on half of a tube along y.

    The surfaces are grids of 10 x 20 and 5 x 20 points; their angles run from 0 to 2 pi inclusive, so the points
    along the seam occur twice.
    """
    angle, along = np.meshgrid(np.linspace(0, 2 * np.pi, 20), np.linspace(0, 1, 10))
    tube = np.array([np.cos(angle), np.sin(angle), 5 * along])
    bar = tube - np.array([0, 0, 2.5]).reshape((3, 1, 1))
    stem = np.array([tube[0, :5], tube[2, :5], tube[1, :5]])
    points = np.concatenate((bar, stem), 1)
    return PointMasses(1.0, points.reshape(3, -1).T)


def t_handle() -> Composite:
    """Return a T-handle of two steel cylinders: a bar along z and a stem along y that starts on the bar's surface.

    The bar is 100 mm long and 12 mm thick, the stem 50 mm long and 10 mm thick. The narrow gap between the stem's flat
    end and the bar's round side is not filled.
    """
    bar, stem = Cylinder(radius=0.006, height=0.1, density=STEEL), Cylinder(radius=0.005, height=0.05, density=STEEL)
    # A quarter turn about x takes z to -y.
    return Composite((Part(bar), Part(stem, (0.0, 0.006 + 0.025, 0.0), (1.0, 1.0, 0.0, 0.0))))


def coin() -> Cylinder:
    """Return a 1 euro coin: 23.25 mm wide, 2.33 mm thick, 7.5 g, as if homogeneous and smooth.

    Council Regulation (EU) No 729/2014, annex I.
    """
    return Cylinder(radius=0.02325 / 2, height=0.00233, mass=0.0075)


def american_football() -> Composite:
    """Return an American football: a wall 4 mm thick between two ellipsoids, with mean official dimensions.

    Length 11 to 11 1/4 in, short circumference 21 to 21 1/4 in, weight 14 to 15 oz: Official Playing Rules of the
    National Football League, rule 2, section 1. The wall, of bladder and leather together, is our estimate.
    """
    wall, ounce = 0.004, 0.028349523125
    half_length, radius = 11.125 * INCH / 2, 21.125 * INCH / (2 * math.pi)
    outer, inner = (radius, radius, half_length), (radius - wall, radius - wall, half_length - wall)
    filled, hollow = math.prod(outer), math.prod(inner)
    density = 14.5 * ounce / (4 / 3 * math.pi * (filled - hollow))
    return Composite(
        (
            Part(Ellipsoid(semi_axes=outer, density=density)),
            Part(Ellipsoid(semi_axes=inner, density=density), hole=True),
        )
    )


def deck_of_cards() -> Cuboid:
    """Return a deck of 52 poker cards: 88 x 63 x 16 mm, 94 g."""
    return Cuboid(edges=(0.088, 0.063, 0.016), mass=0.094)


def phone() -> Cuboid:
    """Return a mobile phone: 147.6 x 71.6 x 7.8 mm, 171 g, as if homogeneous.

    iPhone 15, technical specifications by its maker (2023).
    """
    return Cuboid(edges=(0.1476, 0.0716, 0.0078), mass=0.171)


def earth() -> PrincipalMoments:
    """Return the Earth by its principal moments.

    W. Chen, W. B. Shen, "New estimates of the inertia tensor and rotation of the triaxial nonrigid Earth", J. Geophys.
    Res. 115 (2010), B12419.
    """
    return PrincipalMoments((8.010083e37, 8.010260e37, 8.036481e37))


EXAMPLES: Mapping[str, Body] = MappingProxyType(
    {
        "t-handle-points": t_handle_points(),
        "t-handle": t_handle(),
        "coin": coin(),
        "american-football": american_football(),
        "deck-of-cards": deck_of_cards(),
        "phone": phone(),
        "earth": earth(),
    }
)
"""The bodies by name."""
