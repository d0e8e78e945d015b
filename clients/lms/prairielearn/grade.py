"""External grader for PrairieLearn: reads what was submitted, writes results.json (results.schema.json).

In the question's info.json:

    "externalGradingOptions": {
        "enabled": true, "image": "prairielearn/grader-python", "timeout": 30, "serverFilesCourse": ["polhode/"],
        "entrypoint": ["python3", "/grade/serverFilesCourse/polhode/grade.py"]
    }

`serverFilesCourse/polhode` has this file, polhode_results.py and the folder `bundle`. The question's tests/polhode.json
says what its answers claim; an answer is a field of the question, or a JSON file that is handed in:

    {"question": "1f", "answers": {"T": {"pointer": "/period", "unit": "s"}, "w": {"pointer": "...", "file": "w.json"}}}
"""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import Any

from polhode_results import claim, feedback, handed_in, results


def submission(grade: Path, answers: dict[str, Any]) -> dict[str, Any]:
    """Return the claims that were submitted, by pointer; an answer that is missing claims an empty formula."""
    fields = json.loads((grade / "data" / "data.json").read_text(encoding="utf-8"))["submitted_answers"]
    claims = {}
    for name, answer in answers.items():
        if "file" in answer:
            try:
                claims[answer["pointer"]] = handed_in(grade / "student" / answer["file"])
            except (OSError, ValueError, RecursionError):
                claims[answer["pointer"]] = {"formula": ""}
            continue
        entry = fields.get(name, "")
        # Arrays and other numbers are stored as objects with their type.
        entry = entry.get("_value", "") if isinstance(entry, dict) else entry
        claims[answer["pointer"]] = claim(entry, answer.get("unit"))
    return claims


def report(result: dict[str, Any]) -> dict[str, Any]:
    """Return a result in PrairieLearn's form."""
    tests = [
        {"name": test["pointer"], "points": test["score"] or 0.0, "max_points": 1.0, "message": test["feedback"]}
        for test in result["tests"]
    ]
    if not result["gradable"]:
        faults = [
            f"{fault['pointer'].removeprefix('/submissions/0')}: {fault['detail']}" for fault in result["format_errors"]
        ]
        return {"gradable": False, "message": feedback(result), "format_errors": faults or [result["feedback"]]}
    return {"gradable": True, "score": result["score"], "message": result["feedback"], "tests": tests}


def main() -> None:
    """Grade what is in /grade, or in the folder that is named."""
    grade = Path(sys.argv[1] if len(sys.argv) > 1 else "/grade")
    asked = json.loads((grade / "tests" / "polhode.json").read_text(encoding="utf-8"))
    (result,) = results(Path(__file__).parent, asked["question"], [submission(grade, asked["answers"])])
    (grade / "results").mkdir(exist_ok=True)
    (grade / "results" / "results.json").write_text(json.dumps(report(result)), encoding="utf-8")


if __name__ == "__main__":
    main()
