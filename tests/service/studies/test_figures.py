"""Figures of studies: curves over one or two varied numbers, otherwise distributions of what is known."""

from __future__ import annotations

import json
from types import SimpleNamespace
from typing import Any
from xml.etree import ElementTree

import numpy as np
import pytest

from service.studies.figures import MOST_CURVES, figure

SPACE = {"svg": "http://www.w3.org/2000/svg"}
POLYLINE, SAMPLE = (f"{{{SPACE['svg']}}}{tag}" for tag in ("polyline", "line"))


def drawn(vary: list[dict[str, Any]], shape: tuple[int, ...], inputs: Any, figures: Any, **request: Any) -> Any:
    """Return the document for a study of one figure, its inputs of shape (n, axes) and values of shape (n,)."""
    about = {
        "request": {"vary": vary, **request},
        "axes": [
            {"pointer": one["pointer"], "unit": one.get("unit", "m"), "values": one.get("values")} for one in vary
        ],
        "columns": [{"pointer": "/period", "unit": "s"}],
    }
    chunk = SimpleNamespace(inputs=np.array(inputs, float), figures=np.array(figures, float)[:, None])
    study = SimpleNamespace(count=len(figures), plan={"shape": list(shape)})
    results: Any = SimpleNamespace(study=study, chunks=lambda: [chunk], metadata=lambda: about)
    return ElementTree.fromstring(b"".join(figure(results)))


def curves(document: Any) -> list[list[tuple[float, float]]]:
    found = document.findall("svg:polyline", SPACE)
    return [[tuple(map(float, pair.split(","))) for pair in one.attrib["points"].split()] for one in found]


def words(document: Any) -> str:
    return " ".join("".join(text.itertext()) for text in document.iter(f"{{{SPACE['svg']}}}text"))


def test_one_number_gives_a_curve_without_the_members_that_failed() -> None:
    document = drawn([{"pointer": "/length"}], (4,), [[0], [1], [2], [3]], [0.0, 1.0, np.nan, 3.0])
    (curve,) = curves(document)
    assert len(curve) == 3
    # A straight line stays one.
    (x0, y0), (x1, y1), (x3, y3) = curve
    assert (y1 - y0) / (x1 - x0) == pytest.approx((y3 - y0) / (x3 - x0), rel=1e-2)
    assert "length (m)" in words(document)
    assert "period (s)" in words(document)


def test_listed_numbers_stand_for_themselves() -> None:
    document = drawn([{"pointer": "/length", "values": [5.0, 1.0]}], (2,), [[0], [1]], [2.0, 7.0])
    ((first, second),) = curves(document)
    assert first[0] < second[0]
    assert first[1] < second[1], "the length of 1 has the greater figure, and is drawn higher"


@pytest.mark.parametrize("levels", [3, 40])
def test_two_numbers_give_a_curve_for_each_of_few_levels(levels: int) -> None:
    inputs = [[x, y] for x in range(5) for y in range(levels)]
    document = drawn([{"pointer": "/a"}, {"pointer": "/b"}], (5, levels), inputs, [x * y for x, y in inputs])
    found = curves(document)
    assert len(found) == min(levels, MOST_CURVES)
    assert all(len(one) == 5 for one in found)
    assert "b 0" in words(document)
    assert f"Study of {5 * levels} members; curves at {len(found)} of {levels} values of b" in words(document)
    looks = [(one.attrib["stroke"], one.attrib.get("stroke-dasharray")) for one in document.iter(POLYLINE)]
    assert len(set(looks)) == len(found), "every curve can be told from the others"
    assert len({colour for colour, _ in looks}) >= min(levels, 8)
    labels = [(one.attrib["stroke"], one.attrib.get("stroke-dasharray")) for one in document.iter(SAMPLE)]
    assert labels[-len(found) :] == looks, "the labels show how their curves look"


def test_units_are_written_with_a_bar() -> None:
    document = drawn([{"pointer": "/rate", "unit": "rad s^-1"}], (2,), [[0], [1]], [0.0, 1.0])
    assert "rate (rad/s)" in words(document)


@pytest.mark.parametrize(
    ("vary", "design"),
    [
        ([{"pointer": "/a"}], "random"),
        ([{"pointer": "/a"}, {"pointer": "/b"}, {"pointer": "/c"}], "product"),
        ([{"pointer": "/kind", "values": ["ball", "ring", "disc", "rod"]}], "product"),
    ],
)
def test_what_is_no_curve_is_a_distribution(vary: list[dict[str, Any]], design: str) -> None:
    shape = (4,) if len(vary) == 1 else (2, 2, 1)
    inputs = [[k] * len(vary) for k in range(4)]
    document = drawn(vary, shape, inputs, [3.0, np.nan, 1.0, 2.0], design=design)
    (curve,) = curves(document)
    assert [x for x, _ in curve] == sorted(x for x, _ in curve)
    assert len(curve) == 3
    assert "share of members" in words(document)


def test_a_study_without_any_figure_is_still_drawn() -> None:
    document = drawn([{"pointer": "/a"}], (2,), [[0], [1]], [np.nan, np.nan])
    assert json.dumps(words(document))
