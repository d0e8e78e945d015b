"""The import rules of docs/architecture.md, checked in the source of every file."""

from __future__ import annotations

import ast
import re
from collections.abc import Callable, Iterable
from functools import cache
from pathlib import Path

ROOT = Path(__file__).parent.parent
CORE = sorted((ROOT / "core").rglob("*.py"))
SERVICE = sorted((ROOT / "service").rglob("*.py"))

ALLOWED: dict[str, set[str]] = {
    "errors": set(),
    "arrays": set(),
    "lanes": {"arrays"},
    "compiled": {"lanes", "arrays"},
    "balls": set(),
    "near_names": set(),
    "notices": {"errors"},
    "quantities": {"errors"},
    "formulas": {"errors", "near_names"},
    "formulas_in_doubles": {"formulas", "errors", "near_names"},
    "work": set(),
    "rows": {"quantities", "errors", "work"},
    "double_double": {"compiled", "lanes", "arrays"},
    "double_double_functions": {"double_double", "compiled", "lanes", "arrays"},
    "elliptic": {"double_double", "balls", "compiled", "lanes", "errors", "arrays"},
    "digits": {"balls", "errors", "work"},
    "bodies": {"double_double", "rows", "notices", "digits", "balls", "errors", "work"}
    | {"quantities", "compiled", "lanes", "arrays"},
    "systems": {"double_double", "compiled", "lanes", "arrays", "quantities", "notices", "errors", "work"},
}
ALLOWED["rotation"] = {"systems", "bodies", "elliptic"} | ALLOWED["bodies"] | ALLOWED["elliptic"]
ALLOWED["scenes"] = {"systems", "elliptic"} | ALLOWED["systems"] | ALLOWED["elliptic"]
ALLOWED["certified"] = {"rotation", "scenes"} | ALLOWED["rotation"] | ALLOWED["scenes"]
ALLOWED["multibody"] = (
    {"rotation", "scenes", "formulas", "near_names", "double_double_functions"}
    | ALLOWED["rotation"]
    | ALLOWED["scenes"]
)
ALLOWED["interchange"] = {"multibody", "formulas_in_doubles"} | ALLOWED["multibody"]
"""What each package or module of core may import besides itself. Those in OUTER may import all of core."""

WEB = {"fastapi", "starlette", "pydantic", "pydantic_core", "pydantic_settings", "uvicorn", "httpx", "orjson",
       "prometheus_client", "service"}  # fmt: skip
OUTER = ("assessment", "find", "fits", "sensitivities", "studies", "work_precision")
"""Modules that compare results across packages, and may therefore import all of core."""

SERVICE_LAYERS = (
    {"__init__"},
    {"settings", "problems", "problem_types", "routing", "observability", "responses"},
    {"schemas", "requests"},
    {"execution", "http"},
    {"routes", "openapi"},
    {"studies"},
    {"app"},
    {"broken_pipe", "server", "running", "__main__", "command"},
)
"""The packages and modules of the service in layers, lowest first; each imports from its own layer or a lower one."""


MULTIBODY_LAYERS = (
    {"__init__", "algebra", "undecided", "model_answer", "equations_answer"},
    {"language", "answer"},
    {"laws"},
    {"table", "audit"},
    {"equations"},
    {"reduction", "assembly"},
    {"contacts", "motion"},
    {"search"},
    {"trajectory", "statics", "start"},
    {"formulation"},
    {"phases"},
    {"parts"},
    {"proven"},
    {"solve", "members"},
)
"""The packages and modules of core.multibody in layers, lowest first; each imports from itself or from a lower one."""


@cache
def tree(path: Path) -> ast.Module:
    return ast.parse(path.read_text())


@cache
def nodes(path: Path) -> tuple[ast.AST, ...]:
    return tuple(ast.walk(tree(path)))


@cache
def imports(path: Path) -> frozenset[str]:
    found: set[str] = set()
    for node in nodes(path):
        if isinstance(node, ast.Import):
            found |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom) and node.module:
            assert node.level == 0, f"{path}: imports are absolute"
            found |= {node.module} | {f"{node.module}.{alias.name}" for alias in node.names}
    return frozenset(found)


def name(path: Path) -> str:
    return str(path.relative_to(ROOT))


def package(path: Path, top: str) -> str:
    return path.relative_to(ROOT / top).parts[0].removesuffix(".py")


def for_each(files: Iterable[Path]) -> Callable[[Callable[[Path], None]], Callable[[], None]]:
    """Return what makes one test of a rule for files: a test for each file would be a quarter of all tests."""

    def test_of(rule: Callable[[Path], None]) -> Callable[[], None]:
        def test() -> None:
            broken = []
            for path in files:
                try:
                    rule(path)
                except AssertionError as error:
                    broken.append(f"{name(path)}: {error}")
            assert not broken, "\n".join(broken)

        test.__doc__ = rule.__doc__
        return test

    return test_of


@for_each(CORE)
def test_core_imports_no_web_package(path: Path) -> None:
    assert not {entry.split(".")[0] for entry in imports(path)} & WEB


@for_each(CORE)
def test_core_imports_downwards(path: Path) -> None:
    own = package(path, "core")
    seen = {entry.split(".")[1] for entry in imports(path) if entry.startswith("core.")} - {own}
    if own in ALLOWED:
        assert seen <= ALLOWED[own]
    else:
        assert own in (*OUTER, "__init__"), f"core/{own} is missing from ALLOWED"


@for_each(CORE)
def test_core_neither_prints_nor_reads_the_environment_nor_logs(path: Path) -> None:
    for node in nodes(path):
        if isinstance(node, ast.Call) and isinstance(node.func, ast.Name):
            assert node.func.id not in ("print", "input", "breakpoint")
        if isinstance(node, ast.Attribute) and isinstance(node.value, ast.Name):
            assert (node.value.id, node.attr) not in {("os", "environ"), ("os", "getenv"), ("sys", "stdout")}
    assert not {"logging", "argparse", "dotenv"} & imports(path)


@cache
def layer(own: str) -> int:
    return next(i for i, members in enumerate(SERVICE_LAYERS) if own in members)


@for_each(SERVICE)
def test_service_imports_downwards(path: Path) -> None:
    own = package(path, "service")
    for entry in imports(path):
        if entry.startswith("service."):
            other = entry.split(".")[1]
            if (ROOT / "service" / f"{other}.py").exists() or (ROOT / "service" / other).is_dir():
                assert layer(other) <= layer(own), f"{own} imports {other}"


@for_each(sorted((ROOT / "core" / "multibody").rglob("*.py")))
def test_multibody_imports_downwards(path: Path) -> None:
    height = {member: level for level, members in enumerate(MULTIBODY_LAYERS) for member in members}
    own = package(path, "core/multibody")
    for entry in imports(path):
        if entry.startswith("core.multibody."):
            other = entry.split(".")[2]
            assert other == own or height[other] < height[own], f"{own} imports {other}"


@for_each(sorted((ROOT / "core" / "multibody" / "audit").rglob("*.py")))
def test_the_audit_shares_nothing_with_what_it_checks(path: Path) -> None:
    """It reads the description and the answer, and knows none of the equations that the answer comes from."""
    seen = {entry for entry in imports(path) if entry.startswith("core.")}
    allowed = (
        "core.errors",
        "core.formulas",
        "core.multibody.audit",
        "core.multibody.language",
        "core.multibody.answer",
        "core.systems.trajectory",
    )
    assert all(entry.startswith(allowed) for entry in seen)
    assert not {"scipy", "numba", "flint"} & {entry.split(".")[0] for entry in imports(path)}


@for_each(SERVICE)
def test_the_service_has_no_mechanics(path: Path) -> None:
    """Routes call core; they use no mathematics of their own."""
    assert not {"scipy", "numba", "mpmath", "flint"} & {entry.split(".")[0] for entry in imports(path)}


@for_each(CORE)
def test_scipy_is_optional(path: Path) -> None:
    """Its solvers are methods that a question may name (`systems/methods/from_scipy.py`); all else does without."""
    assert "scipy" not in {entry.split(".")[0] for entry in imports(path)}


@for_each(CORE + SERVICE)
def test_no_function_assigns_a_global(path: Path) -> None:
    for node in nodes(path):
        assert not isinstance(node, ast.Global), "no global mutable state"


@for_each(CORE + SERVICE)
def test_modules_are_named_by_content_and_are_of_limited_length(path: Path) -> None:
    assert path.stem not in ("utils", "util", "helpers", "helper", "common", "models", "misc", "base", "types")
    assert len(path.read_text().splitlines()) <= 700


@for_each(CORE + SERVICE)
def test_every_module_has_a_docstring(path: Path) -> None:
    text = ast.get_docstring(tree(path))
    assert text or path.name == "__init__.py"


def test_the_architecture_page_lists_every_package_and_its_imports() -> None:
    page = (ROOT / "docs" / "architecture.md").read_text()
    listed = dict(re.findall(r"^\| `core/(\w+)(?:\.py|/)` \|.*\| (.*) \|$", page, re.MULTILINE))
    assert set(listed) == {package(path, "core") for path in CORE} - {"__init__"}
    for own, cell in listed.items():
        if own in OUTER:
            assert cell == "all of core"
        else:
            direct = set() if cell == "nothing" else set(cell.split(", "))
            assert direct.union(*(ALLOWED[other] for other in direct)) == ALLOWED[own], own


TESTED_IN = {
    "core/bodies/pinned.py": "core/rotation/test_torque_free.py",
    "core/assessment/judged_claims.py": "core/assessment/test_grader.py",
    "core/assessment/question_source.py": "core/assessment/test_graded_question.py",
    "core/assessment/stated_bounds.py": "core/assessment/test_graded_question.py",
    "core/assessment/results.py": "core/assessment/test_answer_key.py",
    "core/bodies/uniform.py": "core/bodies/test_solids.py",
    "core/systems/budget.py": "core/systems/methods/test_fixed_step.py",
    "core/systems/methods/closed_form.py": "core/systems/test_solve.py",
    "core/systems/methods/lsoda.py": "core/systems/methods/test_from_scipy.py",
    "core/systems/methods/method.py": "contracts/test_methods.py",
    "core/systems/methods/radau.py": "core/systems/methods/test_from_scipy.py",
    "core/systems/question.py": "core/systems/test_solve.py",
    "core/systems/state_motion.py": "core/systems/test_solve.py",
    "core/systems/system.py": "core/systems/test_solve.py",
    "core/systems/trajectory.py": "core/systems/test_solve.py",
    "core/rotation/precession/missing_reasons.py": "core/rotation/precession/test_precession.py",
    "core/rotation/attitude/frame.py": "core/rotation/attitude/test_free_attitude.py",
    "core/rotation/uncertainty/sensitivities.py": "core/rotation/uncertainty/test_input_uncertainty.py",
    "core/rotation/closed_form/condition_bounds.py": "core/rotation/uncertainty/test_input_uncertainty.py",
    "core/rotation/closed_form/underflow.py": "extremes/test_rotation.py",
    "core/rotation/stability/errors.py": "core/rotation/stability/test_stability.py",
    "core/rotation/regimes.py": "core/rotation/test_free_rotation.py",
    "core/scenes/chain_motion.py": "core/scenes/test_chain_on_wedge.py",
    "core/scenes/equation.py": "core/scenes/test_sampled_motion.py",
    "core/scenes/figures.py": "core/scenes/test_named_scene.py",
    "core/scenes/motion.py": "core/scenes/test_named_scene.py",
    "core/scenes/pendulum_in_balls.py": "core/certified/test_scenes.py",
    "core/scenes/rod_motion.py": "core/scenes/test_rod_in_hole.py",
    "core/scenes/shaft_figures.py": "core/scenes/test_unwinding_shafts.py",
    "core/scenes/string_phases.py": "core/scenes/test_unwinding_shafts.py",
    "core/scenes/string_samples.py": "core/scenes/test_unwinding_shafts.py",
}
TESTED_IN |= {
    f"core/assessment/feedback/{name}.py": "core/assessment/feedback/test_languages.py"
    for name in ("english", "french", "german", "spanish")
}
TESTED_IN |= {
    f"core/fits/{name}.py": "core/fits/test_fit.py"
    for name in ("comparison", "computed", "model", "problem", "search", "statistics", "wording")
}
TESTED_IN["core/multibody/reduction/least_places.py"] = "core/multibody/phases/test_passing_touch.py"
TESTED_IN["core/formulas_in_doubles.py"] = "core/test_formulas.py"
TESTED_IN["core/fits/unknowns.py"] = "service/test_fits.py"
TESTED_IN["core/assessment/typed_number.py"] = "core/assessment/test_typed_entry.py"
TESTED_IN["core/assessment/typed_signs.py"] = "core/assessment/test_typed_entry.py"
TESTED_IN["core/assessment/feedback/entry_fault.py"] = "core/assessment/test_typed_entry.py"
TESTED_IN |= {
    f"core/find/{name}.py": "core/find/test_search.py"
    for name in (
        *("borders", "evaluations", "extremes", "figures", "infinite", "minima"),
        *("known_roots", "roots", "scanning", "solutions", "systems", "varied"),
    )
}
TESTED_IN |= {
    f"core/interchange/{name}.py": f"core/interchange/{through}.py"
    for through, names in {
        "test_export_mjcf": "mjcf_geometries mjcf_tree start_in_numbers",
        "test_import_model": "draft left_out plane_scene_writing scene_of_draft scene_writing",
        "test_urdf": "inertia",
        "test_mjcf": "mjcf_attributes mjcf_elements mjcf_geometry mjcf_joints",
    }.items()
    for name in names.split()
}
TESTED_IN["core/assessment/carried.py"] = "core/assessment/test_grader.py"
TESTED_IN["core/assessment/terms.py"] = "core/assessment/test_grader.py"
TESTED_IN["core/assessment/gradable.py"] = "core/assessment/test_grader.py"
TESTED_IN["core/assessment/sample_findings.py"] = "core/assessment/test_samples.py"
TESTED_IN |= {
    f"core/assessment/catalogue/{name}.py": "contracts/test_mistakes.py"
    for name in ("bodies", "general", "rotation", "scenes")
}
TESTED_IN |= {
    f"core/multibody/{name}.py": f"core/multibody/{through}.py"
    for through, names in {
        "contacts/test_impacts": "contacts/impulses phases/accumulation",
        "audit/test_audit": (
            "audit/balanced audit/chosen_times audit/energy audit/failure audit/laws_at_samples audit/repetition "
            "audit/samples audit/start"
        ),
        "audit/test_definitions": (
            "audit/between_places audit/bodies audit/coefficients audit/contact_definitions audit/contacts "
            "audit/chains audit/definition audit/guides "
            "audit/definition_of audit/joint_definitions audit/joints audit/law_definitions audit/laws "
            "audit/newton audit/placement audit/rolling audit/string_definitions audit/string_runs audit/strings "
            "audit/surfaces"
        ),
        "assembly/test_assembled_scene": (
            "assembly/described_bodies assembly/exact_places assembly/metric assembly/misfit assembly/nearest_places "
            "assembly/nearest_that_fits assembly/nearest_velocities assembly/quadratics"
        ),
        "laws/test_formula_forces": (
            "audit/formula_definitions audit/formula_forces audit/formulas language/motion_formulas laws/kernel "
            "laws/law laws/linear laws/samples laws/series laws/tape table/formula_laws"
        ),
        "formulation/test_scene_equations": (
            "equations_answer formulation/body_angles formulation/chart formulation/circles "
            "formulation/closed_forms formulation/constants "
            "formulation/euler formulation/conserved formulation/constraint_forces "
            "formulation/formula_nodes formulation/lagrange formulation/law_forces formulation/linear_equations "
            "formulation/sides formulation/symbols"
        ),
        "formulation/notation/test_notations": "formulation/notation/latex formulation/notation/mathml "
        "formulation/notation/modelica "
        "formulation/notation/names formulation/notation/plain",
        "table/test_formulas_of_time": "audit/driven table/moving_places",
        "table/test_joints_of_space": "audit/joints_of_space",
        "table/test_curves": "audit/curves",
        "table/test_turns_in_space": "audit/turns_in_space",
        "laws/test_formulas_of_pieces": (
            "equations/starting_pieces laws/corners language/switches phases/formula_ends table/law_pieces"
        ),
        "table/test_description": (
            "table/connection_effects table/coordinates "
            "table/frames table/joints table/measures table/rolling table/rows "
            "table/spatial_orientation"
        ),
        "trajectory/test_columns": "trajectory/column_errors",
        "members/test_follow": (
            "members/lane_doubles members/lane_pairs members/lane_series members/lane_space members/lane_table "
            "members/many members/member_columns members/plan"
        ),
        "members/test_recorded_balls": "algebra/recordable algebra/square_systems",
        "language/test_scene": (
            "language/body language/connection language/contacts language/forces language/joints language/reading "
            "language/strings"
        ),
        "reduction/test_passes": "reduction/pinning reduction/reduction",
        "trajectory/test_occurrences": "trajectory/search_along",
        "contacts/test_complementarity": (
            "contacts/conditions_of_states contacts/contact_forces contacts/contact_responses contacts/contact_states"
        ),
        "contacts/test_certificates": "contacts/admissible_forces",
        "contacts/test_shares_in_space": "phases/shared_friction",
        "phases/test_recurring_bounces": "phases/shared_impulses",
        "table/test_contact_geometry": (
            "contacts/contact_start contacts/projection equations/expansion equations/polynomial_roots "
            "phases/phase phases/phases "
            "phases/slow_bounces phases/tracks phases/watches start "
            "table/contact_places"
        ),
        "table/test_supports": "table/rolling_on_planes",
        "table/test_level_rims": "audit/level_rims phases/level_phases",
        "table/test_ball_on_box": "audit/ball_on_box",
        "table/test_strings": "table/string_measures",
        "phases/test_turning_slip": "equations/onsets_of_slip motion/turning_friction phases/turning_pieces",
        "statics/test_exact_places": "statics/places_beside statics/small_motions",
        "test_stated_errors": "algebra/doubles",
        "statics/test_equilibria": "statics/equilibrium_search statics/resting_places statics/static_equations",
        "motion/test_free_body": "motion/turning_body",
        "search/test_first_zero": (
            "search/bands search/batch search/curves search/first_of_motion search/followed search/location "
            "search/pieces search/taylor"
        ),
        "phases/test_sums": "phases/stretches",
        "phases/test_changed_connections": (
            "audit/blows audit/occasions audit/stages contacts/impulsive_rates language/occasions phases/schedule "
            "table/blows table/timed"
        ),
        "proven/test_proven_answer": "proven/part_proof",
        "parts/test_joined_answer": (
            "parts/common_span parts/joined_model parts/joined_phases parts/joined_trajectory parts/searched_parts"
        ),
        "motion/test_numerical": (
            "equations/packed motion/products motion/returns motion/run motion/series motion/series_pairs"
            " motion/series_run"
            " motion/step_sizes motion/vertical_symmetry"
        ),
        "motion/test_stiff": (
            "algebra/complex_systems motion/collocated motion/collocation motion/dissipative motion/linearised"
            " motion/radau motion/stages"
        ),
        "equations/test_saddle": "algebra/square_inverse equations/schur_complement",
        "phases/test_phase_answer": "phases/phase_states phases/phase_columns",
        "phases/test_described_system": "phases/method_samples phases/smooth_motion trajectory/scene_request",
        "test_solve": ("answer model_answer motion/motion motion/uniform motion/whole trajectory/events"),
    }.items()
    for name in names.split()
}
"""Modules of core without a test file of the same name, and the file that tests them through their callers."""


def defines_something(path: Path) -> bool:
    return any(isinstance(node, ast.FunctionDef | ast.ClassDef) for node in nodes(path))


@for_each([path for path in CORE if path.name != "__init__.py"])
def test_tests_mirror_the_code(path: Path) -> None:
    if not defines_something(path):
        return
    own = ROOT / "tests" / path.parent.relative_to(ROOT) / f"test_{path.name}"
    through = TESTED_IN.get(name(path))
    assert own.exists() != (through is not None), f"{name(path)} is tested in {'two files' if through else 'no file'}"
    assert through is None or (ROOT / "tests" / through).exists()


def test_exceptions_name_existing_modules() -> None:
    assert set(TESTED_IN) <= {name(path) for path in CORE}
