"""A tool of LTI 1.3 that asks a question, grades answers, and sends the score to the platform (Canvas, Moodle, ...).

The folder that the environment variable POLHODE_LTI names (this one if it is not set) has `bundle` (or `questions`, see
polhode_results.py), `platforms.json` with the platforms in the form of PyLTI1p3, the keys that it names, and
`questions.json`:

    {"1f": {"text": "What is the period?", "answers": {"T": {"pointer": "/period", "unit": "s"}}, "attempts": 5}}

A link of the platform says which question it is by the custom parameter `question`. Run: waitress-serve bridge:app,
behind a proxy with HTTPS, without which browsers keep no cookie of a page within another.
"""

from __future__ import annotations

import json
import os
import sqlite3
from collections.abc import Iterable
from contextlib import closing
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

from flask import Flask, Response, abort, make_response, render_template_string, request, url_for
from flask_caching import Cache
from polhode_results import claim, feedback, results
from pylti1p3.contrib.flask import (
    FlaskCacheDataStorage,
    FlaskMessageLaunch,
    FlaskOIDCLogin,
    FlaskRequest,
    FlaskServiceConnector,
)
from pylti1p3.exception import LtiException, OIDCException
from pylti1p3.grade import Grade
from pylti1p3.tool_config import ToolConfJsonFile
from requests import RequestException

CUSTOM = "https://purl.imsglobal.org/spec/lti/claim/custom"
LINK = "https://purl.imsglobal.org/spec/lti/claim/resource_link"
DEPLOYMENT = "https://purl.imsglobal.org/spec/lti/claim/deployment_id"

ATTEMPTS = 5
"""Of each student at a question that says nothing else: without a limit the answer can be found by trying."""

LONGEST_ENTRY = 2_000

PAGE = """<!doctype html><html><head><meta charset="utf-8"><title>{{ name }}</title></head><body>
<p>{{ question["text"] }}</p>
{% if said %}<p role="status">{{ said }}</p>{% endif %}
{% if left > 0 %}<form method="post" action="{{ url_for('answer') }}">
<input type="hidden" name="launch" value="{{ launch }}">
{% for field in question["answers"] %}
<p><label>{{ field }} <input name="answer-{{ field }}" value="{{ typed.get(field, '') }}" maxlength="2000"></label></p>
{% endfor %}<button>Submit</button></form>{% endif %}
<p>Attempts left: {{ left }}. Best score: {{ "%.0f" | format(100 * best) }} %.</p></body></html>"""


class Connector(FlaskServiceConnector):
    """Requests to platforms; their tokens are kept by client, because all Canvas platforms name the same issuer."""

    def _scope_key(self, scopes: Iterable[str]) -> str:
        return json.dumps([self._registration.get_client_id(), super()._scope_key(scopes)])


class Attempts:
    """How often each student has answered a link, and with what best score, in a file."""

    def __init__(self, file: Path) -> None:
        self._file = file
        with closing(self._open()) as store, store:
            store.execute("create table if not exists attempts (who text primary key, count integer, best real)")

    def _open(self) -> sqlite3.Connection:
        return sqlite3.connect(self._file, timeout=30)

    def of(self, who: str) -> tuple[int, float]:
        """Return the number of attempts and the best score."""
        with closing(self._open()) as store:
            return store.execute("select count, best from attempts where who = ?", (who,)).fetchone() or (0, 0.0)

    def begin(self, who: str, most: int) -> bool:
        """Count an attempt; return whether it is still allowed."""
        with closing(self._open()) as store, store:
            store.execute("insert or ignore into attempts values (?, 0, 0.0)", (who,))
            counted = store.execute("update attempts set count = count + 1 where who = ? and count < ?", (who, most))
            return counted.rowcount == 1

    def take_back(self, who: str) -> None:
        """Give an attempt back that was not graded."""
        with closing(self._open()) as store, store:
            store.execute("update attempts set count = count - 1 where who = ?", (who,))

    def end(self, who: str, score: float) -> float:
        """Note a score; return the best."""
        with closing(self._open()) as store, store:
            store.execute("update attempts set best = max(best, ?) where who = ?", (score, who))
            return float(store.execute("select best from attempts where who = ?", (who,)).fetchone()[0])


def create_app(folder: Path) -> Flask:
    """Return the tool whose questions, platforms and keys are in a folder."""
    app = Flask(__name__)
    data = folder / "data"
    data.mkdir(mode=0o700, exist_ok=True)
    cache = Cache(app, config={"CACHE_TYPE": "FileSystemCache", "CACHE_DIR": str(data / "launches")})
    storage = FlaskCacheDataStorage(cache)
    platforms = ToolConfJsonFile(str(folder / "platforms.json"))
    questions = json.loads((folder / "questions.json").read_text(encoding="utf-8"))
    attempts = Attempts(data / "attempts.sqlite")

    def asked(launch: FlaskMessageLaunch) -> tuple[str, Any, str]:
        """Return the name of a launch's question, the question, and whose attempts are counted at which link."""
        said = launch.get_launch_data()
        name = said.get(CUSTOM, {}).get("question")
        if name not in questions:
            abort(404, "The custom parameter 'question' of this link names no question of questions.json.")
        who = json.dumps([said["iss"], said[DEPLOYMENT], said[LINK]["id"], name, said["sub"]])
        return name, questions[name], who

    def page(launch: FlaskMessageLaunch, said: str = "", typed: dict[str, str] | None = None) -> Response:
        name, question, who = asked(launch)
        count, best = attempts.of(who)
        left = max(0, question.get("attempts", ATTEMPTS) - count)
        shown = {"name": name, "question": question, "launch": launch.get_launch_id(), "said": said}
        made = make_response(render_template_string(PAGE, **shown, typed=typed or {}, left=left, best=best))
        made.headers["Content-Security-Policy"] = "default-src 'none'; form-action 'self'"
        made.headers["Cache-Control"] = "no-store"
        return made

    @app.before_request
    def require_https() -> None:
        if not request.is_secure:
            abort(400, "HTTPS is needed: say so to waitress-serve by --trusted-proxy and --trusted-proxy-headers.")

    @app.errorhandler(LtiException)
    @app.errorhandler(OIDCException)
    def refused(fault: Exception) -> tuple[str, int]:
        text = (
            f"This launch is not valid: {type(fault).__name__}. Open the link in the course again, in a window of its "
            "own if your browser keeps no cookies of pages within others."
        )
        return text, 403

    @app.get("/keys")
    def keys() -> Any:
        return platforms.get_jwks()

    @app.route("/login", methods=["GET", "POST"])
    def login() -> Any:
        begun = FlaskOIDCLogin(FlaskRequest(), platforms, launch_data_storage=storage)
        return begun.redirect(url_for("launch", _external=True))

    @app.post("/launch")
    def launch() -> Response:
        begun = FlaskMessageLaunch(FlaskRequest(), platforms, launch_data_storage=storage)
        begun.get_launch_data()
        return page(begun)

    @app.post("/answer")
    def answer() -> Response:
        begun = FlaskMessageLaunch.from_cache(
            request.form.get("launch", ""),
            FlaskRequest(),
            platforms,
            launch_data_storage=storage,
            service_connector_cls=Connector,
        )
        name, question, who = asked(begun)
        typed = {field: request.form.get(f"answer-{field}", "")[:LONGEST_ENTRY] for field in question["answers"]}
        claims = {
            entry["pointer"]: claim(typed[field], entry.get("unit"))
            for field, entry in question["answers"].items()
            if typed[field].strip()
        }
        if not claims:
            return page(begun, "There is no answer yet.")
        if not attempts.begin(who, question.get("attempts", ATTEMPTS)):
            return page(begun, "There are no attempts left.", typed)
        try:
            (result,) = results(folder, name, [claims])
        except Exception:
            attempts.take_back(who)
            raise
        best = attempts.end(who, result["score"] or 0.0)
        return page(begun, f"{feedback(result)} {_sent(begun, best)}", typed)

    return app


def _sent(launch: FlaskMessageLaunch, score: float) -> str:
    """Send a score to the platform; return what is to be said of that."""
    if not launch.check_student_access():
        return "The score was not sent: this is not a student's view."
    if not launch.has_ags():
        return "The score was not sent: the platform takes none for this link."
    said = launch.get_launch_data()
    grade = Grade().set_score_given(score).set_score_maximum(1.0).set_user_id(said["sub"])
    grade.set_timestamp(datetime.now(UTC).isoformat(timespec="milliseconds"))
    grade.set_activity_progress("Completed").set_grading_progress("FullyGraded")
    try:
        launch.get_ags().put_grade(grade)
    except (LtiException, RequestException):
        return "The platform did not take the score; it is sent again with the next attempt."
    return "The score has been sent."


def __getattr__(name: str) -> Flask:
    """Make the application where a server asks for it; tests make their own."""
    if name == "app":
        return create_app(Path(os.environ.get("POLHODE_LTI", Path(__file__).parent)))
    raise AttributeError(name)
