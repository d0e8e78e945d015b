"""Element for PrairieLearn that grades a number, an array or a formula with Polhode.

    <pl-polhode answers-name="T" question="1f" pointer="/period" unit="s" label="T ="></pl-polhode>

`unit` is that of answers without one; `weight` defaults to 1. The course's elements/pl-polhode has this folder and
polhode_results.py; its serverFilesCourse/polhode has the folder `bundle` (or, with POLHODE_URL set, `questions`).
"""

from __future__ import annotations

import html
import sys
from html.parser import HTMLParser
from pathlib import Path
from typing import Any

sys.path.insert(0, str(Path(__file__).parent))

from polhode_results import claim, feedback, results

Data = dict[str, Any]
REQUIRED = ("answers-name", "question", "pointer")
OPTIONAL = ("unit", "label", "weight")


def attributes(element_html: str) -> dict[str, str]:
    """Return the attributes of the element, or raise `ValueError` for one that is missing or not known."""
    found: dict[str, str] = {}

    class First(HTMLParser):
        def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
            if tag == "pl-polhode":
                found.update({name: value or "" for name, value in attrs})

    First().feed(element_html)
    missing = [name for name in REQUIRED if not found.get(name)]
    unknown = [name for name in found if name not in REQUIRED + OPTIONAL]
    if missing or unknown:
        raise ValueError(f"pl-polhode: missing {missing}, not known {unknown}")
    return found


def prepare(element_html: str, data: Data) -> None:
    """Check the element when a variant of the question is made."""
    attributes(element_html)


def render(element_html: str, data: Data) -> str:
    """Return the HTML of a panel."""
    given = attributes(element_html)
    name, label = html.escape(given["answers-name"]), html.escape(given.get("label", ""))
    typed = html.escape(str(data["raw_submitted_answers"].get(given["answers-name"], "")))
    if data["panel"] == "question":
        state = "" if data["editable"] else " disabled"
        return f'<label>{label} <input type="text" name="{name}" value="{typed}" class="form-control"{state}></label>'
    if data["panel"] == "submission":
        said = data["format_errors"].get(given["answers-name"])
        said = said or data["partial_scores"].get(given["answers-name"], {}).get("feedback", "")
        return f"<p>{label} <code>{typed}</code></p><p>{html.escape(str(said))}</p>"
    return ""


def parse(element_html: str, data: Data) -> None:
    """Read what was typed."""
    given = attributes(element_html)
    name = given["answers-name"]
    typed = data["submitted_answers"].get(name)
    if typed is None or not str(typed).strip():
        data["format_errors"][name] = "Enter an answer."
        data["submitted_answers"][name] = None
    else:
        data["submitted_answers"][name] = claim(str(typed), given.get("unit"))


def grade(element_html: str, data: Data) -> None:
    """Grade what was read; what cannot be judged costs no attempt."""
    given = attributes(element_html)
    name = given["answers-name"]
    folder = Path(data["options"]["server_files_course_path"]) / "polhode"
    (result,) = results(folder, given["question"], [{given["pointer"]: data["submitted_answers"][name]}])
    if result["gradable"]:
        weight = int(given.get("weight", "1"))
        data["partial_scores"][name] = {"score": result["score"], "weight": weight, "feedback": feedback(result)}
    else:
        data["format_errors"][name] = feedback(result)
