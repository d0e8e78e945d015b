"""Autograder for Gradescope: grades the file answers.json of a submission, writes results.json.

The archive has setup.sh, run_autograder, this file, polhode_results.py, the folder `bundle`, and points.json with what
each question is worth: {"1f": 2.0, "1h": 1.0}. A student hands in answers.json:

    {"1f": {"/period": "6.2806 s"}, "1h": {"/energy": {"value": 1.75, "unit": "J"}}}
"""

from __future__ import annotations

import json
import os
from pathlib import Path
from typing import Any

from polhode_results import claim, feedback, handed_in, results

HERE = Path(__file__).parent


def graded(question: str, points: float, claims: Any) -> dict[str, Any]:
    """Return the entry of a question in results.json."""
    entry: dict[str, Any] = {"name": question, "max_score": points, "score": 0.0, "status": "failed"}
    if not isinstance(claims, dict) or not claims:
        return entry | {"output": "There is no answer to this question in answers.json."}
    read = {pointer: one if isinstance(one, dict) else claim(one) for pointer, one in claims.items()}
    (result,) = results(HERE, question, [read])
    score = points * (result["score"] or 0.0)
    return entry | {
        "score": score,
        "status": "passed" if result["correct"] else "failed",
        "output": feedback(result),
    }


def main() -> None:
    """Grade /autograder/submission, or that of the folder in the environment variable AUTOGRADER."""
    root = Path(os.environ.get("AUTOGRADER", "/autograder"))
    points = json.loads((HERE / "points.json").read_text(encoding="utf-8"))
    try:
        answers = handed_in(root / "submission" / "answers.json")
        said = ""
    except (OSError, ValueError, RecursionError) as fault:
        answers, said = {}, f"answers.json cannot be read: {fault}"
    answers = answers if isinstance(answers, dict) else {}
    tests = [graded(question, worth, answers.get(question)) for question, worth in points.items()]
    found = {"tests": tests} | ({"output": said} if said else {})
    (root / "results" / "results.json").write_text(json.dumps(found), encoding="utf-8")


if __name__ == "__main__":
    main()
