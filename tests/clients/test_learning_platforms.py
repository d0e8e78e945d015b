"""Graders for learning platforms, run as the platforms run them."""

from __future__ import annotations

import importlib.util
import json
import os
import shutil
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from types import ModuleType
from typing import Any
from xml.etree import ElementTree

import jinja2
import jsonschema
import pytest

ROOT = Path(__file__).parents[2]
PLATFORMS = ROOT / "clients" / "lms"
PERIOD = 6.2831853


def deployed(folder: Path, bundle: Path, *files: str) -> Path:
    """Copy files of a platform, what they import and the bundle into one folder."""
    folder.mkdir(parents=True, exist_ok=True)
    for file in (*files, "polhode_results.py"):
        shutil.copy(PLATFORMS / file, folder)
    shutil.copytree(bundle, folder / "bundle")
    return folder


def without_service() -> dict[str, str]:
    return {name: value for name, value in os.environ.items() if name != "POLHODE_URL"}


def valid(folder: str, report: Any) -> Any:
    jsonschema.validate(report, json.loads((PLATFORMS / folder / "results.schema.json").read_text()))
    return report


class Course:
    """A PrairieLearn course whose external grader has been copied into it."""

    def __init__(self, folder: Path, bundle: Path) -> None:
        self.folder = folder
        self.code = deployed(folder / "serverFilesCourse" / "polhode", bundle, "prairielearn/grade.py")
        for name in ("data", "tests", "student"):
            (folder / name).mkdir()

    def report(self, asked: Any, fields: Any, files: dict[str, Any]) -> Any:
        (self.folder / "tests" / "polhode.json").write_text(json.dumps(asked))
        (self.folder / "data" / "data.json").write_text(json.dumps({"submitted_answers": fields}))
        for name, content in files.items():
            (self.folder / "student" / name).write_text(json.dumps(content))
        subprocess.run(
            [sys.executable, str(self.code / "grade.py"), str(self.folder)],
            check=True, timeout=100, env=without_service(),
        )  # fmt: skip
        return valid("prairielearn", json.loads((self.folder / "results" / "results.json").read_text()))


TIMED: Any = {"question": "1f", "answers": {"T": {"pointer": "/period", "unit": "s"}}}


@pytest.mark.parametrize(
    ("typed", "score"),
    [(6.28, 1.0), ("6.28", 1.0), ("0.1047 min", 1.0), (-6.28, 0.5), ("3", 0.0), ({"_type": "x", "_value": 6.28}, 1.0)],
)
def test_the_external_grader_of_prairielearn(tmp_path: Path, bundle: Path, typed: Any, score: float) -> None:
    report = Course(tmp_path, bundle).report(TIMED, {"T": typed}, {})
    assert report["gradable"]
    assert report["score"] == score
    assert report["tests"][0]["name"] == "/period"
    assert report["tests"][0]["points"] == score


@pytest.mark.parametrize("typed", ["", "6 +", "__import__('os')"])
def test_what_cannot_be_read_is_not_gradable(tmp_path: Path, bundle: Path, typed: str) -> None:
    report = Course(tmp_path, bundle).report(TIMED, {"T": typed}, {})
    assert not report["gradable"]
    assert report["format_errors"][0].startswith("/~1period")


def test_files_that_are_handed_in_are_graded(tmp_path: Path, bundle: Path) -> None:
    request = json.loads((ROOT / "examples" / "assessments" / "1g.json").read_text())
    (submitted,) = request["submissions"]
    ((pointer, claim),) = submitted.items()
    asked = {"question": "1g", "answers": {"w": {"pointer": pointer, "file": "w.json"}}}
    course = Course(tmp_path, bundle)
    report = course.report(asked, {}, {"w.json": claim})
    assert report["score"] == 0.25
    (tmp_path / "student" / "w.json").rename(tmp_path / "elsewhere.json")
    (tmp_path / "student" / "w.json").symlink_to(tmp_path / "elsewhere.json")
    assert not course.report(asked, {}, {})["gradable"]


@pytest.fixture
def element(tmp_path: Path, bundle: Path, monkeypatch: pytest.MonkeyPatch) -> ModuleType:
    folder = tmp_path / "elements" / "pl-polhode"
    shutil.copytree(PLATFORMS / "prairielearn" / "pl-polhode", folder)
    shutil.copy(PLATFORMS / "polhode_results.py", folder)
    (tmp_path / "serverFilesCourse" / "polhode").mkdir(parents=True)
    shutil.copytree(bundle, tmp_path / "serverFilesCourse" / "polhode" / "bundle")
    monkeypatch.delenv("POLHODE_URL", raising=False)
    monkeypatch.setattr(sys, "path", [*sys.path])
    monkeypatch.delitem(sys.modules, "polhode_results", raising=False)
    controller = json.loads((folder / "info.json").read_text())["controller"]
    spec = importlib.util.spec_from_file_location("pl_polhode", folder / controller)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


ELEMENT = '<pl-polhode answers-name="T" question="1f" pointer="/period" unit="s" label="T ="></pl-polhode>'


def data_of(tmp_path: Path, typed: str | None) -> Any:
    answers = {} if typed is None else {"T": typed}
    return {
        "params": {}, "correct_answers": {}, "format_errors": {}, "partial_scores": {}, "feedback": {}, "score": 0.0,
        "submitted_answers": {**answers}, "raw_submitted_answers": answers, "editable": True, "panel": "question",
        "variant_seed": 1, "options": {"server_files_course_path": str(tmp_path / "serverFilesCourse")},
    }  # fmt: skip


@pytest.mark.parametrize(("typed", "score"), [("6.2806", 1.0), ("6280.6 ms", 1.0), ("-6.28 s", 0.5), ("1e3", 0.0)])
def test_the_element_of_prairielearn(element: ModuleType, tmp_path: Path, typed: str, score: float) -> None:
    data = data_of(tmp_path, typed)
    element.prepare(ELEMENT, data)
    assert '<input type="text" name="T"' in element.render(ELEMENT, data)
    element.parse(ELEMENT, data)
    assert not data["format_errors"]
    element.grade(ELEMENT, data)
    assert data["partial_scores"]["T"]["score"] == score
    assert data["partial_scores"]["T"]["weight"] == 1
    data["panel"] = "submission"
    shown = element.render(ELEMENT, data)
    assert typed in shown
    assert data["partial_scores"]["T"]["feedback"].split(";")[0] in shown
    data["panel"] = "answer"
    assert element.render(ELEMENT, data) == ""


@pytest.mark.parametrize("typed", [None, "", "  ", "6 + <script>"])
def test_the_element_refuses_what_cannot_be_read(element: ModuleType, tmp_path: Path, typed: str | None) -> None:
    data = data_of(tmp_path, typed)
    element.parse(ELEMENT, data)
    if not data["format_errors"]:
        element.grade(ELEMENT, data)
    assert data["format_errors"]["T"]
    assert not data["partial_scores"]
    data["panel"] = "submission"
    assert "<script>" not in element.render(ELEMENT, data)


def test_an_element_without_its_attributes_is_no_question(element: ModuleType, tmp_path: Path) -> None:
    for wrong in ('<pl-polhode answers-name="T" question="1f"></pl-polhode>', ELEMENT.replace("unit", "units")):
        with pytest.raises(ValueError, match="pl-polhode: missing"):
            element.prepare(wrong, data_of(tmp_path, None))


def test_the_element_grades_with_a_service_too(
    element: ModuleType, tmp_path: Path, service: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("POLHODE_URL", service)
    folder = tmp_path / "serverFilesCourse" / "polhode"
    shutil.rmtree(folder / "bundle")
    (folder / "questions").mkdir()
    shutil.copy(ROOT / "examples" / "assessments" / "1f.json", folder / "questions")
    data = data_of(tmp_path, "-6.28 s")
    element.parse(ELEMENT, data)
    element.grade(ELEMENT, data)
    assert data["partial_scores"]["T"]["score"] == 0.5


def autograded(
    tmp_path: Path, bundle: Path, answers: str | None, hand_in: Callable[[Path], object] | None = None
) -> Any:
    source = deployed(
        tmp_path / "source", bundle, "gradescope/grade.py", "gradescope/run_autograder", "gradescope/setup.sh"
    )
    (source / "points.json").write_text('{"1f": 2.0, "problem-1": 3.0}')
    for name in ("submission", "results"):
        (tmp_path / name).mkdir(exist_ok=True)
    if answers is not None:
        (tmp_path / "submission" / "answers.json").write_text(answers)
    environment = without_service() | {"AUTOGRADER": str(tmp_path)}
    environment["PATH"] = f"{Path(sys.executable).parent}{os.pathsep}{environment['PATH']}"
    subprocess.run([str(source / "run_autograder")], check=True, timeout=100, env=environment)
    return valid("gradescope", json.loads((tmp_path / "results" / "results.json").read_text()))


def linked(submission: Path) -> None:
    """Hand in a link to right answers: what it leads to could be anything that the grader may read."""
    (submission.parent / "right").write_text('{"1f": {"/period": "6.2806 s"}}')
    (submission / "answers.json").symlink_to(submission.parent / "right")


def shadowed(submission: Path) -> None:
    """Hand in modules with the names of those that the grader imports."""
    for name in ("json", "polhode_results", "numpy"):
        (submission / f"{name}.py").write_text("raise SystemExit(1)")
    (submission / "answers.json").write_text("{}")


@pytest.mark.parametrize("hand_in", [linked, shadowed, lambda folder: os.mkfifo(folder / "answers.json")])
def test_only_a_file_is_read_of_what_is_handed_in(
    tmp_path: Path, bundle: Path, hand_in: Callable[[Path], object]
) -> None:
    (tmp_path / "submission").mkdir()
    hand_in(tmp_path / "submission")
    report = autograded(tmp_path, bundle, None)
    assert [test["score"] for test in report["tests"]] == [0.0, 0.0]


def test_the_autograder_of_gradescope(tmp_path: Path, bundle: Path) -> None:
    answers = {
        "1f": {"/period": "-6.28 s"},
        "problem-1": {"/tension": {"value": 2.7528, "unit": "N"}, "/accelerations/0": "3.33 m/s^2"},
    }
    period, forces = autograded(tmp_path, bundle, json.dumps(answers))["tests"]
    assert (period["score"], period["max_score"], period["status"]) == (1.0, 2.0, "failed")
    assert (forces["score"], forces["status"], forces["output"]) == (3.0, "passed", "Correct.")


@pytest.mark.parametrize(
    "answers",
    [
        None,
        '{"1f": 3}',
        # What is no claim: a tolerance, a score, and numbers that nothing can be compared with.
        '{"1f": {"/period": {"value": 6.28, "unit": "s", "tolerance": 9}}, "problem-1": {"/tension": {"value": NaN}}}',
        '{"1f": {"/period": {"value": 1, "reference": 1, "score": 1}}, "problem-1": {"": 1e400}}',
        '{"1f": ' + "[" * 10_000,
    ],
    ids=lambda answers: str(answers)[:30],
)
def test_nothing_that_is_handed_in_stops_the_autograder(tmp_path: Path, bundle: Path, answers: str | None) -> None:
    report = autograded(tmp_path, bundle, answers)
    assert [test["score"] for test in report["tests"]] == [0.0, 0.0]
    assert all(test["output"] for test in report["tests"])


def test_a_question_for_stack_has_the_variants_of_the_service(service: str) -> None:
    spec = json.loads((PLATFORMS / "moodle" / "flip-interval.json").read_text())
    done = subprocess.run(
        [sys.executable, str(PLATFORMS / "moodle" / "stack.py"), str(PLATFORMS / "moodle" / "flip-interval.json")],
        capture_output=True, check=True, timeout=100,
        env=os.environ | {"POLHODE_URL": service, "PYTHONPATH": str(ROOT / "clients" / "python")},
    )  # fmt: skip
    question = ElementTree.fromstring(done.stdout).find("question")
    assert question is not None
    assert question.get("type") == "stack"
    lines = (question.findtext("questionvariables/text") or "").splitlines()
    assert lines[0] == "variant: rand(5) + 1;"
    lists = {
        name: json.loads(rest[: rest.index("]") + 1]) for name, rest in (line.split(": ", 1) for line in lines[1:])
    }
    assert set(lists) == {"moment_1", "moment_2", "rate", "answer"}
    assert all(f"{{@{name}@}}" in (question.findtext("questiontext/text") or "") for name in spec["numbers"])
    assert (question.findtext("prt/node/answertest"), question.findtext("prt/node/testoptions")) == (
        "UnitsRelative",
        "0.01",
    )
    assert question.findtext("input/tans") == "answer*s"
    # Each answer is the service's own.
    from polhode_client import Client

    with Client(service) as polhode:
        for one, two, rate, answer in zip(
            *(lists[name] for name in ("moment_1", "moment_2", "rate", "answer")), strict=True
        ):
            body: Any = {"kind": "principal-moments", "moments": [one, two, 1.5]}
            assert polhode.precession(body=body, angular_velocity=[0.1, rate, 0.1])["flip_interval"] == answer


def coderunner(tmp_path: Path, bundle: Path, program: str, *, without_landlock: bool = False) -> Any:
    """Run the template as CodeRunner does: expanded by Twig, whose syntax here is that of Jinja."""
    environment = jinja2.Environment()
    environment.filters["e"] = lambda text, kind: text.replace("\\", "\\\\").replace('"', '\\"')
    template = environment.from_string((PLATFORMS / "moodle" / "coderunner_template.py.twig").read_text())
    code = template.render(
        STUDENT_ANSWER=program,
        TESTCASES=[{"testcode": "/period s"}, {"testcode": "/body_rate rad/s"}],
        QUESTION={"parameters": {"question": "1f"}},
    )
    shutil.copy(bundle.with_suffix(".zip"), tmp_path)
    shutil.copy(PLATFORMS / "polhode_results.py", tmp_path)
    if without_landlock:
        code = code.replace(
            "CREATE_RULESET, ADD_RULE, RESTRICT_SELF = 444", "CREATE_RULESET, ADD_RULE, RESTRICT_SELF = 9999"
        )
    # As Jobe runs it: the shell writes into files of the folder of the run, which are then read by their paths.
    (tmp_path / "prog.py").write_text(code)
    subprocess.run(
        ["sh", "-c", f"{sys.executable} prog.py > prog.out 2> prog.err; echo $? > prog.status"],
        cwd=tmp_path, check=True, timeout=100,
        env=without_service() | {"PYTHONPATH": str(tmp_path), "TMPDIR": str(tmp_path)},
    )  # fmt: skip
    assert (tmp_path / "prog.status").read_text() == "0\n", (tmp_path / "prog.err").read_text()
    assert not list(tmp_path.glob("*/bundle")), "the answer keys are left for the next program"
    return json.loads((tmp_path / "prog.out").read_text())


DETACHED = """
import os, sys, time
if os.fork() == 0:
    os.setsid()
    if os.fork() == 0:
        print(os.getpid(), file=sys.stderr, flush=True)
        open("detached", "w")
        {attack}
    os._exit(0)
os.wait()
while not os.path.exists("detached"):
    time.sleep(0.01)
answers = ["1 s", "2 rad/s"]
"""
"""A program that leaves a process behind, in a session of its own."""

REWRITES = """
        import glob, json, tempfile
        until = time.time() + 20
        while time.time() < until:
            for key in glob.glob(f"{tempfile.gettempdir()}/*/bundle/keys/*.json"):
                figures = {tuple(f["path"]): f["reference"]["value"] for f in json.load(open(key))["figures"]}
                right = [f"{figures['period',]!r} s", f"{figures['body_rate',]!r} rad/s"]
                open("answers.json", "w").write(json.dumps(right))
"""


@pytest.mark.parametrize("attack", [REWRITES, "time.sleep(60)", "import signal; signal.pause()"])
def test_what_a_program_leaves_behind_ends_before_the_keys_are_unpacked(
    tmp_path: Path, bundle: Path, attack: str
) -> None:
    found = coderunner(tmp_path, bundle, DETACHED.replace("{attack}", attack))
    assert found["fraction"] == 0.0
    process = int(found["prologuehtml"].removeprefix("<pre>").split()[0])
    assert not Path(f"/proc/{process}").exists()


@pytest.mark.parametrize(
    "made",
    [
        "os.mkfifo('answers.json')",
        "open('right', 'w').write('[6.2806, 1]'); os.symlink('right', 'answers.json')",
        "os.mkdir('answers.json')",
    ],
)
def test_answers_are_read_from_a_file_alone(tmp_path: Path, bundle: Path, made: str) -> None:
    assert coderunner(tmp_path, bundle, f"import os\n{made}\nos._exit(0)")["fraction"] == 0.0


def test_modules_that_a_program_writes_are_not_imported_by_what_grades_it(tmp_path: Path, bundle: Path) -> None:
    """Of any name, as of those that Python imports only when it needs them."""
    written = """
import sys
for name in (*sys.stdlib_module_names, "polhode_results", "numpy"):
    open(name + ".py", "w").write("import os; os.write(1, b'{}'); os._exit(0)")
answers = [1, 2]
"""
    found = coderunner(tmp_path, bundle, written)
    assert found["fraction"] == 0.0
    assert found["prologuehtml"] == ""


FORGED = json.dumps({"fraction": 1.0, "testresults": [["iscorrect"], [1]], "prologuehtml": ""})
ATTACKS = {
    "the output by its path": "open('{run}/prog.out', 'w').write(forged)",
    "another file in place of the output": "os.unlink('{run}/prog.out'); open('{run}/prog.out', 'w').write(forged)",
    "another file moved over the output": "open('mine', 'w').write(forged); os.rename('mine', '{run}/prog.out')",
    "the output as the grader has it open": "open(f'/proc/{os.getppid()}/fd/1', 'a').write(forged)",
    "the output of whoever has it open": "open(f'/proc/{grandparent}/fd/1', 'a').write(forged)",
    "the memory of the grader": "open(f'/proc/{os.getppid()}/mem', 'r+b')",
    "a module of the grader": "open('{run}/polhode_results.py', 'w').write('raise SystemExit')",
    "a module for the grader": "open('{run}/json.py', 'w').write('raise SystemExit')",
    "the folder of the run": "os.rename('{run}', '{run}-old')",
    "a link into the folder of the run": "os.link('{run}/prog.py', 'mine')",
}


@pytest.mark.parametrize("attack", ATTACKS.values(), ids=ATTACKS)
def test_a_program_changes_nothing_of_the_run_that_grades_it(tmp_path: Path, bundle: Path, attack: str) -> None:
    """Whatever its user is: the tests' is often root."""
    run = tmp_path / "run"
    run.mkdir()
    program = f"""
import os
forged = {FORGED!r}
grandparent = int(open(f"/proc/{{os.getppid()}}/stat").read().rpartition(")")[2].split()[1])
{attack.replace("{run}", str(run))}
answers = [6.2806, 1]
"""
    found = coderunner(run, bundle, program)
    assert found["fraction"] == 0.0
    assert "Error" in found["prologuehtml"]
    assert {file.name for file in run.iterdir()} <= {
        *("prog.py", "prog.out", "prog.err", "prog.status", "polhode_results.py", "__pycache__"),
    }


def test_a_program_has_a_folder_of_its_own_to_write_in(tmp_path: Path, bundle: Path) -> None:
    program = """
import os, subprocess, sys, tempfile
with tempfile.TemporaryDirectory() as folder:
    open(f"{folder}/a", "w").write("6.2806")
    os.rename(f"{folder}/a", "b")
os.makedirs("left/behind")
os.chmod("left", 0)
subprocess.run([sys.executable, "-c", "print(1)"], check=True, stdout=subprocess.DEVNULL)
answers = [float(open("b").read()), "1 rad/s"]
"""
    assert coderunner(tmp_path, bundle, program)["fraction"] == 1.0


def test_no_program_is_run_where_it_cannot_be_kept_from_the_grader(tmp_path: Path, bundle: Path) -> None:
    """As on systems without Landlock: the number of its system call here is that of none."""
    found = coderunner(tmp_path, bundle, "answers = [6.2806, 1]", without_landlock=True)
    assert found["fraction"] == 0.0
    assert "cannot be run apart" in found["prologuehtml"]


@pytest.mark.parametrize(
    ("program", "fraction"),
    [
        ('from math import pi\nprint("{")\nanswers = [6.2806, "1 rad/s"]', 1.0),
        ('answers = ["-6.28 s", 7]', 0.25),
        ("answers = [6.28]", 0.5),
        ("raise ValueError('\"')", 0.0),
        ("answers = 3", 0.0),
        ("answers = list(open('bundle.zip'))", 0.0),
        ("import os\nos.mkdir('bundle')\nopen('bundle/json.py', 'w').write('1/0')\nanswers = [6.28]", 0.5),
    ],
)
def test_the_template_of_coderunner(tmp_path: Path, bundle: Path, program: str, fraction: float) -> None:
    found = coderunner(tmp_path, bundle, program)
    assert found["fraction"] == fraction
    header, *rows = found["testresults"]
    assert header == ["Figure", "Got", "Feedback", "iscorrect"]
    assert [row[0] for row in rows] == ["/period", "/body_rate"]
    assert ("Traceback" in found["prologuehtml"]) == ("raise" in program or "bundle.zip" in program)
