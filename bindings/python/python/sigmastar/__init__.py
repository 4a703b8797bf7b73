"""Certified gains of a regulator for periodic disturbances.

`certify` takes a specification of bounding functions, or a plant by its formulas, and returns a certificate of one gain that
provably works for every number of oscillators; `check` decides a certificate again with code of its own.

    >>> import sigmastar
    >>> certificate = sigmastar.certify("specs/paper-example.json")
    >>> print(certificate.sigma_star)
    39.8018
    >>> bool(sigmastar.check(certificate))
    True

A claim is proved: no floating-point number decides it. What is not certified is an exception (`UndecidedError`, `RefutedError`,
`InputError`), never a certificate.
"""

from ._calls import certify, check, controller, rate, transfer
from ._condition import Condition
from ._errors import Diagnostic, InputError, RefutedError, SigmastarError, UndecidedError
from ._exact import Exact
from ._native import VERSION as __version__
from ._regulator import Regulator, SampledRegulator
from ._results import Certificate, Check, InitialSet, PeriodicSolution, Rate, Rates, Samples, Share, TransferBound
from ._study import Case, Study, load_study, results, run_case, study_cases, write_results

__all__ = [
    "Case",
    "Certificate",
    "Check",
    "Condition",
    "Diagnostic",
    "Exact",
    "InitialSet",
    "InputError",
    "PeriodicSolution",
    "Rate",
    "Rates",
    "RefutedError",
    "Regulator",
    "SampledRegulator",
    "Samples",
    "Share",
    "SigmastarError",
    "Study",
    "TransferBound",
    "UndecidedError",
    "__version__",
    "certify",
    "check",
    "controller",
    "load_study",
    "rate",
    "results",
    "run_case",
    "study_cases",
    "transfer",
    "write_results",
]
