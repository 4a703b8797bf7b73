"""The package itself."""

import subprocess
import sys
from importlib import metadata, resources

import pytest
import sigmastar
from conftest import ROOT


def toml(path):
    tomllib = pytest.importorskip("tomllib")
    return tomllib.loads((ROOT / path).read_text(encoding="utf-8"))


def test_there_is_one_version():
    version = toml("Cargo.toml")["workspace"]["package"]["version"]
    assert sigmastar.__version__ == metadata.version("sigmastar") == version


def test_it_is_typed():
    assert resources.files("sigmastar").joinpath("py.typed").is_file()
    assert resources.files("sigmastar").joinpath("_native.pyi").is_file()
    for name in sigmastar.__all__:
        assert getattr(sigmastar, name).__doc__, name


def test_the_line_of_the_readme():
    code = "import sigmastar; print(sigmastar.certify('specs/paper-example.json').sigma_star)"
    done = subprocess.run([sys.executable, "-c", code], cwd=ROOT, stdout=subprocess.PIPE, check=True)
    assert done.stdout == b"39.8018\n"
