"""Clients that are generated from docs/openapi.json: they type-check, answer, and bring every field back as it is."""

from __future__ import annotations

import importlib
import json
import re
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from types import ModuleType
from typing import Any

import orjson
import pytest

from core.systems.budget import Budget
from service.execution.request_handler import RequestHandler
from service.requests.request_reader import Limits
from service.responses.json_rows import written
from service.routes import questions
from service.routing import PostRoute, StudyRoute

DOCUMENT = Path(__file__).parents[2] / "docs" / "openapi.json"
ROUTES = questions()
HANDLER = RequestHandler(ROUTES, Budget(), Limits())
EXAMPLES = [(route, name) for route in ROUTES if not isinstance(route, StudyRoute) for name in route.examples]
NUMBERED = {"DormandPrince853", "RungeKutta4"}
"""Names that end in a number in the field's own terms."""

DATAMODEL = [
    "datamodel_code_generator",
    "--input-file-type",
    "openapi",
    "--output-model-type",
    "pydantic_v2.BaseModel",
    "--target-python-version",
    "3.11",
    "--use-annotated",
    "--use-type-alias",
    "--use-title-as-name",
    "--enum-field-as-literal",
    "all",
    "--naming-strategy",
    "full-path",
    "--formatters",
    "builtin",
]
CLIENT = ["openapi_python_client", "generate", "--meta", "none"]


def run(*command: str, folder: Path) -> str:
    done = subprocess.run([sys.executable, "-m", *command], cwd=folder, check=False, text=True, capture_output=True)
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Path]:
    made: Path = tmp_path_factory.mktemp("generated")
    run(*DATAMODEL, "--input", str(DOCUMENT), "--output", "polhode_models.py", folder=made)
    run(*CLIENT, "--path", str(DOCUMENT), "--output-path", "polhode_api", folder=made)
    sys.path.insert(0, str(made))
    yield made
    sys.path.remove(str(made))


@pytest.fixture(scope="module")
def models(folder: Path) -> ModuleType:
    return importlib.import_module("polhode_models")


@pytest.fixture(scope="module")
def api_models(folder: Path) -> ModuleType:
    return importlib.import_module("polhode_api.models")


@pytest.mark.parametrize("made", ["polhode_models.py", "polhode_api"])
def test_it_passes_mypy_in_strict_mode(folder: Path, made: str) -> None:
    run("mypy", "--strict", "--cache-dir", str(folder / "cache"), made, folder=folder)


@pytest.mark.parametrize("made", ["polhode_models.py", "polhode_api/models/__init__.py"])
def test_its_names_are_those_of_the_field(folder: Path, made: str) -> None:
    names = re.findall(r"^(?:class |from \S+ import )?([A-Z]\w*)", (folder / made).read_text(), re.MULTILINE)
    assert len(names) > 89
    assert {name for name in names if re.search("[0-9]", name)} <= NUMBERED


def answer_of(route: PostRoute, question: Any) -> Any:
    return json.loads(written(HANDLER.answer(route, HANDLER.read(route, orjson.dumps(question)))))


@pytest.mark.parametrize(("route", "name"), EXAMPLES, ids=[f"{route.operation_id}: {name}" for route, name in EXAMPLES])
def test_questions_and_answers_come_back_as_they_were(
    route: PostRoute, name: str, models: ModuleType, api_models: ModuleType
) -> None:
    question = json.loads(json.dumps(route.examples[name].question))
    sent = getattr(models, route.question.__name__).model_validate(question)
    again = sent.model_dump(mode="json", by_alias=True, exclude_unset=True)
    assert same(again, question)
    request = getattr(api_models, route.question.__name__).from_dict(question).to_dict()
    assert same({key: request[key] for key in question}, question)
    answer = answer_of(route, request)
    read = getattr(models, route.answer.__name__).model_validate(answer, strict=True)
    assert same(read.model_dump(mode="json", by_alias=True, exclude_unset=True), answer)
    assert same(getattr(api_models, route.answer.__name__).from_dict(answer).to_dict(), answer)


def test_every_operation_is_called_over_http(folder: Path, api_models: ModuleType, service: str) -> None:
    document = json.loads(DOCUMENT.read_text())
    with importlib.import_module("polhode_api").Client(base_url=service) as client:
        call_every_operation(document, client, api_models)


def call_every_operation(document: Any, client: Any, api_models: ModuleType) -> None:
    operations = [entry for verbs in document["paths"].values() for entry in verbs.values()]
    study = ""
    # A study is dismissed at the end, and waited for before its results are fetched.
    for entry in sorted(
        operations, key=lambda entry: (entry["tags"] == ["studies"], "dismiss" in entry["operationId"])
    ):
        name = entry["operationId"]
        module = importlib.import_module(f"polhode_api.api.{entry['tags'][0]}.{name}")
        places = [study for one in entry.get("parameters", ()) if one.get("in") == "path"]
        questions = [{}]
        if "requestBody" in entry:
            content = entry["requestBody"]["content"]["application/json"]
            request = getattr(api_models, content["schema"]["$ref"].rsplit("/", 1)[1])
            shown = content.get("examples") or plain_examples(document, name)
            questions = [{"body": request.from_dict(one["value"])} for one in shown.values()]
        for question in questions:
            response = module.sync_detailed(*places, client=client, **question)
            assert response.status_code in (200, 202), (name, response.content)
        if name == "create_study":
            study = json.loads(response.content)["jobID"]
            watch = importlib.import_module("polhode_api.api.studies.watch_study")
            watch.sync_detailed(study, client=client)


def plain_examples(document: Any, name: str) -> Any:
    """Return the examples with samples of the operation whose answer is drawn."""
    for verbs in document["paths"].values():
        for entry in verbs.values():
            if entry["operationId"] == name.removesuffix("_svg"):
                examples = entry["requestBody"]["content"]["application/json"]["examples"]
                return {key: one for key, one in examples.items() if "times" in one["value"]}
    raise AssertionError(name)


def same(one: Any, other: Any) -> bool:
    """Return whether two documents are equal in every value and type, but that 1 and 1.0 are one number."""
    if isinstance(one, dict) and isinstance(other, dict):
        return one.keys() == other.keys() and all(same(one[key], other[key]) for key in one)
    if isinstance(one, list) and isinstance(other, list):
        return len(one) == len(other) and all(map(same, one, other))
    if isinstance(one, (int, float)) and isinstance(other, (int, float)):
        return isinstance(one, bool) == isinstance(other, bool) and one == other
    return type(one) is type(other) and one == other
