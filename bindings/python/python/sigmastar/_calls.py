"""The functions of the package."""

from __future__ import annotations

import os
from typing import Callable, Iterable, List, Literal, Mapping, NamedTuple, Optional, Tuple, Union, overload

from . import _native
from ._beside import BoundedPlant, Design, Lyapunov, SamplingPairs, Tuning
from ._document import Document, File, file, is_certificate, read
from ._errors import found
from ._exact import Number, stated, text
from ._laboratory import Falsification, Simulation
from ._regulator import Regulator, SampledRegulator
from ._regulator import regulator as _regulator
from ._regulator import sampled as _sampled
from ._results import Certificate, Check, SampledCertificate, TransferBound
from ._results import certificate as _certificate
from ._results import check as _check
from ._results import transfer as _transfer


Transfer = Literal["best", "boxes", "closed-form"]
"""A proof of the transfer bound."""

Goal = Literal["sigma_star", "feedback"]
"""What a tuning makes small."""


class _Options(NamedTuple):
    transfer: str
    precision_limit: int
    compare: bool
    sigma: Optional[str]
    sampling_period: Optional[str]
    n_o: List[int]
    steady_error: Optional[str]
    peak_error: Optional[str]
    max_control: Optional[str]
    rate: Optional[str]
    harmonics: List[List[int]]


class _Wanted(NamedTuple):
    n_o: Optional[List[int]]
    sigmas: List[str]
    sampling_period: Optional[str]
    steady_error: Optional[str]
    peak_error: Optional[str]
    max_control: Optional[str]
    settle: Optional[str]
    noise: Optional[str]
    simulate: bool
    sampling_periods: bool
    choose: Optional[str]
    harmonics: List[List[int]]


class _Run(NamedTuple):
    sigma: str
    n_o: Optional[int]
    periods: int
    samples: int
    harmonics: int
    sampling_period: Optional[str]
    input_gain: Optional[str]


@overload
def certify(
    document: Union[Certificate, Document],
    *,
    sigma: Optional[Number] = ...,
    sampling_period: None = ...,
    n_o: Union[int, Iterable[int]] = ...,
    harmonics: Iterable[Union[int, Iterable[int]]] = ...,
    steady_error: Optional[Number] = ...,
    peak_error: Optional[Number] = ...,
    max_control: Optional[Number] = ...,
    rate: Optional[Number] = ...,
    transfer: Transfer = ...,
    precision_limit: int = ...,
    compare: bool = ...,
    progress: Optional[Callable[[str], object]] = ...,
) -> Certificate: ...
@overload
def certify(
    document: Union[Certificate, Document],
    *,
    sigma: Optional[Number] = ...,
    sampling_period: Number,
    n_o: Union[int, Iterable[int]] = ...,
    harmonics: Iterable[Union[int, Iterable[int]]] = ...,
    steady_error: Optional[Number] = ...,
    peak_error: Optional[Number] = ...,
    max_control: Optional[Number] = ...,
    rate: Optional[Number] = ...,
    transfer: Transfer = ...,
    precision_limit: int = ...,
    compare: bool = ...,
    progress: Optional[Callable[[str], object]] = ...,
) -> SampledCertificate: ...
def certify(
    document: Union[Certificate, Document],
    *,
    sigma: Optional[Number] = None,
    sampling_period: Optional[Number] = None,
    n_o: Union[int, Iterable[int]] = (),
    harmonics: Iterable[Union[int, Iterable[int]]] = (),
    steady_error: Optional[Number] = None,
    peak_error: Optional[Number] = None,
    max_control: Optional[Number] = None,
    rate: Optional[Number] = None,
    transfer: Transfer = "best",
    precision_limit: int = _native.LARGEST_PRECISION_LIMIT,
    compare: bool = True,
    progress: Optional[Callable[[str], object]] = None,
) -> Certificate:
    """Certifies a bounding specification or a plant: a path, or the document as a dictionary; of a certificate what it is about, anew.

    There is a certificate only where every condition is proved. The options are those of `sigmastar certify`:

    - `sigma`: certify this gain instead of the smallest one found;
    - `sampling_period`: certify the regulator that a computer runs at samples this far apart;
    - `n_o`: numbers of oscillators (at most 8, up to 100) for each of which a rate and a factor are proved and claimed, at this gain, and bounds by the
      number of oscillators where there are some;
    - `harmonics`: a set of harmonics with 0 among them, `[0, 1, 5, 7]`, or several: the claim is for every finite set that contains 0, and bounds
      for these, and a rate and a factor as for a number of `n_o` (none with a delay), are proved where they can be;
    - `steady_error`, `peak_error`, `max_control`: certify a gain that keeps |e| along the periodic solution, |e| in the transient, or the
      control (with `input_gain` over `nominal`) within this (the smallest found), for every number of oscillators, or for those of `n_o`
      where there are some;
    - `rate`: certify a gain with which the rates for the numbers of `n_o` are at least this, in 1/time (the smallest found);
    - `transfer`: the proof of the transfer bound, `best`, `boxes` or `closed-form`;
    - `precision_limit`: the precision in bits at which an undecided condition is given up;
    - `compare`: whether what else would give is worked out too, as bounds at larger gains, for a plant also the bounds by the number of
      oscillators (with `compare=False` only where a limit needs them), and the repaired derivation, for the report and the certificate;
    - `progress`: called with a phrase as each stage begins, `progress=print`, say; what it raises ends the call.

    Raises InputError where the document or an option is wrong, UndecidedError where nothing is claimed either way, RefutedError
    where what was asked for is proved not to hold, and OSError for a file that cannot be read.
    """
    limits = (_maybe(steady_error), _maybe(peak_error), _maybe(max_control), _maybe(rate))
    options = _Options(transfer, precision_limit, compare, _maybe(sigma), _maybe(sampling_period), _counts(n_o), *limits, _sets(harmonics))
    return _certificate(found(_native.certify(_asked(document), options, progress)))


def _sets(harmonics: Iterable[Union[int, Iterable[int]]]) -> List[List[int]]:
    """Sets of harmonics, of which one may stand alone."""
    given = list(harmonics)
    alone = [one for one in given if not isinstance(one, Iterable)]
    if alone and len(alone) == len(given):
        return [_counts(alone)]
    return [_counts(one) for one in given]


def load(path: Union[str, "os.PathLike[str]"]) -> Certificate:
    """Reads a certificate that was saved, and decides it again from its witness: what comes back is proved as by `certify`, and made anew.

    Raises InputError for what is no certificate, and for one whose claim is not what its witness proves (`kind` is `claim`), as of one
    that was altered or that another version made; UndecidedError where a condition is not proved; OSError as `certify`.
    """
    return _certificate(found(_native.reread(read(os.fspath(path)))))


def check(
    certificate: Union[Certificate, Document],
    specification: Optional[Document] = None,
    *,
    sampling_period: Optional[Number] = None,
) -> Check:
    """Decides a certificate again, with none of the code that wrote it: a Certificate, a path or a dictionary.

    With a specification or plant, a certificate about other data is invalid; `sampling_period` is the one that `certify` was given beside
    it, where it was. The answer is true only where the claim is proved.
    A dictionary has to hold every number as the file does: one that `json.load` made may not, where floats lose their spelling.

    Raises InputError and OSError for the specification and the sampling period alone; a bad certificate is told in the answer.
    """
    if specification is None and sampling_period is not None:
        raise ValueError("sampling_period goes with the specification or plant that the certificate is compared with: give it too")
    content = _stored(certificate)[1]
    against = None if specification is None else file(specification, "document")
    return _check(found(_native.check(content, against, _maybe(sampling_period))))


def bound(plant: Union[Certificate, Document], domain: Optional[Tuple[Number, Number]] = None) -> BoundedPlant:
    """The bounding specification of a plant, every number of it proved, on the domain (X, E), or on one a quarter larger than what the
    certificate of the plant needs.

    Raises what `certify` raises.
    """
    wanted = None if domain is None else (text(domain[0]), text(domain[1]))
    told = found(_native.bound(_asked(plant), wanted))
    x, e = told["domain"]
    return BoundedPlant((stated(x, "down"), stated(e, "down")), told["limited"], told["json"])


def lyapunov(document: Union[Certificate, Document]) -> Lyapunov:
    """Finds and proves the Lyapunov triple of a specification with a Jacobian, or the orbit of a plant.

    Raises InputError for a specification that gives its triple, otherwise what `certify` raises.
    """
    return Lyapunov(found(_native.lyapunov(_asked(document)))["reports"])


def sampling(
    document: Union[Certificate, Document],
    sampling_periods: Optional[Iterable[Number]] = None,
    *,
    sigmas: Optional[Iterable[Number]] = None,
) -> SamplingPairs:
    """The smallest certified gain for sampling periods, and the longest certified sampling period for gains; without either list, of
    some that fit the gain in continuous time.

    Raises what `certify` raises; where nothing is certified the answer is false.
    """
    told = found(_native.sampling(_asked(document), _texts(sampling_periods), _texts(sigmas)))
    return SamplingPairs(told["has_pair"], told["reports"])


def design(
    document: Union[Certificate, Document],
    *,
    steady_error: Optional[Number] = None,
    peak_error: Optional[Number] = None,
    max_control: Optional[Number] = None,
    settle: Optional[Number] = None,
    noise: Optional[Number] = None,
    n_o: Union[int, Iterable[int], None] = None,
    harmonics: Iterable[Union[int, Iterable[int]]] = (),
    sigmas: Iterable[Number] = (),
    sampling_period: Optional[Number] = None,
    simulate: bool = True,
    sampling_periods: bool = False,
    choose: Union[str, Iterable[str], Mapping[str, Optional[Tuple[Number, Number]]]] = (),
    progress: Optional[Callable[[str], object]] = None,
) -> Design:
    """Proves what several gains give with several numbers of oscillators, beside what is required, and names the pair to take, as
    `sigmastar design`. Each row is a claim of its own that the independent checker has decided.

    - `steady_error`, `peak_error`, `max_control`: |e| along the periodic solution (with noise the limit superior of |e|), |e| at all
      times, and the control at all times are to be at most this;
    - `settle`: after so many periods |e| is to be at most `steady_error` for good, at samples at the sampling instants;
    - `noise`: |e - e_per| in the limit, with the noise, disturbance and rounding of the document, is to be at most this;
    - `n_o`: the numbers of oscillators of the table (0, 1, 2, 3 and 5);
    - `harmonics`: sets of harmonics, each with 0, for oscillators at these, as of `certify`: `[0, 1, 5, 7]` or `[[0, 1], [0, 2, 4]]`;
    - `sigmas`: its gains, in the place of the smallest one and multiples of it;
    - `sampling_period`: the regulator at samples this far apart;
    - `simulate`: whether simulations of the nominal plant stand beside the proved numbers;
    - `sampling_periods`: whether the longest sampling period that is certified with each gain stands beside it;
    - `choose`: numbers of the document that are to be chosen, as `over` of `tune`: a table is made with its values and with four others of
      each number in turn, and the answer is about the best. The certificate has these values;
    - `progress`: called with a phrase as each group of gains is begun, `progress=print`, say; what it raises ends the call.

    The requirements are about the loop with the noise, the disturbance and the rounding that the document states. With an `actuator` or
    `delay_samples` 1 in the document nothing is proved about these, and the requirements are about the loop without them.

    Raises what `certify` raises; where something required is not proved to be met the answer is false.
    """
    required = (_maybe(steady_error), _maybe(peak_error), _maybe(max_control), _maybe(settle), _maybe(noise))
    gains = [text(sigma) for sigma in sigmas]
    numbers = _names(choose) or None
    wanted = _Wanted(
        None if n_o is None else _counts(n_o), gains, _maybe(sampling_period), *required, simulate, sampling_periods, numbers, _sets(harmonics)
    )
    told = found(_native.design(_asked(document), wanted, progress))
    oscillators = told["n_o"], told["harmonics"]
    return Design(stated(told["sigma"]), *oscillators, told["is_met"], _certificate(told["certificate"]), told["reports"])


def _names(over: Union[str, Iterable[str], Mapping[str, Optional[Tuple[Number, Number]]]]) -> str:
    """Names of numbers, each with its range where it has one, as the program reads them."""
    if isinstance(over, Mapping):
        ranges = {name: "" if ends is None else f"={text(ends[0])}..{text(ends[1])}" for name, ends in over.items()}
        over = [name + ends for name, ends in ranges.items()]
    return over if isinstance(over, str) else ",".join(over)


def tune(
    document: Union[Certificate, Document],
    over: Union[str, Iterable[str], Mapping[str, Optional[Tuple[Number, Number]]]] = ("mu", "n0"),
    *,
    minimise: Goal = "sigma_star",
    error_at: Optional[int] = None,
    tries: int = 120,
) -> Tuning:
    """Looks for better values of numbers that are free: mu, n0, epsilon, base_frequency and others, as `sigmastar tune` has them. Each
    proposal is certified by itself.

    - `over`: their names, or a dictionary of names and ranges, `{"mu": ("1/10", 10), "n0": None}`;
    - `minimise`: `sigma_star`, or `feedback`, sigma_star + mu Nbar^2, what the law multiplies e by at most;
    - `error_at`: make the certified bound of sup|e| with this many oscillators small instead;
    - `tries`: how many proposals are certified at most.

    Raises InputError for what cannot be tuned, and OSError as `certify`; where nothing is certified the answer is false.
    """
    if minimise not in ("sigma_star", "feedback"):
        raise ValueError(f"minimise: {minimise!r} is none of 'sigma_star', 'feedback'")
    names = _names(over)
    at = None if error_at is None else _count(error_at)
    told = found(_native.tune(_asked(document), names, minimise == "feedback", at, _count(tries, "tries")))
    return Tuning(told["has_claim"], told["document"], told["reports"])


def simulate(
    plant: Union[Certificate, Document],
    *,
    sigma: Optional[Number] = None,
    n_o: Optional[int] = None,
    periods: int = 30,
    samples: int = 200,
    harmonics: int = 12,
    sampling_period: Optional[Number] = None,
    input_gain: Optional[Number] = None,
) -> Simulation:
    """Simulates a plant, or that of a certificate, with its regulator of gain `sigma` and `n_o` oscillators, or without them with
    `u = -sigma e`. Floating point: it claims nothing.

    - `sigma`: the gain; without it, of a certificate its own;

    - `periods`, `samples`: the run from the initial condition of the plant, and its samples per period;
    - `harmonics`: Fourier coefficients of the steady error;
    - `sampling_period`: the regulator at samples this far apart; without it, of a certificate about samples those;
    - `input_gain`: the true gain of the actuator.

    Raises InputError and OSError as `certify`.
    """
    plant = _source(plant)
    if isinstance(plant, Certificate):
        sigma = plant.sigma_star_exact if sigma is None else sigma
        if sampling_period is None and plant.samples is not None:
            sampling_period = plant.samples.period
    if sigma is None:
        raise ValueError("no gain is given: give sigma, or a certificate")
    count = None if n_o is None else _count(n_o)
    periods, samples, harmonics = _count(periods, "periods"), _count(samples, "samples"), _count(harmonics, "harmonics")
    run = _Run(text(sigma), count, periods, samples, harmonics, _maybe(sampling_period), _maybe(input_gain))
    told = found(_native.simulate(_asked(plant), run))
    return Simulation(told["complete"], told["csv"], told["reports"])


def falsify(certificate: Union[Certificate, Document], *, trials: int = 50, seed: int = 1) -> Falsification:
    """Simulates random plants that satisfy the data of a certificate and holds what they do against its bounds: a Certificate, a path or
    a dictionary. The same seed gives the same trials. Floating point: what is not found is no proof.

    Raises InputError and OSError as `certify`.
    """
    told = found(_native.falsify(_stored(certificate), _count(trials, "trials"), seed))
    return Falsification(told["outcome"], told["counterexample"], told["reports"])


def transfer(
    document: Union[Certificate, Document],
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
    return _transfer(found(_native.transfer(_asked(document), _maybe(k0), weights, counts)))


@overload
def controller(  # type: ignore[overload-overlap]
    source: SampledCertificate,
    n_o: int = ...,
) -> SampledRegulator: ...
@overload
def controller(
    source: Union[Certificate, Document],
    n_o: int = ...,
    *,
    sigma: Optional[Number] = ...,
    step: None = ...,
) -> Regulator: ...
@overload
def controller(
    source: Union[Certificate, Document],
    n_o: int = ...,
    *,
    sigma: Optional[Number] = ...,
    step: Number,
) -> SampledRegulator: ...
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
    source = _source(source)
    if isinstance(source, Certificate):
        if sigma is not None:
            raise ValueError("a certificate has its gain: leave sigma out, or give the specification")
        if source.samples is not None and step is not None:
            raise ValueError("the certificate has its sampling period: leave step out, or give the specification")
        # The double is certified too, and is what the matrices hold; at samples only the exact gain is.
        sigma = float(source.sigma_star) if source.samples is None else source.sigma_star.exact
        step = step if source.samples is None else source.samples.period
    elif sigma is None:
        raise ValueError("no gain is given: give sigma, or a certificate")
    document = _asked(source)
    count = _count(n_o)
    if step is None:
        return _regulator(found(_native.regulator(document, text(sigma), count)))
    return _sampled(found(_native.sampled_regulator(document, text(sigma), count, text(step))))


def _asked(document: Union[Certificate, Document]) -> File:
    """What errors call a document, and its bytes; of a certificate those of the specification or plant in it."""
    source = _source(document)
    if isinstance(source, Certificate):
        return ("document", source._subject.encode("utf-8"))
    return file(source, "document")


def _source(document: Union[Certificate, Document]) -> Union[Certificate, Document]:
    """The document; where its file is a stored certificate, that, decided again."""
    if isinstance(document, (str, os.PathLike)) and is_certificate(read(os.fspath(document))[1]):
        return load(document)
    return document


def _maybe(number: Optional[Number]) -> Optional[str]:
    return None if number is None else text(number)


def _texts(numbers: Optional[Iterable[Number]]) -> Optional[List[str]]:
    return None if numbers is None else [text(number) for number in numbers]


def _stored(certificate: Union[Certificate, Document]) -> File:
    """What errors call a certificate, and its bytes."""
    if isinstance(certificate, Certificate):
        return ("certificate", certificate.to_json().encode("utf-8"))
    return file(certificate, "certificate")


def _counts(n_o: Union[int, Iterable[int]]) -> list[int]:
    return [_count(count) for count in ([n_o] if isinstance(n_o, int) else n_o)]


def _count(count: int, of: str = "oscillators") -> int:
    if isinstance(count, bool) or int(count) != count or not 0 <= count < 1 << 32:
        raise ValueError(f"{count!r} is no number of {of}")
    return int(count)
