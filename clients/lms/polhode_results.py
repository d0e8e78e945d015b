"""Results of submissions, for graders of learning platforms: from a service, or from a folder that needs no network.

Copy this file beside the grader that imports it. It needs Python's standard library alone; the folder needs numpy.
"""

from __future__ import annotations

import json
import os
import stat
import subprocess
import sys
import urllib.request
from pathlib import Path
from typing import Any


def results(folder: Path, question: str, submissions: list[Any]) -> list[dict[str, Any]]:
    """Return the results of submissions to a question, as POST /v1/assessments answers them.

    Parameters
    ----------
    folder : Path
        Where `bundle` is, as ``python -m clients.offline`` writes it; or, if the environment variable POLHODE_URL names
        a service, where `questions` is, with the requests that such a bundle is written from.
    question : str
        Name of a file in either, without its ending.
    """
    service = os.environ.get("POLHODE_URL")
    if service:
        request = json.loads((folder / "questions" / f"{question}.json").read_text(encoding="utf-8"))
        body = json.dumps(request | {"submissions": submissions}).encode()
        sent = urllib.request.Request(f"{service}/v1/assessments", body, {"Content-Type": "application/json"})
        with urllib.request.urlopen(sent, timeout=60) as answer:
            found: list[dict[str, Any]] = json.load(answer)["results"]
            return found
    request = json.dumps({"question": question, "submissions": submissions})
    command = [sys.executable, "-I", str(folder / "bundle")]
    done = subprocess.run(command, input=request, capture_output=True, text=True, check=True, timeout=60)
    found = json.loads(done.stdout)["results"]
    return found


def handed_in(file: Path) -> Any:
    """Return the document in a file that a student has handed in.

    Raises
    ------
    OSError, ValueError, RecursionError
        If there is none: a link could lead to what students may not see, a pipe would be waited for.
    """
    opened = os.open(file, os.O_RDONLY | os.O_NOFOLLOW | os.O_NONBLOCK)
    with open(opened, encoding="utf-8") as text:
        if not stat.S_ISREG(os.fstat(opened).st_mode):
            raise OSError(f"{file.name} is not a file")
        return json.load(text)


def claim(entry: Any, unit: str | None = None) -> dict[str, Any]:
    """Return the claim that an entry makes: text is read by the grader, as a number with its unit, a formula or a word.

    Parameters
    ----------
    entry : Any
        What was typed, or a value.
    unit : str, optional
        Of what has none of its own.
    """
    return {"text" if isinstance(entry, str) else "value": entry} | ({"unit": unit} if unit else {})


def feedback(result: dict[str, Any]) -> str:
    """Return what is shown of a result: the feedback, which says what could not be read."""
    return str(result["feedback"])
