"""Questions that are spoilt: examples of requests with a few changes of any kind, at any place."""

from __future__ import annotations

import copy
import json
from collections.abc import Sequence
from random import Random
from typing import Any

NUMBERS = [
    0,
    -0.0,
    1,
    -1,
    1e-300,
    5e-324,
    1e300,
    -1e300,
    1e154,
    1e-160,
    1.7976931348623157e308,
    2**53 + 1,
    3.5,
    1e9,
    -7,
]
OTHERS: list[Any] = [None, True, "", "meaningful", "NaN", [], {}, [1.0, 2.0, 3.0], [[1, 2, 3]], {"kind": "ball"}, "1e5"]

WAYS = ("set", "set", "scale", "drop", "twin", "rename")

Spoil = tuple[int, str, Any]
"""At which place, in what way, with what value."""


def random_spoils(random: Random) -> list[Spoil]:
    """Return one to four changes."""
    return [(random.randrange(10_001), random.choice(WAYS), _value(random)) for _ in range(random.randint(1, 4))]


def _value(random: Random) -> Any:
    kind = random.randrange(4)
    if kind == 0:
        return random.choice(NUMBERS)
    if kind == 1:
        return random.choice(OTHERS)
    if kind == 2:
        return random.randint(-5, 200)
    return random.choice((-1.0, 1.0)) * 10.0 ** random.uniform(*random.choice(((-3, 3), (-30, 30), (-307, 308))))


def places(node: Any) -> list[tuple[Any, Any]]:
    """Return every (container, key) of a document."""
    keys = list(node) if isinstance(node, dict) else list(range(len(node))) if isinstance(node, list) else []
    found = [(node, key) for key in keys]
    for key in keys:
        found += places(node[key])
    return found


def spoilt(question: Any, spoils: Sequence[Spoil]) -> Any:
    """Return a question with a few changes."""
    document = json.loads(json.dumps(question))
    for where, how, value in spoils:
        choices = places(document)
        if not choices:
            break
        container, key = choices[where % len(choices)]
        old = container[key]
        number = isinstance(old, (int, float)) and isinstance(value, (int, float))
        if how == "drop":
            del container[key]
        elif how == "twin" and isinstance(container, list):
            container.insert(key, copy.deepcopy(old))
        elif how == "rename" and isinstance(container, dict):
            container[f"{key}s"] = container.pop(key)
        elif how == "scale" and number and abs(product := float(old) * float(value)) < 1e308:
            container[key] = product
        else:
            container[key] = copy.deepcopy(value)
    return document
