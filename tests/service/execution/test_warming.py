"""Ready means that every kernel which a request can reach is compiled."""

from __future__ import annotations

import ast
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[3]
Kernel = tuple[str, str]

OF_NO_REQUEST = {
    ("core.rotation.precession.constants", "angle_per_period"),
}
"""Kernels that Python code calls for users of the library; requests reach them inside of other kernels only."""


def is_kernel(node: ast.AST) -> bool:
    return isinstance(node, ast.FunctionDef) and any(
        isinstance(mark, ast.Call) and isinstance(mark.func, ast.Name) and mark.func.id in ("kernel", "entry")
        for mark in node.decorator_list
    )


def names_outside_kernels(node: ast.AST) -> Iterator[str]:
    for child in ast.iter_child_nodes(node):
        if isinstance(child, ast.Name):
            yield child.id
        if isinstance(child, ast.Attribute) and isinstance(child.value, ast.Name):
            yield f"{child.value.id}.{child.attr}"
        if not is_kernel(child):
            yield from names_outside_kernels(child)


def entry_kernels() -> set[Kernel]:
    """Return the compiled functions that Python code names: all others are compiled with those that call them."""
    trees = {
        ".".join(path.relative_to(ROOT).with_suffix("").parts): ast.parse(path.read_text())
        for path in (ROOT / "core").rglob("*.py")
    }
    kernels = {(module, node.name) for module, tree in trees.items() for node in ast.walk(tree) if is_kernel(node)}  # type: ignore[attr-defined]
    found = set()
    for module, tree in trees.items():
        known = {name: (module, name) for own, name in kernels if own == module}
        for node in ast.walk(tree):
            if isinstance(node, ast.ImportFrom):
                for alias in node.names:
                    called = alias.asname or alias.name
                    known[called] = (node.module or "", alias.name)
                    known |= {
                        f"{called}.{name}": (of, name) for of, name in kernels if of == f"{node.module}.{alias.name}"
                    }
        # What a module makes a kernel of is compiled inside of that.
        made = [node for node in tree.body if isinstance(node, ast.Assign) and isinstance(node.value, ast.Call)]
        tree.body = [node for node in tree.body if node not in made]
        found |= {known[name] for name in names_outside_kernels(tree) if known.get(name) in kernels}
    return found


PROGRAM = """
import gc
from pkgutil import resolve_name
from numba.core.dispatcher import Dispatcher
from core.errors import MechanicsError
from core.systems.budget import Budget
from examples.ask import names, path_of, request_of
from service.execution.request_handler import RequestHandler
from service.requests.request_reader import Limits
from service.routing import TABLE

def show(when):
    for found in gc.get_objects():
        if isinstance(found, Dispatcher):
            for types in found.signatures:
                print(when, found.py_func.__module__, found.py_func.__name__, types)

routes = {route.path: route for route in resolve_name(TABLE)()}
handler = RequestHandler(routes.values(), Budget(), Limits())
handler.warm()
handler.warm_many()
show("warm")
for name in names():
    # A study is answered by the processes of an engine.
    if route := routes.get(path_of(name)):
        try:
            handler.answer(route, handler.read(route, request_of(name)))
        except MechanicsError:
            pass
show("later")
"""


@pytest.fixture(scope="module")
def compiled() -> dict[str, set[tuple[str, ...]]]:
    """What is compiled (module, name, types), in a process of its own, which has called nothing for other tests."""
    done = subprocess.run([sys.executable, "-c", PROGRAM], capture_output=True, text=True, check=True, cwd=ROOT)
    found: dict[str, set[tuple[str, ...]]] = {"warm": set(), "later": set()}
    for when, *kernel in (line.split(" ", 3) for line in done.stdout.splitlines() if line):
        found[when].add(tuple(kernel))
    return found


def test_warming_compiles_every_kernel_that_a_request_can_reach(compiled: dict[str, set[tuple[str, ...]]]) -> None:
    entries = entry_kernels()
    assert len(entries) > 40
    assert entries >= OF_NO_REQUEST
    # Where nothing is cached, what is compiled inside of other kernels counts as compiled.
    assert entries - {kernel[:2] for kernel in compiled["warm"]} <= OF_NO_REQUEST


def test_no_example_has_a_kernel_compiled_for_other_types(compiled: dict[str, set[tuple[str, ...]]]) -> None:
    """A client would wait for that, under load beyond the deadline."""
    ours = {kernel for kernel in compiled["later"] if kernel[0].startswith("core.")}
    assert len(ours) > 40
    assert ours <= compiled["warm"]
