"""Kepler's problem by its anomaly, at the working precision of mpmath: ellipses, and hyperbolas of both signs.

References
----------
L. D. Landau, E. M. Lifshitz, Mechanics, section 15.
"""

from __future__ import annotations

from typing import Any

from mpmath import asinh, atan2, cos, cosh, mp, mpf, pi, sin, sinh, sqrt


def orbit(place: Any, rate: Any, mu: Any, moments: Any) -> tuple[Any, Any, Any]:
    """Return places and velocities of an orbit in the plane at some times, and its period (None of a hyperbola)."""
    (x, y), (u, w) = place, rate
    r, h = sqrt(x * x + y * y), x * w - y * u
    energy = (u * u + w * w) / 2 - mu / r
    e = sqrt(1 + 2 * energy * h * h / mu**2)
    a = abs(mu / (2 * energy))
    n = sqrt(abs(mu) / a**3)
    ellipse, sign = energy < 0, 1 if mu > 0 else -1
    b = a * sqrt(abs(1 - e * e))

    def along(s):
        """Return the place along the axes of the orbit, its rate with the anomaly, and the mean anomaly."""
        if ellipse:
            return (a * (cos(s) - e), b * sin(s)), (-a * sin(s), b * cos(s)), s - e * sin(s)
        return (
            (a * (sign * e - cosh(s)) * sign, b * sinh(s)),
            (-sign * a * sinh(s), b * cosh(s)),
            e * sinh(s) - sign * s,
        )

    product = (x * u + y * w) / sqrt(abs(mu) * a) / e
    start = atan2(product, (1 - r / a) / e) if ellipse else asinh(product)
    (p, q), _, mean = along(start)
    q = q if h > 0 else -q
    # The direction of the pericentre, from the place at the start.
    c, s = (p * x + q * y) / r**2, (p * y - q * x) / r**2
    places, rates = [], []
    for t in moments:
        target = mean + n * mpf(t)
        at = solved(lambda k: along(k)[2], target, n * r / sqrt(abs(mu) / a))
        (p, q), (dp, dq), _ = along(at)
        speed = n * a / sqrt(p * p + q * q)
        turned = [(v, w if h > 0 else -w) for v, w in ((p, q), (dp * speed, dq * speed))]
        place, rate = ((c * v - s * w, s * v + c * w) for v, w in turned)
        places.append(place)
        rates.append(rate)
    return places, rates, 2 * pi / n if ellipse else None


def solved(rising: Any, target: Any, scale: Any) -> Any:
    """Return where a function that rises everywhere has a value, by bisection."""
    low, high = -abs(scale), abs(scale)
    while rising(low) > target:
        low *= 2
    while rising(high) < target:
        high *= 2
    for _ in range(4 * mp.dps):
        middle = (low + high) / 2
        low, high = (middle, high) if rising(middle) < target else (low, middle)
    return (low + high) / 2
