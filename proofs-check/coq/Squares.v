(** Section 2.1: the two sums of squares. The sum of 1/(j + 1/2)^2 is at most pi^2/2, and for |d| <= 1/2 that of 1/(d - j)^2
    over j <> 0 is at most pi^2 - 4. Both for every number of terms. *)

From Coq Require Import Reals ZArith Lra Lia.
From Coquelicot Require Import Rcomplements.
From SigmaStar Require Import Sums.
Local Open Scope R_scope.

(** Doubling: 4/sin^2 y = 1/sin^2 (y/2) + 1/sin^2 ((y + pi)/2). *)
Lemma sine_double y : 0 < y < PI -> / sin (y / 2) ^ 2 + / sin (y / 2 + PI / 2) ^ 2 = 4 * / sin y ^ 2.
Proof.
  intros Hy. replace (y / 2 + PI / 2) with (PI / 2 + y / 2) by ring. rewrite <- cos_sin.
  assert (E : sin y = 2 * sin (y / 2) * cos (y / 2)) by (rewrite <- sin_2a; f_equal; field).
  assert (0 < sin (y / 2)) by (apply sin_gt_0; lra).
  assert (0 < cos (y / 2)) by (apply cos_gt_0; lra).
  pose proof (sin2_cos2 (y / 2)) as P. unfold Rsqr in P. rewrite E.
  set (a := sin (y / 2)) in *. set (b := cos (y / 2)) in *.
  transitivity ((a * a + b * b) / (a ^ 2 * b ^ 2)); [field; lra|]. rewrite P. field. lra.
Qed.

Lemma INR_2 : INR 2 = 2.
Proof. reflexivity. Qed.

Lemma pow2_nat_pos p : 0 < 2 ^ p.
Proof. apply pow_lt; lra. Qed.

Lemma sine_sum p : forall x, 0 < x < PI ->
  sum (2 ^ p) (fun k => / sin ((x + INR k * PI) / 2 ^ p) ^ 2) = 4 ^ p * / sin x ^ 2.
Proof.
  induction p as [|p IH]; intros x Hx.
  - simpl sum. simpl pow. replace ((x + 0 * PI) / 1) with x by field. ring.
  - replace (2 ^ S p)%nat with (2 ^ p + 2 ^ p)%nat by (simpl; lia).
    rewrite sum_split, <- sum_plus. simpl (4 ^ S p). rewrite Rmult_assoc, <- (IH x Hx), <- sum_scal.
    apply sum_ext. intros k Hk. pose proof (pow2_nat_pos p) as P.
    rewrite <- sine_double.
    + f_equal; do 3 f_equal.
      * simpl pow. field. lra.
      * rewrite plus_INR, pow_INR, INR_2. simpl pow. field. lra.
    + assert (Hk' : INR k + 1 <= 2 ^ p).
      { replace 2 with (INR 2) by (simpl; ring). rewrite <- pow_INR, <- S_INR. apply le_INR. lia. }
      pose proof (pos_INR k). pose proof PI_RGT_0. split.
      * apply Rdiv_lt_0_compat; [|lra].
        apply Rplus_lt_le_0_compat; [lra|]. apply Rmult_le_pos; lra.
      * apply Rmult_lt_reg_r with (2 ^ p); [lra|]. unfold Rdiv.
        rewrite Rmult_assoc, Rinv_l by lra. nra.
Qed.

Lemma half_sine_sum p :
  2 * sum (2 ^ p) (fun k => / sin ((INR k + 1 / 2) * PI / 2 ^ S p) ^ 2) = 4 ^ S p.
Proof.
  pose proof PI_RGT_0 as Hpi. pose proof (pow2_nat_pos p) as P.
  pose proof (sine_sum (S p) (PI / 2) ltac:(lra)) as E. rewrite sin_PI2 in E.
  replace (2 ^ S p)%nat with (2 ^ p + 2 ^ p)%nat in E by (simpl; lia). rewrite sum_split in E.
  rewrite (sum_rev (2 ^ p) (fun i => / sin ((PI / 2 + INR (2 ^ p + i) * PI) / 2 ^ S p) ^ 2)) in E.
  replace (4 ^ S p) with (4 ^ S p * / 1 ^ 2) by field. rewrite <- E.
  replace (2 * sum (2 ^ p) (fun k => / sin ((INR k + 1 / 2) * PI / 2 ^ S p) ^ 2))
    with (sum (2 ^ p) (fun k => / sin ((INR k + 1 / 2) * PI / 2 ^ S p) ^ 2)
          + sum (2 ^ p) (fun k => / sin ((INR k + 1 / 2) * PI / 2 ^ S p) ^ 2)) by ring.
  f_equal; apply sum_ext; intros i Hi; do 2 f_equal.
  - f_equal. field. simpl. lra.
  - rewrite <- sin_PI_x. f_equal. rewrite plus_INR, pow_INR, !minus_INR, pow_INR by lia.
    rewrite INR_2. change (INR 1) with 1. simpl pow. field. lra.
Qed.

Lemma inverse_sine u : 0 < u < PI -> / u ^ 2 <= / sin u ^ 2.
Proof.
  intros Hu. assert (0 < sin u) by (apply sin_gt_0; lra). pose proof (sin_lt_x u ltac:(lra)).
  apply Rinv_le_contravar; [apply pow_lt; lra | apply pow_incr; lra].
Qed.

Lemma two_pow_ge J : (J <= 2 ^ J)%nat.
Proof. pose proof (Nat.pow_gt_lin_r 2 J ltac:(lia)). lia. Qed.

Theorem half_squares J : sum J (fun j => / (INR j + 1 / 2) ^ 2) <= PI ^ 2 / 2.
Proof.
  assert (Pos : forall j, 0 < INR j + 1 / 2) by (intros j; pose proof (pos_INR j); lra).
  apply Rle_trans with (sum (2 ^ J) (fun j => / (INR j + 1 / 2) ^ 2)).
  { apply sum_extend; [apply two_pow_ge|]. intros i _. left. apply Rinv_0_lt_compat, pow_lt, Pos. }
  pose proof PI_RGT_0 as Hpi. pose proof (pow2_nat_pos J) as P. pose proof (half_sine_sum J) as E.
  set (S0 := sum (2 ^ J) (fun j => / (INR j + 1 / 2) ^ 2)).
  assert (B : (2 ^ S J) ^ 2 / PI ^ 2 * S0
              <= sum (2 ^ J) (fun k => / sin ((INR k + 1 / 2) * PI / 2 ^ S J) ^ 2)).
  { unfold S0. rewrite <- sum_scal. apply sum_le. intros k Hk.
    assert (Hk' : INR k + 1 <= 2 ^ J).
    { replace 2 with (INR 2) by (simpl; ring). rewrite <- pow_INR, <- S_INR. apply le_INR. lia. }
    apply Rle_trans with (/ ((INR k + 1 / 2) * PI / 2 ^ S J) ^ 2).
    - right. simpl pow. pose proof (Pos k). field. lra.
    - apply inverse_sine. pose proof (Pos k). simpl pow. split.
      + apply Rdiv_lt_0_compat; nra.
      + apply Rmult_lt_reg_r with (2 * 2 ^ J); [lra|]. unfold Rdiv.
        rewrite Rmult_assoc, Rinv_l by lra. nra. }
  assert (E4 : 4 ^ S J = (2 ^ S J) ^ 2) by (rewrite <- !Rpow_mult_distr || (rewrite <- pow_mult, Nat.mul_comm, pow_mult; f_equal; ring)).
  assert (Q : 0 < (2 ^ S J) ^ 2) by (apply pow_lt, pow2_nat_pos).
  rewrite E4 in E. set (q := (2 ^ S J) ^ 2) in *.
  assert (B2 : q / PI ^ 2 * S0 <= q / 2) by lra.
  apply Rmult_le_reg_l with (q / PI ^ 2); [apply Rdiv_lt_0_compat; nra|].
  apply Rle_trans with (1 := B2). right. field. lra.
Qed.

Lemma pair_monotone p d : 1 <= p -> Rabs d <= 1 / 2 ->
  / (p - d) ^ 2 + / (p + d) ^ 2 <= / (p - 1 / 2) ^ 2 + / (p + 1 / 2) ^ 2.
Proof.
  intros Hp Hd. apply Rabs_le_between in Hd.
  assert (Hd2 : d ^ 2 <= 1 / 4) by nra.
  replace (/ (p - d) ^ 2 + / (p + d) ^ 2) with (2 * (p ^ 2 + d ^ 2) * / (p ^ 2 - d ^ 2) ^ 2).
  2:{ replace (p ^ 2 - d ^ 2) with ((p - d) * (p + d)) by ring. field. lra. }
  replace (/ (p - 1 / 2) ^ 2 + / (p + 1 / 2) ^ 2) with (2 * (p ^ 2 + 1 / 4) * / (p ^ 2 - 1 / 4) ^ 2).
  2:{ replace (p ^ 2 - 1 / 4) with ((p - 1 / 2) * (p + 1 / 2)) by field. field. lra. }
  assert (0 < p ^ 2 - 1 / 4) by nra.
  apply Rmult_le_compat; [nra | left; apply Rinv_0_lt_compat; nra | lra |].
  apply Rinv_le_contravar; nra.
Qed.

Theorem distance_squares J d : Rabs d <= 1 / 2 ->
  sum J (fun j => / (INR j + 1 - d) ^ 2 + / (INR j + 1 + d) ^ 2) <= PI ^ 2 - 4.
Proof.
  intros Hd.
  apply Rle_trans with (sum J (fun j => / (INR j + 1 / 2) ^ 2 + / (INR (S j) + 1 / 2) ^ 2)).
  - apply sum_le. intros j _. pose proof (pos_INR j). rewrite S_INR.
    apply Rle_trans with (1 := pair_monotone (INR j + 1) d ltac:(lra) Hd).
    right. f_equal; do 2 f_equal; field.
  - rewrite sum_plus. pose proof (half_squares J) as P1. pose proof (half_squares (S J)) as P2.
    rewrite sum_first in P2. change (INR 0) with 0 in P2.
    replace (/ (0 + 1 / 2) ^ 2) with 4 in P2 by field. lra.
Qed.
