(** Section 2.2 (ii): one scalar test at m_0 bounds T_N for every real x >= m_0 - 1/2 and every N. *)

From Coq Require Import Reals ZArith Lra Lia.
From Coquelicot Require Import Rcomplements.
From SigmaStar Require Import Sums Weights Transfer Squares Poles Enclose.
Local Open Scope R_scope.

Lemma pi_square : 9 <= PI ^ 2.
Proof. interval with (i_prec 60). Qed.

Section Far.
Variable n : nat -> R.
Variable nu : R.
Hypothesis H : weights n.
Hypothesis nu_pos : 0 < nu.

Let n_pos := n_pos n H.

Lemma A_decreases m m' : 1 <= m <= m' -> A_ n m' <= A_ n m.
Proof.
  intros Hm. unfold A_. apply Rplus_le_compat_l. unfold Rdiv.
  pose proof (W4 n H). pose proof (n_pos 1%nat).
  apply Rmult_le_compat_l; [lra|]. apply Rinv_le_contravar; [apply pow_lt; lra|]. apply pow_incr. lra.
Qed.

Lemma Rh_decreases m m' : 1 <= m <= m' -> Rh n m' <= Rh n m.
Proof.
  intros Hm. unfold Rh. pose proof (n_pos O). pose proof (n_pos 1%nat) as H1.
  assert (L0 : 0 <= ln m) by (rewrite <- ln_1; apply ln_mono; lra).
  assert (L1 : ln m' <= ln m + (m' - m) / m).
  { pose proof (Weights.ln_le (m' / m) ltac:(apply Rdiv_lt_0_compat; lra)) as L.
    unfold Rdiv in L at 1. rewrite ln_mult, ln_Rinv in L; try lra; [|apply Rinv_0_lt_compat; lra].
    replace ((m' - m) / m) with (m' / m - 1) by (field; lra). lra. }
  assert (Q : (2.35 + 1.5 * ln m') * (m - 1 / 2) <= (2.35 + 1.5 * ln m) * (m' - 1 / 2)).
  { apply Rle_trans with ((2.35 + 1.5 * (ln m + (m' - m) / m)) * (m - 1 / 2)).
    { apply Rmult_le_compat_r; lra. }
    assert (Y : (m - 1 / 2) / m <= 1) by (apply div_le; lra).
    replace ((2.35 + 1.5 * (ln m + (m' - m) / m)) * (m - 1 / 2))
      with ((2.35 + 1.5 * ln m) * (m - 1 / 2) + 1.5 * (m' - m) * ((m - 1 / 2) / m)) by (field; lra).
    assert (1.5 * (m' - m) * ((m - 1 / 2) / m) <= 1.5 * (m' - m) * 1) by (apply Rmult_le_compat_l; lra).
    assert (0 <= ln m * (m' - m)) by (apply Rmult_le_pos; lra). nra. }
  apply Rplus_le_compat.
  - apply div_le; [lra|].
    replace ((n O + n 1%nat * (2.35 + 1.5 * ln m)) / (m - 1 / 2) * (m' - 1 / 2))
      with ((n O + n 1%nat * (2.35 + 1.5 * ln m)) * (m' - 1 / 2) / (m - 1 / 2)) by (field; lra).
    apply le_div; [lra|].
    assert (n 1%nat * ((2.35 + 1.5 * ln m') * (m - 1 / 2)) <= n 1%nat * ((2.35 + 1.5 * ln m) * (m' - 1 / 2)))
      by (apply Rmult_le_compat_l; lra).
    assert (n O * (m - 1 / 2) <= n O * (m' - 1 / 2)) by (apply Rmult_le_compat_l; lra). lra.
  - unfold Rdiv. apply Rmult_le_compat_l; [lra|]. apply Rinv_le_contravar; nra.
Qed.

Lemma Rh_pos m : 1 <= m -> 0 < Rh n m.
Proof.
  intros Hm. unfold Rh. pose proof (n_pos O). pose proof (n_pos 1%nat) as H1.
  assert (L0 : 0 <= ln m) by (rewrite <- ln_1; apply ln_mono; lra).
  apply Rplus_lt_0_compat; apply Rdiv_lt_0_compat; nra.
Qed.

(** Half a unit beyond the last pole, and further. *)
Lemma beyond_le N x : INR N + 1 / 2 <= x ->
  T n nu N x <= (n O - n 1%nat / 2) / x ^ 2 + PI ^ 2 / 4 * n 1%nat.
Proof.
  intros Hx. pose proof (pos_INR N). pose proof (n_pos 1%nat) as H1.
  apply Rle_trans with (1 := T_le_g' n nu n_pos N x (beyond_regular N x ltac:(lra))).
  set (q := fun l => n 1%nat / 2 * / (IZR l - x) ^ 2).
  assert (E1 : g' n N x <= zsum N (fun l => q l + (if Z.eq_dec l 0 then (n O - n 1%nat / 2) / x ^ 2 else 0))).
  { apply zsum_le. intros l Hl. unfold q. destruct (Z.eq_dec l 0) as [->|E0].
    - unfold c; simpl Z.eq_dec. right. simpl. field. lra.
    - pose proof (c_le n H l E0). pose proof (beyond_gap N x l ltac:(lra) Hl).
      rewrite Rplus_0_r. unfold Rdiv at 1. apply Rmult_le_compat_r; [|assumption].
      left. apply Rinv_0_lt_compat. replace ((IZR l - x) ^ 2) with ((x - IZR l) ^ 2) by ring.
      apply pow_lt. lra. }
  rewrite zsum_plus, zsum_at_0 in E1.
  assert (E2 : zsum N q <= n 1%nat / 2 * (PI ^ 2 / 2)).
  { rewrite (zsum_sides N N q) by lia. rewrite Nat.sub_diag. cbn [sum]. rewrite Rplus_0_r.
    apply Rle_trans with (sum (S (N + N)) (fun i => n 1%nat / 2 * / (INR i + 1 / 2) ^ 2)).
    - rewrite sum_first. apply Rplus_le_compat.
      + unfold q. rewrite <- INR_IZR_INZ. apply Rmult_le_compat_l; [lra|].
        change (INR 0) with 0. apply Rinv_le_contravar; [apply pow_lt; lra|].
        replace ((INR N - x) ^ 2) with ((x - INR N) ^ 2) by ring. apply pow_incr. lra.
      + apply sum_le. intros i _. unfold q. rewrite !minus_IZR, <- !INR_IZR_INZ, S_INR. pose proof (pos_INR i).
        apply Rmult_le_compat_l; [lra|]. apply Rinv_le_contravar; [apply pow_lt; lra|].
        replace ((INR N - 1 - INR i - x) ^ 2) with ((x - INR N + 1 + INR i) ^ 2) by ring. apply pow_incr. lra.
    - rewrite sum_scal. apply Rmult_le_compat_l; [lra|]. apply half_squares. }
  lra.
Qed.

(** The integer nearest to x. *)
Lemma nearest m0 x : (1 <= m0)%nat -> INR m0 - 1 / 2 <= x ->
  exists m, (m0 <= m)%nat /\ Rabs (x - INR m) <= 1 / 2.
Proof.
  intros Hm Hx. assert (1 <= INR m0) by (apply (le_INR 1); lia).
  pose proof (base_Int_part (x + 1 / 2)) as [P1 P2]. set (k := Int_part (x + 1 / 2)) in *.
  assert (Hk : (Z.of_nat m0 <= k)%Z).
  { apply Z.lt_succ_r. apply lt_IZR. rewrite succ_IZR, <- INR_IZR_INZ. lra. }
  exists (Z.to_nat k). split; [lia|].
  rewrite INR_IZR_INZ, Z2Nat.id by lia. apply Rabs_le_between. lra.
Qed.

(** The proposition of section 2.2 (ii). Hypotheses: W1 to W4, nu > 0, an integer m_0 >= 1, and three inequalities at m_0.
    That k_0 is at least 1/(nu^2 n_0) is not used. *)
Theorem far_test (k0 k1 : R) (m0 : nat) :
  (1 <= m0)%nat ->
  let m := INR m0 in
  let a := m ^ 2 * n m0 in
  let b := m * n m0 in
  let s := Rmax (A_ n m - k0) 0 in
  let d := sqrt (b / (2 * m * (k1 * (m - 1 / 2) ^ 2 - s))) in
  s < k1 * (m - 1 / 2) ^ 2 ->
  d <= 1 / 2 ->
  2 / a * (1 / nu ^ 2 + Rh n m ^ 2) + s / m ^ 2 <= k1 * (1 - d / m) ^ 2 ->
  forall N x, m - 1 / 2 <= x -> T n nu N x <= k0 + k1 * x ^ 2.
Proof.
  intros Hm0 m a b s d T1 T2 T3 N x Hx.
  assert (Hm : 1 <= m) by (apply (le_INR 1); exact Hm0).
  assert (Hs : 0 <= s) by apply Rmax_r.
  assert (HA : A_ n m <= k0 + s) by (pose proof (Rmax_l (A_ n m - k0) 0); unfold s; lra).
  assert (Hb : 0 < b) by (apply Rmult_lt_0_compat; [lra | apply n_pos]).
  assert (Ha : 0 < a) by (apply Rmult_lt_0_compat; [apply pow_lt; lra | apply n_pos]).
  set (D := k1 * (m - 1 / 2) ^ 2 - s) in *. assert (HD : 0 < D) by (unfold D; lra).
  assert (Hd2 : d ^ 2 = b / (2 * m * D)).
  { unfold d. rewrite <- Rsqr_pow2, Rsqr_sqrt; [reflexivity|]. left. apply Rdiv_lt_0_compat; nra. }
  assert (Hd : 0 < d) by (apply sqrt_lt_R0; apply Rdiv_lt_0_compat; nra).
  assert (Hk1 : 0 < k1).
  { assert (0 < (m - 1 / 2) ^ 2) by (apply pow_lt; lra). apply Rnot_le_lt. intros E. nra. }
  assert (Hx2 : k1 * (m - 1 / 2) ^ 2 <= k1 * x ^ 2) by (apply Rmult_le_compat_l; [lra|]; apply pow_incr; lra).
  assert (nu2 : 0 < nu ^ 2) by (apply pow_lt, nu_pos).
  destruct (nearest m0 x Hm0 Hx) as [j [Hj Hjx]].
  assert (Hmj : m <= INR j) by (apply le_INR; exact Hj).
  destruct (le_lt_dec j N) as [L|L].
  - assert (HR' : Rest' n (Z.of_nat j) N x <= k0 + s).
    { apply Rle_trans with (1 := Rest'_le n H j N x ltac:(lia) Hjx).
      apply Rle_trans with (2 := HA). apply A_decreases. lra. }
    destruct (Rle_lt_dec (Rabs (x - INR j)) d) as [C|C].
    + (* near the pole: Lemma T and W3 *)
      pose proof (Lemma_T n nu n_pos nu_pos (Z.of_nat j) N x ltac:(lia)) as LT.
      rewrite <- INR_IZR_INZ in LT. specialize (LT Hjx). rewrite c_nat in LT by lia.
      pose proof (Rest_le n H j N x ltac:(lia) Hjx) as HR.
      assert (HR2 : Rest n (Z.of_nat j) N x ^ 2 <= Rh n m ^ 2).
      { rewrite <- (pow2_abs (Rest n (Z.of_nat j) N x)). apply pow_incr. split; [apply Rabs_pos|].
        apply Rle_trans with (1 := HR). apply Rh_decreases. lra. }
      set (J := INR j) in *. set (r := Rest n (Z.of_nat j) N x) in *.
      assert (Ba : a <= J ^ 2 * n j) by (apply W3_le; [exact H | lia]).
      assert (Hnj := n_pos j).
      assert (Q1 : (1 / nu ^ 2 + r ^ 2) / (n j / 2) <= 2 * J ^ 2 / a * (1 / nu ^ 2 + Rh n m ^ 2)).
      { assert (0 < 1 / nu ^ 2) by (apply Rdiv_lt_0_compat; lra). pose proof (pow2_ge_0 r).
        replace ((1 / nu ^ 2 + r ^ 2) / (n j / 2)) with (2 / n j * (1 / nu ^ 2 + r ^ 2)) by (field; lra).
        apply Rmult_le_compat; [left; apply Rdiv_lt_0_compat; lra | lra | | lra].
        apply div_le; [exact Hnj|].
        replace (2 * J ^ 2 / a * n j) with (2 * (J ^ 2 * n j) / a) by (field; lra). apply le_div; lra. }
      assert (Q2 : (1 - d / m) ^ 2 <= (1 - d / J) ^ 2).
      { assert (d / J <= d / m) by (unfold Rdiv; apply Rmult_le_compat_l; [lra|]; apply Rinv_le_contravar; lra).
        assert (d / m <= 1) by (apply div_le; lra). apply pow_incr. lra. }
      assert (Q3 : s <= s / m ^ 2 * J ^ 2).
      { replace (s / m ^ 2 * J ^ 2) with (s * (J ^ 2 / m ^ 2)) by (field; lra).
        rewrite <- (Rmult_1_r s) at 1. apply Rmult_le_compat_l; [exact Hs|].
        apply le_div; [apply pow_lt; lra|]. rewrite Rmult_1_l. apply pow_incr. lra. }
      assert (Q4 : (J - d) ^ 2 <= x ^ 2).
      { apply pow_incr. apply Rabs_le_between in C. lra. }
      assert (HJ2 : 0 < J ^ 2) by (apply pow_lt; lra).
      assert (Q5 : J ^ 2 * (2 / a * (1 / nu ^ 2 + Rh n m ^ 2) + s / m ^ 2) <= J ^ 2 * (k1 * (1 - d / J) ^ 2)).
      { apply Rmult_le_compat_l; [lra|]. apply Rle_trans with (1 := T3). apply Rmult_le_compat_l; lra. }
      replace (J ^ 2 * (k1 * (1 - d / J) ^ 2)) with (k1 * (J - d) ^ 2) in Q5 by (field; lra).
      assert (Q6 : k1 * (J - d) ^ 2 <= k1 * x ^ 2) by (apply Rmult_le_compat_l; lra).
      replace (2 * J ^ 2 / a * (1 / nu ^ 2 + Rh n m ^ 2))
        with (J ^ 2 * (2 / a * (1 / nu ^ 2 + Rh n m ^ 2))) in Q1 by (field; lra).
      lra.
    + (* away from it: W2 *)
      assert (Hne : x <> INR j) by (intros E; rewrite E, Rminus_diag_eq, Rabs_R0 in C; [lra | reflexivity]).
      assert (Reg : regular N x).
      { apply near_pole_regular with (m := Z.of_nat j); rewrite <- INR_IZR_INZ; [lra | exact Hne]. }
      apply Rle_trans with (1 := T_le_g' n nu n_pos N x Reg).
      unfold g'. rewrite (zsum_without N (Z.of_nat j)) by lia.
      fold (Rest' n (Z.of_nat j) N x). rewrite c_nat, <- INR_IZR_INZ by lia.
      assert (Q1 : n j / 2 / (INR j - x) ^ 2 <= D).
      { assert (Bb : INR j * n j <= b) by (apply W2_le; [exact H | lia]).
        assert (Hnj : n j <= b / m).
        { apply le_div; [lra|]. pose proof (n_pos j). nra. }
        assert (d ^ 2 <= (INR j - x) ^ 2).
        { replace ((INR j - x) ^ 2) with (Rabs (x - INR j) ^ 2) by (rewrite pow2_abs; ring).
          apply pow_incr. lra. }
        assert (0 < d ^ 2) by (apply pow_lt; lra).
        apply div_le; [lra|]. apply Rle_trans with (D * d ^ 2); [|apply Rmult_le_compat_l; lra].
        rewrite Hd2. replace (D * (b / (2 * m * D))) with (b / m / 2) by (field; lra). lra. }
      unfold D in Q1. lra.
  - (* beyond the last pole *)
    assert (HN : INR N + 1 / 2 <= x).
    { assert (INR N + 1 <= INR j) by (rewrite <- S_INR; apply le_INR; lia). apply Rabs_le_between in Hjx. lra. }
    apply Rle_trans with (1 := beyond_le N x HN).
    pose proof pi_square. pose proof (n_pos 1%nat). pose proof (W4 n H).
    assert (Q1 : (n O - n 1%nat / 2) / x ^ 2 <= (n O - n 1%nat / 2) / (m - 1 / 2) ^ 2).
    { unfold Rdiv. apply Rmult_le_compat_l; [lra|]. apply Rinv_le_contravar; [apply pow_lt; lra|]. apply pow_incr. lra. }
    unfold A_ in HA. nra.
Qed.

End Far.
