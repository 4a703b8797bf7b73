"""SymPy's expressions, and `**`, as formulas."""

import json
from decimal import Decimal
from fractions import Fraction

import pytest
import sigmastar
from conftest import PLANT, ROOT
from sigmastar._document import file
from sigmastar._formula import formula

sympy = pytest.importorskip("sympy")
t, x, e, a = sympy.symbols("t x e a", real=True)


def test_the_text_is_the_expression():
    for expression, text in [
        (x**2, "x^2"),
        (-x, "-x"),
        (x - e / 2, "-e/2 + x"),
        (sympy.Rational(-2, 3) * x**3, "-2*x^3/3"),
        (2 ** x, "2^x"),
        ((x + e) ** 2 * x, "x*(e + x)^2"),
        (x / (1 + e**2), "x/(e^2 + 1)"),
        (x**-2, "1/x^2"),
        (sympy.sqrt(1 + x), "sqrt(x + 1)"),
        (1 / sympy.sqrt(x), "1/sqrt(x)"),
        ((x**a) ** e, "(x^a)^e"),
        (x ** sympy.Rational(1, 3), "x^(1/3)"),
        (sympy.Abs(x), "abs(x)"),
        (sympy.atan(e * x), "atan(e*x)"),
        (sympy.sinc(2 * x), "sinc(2*x)"),
        (sympy.exp(-x), "exp(-x)"),
        (sympy.log(2) * sympy.E, "exp(1)*log(2)"),
        (sympy.sin(2 * sympy.pi * t), "sin(2*pi*t)"),
        (x / e / a, "x/a/e"),
        (-(x + e) / sympy.sqrt(a), "(-e - x)/sqrt(a)"),
        (2 ** -x, "2^(-x)"),
        (-(2 ** (x * e)), "-2^(e*x)"),
        (0.1 * x, "0.1*x"),
        (-2.5 * x + 1, "1 - 2.5*x"),
        (sympy.Float(-0.5), "-0.5"),
    ]:
        assert formula(expression) == text


@pytest.mark.parametrize(
    "wrong",
    [sympy.I, sympy.gamma(x), sympy.Function("sin")(x), sympy.Symbol("x dot"), sympy.oo, sympy.Float("0.1", 40), sympy.Matrix([x]), x < 1,
     sympy.Piecewise((x, x < 1), (0, True)), sympy.zoo, sympy.nan],
)
def test_what_has_no_notation_is_refused(wrong):
    with pytest.raises(TypeError, match="of SymPy"):
        file({"q": wrong}, "document")


def test_the_text_has_its_value():
    """Read as Python, with `^` for powers, it is what SymPy makes of it."""
    names = {"sin": sympy.sin, "cos": sympy.cos, "tanh": sympy.tanh, "exp": sympy.exp, "abs": sympy.Abs, "sqrt": sympy.sqrt, "x": x, "e": e}
    third = sympy.Rational(1, 3)
    for expression in [
        -(x**2) / 3 - third,
        x - (e - x) * -2,
        (x / e) / (e / x**3),
        -sympy.sqrt(x) * (x - 1) ** 2 / -e,
        sympy.exp(-(x**2)) ** 2 - (-x) ** 3,
        2 ** -x * (-2) ** 3,
        sympy.tanh(x * (e - 1)) / (1 + sympy.cos(x) ** 2) ** 2,
    ]:
        # Integers as SymPy's, so that a quotient of two is exact.
        again = sympy.sympify(formula(expression).replace("^", "**"), locals=names)
        assert sympy.simplify(again - expression) == 0, formula(expression)


def test_a_plant_of_expressions():
    """The same plant in three spellings has one certificate, but for the texts of its formulas."""
    plant = {
        "format": "sigmastar/plant",
        "version": 1,
        "name": "x**2 stays here",
        "period": 1,
        "states": ["x"],
        "f": [-x + e / 2 + sympy.sin(2 * sympy.pi * t) / 4],
        "q": 1 + x / 2 - e**3 / 20 + sympy.cos(2 * sympy.pi * t),
        "initial_set": {"kind": "aligned"},
        "internal_model": {
            "mu": sympy.Integer(1),
            "base_frequency": 2 * sympy.pi,
            "matched": True,
            "weights": {"family": "power", "n0": 2, "epsilon": sympy.Rational(1, 2)},
        },
    }
    by_sympy = sigmastar.certify(plant, compare=False)
    texts = {**plant, "f": ["-x + e/2 + sin(2*pi*t)/4"], "q": "1 + x/2 - e**3/20 + cos(2*pi*t)"}
    by_texts = sigmastar.certify(texts, compare=False)
    assert by_sympy.sigma_star_exact == by_texts.sigma_star_exact
    embedded = json.loads(by_texts.to_json())["plant"]
    assert (embedded["q"], embedded["name"]) == ("1 + x/2 - e^3/20 + cos(2*pi*t)", "x**2 stays here")
    assert sigmastar.check(by_sympy, plant) and sigmastar.check(by_texts, texts)
    # A certificate is what it is, to the letter.
    changed = json.loads(by_texts.to_json())
    changed["plant"]["q"] = changed["plant"]["q"].replace("^", "**")
    assert sigmastar.check(changed).verdict == "bad-input"


def test_numbers_of_sympy():
    for number in [sympy.Integer(2), 2, "2", "2**1", Fraction(2), Decimal(2), sympy.Float(2.0)]:
        assert sigmastar.simulate(ROOT / "specs/plants/linear.json", sigma=number, n_o=1, periods=2).report("json") != ""
    with pytest.raises(sigmastar.InputError):
        sigmastar.certify(PLANT, sigma=sympy.Symbol("s"))
