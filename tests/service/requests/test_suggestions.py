"""Names, paths and numbers of times that clients probably meant."""

from __future__ import annotations

import dataclasses
from typing import get_args

import pytest
from hypothesis import given
from hypothesis import strategies as st

from core.bodies import Body
from core.multibody.language.body import SceneBody
from core.near_names import LONGEST_NAME, plain
from core.quantities import members_of
from core.studies.statistics import Statistic
from core.systems.methods import Method
from service.requests.suggestions import SYNONYMS, count_in_place_of_step, nearest, nearest_path
from service.routes import questions

KINDS = [member.kind for union in (Body, Method) for member in members_of(union)]  # type: ignore[attr-defined]
PATHS = [route.path for route in questions()]


def test_every_word_stands_for_a_name_that_there_is() -> None:
    assert get_args(Body)
    fields = {name for route in questions() for name in _names(route.question)}
    outputs = {"time", "apex_tension", "tension", "acceleration", "accelerations"}
    inner = {"density", "moments", "tensor", "radius", "mass", "tolerance", "step"}
    of_bodies = {field.name for field in dataclasses.fields(SceneBody)}
    assert set(SYNONYMS) <= {*KINDS, *fields, *outputs, *inner, *of_bodies, *get_args(Statistic)}


def test_words_of_free_rotation_are_answered_with_those_of_a_scene() -> None:
    names = [field.name for field in dataclasses.fields(SceneBody)]
    assert [nearest(word, names) for word in ("attitude", "quaternion", "position")] == ["axes", "axes", "at"]


def _names(question: object) -> set[str]:
    members = [question, *get_args(question), *(part for entry in get_args(question) for part in get_args(entry))]
    return {name for member in members for name in getattr(member, "model_fields", ())}


def test_a_name_is_never_taken_for_another() -> None:
    for kind in KINDS:
        assert nearest(kind, KINDS) == nearest(kind.upper().replace("-", "_"), KINDS) == kind


@given(st.text(max_size=200))
def test_whatever_is_written_is_answered_with_a_name_or_none(written: str) -> None:
    found = nearest(written, KINDS)
    assert found is None or found in KINDS
    if len(written) > LONGEST_NAME:
        assert found is None


@pytest.mark.parametrize(
    ("written", "meant"),
    [
        ("/v1/rotation/trajectories", "/v1/rotation/trajectory"),
        ("/rotation/trajectory", "/v1/rotation/trajectory"),
        ("/v1/rotations/precession/", "/v1/rotation/precession"),
        ("/v1/scenes/rod_in_hole", "/v1/scenes/rod-in-hole"),
        ("/v1/mass-properties", "/v1/bodies/mass-properties"),
        ("/V1/Bodies/Mass-Properties", "/v1/bodies/mass-properties"),
        ("/wp-admin.php", None),
        ("/", None),
        ("/" + "x" * 10_000, None),
    ],
)
def test_an_unknown_path_has_a_nearest_one(written: str, meant: str | None) -> None:
    assert nearest_path(written, PATHS) == meant


@given(st.integers(1, 10**6), st.floats(-1e3, 1e3), st.sampled_from([0.1, 0.25, 1e-3, 3.0, -0.5]))
def test_the_number_of_times_is_that_of_the_steps(count: int, start: float, step: float) -> None:
    span = {"start": start, "stop": start + (count - 1) * step, "step": step}
    told = count_in_place_of_step(span, step)
    # Where start swallows the last digits of stop the spacing is another, and is told.
    assert told.split(": ")[1].split(",")[0] == f"count = {count}"


def test_plain_names_have_letters_and_digits_alone() -> None:
    assert plain("Runge_Kutta-4") == "rungekutta4"
