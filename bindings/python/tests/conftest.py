"""What the tests share: the shipped files, and the program that the answers have to agree with."""

import json
import os
import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[3]
EXAMPLE = ROOT / "specs" / "paper-example.json"
PLANT = ROOT / "specs" / "plants" / "relative-degree-2.json"
STUDY = ROOT / "specs" / "studies" / "linear.json"


def paths(folder):
    """The JSON files of a folder of the repository, sorted."""
    return sorted((ROOT / folder).glob("*.json"))


@pytest.fixture(scope="session")
def program():
    """Runs the program and returns its exit code and the bytes of its standard output."""
    binary = os.environ.get("SIGMASTAR_PROGRAM", str(ROOT / "target" / "release" / "sigmastar"))
    if not os.path.exists(binary):
        pytest.fail(f"there is no program {binary}: cargo build --release, or name one in SIGMASTAR_PROGRAM")

    def run(*args):
        done = subprocess.run([binary, *map(str, args)], cwd=ROOT, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL)
        return done.returncode, done.stdout

    return run


@pytest.fixture(scope="session")
def reported(program):
    """The JSON report of `sigmastar certify`."""

    def run(*args):
        return json.loads(program("certify", *args, "--quiet", "--format", "json")[1])

    return run


@pytest.fixture
def document():
    """The paper's example as a dictionary."""
    return json.loads(EXAMPLE.read_text(encoding="utf-8"))
