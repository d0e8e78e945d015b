"""Who may import whom, read from the source of every file; docs/architecture.md says why."""

from __future__ import annotations

import ast
import re
from functools import cache
from pathlib import Path

import pytest

ROOT = Path(__file__).parent.parent
CORE = sorted((ROOT / "core").rglob("*.py"))
SERVICE = sorted((ROOT / "service").rglob("*.py"))

LEDGER: dict[str, set[str]] = {
    "errors": set(),
    "compiled": set(),
    "balls": set(),
    "notices": {"errors"},
    "quantities": {"errors"},
    "rows": {"quantities", "errors"},
    "double_double": {"compiled"},
    "decimal_rows": {"double_double", "compiled"},
    "elliptic": {"double_double", "compiled", "errors"},
    "bodies": {"double_double", "compiled", "rows", "quantities", "notices", "errors"},
    "integration": {"double_double", "compiled", "quantities", "notices", "errors"},
}
LEDGER["rotation"] = {"integration", "bodies", "elliptic"} | LEDGER["bodies"] | LEDGER["elliptic"]
LEDGER["scenes"] = {"integration", "elliptic", "balls"} | LEDGER["integration"] | LEDGER["elliptic"]
LEDGER["multibody"] = {"bodies", "balls"} | LEDGER["bodies"]
LEDGER["certified"] = {"rotation", "scenes"} | LEDGER["rotation"] | LEDGER["scenes"]
"""What each room of core may import beside itself; a file that is not named here may import all of core."""

WEB = {"fastapi", "starlette", "pydantic", "pydantic_core", "pydantic_settings", "uvicorn", "httpx", "orjson",
       "prometheus_client", "service"}  # fmt: skip
OUTER = ("work_precision",)
"""Files directly in core that compare what the rooms do, and may therefore see all of it."""

SERVICE_LAYERS = (
    {"__init__"},
    {
        "settings",
        "problems",
        "logs",
        "metrics",
        "writing",
        "routing",
        "client",
        "figures",
        "rounding",
        "pricing",
        "archive",
        "keys",
        "cors",
        "descriptions",
        "representation",
        "kept",
        "records",
        "aside",
        "processes",
        "scratch",
    },
    {"guards", "large_arrays", "ellipsoid_figure"},
    {"faults"},
    {"reading"},
    {"schemas"},
    {"numerals"},
    {"routes", "answering", "composing", "documentation"},
    {"worker", "prepared"},
    {"compute"},
    {"exchange", "heads"},
    {"rounds"},
    {"dispatch"},
    {"app"},
    {"orderly_http"},
    {"server", "protocol", "running", "__main__"},
)
"""The service's files from the ground upwards; each imports from its own storey or from below."""


def imports(path: Path) -> set[str]:
    found = set()
    for node in ast.walk(ast.parse(path.read_text())):
        if isinstance(node, ast.Import):
            found |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom) and node.module:
            assert node.level == 0, f"{path}: imports are absolute"
            found |= {node.module} | {f"{node.module}.{alias.name}" for alias in node.names}
    return found


def name(path: Path) -> str:
    return str(path.relative_to(ROOT))


def room(path: Path, top: str) -> str:
    return path.relative_to(ROOT / top).parts[0].removesuffix(".py")


@pytest.mark.parametrize("path", CORE, ids=name)
def test_core_knows_nothing_of_the_web(path: Path) -> None:
    assert not {entry.split(".")[0] for entry in imports(path)} & WEB


@pytest.mark.parametrize("path", CORE, ids=name)
def test_core_imports_downwards(path: Path) -> None:
    own = room(path, "core")
    seen = {entry.split(".")[1] for entry in imports(path) if entry.startswith("core.")} - {own}
    if own in LEDGER:
        assert seen <= LEDGER[own]
    else:
        assert own in (*OUTER, "__init__"), f"core/{own} has no line in the ledger of imports"


@pytest.mark.parametrize("path", CORE, ids=name)
def test_core_neither_prints_nor_reads_the_environment_nor_logs(path: Path) -> None:
    for node in ast.walk(ast.parse(path.read_text())):
        if isinstance(node, ast.Call) and isinstance(node.func, ast.Name):
            assert node.func.id not in ("print", "input", "breakpoint")
        if isinstance(node, ast.Attribute) and isinstance(node.value, ast.Name):
            assert (node.value.id, node.attr) not in {("os", "environ"), ("os", "getenv"), ("sys", "stdout")}
    assert not {"logging", "argparse", "dotenv"} & imports(path)


@cache
def storey(own: str) -> int:
    return next(i for i, layer in enumerate(SERVICE_LAYERS) if own in layer)


@pytest.mark.parametrize("path", SERVICE, ids=name)
def test_service_imports_downwards(path: Path) -> None:
    own = room(path, "service")
    for entry in imports(path):
        if entry.startswith("service."):
            other = entry.split(".")[1]
            if (ROOT / "service" / f"{other}.py").exists() or other == "routes":
                assert storey(other) <= storey(own), f"{own} imports {other}"


@pytest.mark.parametrize("path", SERVICE, ids=name)
def test_the_service_has_no_mechanics(path: Path) -> None:
    """Routes call core; they use no mathematics of their own."""
    assert not {"scipy", "numba", "mpmath", "flint"} & {entry.split(".")[0] for entry in imports(path)}


@pytest.mark.parametrize("path", CORE + SERVICE, ids=name)
def test_no_module_level_state_is_changed(path: Path) -> None:
    for node in ast.walk(ast.parse(path.read_text())):
        assert not isinstance(node, ast.Global), "no global mutable state"


@pytest.mark.parametrize("path", CORE + SERVICE, ids=name)
def test_modules_are_named_by_content_and_are_readable_in_one_sitting(path: Path) -> None:
    assert path.stem not in ("utils", "util", "helpers", "helper", "common", "models", "misc", "base", "types")
    assert len(path.read_text().splitlines()) <= 700


@pytest.mark.parametrize("path", CORE + SERVICE, ids=name)
def test_every_module_says_what_it_is(path: Path) -> None:
    text = ast.get_docstring(ast.parse(path.read_text()))
    assert text or path.name == "__init__.py"


def test_the_page_about_the_house_names_every_room_and_what_it_may_import() -> None:
    page = (ROOT / "docs" / "architecture.md").read_text()
    told = dict(re.findall(r"^\| `core/(\w+)(?:\.py|/)` \|.*\| (.*) \|$", page, re.MULTILINE))
    assert set(told) == {room(path, "core") for path in CORE} - {"__init__"}
    for own, cell in told.items():
        if own in OUTER:
            assert cell == "all of core"
        else:
            direct = set() if cell == "nothing" else set(cell.split(", "))
            assert direct.union(*(LEDGER[other] for other in direct)) == LEDGER[own], own


PROVED_THROUGH = {
    "core/compiled.py": "core/test_double_double.py",
    "core/bodies/uniform.py": "core/bodies/test_solids.py",
    "core/certified/scene_samples.py": "core/certified/test_scenes.py",
    "core/integration/budget.py": "core/integration/methods/test_fixed_step.py",
    "core/integration/methods/closed_form.py": "core/integration/test_solve.py",
    "core/integration/methods/lsoda.py": "core/integration/methods/test_from_scipy.py",
    "core/integration/methods/method.py": "contracts/test_methods.py",
    "core/integration/methods/radau.py": "core/integration/methods/test_from_scipy.py",
    "core/integration/system.py": "core/integration/test_solve.py",
    "core/integration/trajectory.py": "core/integration/test_solve.py",
    "core/rotation/absence.py": "core/rotation/test_precession.py",
    "core/rotation/attitude_frame.py": "core/rotation/test_attitude.py",
    "core/rotation/moves.py": "core/rotation/test_inherited.py",
    "core/rotation/sensitivity.py": "core/rotation/test_inherited.py",
    "core/scenes/chain_motion.py": "core/scenes/test_chain_on_wedge.py",
    "core/scenes/rod_motion.py": "core/scenes/test_rod_in_hole.py",
    "core/scenes/string_phases.py": "core/scenes/test_unwinding_shafts.py",
    "core/scenes/string_samples.py": "core/scenes/test_unwinding_shafts.py",
}
PROVED_THROUGH |= {
    f"core/multibody/{name}.py": f"core/multibody/test_{through}.py"
    for through, names in {
        "description": "coordinates inertia laws measures rolling strings",
        "language": "reading",
        "numerical": "packed periods returns series series_pairs vertical_symmetry",
        "solve": "answer columns dynamics events motion uniform whole",
    }.items()
    for name in names.split()
}
"""Modules of core without a test file of their own name, and the one that proves them through what they serve."""


@pytest.mark.parametrize("path", [path for path in CORE if path.name != "__init__.py"], ids=name)
def test_tests_mirror_the_code(path: Path) -> None:
    own = ROOT / "tests" / path.parent.relative_to(ROOT) / f"test_{path.name}"
    through = PROVED_THROUGH.get(name(path))
    assert own.exists() != (through is not None), f"{name(path)} has {'two' if through else 'no'} places for its tests"
    assert through is None or (ROOT / "tests" / through).exists()


def test_no_test_is_said_to_prove_what_there_is_not() -> None:
    assert set(PROVED_THROUGH) <= {name(path) for path in CORE}
