"""docs/peers.md, written from the results."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from benchmarks.peers.sweep import best, closest

OURS = "Polhode"
NEAR = "near separatrix"
REACHED = (1e-6, 1e-12)

HEAD = """\
# Beside its peers

*Written by `make peers`, which measures everything up to the last section in one run; all figures, with every
setting, are in [benchmarks/results/peers.json](../benchmarks/results/peers.json). The rules are in
[decision 12](decisions/0012-fair-comparison.md).*

Each computes {samples} samples of the free body's angular velocity, or attitude, and swept through its settings.
Errors are the largest of any sample against the motion at 50 digits, relative to its largest norm (attitudes: the angle
in radians). Milliseconds are medians of warm runs that include all that a new question needs.
{machine}
{busy}
![Error against milliseconds on the T-handle and near the separatrix](pictures/peers.svg)

- **Same error, less time.** {ratios}
- **Near the separatrix** {near}
- **The horizon costs nothing.** {horizon}
- **Where it is close.** {closest}
"""


def page(result: Mapping[str, Any]) -> str:
    """Return the page."""
    cases = result["cases"]
    machine = result["machine"]
    versions = ", ".join(f"{name} {version}" for name, version in machine["versions"].items())
    head = HEAD.format(
        samples=result["samples"],
        machine=f"{machine['cores']} cores of {machine['processor']}, Python {machine['python']}, {versions}.",
        busy=_busy(result),
        ratios=_ratios(cases),
        near=_near_sentence(cases[NEAR]),
        horizon=_horizon_sentence(result["horizons"]),
        closest=_rival(cases),
    )
    return "\n".join(
        (
            head,
            "## The questions\n",
            _questions(cases),
            "## How many times the closed form's time\n",
            f"At the fastest setting whose error is at most {REACHED[0]:g} / {REACHED[1]:g}; – where none is. "
            "The closed form's own error is below both everywhere.\n",
            _times(cases),
            "![Error against milliseconds on the other questions](pictures/peers-others.svg)\n",
            "## The smallest error that each reached\n",
            _smallest(cases),
            "## Near the separatrix\n",
            "The setting with the smallest error. Final and by component are errors too; the drifts are not.\n",
            _near(cases[NEAR]),
            "## The horizon\n",
            "Milliseconds for 10000 samples over numbers of periods, and their largest error. Integrators ran "
            "for up to 1000 periods, at their tightest tolerance.\n",
            _horizons(result["horizons"]),
            "## Set-up and cold start\n",
            "Set-up: what the first answer to the T-handle takes more than later ones, the least of any setting. "
            "Cold start: seconds from the start of a process to its first answer.\n",
            _starts(result),
            "## The kernel alone\n",
            _kernel(result["kernel"]),
            "## Refused, not installed, left out\n",
            _missing(result),
        )
    )


def _busy(result: Mapping[str, Any]) -> str:
    """Return a warning if the machine had other work, whose own load the benchmark adds to by one."""
    load, cores = result.get("load average", {}), result["machine"]["cores"]
    if load and load["before"] < 0.5 and load["after"] < cores:
        return ""
    return (
        "\n**The machine was busy with other work during this run: times, and ratios below three, are provisional.**\n"
    )


SHORT = "A123", "T-handle", "SciML", "DETEST B5"


def _ratios(cases: Mapping[str, Any]) -> str:
    """Return how much faster the closed form is than the two best known, at the errors that those reach."""
    said = []
    for most in (1e-9, 1e-12):
        ranges = [(peer, _range(cases, peer, most)) for peer in ("SciPy solve_ivp", "heyoka")]
        told = ", ".join(f"{low} to {high} times faster than {peer}" for peer, (low, high) in ranges)
        said.append(f"against errors of {most:g} and less {told}")
    own = max(cases[name]["peers"][OURS]["points"][0]["error"] for name in SHORT)
    return f"On the four short questions, {'; '.join(said)}. The closed form's own error is {own:.0e} at most."


def _range(cases: Mapping[str, Any], peer: str, most: float) -> tuple[str, str]:
    """Return the least and the largest ratio of a peer's fastest time, with an error of at most `most`, to ours."""
    found = []
    for name in SHORT:
        points = [p for n, own in cases[name]["peers"].items() if n.startswith(peer) for p in own["points"]]
        ours = cases[name]["peers"][OURS]["points"][0]["milliseconds"]
        near = [p["milliseconds"] / ours for p in points if "error" in p and p["error"] <= most]
        if near:
            found.append(min(near))
    return _short(min(found)), _short(max(found))


def _near_sentence(case: Mapping[str, Any]) -> str:
    """Return who is right, how wrong the others are, what they conserve, and what the question is worth."""
    ours = case["peers"][OURS]["points"][0]["error"]
    others = {
        peer: [point for point in own["points"] if "error" in point]
        for peer, own in case["peers"].items()
        if not peer.startswith(OURS)
    }
    points = [point for own in others.values() for point in own]
    median = sorted(point["error"] for point in points)[len(points) // 2]
    peer = min((peer for peer in others if others[peer]), key=lambda peer: min(p["error"] for p in others[peer]))
    own = [point["error"] for point in others[peer]]
    least = own.index(min(own))
    tighter = own[least + 1 :]
    chance = f" (by chance: its tighter settings gave up to {max(tighter):.1g})" if tighter else ""
    drift = min(point["drifts"]["energy"] for point in points)
    return (
        f"the closed form's error is {ours:.0e}. The others' median is {median:.1f}, the whole amplitude; the least, "
        f"{own[least]:.1g}, is {peer}'s{chance}. Their energy drifts by as little as {drift:.0e}: a drift is not an "
        "error. The question is well posed, for half a unit in the last place of every input moves the motion by "
        f"{case['inherited']:.0e} at most; but beside the middle axis an integrator's rounding is of the size of what "
        "decides the next flip."
    )


def _rival(cases: Mapping[str, Any]) -> str:
    """Return who came nearest to the closed form's time at a useful error."""
    said, nearest = [], []
    for names in (("A123", "T-handle", "SciML", "DETEST B5"), ("A123, attitude", "T-handle, attitude")):
        found = []
        for name in names:
            peers = cases[name]["peers"]
            ours = peers[OURS]["points"][0]["milliseconds"]
            for peer, own in peers.items():
                point = best(own["points"], 1e-6)
                if point and not peer.startswith(OURS):
                    found.append((point["milliseconds"] / ours, peer, name))
        if found:
            ratio, peer, name = min(found)
            nearest.append(ratio)
            said.append(f"{peer} took {ratio:.2g} times the closed form's time on {name}")
    verb = "wins somewhere" if min(nearest) < 1.0 else "comes near"
    return f"If an error of 1e-6 will do on a short motion, a compiled integrator {verb}: {'; '.join(said)}."


def _horizon_sentence(horizons: Mapping[str, Any]) -> str:
    said = []
    for name, rows in horizons.items():
        own = rows[OURS]
        said.append(
            f"{name}: {_short(own['1']['milliseconds'])} ms over one period, {_short(own['1e+09']['milliseconds'])} ms "
            f"over 1e9, errors {own['1']['error']:.0e} and {own['1e+09']['error']:.0e}"
        )
    return "; ".join(said) + "."


def _questions(cases: Mapping[str, Any]) -> str:
    rows = [
        (name, case["note"], _triple(case["moments"]), _triple(case["start"]), f"{case['stop']:g}")
        for name, case in cases.items()
    ]
    return _table(("question", "what it is", "moments", "start (rad/s)", "to (s)"), rows)


def _times(cases: Mapping[str, Any]) -> str:
    rows = []
    for peer in _peers(cases):
        row = [peer]
        for case in cases.values():
            ours = case["peers"][OURS]["points"][0]["milliseconds"]
            points = case["peers"].get(peer, {}).get("points", [])
            if peer == OURS:
                row.append(f"{_short(ours)} ms")
            elif not points:
                row.append("")
            else:
                reached = [best(points, error) for error in REACHED]
                row.append(" / ".join(_short(p["milliseconds"] / ours) if p else "–" for p in reached))
        rows.append(row)
    return _table(("", *cases), rows)


def _smallest(cases: Mapping[str, Any]) -> str:
    rows = []
    for peer in _peers(cases):
        row = [peer]
        for case in cases.values():
            points = case["peers"].get(peer, {}).get("points", [])
            point = closest(points)
            row.append(f"{point['error']:.1e}" if point else "fails" if points else "")
        rows.append(row)
    return _table(("", *cases), rows)


def _near(case: Mapping[str, Any]) -> str:
    rows = []
    for peer, own in case["peers"].items():
        point = closest(own["points"])
        if point is None:
            rows.append((peer, own["points"][0]["failure"], "", "", "", "", ""))
            continue
        rows.append(
            (
                peer,
                *(f"{point[kind]:.1e}" for kind in ("error", "final error", "component error")),
                *(f"{drift:.0e}" for drift in point["drifts"].values()),
                _short(point["milliseconds"]),
            )
        )
    return _table(("", "error", "final", "by component", "drift of energy", "drift of momentum", "milliseconds"), rows)


def _horizons(horizons: Mapping[str, Any]) -> str:
    rows, columns = [], list(next(iter(next(iter(horizons.values())).values())))
    for name, peers in horizons.items():
        for peer, cells in peers.items():
            row = [name, peer]
            for column in columns:
                cell = cells.get(column)
                row.append(f"{_short(cell['milliseconds'])} ms, {cell['error']:.0e}" if cell else "")
            rows.append(row)
    return _table(("", "", *(f"over {float(column):g}" for column in columns)), rows)


def _starts(result: Mapping[str, Any]) -> str:
    rows = []
    for peer, seconds in result["cold start in seconds"].items():
        points = result["cases"]["T-handle"]["peers"][peer]["points"]
        set_up = min((p["set-up milliseconds"] for p in points if "error" in p), default=None)
        rows.append((peer, "" if set_up is None else _short(set_up), f"{seconds:.2f}"))
    return _table(("", "set-up (ms)", "cold start (s)"), rows)


def _kernel(kernel: Mapping[str, Any]) -> str:
    rows = []
    for name, figures in kernel.items():
        if "microseconds" in figures:
            rows.append((name, f"{figures['microseconds']:.1f} microseconds", ""))
        else:
            rows.append((name, f"{figures['nanoseconds per sample']:.2f} ns a sample", f"{figures['ratio']:.1f}"))
    return _table(("", "time", "times writing three doubles"), rows)


def _missing(result: Mapping[str, Any]) -> str:
    lines = []
    for name, case in result["cases"].items():
        for peer, own in case["peers"].items():
            failures = [point for point in own["points"] if "failure" in point]
            if failures:
                settings = ", ".join(f"{point['setting']:g}" for point in failures) if own["setting"] else ""
                where = f" with {own['setting']} {settings}" if settings else ""
                lines.append(f"- {name}: {peer}{where}: {failures[0]['failure']}")
    if result["not installed"]:
        lines.append(f"- Not installed when this ran: {', '.join(result['not installed'])}.")
    lines += [f"- Left out: {names}. {reason[0].upper()}{reason[1:]}." for names, reason in result["left out"].items()]
    return "\n".join(lines) + "\n"


def _peers(cases: Mapping[str, Any]) -> list[str]:
    return list(dict.fromkeys(peer for case in cases.values() for peer in case["peers"]))


def _triple(values: Sequence[float]) -> str:
    return ", ".join(f"{value:.6g}" for value in values)


def _short(value: float) -> str:
    return f"{value:.0f}" if value >= 99.5 else f"{value:.2g}"


def _table(head: Iterable[str], rows: Iterable[Iterable[str]]) -> str:
    lines = [list(head), *(list(row) for row in rows)]
    lines.insert(1, ["-"] * len(lines[0]))
    return "\n".join("| " + " | ".join(cell.replace("|", "\\|") for cell in line) + " |" for line in lines) + "\n"
