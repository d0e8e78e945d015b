"""The smallest scene in which two answers still differ in the same way.

    python -m tests.oracles.plain_engine.comparison.minimal 25

prints that of a seed as JSON.
"""

from __future__ import annotations

import json
import sys
from collections.abc import Iterator, Sequence

from tests.oracles.plain_engine.comparison.comparing import Verdict, compared
from tests.oracles.plain_engine.comparison.drawing import Json
from tests.oracles.plain_engine.comparison.run import classes_of
from tests.oracles.plain_engine.comparison.scenes import scene_of


def minimal(scene: Json, times: Sequence[float]) -> tuple[Json, Verdict]:
    """Return a scene from which nothing more can be left out, one thing after another."""
    verdict = compared(scene, times)
    wanted = classes_of(verdict)
    while True:
        for smaller in _smaller(scene):
            try:
                found = compared(smaller, times)
            except Exception:
                # What is left out may be what makes a scene possible.
                continue
            if classes_of(found) == wanted:
                scene, verdict = smaller, found
                break
        else:
            return scene, verdict


def _smaller(scene: Json) -> Iterator[Json]:
    for body in scene["bodies"] if len(scene["bodies"]) > 1 else ():
        bodies = {name: value for name, value in scene["bodies"].items() if name != body}
        left = [one for one in scene["connections"] if not _names(one, body)]
        yield {**scene, "bodies": bodies, "connections": left}
    for i in range(len(scene["connections"])):
        yield {**scene, "connections": scene["connections"][:i] + scene["connections"][i + 1 :]}
    for i, one in enumerate(scene["connections"]):
        for key in ("friction", "restitution"):
            if key in one:
                less = {k: v for k, v in one.items() if k != key}
                yield {**scene, "connections": [*scene["connections"][:i], less, *scene["connections"][i + 1 :]]}


def _names(connection: Json, body: str) -> bool:
    places = [connection.get(key) for key in ("a", "b", "place", "body")]
    places += [connection.get("on", {}).get("at"), *connection.get("through", [])]
    return any(isinstance(place, str) and place.partition(".")[0] == body for place in places)


if __name__ == "__main__":
    for number in sys.argv[1:]:
        drawn, asked = scene_of(int(number))
        least, shown = minimal(drawn, asked)
        one = shown.differences[0] if shown.differences else None
        print(json.dumps({**least, "times": asked}))  # noqa: T201
        print(classes_of(shown), "| right:", one and one.right, "| answered:", one and one.answered)  # noqa: T201
