"""The tool of LTI 1.3 against a platform: lti1p3platform, as OpenLearning runs it, signs launches and checks tokens."""

from __future__ import annotations

import json
import shutil
import sys
import threading
from collections.abc import Iterator
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path
from typing import Any
from urllib.parse import parse_qsl, urlsplit

import pytest
from cryptography.hazmat.primitives import serialization
from cryptography.hazmat.primitives.asymmetric import rsa
from lti1p3platform.ltiplatform import LTI1P3PlatformConfAbstract
from lti1p3platform.message_launch import LTIAdvantageMessageLaunchAbstract
from lti1p3platform.oidc_login import OIDCLoginAbstract
from lti1p3platform.registration import Registration

ROOT = Path(__file__).parents[2]
TOOL = "https://tool.test"
LEARNER = "http://purl.imsglobal.org/vocab/lis/v2/membership#Learner"
TEACHER = "http://purl.imsglobal.org/vocab/lis/v2/membership#Instructor"
SCORE = "https://purl.imsglobal.org/spec/lti-ags/scope/score"


def keys() -> tuple[str, str]:
    """Return a private and a public key."""
    key = rsa.generate_private_key(public_exponent=65537, key_size=2048)
    form = serialization.PrivateFormat.TraditionalOpenSSL
    private = key.private_bytes(serialization.Encoding.PEM, form, serialization.NoEncryption())
    public = key.public_key().public_bytes(serialization.Encoding.PEM, serialization.PublicFormat.SubjectPublicKeyInfo)
    return private.decode(), public.decode()


class Login(OIDCLoginAbstract):
    def set_lti_message_hint(self, **kwargs: Any) -> None:
        self._lti_message_hint = "hint"

    def get_redirect(self, url: str) -> str:
        return url


class Launch(LTIAdvantageMessageLaunchAbstract):
    def get_preflight_response(self) -> dict[str, Any]:
        found: dict[str, Any] = self._request
        return found

    def render_launch_form(self, launch_data: Any, **kwargs: Any) -> Any:
        return launch_data


class Platform(LTI1P3PlatformConfAbstract):
    """A platform with one link, whose services answer on the loopback interface."""

    def init_platform_config(self, **kwargs: Any) -> None:
        self.private, self.public = keys()
        self.scores: list[dict[str, Any]] = []
        self.takes = True
        platform = self

        class Handler(BaseHTTPRequestHandler):
            def log_message(self, *arguments: Any) -> None:
                pass

            def answered(self, document: Any, status: int = 200) -> None:
                content = json.dumps(document).encode()
                self.send_response(status)
                self.send_header("Content-Type", "application/json")
                self.send_header("Content-Length", str(len(content)))
                self.end_headers()
                self.wfile.write(content)

            def do_GET(self) -> None:
                self.answered(platform.get_jwks())

            def do_POST(self) -> None:
                body = self.rfile.read(int(self.headers["Content-Length"])).decode()
                if self.path == "/token":
                    return self.answered(platform.get_access_token(dict(parse_qsl(body))))
                assert self.path == "/items/1/scores"
                assert platform.validate_token(self.headers["Authorization"].split()[1], [SCORE])
                if not platform.takes:
                    return self.answered({}, 500)
                platform.scores.append(json.loads(body))
                return self.answered({})

        self.server = ThreadingHTTPServer(("127.0.0.1", 0), Handler)
        threading.Thread(target=self.server.serve_forever, daemon=True).start()
        self.url = f"http://127.0.0.1:{self.server.server_port}"
        registered = Registration().set_iss("https://lms.test").set_client_id("tool").set_deployment_id("1")
        registered.set_launch_url(f"{TOOL}/launch").set_oidc_login_url(f"{TOOL}/login")
        registered.set_platform_public_key(self.public).set_platform_private_key(self.private)
        self._registration = registered

    def get_registration_by_params(self, **kwargs: Any) -> Registration:
        return self._registration

    def known(self) -> dict[str, Any]:
        """Return what the tool is told of the platform."""
        return {
            "https://lms.test": {
                "client_id": "tool",
                "auth_login_url": "https://lms.test/authorise",
                "auth_token_url": f"{self.url}/token",
                "key_set_url": f"{self.url}/keys",
                "private_key_file": "private.key",
                "public_key_file": "public.key",
                "deployment_ids": ["1"],
            }
        }

    def launch(self, browser: Any, user: str, role: str = LEARNER, **custom: str) -> Any:
        """Return the tool's page after a launch, as a browser gets it."""
        login = Login(None, self)
        login.set_lti_message_hint()
        begun = browser.get(login.initiate_login(user))
        sent = dict(parse_qsl(urlsplit(begun.headers["Location"]).query))
        made = Launch(sent, self)
        made.set_user_data(user, [role])
        made.set_resource_link_claim("link")
        made.set_custom_parameters_claim(custom)
        made.set_ags(f"{self.url}/items", f"{self.url}/items/1")
        self.sent = made.lti_launch()
        return browser.post(self.sent["launch_url"], data={k: self.sent[k] for k in ("state", "id_token")})


@pytest.fixture
def platform() -> Iterator[Platform]:
    made = Platform()
    yield made
    made.server.shutdown()
    made.server.server_close()


@pytest.fixture
def tool(bundle: Path, platform: Platform, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Any:
    monkeypatch.delenv("POLHODE_URL", raising=False)
    for file in ("lti/bridge.py", "polhode_results.py"):
        shutil.copy(ROOT / "clients" / "lms" / file, tmp_path)
    (tmp_path / "bundle").symlink_to(bundle)
    private, public = keys()
    (tmp_path / "private.key").write_text(private)
    (tmp_path / "public.key").write_text(public)
    (tmp_path / "platforms.json").write_text(json.dumps(platform.known()))
    asked = {"text": "<b>Period?</b>", "answers": {"T": {"pointer": "/period", "unit": "s"}}, "attempts": 3}
    (tmp_path / "questions.json").write_text(json.dumps({"1f": asked}))
    monkeypatch.syspath_prepend(str(tmp_path))
    for name in ("bridge", "polhode_results"):
        monkeypatch.delitem(sys.modules, name, raising=False)
    from bridge import Connector, create_app  # type: ignore[import-not-found]

    monkeypatch.setattr(Connector, "access_tokens", {})
    app = create_app(tmp_path)
    platform.get_registration().set_tool_key_set(app.test_client().get(f"{TOOL}/keys", base_url=TOOL).get_json())
    return app


def browser_of(tool: Any) -> Any:
    return tool.test_client()


def submit(browser: Any, page: Any, answer: str) -> Any:
    launch = page.text.split('name="launch" value="')[1].split('"')[0]
    return browser.post(f"{TOOL}/answer", base_url=TOOL, data={"launch": launch, "answer-T": answer})


def test_an_answer_is_graded_and_its_score_sent(tool: Any, platform: Platform) -> None:
    browser = browser_of(tool)
    page = platform.launch(browser, "student", question="1f")
    assert page.status_code == 200, page.text
    assert "&lt;b&gt;Period?&lt;/b&gt;" in page.text
    assert "Attempts left: 3. Best score: 0 %" in page.text
    wrong = submit(browser, page, "12,57 s")
    assert "The score has been sent." in wrong.text
    right = submit(browser, page, "6.2832 s")
    assert "Attempts left: 1. Best score: 100 %" in right.text
    assert [(score["userId"], score["scoreMaximum"]) for score in platform.scores] == [("student", 1.0)] * 2
    assert platform.scores[0]["scoreGiven"] < platform.scores[1]["scoreGiven"] == 1.0
    assert platform.scores[1]["gradingProgress"] == "FullyGraded"


def test_attempts_are_counted_and_the_best_score_stays(tool: Any, platform: Platform) -> None:
    browser = browser_of(tool)
    page = platform.launch(browser, "student", question="1f")
    assert "no answer yet" in submit(browser, page, "   ").text
    for answer in ("6.2832 s", "1 s", "<i>2</i>", "6.2832 s"):
        last = submit(browser, page, answer)
        assert "<i>" not in last.text
    assert "There are no attempts left." in last.text
    assert [score["scoreGiven"] for score in platform.scores] == [1.0, 1.0, 1.0]
    # Opened again, and by another student.
    assert "Attempts left: 0" in platform.launch(browser, "student", question="1f").text
    assert "Attempts left: 3" in platform.launch(browser_of(tool), "other", question="1f").text


def test_scores_that_the_platform_did_not_take_are_sent_with_the_next(tool: Any, platform: Platform) -> None:
    browser = browser_of(tool)
    page = platform.launch(browser, "student", question="1f")
    platform.takes = False
    assert "did not take the score" in submit(browser, page, "6.2832 s").text
    platform.takes = True
    submit(browser, page, "1 s")
    assert [score["scoreGiven"] for score in platform.scores] == [1.0]


def test_a_teacher_sees_the_question_and_no_score_is_sent(tool: Any, platform: Platform) -> None:
    browser = browser_of(tool)
    page = platform.launch(browser, "teacher", TEACHER, question="1f")
    assert "not a student" in submit(browser, page, "6.2832 s").text
    assert platform.scores == []


def test_forged_replayed_and_foreign_launches_are_refused(tool: Any, platform: Platform) -> None:
    browser = browser_of(tool)
    page = platform.launch(browser, "student", question="1f")
    token = platform.sent["id_token"]
    head, body, signature = token.split(".")
    for forged in (f"{head}.{body}.{signature[:-4]}AAAA", f"{head}.{body}.", "x", f"{head}.{body[:-2]}.{signature}"):
        sent = {"state": platform.sent["state"], "id_token": forged}
        assert browser.post(f"{TOOL}/launch", base_url=TOOL, data=sent).status_code == 403
    # A stolen token in another browser, and another's launch.
    sent = {"state": platform.sent["state"], "id_token": token}
    assert browser_of(tool).post(f"{TOOL}/launch", base_url=TOOL, data=sent).status_code == 403
    assert submit(browser_of(tool), page, "6.2832 s").status_code == 403
    for launch in ("", "lti1p3-launch-x", "../../data"):
        data = {"launch": launch, "answer-T": "6.2832 s"}
        assert browser.post(f"{TOOL}/answer", base_url=TOOL, data=data).status_code == 403
    assert platform.scores == []


def test_a_link_without_its_question_and_a_page_without_https_say_so(tool: Any, platform: Platform) -> None:
    assert "custom parameter" in platform.launch(browser_of(tool), "student", question="../1f").text
    assert browser_of(tool).get("http://tool.test/login", base_url="http://tool.test").status_code == 400
