"""The page docs/source-questions.md, made from a running service's answers: python -m examples.source_questions.

Numbers whose names begin with "source" are what the source's own formulas give.
"""

from __future__ import annotations

import argparse
from collections.abc import Callable, Mapping, Sequence
from math import acos, cos, degrees, sin, sqrt
from pathlib import Path
from typing import Any

from examples.ask import ask, service_url

Answers = Sequence[Mapping[str, Any]]
Figures = dict[str, float]

TEMPLATE = Path(__file__).with_name("source-questions.template.md")


def _shafts(answers: Answers) -> Figures:
    solid, vertical, until = answers
    (a1, a2), (event,) = solid["accelerations"], until["events"]
    return {
        "tension": solid["tension"],
        "a1": a1,
        "a2": a2,
        "string": solid["string_acceleration"],
        "vertical_tension": vertical["tension"],
        "vertical_acceleration": vertical["accelerations"][0],
        "unwound": event["time"],
    }


def _rod(answers: Answers) -> Figures:
    (found,) = answers
    a = length = 1.0
    g, k = 9.81, sqrt(a * a - length * length / 4)
    return {
        "rate": found["angular_velocity_at_horizontal"],
        "period": found["period"],
        "source": sqrt((g * a * length / k**2 - 2 * g * a * (1 - k)) / (length**2 / 3 + k**2)),
        "source_inertia": sqrt(2 * g * k * (1 - length / (2 * a)) / (a**2 + length**2 / 12)),
    }


def _chain(answers: Answers) -> Figures:
    (found,) = answers
    return {name: found[name] for name in ("acceleration", "apex_tension", "growth_rate", "equilibrium")}


def _one_step(answers: Answers) -> Figures:
    x, y, z = answers[0]["angular_velocity"][-1]
    source_y = 1.0 + (2.0 - 0.5) / 1.0
    return {"x": x, "y": y, "z": z, "source_y": source_y}


def _no_step(answers: Answers) -> Figures:
    x, y, z = answers[0]["angular_velocity"][-1]
    return {"x": x, "y": y, "z": z, "source_x": x - 1.0, "source_y": y - 1.0, "source_z": z - 1.0}


def _last(answers: Answers) -> Figures:
    return dict(zip("xyz", answers[0]["angular_velocity"][-1], strict=True))


def _rates(answers: Answers) -> Figures:
    coin, football = answers
    return {
        "coin_body": coin["body_rate"],
        "coin_space": coin["space_rate"],
        "football_body": football["body_rate"],
        "football_space": football["space_rate"],
    }


def _measured(answers: Answers) -> Figures:
    found = answers[0]["measured"]
    return {
        "point": found["grid_point"],
        "time": found["time"],
        "percent": 100.0 * found["relative_difference"],
        "theory": found["theory"],
        "early": -found["from_tolerance"],
        "grid": found["from_grid"],
        "method": found["from_method"],
    }


def _closed_form(answers: Answers) -> Figures:
    rate = (1.0 - 2.0) / 1.0 * 3.1
    return _last(answers) | {"source_y": 2.0 * cos(10.0 * rate), "source_z": 2.0 * sin(10.0 * rate)}


def _energy(answers: Answers) -> Figures:
    return {"energy": answers[0]["energy"]}


def _surface(answers: Answers) -> Figures:
    return dict(zip("xyz", answers[0]["semi_axes"], strict=True))


def _growth(answers: Answers) -> Figures:
    small, large = ([member["accuracy"]["drifts"]["energy"] for member in found["members"]] for found in answers[1:3])
    return {
        "least": 100.0 * min(small),
        "most": 100.0 * max(small),
        "least_large": 1.0 + min(large),
        "most_large": 1.0 + max(large),
        "refused": answers[3]["status"],
    }


def _compared(answers: Answers) -> Figures:
    oblate, oblate_euler, prolate, prolate_euler = answers
    return {
        "oblate": oblate["period"],
        "prolate": prolate["period"],
        "oblate_error": 100.0 * oblate_euler["accuracy"]["error"],
        "prolate_error": 100.0 * prolate_euler["accuracy"]["error"],
        "source_oblate": 2.0 * oblate["period"],
        "source_prolate": prolate["period"] / 2.0,
    }


def _wobble(answers: Answers) -> Figures:
    sidereal, solar = answers
    return {
        "asymmetry": sidereal["asymmetry"],
        "ellipticity": sidereal["ellipticity"],
        "solar_asymmetry": solar["asymmetry"],
        "solar_ellipticity": solar["ellipticity"],
        "source": sqrt(1.0 + 1.0 / 430.0),
    }


def _earth(answers: Answers) -> Figures:
    earth = answers[0]["earth"]
    return {"rigid": earth["rigid_period_solar"], "observed": earth["observed_period_solar"]}


def _eigenvalues(answers: Answers) -> Figures:
    low, middle, high, _ = answers[0]["equilibria"]
    return {
        "low": low["eigenvalues"][0][1],
        "middle": middle["eigenvalues"][0][0],
        "high": high["eigenvalues"][0][1],
    }


def _flip_interval(answer: Mapping[str, Any]) -> float:
    """Return the interval between flips of a body that does turn over."""
    if not answer["tumbles"]:
        raise ValueError("the middle component changes its sign, but the body does not turn over")
    return float(answer["flip_interval"])


def _flip_of_disturbed(answer: Mapping[str, Any]) -> float:
    """Return the same of a spin about the middle axis after a disturbance."""
    flip = answer["flip"]
    if not flip["reason"].startswith("it turns over every half period"):
        raise ValueError(flip["reason"])
    return float(flip["interval"])


def _thrown(answers: Answers) -> Figures:
    deck, coin = answers
    low, middle, high, _ = (1e5 * (x["moment"] or 0.0) for x in deck["equilibria"])
    return {
        "low": low,
        "middle": middle,
        "high": high,
        "growth": deck["equilibria"][1]["growth_rate"],
        "flip": _flip_of_disturbed(deck),
        "across": 1e7 * coin["equilibria"][0]["moment"],
        "along": 1e7 * coin["equilibria"][2]["moment"],
    }


def _t_handle(answers: Answers) -> Figures:
    found = answers[0]
    x, y, _ = found["center_of_mass"]
    own, other = found["principal"]["moments"], found["principal_about_origin"]["moments"]
    return {
        "mass": found["mass"],
        "x": x,
        "y": y,
        **dict(zip(("low", "middle", "high"), own, strict=True)),
        **dict(zip(("source_low", "source_middle", "source_high"), other, strict=True)),
    }


def _tumbling(answers: Answers) -> Figures:
    free, euler, pinned, pinned_euler, near = answers
    return {
        "flip": _flip_interval(free),
        "growth": 100.0 * euler["accuracy"]["drifts"]["energy"],
        "tilt": degrees(acos(10.0 / sqrt(102.0))),
        "near": _flip_of_disturbed(near),
        "source": _flip_interval(pinned),
        "source_growth": 100.0 * pinned_euler["accuracy"]["drifts"]["energy"],
    }


def _free(answers: Answers) -> Figures:
    return {"warned": [notice["code"] for notice in answers[0]["warnings"]].count("not-free")}


QUESTIONS: Mapping[str, tuple[Callable[[Answers], Figures], tuple[str, ...]]] = {
    "shafts": (
        _shafts,
        (
            "scenes/unwinding-shafts/solid-shafts",
            "scenes/unwinding-shafts/vertical",
            "scenes/unwinding-shafts/until-unwound",
        ),
    ),
    "chain": (_chain, ("scenes/chain-on-wedge/sliding",)),
    "rod": (_rod, ("scenes/rod-in-hole/horizontal",)),
    "1a": (_one_step, ("rotation/trajectory/one-step",)),
    "1b": (_no_step, ("rotation/trajectory/one-step",)),
    "1c": (_last, ("rotation/trajectory/aligned-start",)),
    "1d": (_last, ("rotation/trajectory/sphere",)),
    "1e": (_rates, ("rotation/precession/coin", "rotation/precession/football")),
    "1f": (_measured, ("rotation/precession/measured",)),
    "1g": (_closed_form, ("rotation/trajectory/symmetric",)),
    "1h": (_energy, ("rotation/trajectory/energy",)),
    "1i": (_surface, ("rotation/energy-ellipsoid/source-surface",)),
    "1j": (
        _growth,
        (
            "rotation/ensemble/thirty-starts",
            "rotation/ensemble/thirty-starts-euler",
            "rotation/ensemble/thirty-starts-large-steps",
            "rotation/ensemble/thirty-starts-overflow",
        ),
    ),
    "1k": (
        _compared,
        (
            "rotation/trajectory/oblate",
            "rotation/trajectory/oblate-euler",
            "rotation/trajectory/prolate",
            "rotation/trajectory/prolate-euler",
        ),
    ),
    "1l": (_wobble, ("rotation/wobble/chandler", "rotation/wobble/chandler-solar")),
    "1m": (_earth, ("rotation/wobble/chandler",)),
    "1n": (_eigenvalues, ("rotation/stability/three-moments",)),
    "1o": (_thrown, ("rotation/stability/deck-of-cards", "rotation/stability/coin")),
    "1p": (_t_handle, ("bodies/mass-properties/t-handle",)),
    "1q": (
        _tumbling,
        (
            "t-handle",
            "rotation/trajectory/t-handle-euler",
            "rotation/trajectory/t-handle-pinned",
            "rotation/trajectory/t-handle-pinned-euler",
            "rotation/stability/t-handle-nearly-aligned",
        ),
    ),
    "1r": (_free, ("rotation/trajectory/t-handle-pinned",)),
}
"""What finds the numbers of each question, and the examples whose answers hold them, in the order it takes them."""


def figures(answer_of: Callable[[str], Mapping[str, Any]]) -> dict[str, Figures]:
    """Return the numbers of every question, from what answers an example by its name."""
    return {key: find([answer_of(name) for name in names]) for key, (find, names) in QUESTIONS.items()}


def page(found: Mapping[str, Figures]) -> str:
    """Return the page with its numbers in place."""
    return TEMPLATE.read_text(encoding="utf-8").format(**found)


def main() -> None:
    """Read the command line."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--service", default=service_url(), help="where it runs (default: %(default)s)")
    service = parser.parse_args().service
    print(page(figures(lambda name: ask(name, service))), end="")


if __name__ == "__main__":
    main()
