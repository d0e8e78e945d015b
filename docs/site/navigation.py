"""Which pages the site has, in which order."""

from __future__ import annotations

from pathlib import Path
from typing import Any

ROOT = Path(__file__).parents[2]
DOCS = ROOT / "docs"

PAGES_ELSEWHERE = {
    "README.md": "index.md",
    "CHANGELOG.md": "changelog.md",
    "CONTRIBUTING.md": "contributing.md",
    "clients/python/README.md": "python-client.md",
    "clients/typescript/README.md": "typescript-client.md",
    "clients/lms/prairielearn/README.md": "prairielearn.md",
    "clients/lms/gradescope/README.md": "gradescope.md",
    "clients/lms/moodle/README.md": "moodle.md",
    "clients/lms/lti/README.md": "lti.md",
}
"""Pages outside of docs/, and where they are on the site."""

GENERATED = "reference/endpoints.md", "reference/objects.md", "reference/problems.md", "reference/settings.md"

PHYSICS = (
    "free-rotation free-or-not-free precession stability energy-ellipsoid wobble bodies"
    " rod-in-hole unwinding-shafts chain-on-wedge scenes undecided error-statements audit certified"
)
"""Pages of docs/physics that derive results; the catalogue of scenes is reference."""


def navigation() -> list[Any]:
    """Return the navigation as MkDocs reads it; a page of docs/ that is not named here fails the build."""
    guides = [
        {"See a motion in the browser": "pages.md"},
        {"Describe a scene": "describing-scenes.md"},
        {"Grade homework": "grading.md"},
        {"Grade in PrairieLearn": "prairielearn.md"},
        {"Grade in Gradescope": "gradescope.md"},
        {"Grade in Moodle": "moodle.md"},
        {"Grade in Canvas (LTI)": "lti.md"},
        {"A published solution with mistakes": "homework.md"},
        {"Find the input": "finding.md"},
        {"Fit measured data": "fitting.md"},
        {"Study many variations": "studies.md"},
        {"Read and choose the accuracy": "accuracy.md"},
        {"Compute large trajectories": "large-trajectories.md"},
        {"Use the Python client": "python-client.md"},
        {"Use the TypeScript client": "typescript-client.md"},
        {"Install and deploy the service": "deployment.md"},
    ]
    return [
        {"Home": "index.md"},
        {"Tutorial": "tutorial.md"},
        {"Guides": [entry for entry in guides if _exists(*entry.values())]},
        {
            "Reference": [
                {"Endpoints": GENERATED[0]},
                {"Objects": GENERATED[1]},
                {"Problems": GENERATED[2]},
                {"Settings": GENERATED[3]},
                {"Numbers you can cite": "numbers.md"},
                {"Catalogue of scenes": "physics/scene-catalogue.md"},
                {"Changelog": "changelog.md"},
                {"History of version 1.0.0": "history.md"},
            ]
        },
        {"Physics": [f"physics/{name}.md" for name in PHYSICS.split()]},
        {
            "Explanation": [
                {"Architecture": "architecture.md"},
                {"Speed": "speed.md"},
                {"Comparison with peers": "peers.md"},
                {"Published problems": "references.md"},
                {"The homework behind it": "source-questions.md"},
                {"Contributing": "contributing.md"},
                {"Decisions": [f"decisions/{page.name}" for page in sorted((DOCS / "decisions").glob("*.md"))]},
            ]
        },
    ]


def pages() -> dict[str, Path]:
    """Return the source of every page that is written by hand, by its path on the site."""
    found = {str(page.relative_to(DOCS)): page for page in sorted(DOCS.rglob("*.md"))}
    return found | {target: ROOT / source for source, target in PAGES_ELSEWHERE.items()}


def _exists(path: str) -> bool:
    return path in pages() or path in GENERATED
