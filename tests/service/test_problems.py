import orjson
import pytest

from core import errors
from service.problem_types import REGISTRY, registry
from service.problems import MECHANICS, MOST_BYTES, MOST_FAULTS, Fault, Problem, code_of, pointer_of, problem_of
from tests.service.toy_routes import Unlisted


def tree(root: type) -> list[type]:
    return [root, *(leaf for branch in root.__subclasses__() for leaf in tree(branch))]


@pytest.mark.parametrize("error", tree(errors.MechanicsError), ids=lambda cls: cls.__name__)
def test_every_error_of_the_mechanics_has_its_problem(error: type) -> None:
    if error.__module__.startswith("core."):
        assert error in MECHANICS
        assert MECHANICS[error] in REGISTRY
        withheld = error is errors.SelfCheckFailed
        assert 400 <= REGISTRY[MECHANICS[error]].status < 500 or withheld
        assert (REGISTRY[MECHANICS[error]].status == 500) == withheld


def test_an_unlisted_error_takes_its_ancestors_problem() -> None:
    assert code_of(Unlisted("new")) == "mechanics-error"


def test_the_data_of_an_error_are_members_of_its_problem() -> None:
    document = orjson.loads(problem_of(errors.BudgetExceeded("samples", 7, 5, path=("times", "count"))).body())
    assert (document["what"], document["needed"], document["limit"]) == ("samples", 7, 5)
    assert document["errors"][0]["pointer"] == "/times/count"
    assert document["type"] == "/v1/errors#budget-exceeded"


def test_pointers_are_escaped_as_rfc_6901_says() -> None:
    assert pointer_of(("a/b", "m~n", 0)) == "/a~1b/m~0n/0"


def test_faults_are_bounded_in_number_and_length() -> None:
    many = tuple(Fault(f"/{i}", "x") for i in range(100))
    document = orjson.loads(Problem(REGISTRY["invalid-parameter"], "bad", many).body())
    assert len(document["errors"]) == MOST_FAULTS
    long = tuple(Fault(f"/{'p' * 300}/{i}", "x") for i in range(100))
    assert len(Problem(REGISTRY["invalid-parameter"], "bad", long).body()) <= MOST_BYTES + 20


def test_a_single_fault_is_listed_however_long_it_is() -> None:
    document = orjson.loads(Problem(REGISTRY["invalid-parameter"], "d" * MOST_BYTES, (Fault("/a", "x"),)).body())
    assert [fault["pointer"] for fault in document["errors"]] == ["/a"]


def test_a_remedy_is_given_with_its_fault_alone() -> None:
    document = orjson.loads(problem_of(errors.InvalidParameter("a", "be less", remedy="make it smaller")).body())
    assert document["errors"] == [{"pointer": "/a", "detail": "must be less", "remedy": "make it smaller"}]
    assert {"remedy", "rule", "path"}.isdisjoint(document)


def test_codes_are_unique_and_published() -> None:
    published = registry()
    assert [entry["code"] for entry in published] == list(REGISTRY)
    assert all(entry["title"] and entry["meaning"].endswith(".") for entry in published)


def test_a_problem_names_its_occurrence_by_the_request() -> None:
    problem = Problem(REGISTRY["too-busy"], "later")
    document = orjson.loads(problem.body("a-1"))
    assert (document["instance"], document["request_id"]) == ("urn:polhode:request:a-1", "a-1")
    assert {"instance", "request_id"}.isdisjoint(orjson.loads(problem.body()))
    many = tuple(Fault(f"/{'p' * 300}/{i}", "x") for i in range(100))
    longest = Problem(REGISTRY["invalid-parameter"], "bad", many).body("x" * 64)
    assert len(longest) <= MOST_BYTES + 20
