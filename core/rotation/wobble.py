"""The free wobble of a nearly spherical planet: from its period to its asymmetry and ellipticity, and back."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from math import sqrt
from sys import float_info
from typing import Annotated, Literal

from core.errors import InvalidParameter
from core.quantities import Unit

Day = Literal["sidereal", "solar"]

SOLAR_DAY_IN_ROTATIONS = 1.00273790935
"""Rotations of the Earth in a mean solar day (S. Aoki et al., Astronomy and Astrophysics 105 (1982) 359)."""


LARGEST = Fraction(float_info.max)


@dataclass(frozen=True)
class EarthFigures:
    """What is measured of the Earth, to stand beside a model.

    Attributes
    ----------
    axis_ratio : float
        Equatorial over polar radius.
    asymmetry : float
        (C - A)/A.
    asymmetry_of_shape : float
        What (C - A)/A would be with this axis ratio, were the density a scaled sphere's: the Earth's layers are the
        rounder the deeper they lie.
    rigid_period_sidereal, rigid_period_solar : float
        Period of the wobble if the Earth were rigid (days).
    observed_period_solar : float
        Chandler's period (days).
    sources : tuple of str
        Of the measured figures.
    why : str
        What explains the difference between the rigid and the observed period.
    """

    axis_ratio: Annotated[float, Unit("1")] = 1.00336409
    asymmetry: Annotated[float, Unit("1")] = 0.00328455
    asymmetry_of_shape: Annotated[float, Unit("1")] = 0.00335843
    rigid_period_sidereal: Annotated[float, Unit("d")] = 304.46
    rigid_period_solar: Annotated[float, Unit("d")] = 303.62
    observed_period_solar: Annotated[float, Unit("d")] = 433.0
    sources: tuple[str, ...] = (
        "axis_ratio: World Geodetic System 1984, a = 6378137 m, 1/f = 298.257223563",
        "asymmetry: H/(1 - H), dynamical ellipticity H = (C - A)/C = 0.0032737949 of the IAU 2000 nutation "
        "(P. M. Mathews, T. A. Herring, B. A. Buffett, J. Geophys. Res. 107 (2002) 2068)",
        "observed_period_solar: 433.1 +- 1.7 days (R. O. Vicente, C. R. Wilson, J. Geophys. Res. 102 (1997) 20439)",
    )
    why: str = (
        "A rigid Earth would wobble in 304 days; it is observed to take about 433. The Earth yields: its elastic "
        "mantle and its oceans follow the wobbling axis and lengthen the period; its fluid core hardly takes part and "
        "shortens it. The wobble is damped, and kept alive by ocean and atmosphere, and a yearly forced motion is "
        "added to it: its path is no circle. Euler's equations are right, for a rigid and isolated body. A density "
        "that is not uniform changes none of this: every tensor of inertia has principal axes."
    )


EARTH = EarthFigures()


@dataclass(frozen=True)
class Wobble:
    """A wobble and the body that has it.

    Attributes
    ----------
    period : float
        In days of the kind `day`.
    day : {"sidereal", "solar"}
    rotations : float
        The period in rotations of the body, which is 1/asymmetry.
    asymmetry : float
        (I1 - I)/I of the moment about the axis of figure and the other two.
    ellipticity : float
        Major over minor axis, a/c, if the density is a spherically symmetric one, scaled along the axis.
    flattening : float
        (a - c)/a.
    earth : EarthFigures
    """

    period: float
    day: Day
    rotations: float
    asymmetry: float
    ellipticity: float
    flattening: float
    earth: EarthFigures = EARTH


def from_period(period: float, day: Day = "sidereal") -> Wobble:
    """Return the oblate body whose axis wobbles with a period.

    Euler's equations give the body rate (I1 - I)/I w for a spin w about the axis of figure, so the asymmetry is one
    over the period in rotations. For a density f(x^2/a^2 + y^2/a^2 + z^2/c^2), I1 ~ 2a^2 and I ~ a^2 + c^2, so that
    a/c = sqrt((1 + e)/(1 - e)).

    Parameters
    ----------
    period : float
        In days, more than one rotation, as a wider asymmetry is no body's.
    day : {"sidereal", "solar"}
        A sidereal day is one rotation.

    Raises
    ------
    InvalidParameter
        If no body wobbles so.
    """
    return _wobble(period, day, rotations_of_period(period, day))


def rotations_of_period(period: float, day: Day = "sidereal") -> Fraction:
    """Return a period in rotations, exactly; raises as `from_period` does."""
    if not 0.0 < period < float("inf"):
        raise InvalidParameter("period", "be finite and greater than 0 days")
    rotations = Fraction(period) * length_of(day)
    if rotations > LARGEST:
        raise InvalidParameter("period", "be less than 1.79e308 rotations", remedy="give the period in days")
    if rotations <= 1:
        raise InvalidParameter(
            "period",
            "be more than one rotation: (I1 - I)/I < 1 for every oblate body",
            remedy="give the period in days",
        )
    return rotations


def length_of(day: Day) -> Fraction:
    """Return a day in rotations."""
    return Fraction(SOLAR_DAY_IN_ROTATIONS) if day == "solar" else Fraction(1)


def from_ellipticity(ellipticity: float, day: Day = "sidereal") -> Wobble:
    """Return the wobble of a body with a given ratio a/c of its axes, greater than 1; the inverse of `from_period`.

    Raises
    ------
    InvalidParameter
        If the ratio is not greater than 1.
    """
    rotations = rotations_of_ellipticity(ellipticity)
    return _wobble(float(rotations / length_of(day)), day, rotations)


def rotations_of_ellipticity(ellipticity: float) -> Fraction:
    """Return the period in rotations that belongs to a ratio of axes, exactly; raises as `from_ellipticity` does."""
    # Beyond this the asymmetry (I1 - I)/I is one to the last digit of a double.
    if not 1.0 < ellipticity < 1e8:
        raise InvalidParameter("ellipticity", "be greater than 1 and less than 1e8: a/c of an oblate body")
    # e = (r^2 - 1)/(r^2 + 1), with r^2 - 1 = (r - 1)(r + 1) formed exactly.
    r = Fraction(ellipticity)
    return (r * r + 1) / ((r - 1) * (r + 1))


def _wobble(period: float, day: Day, rotations: Fraction) -> Wobble:
    asymmetry = 1 / rotations
    ellipticity = sqrt((rotations + 1) / (rotations - 1))
    # 1 - c/a = (1 - c^2/a^2)/(1 + c/a), and c^2/a^2 = (1 - e)/(1 + e).
    flattening = float(2 * asymmetry / (1 + asymmetry)) / (1.0 + 1.0 / ellipticity)
    return Wobble(period, day, float(rotations), float(asymmetry), ellipticity, flattening)
