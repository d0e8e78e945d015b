"""Free rotation, bodies, planets and the named scenes."""

from __future__ import annotations

from typing import Any

from mpmath import ellipk, findroot, mpf, sqrt

from tests.service.textbook.asked import Asked, Body, equals

PRECESSION = "/v1/rotation/precession"
PROPERTIES = "/v1/bodies/mass-properties"
TRIAXIAL: Body = {
    "body": {"kind": "principal-moments", "moments": [3.0, 2.0, 1.5]},
    "angular_velocity": [0.1, 4.0, 0.1],
}
COIN: Body = {"body": {"kind": "principal-moments", "moments": [1.0, 1.0, 1.5]}, "angular_velocity": [1.0, 0.0, 2.0]}
CYLINDER: Body = {"body": {"kind": "cylinder", "mass": 2.0, "radius": 0.5, "height": 1.0}}
G = mpf("9.81")


def flip(rates: tuple[Any, Any, Any], moments: tuple[Any, Any, Any]) -> Any:
    """Return half a period of a triaxial body: 2 K(k)/n (Landau, Lifshitz, Mechanics, section 37)."""
    c, b, a = moments
    w3, w2, w1 = rates
    energy2 = a * w1**2 + b * w2**2 + c * w3**2
    square = (a * w1) ** 2 + (b * w2) ** 2 + (c * w3) ** 2
    if square < energy2 * b:
        a, c = c, a
    n = sqrt((c - b) * (square - energy2 * a) / (a * b * c))
    m = (b - a) * (energy2 * c - square) / ((c - b) * (square - energy2 * a))
    return 2 * ellipk(m) / n


def root(function: Any, low: Any, high: Any) -> Any:
    return findroot(function, (mpf(low), mpf(high)), solver="anderson")


def middle(value: Any) -> Any:
    return flip((mpf("0.1"), mpf(4), mpf("0.1")), (mpf(3), value, mpf("1.5"))) - 8


def below(r: Any) -> Any:
    d = sqrt(r**2 - mpf("0.36"))
    return 2 * G * d * (1 - mpf("0.6") / r) / (d**2 + mpf("0.12")) - mpf("6.25")


ROTATION = [
    Asked(
        "middle moment for a flip of 8 s",
        PRECESSION,
        TRIAXIAL,
        {"pointer": "/body/moments/1", "between": [2.1, 2.8]},
        equals("/flip_interval", 8),
        [root(middle, "2.2", "2.6")],
        "2 K(k)/n",
        quick=True,
    ),
    Asked(
        "spin for a flip of 5 s",
        PRECESSION,
        TRIAXIAL,
        {"pointer": "/angular_velocity/1", "between": [1, 20]},
        equals("/flip_interval", 5),
        [root(lambda w: flip((mpf("0.1"), w, mpf("0.1")), (mpf(3), mpf(2), mpf("1.5"))) - 5, 3, 15)],
        "2 K(k)/n",
        quick=True,
    ),
    Asked(
        "separatrix",
        PRECESSION,
        TRIAXIAL,
        {"pointer": "/angular_velocity/0", "between": [0.02, 0.09]},
        {"figure": "/flip_interval", "infinite": True},
        [mpf("0.1") * sqrt(mpf("1.5") * mpf("0.5") / (3 * 1))],
        "I1 (I1 - I2) w1^2 = I3 (I2 - I3) w3^2",
    ),
    Asked(
        "spin for a body rate",
        PRECESSION,
        COIN,
        {"pointer": "/angular_velocity/2", "between": [0.5, 5]},
        equals("/body_rate", 1.5),
        [3.0],
        "(I3 - I1)/I1 w3",
        quick=True,
    ),
    Asked(
        "spin for a space rate",
        PRECESSION,
        COIN,
        {"pointer": "/angular_velocity/2", "between": [0.5, 5]},
        equals("/space_rate", 4),
        [sqrt(mpf(15)) / mpf("1.5")],
        "L/I1",
        quick=True,
    ),
    Asked(
        "height of a cylinder of equal moments",
        PROPERTIES,
        CYLINDER,
        {"pointer": "/body/height", "between": [0.2, 2]},
        equals("/inertia/about_center_of_mass/0/0", 0.25),
        [sqrt(mpf(3)) / 2],
        "h = sqrt(3) r",
        quick=True,
    ),
    Asked(
        "radius for a moment",
        PROPERTIES,
        CYLINDER,
        {"pointer": "/body/radius", "between": [0.1, 3]},
        equals("/inertia/about_center_of_mass/2/2", 1),
        [1.0],
        "m r^2/2",
        quick=True,
    ),
    Asked(
        "period of wobble for a flattening",
        "/v1/rotation/wobble",
        {"period": 300, "day": "sidereal"},
        {"pointer": "/period", "between": [100, 1000], "scale": "log"},
        equals("/asymmetry", 0.0025),
        [400.0],
        "1/asymmetry",
        quick=True,
    ),
    Asked(
        "hole for a rate below",
        "/v1/scenes/rod-in-hole",
        {"hole_radius": 1, "length": 1.2, "mass": 2, "gravity": 9.81},
        {"pointer": "/hole_radius", "between": [0.7, 3]},
        equals("/angular_velocity_at_horizontal", 2.5),
        [root(below, "0.7", "0.9"), root(below, "1.5", "3")],
        "w^2 = 2 g d (1 - s/r)/(d^2 + l^2/12), d^2 = r^2 - s^2, s = l/2",
        quick=True,
    ),
    Asked(
        "rate for a growth",
        "/v1/rotation/stability",
        {"body": TRIAXIAL["body"], "rate": 1.0},
        {"pointer": "/rate", "between": [0.5, 10]},
        equals("/equilibria/1/growth_rate", 1),
        [sqrt(mpf(3) * mpf("1.5") / (mpf("0.5") * 1))],
        "sqrt((I2 - I1)(I3 - I2)/(I1 I3)) w",
        quick=True,
    ),
]
