"""Printed equations, read back, have the accelerations and forces of the answer."""

from __future__ import annotations

import cmath
from collections.abc import Callable, Iterator, Mapping
from typing import Any

import mpmath
import numpy as np
import pytest

from core.errors import BudgetExceeded, NotApplicable
from core.multibody.answer import SceneSolution
from core.multibody.formulation.notation.plain import plain
from core.multibody.formulation.scene_equations import MOST_COORDINATES
from core.multibody.language.numerals import Numerals
from core.multibody.language.reading import scene_from
from core.multibody.language.scene import Scene
from core.multibody.solve import solve_scene
from service.requests.described_scene import SCENE_FIELDS
from service.routes.scene_catalogue import scene_catalogue
from tests.core.multibody.formulation.reading import Jet, evaluated, solved
from tests.core.multibody.random_scenes import any_scene, attracted_or_rolling
from tests.core.multibody.relations.combined_scenes import plane

AGREED = 1e-12
"""Largest difference of accelerations, relative to the largest of the scene."""

UNDECIDED, BEYOND = {"painleve-chalk"}, {"bicycle"}
"""Scenes of the catalogue that have no motion, and such as have too many coordinates."""

ASKED = sorted(set(scene_catalogue()) - UNDECIDED - BEYOND)


def scene_of(question: Mapping[str, Any]) -> Scene:
    return scene_from({name: question[name] for name in SCENE_FIELDS if name in question})


def answer_of(scene: Scene, times: list[float] | None = None) -> SceneSolution:
    outputs = ["accelerations", "trajectory", "energy", "equations"]
    return solve_scene(scene, times or [0.0], outputs, 1e-6)  # type: ignore[arg-type]


def columns_at(scene: Scene, answer: SceneSolution, row: int) -> dict[str, Jet]:
    """Return the columns at a sample with their rates."""
    assert answer.trajectory is not None
    found = answer.trajectory.columns
    jets = {}
    for name in scene.bodies:
        for axis, place, rate in zip(
            "xyz", found[f"{name}.position"].values[row], found[f"{name}.velocity"].values[row], strict=False
        ):
            jets[f"{name}.{axis}"] = Jet(mpmath.mpf(place), mpmath.mpf(rate))
        if f"{name}.angle" in found:
            angle, rate = (found[f"{name}.{end}"].values[row] for end in ("angle", "angular_velocity"))
            jets[f"{name}.angle"] = Jet(mpmath.mpf(angle), mpmath.mpf(rate))
        if f"{name}.angular_velocity_in_space" in found:
            turning = found[f"{name}.angular_velocity_in_space"].values[row]
            for axis, rate in zip("xyz", turning, strict=True):
                jets[f"{name}.turn.{axis}"] = Jet(mpmath.mpf(0), mpmath.mpf(rate))
        if f"{name}.attitude" in found:
            axes = rotation(found[f"{name}.attitude"].values[row])
            turning = found[f"{name}.angular_velocity"].values[row]
            for k, axis in enumerate("xyz"):
                jets[f"{name}.angular_velocity.{axis}"] = Jet(mpmath.mpf(turning[k]))
                jets |= axis_of(f"{name}.axis{k + 1}", axes[:, k], axes @ turning)
        if f"{name}.axis" in found and row == 0:
            jets |= axis_of(f"{name}.axis", found[f"{name}.axis"].values[row], turning_at_start(scene, name))
    return jets


def axis_of(name: str, axis: np.ndarray, turning: np.ndarray) -> dict[str, Jet]:
    rates = np.cross(turning, axis)
    return {f"{name}.{end}": Jet(mpmath.mpf(axis[k]), mpmath.mpf(rates[k])) for k, end in enumerate("xyz")}


def rotation(quaternion: np.ndarray) -> np.ndarray:
    w, x, y, z = quaternion
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
        ]
    )


def turning_at_start(scene: Scene, name: str) -> np.ndarray:
    """Return the angular velocity in space that a description gives a top."""
    body: Any = scene.bodies[name]
    numerals = Numerals.of(scene.let, scene.numbers)

    def read(vector: Any) -> list[float]:
        return [float(x) for x in numerals.vector(vector, (), 3)]

    axes = np.array([read(axis) for axis in body.axes]) if body.axes else np.eye(3)
    return np.array(read(body.angular_velocity or [0, 0, 0])) @ axes


def agreed(scene: Scene, answer: SceneSolution) -> Iterator[tuple[str, float, float]]:
    """Yield every acceleration that the printed equations have, with that of the answer."""
    assert answer.equations is not None
    assert answer.accelerations is not None
    with mpmath.workdps(25):
        found = solved(answer.equations, columns_at(scene, answer, 0))
        assert found.rank == found.unknowns
        for name, begun in answer.equations.start.items():
            if answer.equations.coordinates[name] is not None:
                off = float(found.jets[name].value) - begun.value
                # Angles are those of the columns up to whole turns.
                turns = 2 * np.pi * round(off / (2 * np.pi)) if abs(off) > 1.0 else 0.0
                assert off - turns == pytest.approx(0.0, abs=1e-11 * (1.0 + abs(begun.value))), name
                if begun.rate is not None:
                    assert begun.rate == pytest.approx(float(found.jets[name].rate), rel=1e-11, abs=1e-11), name
        for name, one in answer.accelerations.items():
            for axis, value in zip("xyz", one.linear, strict=False):
                if f"{name}.{axis}" in found.places:
                    yield f"{name}.{axis}", float(found.places[f"{name}.{axis}"].gain), value
            if f"{name}.angle" in found.places:
                assert isinstance(one.angular, float)
                yield f"{name}.angle", float(found.places[f"{name}.angle"].gain), one.angular
            for k in (1, 2, 3):
                if f"{name}.omega_{k}" in found.jets:
                    assert isinstance(one.angular, tuple)
                    yield f"{name}.omega_{k}", float(found.jets[f"{name}.omega_{k}"].rate), one.angular[k - 1]


@pytest.mark.parametrize("name", sorted(BEYOND))
def test_more_coordinates_than_anybody_reads_are_refused(name: str) -> None:
    with pytest.raises(BudgetExceeded) as refused:
        answer_of(scene_of(scene_catalogue()[name].question))
    assert refused.value.limit == MOST_COORDINATES


@pytest.mark.parametrize("name", ASKED)
def test_printed_equations_have_the_accelerations_of_the_answer(name: str) -> None:
    scene = scene_of(scene_catalogue()[name].question)
    compared = list(agreed(scene, answer_of(scene)))
    assert compared
    size = max(abs(value) for _, _, value in compared)
    for column, printed, value in compared:
        assert abs(printed - value) <= AGREED * size, (column, printed, value)


@pytest.mark.parametrize("make", [any_scene, attracted_or_rolling, plane])
@pytest.mark.parametrize("seed", range(14))
def test_printed_equations_of_random_scenes_have_the_accelerations_of_the_answer(
    make: Callable[[int], dict[str, Any]], seed: int
) -> None:
    scene = scene_of(make(seed))
    compared = list(agreed(scene, answer_of(scene)))
    size = max(abs(value) for _, _, value in compared)
    for column, printed, value in compared:
        assert abs(printed - value) <= AGREED * size, (column, printed, value)


def test_the_same_places_on_two_circles_are_solved_once() -> None:
    """A rod and a damper between two points: what the rod has solved is not the centre of a circle for itself."""
    stones = {"a": {"mass": 1, "at": [0.6, 0.8]}, "b": {"mass": 1, "at": [5.6, 0.8]}}
    humps = [{"kind": "rod", "a": name, "b": [x, 0]} for name, x in (("a", 0), ("b", 5))]
    between = [{"kind": "rod", "a": "a", "b": "b"}, {"kind": "damper", "a": "a", "b": "b", "coefficient": 1}]
    for order in ([*between, *humps], [*humps, *between], [*reversed(between), *humps]):
        scene = scene_of({"gravity": [0, -10], "bodies": stones, "connections": order})
        for column, printed, value in agreed(scene, answer_of(scene)):
            assert abs(printed - value) <= AGREED * 10.0, (column, printed, value)


RELATIONS: dict[str, tuple[list[float], list[tuple[str, str | int]]]] = {
    "a divisor that is a square": ([0.4, -0.4, 0.2], [("p.y", "1/p.x"), ("p.x", "p.z^2")]),
    "a divisor that is a sum": ([0.3, -0.3, 0.2], [("p.y", "1/p.x"), ("p.x", "(p.z^2 + p.z)/2")]),
    "a divisor on a circle": ([0.4, -0.4, -0.4], [("p.y", "1/p.x"), ("p.x^2 + p.z^2", 2)]),
    "a divisor on a line": ([0.4, -0.4, -0.4], [("p.y", "1/p.x"), ("p.x", "2 - p.z")]),
    "a divisor of two factors": ([0.4, -0.6, 0.2], [("p.y", "1/(p.x*p.z)"), ("p.x", "p.z^2")]),
    "the square of a divisor": ([0.4, -0.8, 0.2], [("p.y", "1/p.x^2"), ("p.x", "p.z^2")]),
    "a divisor that is a divisor": ([0.4, -0.4, -0.4], [("p.y", "1/p.x"), ("p.x", "1/p.z")]),
}
"""Velocities of a point at [1, 1, 1], and the relations that hold it to a curve."""


@pytest.mark.parametrize("turned_round", [False, True])
@pytest.mark.parametrize("name", RELATIONS)
def test_relations_in_any_order_have_the_same_accelerations(name: str, turned_round: bool) -> None:
    velocity, relations = RELATIONS[name]
    rows = [{"kind": "relation", "name": f"r{k}", "of": of, "equals": to} for k, (of, to) in enumerate(relations)]
    twin = {"kind": "rod", "a": "q", "b": [9, 0, 0]}
    bodies = {
        "p": {"mass": 1, "at": [1, 1, 1], "velocity": velocity},
        "q": {"mass": 2, "at": [9, 0.6, 0.8], "velocity": [1, 0, 0]},
    }
    connections = [*rows, twin][:: -1 if turned_round else 1]
    scene = scene_of({"gravity": [0, -10, 0], "bodies": bodies, "connections": connections})
    compared = list(agreed(scene, answer_of(scene)))
    assert {column for column, _, _ in compared} >= {"p.x", "p.y", "p.z", "q.y", "q.z"}
    for column, printed, value in compared:
        assert abs(printed - value) <= AGREED * 10.0, (column, printed, value)


@pytest.mark.parametrize("name", ASKED)
def test_the_order_of_connections_changes_no_acceleration(name: str) -> None:
    question = scene_catalogue()[name].question
    scene = scene_of({**question, "connections": question.get("connections", [])[::-1]})
    compared = list(agreed(scene, answer_of(scene)))
    assert compared
    size = max(abs(value) for _, _, value in compared)
    for column, printed, value in compared:
        assert abs(printed - value) <= AGREED * size, (column, printed, value)


def test_constants_keep_out_of_the_way_of_time_and_multipliers() -> None:
    """A force of -3 x by constants called t and lambda_1, beside a row that has a multiplier."""
    drive = {"kind": "force", "place": "p", "force": ["-t*lambda_1*x*cos(c1*0)", "0*vx"]}
    question = {
        "let": {"t": 2, "lambda_1": 1.5, "c1": 7},
        "bodies": {"p": {"mass": 1, "at": [1, 0], "velocity": [0.3, 0]}},
        "connections": [drive],
    }
    scene = scene_of(question)
    answer = answer_of(scene)
    assert answer.equations is not None
    assert {column: printed for column, printed, _ in agreed(scene, answer)}["p.x"] == pytest.approx(-3, rel=1e-14)
    assert "t" not in answer.equations.constants


@pytest.mark.parametrize("name", ASKED)
def test_printed_forces_have_the_values_of_the_answer(name: str) -> None:
    scene = scene_of(scene_catalogue()[name].question)
    outputs = ["accelerations", "forces", "trajectory", "equations"]
    answer = solve_scene(scene, [0.0], outputs, 1e-6)  # type: ignore[arg-type]
    assert answer.equations is not None
    assert answer.forces is not None
    with mpmath.workdps(25):
        jets = solved(answer.equations, columns_at(scene, answer, 0)).jets
        # Beside weights, which cancel where a force is zero.
        size = max((abs(one.value) for one in answer.forces.values() if one.value is not None), default=0.0) + 10.0
        for key, formula in answer.equations.forces.items():
            known = answer.forces.get(key)
            if known is not None and known.value is not None:
                assert float(evaluated(formula.plain, jets).value) == pytest.approx(known.value, abs=AGREED * size), key


def test_matrices_have_the_modes_of_the_places_of_rest() -> None:
    """The search for equilibria finds the same small motions by the table and its null space."""
    compared = 0
    for name in ("simple-pendulum", "double-pendulum", "pendulum-on-cart", "loaded-hoop", "two-masses-two-springs"):
        scene = scene_of(scene_catalogue()[name].question)
        answer = solve_scene(scene, [], ["equations", "equilibria"])
        assert answer.equations is not None
        (linear,) = answer.equations.linear
        squares = np.linalg.eigvals(np.linalg.solve(np.array(linear.mass), -np.array(linear.stiffness)))
        modes = [cmath.sqrt(square) for square in squares]
        found = sorted((abs(mode.imag), abs(mode.real)) for mode in modes)
        known = [
            # What is free to go as a whole has no part in the motion, and no frequency.
            sorted({(one.frequency, abs(one.growth_rate)) for one in place.modes} - {(0.0, 0.0)})
            for place in answer.equilibria or ()
        ]
        assert any(len(own) == len(found) and np.allclose(own, found, rtol=1e-12, atol=1e-12) for own in known), (
            name,
            found,
            known,
        )
        compared += 1
    assert compared == 5


def test_a_clock_that_nothing_reads_at_the_start_is_not_written() -> None:
    """Before its first point a table has the value there."""
    scene = {
        "let": {"push": {"points": [[1, 3], [2, 4]], "outside": "constant"}},
        "bodies": {"p": {"mass": 2, "at": [0, 0]}},
        "connections": [{"kind": "force", "place": "p", "force": ["push(t)", 0]}],
    }
    found = solve_scene(scene_from(scene), outputs=["equations"]).equations
    assert found is not None
    assert list(found.coordinates) == ["p.x"]
    assert [one.plain for one in found.equations] == ["p.x'' = 1.5"]


def test_a_force_by_formula_is_the_force_with_its_factors() -> None:
    force = {"kind": "force", "name": "f", "place": "body", "force": ["2*t", 0]}
    scene = scene_from({"bodies": {"body": {"mass": 4, "at": [0, 0]}}, "connections": [force]})
    found = solve_scene(scene, (), ("equations",)).equations
    assert found is not None
    assert plain(found.forces["f.force"].sides[0]) == "2*t"
    assert [[plain(side) for side in one.sides] for one in found.equations] == [["body.x''", "0.25*f.force"]]


def test_pieces_of_formulas_are_written_as_they_are_at_the_start() -> None:
    """A table between its first two points, in digits of doubles."""
    push = {"points": [[0, 1], [1, 2], [2, 0]], "interpolation": "cubic"}
    question = {
        "let": {"push": push},
        "bodies": {"p": {"mass": 1, "at": [0.5, 0], "velocity": [0.3, 0]}},
        "connections": [{"kind": "force", "place": "p", "force": ["push(t)*vx + abs(x)", 0]}],
    }
    scene = scene_of(question)
    answer = answer_of(scene)
    assert answer.equations is not None
    assert all(len(f"{value:.17g}") <= 18 for value in answer.equations.constants.values())
    assert {column: printed for column, printed, _ in agreed(scene, answer)}["p.x"] == pytest.approx(0.8, rel=1e-14)


@pytest.mark.parametrize(
    ("mass", "gravity", "height"), [(1e155, 1e155, 1.0), (1e300, 1e300, 1.0), (1e200, 10.0, 1e150)]
)
def test_equations_with_numbers_beyond_doubles_are_refused(mass: float, gravity: float, height: float) -> None:
    """The weight is no double, or the energy that is conserved is none; without equations the scene is answered."""
    question = {
        "gravity": [0, -gravity],
        "bodies": {"a": {"mass": mass, "at": [0.6 * height, -0.8 * height]}},
        "connections": [{"kind": "rod", "a": "a", "b": [0, 0]}],
    }
    assert solve_scene(scene_of(question), [], ["energy"]).energy is not None
    with pytest.raises(NotApplicable, match="range of doubles"):
        solve_scene(scene_of(question), [], ["equations"])


@pytest.mark.parametrize("angle", [7.3, -4, 3, 40])
@pytest.mark.parametrize(("arm", "x"), [(1, 0), (-0.5, 1000)])
@pytest.mark.parametrize("welded", [None, 0, 2, -9])
def test_angles_of_bodies_are_those_of_their_columns_with_their_turns(
    angle: float, arm: float, x: int, welded: float | None
) -> None:
    def body(far: float, turned: float) -> dict[str, Any]:
        at = [f"{x} + {far}*cos({angle})", f"{far}*sin({angle})"]
        return {"mass": 1, "inertia": 0.1, "at": at, "angle": turned, "places": {"top": [-far, 0]}}

    bodies, connections = {"rod": body(arm, angle)}, [{"kind": "pin", "a": "rod.top", "b": [x, 0]}]
    if welded is not None:
        bodies["other"] = body(2 * arm, welded)
        connections.append({"kind": "weld", "a": "rod", "b": "other"})
    scene = {"gravity": [0, -10], "bodies": bodies, "connections": connections}
    answer = answer_of(scene_from(scene))
    assert answer.equations is not None
    assert answer.trajectory is not None
    known = {name: Jet(mpmath.mpf(value)) for name, value in answer.equations.constants.items()}
    known |= {name: Jet(mpmath.mpf(one.value)) for name, one in answer.equations.start.items()}
    columns = {name: answer.trajectory.columns[f"{name}.angle"].values[0] for name in bodies}
    for name, column in columns.items():
        assert abs(evaluated(plain(answer.equations.places[f"{name}.angle"]), known).value - column) < 1e-13
    for name, formula in answer.equations.coordinates.items():
        assert formula in {f"{one}.angle" for one in columns}
        assert abs(answer.equations.start[name].value - columns[formula.removesuffix(".angle")]) < 1e-13


@pytest.mark.parametrize(
    ("masses", "spring", "rests"),
    [
        # cos(theta) = 1/2 where the bob is at the pulley; upside down at a negative distance; hanging 0.327 m below.
        ((1, 2), None, False),
        ((5, 1), {"b": [-1, -10], "stiffness": 30, "rest_length": 1}, False),
        ((1, 2), {"b": [-1, -4], "stiffness": 30, "rest_length": 1}, True),
    ],
)
def test_small_motions_are_about_places_that_can_be(
    masses: tuple[int, int], spring: dict[str, Any] | None, rests: bool
) -> None:
    bodies = {"weight": {"mass": masses[0], "at": [-1, -2]}, "bob": {"mass": masses[1], "at": [0.6, -0.8]}}
    connections: list[dict[str, Any]] = [{"kind": "string", "through": ["weight", [-1, 0], [0, 0], "bob"]}]
    if spring is not None:
        connections.append({"kind": "spring", "a": "weight", **spring})
    scene = scene_from({"gravity": [0, -9.81], "bodies": bodies, "connections": connections})
    answer = solve_scene(scene, [], ["equations", "equilibria"])
    assert answer.equations is not None
    places = [one.about["weight.y"] for one in answer.equations.linear]
    assert places == pytest.approx([one.positions["weight"][1] for one in answer.equilibria or ()])
    assert bool(places) == rests
