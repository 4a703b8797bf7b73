(** Section 2.3: a matched base frequency. Periodic signals contain only integers k = x, and a finite check decides all of
    them, for every number of oscillators. *)

From Coq Require Import Reals ZArith Lra Lia.
From SigmaStar Require Import Sums Weights Transfer.
Local Open Scope R_scope.

Section Matched.
Variable n : nat -> R.
Variable nu : R.
Hypothesis H : weights n.
Hypothesis nu_pos : 0 < nu.

Let nu2_pos : 0 < nu ^ 2.
Proof. apply pow_lt, nu_pos. Qed.

(** T_N is even. *)
Lemma T_even_integer N k : (0 <= k)%Z -> T n nu N (IZR (- k)) = T n nu N (IZR k).
Proof.
  intros Hk. destruct (Z_le_dec k (Z.of_nat N)) as [L|L].
  - rewrite !T_pole by lia. rewrite c_even. reflexivity.
  - assert (P : forall j, (Z.abs j = k)%Z -> regular N (IZR j)).
    { intros j Hj l Hl E. apply eq_IZR in E. lia. }
    rewrite !T_regular by (apply P; lia). unfold quotient.
    assert (E1 : g n N (IZR (- k)) = - g n N (IZR k)).
    { unfold g, zsum, sum1. rewrite opp_IZR.
      replace (- (c n 0 / (IZR 0 - IZR k) + sum N (fun i => c n (Z.of_nat (S i)) / (IZR (Z.of_nat (S i)) - IZR k)
          + c n (- Z.of_nat (S i)) / (IZR (- Z.of_nat (S i)) - IZR k))))
        with (c n 0 / (IZR 0 - - IZR k) + -1 * sum N (fun i => c n (Z.of_nat (S i)) / (IZR (Z.of_nat (S i)) - IZR k)
          + c n (- Z.of_nat (S i)) / (IZR (- Z.of_nat (S i)) - IZR k))).
      2:{ assert (IZR k <> 0) by (apply IZR_neq; lia). field; repeat split; lra. }
      rewrite <- sum_scal. f_equal. apply sum_ext. intros i Hi. rewrite c_even, opp_IZR.
      assert (IZR (Z.of_nat (S i)) < IZR k) by (apply IZR_lt; lia).
      assert (0 < IZR (Z.of_nat (S i))) by (apply IZR_lt; lia).
      field; repeat split; lra. }
    assert (E2 : g' n N (IZR (- k)) = g' n N (IZR k)).
    { unfold g', zsum, sum1. rewrite opp_IZR. f_equal.
      - assert (IZR k <> 0) by (apply IZR_neq; lia). field; repeat split; lra.
      - apply sum_ext. intros i Hi. rewrite c_even, opp_IZR.
        assert (IZR (Z.of_nat (S i)) < IZR k) by (apply IZR_lt; lia).
        assert (0 < IZR (Z.of_nat (S i))) by (apply IZR_lt; lia).
        field; repeat split; lra. }
    rewrite E1, E2. f_equal. ring.
Qed.

(** (k_0, k_1) bounds T_N at every integer, for every N. *)
Definition admissible_matched (k0 k1 : R) : Prop :=
  forall N k, T n nu N (IZR k) <= k0 + k1 * IZR k ^ 2.

(** The proposition of section 2.3, (2.3): sufficient and necessary. Hypotheses: W1 to W4, nu > 0. *)
Theorem matched_iff k0 k1 :
  admissible_matched k0 k1 <->
  1 / (nu ^ 2 * n O) <= k0 /\ (forall k, (1 <= k)%nat -> 2 / (nu ^ 2 * n k) <= k0 + k1 * INR k ^ 2).
Proof.
  split.
  - intros A. split.
    + pose proof (A O 0%Z) as A0. rewrite (T_at_0 n nu) in A0. lra.
    + intros k Hk. specialize (A k (Z.of_nat k)). rewrite <- INR_IZR_INZ in A.
      rewrite (T_at_pole n nu (n_pos n H) nu_pos) in A by lia. exact A.
  - intros [A0 A] N k.
    assert (P : forall j, (0 <= j)%Z -> T n nu N (IZR j) <= k0 + k1 * IZR j ^ 2).
    { intros j Hj. destruct (Z.eq_dec j 0) as [->|E].
      - rewrite (T_at_0 n nu). lra.
      - specialize (A (Z.to_nat j) ltac:(lia)).
        pose proof (Lemma_T''_integers n nu H nu_pos N (Z.to_nat j) ltac:(lia)) as B.
        rewrite INR_IZR_INZ, Z2Nat.id in A, B by lia. lra. }
    destruct (Z_le_dec 0 k) as [L|L]; [apply P, L|].
    specialize (P (- k)%Z ltac:(lia)).
    replace (IZR (- k) ^ 2) with (IZR k ^ 2) in P by (rewrite opp_IZR; ring).
    rewrite <- (T_even_integer N (- k)) in P by lia. rewrite Z.opp_involutive in P. exact P.
Qed.

(** What a certificate carries: k = 0, every k < K, and one inequality for the tail. Hypotheses: W1 to W4, nu > 0. *)
Theorem matched_criterion k0 k1 K :
  (1 <= K)%nat ->
  1 / (nu ^ 2 * n O) <= k0 ->
  (forall k, (1 <= k < K)%nat -> 2 / (nu ^ 2 * n k) <= k0 + k1 * INR k ^ 2) ->
  2 / (nu ^ 2 * (INR K ^ 2 * n K)) <= k1 ->
  forall N k, T n nu N (IZR k) <= k0 + k1 * IZR k ^ 2.
Proof.
  intros HK H0 HkK Htail. apply matched_iff. split; [exact H0|].
  intros k Hk. destruct (le_lt_dec K k) as [L|L]; [|apply HkK; lia].
  pose proof (n_pos n H) as Hn.
  assert (HkR : 0 < INR k) by (apply lt_0_INR; lia).
  assert (HKR : 0 < INR K) by (apply lt_0_INR; lia).
  assert (Hk0 : 0 <= k0).
  { apply Rle_trans with (2 := H0). left. apply Rdiv_lt_0_compat; [lra|].
    apply Rmult_lt_0_compat; [exact nu2_pos | apply Hn]. }
  assert (W : INR K ^ 2 * n K <= INR k ^ 2 * n k) by (apply W3_le; [exact H | lia]).
  assert (P1 : 0 < INR K ^ 2 * n K) by (apply Rmult_lt_0_compat; [apply pow_lt; lra | apply Hn]).
  assert (P2 : 0 < INR k ^ 2 * n k) by lra.
  assert (B : 2 / (nu ^ 2 * (INR k ^ 2 * n k)) <= k1).
  { apply Rle_trans with (2 := Htail). unfold Rdiv. apply Rmult_le_compat_l; [lra|].
    apply Rinv_le_contravar; [apply Rmult_lt_0_compat; lra|]. apply Rmult_le_compat_l; lra. }
  replace (2 / (nu ^ 2 * n k)) with (2 / (nu ^ 2 * (INR k ^ 2 * n k)) * INR k ^ 2)
    by (pose proof (Hn k); field; lra).
  assert (0 <= INR k ^ 2) by apply pow2_ge_0.
  assert (2 / (nu ^ 2 * (INR k ^ 2 * n k)) * INR k ^ 2 <= k1 * INR k ^ 2)
    by (apply Rmult_le_compat_r; assumption).
  lra.
Qed.

End Matched.
