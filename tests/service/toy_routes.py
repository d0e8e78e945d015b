"""A route table that needs no mechanics: the transport is tested with it."""

from __future__ import annotations

import os
import signal
import time
from dataclasses import dataclass, replace
from typing import Annotated, Any, Literal

import numpy as np

from core.errors import AccuracyUnreachable, MechanicsError, SelfCheckFailed, UnphysicalInertia
from core.notices import Notice
from core.quantities import AngularVelocity, Mass, Position, Quantity, TaggedBy, check
from core.systems.budget import Budget
from service.routing import Example, PostRoute
from service.schemas import Envelope, Request, Times, Vector, sample_times

PositiveMoment = Annotated[float, Quantity("kg m^2", above=0)]


@dataclass(frozen=True)
class Moments:
    moments: tuple[PositiveMoment, PositiveMoment, PositiveMoment]
    kind: Literal["moments"] = "moments"

    def __post_init__(self) -> None:
        check(self)
        if self.moments[2] == 7.0:
            raise UnphysicalInertia(("moments", 2), "not exceed the sum of the others", remedy="make it smaller")


@dataclass(frozen=True)
class Points:
    masses: tuple[Mass, ...]
    positions: tuple[Position, ...]
    kind: Literal["points"] = "points"

    def __post_init__(self) -> None:
        check(self)


@dataclass(frozen=True)
class Nest:
    inner: tuple[ToyBody, ...]
    kind: Literal["nest"] = "nest"


ToyBody = Annotated[Moments | Points | Nest, TaggedBy("kind")]

BODY = {"kind": "moments", "moments": [1.0, 2.0, 3.0]}
GOOD: dict[str, Any] = {
    "body": BODY,
    "angular_velocity": [0.1, 1.0, 0.1],
    "times": {"start": 0.0, "stop": 1.0, "count": 3},
}


class Ask(Request):
    body: ToyBody
    angular_velocity: AngularVelocity
    times: Times
    behaviour: Literal["well", "nan", "fail", "unreachable", "sleep", "spin", "die", "warn", "wrong", "fill"] = "well"


class Told(Envelope):
    time: list[float]
    position: list[Vector]
    nothing: None


def handle(question: Ask, budget: Budget) -> dict[str, Any]:
    since, t = time.process_time(), sample_times(question.times, budget)
    behaviour = question.behaviour
    if behaviour == "fail":
        raise RuntimeError("secret of the service")
    if behaviour == "unreachable":
        raise AccuracyUnreachable(1e-30, 1e-15, "double precision")
    if behaviour == "wrong":
        raise SelfCheckFailed("energy", "rod", 1.5, 1e-3, 1e-12)
    if behaviour == "sleep":
        time.sleep(abs(question.angular_velocity[0]))
    while behaviour == "spin" and time.process_time() - since < question.angular_velocity[0]:
        pass
    if behaviour == "fill":
        np.ones(int(question.angular_velocity[0]), np.uint8)
    if behaviour == "die":
        os.kill(os.getpid(), signal.SIGKILL)
    position = np.stack([t * w for w in question.angular_velocity]).T
    if behaviour == "nan":
        position[-1, -1] = np.nan
    warnings = (Notice("toy", "this is a toy", ("body", "moments", 0)),) if behaviour == "warn" else ()
    return {"time": t, "position": position, "nothing": None, "warnings": warnings}


def is_small(question: Ask) -> bool:
    return (
        question.behaviour not in ("sleep", "spin", "die", "fill")
        and (len(question.times) if isinstance(question.times, list) else question.times.count) <= 1000
    )


class Unlisted(MechanicsError):
    """An error that the table of problems does not name."""


TOY = PostRoute(
    "/v1/toy",
    "ask_toy",
    "A toy",
    "toys",
    Ask,
    Told,
    handle,
    is_small,
    examples={"small": Example("three samples", GOOD)},
)


def in_short(question: Ask, budget: Budget) -> dict[str, Any]:
    """Answer one time alone, at length if the behaviour is to sleep for a minute."""
    seconds = question.angular_velocity[0]
    return handle(
        question.model_copy(update={"times": [0.0], "behaviour": "sleep" if seconds == 60.0 else "well"}), budget
    )


def at_rest(question: Ask, budget: Budget) -> dict[str, Any]:
    return handle(question.model_copy(update={"times": [0.0, 0.0], "behaviour": "well"}), budget)


SHORT = replace(TOY, path="/v1/short", operation_id="ask_short", in_short=(in_short, at_rest))


def table() -> tuple[PostRoute, ...]:
    return (TOY, SHORT)


def inline_table() -> tuple[PostRoute, ...]:
    """Return the same table with every question small, whatever it costs."""
    return (replace(TOY, small=lambda question: True),)
