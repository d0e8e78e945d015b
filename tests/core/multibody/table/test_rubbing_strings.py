"""Strings with friction on pegs: Euler's law of the capstan, against closed forms."""

from __future__ import annotations

import math
from typing import Any

import pytest

from core.errors import InvalidParameter, NotApplicable
from core.multibody.solve import DEFAULT_OUTPUTS, solve_scene
from core.multibody.statics.thresholds import RestOf
from tests.core.multibody.worked_examples import column, force, read
from tests.oracles.plain_engine.comparison.comparing import compared

G = 9.81
OVER_TWO_PEGS = ["light", [-0.1, 0], [0.1, 0], "heavy"]


def over(through: list[Any], speed: float = 0.0, heavy: float = 3, **more: Any) -> dict[str, Any]:
    """Return masses of 1 kg and more that hang 1 m below two pegs, the lighter rising at a speed."""
    return {
        "gravity": [0, -G],
        "bodies": {
            "light": {"mass": 1, "at": [-0.1, -1], "velocity": [0, speed]},
            "heavy": {"mass": heavy, "at": [0.1, -1]},
        },
        "connections": [{"kind": "string", "name": "s", "through": through} | more],
    }


def over_an_edge(dimension: int, weight: float = 2, speed: float = 0, aside: float = 0) -> dict[str, Any]:
    """Return a block of 1 kg on a rough table, with a rope that rubs over its edge to a weight.

    In space the way of the block is turned by the angle of 3-4-5.
    """

    def place(x: float, z: float, y: float = 0) -> list[Any]:
        return [x, z] if dimension == 2 else [f"({x})*4/5 - ({y})*3/5", f"({x})*3/5 + ({y})*4/5", z]

    def velocity(x: float, z: float) -> list[Any]:
        return [x, z] if dimension == 2 else place(x, z, aside)

    table = {"at": place(0, 0), "normal": [0] * (dimension - 1) + [1]}
    return {
        "gravity": place(0, -G),
        "bodies": {
            "block": {"mass": 1, "at": place(-2, 0), "velocity": velocity(speed, 0)},
            "weight": {"mass": weight, "at": place(0, -1), "velocity": place(0, -speed)},
        },
        "connections": [
            {"kind": "contact", "name": "t", "place": "block", "on": table, "friction": 0.3},
            {"kind": "string", "name": "s", "through": ["block", place(0, 0), "weight"], "friction": 0.1},
        ],
    }


@pytest.mark.parametrize("through", [OVER_TWO_PEGS, OVER_TWO_PEGS[::-1]], ids=["forth", "back"])
@pytest.mark.parametrize("turned", [False, True])
def test_the_heavier_mass_sinks_by_the_ratio_of_the_capstan(through: list[Any], turned: bool) -> None:
    """a = g (M - k m)/(M + k m), k = exp(mu pi); both tensions by Newton's law for each mass."""
    k = math.exp(0.2 * math.pi)
    gain = G * (3 - k) / (3 + k)
    scene = over(through, friction=0.2)
    if turned:
        # By the angle of 3-4-5, and moved far away.
        def place(x: float, y: float) -> list[str]:
            return [f"1000 + ({x})*4/5 - ({y})*3/5", f"-500 + ({x})*3/5 + ({y})*4/5"]

        scene["gravity"] = [f"{G}*3/5", f"-{G}*4/5"]
        for name, x in (("light", -0.1), ("heavy", 0.1)):
            scene["bodies"][name] = scene["bodies"][name] | {"at": place(x, -1), "velocity": [0, 0]}
        scene["connections"][0]["through"] = [x if isinstance(x, str) else place(*x) for x in through]
    answer = solve_scene(
        read(scene), [0.0, 0.5], [*DEFAULT_OUTPUTS, "forces-in-time", "work-in-time", "energy-in-time"]
    )
    assert answer.model.name == "constant acceleration"
    fall = column(answer, "heavy.position").values[0] - column(answer, "heavy.position").values[1]
    assert float((fall**2).sum() ** 0.5) == pytest.approx(gain / 8, rel=1e-12)
    ends = {through[0]: "s.1.tension", through[-1]: "s.2.tension"}
    low, high = (column(answer, ends[name]).values[1] for name in ("light", "heavy"))
    assert low == pytest.approx(G + gain, rel=1e-13)
    assert high == pytest.approx(3 * (G - gain), rel=1e-13)
    assert high / low == pytest.approx(k, rel=1e-13)
    assert force(answer, ends["light"]) == pytest.approx(low, rel=1e-13)
    assert force(answer, ends["heavy"]) == pytest.approx(high, rel=1e-13)
    assert column(answer, "s.tension").values[1] == pytest.approx((low + high) / 2, rel=1e-14)
    # The string rubs over the way by which it passes.
    assert column(answer, "s.friction.work").values[1] == pytest.approx(-(high - low) * gain / 8, rel=1e-12)


def test_what_moves_is_braked_and_held_by_the_static_coefficient() -> None:
    """Rising at 2 m/s the light mass slows down at g (k M - m)/(m + k M) while it sinks, and then the string sticks."""
    k = math.exp(0.2 * math.pi)
    answer = solve_scene(
        read(over(OVER_TWO_PEGS, -2, friction=[0.5, 0.2])), [0.0, 0.5], ["trajectory", "forces-in-time"]
    )
    (event,) = answer.events
    assert (event.kind, event.name) == ("stick", "s")
    assert event.time == pytest.approx(2 / (G * (3 * k - 1) / (1 + 3 * k)), rel=1e-13)
    assert column(answer, "light.velocity").values[1] == pytest.approx([0, 0], abs=1e-15)
    assert column(answer, "s.friction").values[1] == pytest.approx(2 * G, rel=1e-13)


def test_thresholds_of_rest_are_those_of_the_capstan() -> None:
    """ln(M/m)/pi of the coefficient, and ln(M/m)/(2 pi mu) - 1/2 turns around a bollard."""
    held = over(OVER_TWO_PEGS, friction=0.5)
    wound = over(OVER_TWO_PEGS, heavy=50, friction=0.2, turns=3)
    expected = [math.log(3) / math.pi, math.log(50) / (0.4 * math.pi) - 0.5]
    for scene, entry, value in zip((held, wound), ("friction", "turns"), expected, strict=True):
        answer = solve_scene(read(scene), outputs=[RestOf(f"/connections/0/{entry}", (0, 9))])
        assert answer.thresholds is not None
        assert answer.thresholds[0].lower.value == pytest.approx(value, rel=1e-13)


def test_a_string_that_goes_on_straight_does_not_rub() -> None:
    scene = {
        "bodies": {"a": {"mass": 1, "at": [-1, 0], "velocity": [1, 0]}, "b": {"mass": 1, "at": [1, 0]}},
        "connections": [{"kind": "string", "name": "s", "through": ["a", [0, 0], "b"], "friction": 0.4}],
    }
    answer = solve_scene(read(scene), outputs=["forces"])
    assert force(answer, "s.friction") == 0.0


def test_in_space_it_holds_as_in_the_plane() -> None:
    plane = over(OVER_TWO_PEGS, friction=0.2)
    space = {
        "gravity": [0, 0, -G],
        "bodies": {"light": {"mass": 1, "at": [0, -0.1, -1]}, "heavy": {"mass": 3, "at": [0, 0.1, -1]}},
        "connections": [plane["connections"][0] | {"through": ["light", [0, -0.1, 0], [0, 0.1, 0], "heavy"]}],
    }
    one, other = (solve_scene(read(scene), [0.4], ["trajectory"]) for scene in (plane, space))
    assert column(one, "heavy.position").values[0][1] == column(other, "heavy.position").values[0][2]


@pytest.mark.parametrize(
    ("scene", "times"),
    [
        (over(OVER_TWO_PEGS, -2, friction=[0.5, 0.2]), [0.0, 0.2, 0.5]),
        (over(OVER_TWO_PEGS, -2, heavy=1.1, friction=0.2, length=2.5), [0.0, 0.3, 0.6]),
        (over(OVER_TWO_PEGS, -1, friction=0.1, restitution=0.5, length=2.3), [0.0, 0.2, 0.4]),
        (over_an_edge(2, speed=-1), [0.0, 0.1, 0.3]),
        (over_an_edge(3, speed=-1), [0.0, 0.1, 0.3]),
    ],
    ids=["sticks", "becomes taut", "jerks", "over an edge", "over an edge in space"],
)
def test_the_plain_engine_agrees(scene: dict[str, Any], times: list[float]) -> None:
    verdict = compared(scene, times)
    assert verdict.differences == []
    assert not verdict.not_supported
    assert verdict.compared > 0


@pytest.mark.parametrize("dimension", [2, 3])
@pytest.mark.parametrize("turned_round", [False, True])
def test_a_weight_draws_a_block_on_a_rough_table_over_its_edge(dimension: int, turned_round: bool) -> None:
    """T_1 - mu m g = m a and M g - k T_1 = M a: a = g (M - mu k m)/(M + k m) with k = exp(mu' pi/2)."""
    k = math.exp(0.1 * math.pi / 2)
    gain = G * (2 - 0.3 * k) / (2 + k)
    for speed in (0.0, 1.0):
        scene = over_an_edge(dimension, speed=speed)
        if turned_round:
            scene["connections"].reverse()
            scene["connections"][0]["through"].reverse()
        answer = solve_scene(read(scene), [0.0, 0.3], ["trajectory", "forces"])
        assert answer.model.name == "constant acceleration"
        fall = column(answer, "weight.velocity").values
        assert fall[0][-1] - fall[1][-1] == pytest.approx(0.3 * gain, rel=1e-12)
        assert force(answer, "s.1.tension" if turned_round else "s.2.tension") == pytest.approx(2 * (G - gain))


@pytest.mark.parametrize("dimension", [2, 3])
def test_a_light_weight_leaves_the_block_at_rest(dimension: int) -> None:
    answer = solve_scene(read(over_an_edge(dimension, weight=0.2)), [0.0, 0.3], ["trajectory"])
    assert answer.model.name == "rest"


@pytest.mark.parametrize("dimension", [2, 3])
def test_a_block_under_the_peg_is_held_by_floor_and_string(dimension: int) -> None:
    """How floor and string share its weight is not determined: the tensions are within exp(mu pi) of one another."""
    between = [0.0] * (dimension - 2)
    weight = {"mass": 0.1, "at": [3, *between, 0]}
    through = ["block", [0, *between, 1], [3, *between, 1], "weight"]
    floor = {"at": [0, *between, 0], "normal": [0, *between, 1]}
    scene = {
        "gravity": [0, *between, -G],
        "bodies": {"block": {"mass": 1, "at": [0, *between, 0]}, "weight": weight},
        "connections": [
            {"kind": "contact", "name": "t", "place": "block", "on": floor, "friction": 0.3},
            {"kind": "string", "name": "s", "through": through, "friction": 0.1},
        ],
    }
    answer = solve_scene(read(scene), [0.0, 0.3], ["trajectory", "forces"])
    assert answer.model.name == "rest"
    assert force(answer, "s.2.tension") == pytest.approx(0.1 * G, rel=1e-13)
    assert answer.forces is not None
    assert answer.forces["s.1.tension"].value is None
    weight["mass"] = 2
    answer = solve_scene(read(scene), [0.0, 0.3], ["trajectory"])
    # Lifted as in Atwood's machine.
    k = math.exp(0.1 * math.pi)
    lifted = column(answer, "block.velocity").values[1][-1]
    assert lifted == pytest.approx(0.3 * G * (2 - k) / (2 + k), rel=1e-12)


def test_a_block_that_slides_askew_is_refused() -> None:
    """Also where its friction turns with the slip."""
    with pytest.raises(NotApplicable, match="change their directions"):
        solve_scene(read(over_an_edge(3, speed=1, aside=0.1)), [0.3], ["trajectory"])


def test_a_string_whose_parts_swing_is_refused() -> None:
    scene = over(OVER_TWO_PEGS, friction=0.2)
    scene["bodies"]["light"]["velocity"] = [0.1, 0]
    with pytest.raises(NotApplicable, match="change their directions") as caught:
        solve_scene(read(scene), [1.0], ["trajectory"])
    assert caught.value.path == ("connections", 0, "friction")


@pytest.mark.parametrize(
    ("changes", "path"),
    [
        ({"through": ["light", "heavy"]}, ("through",)),
        ({"through": ["light", [0, 0]]}, ("through",)),
        ({"friction": -1}, ("friction",)),
        ({"turns": -1}, ("turns",)),
        ({"turns": 2.5}, ("turns",)),
        ({"turns": 0.5}, ("turns",)),
        ({"turns": 1e300}, ("turns",)),
        ({"friction": None}, ("turns",)),
    ],
)
def test_faults_name_their_field(changes: dict[str, Any], path: tuple[str, ...]) -> None:
    with pytest.raises(InvalidParameter) as caught:
        solve_scene(read(over(**{"through": OVER_TWO_PEGS, "friction": 0.2, "turns": 1, **changes})), [1.0])
    assert caught.value.path == ("connections", 0, *path)


def over_a_drum(inertia: Any, friction: Any, spin: float = 0, speed: float = 0, heavy: float = 3) -> dict[str, Any]:
    """Return masses of 1 kg and more that hang from a string over a drum, on which it rubs."""
    return {
        "gravity": [0, -G],
        "bodies": {
            "light": {"mass": 1, "at": [-0.1, -1], "velocity": [0, speed]},
            "heavy": {"mass": heavy, "at": [0.1, -1]},
            "drum": {"mass": 2, "radius": 0.1, "inertia": inertia, "at": [0, 0], "angular_velocity": spin},
        },
        "connections": [
            {"kind": "pin", "name": "axle", "a": "drum", "b": [0, 0]},
            {
                "kind": "string",
                "name": "s",
                "through": ["light", "drum", "heavy"],
                "sides": {"drum": ["left", "right"]},
                "friction": friction,
            },
        ],
    }


def test_a_string_slips_on_a_heavy_drum_by_the_ratio_of_the_capstan() -> None:
    answer = solve_scene(read(over_a_drum(1, 0.1)), [0.4])
    k = math.exp(0.1 * math.pi)
    gain = G * (3 - k) / (3 + k)
    assert answer.accelerations is not None
    assert answer.accelerations["heavy"].linear[1] == pytest.approx(-gain, rel=1e-14)
    # The difference of the tensions turns the drum.
    turned = 0.1 * (3 * (G - gain) - (G + gain))
    assert answer.accelerations["drum"].angular == pytest.approx(-turned, rel=1e-13)
    assert force(answer, "s.2.tension") / force(answer, "s.1.tension") == pytest.approx(k, rel=1e-14)


def test_a_string_sticks_on_a_light_drum_as_on_one_without_slip() -> None:
    rough, plain = over_a_drum(0.001, 0.3), over_a_drum(0.001, 0.3)
    del plain["connections"][1]["friction"]
    rubbing, wound = (solve_scene(read(scene), [0.4]) for scene in (rough, plain))
    assert rubbing.accelerations is not None
    assert wound.accelerations is not None
    assert rubbing.accelerations["heavy"].linear == pytest.approx(wound.accelerations["heavy"].linear, rel=1e-14)
    assert force(rubbing, "s.2.tension") == pytest.approx(force(wound, "s.2.tension"), rel=1e-14)


@pytest.mark.parametrize(("spin", "torque"), [(-30, 1.0), (30, -1.0)])
def test_a_band_brake_has_the_torque_of_its_tensions(spin: float, torque: float) -> None:
    """W (exp(mu pi) - 1) R where the drum draws at the fixed end, W (1 - exp(-mu pi)) R where at the weight."""
    scene = over_a_drum(0.1, 0.3, spin)
    del scene["bodies"]["light"]
    scene["connections"][1]["through"] = [[-0.1, -1], "drum", "heavy"]
    answer = solve_scene(read(scene), [0.2])
    assert answer.accelerations is not None
    expected = 3 * G * torque * (math.exp(torque * 0.3 * math.pi) - 1) * torque * 0.1 / 0.1
    assert answer.accelerations["drum"].angular == pytest.approx(torque * abs(expected), rel=1e-13)
    assert answer.accelerations["heavy"].linear[1] == pytest.approx(0, abs=1e-13)


def test_a_belt_may_wind_by_more_than_half_a_turn() -> None:
    """From above over the left to the right: three quarters of a turn between a fixed end and a pull of 20 N."""
    drum = {"mass": 2, "radius": 0.2, "inertia": 0.1, "at": [0, 0], "angular_velocity": 10}
    scene = {
        "bodies": {"drum": drum, "end": {"mass": 1, "at": [0.2, 1]}},
        "connections": [
            {"kind": "pin", "a": "drum", "b": [0, 0]},
            {"kind": "track", "place": "end", "on": {"at": [0.2, 0], "slope": {"degrees": 90}}},
            {
                "kind": "string",
                "name": "s",
                "through": [[1, 0.2], "drum", "end"],
                "sides": {"drum": ["above", "right"]},
                "friction": 0.2,
            },
            {"kind": "force", "place": "end", "force": [0, 20]},
        ],
    }
    answer = solve_scene(read(scene), [0.1])
    ratio = force(answer, "s.1.tension") / force(answer, "s.2.tension")
    assert ratio == pytest.approx(math.exp(0.2 * 1.5 * math.pi), rel=1e-14)


@pytest.mark.parametrize(
    "scene",
    [
        over_a_drum(1, 0.1),
        over_a_drum(0.001, 0.3),
        over_a_drum(0.05, 0.2, spin=-60),
        over_a_drum(0.05, [0.3, 0.2], spin=60, speed=1),
        over_a_drum(0.05, [0.3, 0.2], spin=-10, speed=1, heavy=1),
    ],
)
def test_a_string_on_a_drum_moves_as_the_plain_engine_says(scene: dict[str, Any]) -> None:
    verdict = compared(scene, [0.0, 0.2, 0.4])
    assert not verdict.not_supported
    assert not verdict.differences
    assert verdict.compared > 0


@pytest.mark.parametrize(
    ("through", "sides"),
    [
        (["light", "drum", [0, 5], "heavy"], ["left", "right"]),
        (["light", "drum", "heavy"], ["left", "left"]),
        ([[-0.1, -1], "drum", [0.1, -1]], ["left", "right"]),
    ],
)
def test_a_string_rubs_on_one_drum_between_ends_that_move(through: list[Any], sides: list[str]) -> None:
    scene = over_a_drum(1, 0.1)
    scene["connections"][1] |= {"through": through, "sides": {"drum": sides}}
    with pytest.raises(InvalidParameter):
        solve_scene(read(scene), [0.1])
