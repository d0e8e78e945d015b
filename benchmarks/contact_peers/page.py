"""The section of docs/peers.md about scenes with contacts, written from the results."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

OURS = "Polhode"
SHOWN = {
    "ladder": ("leaves the wall at", "angle at 0.8 s"),
    "slip to roll": ("slips below 10 mm/s from", "place at 1 s"),
    "bounce": ("last above 1 mm", "height at 2.2 s"),
}
"""By case: an event and a place. Only Polhode has the last bounce and the start of rolling itself."""
FREE = 5.0
"""Spin (rad/s) of the second chalk, which goes on as long as nothing pushes it."""
IN_PLACE = {"slips below 10 mm/s from": "rolls from", "last above 1 mm": "rests from"}
"""What is compared instead for Polhode, which has an event where others fade."""

TITLE = "## Scenes with contacts\n"
HEAD = """## Scenes with contacts

*Written by `make peers-scenes`; every figure is in
[contact_peers.json](../benchmarks/results/contact_peers.json).* A ladder that leaves the wall, a disc that slips before
it rolls, a ball that bounces to rest, and Painlevé's chalk in two states. Engines run through time steps of 1e-2, 1e-3,
1e-4 and 1e-5 s, Drake's continuous models through accuracies of 1e-3, 1e-5, 1e-7 and 1e-9, each with a stiffness that
goes with it; hydroelastic contact is off. Every run has a process of its own and {limit:g} s.
{machine}
{busy}"""

MEANING = """- **Events.** {events}
  The disc slows down linearly as long as it slips: velocities of an engine that takes whole steps are right there, and
  its places are half a step off.
- **Time.** {times}
- **Restitution.** Of the peers only PyBullet has it as a parameter, and contacts that act from a distance take most of
  it away unless that distance is made small. MuJoCo's and Drake's contacts are springs with damping, set here so that
  the first bounce leaves 0.8 of the speed; with Hunt and Crossley's damping the share grows as the speed falls.
- **Undecided.** Polhode ends with `{codes[0]}` and `{codes[1]}`, says why, lists the candidates and what would decide.
  {undecided} {ways} None of the {runs} runs of
  the peers that ended on the two states gives an error or a warning about it.
- **Bounds.** Every figure of Polhode is within the error that it states. The others state none.
"""


def with_section(page: str, results: Path) -> str:
    """Return the page of the peers with this section at its end, if there is a file of results."""
    before = page.partition(TITLE)[0].rstrip("\n") + "\n"
    if not results.exists():
        return before
    return before + "\n" + section(json.loads(results.read_text(encoding="utf-8")))


def section(result: Mapping[str, Any]) -> str:
    """Return the section."""
    cases, machine = result["cases"], result["machine"]
    versions = ", ".join(f"{name} {version}" for name, version in machine["versions"].items())
    load = result["load average"]
    busy = max(load.values()) >= machine["cores"]
    warning = "**The machine was busy with other work during this run: times are provisional.**\n" if busy else ""
    text = [
        HEAD.format(
            limit=result["limit"],
            machine=f"{machine['cores']} cores of {machine['processor']}, Python {machine['python']}, {versions}.",
            busy=warning,
        ),
        MEANING.format(
            events=_events(cases),
            times=_times(cases),
            codes=[cases[name]["engines"][OURS][0]["says"]["code"] for name in _undecided(cases)],
            undecided=_spread(cases),
            ways=_ways(cases),
            runs=sum(
                "failure" not in point
                for name in _undecided(cases)
                for engine, points in cases[name]["engines"].items()
                for point in points
                if engine != OURS
            ),
        ),
    ]
    text.extend(_table_of(name, cases[name]) for name in SHOWN)
    text.append(_chalk(cases))
    text.append("\n".join(_failures(cases)))
    return "\n".join(text)


def _undecided(cases: Mapping[str, Any]) -> list[str]:
    return [name for name, case in cases.items() if not case["references"]]


def _ours(case: Mapping[str, Any], name: str) -> float:
    errors = case["engines"][OURS][0]["errors"]
    return float(errors[name] if name in errors else errors[IN_PLACE[name]])


def _least(case: Mapping[str, Any], name: str) -> tuple[float, str, float]:
    """Return the least error of a peer, whose, and its milliseconds."""
    return min(
        (point["errors"][name], engine, point["milliseconds"])
        for engine, points in case["engines"].items()
        for point in points
        if engine != OURS and name in point.get("errors", {})
    )


def _events(cases: Mapping[str, Any]) -> str:
    said = []
    for name, (event, _) in SHOWN.items():
        error, engine, _ = _least(cases[name], event)
        said.append(f"{name}: Polhode {_ours(cases[name], event):.0e} s, the best peer {error:.0e} s ({engine})")
    return "Errors of their times, at each peer's best setting. " + "; ".join(said) + "."


def _times(cases: Mapping[str, Any]) -> str:
    said = []
    for name, (_, place) in SHOWN.items():
        own = cases[name]["engines"][OURS][0]["milliseconds"]
        error, engine, spent = _least(cases[name], place)
        said.append(
            f"{name}: {own:.1f} ms, error {_ours(cases[name], place):.0e}; {engine} {spent:.0f} ms, {error:.0e}"
        )
    return (
        "A whole answer of Polhode, from the document to the error statements, and the best peer's motion alone. "
        + "; ".join(said)
        + "."
    )


def _spread(cases: Mapping[str, Any]) -> str:
    """Return how far the peers are apart where mechanics decides nothing."""
    said = []
    for name in _undecided(cases):
        points = [
            point["figures"]
            for engine, own in cases[name]["engines"].items()
            for point in own
            if engine != OURS and "figures" in point
        ]
        foot = [point["foot after 1 ms"] for point in points]
        forces = [point["largest force"] for point in points]
        said.append(
            f"In the state with {cases[name]['engines'][OURS][0]['says']['code']} the foot slides at {min(foot):.2g} "
            f"to {max(foot):.2g} m/s after 1 ms, and the largest force is {min(forces):.2g} to {max(forces):.2g} N."
        )
    return " ".join(said)


def _ways(cases: Mapping[str, Any]) -> str:
    """Return which way the peers go where several motions are possible."""
    name = next(n for n in _undecided(cases) if cases[n]["engines"][OURS][0]["says"]["code"] == "several-motions")
    runs = [
        (engine, point["figures"]["spin at 0.1 s"])
        for engine, points in cases[name]["engines"].items()
        for point in points
        if engine != OURS and "figures" in point
    ]
    held = [(engine, spin) for engine, spin in runs if abs(spin - FREE) > 0.1 * FREE]
    names = dict.fromkeys(engine for engine, _ in held)
    return (
        f"There {len(runs) - len(held)} runs let the rod go free, which leaves it its {FREE:g} rad/s, and {len(held)} "
        f"stop its foot, which leaves {max(spin for _, spin in held):.2g} rad/s: {'; '.join(names)}."
    )


def _cell(point: Mapping[str, Any], names: tuple[str, str]) -> str:
    if "failure" in point:
        return "fails"
    errors = [f"{point['errors'][name]:.0e}" if name in point["errors"] else "–" for name in names]
    return f"{errors[0]}, {errors[1]} ({_short(point['milliseconds'])} ms)"


def _table_of(name: str, case: Mapping[str, Any]) -> str:
    event, place = SHOWN[name]
    units = [case["references"][one][1] for one in (event, place)]
    lines = [
        f"### {name.capitalize()}\n",
        f"{case['note'].capitalize()}. Errors of: {event} ({units[0]}), {place} ({units[1]}), from the coarsest "
        "setting to the finest; – where the motion never gets there.\n",
        "| | | | | |\n| - | - | - | - | - |",
    ]
    for engine, points in case["engines"].items():
        if engine == OURS:
            spent = _short(points[0]["milliseconds"])
            cells = [f"{_ours(case, event):.0e}, {_ours(case, place):.0e} ({spent} ms)"]
        else:
            cells = [_cell(point, (event, place)) for point in points]
        cells += [""] * (4 - len(cells))
        lines.append(f"| {engine} | " + " | ".join(cells) + " |")
    return "\n".join(lines) + "\n"


def _chalk(cases: Mapping[str, Any]) -> str:
    lines = ["### Painlevé's chalk\n"]
    lines.append("Rate of the foot after 1 ms (m/s), largest force (N) and spin at 0.1 s (rad/s), by setting.\n")
    for name in _undecided(cases):
        lines.append(f"{cases[name]['note'].capitalize()}.\n")
        lines.append("| | | | | |\n| - | - | - | - | - |")
        for engine, points in cases[name]["engines"].items():
            if engine == OURS:
                cells = [f"`{points[0]['says']['code']}`"]
            else:
                cells = ["fails" if "failure" in one else _state(one["figures"]) for one in points]
            lines.append(f"| {engine} | " + " | ".join([*cells, *[""] * (4 - len(cells))]) + " |")
        lines.append("")
    return "\n".join(lines)


def _state(figures: Mapping[str, float]) -> str:
    return f"{figures['foot after 1 ms']:.2g}, {figures['largest force']:.2g}, {figures['spin at 0.1 s']:.3g}"


def _failures(cases: Mapping[str, Any]) -> Iterator[str]:
    for name, case in cases.items():
        for engine, points in case["engines"].items():
            for point in points:
                if "failure" in point:
                    yield f"- {name}: {engine} at {point['setting']:g}: {point['failure']}"
                if "warnings" in point:
                    yield f"- {name}: {engine} at {point['setting']:g} warns: {point['warnings'][0][:200]}"


def _short(value: float) -> str:
    return f"{value:.0f}" if value >= 99.5 else f"{value:.2g}"
