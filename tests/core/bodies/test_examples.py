"""Named bodies against published figures."""

from __future__ import annotations

import math

import numpy as np
import pytest

from core.bodies import Body
from core.quantities import members_of
from tests.core.bodies.example_bodies import EXAMPLES


def test_the_examples_are_bodies_that_matter_can_have() -> None:
    assert set(EXAMPLES) == {
        "t-handle-points", "t-handle", "coin", "american-football", "deck-of-cards", "phone", "earth",
    }  # fmt: skip
    for body in EXAMPLES.values():
        assert isinstance(body, members_of(Body))
        properties = body.mass_properties()
        assert properties.validity.physical
        assert properties.warnings == ()
    with pytest.raises(TypeError):
        EXAMPLES["moon"] = EXAMPLES["earth"]  # type: ignore[index]


def test_the_points_of_the_t_handle() -> None:
    body = EXAMPLES["t-handle-points"]
    found = body.mass_properties()
    assert len(body.positions) == 300
    assert found.mass == 300.0
    assert np.abs(found.center_of_mass - [1 / 20, 10 / 27, 0]).max() < 1e-15
    # Rounded as the lesson prints them, about the origin; and about the centre of mass.
    origin = found.principal_about_origin.moments
    assert np.abs(origin - [437.68518519, 714.00820069, 837.19550301]).max() < 5e-9
    assert np.abs(found.principal.moments - [395.782921811, 713.509259259, 795.792181070]).max() < 5e-10
    assert np.abs(np.abs(found.principal.axes) - [[0, 0, 1], [0, 1, 0], [1, 0, 0]]).max() < 1e-14


def test_the_points_are_those_of_the_lesson() -> None:
    # Written with loops, where the example uses grids.
    expected = []
    for k in range(3):
        for i in range(15):
            for j in range(20):
                angle, along = 2 * math.pi * j / 19, (i if i < 10 else i - 10) / 9
                bar = (math.cos(angle), math.sin(angle), 5 * along - 2.5)
                stem = (math.cos(angle), 5 * along, math.sin(angle))
                expected.append((bar if i < 10 else stem)[k])
    points = np.array(expected).reshape(3, 300).T
    assert np.abs(EXAMPLES["t-handle-points"].positions - points).max() < 5e-15


def test_a_real_t_handle_by_hand() -> None:
    # Two cylinders and the parallel-axis theorem, in doubles.
    found = EXAMPLES["t-handle"].mass_properties()
    bar, stem = 7850 * math.pi * 0.006**2 * 0.1, 7850 * math.pi * 0.005**2 * 0.05
    middle = stem * 0.031 / (bar + stem)
    assert found.mass == pytest.approx(bar + stem, rel=1e-14)
    assert found.center_of_mass == pytest.approx([0, middle, 0], rel=1e-14, abs=1e-17)
    steiner = bar * middle**2 + stem * (0.031 - middle) ** 2
    across = bar * (0.006**2 / 4 + 0.1**2 / 12)
    x = across + stem * (0.005**2 / 4 + 0.05**2 / 12) + steiner
    y = across + stem * 0.005**2 / 2
    z = bar * 0.006**2 / 2 + stem * (0.005**2 / 4 + 0.05**2 / 12) + steiner
    assert found.inertia == pytest.approx(np.diag([x, y, z]), rel=1e-13, abs=1e-20)
    assert found.symmetry == "triaxial"


def test_a_coin_and_a_football_are_symmetric() -> None:
    coin, football = EXAMPLES["coin"].mass_properties(), EXAMPLES["american-football"].mass_properties()
    assert coin.symmetry == "oblate"
    assert coin.mass == 0.0075
    assert football.symmetry == "prolate"
    assert football.mass == pytest.approx(14.5 * 0.45359237 / 16, rel=1e-13)
    # A surface without thickness in the middle of the wall, summed over hoops, is the same within the wall's share.
    a, c = 21.125 * 0.0254 / (2 * math.pi) - 0.002, 11.125 * 0.0254 / 2 - 0.002
    t = (np.arange(20000) + 0.5) * math.pi / 20000
    hoops = np.sin(t) * np.hypot(c * np.sin(t), a * np.cos(t))
    weight = football.mass * hoops / hoops.sum()
    low, middle, _ = football.principal.moments
    assert low == pytest.approx((weight * (a * np.sin(t)) ** 2).sum(), rel=0.01)
    assert middle == pytest.approx((weight * ((a * np.sin(t)) ** 2 / 2 + (c * np.cos(t)) ** 2)).sum(), rel=0.01)


def test_a_deck_of_cards_and_a_phone_have_three_moments() -> None:
    deck = EXAMPLES["deck-of-cards"].mass_properties()
    assert deck.principal.moments == pytest.approx([3.310e-5, 6.267e-5, 9.175e-5], rel=2e-4)
    phone = EXAMPLES["phone"].mass_properties()
    assert phone.symmetry == "triaxial"
    assert phone.mass == 0.171


def test_the_earth() -> None:
    low, middle, high = EXAMPLES["earth"].mass_properties().principal.moments
    equatorial = (low + middle) / 2
    # Dynamical ellipticity (C - A)/A, and Euler's period in sidereal days, as commonly given.
    assert (high - equatorial) / equatorial == pytest.approx(0.00328455, rel=2e-5)
    assert equatorial / (high - equatorial) == pytest.approx(304.46, rel=2e-5)
    # B - A by the gravity coefficients C22 and S22, 7.260e-6 M R^2: Liu and Chao, Geophys. J. Int. 106 (1991), 699.
    assert middle - low == pytest.approx(7.260e-6 * 5.9722e24 * 6378137.0**2, rel=5e-3)
