"""Make docs/pictures/parameter-map.svg and results/parameter_map.json: the true error of every kind of free motion.

python -m benchmarks.parameter_map

Bodies of moments 1, B, 2: B goes from next to 1 to next to 2. Starts lie at a distance m1 (the complementary parameter
of the elliptic functions) from the separatrix, on either side of it. Each cell is the worst of its motions, at times up
to 1e9 periods, judged in ball arithmetic, which shares nothing with the double kernels.
"""

from __future__ import annotations

import json
import math
import statistics
import sys
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from itertools import product
from pathlib import Path
from random import Random

import numpy as np

from benchmarks.machine import RESULTS, described
from core.bodies.mass_properties import diagonal
from core.rotation.free_rotation import FreeRotation
from tests.core.certified.judge import UNIT_ROUNDOFF, Verdict, judged
from tests.oracles.cases import Case

PICTURE = Path(__file__).parents[1] / "docs" / "pictures" / "parameter-map.svg"
LEAST, GREATEST = 1.0, 2.0
SHARES = [10.0 ** -(15 - 0.75 * k) for k in range(20)] + [0.25, 0.5]
"""Differences of the middle moment from its nearer neighbour, the other two being 1 apart."""
SHAPES = [(share, False) for share in SHARES] + [(share, True) for share in reversed(SHARES[:-1])]
DEPTHS = [0.15 + 7.5 * k for k in range(41)]
"""Decades from the separatrix."""
ROWS = [(depth, 2) for depth in DEPTHS] + [(depth, 0) for depth in reversed(DEPTHS)]
"""And which axis is circled: the one of largest moment above, of smallest moment below."""
MOTIONS = 4
SEED = "parameter map"


@dataclass(frozen=True)
class Cell:
    """The motions of one shape at one distance from the separatrix."""

    column: int
    row: int
    verdicts: tuple[Verdict, ...]
    decades_off: float

    @property
    def error(self) -> float:
        """Worst error of angular velocity, in units of 2^-53 of the largest rate."""
        return max(verdict.error for verdict in self.verdicts) / UNIT_ROUNDOFF

    @property
    def attitude_error(self) -> float | None:
        """Worst error of a turned unit vector, in units of 2^-53; None where every attitude is refused."""
        known = [verdict.attitude_error for verdict in self.verdicts if verdict.attitude_error is not None]
        return max(known) / UNIT_ROUNDOFF if known else None


def motion(
    rng: Random, share: float, near_greatest: bool, depth: float, circled: int, countable: bool
) -> tuple[Case, float]:
    """Return a motion, at times that judge it, and by how many decades its distance differs from the one meant."""
    moments = (LEAST, GREATEST - share if near_greatest else LEAST + share, GREATEST)
    m1 = 10.0**-depth
    b, c, d = moments[1], moments[2 - circled], moments[circled]
    # On the polhode with D_d = X, D_c = 1 at am u = theta; near the middle axis, where it is resolved, or anywhere.
    x = (1.0 - m1) * abs(d - b) / abs(b - c)
    along = 10.0 ** rng.uniform(-1.0, 1.5) * math.sqrt(m1)
    cosine, sine = along / math.hypot(1.0, along), 1.0 / math.hypot(1.0, along)
    rates = [0.0, 0.0, 0.0]
    rates[2 - circled] = rng.choice((-1, 1)) * math.sqrt(x / (c * abs(d - c))) * cosine
    rates[1] = rng.choice((-1, 1)) * math.sqrt(x / (b * abs(d - b))) * sine
    rates[circled] = rng.choice((-1, 1)) * math.hypot(cosine, math.sqrt(m1) * sine) / math.sqrt(d * abs(d - c))
    found = FreeRotation(diagonal(moments).principal, np.array(rates))
    assert found.motion.circled == circled
    period = found.period
    assert period is not None
    # A body with nearly equal moments turns very often in a period: half of its motions end where turns can be counted.
    turns = 1e9 / found.largest_norm
    longest = min(1e9 * period, turns) if countable else 1e9 * period
    quarter = 1.0 / found.motion.p / found.motion.time_scale
    times = [longest, -longest * rng.random()]
    for _ in range(3):
        # Near the separatrix everything happens within a few units about the odd or even quarter periods.
        flips = round(2.0 * longest / period * 10.0 ** -rng.uniform(0.0, 9.0)) + 0.5 * rng.choice((0, 1))
        times.append(0.5 * flips * period + quarter * rng.gauss(0.0, 2.0))
    name = f"{SEED} {share:.3g} {near_greatest} {depth:.4g} {circled} {rng.random()}"
    return Case(name, moments, (rates[0], rates[1], rates[2]), tuple(times)), abs(math.log10(found.motion.m1) + depth)


def cells() -> list[Cell]:
    """Judge every cell; a motion that the kernels refuse would be an error."""
    found = []
    for (column, (share, near_greatest)), (row, (depth, circled)) in product(enumerate(SHAPES), enumerate(ROWS)):
        verdicts, off = [], 0.0
        for k in range(MOTIONS):
            case, missed = motion(
                Random(f"{SEED} {column} {row} {k}"), share, near_greatest, depth, circled, k % 2 == 0
            )
            verdict = judged(case, "map")
            assert verdict is not None, case
            assert not verdict.caught, case
            verdicts.append(verdict)
            off = max(off, missed)
        found.append(Cell(column, row, tuple(verdicts), off))
    return found


def summary(found: list[Cell]) -> dict[str, object]:
    """Return what the picture shows, as figures."""
    verdicts = [verdict for cell in found for verdict in cell.verdicts]

    def of(errors: list[float]) -> dict[str, float]:
        ordered = sorted(error / UNIT_ROUNDOFF for error in errors)
        return {
            "motions": len(ordered),
            "worst": round(ordered[-1], 2),
            "99 %": round(ordered[int(0.99 * (len(ordered) - 1))], 2),
            "median": round(statistics.median(ordered), 2),
        }

    def grid(errors: Callable[[Cell], float | None]) -> list[list[float | None]]:
        table: list[list[float | None]] = [[None] * len(SHAPES) for _ in ROWS]
        for cell in found:
            error = errors(cell)
            table[cell.row][cell.column] = None if error is None else round(error, 1)
        return table

    return {
        "machine": described("numpy", "numba", "python-flint"),
        "unit": "2^-53 of the largest rate; of a turned unit vector",
        "seed": SEED,
        "motions per cell": MOTIONS,
        "longest": "1e9 periods; for every second motion also at most 1e9 radians",
        "angular velocity": of([verdict.error for verdict in verdicts]),
        "attitude": of([verdict.attitude_error for verdict in verdicts if verdict.attitude_error is not None]),
        "cells without an attitude": sum(cell.attitude_error is None for cell in found),
        "statements below the true error": sum(verdict.caught for verdict in verdicts),
        "least stated over true": round(
            min(verdict.stated / verdict.error for verdict in verdicts if verdict.error > UNIT_ROUNDOFF / 8), 2
        ),
        "decades by which a cell's distance is missed at most": round(max(cell.decades_off for cell in found), 3),
        "columns": [[float(f"{share:.3g}"), "of the largest" if up else "of the smallest"] for share, up in SHAPES],
        "rows": [[round(-depth, 2), "largest" if circled else "smallest"] for depth, circled in ROWS],
        "worst of angular velocity": grid(lambda cell: cell.error),
        "worst of attitude": grid(lambda cell: cell.attitude_error),
    }


Errors = Mapping[tuple[int, int], float | None]

# Viridis (S. van der Walt, N. Smith), which remains ordered for every kind of colour vision and in grey; dark is worse.
COLOURS = ("#fde725", "#7ad151", "#22a884", "#2a788e", "#414487", "#440154")
REFUSED = "#cccccc"
WIDTH, HEIGHT, TOP, GAP = 360.0, 420.0, 74.0, 110.0


def drawn(found: list[Cell]) -> str:
    """Return both panels as an SVG document."""
    panels = (
        ("angular velocity", 1.0, {(cell.column, cell.row): cell.error for cell in found}),
        ("attitude", 2.0, {(cell.column, cell.row): cell.attitude_error for cell in found}),
    )
    parts = []
    for k, (title, step, errors) in enumerate(panels):
        parts += panel(96.0 + k * (WIDTH + GAP), title, step, errors)
    caption = (
        "Bodies of moments 1, B, 2. Each cell: the worst of 4 motions at 5 times up to 10⁹ periods, against ball "
        "arithmetic. Darker is worse."
    )
    title = "True error of free rotation over all bodies and all distances from the separatrix"
    height = TOP + HEIGHT + 130
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 980 {height:g}" font-family="sans-serif" font-size="13">'
        f'<title>{title}</title><rect width="980" height="{height:g}" fill="white"/>'
        f'<text x="96" y="26" font-size="15" font-weight="bold">{title}</text>'
        + "".join(parts)
        + f'<text x="96" y="{height - 14:g}" fill="#333">{caption}</text></svg>\n'
    )


def panel(left: float, title: str, step: float, errors: Errors) -> list[str]:
    """Return one map with its axes and its key; errors are shown in classes of `step` units of 2^-53."""
    columns, rows = len(SHAPES), len(ROWS)
    dx, dy = WIDTH / columns, HEIGHT / rows
    runs: dict[str, list[str]] = {}
    for row in range(rows):
        classes = [shade(errors[column, row], step) for column in range(columns)]
        start = 0
        for column in range(1, columns + 1):
            if column == columns or classes[column] != classes[start]:
                runs.setdefault(classes[start], []).append(f"M{start} {row}h{column - start}v1h{start - column}z")
                start = column
    place = f"translate({left:g} {TOP:g}) scale({dx:.5f} {dy:.5f})"
    parts = [f'<g transform="{place}" shape-rendering="crispEdges">']
    parts += [f'<path fill="{colour}" d="{"".join(path)}"/>' for colour, path in sorted(runs.items())]
    parts.append(f'</g><text x="{left:g}" y="{TOP - 14:g}" font-weight="bold">{title}</text>')
    parts.append(f'<rect x="{left:g}" y="{TOP:g}" width="{WIDTH:g}" height="{HEIGHT:g}" fill="none" stroke="#666"/>')
    parts += across(left, dx) + up(left, dy) + key(left, title, step)
    return parts


def shade(error: float | None, step: float) -> str:
    """Return the colour of a cell."""
    return REFUSED if error is None else COLOURS[min(len(COLOURS) - 1, int(error / step))]


def power(exponent: int) -> str:
    """Return a power of ten, its exponent in small figures that every reader of SVG sets alike."""
    return "10" + str(exponent).translate(str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹"))


def across(left: float, dx: float) -> list[str]:
    """Return the axis of shapes: how near the middle moment is to its neighbours."""
    bottom, parts = TOP + HEIGHT, []
    marks = [(k, share, up) for k, (share, up) in enumerate(SHAPES) if share in (SHARES[0], SHARES[8], SHARES[16], 0.5)]
    for column, share, near_greatest in marks:
        x = left + (column + 0.5) * dx
        near = power(round(math.log10(share)))
        label = "1.5" if share == 0.5 else f"2 − {near}" if near_greatest else f"1 + {near}"
        parts.append(f'<line x1="{x:.1f}" y1="{bottom:g}" x2="{x:.1f}" y2="{bottom + 5:g}" stroke="#666"/>')
        parts.append(f'<text x="{x:.1f}" y="{bottom + 20:g}" font-size="11" text-anchor="middle">{label}</text>')
    middle = left + WIDTH / 2
    parts.append(f'<text x="{middle:g}" y="{bottom + 40:g}" text-anchor="middle">middle moment B</text>')
    parts.append(f'<text x="{left:g}" y="{bottom + 40:g}" fill="#555" font-size="11">two smallest equal</text>')
    end = left + WIDTH
    parts.append(
        f'<text x="{end:g}" y="{bottom + 40:g}" fill="#555" font-size="11" text-anchor="end">two largest equal</text>'
    )
    return parts


def up(left: float, dy: float) -> list[str]:
    """Return the axis of distances from the separatrix, which lies across the middle."""
    parts, middle = [], TOP + HEIGHT / 2
    for row, (depth, _) in enumerate(ROWS):
        if round(depth - 0.15) % 75 == 0:
            y = TOP + (row + 0.5) * dy
            label = power(-round(depth)) if depth > 1 else "0.7"
            parts.append(f'<line x1="{left - 5:g}" y1="{y:.1f}" x2="{left:g}" y2="{y:.1f}" stroke="#666"/>')
            if depth < 290:
                parts.append(f'<text x="{left - 9:g}" y="{y + 4:.1f}" font-size="11" text-anchor="end">{label}</text>')
    parts.append(f'<text x="{left - 9:g}" y="{middle + 4:g}" font-size="11" text-anchor="end">{power(-300)}</text>')
    parts.append(
        f'<line x1="{left:g}" y1="{middle:g}" x2="{left + WIDTH:g}" y2="{middle:g}" stroke="white" stroke-width="2"/>'
    )
    for label, y in (("about the largest", TOP + HEIGHT / 4), ("about the smallest", TOP + 3 * HEIGHT / 4)):
        x = left - 62
        parts.append(
            f'<text x="{x:g}" y="{y:g}" transform="rotate(-90 {x:g} {y:g})" text-anchor="middle">m₁, {label}</text>'
        )
    return parts


def key(left: float, title: str, step: float) -> list[str]:
    """Return what the colours mean."""
    y, parts = TOP + HEIGHT + 58, []
    unit = "of the largest rate" if title == "angular velocity" else "rad"
    for k, colour in enumerate(COLOURS):
        x = left + 34 * k
        last = k == len(COLOURS) - 1
        parts.append(f'<rect x="{x:g}" y="{y:g}" width="34" height="13" fill="{colour}"/>')
        parts.append(f'<text x="{x:g}" y="{y + 27:g}" font-size="11">{step * k:g}{"+" if last else ""}</text>')
    parts.append(f'<text x="{left + 34 * len(COLOURS) + 10:g}" y="{y + 11:g}" font-size="11">× 2⁻⁵³ {unit}</text>')
    if title == "attitude":
        x = left + 34 * len(COLOURS) + 80
        parts.append(f'<rect x="{x:g}" y="{y:g}" width="13" height="13" fill="{REFUSED}"/>')
        parts.append(f'<text x="{x + 19:g}" y="{y + 11:g}" font-size="11">refused: 2⁴⁸ turns</text>')
    return parts


def main() -> None:
    """Judge, draw and write."""
    found = cells()
    figures = summary(found)
    (RESULTS / "parameter_map.json").write_text(json.dumps(figures) + "\n", encoding="utf-8")
    PICTURE.write_text(drawn(found), encoding="utf-8")
    shown = {name: value for name, value in figures.items() if not isinstance(value, list)}
    sys.stdout.write(json.dumps(shown, indent=2) + "\n")


if __name__ == "__main__":
    main()
