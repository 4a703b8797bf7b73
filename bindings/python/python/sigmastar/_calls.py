"""The functions of the package."""

from __future__ import annotations

from typing import Iterable, NamedTuple, Optional, Tuple, Union

from . import _native
from ._document import Document, File, file
from ._errors import found
from ._exact import Number, text
from ._regulator import Regulator, SampledRegulator
from ._regulator import regulator as _regulator
from ._regulator import sampled as _sampled
from ._results import Certificate, Check, Rates, TransferBound
from ._results import certificate as _certificate
from ._results import check as _check
from ._results import rates as _rates
from ._results import transfer as _transfer


class _Options(NamedTuple):
    transfer: str
    precision_limit: int
    compare: bool
    sigma: Optional[str]
    sampling_period: Optional[str]


def certify(
    document: Document,
    *,
    sigma: Optional[Number] = None,
    sampling_period: Optional[Number] = None,
    transfer: str = "best",
    precision_limit: int = _native.LARGEST_PRECISION_LIMIT,
    compare: bool = True,
) -> Certificate:
    """Certifies a bounding specification or a plant: a path, or the document as a dictionary.

    There is a certificate only where every condition is proved. The options are those of `sigmastar certify`:

    - `sigma`: certify this gain instead of the smallest one that is found;
    - `sampling_period`: certify the regulator that a computer runs at samples this far apart;
    - `transfer`: the proof of the transfer bound, `best`, `boxes` or `closed-form`;
    - `precision_limit`: the precision in bits at which an undecided condition is given up;
    - `compare`: whether the repaired derivation is worked out too, for the report and the certificate.

    Raises InputError where the document or an option is wrong, UndecidedError where nothing is claimed either way, RefutedError
    where what was asked for is proved not to hold, and OSError for a file that cannot be read.
    """
    options = _Options(transfer, precision_limit, compare, _maybe(sigma), _maybe(sampling_period))
    return _certificate(found(_native.certify(file(document, "document"), options)))


def check(certificate: Union[Certificate, Document], specification: Optional[Document] = None) -> Check:
    """Decides a certificate again, with none of the code that wrote it: a Certificate, a path or a dictionary.

    With a specification or plant, a certificate about other data is invalid. The answer is true only where the claim is proved.
    A dictionary has to hold every number as the file does: one that `json.load` made may not, where floats lose their spelling.

    Raises InputError and OSError for the specification alone; a bad certificate is told in the answer.
    """
    content = certificate.to_json().encode("utf-8") if isinstance(certificate, Certificate) else file(certificate, "")[1]
    against = None if specification is None else file(specification, "document")
    return _check(found(_native.check(content, against)))


def rate(document: Document, n_o: Iterable[int] = (0, 1, 2, 4, 8, 16), *, sigma: Optional[Number] = None) -> Rates:
    """Certifies a specification or plant and proves rates of convergence for some numbers of oscillators, at the gain sigma of
    at least sigma_star, or at sigma_star itself.

    Raises what `certify` raises; InputError for a smaller gain, and for more than 200 oscillators.
    """
    return _rates(found(_native.rates(file(document, "document"), _maybe(sigma), _counts(n_o))))


def transfer(
    document: Document,
    *,
    k0: Optional[Number] = None,
    minimise: Optional[Tuple[Number, Number]] = None,
    n_o: Optional[Iterable[Optional[int]]] = None,
) -> TransferBound:
    """Proves the transfer bound of the internal model, T_N(x) <= k0 + k1 x^2 for every number of oscillators.

    - `k0`: the smallest k1 for this k0;
    - `minimise=(a, b)`: the pair with the smallest a k0 + b k1; without both, the weights of the data at X = E = 0;
    - `n_o`: numbers of oscillators whose share of the bound is worked out, None for infinitely many.

    Raises RefutedError for a k0 below T_N(0), UndecidedError where no proof was found, InputError and OSError as `certify`.
    """
    if k0 is not None and minimise is not None:
        raise ValueError("k0 and minimise do not go together: leave one of them out")
    weights = None if minimise is None else (text(minimise[0]), text(minimise[1]))
    counts = None if n_o is None else [None if count is None else _count(count) for count in n_o]
    return _transfer(found(_native.transfer(file(document, "document"), _maybe(k0), weights, counts)))


def controller(
    source: Union[Certificate, Document],
    n_o: int = 4,
    *,
    sigma: Optional[Number] = None,
    step: Optional[Number] = None,
) -> Union[Regulator, SampledRegulator]:
    """The regulator with n_o oscillators as NumPy arrays, of a certificate with its gain, or of a specification or plant with
    the gain `sigma`.

    With a sampling time `step` it is the law at samples. A certificate about the regulator at samples has its own sampling
    period, and its claim is about no other: neither `sigma` nor `step` goes with it. One about continuous time says nothing
    about a sampled law.

    Raises InputError for a gain or sampling time that is wrong or works badly, and OSError as `certify`.
    """
    if isinstance(source, Certificate):
        if sigma is not None:
            raise ValueError("a certificate has its gain: leave sigma out, or give the specification")
        if source.samples is not None and step is not None:
            raise ValueError("the certificate has its sampling period: leave step out, or give the specification")
        # The double is certified too, and is what the matrices hold; at samples only the exact gain is.
        sigma = float(source.sigma_star) if source.samples is None else source.sigma_star.exact
        step = step if source.samples is None else source.samples.period
        document: File = (source.name, source._subject.encode("utf-8"))
    else:
        if sigma is None:
            raise ValueError("no gain is given: give sigma, or a certificate")
        document = file(source, "document")
    count = _count(n_o)
    if step is None:
        return _regulator(found(_native.regulator(document, text(sigma), count)))
    return _sampled(found(_native.sampled_regulator(document, text(sigma), count, text(step))))


def _maybe(number: Optional[Number]) -> Optional[str]:
    return None if number is None else text(number)


def _counts(n_o: Iterable[int]) -> list[int]:
    return [_count(count) for count in n_o]


def _count(n_o: int) -> int:
    if isinstance(n_o, bool) or int(n_o) != n_o or not 0 <= n_o < 1 << 32:
        raise ValueError(f"{n_o!r} is no number of oscillators")
    return int(n_o)
