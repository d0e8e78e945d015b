"""The worked homework graded number by number, as docs/grading.md says and as its errors are known."""

from __future__ import annotations

import json
import re
import sys
from pathlib import Path
from urllib.request import Request, urlopen

import pytest

from examples import grade_homework
from examples.ask import names, request_of
from tests.service.conftest import PATIENCE

ROOT = Path(__file__).parents[2]
PAGE = ROOT / "docs" / "grading.md"
SCRIPT = ROOT / "examples" / "grade_homework.py"
GRADED = [name for name in names() if name.startswith(grade_homework.FOLDER)]

# Question, index of the submission, figure; verdict and the mistake that has to be named first.
KNOWN = {
    ("problem-1", 0, "/tension"): ("correct", None),
    ("problem-1", 0, "/accelerations"): ("correct", None),
    ("problem-1", 1, "/accelerations/0"): ("correct", None),
    ("problem-1", 1, "/accelerations/1"): ("correct", None),
    # The multiplier of the homework is minus the tension.
    ("problem-1", 1, "/tension"): ("incorrect", "sign"),
    # Its energy has unequal dimensions, and the formula the value above.
    ("problem-2", 2, "/angular_velocity_at_horizontal"): ("incorrect", "rod-depth-and-inertia"),
    ("problem-2", 0, "/angular_velocity_at_horizontal"): ("incorrect", "rod-depth-and-inertia"),
    ("problem-2", 1, "/angular_velocity_at_horizontal"): ("incorrect", "rod-inertia-about-end"),
    ("1a", 0, "/angular_velocity/1"): ("incorrect", "euler-second-equation"),
    ("1b", 0, "/angular_velocity/1"): ("incorrect", "derivative-for-state"),
    ("1c", 0, "/angular_velocity/0"): ("correct", None),
    ("1d", 0, "/angular_velocity/0"): ("correct", None),
    ("1e", 0, "/body_rate"): ("correct", None),
    ("1f", 0, "/period"): ("correct", None),
    ("1f", 1, "/period"): ("incorrect", "sign"),
    ("1g", 0, "/angular_velocity"): ("incorrect", "samples-rate-over-axial-moment"),
    ("1h", 0, "/energy"): ("correct", None),
    ("1i", 0, "/semi_axes"): ("correct", None),
    ("1k", 0, "/period"): ("incorrect", "rate-over-axial-moment"),
    ("1l", 0, "/asymmetry"): ("correct", None),
    ("1l", 0, "/ellipticity"): ("incorrect", "ellipticity-root-of-moments"),
    ("1n", 0, "/equilibria/0/stable"): ("correct", None),
    ("1n", 0, "/equilibria/1/stable"): ("correct", None),
    ("1n", 0, "/equilibria/2/stable"): ("correct", None),
    ("1n", 1, "/equilibria/0/stable"): ("incorrect", "extreme-axis-unstable"),
    ("1n", 1, "/equilibria/1/stable"): ("incorrect", "middle-axis-stable"),
    ("1n", 1, "/equilibria/2/stable"): ("incorrect", "extreme-axis-unstable"),
    ("1o", 0, "/symmetry"): ("correct", None),
    ("1p", 0, "/principal/moments"): ("incorrect", "inertia-about-another-point"),
    ("1q", 0, "/flip_interval"): ("incorrect", "inertia-about-another-point"),
}


def graded(answer_of):
    """Yield question, index of the submission, the result of each claim and the claim."""
    for name in GRADED:
        submissions = json.loads(request_of(name))["submissions"]
        results = answer_of(name)["results"]
        for i, (submission, result) in enumerate(zip(submissions, results, strict=True)):
            assert result["format_errors"] == []
            for test in result["tests"]:
                yield name.removeprefix(grade_homework.FOLDER), i, test, submission[test["pointer"]]


def row(question, test, claim):
    value = claim.get("value", claim.get("formula"))
    shown = value if isinstance(value, str) else json.dumps(value) if len(json.dumps(value)) < 60 else "6 samples"
    shown = f"`{shown}`" if "formula" in claim else shown
    tags = ", ".join(match["tag"] for match in test["matches"])
    cells = (question, f"`{test['pointer']}`", f"{shown} {claim.get('unit', '')}".strip(), test["verdict"])
    return f"| {' | '.join(cells)} | {test['score']:g} | {tags} |".replace("|  |", "| |")


def test_every_number_has_the_verdict_and_the_mistake_that_are_known(answer_of):
    found = {}
    for question, i, test, _ in graded(answer_of):
        first = test["matches"][0]["tag"] if test["matches"] else None
        found[question, i, test["pointer"]] = (test["verdict"], first)
    assert found == KNOWN


def test_the_page_has_the_table(answer_of):
    rows = [row(question, test, claim) for question, _, test, claim in graded(answer_of)]
    text = PAGE.read_text(encoding="utf-8")
    assert text.rstrip().endswith("\n".join(rows)), "\n".join(rows)


def test_the_script_grades_all_of_it_in_few_lines(service, monkeypatch, capsys):
    monkeypatch.setattr(sys, "argv", ["grade_homework", "--service", service])
    grade_homework.main()
    printed = capsys.readouterr().out
    assert sum(
        "correct" in line.split()[2:3] or "incorrect" in line.split()[2:3] for line in printed.splitlines()
    ) == len(KNOWN)
    assert "moment of inertia about an end of the rod" in printed
    source = SCRIPT.read_text(encoding="utf-8")
    assert len(source.splitlines()) <= 30
    assert not any(word in source for word in ("math", "numpy", "tolerance", "abs("))


@pytest.mark.parametrize("name", GRADED)
def test_references_are_known_better_than_they_are_compared(answer_of, name):
    for reference in answer_of(name)["reference"]:
        size = max(map(abs, flat(reference["value"])), default=1.0)
        assert reference["error"] <= 1e-12 * size


def flat(value):
    if isinstance(value, list):
        return [number for entry in value for number in flat(entry)]
    return [] if isinstance(value, (bool, str)) or value is None else [value]


def test_the_variants_of_the_page_exist(service):
    (block,) = re.findall(r"```json\n(.*?)```", PAGE.read_text(), re.DOTALL)
    headers = {"Content-Type": "application/json"}
    with urlopen(Request(f"{service}/v1/variants", block.encode(), headers), timeout=PATIENCE) as response:
        answer = json.load(response)
    assert len(answer["variants"]) == json.loads(block)["count"]
