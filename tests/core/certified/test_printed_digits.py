"""Every printed digit but the last, by a run at twice the digits, on random and extreme questions."""

from __future__ import annotations

from collections.abc import Iterator
from decimal import Decimal
from fractions import Fraction
from random import Random
from typing import Any

import pytest

from core.bodies.exact_inertia import ExactInertia
from core.certified.ellipsoid_mesh import certified_grid, certified_triangles
from core.certified.energy_ellipsoid import CertifiedEllipsoid
from core.certified.free_rotation import CertifiedRotation
from core.certified.precession import certified_precession
from core.certified.scenes import certified_scene, exact_scene
from core.certified.stability import certified_stability
from core.scenes.chain_on_wedge import ChainOnWedge
from core.scenes.rod_in_hole import RodInHole
from core.scenes.unwinding_shafts import UnwindingShafts
from tests.core.bodies.exact_tensors import of_tensor

SEEDS = range(24)


def decimal(rng: Random, places: int = 30) -> str:
    """Return a decimal string with so many digits, of magnitude near one."""
    return f"{rng.choice('123456789')}.{rng.randrange(10**places):0{places}d}"


def question(seed: int) -> tuple[ExactInertia, list[str], list[str]]:
    """Return a body, its start and times: every third near the separatrix, every fourth oblique, some far out."""
    rng = Random(f"printed digits {seed}")
    moments = [decimal(rng) for _ in range(3)]
    rates = [f"{rng.choice(['', '-'])}{decimal(rng)}" for _ in range(3)]
    if seed % 3 == 0:
        small = f"e-{rng.choice([1, 12, 60, 300])}"
        moments.sort(key=Fraction)
        rates = [rates[0] + small, rates[1], rates[2] + small]
    if seed % 4 == 1:
        a, b, c = (decimal(rng) for _ in range(3))
        x, y, z = (f"0.{rng.randrange(10**20):020d}" for _ in range(3))
        inertia = of_tensor([[f"1{a}", x, y], [x, f"1{b}", z], [y, z, f"1{c}"]])
    elif seed % 4 == 2 and seed % 3:
        inertia = ExactInertia.of_moments([moments[0], moments[0], moments[1]])
    else:
        inertia = ExactInertia.of_moments(moments)
    horizon = rng.choice(["e-20", "", "e3", "e9"])
    return inertia, rates, ["0", decimal(rng), f"-{decimal(rng)}{horizon}", f"{decimal(rng)}{horizon}"]


def numerals(value: Any) -> Iterator[str]:
    """Yield every numeral of an answer, however deep."""
    if isinstance(value, str):
        try:
            Decimal(value)
        except ArithmeticError:
            return
        yield value
    elif isinstance(value, dict):
        for entry in value.values():
            yield from numerals(entry)
    elif isinstance(value, (list, tuple)):
        for entry in value:
            yield from numerals(entry)


def unit_of(numeral: str) -> Fraction:
    """Return one unit of the last digit."""
    exponent = Decimal(numeral).as_tuple().exponent
    assert isinstance(exponent, int)
    return Fraction(10) ** exponent


def hold(few: Any, many: Any, digits: int) -> None:
    """Hold every numeral against the same with twice the digits."""
    rough, precise = list(numerals(few)), list(numerals(many))
    assert len(rough) == len(precise) > 0
    for x, y in zip(rough, precise, strict=True):
        if x == "0":
            # Exactly zero, and then it is so at any precision.
            assert y == "0"
            continue
        assert abs(Fraction(x) - Fraction(y)) <= Fraction(51, 100) * unit_of(x) + unit_of(y)
        if not x.lstrip("-").startswith("0e"):
            assert len(Decimal(x).as_tuple().digits) <= digits


def rotation(seed: int, digits: int) -> Any:
    inertia, rates, times = question(seed)
    motion = CertifiedRotation.of(inertia, rates)
    precession = certified_precession(motion, digits)
    return (
        motion.trajectory(times, digits, ("0.1", "-0.7", "0.2", "0.3")),
        motion.period(digits),
        motion.flip_interval(digits),
        motion.largest_rate(digits),
        motion.angular_momentum(digits),
        motion.energy(digits),
        {name: value for name, value in vars(precession).items() if name not in ("absent", "symmetry", "regime")},
    )


def stability(seed: int, digits: int) -> Any:
    inertia, rates, _ = question(seed)
    disturbance = None if inertia.equal_moments > 1 else (rates[0], rates[2])
    found = certified_stability(inertia, rates[1], digits, disturbance)
    flip = None if found.flip is None else (found.flip.disturbance, found.flip.interval)
    return [(e.axis, e.moment, e.eigenvalues, e.growth_rate, e.drift_rate) for e in found.equilibria], flip


def ellipsoid(seed: int, digits: int) -> Any:
    inertia, rates, times = question(seed)
    surface = CertifiedEllipsoid.of(inertia, times[1])
    mesh = certified_triangles(surface, 1 + seed % 3, digits)
    return (
        surface.semi_axes(digits),
        surface.axes(digits),
        vars(surface.polhode(rates, 11, digits)),
        [vars(curve) for curve in surface.separatrix(8 + seed % 5, digits)],
        mesh.vertices,
        [mesh.quality.volume_ratio, mesh.quality.smallest_angle, mesh.quality.longest_edge],
        certified_grid(surface, 3, digits),
    )


def scene(seed: int, digits: int) -> Any:
    rng = Random(f"printed digits of scenes {seed}")
    masses, gravity = [decimal(rng), decimal(rng)], decimal(rng)
    slopes = [f"0.{rng.randrange(2, 9)}{rng.randrange(10**20):020d}" for _ in range(2)]
    times = [f"0.{rng.randrange(10**20):020d}", f"0.0{rng.randrange(10**20):020d}"]
    chosen: Any
    if seed % 3 == 0:
        radii = [decimal(rng), decimal(rng)]
        geometry = {"radii": radii, "slopes": slopes, "positions": ["1", "1.5"], "wound": ["9", "9"]}
        chosen = exact_scene(UnwindingShafts, {"masses": masses, "gravity": gravity, **geometry})
    elif seed % 3 == 1:
        length = f"0.{rng.randrange(3, 9)}{rng.randrange(10**20):020d}"
        chosen = exact_scene(RodInHole, {"hole_radius": "1", "length": length, "mass": masses[0], "gravity": gravity})
        times = [*times, f"{decimal(rng)}e6"]
    else:
        chosen = exact_scene(
            ChainOnWedge,
            {
                "masses": masses,
                "slopes": slopes,
                "gravity": gravity,
                "length": "9",
                "linear_density": decimal(rng),
                "position": "4.5",
            },
        )
    found = certified_scene(chosen, digits, times)
    columns = {} if found.trajectory is None else {n: c for n, c in found.trajectory.items() if n != "time"}
    return found.figures, columns


@pytest.mark.parametrize("digits", [16, 60])
@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("answer", [rotation, stability, ellipsoid, scene], ids=lambda answer: answer.__name__)
def test_every_printed_digit_but_the_last(answer, seed, digits):
    hold(answer(seed, digits), answer(seed, 2 * digits), digits)


@pytest.mark.parametrize("answer", [rotation, stability], ids=lambda answer: answer.__name__)
@pytest.mark.parametrize("seed", [0, 1, 2])
def test_a_thousand_digits_extend_five_hundred(answer, seed):
    hold(answer(seed, 500), answer(seed, 1000), 500)
