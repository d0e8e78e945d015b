"""Pieces of a motion that are expanded at once, and the signs of quantities on them."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from core.arrays import Floats, Integers

_USUAL = 0.1
"""Share of pieces that is shorter than expected: what is left of these is expanded one by one."""

MUCH_LONGER = 2.0
"""How many times as long as those before pieces are tried at most."""


@dataclass(frozen=True)
class Signs:
    """What is known of one quantity on some pieces: its curve, and the segments of each piece."""

    curves: Floats
    counts: Integers
    ends: Floats
    signs: Integers


@dataclass(frozen=True)
class Batch:
    """Pieces that are expanded at once, and what every quantity does on them.

    Attributes
    ----------
    lengths : ndarray, shape (p,)
    natural : ndarray, shape (p,)
        How long they could be.
    usual : float
        How long most of them could be at least.
    plain : ndarray of bool, shape (p,)
        Where everything is above zero.
    of : dict of int to Signs
        By the number of the quantity.
    """

    lengths: Floats
    natural: Floats
    usual: float
    plain: np.ndarray
    of: dict[int, Signs]


def segments(own: Signs, number: int) -> list[tuple[float, int]]:
    """Return the ends and signs of the segments of a piece."""
    count = own.counts[number]
    return list(zip(own.ends[number, :count].tolist(), own.signs[number, :count].tolist(), strict=True))


def usual_length(natural: Floats, lengths: Floats) -> float:
    """Return a length that most pieces could have at least, a power of two as theirs are; 0 if corners end them all."""
    # What is a polynomial exactly could be followed for ever.
    longest = MUCH_LONGER * float(lengths.max())
    whole = np.sort(natural[natural >= lengths])
    if not len(whole):
        return 0.0
    found = min(float(whole[int(_USUAL * len(whole))]), longest)
    return float(2.0 ** math.floor(math.log2(found)))
