(** The pair (k_0, k_1) of the certificate of specs/paper-example.json: mu = 1, w = 2 pi, matched, n_0 = 2, n_l = l^(-3/2),
    and K = 2. *)

From Coq Require Import Reals ZArith Lra Lia.
From SigmaStar Require Import Sums Weights Transfer Matched Enclose.
Local Open Scope R_scope.

Definition example_weights : nat -> R := power 2 (1 / 2).
Definition example_nu : R := 1 / (2 * PI).

Lemma example_W : weights example_weights.
Proof. apply power_weights; lra. Qed.

Lemma example_nu_pos : 0 < example_nu.
Proof. unfold example_nu. interval with (i_prec 60). Qed.

(** Section 2.3 with numbers: a closed statement, for every number N of oscillators and every integer k. *)
Theorem example_transfer_bound :
  forall N k, T example_weights example_nu N (IZR k) <= 19.739209 + 59.217627 * IZR k ^ 2.
Proof.
  apply matched_criterion with (K := 2%nat).
  - apply example_W.
  - apply example_nu_pos.
  - lia.
  - unfold example_weights, example_nu. simpl (power _ _ _). interval with (i_prec 60).
  - intros k Hk. assert (k = 1%nat) by lia. subst k.
    unfold example_weights, example_nu, power, Rpower. simpl INR. rewrite ln_1. interval with (i_prec 60).
  - unfold example_weights, example_nu, power, Rpower. simpl INR. interval with (i_prec 60).
Qed.
