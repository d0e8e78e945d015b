"""Which of the names that exist was probably meant by one that does not."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterable, Mapping
from difflib import get_close_matches

LONGEST_NAME = 80
"""Characters of a name that is compared with others; a longer one is no misspelling."""

ALIKE = 0.78
"""Share of its letters that a name must have in common with another to be taken for a misspelling of it."""

ALIKE_IN_SCENE = 0.6
"""The same of names in one scene, which are few, often short, and listed beside the guess."""

MOST_LISTED = 20
"""Names in a list; the rest are counted."""


def plain(name: str) -> str:
    """Return the letters and digits of a name, in lower case."""
    return re.sub("[^a-z0-9]", "", name[: 2 * LONGEST_NAME].lower())


def nearest(
    given: str, names: Iterable[str], alike: float = ALIKE, synonyms: Mapping[str, Iterable[str]] | None = None
) -> str | None:
    """Return the name that was probably meant, whatever its case and hyphens; None if none is near.

    Parameters
    ----------
    given : str
    names : iterable of str
        Those that exist.
    alike : float
        Least ratio of `difflib.SequenceMatcher`, from 0 to 1.
    synonyms : mapping of str to names, optional
        Other words for some of the names.
    """
    if not given or len(given) > LONGEST_NAME:
        return None
    known, written = {plain(name): name for name in names}, plain(given)
    if written in known:
        return known[written]
    for name in known.values():
        if written in map(plain, (synonyms or {}).get(name, ())):
            return name
    found = get_close_matches(written, known, 1, alike)
    return known[found[0]] if found else None


def did_you_mean(
    given: object, names: Iterable[str], synonyms: Mapping[str, Iterable[str]] | None = None
) -> str | None:
    """Return the question for the name that was probably meant in a scene; None if none is near: see `nearest`."""
    near = nearest(given, names, ALIKE_IN_SCENE, synonyms) if isinstance(given, str) else None
    return None if near is None else f'did you mean "{near}"?'


def near_and_all(given: object, names: Collection[str], what: str) -> str:
    """Return the remedy of an unknown name in a scene: the name that was probably meant, and all that exist.

    Parameters
    ----------
    given : object
        What stands in the place of the name.
    names : collection of str
        Those that exist, one at least.
    what : str
        What they name, in the plural: ``"bodies"``.
    """
    shown, more = ", ".join(list(names)[:MOST_LISTED]), len(names) - MOST_LISTED
    listed = f"the {what} here are {shown}{f' and {more} more' if more > 0 else ''}"
    near = did_you_mean(given, names)
    return listed if near is None else f"{near} {listed}"
