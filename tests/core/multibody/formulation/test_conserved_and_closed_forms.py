"""What equations say to be conserved is, and their closed forms are the motion, in every scene of the catalogue."""

from __future__ import annotations

import re

import mpmath
import pytest

from core.multibody.equations_answer import SceneEquations
from service.routes.scene_catalogue import scene_catalogue
from tests.core.multibody.formulation.reading import Jet, evaluated
from tests.core.multibody.formulation.test_scene_equations import ASKED, answer_of, columns_at, scene_of

LATER = 0.03
"""Time (s) that every motion of the catalogue reaches in its first phase."""

CONSERVED = {
    name: count
    for count, names in {
        0: """
            band-brake bead-on-rough-ring
            block-on-spring-with-friction
            block-up-rough-incline
            crank-slider damped-governor damped-oscillator drawer-pulled-aside
            driven-duffing-oscillator fall-with-drag
            four-legged-table kapitza-pendulum
            rope-on-bollard sleeping-top
            stone-across-slope
        """,
        1: """
            slip-to-roll
            disc-slips-down-incline
            blocks-pulled
            block-on-plank-in-space
            block-on-plank
            backspin-returns
            ball-in-bowl centrifugal-governor coin-rolls-round coupled-pendulums four-bar-linkage lagrange-points
            plank-on-two-strings rattleback rod-in-cylinder rod-on-edge
            atwood-machine atwood-machine-with-spring ball-on-ball-dropped bead-on-hoop
            bead-on-parabola bead-on-rotating-rod block-and-tackle block-tips-over rocking-block
            blocks-on-incline breaking-string
            bounce-to-rest chain-off-table chain-over-peg cradle-of-two cylinder-in-cylinder
            cylinder-on-incline disc-leaves-cylinder double-pendulum
            double-pendulum-of-points dumbbell-dropped dumbbell-dropped-in-space elastic-pendulum
            inverted-pendulum-on-torsion-spring ladder-leaves-wall ladder-on-rails
            loaded-hoop loop-with-slack-string massive-pulley
            pendulum-on-a-nail pendulum-on-cart pendulum-timed
            physical-pendulum rod-against-stop simple-pendulum spool spool-rolls-away
            spool-winds-up stone-leaves-hollow-sphere struck-rod swinging-atwood-machine trammel two-masses-two-springs
            weight-lands yo-yo
        """,
        2: """
            three-body-figure-eight
            sphere-on-turntable
            movable-wedge
            harmonic-ellipse
            double-atwood-machine
            alpha-particle asymmetric-top ball-and-stick ball-in-cylinder
            ballistic-pendulum blocks-count-pi conical-pendulum
            cylinder-on-cylinder cylinder-on-movable-wedge foucault-pendulum gyroscope-with-offset-mass
            kepler-ellipse kovalevskaya-top lagrange-top precessing-top sphere-on-incline spherical-pendulum
            spinning-disc-bounces vibrating-dumbbell weight-under-table
        """,
        3: """
            shafts-on-wedge
            ball-bounces-with-spin dumbbell
        """,
        4: """
        """,
        5: """
            billiard-ball
            thrown-body
            binary-stars
        """,
    }.items()
    for name in names.split()
}
"""How many quantities the equations of each scene of the catalogue show to be conserved."""

CLOSED = {
    name: count
    for count, names in {
        0: """
            alpha-particle asymmetric-top atwood-machine-with-spring ball-in-bowl ball-in-cylinder bead-on-hoop
            bead-on-parabola bead-on-rough-ring centrifugal-governor coin-rolls-round conical-pendulum
            coupled-pendulums crank-slider cylinder-on-cylinder double-pendulum double-pendulum-of-points
            drawer-pulled-aside driven-duffing-oscillator elastic-pendulum fall-with-drag foucault-pendulum
            damped-governor
            four-bar-linkage four-legged-table gyroscope-with-offset-mass inverted-pendulum-on-torsion-spring
            kapitza-pendulum kepler-ellipse kovalevskaya-top lagrange-points lagrange-top loaded-hoop
            pendulum-on-cart plank-on-two-strings precessing-top rattleback rod-in-cylinder rod-on-edge
            sleeping-top sphere-on-turntable spherical-pendulum stone-across-slope swinging-atwood-machine
            three-body-figure-eight trammel vibrating-dumbbell weight-under-table
        """,
        1: """
            atwood-machine ball-and-stick ball-on-ball-dropped bead-on-rotating-rod block-and-tackle
            block-tips-over blocks-count-pi blocks-on-incline bounce-to-rest chain-off-table chain-over-peg
            breaking-string cradle-of-two cylinder-in-cylinder
            cylinder-on-incline damped-oscillator disc-leaves-cylinder
            dumbbell-dropped dumbbell-dropped-in-space ladder-leaves-wall ladder-on-rails loop-with-slack-string
            massive-pulley pendulum-on-a-nail pendulum-timed physical-pendulum
            rocking-block rod-against-stop simple-pendulum spool
            spool-rolls-away spool-winds-up stone-leaves-hollow-sphere struck-rod weight-lands yo-yo
        """,
        2: """
            ballistic-pendulum band-brake binary-stars block-on-spring-with-friction block-up-rough-incline
            cylinder-on-movable-wedge
            double-atwood-machine harmonic-ellipse movable-wedge rope-on-bollard sphere-on-incline
            spinning-disc-bounces two-masses-two-springs
        """,
        3: """
            backspin-returns ball-bounces-with-spin block-on-plank block-on-plank-in-space
            disc-slips-down-incline dumbbell shafts-on-wedge slip-to-roll thrown-body
        """,
        4: """
            blocks-pulled
        """,
        6: """
            billiard-ball
        """,
    }.items()
    for name in names.split()
}
"""How many coordinates of each are elementary or elliptic functions of the time."""

UNSEEN = {"ball-bounces-with-spin": (2, 1), "lagrange-top": (2, 0), "precessing-top": (2, 0)}
"""Of how many of both no column shows, at a later time, the rates on which they depend."""


def later(name: str) -> tuple[SceneEquations, dict[str, Jet], dict[str, Jet], float]:
    """Return the equations of a scene of the catalogue, its columns at `LATER`, the time and constants, its energy."""
    scene = scene_of(scene_catalogue()[name].question)
    answer = answer_of(scene, [0.0, LATER])
    assert answer.equations is not None
    assert answer.trajectory is not None
    assert len(answer.trajectory.time) == 2
    assert not answer.phases or len(answer.phases) == 1
    known = {key: Jet(mpmath.mpf(x)) for key, x in answer.equations.constants.items()}
    known["t"] = Jet(mpmath.mpf(LATER), mpmath.mpf(1))
    assert answer.energy is not None
    return answer.equations, columns_at(scene, answer, 1), known, answer.energy.total


def test_the_energy_of_a_part_beside_one_that_loses_energy_has_its_coordinates_in_its_name() -> None:
    equations, *_ = later("billiard-ball")
    names = [one.name for one in equations.conserved]
    assert "energy of ball.turn.z" in names
    assert "momentum of ball.turn.z" in names


def test_momenta_are_found_that_are_of_no_single_coordinate() -> None:
    """Along a floor without friction, about the contact of a ball that slips, and about a centre of force."""
    for name, kept in {
        "movable-wedge": "momentum of wedge.x, block.x: block.x' + 3*wedge.x'",
        "slip-to-roll": "momentum of disc.x, disc.angle: 0.005*disc.angle' - 0.1*disc.x'",
        "harmonic-ellipse": "angular momentum of bob.x, bob.y: 2*bob.x*bob.y' - 2*bob.x'*bob.y",
    }.items():
        equations, *_ = later(name)
        assert kept in [f"{one.name}: {one.formula.plain}" for one in equations.conserved]


def test_every_scene_of_the_catalogue_is_expected_to_conserve_something_or_nothing() -> None:
    assert sorted(CONSERVED) == sorted(CLOSED) == ASKED


@pytest.mark.parametrize("name", ASKED)
def test_what_is_said_to_be_conserved_stays(name: str) -> None:
    equations, columns, jets, energy = later(name)
    for key, text in equations.coordinates.items():
        if text is None and key in columns:
            jets[key] = columns[key]
        elif text is not None and names_in(text) <= {*columns, *jets}:
            jets[key] = evaluated(text, columns | jets)
    compared = 0
    for one in equations.conserved:
        if names_in(one.formula.plain) <= set(jets):
            compared += 1
            value = float(evaluated(one.formula.plain, jets).value)
            assert value == pytest.approx(one.value, rel=1e-7, abs=1e-7), one.name
        if one.name == "energy":
            assert one.value == pytest.approx(energy, rel=1e-15)
    assert len(equations.conserved) == CONSERVED[name]
    assert compared == CONSERVED[name] - UNSEEN.get(name, (0, 0))[0]


@pytest.mark.parametrize("name", ASKED)
def test_closed_forms_are_the_motion(name: str) -> None:
    equations, columns, jets, _ = later(name)
    compared = 0
    for key, formula in equations.closed_form.items():
        text, moved = equations.coordinates[key], evaluated(formula.plain, jets)
        if text is None:
            # Of a turn about an axis of space columns show the rate alone.
            there = columns.get(key)
        else:
            there = evaluated(text, columns | jets)
            assert float(moved.value) == pytest.approx(float(there.value), rel=1e-10, abs=1e-10), key
        if there is not None:
            compared += 1
            assert float(moved.rate) == pytest.approx(float(there.rate), rel=1e-8, abs=1e-8), key
    assert len(equations.closed_form) == CLOSED[name]
    assert compared == CLOSED[name] - UNSEEN.get(name, (0, 0))[1]


def names_in(text: str) -> set[str]:
    """Return the names in a formula, without primes."""
    found = re.findall(r"(?<![\w.])[A-Za-z][A-Za-z0-9_]*(?:-[A-Za-z0-9_]+)*(?:\.[A-Za-z][\w-]*)*(?!\w*\()", text)
    return {*found} - {"sin", "cos", "sqrt", "exp", "atan2"}


@pytest.mark.parametrize("power", [0, 1, 2])
@pytest.mark.parametrize("turning", [0, 2])
def test_central_forces_by_formula_keep_angular_momentum(power: int, turning: int) -> None:
    """A field along the place, with a magnetic one: m (x vy - y vx) + q B (x^2 + y^2)/2."""
    pull = f"-(x^2 + y^2)^{power}" if power else "-1"
    question = {
        "bodies": {"stone": {"mass": 1.5, "at": [1, 0.25], "velocity": [-0.3, 0.5]}},
        "connections": [{"kind": "field", "force": [f"{pull}*x + {turning}*vy", f"{pull}*y - {turning}*vx"]}],
    }
    scene = scene_of(question)
    answer = answer_of(scene, [0.0, 0.7, 1.9])
    assert answer.equations is not None
    (kept,) = answer.equations.conserved
    assert kept.name == "angular momentum of stone.x, stone.y"
    for row in range(3):
        jets = columns_at(scene, answer, row)
        x, y = jets["stone.x"], jets["stone.y"]
        by_hand = 1.5 * (x.value * y.rate - y.value * x.rate) + turning * (x.value**2 + y.value**2) / 2
        assert float(by_hand) == pytest.approx(kept.value, rel=1e-12)


def test_nested_powers_of_a_law_are_not_multiplied_out() -> None:
    question = {
        "bodies": {"stone": {"mass": 1, "at": [0.1, 0.2]}},
        "connections": [{"kind": "field", "force": ["(((1 + x + y)^9)^9)^9", "0"]}],
    }
    equations = answer_of(scene_of(question), [0.0]).equations
    assert equations is not None
    assert all("stone.x" not in one.name for one in equations.conserved)
