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

from ._beside import BoundedPlant, Design, Lyapunov, Pair, SamplingPairs, Tuned, Tuning
from ._calls import bound, certify, check, controller, design, falsify, load, lyapunov, sampling, simulate, transfer, tune
from ._condition import Condition
from ._errors import Diagnostic, InputError, RefutedError, SigmastarError, UndecidedError
from ._exact import Exact
from ._laboratory import Falsification, Simulation
from ._native import VERSION as __version__
from ._regulator import Regulator, SampledRegulator
from ._results import (
    Certificate,
    Check,
    ClaimedBounds,
    ClaimedRate,
    ErrorBound,
    InitialSet,
    PeriodicSolution,
    SampledCertificate,
    Samples,
    Share,
    TransferBound,
)
from ._study import Case, Study, load_study, results, run_case, study_cases, write_results

__all__ = [
    "BoundedPlant",
    "Case",
    "Certificate",
    "Check",
    "ClaimedBounds",
    "ClaimedRate",
    "Condition",
    "Design",
    "Diagnostic",
    "ErrorBound",
    "Exact",
    "Falsification",
    "InitialSet",
    "InputError",
    "Lyapunov",
    "Pair",
    "PeriodicSolution",
    "RefutedError",
    "Regulator",
    "SampledCertificate",
    "SampledRegulator",
    "Samples",
    "SamplingPairs",
    "Share",
    "SigmastarError",
    "Simulation",
    "Study",
    "TransferBound",
    "Tuned",
    "Tuning",
    "UndecidedError",
    "__version__",
    "bound",
    "certify",
    "check",
    "controller",
    "design",
    "falsify",
    "load",
    "load_study",
    "lyapunov",
    "results",
    "run_case",
    "sampling",
    "simulate",
    "study_cases",
    "transfer",
    "tune",
    "write_results",
]
