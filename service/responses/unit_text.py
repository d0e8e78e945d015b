"""Units as drawings write them: with a fraction bar, rad/s, where the API declares powers, rad s^-1."""

from __future__ import annotations


def unit_text(unit: str) -> str:
    """Return a unit with what divides behind a bar.

    Parameters
    ----------
    unit : str
        Factors with spaces between them, as `core.quantities` writes them: ``"kg m^2 s^-1"``. What has a bar already
        stays as it is.
    """
    above, below = [], []
    for factor in unit.split():
        name, minus, power = factor.partition("^-")
        if minus:
            below.append(name if power == "1" else f"{name}^{power}")
        else:
            above.append(factor)
    if not below:
        return unit
    divisor = below[0] if len(below) == 1 else f"({' '.join(below)})"
    return f"{' '.join(above) or '1'}/{divisor}"
