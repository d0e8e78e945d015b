"""Mutants: small changes of the code of core, each of which a test has to notice.

Run: python -m tests.mutation [number of mutants] [seed] [module or folder ...].

A mutant changes one comparison, operator, number, condition or name in one function. It takes the place of the function
in a child of this process, where core and its kernels are loaded, and the child runs tests: those of the module, those
that import it, and those of whole scenes. Compiled functions are left out, as each would be compiled anew. What no test
notices is printed as the statement before and after.
"""

from __future__ import annotations

import ast
import gc
import importlib
import os
import random
import resource
import sys
import time
from collections.abc import Callable, Iterator, Sequence
from itertools import islice
from pathlib import Path
from types import CodeType, FunctionType
from typing import NamedTuple

import pytest

from tests.test_architecture import TESTED_IN

ROOT = Path(__file__).parent.parent

ENGINE = ("contacts", "language", "motion", "parts", "phases", "reduction", "search", "statics", "trajectory")
PLACES = [*(f"core/multibody/{name}" for name in ENGINE), "core/multibody/solve.py", "core/multibody/start.py"]
"""What is changed by default: the engine of described scenes, its tables, kernels and audit apart."""

OF_SCENES = """
test_redundant test_undecided test_stated_errors phases/test_searches test_event_times parts/test_joined_answer
statics/test_thresholds test_solve phases/test_phase_answer phases/test_sums phases/test_coincident_events
test_against_named_scenes relations/test_relations test_contact_scenes
"""
"""Tests of whole scenes, which run after those of the module, the quickest first."""

LONGEST = 300
"""Processor time (s) after which a child is ended: three times what the longest tests take."""

SWAPPED: dict[type[ast.AST], type[ast.AST]] = {
    ast.Lt: ast.LtE, ast.LtE: ast.Lt, ast.Gt: ast.GtE, ast.GtE: ast.Gt, ast.Eq: ast.NotEq, ast.NotEq: ast.Eq,
    ast.In: ast.NotIn, ast.NotIn: ast.In, ast.Is: ast.IsNot, ast.IsNot: ast.Is, ast.And: ast.Or, ast.Or: ast.And,
    ast.Add: ast.Sub, ast.Sub: ast.Add, ast.Mult: ast.Div, ast.Div: ast.Mult,
}  # fmt: skip
TURNED: dict[type[ast.AST], type[ast.AST]] = {ast.Lt: ast.Gt, ast.Gt: ast.Lt, ast.LtE: ast.GtE, ast.GtE: ast.LtE}
RENAMED = {"min": "max", "max": "min", "any": "all", "all": "any", "argmin": "argmax", "argmax": "argmin"}

Change = Callable[[], None]


class Site(NamedTuple):
    """A place in a syntax tree, and what changes the tree there."""

    function: ast.FunctionDef
    statement: ast.stmt
    change: Change


class Mutant(NamedTuple):
    """A change of a function, and its code with it."""

    path: str
    line: int
    before: str
    after: str
    code: CodeType


def sites(tree: ast.Module) -> Iterator[Site]:
    """Yield every place of a module that can be changed."""
    for outer in tree.body:
        for function in outer.body if isinstance(outer, ast.ClassDef) else [outer]:
            if not isinstance(function, ast.FunctionDef) or _is_compiled(function):
                continue
            for statement in ast.walk(function):
                if isinstance(statement, ast.stmt) and not isinstance(statement, ast.Raise | ast.Assert):
                    for node in _own(statement):
                        yield from (Site(function, statement, change) for change in _changes(node))


def _is_compiled(function: ast.FunctionDef) -> bool:
    return any(ast.unparse(one).startswith(("kernel", "entry")) for one in function.decorator_list)


def _own(statement: ast.stmt) -> Iterator[ast.AST]:
    """Yield the nodes of a statement that are in no statement, text or annotation within it."""
    left: list[ast.AST] = [] if isinstance(statement, ast.FunctionDef | ast.ClassDef) else [statement]
    while left:
        node = left.pop()
        yield node
        for name, value in ast.iter_fields(node):
            if name != "annotation":
                inner = value if isinstance(value, list) else [value]
                left += [
                    one for one in inner if isinstance(one, ast.AST) and not isinstance(one, ast.stmt | ast.JoinedStr)
                ]


def _changes(node: ast.AST) -> Iterator[Change]:
    """Yield what changes a node."""

    def put(name: str, value: object) -> Change:
        return lambda: setattr(node, name, value)

    if isinstance(node, ast.Compare) and len(node.ops) == 1:
        for table in (SWAPPED, TURNED):
            if type(node.ops[0]) in table:
                yield put("ops", [table[type(node.ops[0])]()])
    elif isinstance(node, ast.BinOp | ast.BoolOp) and type(node.op) in SWAPPED:
        yield put("op", SWAPPED[type(node.op)]())
    elif isinstance(node, ast.Constant) and isinstance(node.value, bool):
        yield put("value", not node.value)
    elif isinstance(node, ast.Constant) and isinstance(node.value, int | float):
        yield put("value", node.value + 1)
    elif isinstance(node, ast.Name) and node.id in RENAMED:
        yield put("id", RENAMED[node.id])
    elif isinstance(node, ast.Attribute) and node.attr in RENAMED:
        yield put("attr", RENAMED[node.attr])
    elif isinstance(node, ast.If | ast.IfExp):
        yield put("test", ast.copy_location(ast.UnaryOp(ast.Not(), node.test), node.test))


def mutant(path: str, number: int) -> Mutant:
    """Return a mutant of a module by its number."""
    tree = ast.parse((ROOT / path).read_text(encoding="utf-8"))
    site = next(islice(sites(tree), number, None))
    before = ast.unparse(site.statement).splitlines()
    site.change()
    after = ast.unparse(site.statement).splitlines()
    changed = next(k for k, (old, new) in enumerate(zip(before, after, strict=True)) if old != new)
    code = compile(ast.fix_missing_locations(tree), str(ROOT / path), "exec")
    own = next(one for one in _codes(code) if (one.co_name, one.co_firstlineno) == _place(site.function))
    return Mutant(path, site.statement.lineno, before[changed].strip(), after[changed].strip(), own)


def _place(function: ast.FunctionDef) -> tuple[str, int]:
    return function.name, min([function.lineno, *(one.lineno for one in function.decorator_list)])


def _codes(code: CodeType) -> Iterator[CodeType]:
    for one in code.co_consts:
        if isinstance(one, CodeType):
            yield one
            yield from _codes(one)


def put_in_place(code: CodeType) -> int:
    """Give its code to the function that it was made from, and return how many such functions there are."""
    found = [
        one
        for one in gc.get_objects()
        if isinstance(one, FunctionType)
        and (one.__code__.co_filename, one.__code__.co_firstlineno, one.__name__)
        == (code.co_filename, code.co_firstlineno, code.co_name)
    ]
    for function in found:
        function.__code__ = code
    return len(found)


def tests_of(path: str) -> list[str]:
    """Return the tests that have to notice a change of a module, the most likely first."""
    own = path.removeprefix("core/multibody/")
    folder, _, name = own.rpartition("/")
    mirrored = f"tests/core/multibody/{folder}/test_{name}".replace("//", "/")
    known = [f"tests/{TESTED_IN[path]}"] if path in TESTED_IN else [mirrored]
    imported = path.removesuffix(".py").replace("/", ".")
    importing = [
        str(file.relative_to(ROOT))
        for file in sorted((ROOT / "tests/core/multibody").rglob("test_*.py"))
        if f"from {imported} import" in file.read_text(encoding="utf-8")
    ]
    return list(dict.fromkeys([*known, *importing, *_files_of_scenes()]))


def _files_of_scenes() -> list[str]:
    return [f"tests/core/multibody/{name}.py" for name in OF_SCENES.split()]


def noticed(one: Mutant, seconds: int = LONGEST) -> str:
    """Return by what a mutant is noticed, the empty string if by nothing."""
    reading, writing = os.pipe()
    child = os.fork()
    if not child:
        resource.setrlimit(resource.RLIMIT_CPU, (seconds, seconds))
        os.dup2(os.open(os.devnull, os.O_WRONLY), 1)
        os.dup2(1, 2)
        first = _FirstFailure()
        in_place = put_in_place(one.code)
        code = pytest.main(
            ["-q", "-x", "-n0", "--assert=plain", "-p", "no:cacheprovider", *tests_of(one.path)], plugins=[first]
        )
        os.write(
            writing, (first.name or f"pytest: {code}").encode() if code and in_place else b"" if in_place else b"?"
        )
        os._exit(0)
    os.close(writing)
    with os.fdopen(reading) as pipe:
        told = pipe.read()
    _, status = os.waitpid(child, 0)
    return told if os.WIFEXITED(status) and os.WEXITSTATUS(status) == 0 else "processor time"


class _FirstFailure:
    """Holds the name of the first test that fails."""

    name = ""

    def pytest_runtest_logreport(self, report: pytest.TestReport) -> None:
        if report.failed:
            self.name = self.name or report.nodeid


def modules(places: Sequence[str]) -> list[str]:
    """Return the modules at places, without those that hold no code."""
    files = [ROOT / place for place in places]
    found = [inner for one in files for inner in ([one] if one.suffix else sorted(one.rglob("*.py")))]
    return [str(one.relative_to(ROOT)) for one in found if one.name != "__init__.py"]


def main(count: int = 300, seed: int = 1, *places: str) -> int:
    """Try mutants, print those that nothing notices, and return 1 if they are more than a tenth."""
    os.chdir(ROOT)
    paths = modules(places or PLACES)
    drawn = [(path, k) for path in paths for k, _ in enumerate(sites(ast.parse((ROOT / path).read_text())))]
    chosen = random.Random(seed).sample(drawn, min(count, len(drawn)))
    for path in paths:
        importlib.import_module(path.removesuffix(".py").replace("/", "."))
    for file in _files_of_scenes():
        importlib.import_module(file.removesuffix(".py").replace("/", "."))
    survivors = 0
    for number, (path, k) in enumerate(chosen, 1):
        one, begin = mutant(path, k), time.monotonic()
        by = noticed(one)
        survivors += not by
        sys.stdout.write(f"{number} {path}:{one.line} {by or 'SURVIVES'} ({time.monotonic() - begin:.0f} s)\n")
        if not by:
            sys.stdout.write(f"    {one.before}\n    {one.after}\n")
        sys.stdout.flush()
    sys.stdout.write(f"{len(chosen) - survivors} of {len(chosen)} mutants of {len(drawn)} are noticed\n")
    return int(survivors > 0.1 * len(chosen))


if __name__ == "__main__":
    arguments = sys.argv[1:]
    count, seed = [*map(int, arguments[:2]), 300, 1][:2] if len(arguments) != 1 else (int(arguments[0]), 1)
    sys.exit(main(count, seed, *arguments[2:]))
