"""Closed curves, compared as sets of points: wherever they start, in either direction, by however many points.

A curve of an answer is given at equal steps of an angle, in which it is smooth, so that the trigonometric polynomial
through its points is the curve up to the terms that are left out (L. N. Trefethen and J. A. C. Weideman, "The
exponentially convergent trapezoidal rule", SIAM Review 56 (2014) 385, section 4).
"""

from __future__ import annotations

import numpy as np

from core.arrays import Floats

DENSE = 2048
"""Points by which the curve of an answer is compared."""

BLOCK = 1 << 18
"""Pairs of a point and a chord that are looked at together."""


def dense(points: Floats) -> tuple[Floats, float]:
    """Return a closed curve at many points, the first again at the end, and how far their chords are from it.

    Parameters
    ----------
    points : ndarray, shape (n, k)
        At equal steps of an angle, the first again at the end.
    """
    count = len(points) - 1
    spectrum = np.fft.rfft(points[:-1], axis=0)
    fine = max(DENSE, 2 * count)
    found = np.fft.irfft(spectrum, fine, axis=0) * (fine / count)
    found = np.concatenate([found, found[:1]])
    # What is left out is about as large as the last terms; a chord misses an eighth of the second difference.
    left_out = 2.0 / count * np.abs(spectrum[-(len(spectrum) // 4) :]).sum(axis=0).max()
    sag = np.linalg.norm(np.diff(found, 2, axis=0), axis=1).max() / 8.0
    return found, float(left_out + sag)


def separation(curve: Floats, points: Floats) -> float:
    """Return how far two closed curves are apart: the largest distance of any point of either from the other.

    Parameters
    ----------
    curve : ndarray, shape (n, k)
        In order, from anywhere and in either direction; straight between its points, and from the last to the first.
    points : ndarray, shape (m, k)
        Of the curve of an answer, as for `dense`.
    """
    own, _ = dense(points)
    closed = np.concatenate([curve, curve[:1]])
    return max(_farthest(curve, own), _farthest(own[:-1], closed))


def _farthest(points: Floats, chain: Floats) -> float:
    """Return the largest distance of a point from a chain of chords."""
    start, along = chain[:-1], np.diff(chain, axis=0)
    square = (along * along).sum(axis=1)
    square[square == 0.0] = 1.0
    farthest, rows = 0.0, max(1, BLOCK // len(start))
    for first in range(0, len(points), rows):
        apart = points[first : first + rows, None] - start
        share = np.clip(np.einsum("ijk,jk->ij", apart, along) / square, 0.0, 1.0)
        apart -= share[..., None] * along
        farthest = max(farthest, float(np.sqrt((apart * apart).sum(axis=2).min(axis=1)).max()))
    return farthest
