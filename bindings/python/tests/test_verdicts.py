"""The verdict on every shipped file is that of the program."""

import json
import os

import pytest
import sigmastar
from conftest import ROOT, paths

# Plants take seconds: an ordinary run takes every fifth, as the tests of the program do.
EVERY = 1 if os.environ.get("SIGMASTAR_CASES") == "all" else 5
FILES = [path for folder in ("specs", "specs/invalid", "specs/plants/invalid") for path in paths(folder)]
FILES += list(paths("specs/plants"))[::EVERY]


def verdict(path):
    """The verdict, and the certificate where there is one."""
    try:
        certificate = sigmastar.certify(path, compare=False)
    except sigmastar.SigmastarError as error:
        return error.verdict, error
    return certificate.verdict, certificate


@pytest.mark.parametrize("path", FILES, ids=lambda path: str(path.relative_to(ROOT)))
def test_the_verdict_is_that_of_the_program(path, program):
    code, output = program("certify", path, "--no-alternatives", "--quiet", "--format", "json")
    report = json.loads(output)
    said, found = verdict(path)
    assert said == report["verdict"]
    assert {"certified": 0, "refuted": 1, "bad-input": 2, "undecided": 3}[said] == code
    if said == "certified":
        assert found.sigma_star_exact == report["sigma_star"]
        assert found.sigma_star >= found.sigma_star.fraction
        assert found.sha256 == report["specification"]["sha256"]
        assert all(condition.holds for condition in found.conditions)
        # Every form of the report is that of the program, to the byte.
        assert found.report("json").encode() == output
    elif path.name == "wrong-format.json":
        # It says that it is a certificate: both look for its parts, in another order.
        assert [one.message for one in found.diagnostics] == ["there is neither a `specification` nor a `plant` in it"]
        assert report["errors"][0]["message"] == "the field `claim` is missing"
    else:
        known = report.get("errors", [])
        assert [one.message for one in found.diagnostics] == [error["message"] for error in known if "code" in error]
        assert [one.pointer for one in found.diagnostics] == [error["pointer"] for error in known if "code" in error]


def test_there_are_files_of_every_verdict():
    names = {path.parent.name for path in FILES}
    assert names == {"specs", "invalid", "plants"} and len(FILES) > 70


def test_only_the_certified_ones_have_a_certificate():
    for name, kind in [("undecided-sign", sigmastar.UndecidedError), ("decreasing-bound", sigmastar.InputError)]:
        with pytest.raises(kind) as caught:
            sigmastar.certify(ROOT / "specs" / "invalid" / f"{name}.json")
        assert isinstance(caught.value, sigmastar.SigmastarError)
        assert caught.value.diagnostics[0].line is not None
