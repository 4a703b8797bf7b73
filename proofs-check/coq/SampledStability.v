(** Section 12.3: C5h implies that U^t <= U_k for every t in (0, h]. *)

From Coq Require Import Reals Lra Lia.
From Coquelicot Require Import Rcomplements.
From SigmaStar Require Import Sums Forms.
Local Open Scope R_scope.

Section Sampled.
Variables (w_x a_2 P_up k_f k_x k_l m k_e sigma h K Nb2 eta k_p : R).
Hypothesis w_x_pos : 0 < w_x.
Hypothesis k_f_nonneg : 0 <= k_f.
Hypothesis k_x_nonneg : 0 <= k_x.
Hypothesis k_e_nonneg : 0 <= k_e.
Hypothesis h_pos : 0 < h.
Hypothesis K_pos : 0 < K.
Hypothesis eta_pos : 0 < eta.
Hypothesis k_p_pos : 0 < k_p.

(** S0: K h Nb2 < 2, and 1 + theta = 1/(1 - K h Nb2/2). *)
Hypothesis S0 : K * h * Nb2 < 2.
Definition theta : R := / (1 - K * h * Nb2 / 2) - 1.

(** The functions of t of (12.6) and (12.7). *)
Definition g_ (t : R) : R := t * k_e / (sqrt 12 * k_p).
Definition root (t : R) : R := sqrt (1 - t * sigma + (t * sigma) ^ 2 / 3).
Definition c_X (t : R) : R := t * k_x / (PI * k_p).
Definition c_E (t : R) : R := root t + t * k_e / (PI * k_p).
Definition c_Y (t : R) : R := t / (sqrt 3 * k_p).
Definition D_t (t : R) : R :=
  Rmax (Rabs (1 - t * sigma + eta / K * (1 - t * sigma / 2) * m))
       (Rabs (1 - t * sigma - eta / K * (1 - t * sigma / 2) * k_l)).

(** (12.7) *)
Definition Q (t X E Y : R) : R :=
  2 * w_x * a_2 * X ^ 2 - 2 * w_x * sqrt P_up * k_f * X * (c_X t * X + c_E t * E + c_Y t * Y)
  + sigma * (2 - t * sigma) * E ^ 2 - 2 * D_t t * E * Y
  + (2 * eta / K * (1 - t / h * (theta / (1 + theta))) - t - eta / K * t * m) * Y ^ 2
  - 2 * eta / K * Y * (k_x * (1 + g_ t) * X + g_ t * k_e * E + t ^ 2 * k_e ^ 2 / (6 * k_p) * Y).

Lemma theta_fraction : theta / (1 + theta) = K * h * Nb2 / 2.
Proof. unfold theta. field. lra. Qed.

(** One interval (0, t] of a sample, in error coordinates: what the plant, the regulator and (12.6) say of it. X is the rms of xi,
    re that of e, q_m the mean of q, and b = M'NM. *)
Record interval_at (t X xi2_k xi2_t e_k e_t V_k V_t y q_m re b d_l d_m p : R) : Prop := {
  X_nonneg : 0 <= X;
  xi_decay : xi2_t <= xi2_k + t * (- 2 * a_2 * X ^ 2 + 2 * sqrt P_up * k_f * X * re);
  re_bound : re <= c_X t * X + c_E t * Rabs e_k + c_Y t * Rabs y;
  e_step : e_t = (1 - t * sigma) * e_k + t * y;
  balance_t : V_t = V_k - 2 * t / K * ((1 - K * t * b / 2) * y ^ 2 - y * q_m);
  b_bound : b <= Nb2;
  mean_q : q_m = d_l * e_k + d_m * y + p;
  d_l_bound : - k_l * (1 - t * sigma / 2) <= d_l <= m * (1 - t * sigma / 2);
  d_m_bound : d_m <= t * m / 2;
  p_bound : Rabs p <= k_x * (1 + g_ t) * X + g_ t * k_e * Rabs e_k + t ^ 2 * k_e ^ 2 / (6 * k_p) * Rabs y
}.

Definition U_ (xi2 e V : R) : R := w_x * xi2 + e ^ 2 + eta * V.

(** (12.7): -(U^t - U_k)/t >= Q_t. *)
Theorem U_step t X xi2_k xi2_t e_k e_t V_k V_t y q_m re b d_l d_m p :
  0 < t <= h -> interval_at t X xi2_k xi2_t e_k e_t V_k V_t y q_m re b d_l d_m p ->
  U_ xi2_t e_t V_t <= U_ xi2_k e_k V_k - t * Q t X (Rabs e_k) (Rabs y).
Proof.
  intros Ht [HX Hxi Hre He HV Hb Hq Hdl Hdm Hp].
  set (E := Rabs e_k) in *. set (Y := Rabs y) in *. set (r := eta / K).
  assert (Hr : 0 < r) by (apply Rdiv_lt_0_compat; lra).
  assert (HE : 0 <= E) by apply Rabs_pos. assert (HY : 0 <= Y) by apply Rabs_pos.
  assert (E2 : e_k ^ 2 = E ^ 2) by (unfold E; rewrite pow2_abs; reflexivity).
  assert (Y2 : y ^ 2 = Y ^ 2) by (unfold Y; rewrite pow2_abs; reflexivity).
  assert (HS : 0 <= sqrt P_up) by apply sqrt_pos.
  (* x *)
  assert (B1 : w_x * xi2_t <= w_x * xi2_k
                + t * (- 2 * w_x * a_2 * X ^ 2 + 2 * w_x * sqrt P_up * k_f * X * (c_X t * X + c_E t * E + c_Y t * Y))).
  { apply Rle_trans with (w_x * (xi2_k + t * (- 2 * a_2 * X ^ 2 + 2 * sqrt P_up * k_f * X * re))).
    - apply Rmult_le_compat_l; lra.
    - assert (C : 2 * w_x * sqrt P_up * k_f * X * re <= 2 * w_x * sqrt P_up * k_f * X * (c_X t * X + c_E t * E + c_Y t * Y)).
      { apply Rmult_le_compat_l; [|exact Hre]. repeat apply Rmult_le_pos; lra. }
      assert (t * (2 * w_x * sqrt P_up * k_f * X * re)
              <= t * (2 * w_x * sqrt P_up * k_f * X * (c_X t * X + c_E t * E + c_Y t * Y)))
        by (apply Rmult_le_compat_l; lra). lra. }
  (* the cross term of e and y *)
  assert (B2 : (1 - t * sigma + r * d_l) * e_k * y <= D_t t * E * Y).
  { apply Rle_trans with (Rabs ((1 - t * sigma + r * d_l) * e_k * y)); [apply Rle_abs|].
    rewrite !Rabs_mult. fold E Y. rewrite !Rmult_assoc.
    apply Rmult_le_compat_r; [apply Rmult_le_pos; assumption|].
    assert (C1 := Rmax_l (Rabs (1 - t * sigma + eta / K * (1 - t * sigma / 2) * m))
                         (Rabs (1 - t * sigma - eta / K * (1 - t * sigma / 2) * k_l))).
    assert (C2 := Rmax_r (Rabs (1 - t * sigma + eta / K * (1 - t * sigma / 2) * m))
                         (Rabs (1 - t * sigma - eta / K * (1 - t * sigma / 2) * k_l))).
    fold (D_t t) r in C1, C2. apply Rabs_le_between in C1. apply Rabs_le_between in C2. apply Rabs_le_between.
    assert (r * d_l <= r * (m * (1 - t * sigma / 2))) by (apply Rmult_le_compat_l; lra).
    assert (r * (- k_l * (1 - t * sigma / 2)) <= r * d_l) by (apply Rmult_le_compat_l; lra). lra. }
  (* d_m, p, b *)
  assert (B3 : d_m * y ^ 2 <= t * m / 2 * Y ^ 2) by (rewrite Y2; apply Rmult_le_compat_r; [apply pow2_ge_0 | exact Hdm]).
  assert (B4 : y * p <= Y * (k_x * (1 + g_ t) * X + g_ t * k_e * E + t ^ 2 * k_e ^ 2 / (6 * k_p) * Y)).
  { apply Rle_trans with (Rabs (y * p)); [apply Rle_abs|]. rewrite Rabs_mult. apply Rmult_le_compat_l; assumption. }
  assert (B5 : (1 - t / h * (theta / (1 + theta))) * Y ^ 2 <= (1 - K * t * b / 2) * y ^ 2).
  { rewrite Y2, theta_fraction. apply Rmult_le_compat_r; [apply pow2_ge_0|].
    replace (t / h * (K * h * Nb2 / 2)) with (K * t * Nb2 / 2) by (field; lra).
    assert (K * t * b <= K * t * Nb2) by (apply Rmult_le_compat_l; [nra | exact Hb]). lra. }
  assert (B6 : t * (2 * r * ((1 - t / h * (theta / (1 + theta))) * Y ^ 2)) <= t * (2 * r * ((1 - K * t * b / 2) * y ^ 2)))
    by (apply Rmult_le_compat_l; [lra|]; apply Rmult_le_compat_l; lra).
  assert (B7 : t * (2 * ((1 - t * sigma + r * d_l) * e_k * y)) <= t * (2 * (D_t t * E * Y)))
    by (apply Rmult_le_compat_l; lra).
  assert (B8 : t * (2 * r * (d_m * y ^ 2)) <= t * (2 * r * (t * m / 2 * Y ^ 2)))
    by (apply Rmult_le_compat_l; [lra|]; apply Rmult_le_compat_l; lra).
  assert (B9 : t * (2 * r * (y * p)) <= t * (2 * r * (Y * (k_x * (1 + g_ t) * X + g_ t * k_e * E + t ^ 2 * k_e ^ 2 / (6 * k_p) * Y))))
    by (apply Rmult_le_compat_l; [lra|]; apply Rmult_le_compat_l; lra).
  assert (EV : eta * V_t = eta * V_k - t * (2 * r * ((1 - K * t * b / 2) * y ^ 2)) + t * (2 * r * (y * q_m))).
  { rewrite HV. unfold r. field. lra. }
  assert (Eq : t * (2 * r * (y * q_m)) = t * (2 * r * d_l * e_k * y) + t * (2 * r * (d_m * y ^ 2)) + t * (2 * r * (y * p)))
    by (rewrite Hq; ring).
  assert (Ee : e_t ^ 2 = e_k ^ 2 - t * (sigma * (2 - t * sigma) * E ^ 2) + t * (2 * (1 - t * sigma) * e_k * y) + t * (t * Y ^ 2))
    by (rewrite He, <- E2, <- Y2; ring).
  unfold U_, Q. replace (2 * eta / K) with (2 * r) by (unfold r; field; lra). fold r.
  rewrite EV, Eq, Ee. lra.
Qed.

(** Q_t lies above its chord over [0, h]. Two of its parts are not polynomials in t: the root in c_E, and D_t. Both lie below theirs. *)
Lemma root_convex la : 0 <= la <= 1 -> root (la * h) <= (1 - la) * root 0 + la * root h.
Proof.
  intros Hla. unfold root. replace (1 - 0 * sigma + (0 * sigma) ^ 2 / 3) with 1 by field. rewrite sqrt_1.
  set (z := h * sigma). replace (la * h * sigma) with (la * z) by (unfold z; ring).
  assert (Hz : 0 <= 1 - z + z ^ 2 / 3) by (pose proof (pow2_ge_0 (1 - z / 2)); pose proof (pow2_ge_0 z); nra).
  assert (H1 : 1 - z / 2 <= sqrt (1 - z + z ^ 2 / 3)).
  { apply Rle_trans with (Rabs (1 - z / 2)); [apply Rle_abs|]. rewrite <- sqrt_Rsqr_abs. apply sqrt_le_1_alt.
    unfold Rsqr. pose proof (pow2_ge_0 z). nra. }
  set (q := sqrt (1 - z + z ^ 2 / 3)) in *.
  assert (Hq : 0 <= q) by apply sqrt_pos.
  assert (Eq : q ^ 2 = 1 - z + z ^ 2 / 3) by (unfold q; rewrite <- Rsqr_pow2, Rsqr_sqrt; auto).
  assert (Hs : 0 <= (1 - la) * 1 + la * q).
  { assert (0 <= la * q) by (apply Rmult_le_pos; lra). lra. }
  rewrite <- (sqrt_pow2 ((1 - la) * 1 + la * q)) by exact Hs. apply sqrt_le_1_alt.
  replace (((1 - la) * 1 + la * q) ^ 2) with ((1 - la) ^ 2 + 2 * la * (1 - la) * q + la ^ 2 * q ^ 2) by ring.
  rewrite Eq. assert (2 * la * (1 - la) * (1 - z / 2) <= 2 * la * (1 - la) * q) by (apply Rmult_le_compat_l; nra). nra.
Qed.

Lemma Rabs_convex la u v : 0 <= la <= 1 -> Rabs ((1 - la) * u + la * v) <= (1 - la) * Rabs u + la * Rabs v.
Proof.
  intros Hla. apply Rle_trans with (1 := Rabs_triang _ _). rewrite !Rabs_mult.
  rewrite (Rabs_right (1 - la)), (Rabs_right la) by lra. lra.
Qed.

Lemma D_convex la : 0 <= la <= 1 -> D_t (la * h) <= (1 - la) * D_t 0 + la * D_t h.
Proof.
  intros Hla. unfold D_t at 1.
  set (f := fun t => 1 - t * sigma + eta / K * (1 - t * sigma / 2) * m).
  set (k := fun t => 1 - t * sigma - eta / K * (1 - t * sigma / 2) * k_l).
  change (Rmax (Rabs (f (la * h))) (Rabs (k (la * h))) <= (1 - la) * Rmax (Rabs (f 0)) (Rabs (k 0)) + la * Rmax (Rabs (f h)) (Rabs (k h))).
  replace (f (la * h)) with ((1 - la) * f 0 + la * f h) by (unfold f; field; lra).
  replace (k (la * h)) with ((1 - la) * k 0 + la * k h) by (unfold k; field; lra).
  apply Rmax_lub.
  - apply Rle_trans with (1 := Rabs_convex la _ _ Hla).
    apply Rplus_le_compat; apply Rmult_le_compat_l; try lra; apply Rmax_l.
  - apply Rle_trans with (1 := Rabs_convex la _ _ Hla).
    apply Rplus_le_compat; apply Rmult_le_compat_l; try lra; apply Rmax_r.
Qed.

Theorem Q_concave t X E Y : 0 <= t <= h -> 0 <= X -> 0 <= E -> 0 <= Y ->
  (1 - t / h) * Q 0 X E Y + t / h * Q h X E Y <= Q t X E Y.
Proof.
  intros Ht HX HE HY. set (la := t / h).
  assert (Hla : 0 <= la <= 1).
  { split; [apply Rmult_le_pos; [lra | left; apply Rinv_0_lt_compat; lra] | apply div_le; lra]. }
  assert (Et : t = la * h) by (unfold la; field; lra). clearbody la.
  assert (HS : 0 <= sqrt P_up) by apply sqrt_pos.
  assert (C1 : w_x * sqrt P_up * k_f * X * E * root t <= w_x * sqrt P_up * k_f * X * E * ((1 - la) * root 0 + la * root h)).
  { apply Rmult_le_compat_l; [repeat apply Rmult_le_pos; lra|]. rewrite Et. apply root_convex, Hla. }
  assert (C2 : E * Y * D_t t <= E * Y * ((1 - la) * D_t 0 + la * D_t h)).
  { apply Rmult_le_compat_l; [apply Rmult_le_pos; lra|]. rewrite Et. apply D_convex, Hla. }
  assert (C3 : 0 <= 2 * eta / K * Y * (k_e ^ 2 / (6 * k_p) * Y * (la * (1 - la) * h ^ 2))).
  { assert (0 < eta / K) by (apply Rdiv_lt_0_compat; lra).
    assert (0 <= k_e ^ 2 / (6 * k_p)) by (apply Rmult_le_pos; [apply pow2_ge_0 | left; apply Rinv_0_lt_compat; lra]).
    replace (2 * eta / K) with (2 * (eta / K)) by (field; lra).
    pose proof (pow2_ge_0 h) as H2.
    revert H H0 H2. generalize (eta / K) (k_e ^ 2 / (6 * k_p)) (h ^ 2). intros u v z Hu Hv Hz.
    repeat apply Rmult_le_pos; lra. }
  assert (Eq : Q t X E Y - ((1 - la) * Q 0 X E Y + la * Q h X E Y)
    = 2 * (w_x * sqrt P_up * k_f * X * E * ((1 - la) * root 0 + la * root h) - w_x * sqrt P_up * k_f * X * E * root t)
      + 2 * (E * Y * ((1 - la) * D_t 0 + la * D_t h) - E * Y * D_t t)
      + 2 * eta / K * Y * (k_e ^ 2 / (6 * k_p) * Y * (la * (1 - la) * h ^ 2))).
  { unfold Q, c_E, c_X, c_Y, g_.
    generalize (D_t t) (D_t 0) (D_t h) (root t) (root 0) (root h). intros d dO dh s sO sh.
    rewrite theta_fraction, Et. pose proof PI_RGT_0.
    assert (sqrt 12 <> 0) by (apply Rgt_not_eq, sqrt_lt_R0; lra).
    assert (sqrt 3 <> 0) by (apply Rgt_not_eq, sqrt_lt_R0; lra).
    field. repeat split; lra. }
  lra.
Qed.

(** The coefficients of Q_t as a form in (X, E, Y). *)
Definition q_XX t := 2 * w_x * a_2 - 2 * w_x * sqrt P_up * k_f * c_X t.
Definition q_XE t := - (w_x * sqrt P_up * k_f * c_E t).
Definition q_XY t := - (w_x * sqrt P_up * k_f * c_Y t) - eta / K * (k_x * (1 + g_ t)).
Definition q_EE t := sigma * (2 - t * sigma).
Definition q_EY t := - D_t t - eta / K * (g_ t * k_e).
Definition q_YY t := 2 * eta / K * (1 - t / h * (theta / (1 + theta))) - t - eta / K * t * m
                     - 2 * eta / K * (t ^ 2 * k_e ^ 2 / (6 * k_p)).

Lemma Q_form t X E Y : Q t X E Y = form3 (q_XX t) (q_XE t) (q_XY t) (q_EE t) (q_EY t) (q_YY t) X E Y.
Proof. unfold Q, form3, q_XX, q_XE, q_XY, q_EE, q_EY, q_YY. rewrite theta_fraction. field. repeat split; lra. Qed.

(** (C5h): the leading minors of Q_0 and Q_h are positive. *)
Definition minors_positive (t : R) : Prop :=
  0 < q_XX t /\ 0 < minor2 (q_XX t) (q_XE t) (q_EE t)
  /\ 0 < minor3 (q_XX t) (q_XE t) (q_XY t) (q_EE t) (q_EY t) (q_YY t).

(** Section 12.3: U^t <= U_k. Hypotheses: S0, k_p > 0, C5h, and (12.6), the decay of xi and the balance in [interval_at]. *)
Theorem C5h_U_decreases t X xi2_k xi2_t e_k e_t V_k V_t y q_m re b d_l d_m p :
  minors_positive 0 -> minors_positive h ->
  0 < t <= h -> interval_at t X xi2_k xi2_t e_k e_t V_k V_t y q_m re b d_l d_m p ->
  U_ xi2_t e_t V_t <= U_ xi2_k e_k V_k.
Proof.
  intros M0 Mh Ht HI. apply Rle_trans with (1 := U_step _ _ _ _ _ _ _ _ _ _ _ _ _ _ _ Ht HI).
  assert (P : forall s, minors_positive s -> 0 <= Q s X (Rabs e_k) (Rabs y)).
  { intros s [P1 [P2 P3]]. rewrite Q_form.
    destruct (Req_dec X 0) as [EX|EX]; [destruct (Req_dec (Rabs e_k) 0) as [EE|EE]; [destruct (Req_dec (Rabs y) 0) as [EY|EY]|]|].
    - rewrite EX, EE, EY. unfold form3. right. ring.
    - left. apply form3_pos; tauto.
    - left. apply form3_pos; tauto.
    - left. apply form3_pos; tauto. }
  pose proof (X_nonneg _ _ _ _ _ _ _ _ _ _ _ _ _ _ _ HI) as HX.
  pose proof (Q_concave t X (Rabs e_k) (Rabs y) ltac:(lra) HX (Rabs_pos _) (Rabs_pos _)) as C.
  assert (Hla : 0 <= t / h <= 1).
  { split; [apply Rmult_le_pos; [lra | left; apply Rinv_0_lt_compat; lra] | apply div_le; lra]. }
  pose proof (P 0 M0). pose proof (P h Mh).
  assert (0 <= (1 - t / h) * Q 0 X (Rabs e_k) (Rabs y)) by (apply Rmult_le_pos; lra).
  assert (0 <= t / h * Q h X (Rabs e_k) (Rabs y)) by (apply Rmult_le_pos; lra).
  assert (0 <= t * Q t X (Rabs e_k) (Rabs y)) by (apply Rmult_le_pos; lra).
  lra.
Qed.

End Sampled.
