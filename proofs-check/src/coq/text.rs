//! The Coq file around the numbers of a certificate.

use super::Parts;
use super::terms::number;
use proofs_core::rules::transfer::Proof;

/// What every file begins with.
const HEAD: &str = "\
From Coq Require Import Reals ZArith Lra Lia.
From Coquelicot Require Import Coquelicot.
From SigmaStar Require Import Sums Weights WeightSum ExplicitWeights Transfer Matched PlantBounds Decline Claim Decide.
Local Open Scope R_scope.
";

/// What x is where a plant is given by its formulas.
const COORDINATES: &str = "
    It is about a plant in the coordinates around its orbit: x stands for L^-1 (x - x_0), and f and q are those of it.";

/// The whole file; `record` has the fields of `numbers`.
pub fn file(digest: &str, record: &str, parts: &Parts) -> String {
    let [x, e, zeta] = parts.sizes.each_ref().map(number);
    let matched = match parts.witness.transfer {
        Proof::Matched(k) => Some(k),
        Proof::ClosedForm | Proof::Boxes { .. } => None,
    };
    let hypothesis = if matched.is_some() { "" } else { "\n  transfer_bound cert ->" };
    let names = if matched.is_some() { "About Existence" } else { "About Transfer Existence" };
    let transfer = if matched.is_some() { "transfer" } else { "Transfer" };
    let lemma = matched.map_or_else(String::new, transfer_lemma);
    let [what, coordinates] = match parts.spec.plant {
        Some(_) => ["plant", COORDINATES],
        None => ["specification", ""],
    };
    format!(
        "(** A certificate in continuous time, written by proofs-check --coq. The definitions are those of Sizes.v, PlantBounds.v and
    Claim.v in proofs-check/coq; this file has the numbers of the certificate, and Coq decides its conditions.{coordinates}

    SHA-256 of the canonical {what}:
    {digest} *)

{HEAD}
Definition cert : numbers := {{|
{record}
|}}.

(** S1 to S3 with E1 to E4 of (E), C4, C5 and C5b, C5m of (M) or C4, C4f, C5x, C5e and C5s of (Jm), (B) with an input gain, and the sizes of
    the periodic solution that are stated. *)
Lemma conditions :
  existence_conditions cert /\\ stability_conditions cert /\\
  (x_per cert <= {x} /\\ e_per cert <= {e} /\\ Z_per cert <= {zeta}).
Proof.
  note_existence cert.
  split; [decide_conditions cert|]. apply and_comm. split; [split; [|split]; decide_size|].
  note_stability cert. decide_conditions cert.
Qed.

Lemma the_weights : weights (n cert).
Proof. decide_weights cert. Qed.

Lemma weight_sum : forall N, n cert O + sum1 N (n cert) <= n_bar2 cert.
Proof. decide_weight_sum cert. Qed.
{lemma}
(** For every plant that is as [about] says, every N, every gain s from sigma on and every input gain b of the interval (1 without): each
    solution p of the stated size attracts, in that what starts in the set stays in the error box, U does not grow, xt, et and s are square
    integrable, and the errors of x and e tend to 0. *)
Theorem certificate_attracts :
  forall (X : NormedModule R_AbsRing) f q (m : forms X), about cert f q m ->
  forall s b, sigma cert <= s -> b_lo cert <= b <= b_hi cert -> exists rho, 0 < rho /\\
  forall N p, (forall t, solves cert f q N s b p t) -> sized cert N p -> attracts cert f q m N s b p rho.
Proof.
  intros X f q m About s b Hs Hb.
  destruct (attracting cert f q m (n_pos _ the_weights) About (proj1 (proj2 conditions)) s b Hs Hb) as [rho [Hrho A]].
  exists rho. split; [exact Hrho|]. intros N p. apply (A N p (weight_sum N)).
Qed.

(** The certificate. That the periodic solution exists, [periodic_exists], is a hypothesis: its conditions are proved here, section 10.3,
    or 13.7 with (E), is not. *)
Theorem certificate_holds :
  forall (X : NormedModule R_AbsRing) f q (m : forms X), about cert f q m ->{hypothesis}
  periodic_exists cert f q -> certified cert f q m.
Proof.
  intros X f q m {names}.
  apply (claim cert f q m (n_pos _ the_weights) About (proj1 (proj2 conditions)) Existence (proj1 conditions) the_weights {transfer}
           weight_sum).
Qed.

(** What both rest on. *)
Definition certificate := (certificate_attracts, certificate_holds).
Print Assumptions certificate.
"
    )
}

/// The matched criterion, where the certificate has it.
fn transfer_lemma(k: u32) -> String {
    format!(
        "
(** Section 2.3: every k below {k} one by one, and one inequality for the others. *)
Lemma transfer : transfer_bound cert.
Proof. decide_matched cert the_weights {k}%nat. Qed.
"
    )
}
