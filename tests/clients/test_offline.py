"""The folder that grades without a network: its results are those of the service."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

from core.systems.budget import Budget
from service.execution.request_handler import RequestHandler
from service.requests.request_reader import Limits
from service.responses.json_rows import written
from service.routes import questions

ROOT = Path(__file__).parents[2]
ROUTE = {route.path: route for route in questions()}["/v1/assessments"]
HANDLER = RequestHandler([ROUTE], Budget(), Limits())

REQUESTS: dict[str, Any] = {
    file.stem: json.loads(file.read_text()) for file in sorted((ROOT / "examples" / "assessments").glob("*.json"))
}
REQUESTS |= {f"documented-{name}": json.loads(json.dumps(one.question)) for name, one in ROUTE.examples.items()}

ALONE = """
import contextlib, io, json, runpy, socket, sys

def refuse(*arguments, **options):
    raise OSError("there is no network")

class OnlyHere:
    def find_spec(self, name, path=None, target=None):
        if name.partition(".")[0] in ("service", "scipy", "numba", "pydantic", "flint", "orjson", "httpx"):
            raise ImportError(name)

socket.socket.connect = socket.create_connection = socket.getaddrinfo = refuse
sys.meta_path.insert(0, OnlyHere())
bundle = sys.argv[1]
requests, answers = json.load(sys.stdin), []
for request in requests:
    sys.stdin = io.StringIO(json.dumps(request))
    with contextlib.redirect_stdout(io.StringIO()) as written:
        runpy.run_path(bundle, run_name="__main__")
    answers.append(json.loads(written.getvalue()))
json.dump(answers, sys.stdout)
import core
assert core.__file__.startswith(bundle)
assert "pint" not in sys.modules or sys.modules["pint"].__file__.startswith(bundle)
"""


@pytest.fixture(scope="module")
def bundle(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder: Path = tmp_path_factory.mktemp("offline")
    files = []
    for name, request in REQUESTS.items():
        files.append(folder / f"{name}.json")
        files[-1].write_text(json.dumps(request))
    command = [sys.executable, "-m", "clients.offline", *map(str, files), "--output", str(folder / "bundle")]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False, timeout=250)
    assert done.returncode == 0, done.stderr
    return folder / "bundle"


def graded_offline(bundle: Path, *requests: Any) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, "-I", "-c", ALONE, str(bundle)]
    return subprocess.run(
        command, cwd=bundle.parent, input=json.dumps(requests), capture_output=True, text=True, check=False, timeout=100
    )


def results_of(bundle: Path, *asked: tuple[str, Any]) -> list[Any]:
    """Return the results of questions, each with its submissions."""
    done = graded_offline(bundle, *({"question": name, "submissions": handed_in} for name, handed_in in asked))
    assert done.returncode == 0, done.stderr
    return [answer["results"] for answer in json.loads(done.stdout)]


@pytest.fixture(scope="module")
def results(bundle: Path) -> dict[str, Any]:
    """Return the results of all requests."""
    found = results_of(bundle, *((name, request["submissions"]) for name, request in REQUESTS.items()))
    return dict(zip(REQUESTS, found, strict=True))


def comparable(results: Any) -> Any:
    """Return results without the analysis of wrong samples, for which the motion has to be computed."""
    for result in results:
        for test in result["tests"]:
            if test.pop("samples", None) is not None and not test["matches"]:
                test.pop("feedback")
                result.pop("feedback")
    return results


@pytest.mark.parametrize("name", REQUESTS)
def test_results_are_those_of_the_service(results: dict[str, Any], name: str) -> None:
    request = REQUESTS[name]
    own = comparable(
        json.loads(written(HANDLER.answer(ROUTE, HANDLER.read(ROUTE, json.dumps(request).encode()))))["results"]
    )
    found = results[name]
    for mine, theirs in zip(own, found, strict=True):
        if "feedback" not in mine:
            theirs.pop("feedback")
            for one, other in zip(mine["tests"], theirs["tests"], strict=True):
                if "feedback" not in one:
                    other.pop("feedback")
    assert found == own


@pytest.mark.parametrize(
    ("claim", "verdict"),
    [
        ({"value": 376.838419, "unit": "m"}, "wrong-unit"),
        ({"value": 6280.6, "unit": "ms"}, "correct"),
        ({"value": 6.2806}, "missing-unit"),
        ({"value": 12.5612806, "unit": "s"}, "incorrect"),
        ({"formula": "2*pi*1.0/0.5"}, "missing-unit"),
    ],
)
def test_submissions_that_were_not_there_are_graded(bundle: Path, claim: Any, verdict: str) -> None:
    (found,) = results_of(bundle, ("1f", [{"/period": claim}]))
    ((test,),) = (result["tests"] for result in found)
    assert test["verdict"] == verdict
    request = REQUESTS["1f"] | {"submissions": [{"/period": claim}]}
    own = json.loads(written(HANDLER.answer(ROUTE, HANDLER.read(ROUTE, json.dumps(request).encode()))))
    assert found == own["results"]


def test_samples_at_other_times_and_unknown_figures_are_not_guessed(bundle: Path) -> None:
    other = {"/angular_velocity": {"value": [[1.0, 0.0, 0.0]], "times": [0.123], "unit": "rad/s"}}
    for submission in (other, {"/nothing": {"value": 1.0}}):
        ((result,),) = results_of(bundle, ("1g", [submission]))
        assert not result["gradable"]
        assert result["score"] is None
        assert result["format_errors"][0]["pointer"].startswith("/submissions/0/")


def test_a_question_has_to_be_named_if_there_are_several(bundle: Path) -> None:
    for request in ({"submissions": []}, {"question": "nothing", "submissions": []}):
        done = graded_offline(bundle, request)
        assert done.returncode == 1
        assert "must be one of" in done.stderr


def test_nothing_of_core_is_changed_and_nothing_compiled_goes_with_it(bundle: Path) -> None:
    copied = [file.relative_to(bundle) for file in (bundle / "core").rglob("*.py")]
    assert Path("core/assessment/compare.py") in copied
    for file in copied:
        assert (bundle / file).read_bytes() == (ROOT / file).read_bytes()
    assert not {"rotation", "multibody", "systems"} & {file.parts[1] for file in copied}


def test_what_cannot_be_asked_is_refused(tmp_path: Path) -> None:
    wrong = tmp_path / "wrong.json"
    wrong.write_text(json.dumps({"question": {"path": "/v1/nothing", "request": {}}, "submissions": [{}]}))
    command = [sys.executable, "-m", "clients.offline", str(wrong), "--output", str(tmp_path / "bundle")]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False, timeout=100)
    assert done.returncode == 1
    assert done.stderr.splitlines()[-1].startswith(f"{wrong}: /question/path must be the path")
    assert not (tmp_path / "bundle").exists()
