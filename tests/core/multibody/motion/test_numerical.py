"""Stated errors of series, doubles and pairs, against runs of higher order in pairs; and motions at extremes."""

from __future__ import annotations

from fractions import Fraction
from functools import partial

import mpmath
import numpy as np
import pytest

from core.balls import precision
from core.errors import AccuracyUnreachable, BudgetExceeded, MechanicsError
from core.multibody.algebra.polynomials import BITS
from core.multibody.equations.dynamics import accelerations
from core.multibody.motion.periods import repeating
from core.multibody.motion.run import Run
from core.multibody.motion.vertical_symmetry import precessing
from core.multibody.solve import solve_scene
from tests.core.multibody.judge import KINDS, judged, numerical, stated_over_true
from tests.core.multibody.random_scenes import any_scene, attracted_or_rolling, pendulum_of_points
from tests.core.multibody.worked_examples import column, points, read


@pytest.mark.parametrize("kind", range(KINDS))
def test_errors_are_never_stated_too_small(kind: int) -> None:
    """In all, 330 motions with two times each; `tests.core.multibody.judge` judges any number of them."""
    ratios = [
        ratio
        for number in range(30)
        for ratio in stated_over_true(KINDS * number + kind, (False, True) if number < 5 else (False,))
    ]
    assert min(ratios, default=np.inf) > 1.0


@pytest.mark.parametrize("kind", range(7))
def test_errors_of_attraction_and_of_balls_are_never_stated_too_small(kind: int) -> None:
    """In all, 140 motions with two times each."""
    ratios = []
    for number in range(20):
        try:
            runs = (False, True) if number < 4 else (False,)
            ratios.extend(stated_over_true(7 * number + kind, runs, attracted_or_rolling))
        except MechanicsError:
            # Bodies that nearly collide are followed by neither.
            assert kind in (0, 1, 6)
    assert min(ratios, default=np.inf) > 1.0
    assert len(ratios) > 5 or kind in (2, 3, 4)


@pytest.mark.parametrize("seed", [4, 6, 10, 15, 17, 21, 26, 28, 32, 37, 39, 43, 48, 50, 54])
def test_one_period_agrees_with_the_series(seed: int) -> None:
    with precision(BITS):
        (motion,) = numerical(any_scene(seed))
        gain, chosen = accelerations(motion.table)
        periodic = repeating(motion.table, gain, chosen) or precessing(motion.table, gain, chosen)
        assert periodic is not None
        for t in np.random.default_rng(seed).uniform(-6, 6, 3):
            right = judged(motion, float(t))
            found = periodic.states(np.array([t]))
            for value, error, expected in zip((found.q, found.v), (found.q_error, found.v_error), right, strict=True):
                true = np.abs((value[0, :, 0] - expected[:, 0]) + (value[0, :, 1] - expected[:, 1]))
                assert np.all(true <= error[0] + 2.0**-90 * np.abs(expected[:, 0]).max())
                assert np.all(error[0] <= 2.0**-75 * (1 + np.abs(expected).max()))


@pytest.mark.parametrize("power", [-300, -30, 30, 300])
def test_lengths_of_any_size(power: int) -> None:
    """A double pendulum of 2^power metres at 2^power times gravity is the same motion."""
    factor = f"1e{power // 3}"
    scene = points((1, 2), ("0.7", "-1"), (1, 3))
    answer = solve_scene(read(scene), [0.0, 1.5])
    for body in scene["bodies"].values():
        body["at"] = [f"({x})*{factor}" for x in body["at"]]
    scene["gravity"] = [0, f"-9.81*{factor}"]
    scaled = solve_scene(read(scene), [0.0, 1.5])
    a, b = column(answer, "p1.position"), column(scaled, "p1.position")
    assert np.abs(a.values - b.values / float(factor)).max() <= a.error + b.error / float(factor) + 1e-15


@pytest.mark.parametrize("factor", ["1e-150", "1e-26", "1e100"])
def test_masses_of_any_size(factor: str) -> None:
    scene = points((1, 2), ("0.7", "-1"), (1, 3))
    answer = solve_scene(read(scene), [1.5], ("trajectory", "forces-in-time"))
    for body in scene["bodies"].values():
        body["mass"] = f"{body['mass']}*{factor}"
    scaled = solve_scene(read(scene), [1.5], ("trajectory", "forces-in-time"))
    a, b = column(answer, "p1.position"), column(scaled, "p1.position")
    assert np.abs(a.values - b.values).max() <= a.error + b.error
    assert column(scaled, "r0.force").values[0] / float(factor) == pytest.approx(
        column(answer, "r0.force").values[0], rel=1e-12
    )


@pytest.mark.parametrize("masses", [("1", "1e-12"), ("1e-12", "1"), ("1", "1e12"), ("1e-6", "1")])
def test_mass_ratios_of_a_million_million(masses: tuple[str, str]) -> None:
    answer = solve_scene(read(points((1, 1), ("0.9", "1.3"), masses)), [0.05], accuracy=1e-6)
    place = column(answer, "p1.position")
    with precision(BITS):
        (motion,) = numerical(points((1, 1), ("0.9", "1.3"), masses))
        q, _ = judged(motion, 0.05)
    # The coordinates that remain are those of the points.
    right = dict(zip(motion.table.names, q[:, 0], strict=True))
    assert np.hypot(place.values[0, 0] - right["p1.x"], place.values[0, 1] - right["p1.y"]) <= place.error < 1e-6


def test_stiff_springs_are_followed() -> None:
    scene = {
        "gravity": [0, -9.81],
        "bodies": {"p": {"mass": 1, "at": [1, 0]}},
        "connections": [{"kind": "spring", "a": "p", "b": [0, 0], "stiffness": 1e8, "rest_length": 1}],
    }
    answer = solve_scene(read(scene), [0.5])
    assert column(answer, "p.position").error < 1e-9
    rigid = solve_scene(read({**scene, "connections": [{"kind": "rod", "a": "p", "b": [0, 0]}]}), [0.5])
    away = column(answer, "p.position").values - column(rigid, "p.position").values
    assert np.linalg.norm(away) < 1e-5


@pytest.mark.parametrize(("kind", "apart"), [("reference", 2.0**-68), ("fine", 2.0**-85), ("check", 2.0**-85)])
@pytest.mark.parametrize("way", [1.0, -1.0])
def test_a_run_in_pairs_goes_on_from_where_it_ended(kind: str, apart: float, way: float) -> None:
    """Its steps are those of a run from the start, to their tolerance and the growth of the rounding of pairs."""
    with precision(BITS):
        (whole,), (grown,) = (numerical(points((1, 2), ("0.7", "-1"), (1, 3))) for _ in range(2))
        right = whole.run(kind, 8.0 * way)
        for end in np.linspace(0.0, 8.0, 30):
            found = grown.run(kind, float(end) * way)
            assert abs(found.end) >= end
            assert len(found.starts) == len(found.series) + 1
    assert found.end == right.end
    np.testing.assert_allclose(found.starts[:, 0], right.starts[:, 0], rtol=1e-12, atol=0)
    assert np.abs((found.series[:, :, :2] - right.series[:, :, :2]).sum(axis=-1)).max() < apart
    # What was found before stays as it was.
    early = grown.run(kind, 1.0 * way)
    assert early is found


def test_steps_that_a_search_takes_grow_with_its_length() -> None:
    """A search along a stiff motion asks on and on: what lies behind is not followed again."""
    (one,) = numerical(points((1, 2), ("0.7", "-1"), (1, 3)))
    taken = []
    steps = one.steps

    def counted(kind: str, end: float, since: Run | None = None) -> Run:
        found = steps(kind, end, since)
        taken.append(len(found.series) - (0 if since is None else len(since.series) - 1))
        return found

    one.steps = counted  # type: ignore[method-assign]
    for end in np.linspace(0.0, 8.0, 30):
        found = one.run("reference", float(end))
    assert sum(taken) <= len(found.series) + 30


def test_a_grown_run_has_no_more_steps_than_any(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("core.multibody.motion.run.MOST_STEPS", 40)
    monkeypatch.setattr("core.multibody.motion.series_run._CHUNK", 2**14)
    (one,) = numerical(points((1, 2), ("0.7", "-1"), (1, 3)))
    ends = iter(np.linspace(0.0, 40.0, 80).tolist())
    with pytest.raises(BudgetExceeded, match="steps"):
        list(map(partial(one.run, "reference"), ends))
    assert 1.0 < next(ends) < 39.0


def test_a_motion_that_would_take_too_many_steps_is_refused() -> None:
    with pytest.raises((BudgetExceeded, AccuracyUnreachable)):
        solve_scene(read(pendulum_of_points(np.random.default_rng(1), 3)), [1e7])


@pytest.mark.parametrize("speed", ["1", "0.3", "0.01", "1e-6", "1e-9", "1e-12", "1e-20", "1e-100"])
@pytest.mark.parametrize("angle", ["0.3", "1", "2.5"])
def test_what_starts_beside_its_turning_point_has_a_period(speed: str, angle: str) -> None:
    """It passes its place twice in 2 v/a; K of the energy: sin^2(amplitude/2) = sin^2(angle/2) + v^2/(4 g l)."""
    scene = {
        "gravity": [0, "-9.81"],
        "bodies": {
            "bob": {
                "mass": 1,
                "at": [f"sin({angle})", f"-cos({angle})"],
                "velocity": [f"{speed}*cos({angle})", f"{speed}*sin({angle})"],
            }
        },
        "connections": [{"kind": "rod", "a": "bob", "b": [0, 0]}],
    }
    answer = solve_scene(read(scene), [0.1])
    with mpmath.workdps(30):
        g = mpmath.mpf("9.81")
        m = mpmath.sin(mpmath.mpf(angle) / 2) ** 2 + mpmath.mpf(speed) ** 2 / (4 * g)
        assert answer.period == pytest.approx(float(4 * mpmath.ellipk(m) / mpmath.sqrt(g)), rel=4e-16)


def on_a_line(cosine: str, sine: str) -> dict[str, object]:
    """Return a body at rest that hangs from a place on a line, all turned about the vertical."""
    return {
        "gravity": [0, 0, -10],
        "bodies": {
            "b": {
                "mass": 1,
                "moments": [0.1, 0.2, 0.3],
                "at": [0, 0, 0],
                "axes": [[cosine, sine, 0], [f"-({sine})", cosine, 0], [0, 0, 1]],
                "places": {"p": [0.5, 0, 0]},
            }
        },
        "connections": [
            {
                "kind": "track",
                "place": "b.p",
                "on": {
                    "at": [f"({cosine})/2", f"({sine})/2", 0],
                    "direction": [f"0.6*({cosine}) - 0.8*({sine})", f"0.6*({sine}) + 0.8*({cosine})", 0],
                },
            }
        ],
    }


@pytest.mark.parametrize(("cosine", "sine"), [("1", "0"), ("0.8", "-0.6"), ("5/13", "12/13")])
def test_coordinates_that_only_rounding_moves_do_not_shorten_steps(cosine: str, sine: str) -> None:
    times = (0.2, 0.5)
    # Turned by acos 3/5 the line lies along x, and the coordinate across it is given away.
    expected = solve_scene(read(on_a_line("0.6", "-0.8")), times, ("trajectory",))
    found = solve_scene(read(on_a_line(cosine, sine)), times, ("trajectory",))
    first, second = (column(one, "b.position") for one in (expected, found))
    back = complex(0.6, -0.8) / complex(Fraction(cosine), Fraction(sine))
    turned = (np.asarray(second.values)[:, :2] @ [1, 1j]) * back
    assert np.max(np.abs(turned - np.asarray(first.values)[:, :2] @ [1, 1j])) < 1e-14
    assert np.max(np.abs(np.asarray(second.values)[:, 2] - np.asarray(first.values)[:, 2])) < 1e-14


@pytest.mark.parametrize("apart", [("5", "0"), ("-4", "3"), ("-60/13", "25/13"), ("2*cos(1)", "2*sin(1)")])
@pytest.mark.parametrize("between", ["gravitation", "damper"])
def test_a_force_that_a_rod_balances_does_not_stop_what_only_rounding_turns(
    apart: tuple[str, str], between: str
) -> None:
    """Two stones joined by a rod leave two equal humps at once, at two thirds of the height, and fall side by side.

    Before that no stone comes into line with the rod.
    """
    x, y = apart
    bodies = {"a": {"mass": 1, "at": ["0.6", "0.8"]}, "b": {"mass": 1, "at": [f"0.6 + {x}", f"0.8 + {y}"]}}
    force = {"gravitation": {"constant": 1}, "damper": {"coefficient": 2}}[between]
    connections = [
        {"kind": "contact", "place": "a", "on": {"at": [0, 0], "radius": 1}},
        {"kind": "contact", "place": "b", "on": {"at": [x, y], "radius": 1}},
        {"kind": "rod", "a": "a", "b": "b"},
        {"kind": between, "a": "a", "b": "b", **force},
    ]
    answer = solve_scene(
        read({"gravity": [0, -10], "bodies": bodies, "connections": connections}), [0.5], ("trajectory",)
    )
    assert [event.kind for event in answer.events] == ["lift-off", "lift-off"]
    with mpmath.workdps(30):
        leaves, start = mpmath.mpf(8) / 15, mpmath.acos(mpmath.mpf("0.8"))
        # The angle from the top grows at sqrt(2 g (0.8 - cos)); its way is taken as s^2.
        slide = mpmath.quad(
            lambda s: 2 * s / mpmath.sqrt(40 * mpmath.sin(start + s * s / 2) * mpmath.sin(s * s / 2)),
            [0, mpmath.sqrt(mpmath.acos(leaves) - start)],
        )
        speed, late = mpmath.sqrt(20 * (mpmath.mpf("0.8") - leaves)), mpmath.mpf("0.5") - slide
        across, down = speed * leaves, speed * mpmath.sqrt(1 - leaves**2)
        expected = [mpmath.sqrt(1 - leaves**2) + across * late, leaves - down * late - 5 * late**2]
    place = column(answer, "a.position")
    assert np.max(np.abs(np.asarray(place.values)[0] - [float(x) for x in expected])) <= place.error + 1e-15


def test_a_damper_sets_the_unit_of_time_where_only_rounding_moves() -> None:
    """Two stones with a damper between them leave their loops at once, and fly side by side as one alone does."""
    bodies = {name: {"mass": 2, "at": [x, -1], "velocity": ["sqrt(35)", 0]} for name, x in (("a", 0), ("b", 5))}
    connections = [
        {"kind": "contact", "name": f"loop-{name}", "place": name, "on": {"at": [x, 0], "radius": -1}}
        for name, x in (("a", 0), ("b", 5))
    ]
    damper = {"kind": "damper", "a": "a", "b": "b", "coefficient": 0.5}
    times = [0.36, 0.6, 0.8]
    both = solve_scene(read({"gravity": [0, -10], "bodies": bodies, "connections": [*connections, damper]}), times)
    alone = solve_scene(
        read({"gravity": [0, -10], "bodies": {"a": bodies["a"]}, "connections": connections[:1]}), times
    )
    assert [event.kind for event in both.events] == ["lift-off", "lift-off"]
    first, second = column(both, "a.position"), column(alone, "a.position")
    assert np.max(np.abs(np.asarray(first.values) - np.asarray(second.values))) <= first.error + second.error
