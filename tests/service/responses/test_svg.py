"""Curves on logarithmic scales: every positive point has its place and nothing else is drawn."""

from __future__ import annotations

from math import inf, isclose, log10, nextafter
from typing import Any
from xml.etree import ElementTree

import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from service.responses.svg import COLOURS, HEIGHT, LEFT, MOST_TICKS, TOP, WIDTH, Curve, Level, Scale, log_log

NAMESPACE = "{http://www.w3.org/2000/svg}"
LARGEST = nextafter(inf, 0.0)
POSITIVE = st.floats(5e-324, LARGEST)
ANY = st.floats(allow_nan=False, allow_infinity=False)
LABELS = st.text(st.characters(codec="utf-8", exclude_categories=["Cc", "Cs"], exclude_characters="￾￿"), max_size=8)
CURVES = st.lists(
    st.builds(Curve, LABELS, st.lists(st.tuples(ANY, ANY), max_size=5), st.booleans()), max_size=len(COLOURS) + 2
)


def drawn(text: str) -> ElementTree.Element:
    assert "nan" not in text
    assert "inf" not in text.replace("info", "")
    return ElementTree.fromstring(text)


def places(found: ElementTree.Element) -> list[tuple[float, float]]:
    """Return the places of points."""
    return [(float(dot.get("cx", "")), float(dot.get("cy", ""))) for dot in found.iter(f"{NAMESPACE}circle")]


def lines(found: ElementTree.Element) -> list[list[tuple[float, float]]]:
    return [
        [(float(x), float(y)) for x, y in (pair.split(",") for pair in line.get("points", "").split())]
        for line in found.iter(f"{NAMESPACE}polyline")
    ]


def texts(found: ElementTree.Element) -> list[str]:
    return ["".join(text.itertext()) for text in found.iter(f"{NAMESPACE}text")]


class TestScale:
    @given(st.lists(ANY, max_size=6))
    @example([5e-324, LARGEST])
    @example([1000.0])
    @settings(derandomize=True)
    def test_it_holds_all_positive_values_in_whole_decades(self, values: list[float]) -> None:
        scale = Scale.over(values, 10.0, 100.0)
        assert scale.low < scale.high
        assert all(10.0 - 1e-9 <= scale(value) <= 110.0 + 1e-9 for value in values if value > 0.0)
        positive = [log10(value) for value in values if value > 0.0]
        if positive:
            # No decade is there for nothing, but for the one that every scale has.
            assert scale.low <= min(positive) < scale.low + 1
            assert scale.high - 1 < max(positive) or scale.high == scale.low + 1

    @given(POSITIVE, POSITIVE)
    @settings(derandomize=True)
    def test_equal_factors_are_equal_distances_and_it_may_run_backwards(self, one: float, other: float) -> None:
        up, down = (Scale.over([one, other], start, length) for start, length in ((0.0, 100.0), (100.0, -100.0)))
        assert isclose(up(one) + down(one), 100.0, abs_tol=1e-9)
        decades = log10(other) - log10(one)
        assert isclose(up(other) - up(one), 100.0 * decades / (up.high - up.low), abs_tol=1e-9)

    @given(st.lists(POSITIVE, max_size=4))
    @example([5e-324, LARGEST])
    @settings(derandomize=True)
    def test_few_decades_are_marked_evenly(self, values: list[float]) -> None:
        scale = Scale.over(values, 0.0, 1.0)
        assert 2 <= len(scale.exponents) <= MOST_TICKS
        assert scale.exponents[0] == scale.low
        assert scale.exponents[-1] <= scale.high
        # Of so few decades each is.
        assert scale.high - scale.low >= MOST_TICKS or [*scale.exponents] == [*range(scale.low, scale.high + 1)]


class TestFigure:
    @given(LABELS, CURVES, st.lists(st.builds(Level, LABELS, ANY), max_size=3))
    @example("", [Curve("", [(5e-324, LARGEST), (LARGEST, 5e-324)])], [])
    @example("", [Curve("", [(1.0, 1.0)])], [Level("", 5e-324)])
    @example("", [], [])
    @example("", [Curve(str(k), [(1.0, 1.0)]) for k in range(len(COLOURS) + 1)], [])
    @settings(deadline=None, derandomize=True)
    def test_whatever_is_drawn_lies_within_the_frame_and_nothing_is_missing(
        self, title: str, curves: list[Curve], levels: list[Level]
    ) -> None:
        found = drawn(log_log(title, "x", "y", curves, levels))
        shown = [[p for p in curve.points if min(p) > 0.0] for curve in curves]
        plain = [own for curve, own in zip(curves, shown, strict=True) if not curve.emphasised]
        broad = [own for curve, own in zip(curves, shown, strict=True) if curve.emphasised]
        dots = places(found)
        assert len(dots) == sum(map(len, plain))
        assert sorted(map(len, lines(found))) == sorted(len(own) for own in (*plain, *broad) if own)
        for x, y in (*dots, *(point for line in lines(found) for point in line)):
            assert LEFT - 0.05 <= x <= LEFT + WIDTH + 0.05
            assert TOP - 0.05 <= y <= TOP + HEIGHT + 0.05
        across = [line for line in found.iter(f"{NAMESPACE}line") if line.get("stroke-dasharray")]
        assert len(across) == sum(level.value > 0.0 for level in levels)
        assert all(TOP - 0.05 <= float(line.get("y1", "")) <= TOP + HEIGHT + 0.05 for line in across)
        told = texts(found)
        assert told[0] == title
        assert {level.label for level in levels if level.value > 0.0} <= set(told)
        assert {curve.label for curve in curves if not curve.emphasised} <= set(told)

    def test_points_are_where_they_belong(self) -> None:
        points = [(1.0, 1e-8), (10.0, 1e-4), (100.0, 1.0)]
        found = drawn(log_log("", "", "", [Curve("", points)]))
        middle = (LEFT + WIDTH / 2, TOP + HEIGHT / 2)
        assert places(found) == lines(found)[0] == [(LEFT, TOP + HEIGHT), middle, (LEFT + WIDTH, TOP)]

    def test_marks_stand_at_their_powers_of_ten(self) -> None:
        powers = [(10.0**k, 10.0**-k) for k in range(5)]
        found = drawn(log_log("", "", "", [Curve("", powers)]))
        grid = {
            (line.get("x1"), line.get("x2")) if line.get("x1") == line.get("x2") else (line.get("y1"), line.get("y2"))
            for line in found.iter(f"{NAMESPACE}line")
        }
        dots = [*found.iter(f"{NAMESPACE}circle")]
        assert grid == {(dot.get("cx"),) * 2 for dot in dots} | {(dot.get("cy"),) * 2 for dot in dots}
        assert [text for text in texts(found) if text.startswith("10")] == [
            *(f"10{k}" for k in range(5)),
            *(f"10{k}" for k in range(-4, 1)),
        ]

    def test_an_emphasised_curve_lies_under_the_others(self) -> None:
        points = [(1.0, 1.0), (2.0, 2.0)]
        found = drawn(log_log("", "", "", [Curve("a", points), Curve("b", points, emphasised=True)]))
        pale, line = found.iter(f"{NAMESPACE}polyline")
        assert float(pale.get("stroke-width", "")) > float(line.get("stroke-width", ""))
        assert (pale.get("stroke"), line.get("stroke")) == ("#cccccc", COLOURS[0])
        assert "b" not in texts(found)

    @pytest.mark.parametrize("label", ["<script>alert(1)</script>", 'a"b', "a & b", "]]>"])
    def test_labels_are_text_and_nothing_else(self, label: str) -> None:
        found = drawn(log_log(label, label, label, [Curve(label, [(1.0, 1.0)])], [Level(label, 1.0)]))
        assert texts(found).count(label) == 5
        assert not [*found.iter(f"{NAMESPACE}script")]

    def test_equal_figures_are_equal_bytes(self) -> None:
        def once() -> Any:
            return log_log("t", "x", "y", [Curve("a", [(1.0, 0.1), (3.0, 1e-9)])], [Level("l", 1e-3)])

        assert once() == once()
