"""Contact scenes beside physics engines: the questions, their references, what is measured, and the page."""

from __future__ import annotations

import json
import math
from importlib import metadata
from pathlib import Path

import pytest
from scipy.integrate import solve_ivp

from benchmarks.contact_peers import ours
from benchmarks.contact_peers.cases import BOUNCE, CASES, LADDER, SLIP, ContactCase
from benchmarks.contact_peers.drake_engine import dissipation_for
from benchmarks.contact_peers.mujoco_engine import restitution_of
from benchmarks.contact_peers.observed import Step, figures
from benchmarks.contact_peers.page import section, with_section
from benchmarks.contact_peers.worker import ENGINES, OURS
from benchmarks.machine import RESULTS
from core.multibody.language.reading import scene_from

ROOT = Path(__file__).parents[2]


def value(case: ContactCase, name: str) -> float:
    return float(case.references[name][0])


def test_the_ladder_s_references_are_those_of_another_formulation() -> None:
    """The angle with the vertical by its equation of motion, on the wall and off it, integrated with DOP853."""
    g, half = 9.81, 1.5

    def on_wall(_: float, y: list[float]) -> list[float]:
        return [y[1], 0.75 * g * math.sin(y[0]) / half]

    def off_wall(_: float, y: list[float]) -> list[float]:
        # (sin^2 + 1/3) phi'' + sin cos phi'^2 = g sin phi/l
        s, c = math.sin(y[0]), math.cos(y[0])
        return [y[1], (g * s / half - s * c * y[1] ** 2) / (s * s + 1 / 3)]

    time = value(LADDER, "leaves the wall at")
    options = {"method": "DOP853", "rtol": 1e-13, "atol": 1e-13}
    first = solve_ivp(on_wall, (0, time), [0.5, 0.0], **options).y[:, -1]
    assert math.cos(first[0]) == pytest.approx(2 / 3 * math.cos(0.5), rel=1e-12)
    second = solve_ivp(off_wall, (time, 0.8), first, **options).y[:, -1]
    assert math.pi / 2 - second[0] == pytest.approx(value(LADDER, "angle at 0.8 s"), rel=1e-11)


def test_known_figures() -> None:
    assert value(LADDER, "leaves the wall at") == pytest.approx(0.58173830116164499, rel=1e-16)
    assert value(SLIP, "rolls from") == pytest.approx(0.509683995922528, rel=1e-15)
    assert value(BOUNCE, "rests from") == pytest.approx(4.543368996115371, rel=1e-16)


def test_what_is_measured_of_a_bounce_is_exact_between_steps() -> None:
    """Heights between steps are cubics of heights and rates: parabolas, however long the steps are."""
    first = math.sqrt(2.5 / 9.81)
    speed, begin, steps = 0.8 * 9.81 * first, first, [Step(0.0, (0.0, 1.25, 0.0, 0.0, 0.0, 0.0))]
    while speed > 1e-3:
        steps.append(Step(begin, (0.0, 0.0, 0.0, 0.0, speed, 0.0)))
        begin += 2 * speed / 9.81
        steps.append(Step(begin, (0.0, 0.0, 0.0, 0.0, -speed, 0.0)))
        speed *= 0.8
    peaks = [
        Step((a.time + b.time) / 2, (0.0, a.state[4] ** 2 / 19.62, 0.0, 0.0, 0.0, 0.0))
        for a, b in zip(steps[1::2], steps[2::2], strict=True)
    ]
    every = sorted([*steps, *peaks], key=lambda one: (one.time, one.state[4]))
    found = figures(BOUNCE, every[-1].state, every)
    assert found["height at 2.2 s"] == pytest.approx(value(BOUNCE, "height at 2.2 s"), rel=1e-12)
    assert found["last above 1 mm"] == pytest.approx(value(BOUNCE, "last above 1 mm"), rel=1e-12)


def test_dampings_leave_the_wanted_share_of_a_speed() -> None:
    def left(force: object) -> float:
        def leaves(_: float, y: list[float]) -> float:
            return y[0] - 1e-12 if y[1] > 0 else -1.0

        def pulls(_: float, y: list[float]) -> float:
            return -1.0 if y[1] <= 0 else force(*y)  # type: ignore[operator]

        leaves.terminal = pulls.terminal = True  # type: ignore[attr-defined]
        leaves.direction, pulls.direction = 1.0, -1.0  # type: ignore[attr-defined]
        run = solve_ivp(
            lambda _, y: [y[1], force(*y)],  # type: ignore[operator]
            (0, 20),
            [-1e-13, -1.0],
            events=[leaves, pulls],
            rtol=1e-10,
            atol=1e-13,
        )
        return float(run.y[1, -1])

    # Hunt and Crossley: -x (1 - d v), with x < 0 in contact, for a stiffness and a mass of one.
    d = dissipation_for(0.8, 1.0)
    assert left(lambda x, v: -x * (1 - d * v)) == pytest.approx(0.8, rel=1e-5)
    # A linear damper stops pushing before the spring does.
    assert left(lambda x, v: -x - 0.2 * v) == pytest.approx(restitution_of(0.1), rel=1e-5)


@pytest.mark.parametrize("case", CASES, ids=lambda case: case.name)
def test_polhode_answers_within_what_it_states(case: ContactCase) -> None:
    found, stated, said = ours.measured(case, ours.prepared(case, 1e-9)())
    assert set(found) <= set(case.references)
    for name, own in found.items():
        assert abs(own - value(case, name)) <= stated[name] + 2.0**-53 * abs(own)
    assert (said is None) == bool(case.references)
    # The engines get the same body.
    (body,) = scene_from(dict(case.scene)).bodies.values()
    assert case.mass == float(body.mass)


@pytest.mark.parametrize("engine", [one for one in ENGINES if one.name != OURS], ids=lambda engine: engine.name)
def test_engines_agree_roughly(engine: object) -> None:
    try:
        metadata.version(engine.package)  # type: ignore[attr-defined]
    except metadata.PackageNotFoundError:
        pytest.skip("not installed")
    steps: list[Step] = []
    final = engine.prepare(SLIP, engine.settings[1])(steps)  # type: ignore[attr-defined]
    assert figures(SLIP, final, steps)["velocity at 1 s"] == pytest.approx(2.0, rel=0.05)


def test_the_page_shows_the_results() -> None:
    results = RESULTS / "contact_peers.json"
    page = (ROOT / "docs" / "peers.md").read_text(encoding="utf-8")
    assert with_section(page, results) == page
    assert section(json.loads(results.read_text(encoding="utf-8"))) in page
