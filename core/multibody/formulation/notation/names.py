"""What the names of variables say: a letter, and whose it is."""

from __future__ import annotations

import re
from typing import NamedTuple

GREEK = {"theta": "θ", "phi": "φ", "angle": "φ", "turn": "φ", "lambda": "λ", "omega": "ω", "gamma": "γ"}
"""Ends of names that are written as Greek letters."""

SHORT = {"length": "l", "rate": "v", "force": "F", "centre": "c", "torque": "M", "gap": "d"}
"""Ends of names that have a usual letter."""

LETTERS = {"θ": r"\theta", "φ": r"\varphi", "λ": r"\lambda", "ω": r"\omega", "γ": r"\gamma", "Δ": r"\Delta"}
"""How LaTeX writes the letters that have a name in it."""


class Symbol(NamedTuple):
    """A letter, what stands below it, and how many dots it has.

    Attributes
    ----------
    letter, owner : str
    order : int
        Of the derivative by time.
    """

    letter: str
    owner: str
    order: int


def symbol_of(name: str) -> Symbol:
    """Return how a name is written."""
    order = len(name) - len(name.rstrip("'"))
    head, _, end = name.rstrip("'").rpartition(".")
    word, digits = end.rstrip("0123456789").rstrip("_"), end[len(end.rstrip("0123456789")) :]
    letter = GREEK.get(word, SHORT.get(word))
    if letter is None and re.fullmatch("d[xyz]", word):
        letter = f"Δ{word[1]}"
    if letter is None and head and len(word) > 1:
        # A word: whose it is says more than a letter.
        return Symbol("F", f"{head}.{end}", order)
    return Symbol(letter or word, ", ".join(part for part in (digits, head) if part), order)
