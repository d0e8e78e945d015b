"""What data do not determine, in words."""

from __future__ import annotations

from collections.abc import Sequence

from core.fits.statistics import INVOLVED, Undetermined


def combination(found: Undetermined, names: Sequence[str]) -> str:
    """Return a sentence on what may be changed without the data showing it.

    Parameters
    ----------
    names : sequence of str
        Of the numbers, in the order of the direction.
    """
    parts = [
        f"{name} by {share:+.3g} %"
        for name, share in zip(names, found.direction.tolist(), strict=True)
        if abs(share) > INVOLVED
    ]
    together = " and ".join(parts)
    if found.uncertainty is not None:
        size = 100.0 * found.uncertainty
        return f"a change of {together} is not told from none: its standard error is {size:.3g} %"
    changes = "changes" if len(parts) == 1 else "together change"
    return f"a change of {together} {changes} nothing that these data show"
