(** Sections 10.2, 10.4, 13.1 and 13.5: bounds of the answers e_j, y_j, u_j of the loop to one harmonic q_j. The hypothesis is
    e_j = q_j/denominator, in the form denominator e_j = q_j, for any real value eta of G/i and any input gain b. That the loop's answers
    satisfy it away from the poles of G, for every number of oscillators, and are e_j = y_j = 0 at the poles, is proved in [Answers]. *)

From Coq Require Import Reals Lra Lia.
From Coquelicot Require Import Coquelicot.
From SigmaStar Require Import Sums.
Local Open Scope R_scope.

Lemma Cmod2 (z : C) : Cmod z ^ 2 = fst z ^ 2 + snd z ^ 2.
Proof.
  unfold Cmod. rewrite <- Rsqr_pow2, Rsqr_sqrt; [reflexivity|].
  pose proof (pow2_ge_0 (fst z)). pose proof (pow2_ge_0 (snd z)). lra.
Qed.

Lemma square_le a b : 0 <= b -> a ^ 2 <= b ^ 2 -> a <= b.
Proof. intros Hb H. apply Rnot_lt_le. intros C. nra. Qed.

(** |d| |e| = |q| for d e = q; a lower bound of |d|^2 is an upper bound of |e|. *)
Lemma quotient_bound (d e q : C) L : 0 <= L -> L ^ 2 <= Cmod d ^ 2 -> (d * e)%C = q -> Cmod e * L <= Cmod q.
Proof.
  intros HL Hd E. rewrite <- E, Cmod_mult, Rmult_comm. apply Rmult_le_compat_r; [apply Cmod_ge_0|].
  apply square_le; [apply Cmod_ge_0 | exact Hd].
Qed.

Section Transfers.
Variables sigma om mu b eta : R.
Hypothesis sigma_pos : 0 < sigma.

(** Y = b mu G/i. With g_N of section 2, G = (i/w) g_N, this is b nu g_N. *)
Let Y := b * mu * eta.

(** The denominator of 13.1, with kap e added (10.4; kap = 0 otherwise):
    i om + b sigma + kap + b mu (i om + sigma) G, where G = i eta. *)
Definition denominator (kap : R) : C :=
  (Ci * om + (b * sigma + kap)%R + (b * mu)%R * (Ci * om + sigma) * (Ci * eta))%C.

Lemma denominator2 kap : Cmod (denominator kap) ^ 2 = (b * sigma + kap - Y * om) ^ 2 + (om + Y * sigma) ^ 2.
Proof. rewrite Cmod2. unfold denominator, Y; simpl. ring. Qed.

(** Its smallest value over all real G/i. *)
Lemma denominator_min kap :
  ((b * sigma + kap) * sigma + om ^ 2) ^ 2 <= Cmod (denominator kap) ^ 2 * (sigma ^ 2 + om ^ 2).
Proof.
  rewrite denominator2. set (be := b * sigma + kap).
  replace (((be - Y * om) ^ 2 + (om + Y * sigma) ^ 2) * (sigma ^ 2 + om ^ 2))
    with ((be * sigma + om ^ 2) ^ 2 + (om * sigma + Y * (sigma ^ 2 + om ^ 2) - be * om) ^ 2) by ring.
  pose proof (pow2_ge_0 (om * sigma + Y * (sigma ^ 2 + om ^ 2) - be * om)). lra.
Qed.

Let so := sigma ^ 2 + om ^ 2.
Lemma so_pos : 0 < sigma ^ 2 + om ^ 2.
Proof. pose proof (pow2_ge_0 om). nra. Qed.

Lemma sqrt_so2 : sqrt (sigma ^ 2 + om ^ 2) ^ 2 = sigma ^ 2 + om ^ 2.
Proof. rewrite <- Rsqr_pow2, Rsqr_sqrt; [reflexivity | left; apply so_pos]. Qed.

(** 13.1: |e_j| (b sigma^2 + om^2) <= |q_j| sqrt(sigma^2 + om^2). *)
Theorem e_bound (e q : C) : 0 < b -> (denominator 0 * e)%C = q ->
  Cmod e <= Cmod q * sqrt (sigma ^ 2 + om ^ 2) / (b * sigma ^ 2 + om ^ 2).
Proof.
  intros Hb E. pose proof so_pos as Hso. pose proof (pow2_ge_0 om) as Hom.
  assert (Hd : 0 < b * sigma ^ 2 + om ^ 2) by (assert (0 < b * sigma ^ 2) by (apply Rmult_lt_0_compat; nra); lra).
  assert (Hr : 0 < sqrt (sigma ^ 2 + om ^ 2)) by (apply sqrt_lt_R0, Hso).
  set (L := (b * sigma ^ 2 + om ^ 2) / sqrt (sigma ^ 2 + om ^ 2)).
  assert (HL : 0 < L) by (apply Rdiv_lt_0_compat; assumption).
  assert (Q : Cmod e * L <= Cmod q).
  { apply (quotient_bound (denominator 0) e q L); [lra | | exact E].
    unfold L. rewrite Rpow_div_distr || replace ((((b * sigma ^ 2 + om ^ 2) / sqrt (sigma ^ 2 + om ^ 2)) ^ 2))
      with ((b * sigma ^ 2 + om ^ 2) ^ 2 / sqrt (sigma ^ 2 + om ^ 2) ^ 2) by (field; lra).
    rewrite sqrt_so2. apply div_le; [exact Hso|]. pose proof (denominator_min 0) as M.
    replace ((b * sigma + 0) * sigma + om ^ 2) with (b * sigma ^ 2 + om ^ 2) in M by ring. exact M. }
  apply le_div; [exact Hd|]. replace (b * sigma ^ 2 + om ^ 2) with (L * sqrt (sigma ^ 2 + om ^ 2)) by (unfold L; field; lra).
  rewrite <- Rmult_assoc. apply Rmult_le_compat_r; [lra | exact Q].
Qed.

(** 13.1: so |e_j| <= |q_j|/(bm sqrt(sigma^2 + om^2)) for every bm <= min(1, b). *)
Theorem e_bound_bm (e q : C) bm : 0 < bm <= 1 -> bm <= b -> (denominator 0 * e)%C = q ->
  Cmod e <= Cmod q / (bm * sqrt (sigma ^ 2 + om ^ 2)).
Proof.
  intros Hbm Hb E. apply Rle_trans with (1 := e_bound e q ltac:(lra) E).
  pose proof so_pos as Hso. pose proof (pow2_ge_0 om) as Hom. pose proof (Cmod_ge_0 q) as Hq.
  assert (Hr : 0 < sqrt (sigma ^ 2 + om ^ 2)) by (apply sqrt_lt_R0, Hso).
  pose proof sqrt_so2 as E2. set (r := sqrt (sigma ^ 2 + om ^ 2)) in *.
  assert (Hd : bm * r ^ 2 <= b * sigma ^ 2 + om ^ 2) by (rewrite E2; nra).
  assert (Hd0 : 0 < bm * r ^ 2) by (apply Rmult_lt_0_compat; nra).
  replace (Cmod q / (bm * r)) with (Cmod q * r / (bm * r ^ 2)) by (field; lra).
  unfold Rdiv. apply Rmult_le_compat_l; [apply Rmult_le_pos; lra|]. apply Rinv_le_contravar; assumption.
Qed.

(** 10.2: with b = 1, |e_j| <= |q_j|/sqrt(sigma^2 + om^2). *)
Theorem e_bound_unit (e q : C) : b = 1 -> (denominator 0 * e)%C = q -> Cmod e <= Cmod q / sqrt (sigma ^ 2 + om ^ 2).
Proof.
  intros Hb E. pose proof (e_bound_bm e q 1 ltac:(lra) ltac:(lra) E) as H. rewrite Rmult_1_l in H. exact H.
Qed.

(** 13.1, 10.4: |om e_j| <= d_b |q_j| with d_b = 1 for b >= 1/2, else 1/(2 sqrt(b(1-b))); for every kap >= 0. *)
Definition d_ (b : R) : R := if Rle_dec (1 / 2) b then 1 else / (2 * sqrt (b * (1 - b))).

Theorem om_e_bound (e q : C) kap : 0 < b -> 0 <= kap -> (denominator kap * e)%C = q ->
  Rabs om * Cmod e <= d_ b * Cmod q.
Proof.
  intros Hb Hk E. pose proof so_pos as Hso. pose proof (pow2_ge_0 om) as Hom. pose proof (denominator_min kap) as M.
  set (u := om ^ 2) in *. set (v := sigma ^ 2) in *. assert (Hv : 0 < v) by (unfold v; nra).
  assert (M2 : (b * v + u) ^ 2 <= Cmod (denominator kap) ^ 2 * (v + u)).
  { apply Rle_trans with (2 := M). apply pow_incr. unfold v. split; [nra|]. assert (0 <= kap * sigma) by nra. nra. }
  assert (Hd : 0 < d_ b /\ u * (v + u) <= d_ b ^ 2 * (b * v + u) ^ 2).
  { unfold d_. destruct (Rle_dec (1 / 2) b) as [B|B].
    - split; [lra|]. assert (0 <= (2 * b - 1) * (u * v)) by (apply Rmult_le_pos; [lra | apply Rmult_le_pos; lra]).
      pose proof (pow2_ge_0 (b * v)). lra.
    - assert (P : 0 < b * (1 - b)) by nra. assert (Hs : 0 < sqrt (b * (1 - b))) by (apply sqrt_lt_R0, P).
      split; [apply Rinv_0_lt_compat; lra|].
      replace ((/ (2 * sqrt (b * (1 - b)))) ^ 2) with (/ (4 * sqrt (b * (1 - b)) ^ 2)) by (field; lra).
      replace (sqrt (b * (1 - b)) ^ 2) with (b * (1 - b)) by (rewrite <- Rsqr_pow2, Rsqr_sqrt; lra).
      apply Rle_trans with ((b * v + u) ^ 2 / (4 * (b * (1 - b)))); [|right; unfold Rdiv; ring].
      apply le_div; [lra|].
      pose proof (pow2_ge_0 ((1 - 2 * b) * u - b * v)). nra. }
  destruct Hd as [Hd1 Hd2].
  assert (HL : (Rabs om / d_ b) ^ 2 <= Cmod (denominator kap) ^ 2).
  { replace ((Rabs om / d_ b) ^ 2) with (u / d_ b ^ 2) by (unfold u; rewrite <- (pow2_abs om); field; lra).
    assert (0 < d_ b ^ 2) by (apply pow_lt; lra).
    apply div_le; [assumption|]. apply Rmult_le_reg_r with (v + u); [lra|].
    apply Rle_trans with (1 := Hd2). apply Rle_trans with (d_ b ^ 2 * (Cmod (denominator kap) ^ 2 * (v + u))).
    - apply Rmult_le_compat_l; lra.
    - right. ring. }
  pose proof (quotient_bound _ e q (Rabs om / d_ b)
    ltac:(apply Rmult_le_pos; [apply Rabs_pos | left; apply Rinv_0_lt_compat; lra]) HL E) as Q.
  apply Rle_trans with (d_ b * (Cmod e * (Rabs om / d_ b))).
  - right. field. lra.
  - apply Rmult_le_compat_l; lra.
Qed.

(** 13.1: |y_j|^2 c_b^2 (1 + Y^2) <= |q_j|^2, where y_j = (i om + sigma) e_j, Y = b nu g_N, c_b^2 = b^2 for b <= 1 and 4/(3+b) for b > 1. *)
Definition c2_ (b : R) : R := if Rle_dec b 1 then b ^ 2 else 4 / (3 + b).

Lemma denominator_y : 0 < b ->
  c2_ b * (1 + Y ^ 2) * (sigma ^ 2 + om ^ 2) <= Cmod (denominator 0) ^ 2.
Proof.
  intros Hb. rewrite denominator2. unfold c2_. destruct (Rle_dec b 1) as [B|B].
  - assert (E : (b * sigma + 0 - Y * om) ^ 2 + (om + Y * sigma) ^ 2 - b ^ 2 * (1 + Y ^ 2) * (sigma ^ 2 + om ^ 2)
      = (1 - b) * ((om + Y * sigma) ^ 2 + b * om ^ 2 + b * (Y * sigma) ^ 2 + (1 + b) * (Y * om) ^ 2)) by ring.
    assert (0 <= (1 - b) * ((om + Y * sigma) ^ 2 + b * om ^ 2 + b * (Y * sigma) ^ 2 + (1 + b) * (Y * om) ^ 2)).
    { apply Rmult_le_pos; [lra|]. pose proof (pow2_ge_0 (om + Y * sigma)). pose proof (pow2_ge_0 om).
      pose proof (pow2_ge_0 (Y * sigma)). pose proof (pow2_ge_0 (Y * om)). nra. }
    lra.
  - assert (Hb1 : 1 < b) by lra.
    replace (4 / (3 + b) * (1 + Y ^ 2) * (sigma ^ 2 + om ^ 2)) with (4 * (1 + Y ^ 2) * (sigma ^ 2 + om ^ 2) / (3 + b)) by (field; lra).
    apply div_le; [lra|].
    assert (E : ((b * sigma + 0 - Y * om) ^ 2 + (om + Y * sigma) ^ 2) * (3 + b) - 4 * (1 + Y ^ 2) * (sigma ^ 2 + om ^ 2)
      = (b - 1) * (((b + 2) * sigma - Y * om) ^ 2 + (om - Y * sigma) ^ 2)) by ring.
    assert (0 <= (b - 1) * (((b + 2) * sigma - Y * om) ^ 2 + (om - Y * sigma) ^ 2)).
    { apply Rmult_le_pos; [lra|]. pose proof (pow2_ge_0 ((b + 2) * sigma - Y * om)). pose proof (pow2_ge_0 (om - Y * sigma)). lra. }
    lra.
Qed.

Lemma c2_pos : 0 < b -> 0 < c2_ b.
Proof. intros Hb. unfold c2_. destruct (Rle_dec b 1); [nra | apply Rdiv_lt_0_compat; lra]. Qed.

Theorem y_bound (e q y : C) : 0 < b -> (denominator 0 * e)%C = q -> y = ((Ci * om + sigma) * e)%C ->
  Cmod y ^ 2 <= Cmod q ^ 2 / (c2_ b * (1 + (b * mu * eta) ^ 2)).
Proof.
  intros Hb E Ey. fold Y. pose proof (c2_pos Hb) as Hc. pose proof (pow2_ge_0 Y) as HY.
  apply le_div; [apply Rmult_lt_0_compat; lra|].
  rewrite Ey, Cmod_mult, Rpow_mult_distr. rewrite <- E, Cmod_mult, Rpow_mult_distr.
  assert (Es : Cmod (Ci * om + sigma)%C ^ 2 = sigma ^ 2 + om ^ 2) by (rewrite Cmod2; simpl; ring).
  rewrite Es. pose proof (denominator_y Hb) as D. pose proof (pow2_ge_0 (Cmod e)).
  replace ((sigma ^ 2 + om ^ 2) * Cmod e ^ 2 * (c2_ b * (1 + Y ^ 2)))
    with (c2_ b * (1 + Y ^ 2) * (sigma ^ 2 + om ^ 2) * Cmod e ^ 2) by ring.
  apply Rmult_le_compat_r; assumption.
Qed.

(** Section 3: with b = 1, |S| = |y_j/q_j| <= 1. *)
Theorem S_bound (e q y : C) : b = 1 -> (denominator 0 * e)%C = q -> y = ((Ci * om + sigma) * e)%C -> Cmod y <= Cmod q.
Proof.
  intros Hb E Ey. apply square_le; [apply Cmod_ge_0|].
  apply Rle_trans with (1 := y_bound e q y ltac:(lra) E Ey). unfold c2_. rewrite Hb.
  destruct (Rle_dec 1 1) as [_|N]; [|lra]. pose proof (pow2_ge_0 (1 * mu * eta)). pose proof (pow2_ge_0 (Cmod q)).
  apply div_le; nra.
Qed.

(** 10.4, 13.1: |e_j| <= g_k |q_j| where q_j - kap e_j drives the loop, for every b >= b_lo. *)
Definition g_k (b_lo kap : R) : R :=
  if Rle_dec kap ((2 - b_lo) * sigma) then / (b_lo * sigma + kap) else / (2 * sqrt (sigma * (kap - (1 - b_lo) * sigma))).

Theorem e_bound_kap (e q : C) b_lo kap : 0 < b_lo <= b -> 0 <= kap -> (denominator kap * e)%C = q ->
  Cmod e <= g_k b_lo kap * Cmod q.
Proof.
  intros Hb Hk E. pose proof so_pos as Hso. pose proof (pow2_ge_0 om) as Hom. pose proof (denominator_min kap) as M.
  set (u := om ^ 2) in *. assert (Hs2 : 0 < sigma ^ 2) by nra.
  set (be := b_lo * sigma + kap). assert (Hbe : 0 < be) by (unfold be; nra).
  assert (M2 : (be * sigma + u) ^ 2 <= Cmod (denominator kap) ^ 2 * (sigma ^ 2 + u)).
  { apply Rle_trans with (2 := M). apply pow_incr. unfold be. split; [nra|]. assert (b_lo * sigma ^ 2 <= b * sigma ^ 2) by nra. nra. }
  assert (Hg : 0 < g_k b_lo kap /\ sigma ^ 2 + u <= g_k b_lo kap ^ 2 * (be * sigma + u) ^ 2).
  { unfold g_k. fold be. destruct (Rle_dec kap ((2 - b_lo) * sigma)) as [B|B].
    - split; [apply Rinv_0_lt_compat, Hbe|].
      replace ((/ be) ^ 2 * (be * sigma + u) ^ 2) with ((be * sigma + u) ^ 2 / be ^ 2) by (field; lra).
      apply le_div; [apply pow_lt, Hbe|].
      assert (be <= 2 * sigma) by (unfold be; lra).
      assert (be ^ 2 * u <= 2 * sigma * be * u) by (apply Rmult_le_compat_r; nra).
      pose proof (pow2_ge_0 u). nra.
    - assert (P : 0 < kap - (1 - b_lo) * sigma) by (apply Rnot_le_lt in B; nra).
      assert (P2 : 0 < sigma * (kap - (1 - b_lo) * sigma)) by (apply Rmult_lt_0_compat; assumption).
      assert (Hs : 0 < sqrt (sigma * (kap - (1 - b_lo) * sigma))) by (apply sqrt_lt_R0, P2).
      split; [apply Rinv_0_lt_compat; lra|].
      replace ((/ (2 * sqrt (sigma * (kap - (1 - b_lo) * sigma)))) ^ 2)
        with (/ (4 * sqrt (sigma * (kap - (1 - b_lo) * sigma)) ^ 2)) by (field; lra).
      replace (sqrt (sigma * (kap - (1 - b_lo) * sigma)) ^ 2) with (sigma * (kap - (1 - b_lo) * sigma))
        by (rewrite <- Rsqr_pow2, Rsqr_sqrt; lra).
      replace (sigma * (kap - (1 - b_lo) * sigma)) with (be * sigma - sigma ^ 2) in * by (unfold be; ring).
      apply Rle_trans with ((be * sigma + u) ^ 2 / (4 * (be * sigma - sigma ^ 2))); [|right; unfold Rdiv; ring].
      apply le_div; [lra|].
      pose proof (pow2_ge_0 ((sigma ^ 2 + u) - (be * sigma - sigma ^ 2))). nra. }
  destruct Hg as [Hg1 Hg2].
  assert (HL : (/ g_k b_lo kap) ^ 2 <= Cmod (denominator kap) ^ 2).
  { replace ((/ g_k b_lo kap) ^ 2) with (1 / g_k b_lo kap ^ 2) by (field; lra).
    assert (0 < g_k b_lo kap ^ 2) by (apply pow_lt; lra).
    apply div_le; [assumption|]. apply Rmult_le_reg_r with (sigma ^ 2 + u); [lra|].
    rewrite Rmult_1_l. apply Rle_trans with (1 := Hg2).
    apply Rle_trans with (g_k b_lo kap ^ 2 * (Cmod (denominator kap) ^ 2 * (sigma ^ 2 + u))).
    - apply Rmult_le_compat_l; lra.
    - right. ring. }
  pose proof (quotient_bound _ e q (/ g_k b_lo kap) ltac:(left; apply Rinv_0_lt_compat; lra) HL E) as Q.
  apply Rle_trans with (g_k b_lo kap * (Cmod e * / g_k b_lo kap)).
  - right. field. lra.
  - apply Rmult_le_compat_l; lra.
Qed.

(** 13.5: |u_j| <= sqrt(lam_b) |q_j|/b, where i om e_j = q_j + b u_j. *)
Definition lam (b : R) : R := 1 + 2 / (4 * b - 1 + sqrt (1 + 8 * b)).

Theorem u_bound (e q u : C) : 0 < b -> (denominator 0 * e)%C = q -> (Ci * om * e = q + b * u)%C ->
  Cmod u <= sqrt (lam b) * Cmod q / b.
Proof.
  intros Hb E Eu. set (r := sqrt (1 + 8 * b)).
  assert (Er : r ^ 2 = 1 + 8 * b) by (unfold r; rewrite <- Rsqr_pow2, Rsqr_sqrt; lra).
  assert (Hr : 1 < r) by (unfold r; rewrite <- sqrt_1 at 1; apply sqrt_lt_1; lra).
  assert (Hlam : 0 < lam b) by (unfold lam; fold r; assert (0 < 2 / (4 * b - 1 + r)) by (apply Rdiv_lt_0_compat; lra); lra).
  assert (Eb : b = (r ^ 2 - 1) / 8) by lra.
  set (k := 4 / ((r - 1) * (r + 3))).
  assert (Hden : 0 < (r - 1) * (r + 3)) by nra.
  assert (Hk : 0 < k) by (apply Rdiv_lt_0_compat; lra).
  assert (Ek : lam b = 1 + k).
  { unfold lam. fold r. unfold k. replace (4 * b - 1 + r) with ((r - 1) * (r + 3) / 2) by (rewrite Eb; field). field. lra. }
  (* b u = i om e - q = - (denominator - i om) e *)
  assert (Ebu : (b * u = - ((denominator 0 - Ci * om) * e))%C).
  { replace (b * u)%C with (q + b * u - q)%C by ring. rewrite <- Eu, <- E. ring. }
  assert (N2 : Cmod (denominator 0 - Ci * om)%C ^ 2 = (b * sigma - Y * om) ^ 2 + (Y * sigma) ^ 2).
  { rewrite Cmod2. unfold denominator, Y; simpl. ring. }
  assert (Main : Cmod (denominator 0 - Ci * om)%C ^ 2 <= lam b * Cmod (denominator 0) ^ 2).
  { rewrite N2, denominator2, Ek, Rplus_0_r.
    set (al := 2 * (r + 1) / ((r - 1) * (r + 3))).
    assert (Id : k * (om ^ 2 + sigma ^ 2) * ((1 + k) * ((b * sigma - Y * om) ^ 2 + (om + Y * sigma) ^ 2) - ((b * sigma - Y * om) ^ 2 + (Y * sigma) ^ 2))
      = (k * (om ^ 2 + sigma ^ 2) * Y + sigma * om * (1 + k - k * b)) ^ 2 + (al * om ^ 2 - k * b * sigma ^ 2) ^ 2).
    { unfold k, al. rewrite Eb. field. lra. }
    assert (P : 0 < k * (om ^ 2 + sigma ^ 2)) by (pose proof so_pos; apply Rmult_lt_0_compat; lra).
    pose proof (pow2_ge_0 (k * (om ^ 2 + sigma ^ 2) * Y + sigma * om * (1 + k - k * b))).
    pose proof (pow2_ge_0 (al * om ^ 2 - k * b * sigma ^ 2)).
    apply Rnot_lt_le. intros C. nra. }
  assert (Q : Cmod (b * u)%C ^ 2 <= (sqrt (lam b) * Cmod q) ^ 2).
  { rewrite Ebu, Cmod_opp, Cmod_mult, !Rpow_mult_distr, <- E, Cmod_mult, Rpow_mult_distr.
    replace (sqrt (lam b) ^ 2) with (lam b) by (rewrite <- Rsqr_pow2, Rsqr_sqrt; lra).
    rewrite <- Rmult_assoc. apply Rmult_le_compat_r; [apply pow2_ge_0 | exact Main]. }
  apply square_le in Q; [|apply Rmult_le_pos; [apply sqrt_pos | apply Cmod_ge_0]].
  rewrite Cmod_mult, Cmod_R, Rabs_right in Q by lra. apply le_div; lra.
Qed.

End Transfers.

(** 13.5: lam_1 = 4/3, and lam_b decreases in b. *)
Theorem lam_unit : lam 1 = 4 / 3.
Proof.
  unfold lam. replace (1 + 8 * 1) with (3 * 3) by ring. rewrite sqrt_square by lra. field.
Qed.

Theorem lam_decreases b b' : 0 < b <= b' -> lam b' <= lam b.
Proof.
  intros Hb. unfold lam. apply Rplus_le_compat_l. unfold Rdiv. apply Rmult_le_compat_l; [lra|].
  assert (1 <= sqrt (1 + 8 * b)) by (rewrite <- sqrt_1 at 1; apply sqrt_le_1_alt; lra).
  assert (sqrt (1 + 8 * b) <= sqrt (1 + 8 * b')) by (apply sqrt_le_1_alt; lra).
  apply Rinv_le_contravar; lra.
Qed.

(** 13.1: over an interval of gains the worst c_b is at one of its ends, and the worst d_b at b_lo; b c_b^2 >= b_lo^3. *)
Theorem c2_ends b_lo b_hi b : 0 < b_lo <= 1 -> 1 <= b_hi -> b_lo <= b <= b_hi -> Rmin (c2_ b_lo) (c2_ b_hi) <= c2_ b.
Proof.
  intros H1 H2 Hb. unfold c2_ at 3. destruct (Rle_dec b 1) as [B|B].
  - apply Rle_trans with (1 := Rmin_l _ _). unfold c2_. destruct (Rle_dec b_lo 1) as [_|N]; [|lra]. apply pow_incr. lra.
  - apply Rle_trans with (1 := Rmin_r _ _). unfold c2_. destruct (Rle_dec b_hi 1) as [N|_]; [lra|].
    unfold Rdiv. apply Rmult_le_compat_l; [lra|]. apply Rinv_le_contravar; lra.
Qed.

Theorem b_c2 b_lo b : 0 < b_lo <= 1 -> b_lo <= b -> b_lo ^ 3 <= b * c2_ b.
Proof.
  intros H1 Hb. unfold c2_. destruct (Rle_dec b 1) as [B|B].
  - replace (b * b ^ 2) with (b ^ 3) by ring. apply pow_incr. lra.
  - apply Rle_trans with 1.
    + rewrite <- (pow1 3). apply pow_incr. lra.
    + replace (b * (4 / (3 + b))) with (4 * b / (3 + b)) by (field; lra). apply le_div; lra.
Qed.

Theorem d_decreases b_lo b : 0 < b_lo <= b -> d_ b <= d_ b_lo.
Proof.
  intros Hb. unfold d_. destruct (Rle_dec (1 / 2) b) as [B|B]; destruct (Rle_dec (1 / 2) b_lo) as [L|L]; try lra.
  - assert (P : 0 < b_lo * (1 - b_lo)) by nra. assert (S : 0 < sqrt (b_lo * (1 - b_lo))) by (apply sqrt_lt_R0, P).
    assert (sqrt (b_lo * (1 - b_lo)) <= / 2).
    { rewrite <- (sqrt_pow2 (/ 2)) by lra. apply sqrt_le_1_alt. pose proof (pow2_ge_0 (b_lo - / 2)). lra. }
    rewrite <- Rinv_1 at 1. apply Rinv_le_contravar; lra.
  - assert (P : 0 < b_lo * (1 - b_lo)) by nra. assert (S : 0 < sqrt (b_lo * (1 - b_lo))) by (apply sqrt_lt_R0, P).
    apply Rinv_le_contravar; [lra|]. apply Rmult_le_compat_l; [lra|]. apply sqrt_le_1_alt. nra.
Qed.
