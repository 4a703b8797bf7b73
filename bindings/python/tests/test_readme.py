"""The lines of the README: they run, and their types are right."""

import importlib.util
import os
import re
import subprocess
import sys
from pathlib import Path

import pytest
from conftest import ROOT

README = Path(__file__).resolve().parents[1] / "README.md"


def lines():
    blocks = re.findall(r"```python\n(.*?)```", README.read_text(encoding="utf-8"), re.DOTALL)
    assert len(blocks) >= 5
    return "\n".join(blocks)


def test_they_run(tmp_path):
    for name in ("control", "pandas", "matplotlib", "sympy"):
        pytest.importorskip(name)
    (tmp_path / "specs").symlink_to(ROOT / "specs")
    environment = {**os.environ, "MPLBACKEND": "Agg"}
    subprocess.run([sys.executable, "-c", lines()], cwd=tmp_path, check=True, env=environment, stdout=subprocess.DEVNULL)
    assert {"certificate.json", "bounds.json", "results.csv"} <= set(os.listdir(tmp_path))


MISUSED = """
import sigmastar
sigmastar.certify("a", transfer="bset")
sigmastar.certify("a").report("htm")
sigmastar.controller("a", sigma=1).spectral_radius
"""

USED = """
import sigmastar
certificate: sigmastar.SampledCertificate = sigmastar.certify("a", sampling_period="1/500")
certificate.samples.count + 1
sigmastar.controller(certificate).spectral_radius
sigmastar.controller("a", sigma=1, step=0.1).gain
sigmastar.controller("a", sigma=1).Phi
"""


def test_their_types_are_right(tmp_path):
    pytest.importorskip("mypy")

    def found(name, text):
        path = tmp_path / name
        path.write_text(text, encoding="utf-8")
        # SymPy states no types.
        flags = ["--strict", "--disable-error-code", "import-untyped", "--cache-dir", str(tmp_path / "cache")]
        call = [sys.executable, "-m", "mypy", *flags, str(path)]
        return subprocess.run(call, cwd=tmp_path, capture_output=True, text=True)

    for name, text in [("readme.py", lines()), ("used.py", USED)]:
        assert (done := found(name, text)).returncode == 0, done.stdout + done.stderr
    done = found("misused.py", MISUSED)
    assert done.returncode == 1 and done.stdout.count(": error:") == 3, done.stdout


def test_the_package_and_the_examples_state_their_types():
    for name in ("mypy", "control", "distributed", "pandas", "sympy"):
        pytest.importorskip(name)
    folder = README.parent
    called = ["python", "examples", str(ROOT / "examples" / "comparison.py")]
    done = subprocess.run([sys.executable, "-m", "mypy", "--strict", *called], cwd=folder, capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr
    # Pyright brings a program of its own, which is not asked for.
    if importlib.util.find_spec("pyright") is not None:
        done = subprocess.run([sys.executable, "-m", "pyright", "--pythonpath", sys.executable, *called], cwd=folder, capture_output=True, text=True)
        assert done.returncode == 0, done.stdout + done.stderr
