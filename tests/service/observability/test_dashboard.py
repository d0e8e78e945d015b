"""The dashboard and the alert rules name metrics, labels and codes that exist."""

from __future__ import annotations

import json
import re
from collections.abc import Iterator
from pathlib import Path

from service.observability.metrics import Metrics
from service.problem_types import REGISTRY
from tests.service.conftest import ROOT

FOLDER = ROOT / "docs" / "observability"
DASHBOARD, ALERTS = FOLDER / "grafana.json", FOLDER / "alerts.yml"

_NAME = re.compile(r"\bpolhode_\w+")
_LABELS = re.compile(r"by \(([^)]*)\)|\{\{ ?\$?(?:labels\.)?(\w+) ?\}\}|(?<=\{)(\w+)=")

OF_PROMETHEUS = {"le", "job"}
"""Labels of histograms and of the scraped target."""


def expressions() -> Iterator[tuple[str, str]]:
    """Yield each expression with the text that shows its labels."""
    for panel in json.loads(DASHBOARD.read_text())["panels"]:
        for target in panel["targets"]:
            yield target["expr"], target["legendFormat"]
    for rule in ALERTS.read_text().split("- alert: ")[1:]:
        expression = re.search(r"expr: (.*)", rule)
        assert expression
        yield expression[1], rule.split("summary:")[1]


def exported() -> dict[str, set[str]]:
    """Return the labels of every sample of a service that has counted something of each kind."""
    metrics = Metrics()
    metrics.observe(("a", 200), 0.1)
    metrics.problem("too-busy")
    for counter in (metrics.long_inline, metrics.handed_over):
        counter.labels("a").inc()
    metrics.failed_checks.labels("a", "energy").inc()
    metrics.used_seconds.labels("a").inc()
    return {sample.name: {*sample.labels} for family in metrics.registry.collect() for sample in family.samples}


def test_every_metric_and_label_exists() -> None:
    known, count = exported(), 0
    for expression, shown in expressions():
        names = _NAME.findall(expression)
        labels = {
            label
            for groups in _LABELS.findall(f"{expression} {shown}")
            for label in re.split(r"[, ]+", "".join(groups))
        }
        for name in names:
            assert name in known, f"{name} is no metric of the service"
            count += 1
        given = set().union(*(known[name] for name in names)) | OF_PROMETHEUS
        assert labels - {""} <= given, (expression, labels - given)
    assert count >= 20


def test_every_metric_is_on_the_dashboard() -> None:
    text = DASHBOARD.read_text()
    missing = [
        name for name in exported() if not name.endswith(("_created", "_sum", "_count", "_bucket")) and name not in text
    ]
    assert missing == []


def test_codes_of_problems_exist() -> None:
    codes = re.findall(r'code="([^"]+)"', ALERTS.read_text())
    assert codes
    assert set(codes) <= set(REGISTRY)


def test_panels_do_not_overlap() -> None:
    panels = json.loads(DASHBOARD.read_text())["panels"]
    places = [(panel["gridPos"]["x"], panel["gridPos"]["y"]) for panel in panels]
    assert len(set(places)) == len({panel["id"] for panel in panels}) == len(panels)


def test_the_documentation_leads_to_both() -> None:
    text = (ROOT / "docs" / "deployment.md").read_text()
    assert all(f"observability/{Path(file).name}" in text for file in (DASHBOARD, ALERTS))
