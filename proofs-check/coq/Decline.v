(** Sections 5, 10.4 and 13.7: U' is at most a negative multiple of xi^2 + et^2 + s^2 in the error box, by C5 of what is known in norms
    or by (M), for every gain from sigma on. *)

From Coq Require Import Reals Lra Lia.
From Coquelicot Require Import Coquelicot.
From SigmaStar Require Import Sums Stability Containment Sizes PlantBounds.
Local Open Scope R_scope.

Section Decline.
Variable c : numbers.
Context {X : NormedModule R_AbsRing}.
Variables (f : R -> X -> R -> X) (q : R -> X -> R -> R).
Variables (F : R -> X -> X) (P : R -> X -> R) (P' : R -> X -> X -> R).
Hypothesis form : quadratic_form c P P'.
Hypothesis plant : as_known c f q F P P'.
Hypothesis conditions : stability_conditions c.

Let p_low_pos : 0 < p_low c. Proof. apply (signs_b _ conditions). Qed.
Let p_up_pos : 0 < p_up c. Proof. apply (signs_b _ conditions). Qed.
Let D_x_pos : 0 < D_x c. Proof. apply (signs_b _ conditions). Qed.
Let D_e_pos : 0 < D_e c. Proof. apply (signs_b _ conditions). Qed.
Let P_nonneg := P_nonneg c P P' form conditions.
Let xi_le_norm := xi_le_norm c P P' form conditions.
Let q_part := q_part c f q F P P' form plant conditions.

Let h_pos : 0 < h c. Proof. apply (signs_b _ conditions). Qed.
Let mu_pos : 0 < mu c. Proof. apply (signs_b _ conditions). Qed.
Let w_x_pos : 0 < w_x c. Proof. apply (signs_b _ conditions). Qed.

Lemma ht_pos : 0 < ht c.
Proof. unfold ht. apply Rdiv_lt_0_compat; lra. Qed.

(** C5 of Stability.v, for every larger gain. *)
Lemma C5_of s : of_matrix c = None -> sigma c <= s ->
  C5 (w_x c * a_2 c) (w_x c * sqrt (p_up c) * k_f c) (k_x c) (ht c) (size c) s.
Proof.
  intros N Hs. pose proof (C5_ _ conditions) as Q5. pose proof (C5b _ conditions) as Q5b. rewrite N in Q5, Q5b.
  apply C5_larger with (sigma c); [|exact Hs].
  destruct (nonneg _ conditions) as [Kx Kf]. split.
  - apply ht_pos.
  - apply Rmult_le_pos; [|exact Kf]. apply Rmult_le_pos; [lra | apply sqrt_pos].
  - exact Kx.
  - unfold size. rewrite max2_Rmax. apply Rle_trans with (2 := Rmax_l _ _). apply Rabs_pos.
  - exact Q5.
  - exact Q5b.
Qed.

(** U' <= -rho (xi^2 + et^2 + s^2) at one time; rho serves every N, plant and solution. *)
Lemma decay s : of_matrix c = None -> sigma c <= s -> exists rho, 0 < rho /\
  forall xi2 xi2' e u_x delta phi y m,
  0 <= xi2 -> xi2' <= - 2 * a_2 c * xi2 + 2 * sqrt (p_up c) * sqrt xi2 * phi ->
  Rabs u_x <= k_x c * sqrt xi2 -> - k_l c <= delta <= most c -> Rabs phi <= k_f c * Rabs e ->
  y = u_x + delta * e + mu c * m ->
  w_x c * xi2' + 2 * e * (y - s * e) + h c * (- 2 * m * y) <= - rho * (xi2 + e ^ 2 + m ^ 2).
Proof.
  intros N Hs. destruct (C5_form _ _ _ _ _ _ (C5_of s N Hs)) as [rho [Hrho Fm]].
  pose proof ht_pos as Hht.
  set (K := 3 * (1 + k_x c ^ 2 + (k_l c ^ 2 + most c ^ 2)) / mu c ^ 2).
  assert (HK : 0 <= K).
  { unfold K. pose proof (pow2_ge_0 (k_x c)). pose proof (pow2_ge_0 (k_l c)). pose proof (pow2_ge_0 (most c)).
    left. apply Rdiv_lt_0_compat; [lra | apply pow_lt; lra]. }
  exists (rho / (1 + K)). split; [apply Rdiv_lt_0_compat; lra|].
  intros xi2 xi2' e u_x delta phi y m P0 P1 P2 P3 P4 Ey.
  set (xi := sqrt xi2) in *. assert (Hxi : 0 <= xi) by apply sqrt_pos.
  assert (Exi : xi2 = xi ^ 2) by (unfold xi; rewrite <- Rsqr_pow2, Rsqr_sqrt; auto).
  set (v := (1 + ht c * delta) * e + ht c * u_x).
  assert (HD : Rabs (1 + ht c * delta) <= size c).
  { unfold size. rewrite max2_Rmax. pose proof (Rmax_l (Rabs (1 + ht c * most c)) (Rabs (1 - ht c * k_l c))) as M1.
    pose proof (Rmax_r (Rabs (1 + ht c * most c)) (Rabs (1 - ht c * k_l c))) as M2.
    set (M := Rmax _ _) in *. apply Rabs_le_between in M1. apply Rabs_le_between in M2. apply Rabs_le_between.
    assert (ht c * delta <= ht c * most c) by (apply Rmult_le_compat_l; lra).
    assert (ht c * - k_l c <= ht c * delta) by (apply Rmult_le_compat_l; lra). lra. }
  assert (Hv : Rabs v <= size c * Rabs e + ht c * k_x c * xi).
  { unfold v. apply Rle_trans with (1 := Rabs_triang _ _). rewrite !Rabs_mult. apply Rplus_le_compat.
    - apply Rmult_le_compat_r; [apply Rabs_pos | exact HD].
    - rewrite (Rabs_right (ht c)) by lra. rewrite Rmult_assoc. apply Rmult_le_compat_l; [lra | exact P2]. }
  specialize (Fm xi e y v Hxi Hv).
  assert (Q1 : w_x c * xi2' <= - 2 * (w_x c * a_2 c) * xi ^ 2 + 2 * (w_x c * sqrt (p_up c) * k_f c) * xi * Rabs e).
  { apply Rle_trans with (w_x c * (- 2 * a_2 c * xi2 + 2 * sqrt (p_up c) * xi * phi)).
    - apply Rmult_le_compat_l; [lra | exact P1].
    - rewrite Exi. assert (2 * w_x c * sqrt (p_up c) * xi * phi <= 2 * w_x c * sqrt (p_up c) * xi * (k_f c * Rabs e)).
      { apply Rmult_le_compat_l.
        - repeat apply Rmult_le_pos; try lra. apply sqrt_pos.
        - apply Rle_trans with (2 := P4). apply Rle_abs. }
      lra. }
  assert (Q2 : 2 * e * (y - s * e) + h c * (- 2 * m * y) = - 2 * s * e ^ 2 + 2 * y * v - 2 * ht c * y ^ 2).
  { assert (Em : m = (y - (u_x + delta * e)) / mu c) by (rewrite Ey; field; lra).
    assert (Eh : h c = ht c * mu c) by (unfold ht; field; lra).
    rewrite Eh. replace (ht c * mu c * (- 2 * m * y)) with (- 2 * ht c * (mu c * m) * y) by ring.
    replace (mu c * m) with (y - (u_x + delta * e)) by (rewrite Em; field; lra). unfold v. ring. }
  assert (Q3 : m ^ 2 <= K * (xi2 + e ^ 2 + y ^ 2)).
  { replace (m ^ 2) with ((mu c * m) ^ 2 / mu c ^ 2) by (field; lra).
    apply div_le; [apply pow_lt; lra|].
    replace (K * (xi2 + e ^ 2 + y ^ 2) * mu c ^ 2)
      with (3 * (1 + k_x c ^ 2 + (k_l c ^ 2 + most c ^ 2)) * (xi2 + e ^ 2 + y ^ 2)) by (unfold K; field; lra).
    replace (mu c * m) with (y - u_x - delta * e) by lra.
    assert (R1 : u_x ^ 2 <= k_x c ^ 2 * xi2).
    { rewrite Exi, <- Rpow_mult_distr, <- (pow2_abs u_x). apply pow_incr. split; [apply Rabs_pos | exact P2]. }
    assert (R2 : delta ^ 2 <= k_l c ^ 2 + most c ^ 2).
    { destruct (Rle_lt_dec 0 delta); pose proof (pow2_ge_0 (k_l c)); pose proof (pow2_ge_0 (most c)).
      - assert (delta ^ 2 <= most c ^ 2) by (apply pow_incr; lra). lra.
      - assert ((- delta) ^ 2 <= k_l c ^ 2) by (apply pow_incr; lra). lra. }
    assert (R3 : (y - u_x - delta * e) ^ 2 <= 3 * (y ^ 2 + u_x ^ 2 + delta ^ 2 * e ^ 2)).
    { pose proof (pow2_ge_0 (y + u_x)). pose proof (pow2_ge_0 (y + delta * e)). pose proof (pow2_ge_0 (u_x - delta * e)).
      replace (delta ^ 2 * e ^ 2) with ((delta * e) ^ 2) by ring. lra. }
    assert (R4 : delta ^ 2 * e ^ 2 <= (k_l c ^ 2 + most c ^ 2) * e ^ 2) by (apply Rmult_le_compat_r; [apply pow2_ge_0 | exact R2]).
    pose proof (pow2_ge_0 e) as E0. pose proof (pow2_ge_0 y) as Y0. pose proof (pow2_ge_0 (k_x c)) as K0.
    assert (K1 : 0 <= k_l c ^ 2 + most c ^ 2) by (pose proof (pow2_ge_0 (k_l c)); pose proof (pow2_ge_0 (most c)); lra).
    set (a := k_x c ^ 2) in *. set (b := k_l c ^ 2 + most c ^ 2) in *. set (ee := e ^ 2) in *. set (yy := y ^ 2) in *.
    assert (0 <= a * ee) by (apply Rmult_le_pos; assumption). assert (0 <= a * yy) by (apply Rmult_le_pos; assumption).
    assert (0 <= b * xi2) by (apply Rmult_le_pos; assumption). assert (0 <= b * yy) by (apply Rmult_le_pos; assumption). lra. }
  assert (Q4 : rho / (1 + K) * (xi2 + e ^ 2 + m ^ 2) <= rho * (xi ^ 2 + e ^ 2 + y ^ 2)).
  { rewrite <- Exi. apply Rle_trans with (rho / (1 + K) * ((1 + K) * (xi2 + e ^ 2 + y ^ 2))).
    - apply Rmult_le_compat_l; [left; apply Rdiv_lt_0_compat; lra|]. pose proof (pow2_ge_0 y). lra.
    - right. field. lra. }
  lra.
Qed.

(** (M), where it is given. *)
Lemma of_matrix_known m : of_matrix c = Some m -> domain_of_decline c (by_matrix m) /\ bounded_decline c f q P P' (by_matrix m).
Proof.
  unfold of_matrix. intros M. pose proof plant as W. unfold as_known in W. pose proof (domain_b _ conditions) as D.
  destruct (known c) as [o|k]; [discriminate|]. destruct D as [_ [_ D]]. pose proof (bounded_f c f q P P' k W) as Wf.
  destruct (of_decline k) as [fe rate most|m']; [discriminate|]. injection M as ->. split; assumption.
Qed.

(** The same by (M): the square that is left of F, with the multiple of P and of et^2 that the margins give, bounds s. *)
Lemma decay_by_matrix m s : of_matrix c = Some m -> sigma c <= s -> exists rho, 0 < rho /\
  forall t v xp e ep z y, near c v xp e ep -> y = q t v e - q t xp ep + mu c * z ->
  w_x c * P' t (minus v xp) (minus (f t v e) (f t xp ep)) + 2 * (e - ep) * (y - s * (e - ep)) + h c * (- 2 * z * y)
  <= - rho * (P t (minus v xp) + (e - ep) ^ 2 + z ^ 2).
Proof.
  intros M Hs. pose proof ht_pos as Hht. pose proof (C5_ _ conditions) as Hde. pose proof (C5b _ conditions) as Hta.
  rewrite M in Hde, Hta. destruct (of_matrix_known m M) as [D W].
  set (a := 2 * w_x c * delta_m m). set (b := 2 * (s - tau_m m)). set (kp := 2 * ht c).
  assert (Ha : 0 < a) by (unfold a; apply Rmult_lt_0_compat; [lra | exact Hde]).
  assert (Hb : 0 < b) by (unfold b; lra). assert (Hk : 0 < kp) by (unfold kp; lra).
  (* mu z = w - (q - q')/2 + et/kp, where kp w^2 is what is left *)
  set (Kx := k_x c ^ 2). set (Kd := 2 * (k_l c ^ 2 + most c ^ 2 + / kp ^ 2)).
  assert (HKx : 0 <= Kx) by apply pow2_ge_0.
  assert (HKd : 0 <= Kd).
  { unfold Kd. pose proof (pow2_ge_0 (k_l c)). pose proof (pow2_ge_0 (most c)).
    assert (0 < / kp ^ 2) by (apply Rinv_0_lt_compat, pow_lt, Hk). lra. }
  set (low := Rmin a (Rmin b kp)).
  assert (Hl : 0 < low) by (unfold low; repeat apply Rmin_glb_lt; assumption).
  set (K := 3 * (1 + Kx + Kd) / mu c ^ 2).
  assert (HK : 0 < K) by (unfold K; apply Rdiv_lt_0_compat; [lra | apply pow_lt; lra]).
  exists (low / (1 + K)). split; [apply Rdiv_lt_0_compat; lra|].
  intros t v xp e ep z y H Ey. destruct (q_part t v xp e ep H) as [u_x [delta [Eq [Q2 Q3]]]].
  set (d := e - ep) in *. set (u := q t v e - q t xp ep) in *. set (p := P t (minus v xp)) in *.
  set (p' := P' t (minus v xp) (minus (f t v e) (f t xp ep))) in *.
  assert (P0 : 0 <= p) by apply P_nonneg.
  assert (Fm : 0 <= - w_x c * (p' + 2 * delta_m m * p) - kp * u * (u / 2 + d / kp) + 2 * tau_m m * d ^ 2
                    - 2 * d * (u / 2 + d / kp) + kp * (u / 2 + d / kp) ^ 2).
  { pose proof (near_norm c _ _ _ _ H) as Nv. pose proof (near_e c _ _ _ _ H) as Ne. destruct H as [Hxp [Hep _]]. destruct D as [D1 [D2 [D3 D4]]].
    apply (W t v xp e ep); lra. }
  set (r := u / 2 + d / kp) in *. set (left := y - r).
  assert (Fall : w_x c * p' + 2 * d * (y - s * d) + h c * (- 2 * z * y) <= - (a * p + b * d ^ 2 + kp * left ^ 2)).
  { assert (Eh : h c * z = kp / 2 * (y - u)) by (rewrite Ey; unfold kp, ht; field; lra).
    replace (h c * (- 2 * z * y)) with (- 2 * (h c * z) * y) by ring. rewrite Eh.
    assert (Er : kp * u + 2 * d = 2 * kp * r) by (unfold r; field; lra).
    assert (E1 : - w_x c * (p' + 2 * delta_m m * p) - kp * u * r + 2 * tau_m m * d ^ 2 - 2 * d * r + kp * r ^ 2
                 = - w_x c * p' - a * p + 2 * tau_m m * d ^ 2 - (kp * u + 2 * d) * r + kp * r ^ 2) by (unfold a; ring).
    rewrite E1, Er in Fm.
    assert (E2 : w_x c * p' + 2 * d * (y - s * d) + - 2 * (kp / 2 * (y - u)) * y
                 = w_x c * p' - 2 * s * d ^ 2 + (kp * u + 2 * d) * y - kp * y ^ 2) by field.
    rewrite E2, Er. unfold left, b. lra. }
  assert (Z : z ^ 2 <= K * (p + d ^ 2 + left ^ 2)).
  { replace (z ^ 2) with ((mu c * z) ^ 2 / mu c ^ 2) by (field; lra). apply div_le; [apply pow_lt; lra|].
    replace (K * (p + d ^ 2 + left ^ 2) * mu c ^ 2) with (3 * (1 + Kx + Kd) * (p + d ^ 2 + left ^ 2)) by (unfold K; field; lra).
    assert (Ez : mu c * z = left - u_x / 2 + (/ kp - delta / 2) * d) by (unfold left, r; rewrite Ey, Eq; field; lra).
    rewrite Ez. set (g := / kp - delta / 2).
    assert (R0 : (left - u_x / 2 + g * d) ^ 2 <= 3 * (left ^ 2 + u_x ^ 2 / 4 + (g * d) ^ 2)).
    { pose proof (pow2_ge_0 (left + u_x / 2)). pose proof (pow2_ge_0 (left - g * d)). pose proof (pow2_ge_0 (u_x / 2 + g * d)). lra. }
    assert (R1 : u_x ^ 2 <= Kx * p).
    { assert (Ep : p = sqrt p ^ 2) by (rewrite <- Rsqr_pow2, Rsqr_sqrt; auto).
      unfold Kx. rewrite Ep, <- Rpow_mult_distr, <- (pow2_abs u_x). apply pow_incr. split; [apply Rabs_pos | exact Q2]. }
    assert (R2 : delta ^ 2 <= k_l c ^ 2 + most c ^ 2).
    { destruct (Rle_lt_dec 0 delta); pose proof (pow2_ge_0 (k_l c)); pose proof (pow2_ge_0 (most c)).
      - assert (delta ^ 2 <= most c ^ 2) by (apply pow_incr; lra). lra.
      - assert ((- delta) ^ 2 <= k_l c ^ 2) by (apply pow_incr; lra). lra. }
    assert (R3 : g ^ 2 <= Kd).
    { unfold g, Kd. replace (/ kp ^ 2) with ((/ kp) ^ 2) by (field; lra). pose proof (pow2_ge_0 (/ kp + delta / 2)).
      pose proof (pow2_ge_0 delta). lra. }
    assert (R4 : (g * d) ^ 2 <= Kd * d ^ 2) by (rewrite Rpow_mult_distr; apply Rmult_le_compat_r; [apply pow2_ge_0 | exact R3]).
    pose proof (pow2_ge_0 d) as D0. pose proof (pow2_ge_0 left) as L0.
    set (dd := d ^ 2) in *. set (ll := left ^ 2) in *.
    assert (0 <= Kx * p) by (apply Rmult_le_pos; assumption). assert (0 <= Kx * dd) by (apply Rmult_le_pos; assumption).
    assert (0 <= Kx * ll) by (apply Rmult_le_pos; assumption). assert (0 <= Kd * p) by (apply Rmult_le_pos; assumption).
    assert (0 <= Kd * ll) by (apply Rmult_le_pos; assumption). lra. }
  apply Rle_trans with (1 := Fall).
  assert (Q4 : low / (1 + K) * (p + d ^ 2 + z ^ 2) <= low * (p + d ^ 2 + left ^ 2)).
  { apply Rle_trans with (low / (1 + K) * ((1 + K) * (p + d ^ 2 + left ^ 2))).
    - apply Rmult_le_compat_l; [left; apply Rdiv_lt_0_compat; lra|]. pose proof (pow2_ge_0 left). lra.
    - right. field. lra. }
  assert (L1 : low <= a) by apply Rmin_l.
  assert (L2 : low <= b) by (apply Rle_trans with (1 := Rmin_r _ _), Rmin_l).
  assert (L3 : low <= kp) by (apply Rle_trans with (1 := Rmin_r _ _), Rmin_r).
  assert (low * p <= a * p) by (apply Rmult_le_compat_r; assumption).
  assert (low * d ^ 2 <= b * d ^ 2) by (apply Rmult_le_compat_r; [apply pow2_ge_0 | exact L2]).
  assert (low * left ^ 2 <= kp * left ^ 2) by (apply Rmult_le_compat_r; [apply pow2_ge_0 | exact L3]). lra.
Qed.

(** ** What Claim.v takes of it *)

(** U' <= -rho (xi^2 + et^2 + s^2) at one time; rho serves every N, plant and solution. *)
Theorem declines s : sigma c <= s -> exists rho, 0 < rho /\
  forall t v xp e ep z y, near c v xp e ep -> y = q t v e - q t xp ep + mu c * z ->
  w_x c * P' t (minus v xp) (minus (f t v e) (f t xp ep)) + 2 * (e - ep) * (y - s * (e - ep)) + h c * (- 2 * z * y)
  <= - rho * (P t (minus v xp) + (e - ep) ^ 2 + z ^ 2).
Proof.
  intros Hs. destruct (of_matrix c) as [m|] eqn:M; [apply (decay_by_matrix m s M Hs)|].
  destruct (decay s M Hs) as [rho [Hrho Dec]]. exists rho. split; [exact Hrho|].
  intros t v xp e ep z y H Ey.
  destruct (q_part t v xp e ep H) as [u_x [delta [Q1 [Q2 Q3]]]]. destruct (f_part c f q F P P' form plant conditions t v xp e ep M H) as [phi [F1 F2]].
  apply (Dec _ _ _ u_x delta phi); try assumption; [apply P_nonneg | rewrite Ey, Q1; reflexivity].
Qed.

Lemma xi_near t v xp e ep : near c v xp e ep -> sqrt (P t (minus v xp)) <= sqrt (p_up c) * D_x c.
Proof.
  intros H. apply Rle_trans with (1 := xi_le_norm t _). apply Rmult_le_compat_l; [apply sqrt_pos | left; apply H].
Qed.

(** In the error box neither xi^2 nor q changes fast. *)
Theorem slopes : exists C, 0 < C /\ forall t v xp e ep, near c v xp e ep ->
  P' t (minus v xp) (minus (f t v e) (f t xp ep)) <= C /\ Rabs (q t v e - q t xp ep) <= C.
Proof.
  destruct (nonneg _ conditions) as [Kx Kf].
  set (Xi := sqrt (p_up c) * D_x c).
  assert (HXi : 0 <= Xi) by (apply Rmult_le_pos; [apply sqrt_pos | lra]).
  set (Cq := k_x c * Xi + (Rabs (k_l c) + Rabs (most c)) * D_e c).
  assert (Hq : forall t v xp e ep, near c v xp e ep -> Rabs (q t v e - q t xp ep) <= Cq).
  { intros t v xp e ep H. destruct (q_part t v xp e ep H) as [u_x [delta [Q1 [Q2 Q3]]]]. rewrite Q1.
    apply Rle_trans with (1 := Rabs_triang _ _). unfold Cq. apply Rplus_le_compat.
    - apply Rle_trans with (1 := Q2). apply Rmult_le_compat_l; [exact Kx | apply (xi_near t v xp e ep H)].
    - rewrite Rabs_mult. apply Rmult_le_compat; [apply Rabs_pos | apply Rabs_pos | | left; apply H].
      pose proof (Rle_abs (k_l c)). pose proof (Rle_abs (most c)). pose proof (Rabs_pos (k_l c)). pose proof (Rabs_pos (most c)).
      apply Rabs_le_between. lra. }
  assert (Hf : exists Cf, 0 <= Cf /\ forall t v xp e ep, near c v xp e ep -> P' t (minus v xp) (minus (f t v e) (f t xp ep)) <= Cf).
  { destruct (of_matrix c) as [m|] eqn:M.
    - destruct (of_matrix_known m M) as [D W]. exists (2 * Rabs (tau_m m) * D_e c ^ 2 / w_x c).
      assert (T0 : 0 <= 2 * Rabs (tau_m m) * D_e c ^ 2).
      { pose proof (Rabs_pos (tau_m m)). apply Rmult_le_pos; [lra | apply pow2_ge_0]. }
      split; [apply le_div; lra|]. intros t v xp e ep H. apply le_div; [lra|].
      pose proof (C5_ _ conditions) as Hde. rewrite M in Hde.
      assert (Fm := W t v xp e ep 0). pose proof (near_norm c _ _ _ _ H) as Nv. pose proof (near_e c _ _ _ _ H) as Ne.
      destruct H as [Hxp [Hep [_ He]]]. destruct D as [D1 [D2 [D3 D4]]]. specialize (Fm ltac:(lra) ltac:(lra) ltac:(lra) ltac:(lra)).
      assert (P0 : 0 <= 2 * w_x c * delta_m m * P t (minus v xp)).
      { apply Rmult_le_pos; [apply Rmult_le_pos; lra | apply P_nonneg]. }
      assert (E0 : tau_m m * (e - ep) ^ 2 <= Rabs (tau_m m) * D_e c ^ 2).
      { apply Rle_trans with (Rabs (tau_m m) * (e - ep) ^ 2).
        - apply Rmult_le_compat_r; [apply pow2_ge_0 | apply Rle_abs].
        - apply Rmult_le_compat_l; [apply Rabs_pos|]. rewrite <- (pow2_abs (e - ep)). apply pow_incr. split; [apply Rabs_pos | lra]. }
      lra.
    - exists (2 * sqrt (p_up c) * Xi * (k_f c * D_e c)).
      assert (Sp : 0 <= sqrt (p_up c)) by apply sqrt_pos.
      split; [repeat apply Rmult_le_pos; lra|]. intros t v xp e ep H.
      destruct (f_part c f q F P P' form plant conditions t v xp e ep M H) as [phi [F1 F2]].
      assert (A2 : 0 < a_2 c).
      { pose proof (C5_ _ conditions) as Q. rewrite M in Q. pose proof ht_pos. pose proof (pow2_ge_0 (k_x c)).
        assert (0 <= ht c * k_x c ^ 2) by (apply Rmult_le_pos; lra). apply Rnot_le_lt. intros L.
        assert (w_x c * a_2 c <= w_x c * 0) by (apply Rmult_le_compat_l; lra). lra. }
      apply Rle_trans with (1 := F2).
      assert (0 <= a_2 c * P t (minus v xp)) by (apply Rmult_le_pos; [lra | apply P_nonneg]).
      assert (phi <= k_f c * D_e c).
      { apply Rle_trans with (1 := Rle_abs phi). apply Rle_trans with (1 := F1). apply Rmult_le_compat_l; [lra | left; apply H]. }
      assert (0 <= k_f c * D_e c) by (apply Rmult_le_pos; lra).
      assert (sqrt (P t (minus v xp)) * phi <= Xi * (k_f c * D_e c)).
      { apply Rle_trans with (sqrt (P t (minus v xp)) * (k_f c * D_e c)).
        - apply Rmult_le_compat_l; [apply sqrt_pos | assumption].
        - apply Rmult_le_compat_r; [assumption | apply (xi_near t v xp e ep H)]. }
      assert (sqrt (p_up c) * (sqrt (P t (minus v xp)) * phi) <= sqrt (p_up c) * (Xi * (k_f c * D_e c)))
        by (apply Rmult_le_compat_l; assumption).
      lra. }
  destruct Hf as [Cf [Cf0 Hf]]. exists (Rabs Cq + Cf + 1). split; [pose proof (Rabs_pos Cq); lra|].
  intros t v xp e ep H. pose proof (Hf t v xp e ep H). pose proof (Hq t v xp e ep H). pose proof (Rle_abs Cq). pose proof (Rabs_pos Cq). lra.
Qed.

End Decline.
