"""The state of a study as it is written, in the shape of OGC API Processes."""

from __future__ import annotations

import time
from datetime import UTC, datetime
from importlib.util import find_spec
from typing import Any

from service.responses import npz
from service.responses.svg import SVG
from service.routes.studies import PATH
from service.schemas import SIGNATURE
from service.studies import comma_separated, grids, tables
from service.studies.study import SUCCESSFUL, Study

JSON_TYPE = "application/json"

REPRESENTATIONS: dict[str, str | None] = {
    JSON_TYPE: None,
    npz.MEDIA_TYPE: None,
    tables.MEDIA_TYPE: None,
    grids.MEDIA_TYPE: "zarr",
    comma_separated.MEDIA_TYPE: None,
    SVG: None,
}
"""Media types of results, each with the optional package that writes it."""

_WRITTEN_HERE = tuple(kind for kind, package in REPRESENTATIONS.items() if package is None or find_spec(package))


def state_of(study: Study) -> dict[str, Any]:
    """Return the state of a study as it is written."""
    now, address = time.time(), f"{PATH}/{study.id}"
    links = [("self", address, JSON_TYPE), ("events", f"{address}/events", "text/event-stream")]
    if study.status == SUCCESSFUL:
        kinds = (JSON_TYPE,) if study.whole else _WRITTEN_HERE
        links.extend(("results", f"{address}/results", kind) for kind in kinds)
    return {
        "jobID": study.id,
        "type": "process",
        "processID": "study",
        "status": study.status,
        "message": study.message,
        "created": _moment(study.created),
        "started": _moment(study.started),
        "finished": _moment(study.finished),
        "updated": _moment(now),
        "progress": 100 * study.done // study.count,
        "path": study.plan["path"],
        "count": study.count,
        **{name: study.plan[name] for name in ("shape", "inputs", "figures", "together")},
        "done": study.done,
        "failed": study.failed,
        "seconds": study.seconds,
        "predicted_seconds": study.plan["seconds"],
        "bytes": study.plan["bytes"],
        "predicted_end": _moment(_end(study, now)),
        "links": [{"href": href, "rel": rel, "type": kind} for rel, href, kind in links],
    }


def _end(study: Study, now: float) -> float | None:
    """Return when an unfinished study should end: by what is predicted, and then by how long its members have taken."""
    if not study.unfinished:
        return None
    if not study.done or study.started is None:
        return now + float(study.plan["seconds"])
    return now + (now - study.started) * (study.count - study.done) / study.done


def _moment(seconds: float | None) -> str | None:
    return None if seconds is None else datetime.fromtimestamp(seconds, UTC).isoformat(timespec="milliseconds")


def signed(document: dict[str, Any]) -> dict[str, Any]:
    """Return a document with the name and version of what has made it."""
    return {"signature": SIGNATURE, **document}
