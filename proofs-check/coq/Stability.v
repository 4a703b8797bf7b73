(** Sections 5, 10.4 and 13.1: C5 in closed form makes the form of the dissipation positive definite, so U decreases; with
    an input gain too; and what holds for sigma holds for every larger gain. *)

From Coq Require Import Reals Lra Lia.
From Coquelicot Require Import Coquelicot.
From SigmaStar Require Import Sums Forms.
Local Open Scope R_scope.

(** ** The closed form of C5 *)

(** C5 and C5b of (10.5). p = w_x sqrt(P_up) k_f, A = w_x a_2, ht = h/mu, and D bounds |1 + ht delta| over the sector. *)
Record C5 (A p k_x ht D sigma : R) : Prop := {
  C5_ht : 0 < ht;
  C5_p : 0 <= p;
  C5_kx : 0 <= k_x;
  C5_D : 0 <= D;
  C5_A : ht * k_x ^ 2 < 4 * A;
  C5_sigma : D ^ 2 / (4 * ht) + (p + k_x * D / 2) ^ 2 / (4 * A - ht * k_x ^ 2) < sigma
}.

(** The form in xi, |et| and y = u + mu s, where v = (1 + ht delta) et + ht u_x. *)
Lemma C5_form A p k_x ht D sigma : C5 A p k_x ht D sigma ->
  exists rho, 0 < rho /\ forall xi et y v, 0 <= xi -> Rabs v <= D * Rabs et + ht * k_x * xi ->
    rho * (xi ^ 2 + et ^ 2 + y ^ 2)
    <= 2 * A * xi ^ 2 - 2 * p * xi * Rabs et + 2 * sigma * et ^ 2 - 2 * y * v + 2 * ht * y ^ 2.
Proof.
  intros [Hh Hp Hk HD HA Hs].
  set (al := 2 * A - ht * k_x ^ 2 / 2). set (be := 2 * p + D * k_x). set (ga := 2 * sigma - D ^ 2 / (2 * ht)).
  assert (Hd : be ^ 2 < 4 * al * ga).
  { assert (Q : (p + k_x * D / 2) ^ 2 < (sigma - D ^ 2 / (4 * ht)) * (4 * A - ht * k_x ^ 2)).
    { apply Rlt_div_l; lra. }
    replace (be ^ 2) with (4 * (p + k_x * D / 2) ^ 2) by (unfold be; field).
    replace (4 * al * ga) with (4 * ((sigma - D ^ 2 / (4 * ht)) * (4 * A - ht * k_x ^ 2)))
      by (unfold al, ga; field; lra). lra. }
  destruct (form2_margin al be ga ltac:(unfold al; lra) Hd) as [r [Hr F]].
  set (C := D ^ 2 / (2 * ht ^ 2) + k_x ^ 2 / 2).
  assert (HC : 0 <= C).
  { unfold C. assert (0 <= D ^ 2 / (2 * ht ^ 2)); [|nra].
    apply Rmult_le_pos; [apply pow2_ge_0|]. left. apply Rinv_0_lt_compat. nra. }
  set (rho := Rmin (r / (1 + 2 * C)) ht).
  assert (R1 : rho * (1 + 2 * C) <= r).
  { apply Rle_trans with (r / (1 + 2 * C) * (1 + 2 * C)).
    - apply Rmult_le_compat_r; [lra | apply Rmin_l].
    - right. field. lra. }
  assert (R2 : rho <= ht) by apply Rmin_r.
  assert (Hrho : 0 < rho) by (apply Rmin_glb_lt; [apply Rdiv_lt_0_compat; lra | exact Hh]).
  exists rho. split; [exact Hrho|]. intros xi et y v Hxi Hv.
  specialize (F xi (Rabs et)). rewrite pow2_abs in F.
  set (W := D * Rabs et + ht * k_x * xi) in *.
  assert (Hv2 : v ^ 2 <= W ^ 2).
  { rewrite <- (pow2_abs v). apply pow_incr. split; [apply Rabs_pos | exact Hv]. }
  set (v' := v / (2 * ht)).
  assert (E1 : - 2 * y * v + 2 * ht * y ^ 2 = 2 * ht * (y - v') ^ 2 - v ^ 2 / (2 * ht)) by (unfold v'; field; lra).
  assert (E2 : v ^ 2 / (2 * ht) <= W ^ 2 / (2 * ht)).
  { unfold Rdiv. apply Rmult_le_compat_r; [left; apply Rinv_0_lt_compat; lra | exact Hv2]. }
  assert (E3 : 2 * A * xi ^ 2 - 2 * p * xi * Rabs et + 2 * sigma * et ^ 2 - W ^ 2 / (2 * ht)
               = al * xi ^ 2 - be * xi * Rabs et + ga * et ^ 2).
  { unfold W, al, be, ga. rewrite <- (pow2_abs et). field. lra. }
  assert (E4 : v' ^ 2 <= C * (xi ^ 2 + et ^ 2)).
  { replace (v' ^ 2) with (v ^ 2 / (4 * ht ^ 2)) by (unfold v'; field; lra).
    apply div_le; [nra|]. apply Rle_trans with (1 := Hv2).
    apply Rle_trans with (2 * D ^ 2 * et ^ 2 + 2 * (ht * k_x) ^ 2 * xi ^ 2).
    - unfold W. rewrite <- (pow2_abs et). pose proof (pow2_ge_0 (D * Rabs et - ht * k_x * xi)). lra.
    - replace (C * (xi ^ 2 + et ^ 2) * (4 * ht ^ 2)) with ((2 * D ^ 2 + 2 * (ht * k_x) ^ 2) * (xi ^ 2 + et ^ 2))
        by (unfold C; field; lra).
      assert (0 <= D ^ 2 * xi ^ 2) by (apply Rmult_le_pos; apply pow2_ge_0).
      assert (0 <= (ht * k_x) ^ 2 * et ^ 2) by (apply Rmult_le_pos; apply pow2_ge_0). lra. }
  assert (E5 : rho * y ^ 2 <= 2 * rho * (y - v') ^ 2 + 2 * rho * (C * (xi ^ 2 + et ^ 2))).
  { pose proof (pow2_ge_0 (y - 2 * v')).
    assert (rho * y ^ 2 <= rho * (2 * (y - v') ^ 2 + 2 * v' ^ 2)) by (apply Rmult_le_compat_l; lra).
    assert (rho * v' ^ 2 <= rho * (C * (xi ^ 2 + et ^ 2))) by (apply Rmult_le_compat_l; lra). lra. }
  assert (E6 : rho * (1 + 2 * C) * (xi ^ 2 + et ^ 2) <= r * (xi ^ 2 + et ^ 2)).
  { apply Rmult_le_compat_r; [|exact R1]. pose proof (pow2_ge_0 xi). pose proof (pow2_ge_0 et). lra. }
  assert (E7 : rho * (y - v') ^ 2 <= ht * (y - v') ^ 2) by (apply Rmult_le_compat_r; [apply pow2_ge_0 | exact R2]).
  lra.
Qed.

(** |1 + ht (delta + (1-b) sigma)| over a sector and an interval of gains is largest at two corners. *)
Lemma corner_bound ht sigma b_lo b_hi k_l m b delta D :
  0 < ht -> 0 < sigma -> b_lo <= b <= b_hi -> - k_l <= delta <= m ->
  Rabs (1 + ht * (m + (1 - b_lo) * sigma)) <= D -> Rabs (1 + ht * (- k_l + (1 - b_hi) * sigma)) <= D ->
  Rabs (1 + ht * (delta + (1 - b) * sigma)) <= D.
Proof.
  intros Hh Hs Hb Hd H1 H2. apply Rabs_le_between in H1. apply Rabs_le_between in H2. apply Rabs_le_between.
  assert (ht * (delta + (1 - b) * sigma) <= ht * (m + (1 - b_lo) * sigma)) by (apply Rmult_le_compat_l; nra).
  assert (ht * (- k_l + (1 - b_hi) * sigma) <= ht * (delta + (1 - b) * sigma)) by (apply Rmult_le_compat_l; nra).
  lra.
Qed.

(** ** U decreases *)

Section Decrease.
(** Functions of time: xi2 = xi^2, et, V = zt'N zt, s = M'N zt; the parts u_x, u_e = delta et of the difference of q, and phi. *)
Variables (xi2 xi2' et et' V V' s u_x delta phi : R -> R).
Variables (w_x a_2 P_up k_f k_x k_l m mu sigma : R).
Hypothesis w_x_pos : 0 < w_x.
Hypothesis mu_pos : 0 < mu.

(** What the plant contributes (Lemma 5.1, 10.4) at the time t: the decay of xi, and the bounds in the error box. *)
Record plant_at (t : R) : Prop := {
  xi2_nonneg : 0 <= xi2 t;
  xi2_decay : xi2' t <= - 2 * a_2 * xi2 t + 2 * sqrt P_up * sqrt (xi2 t) * phi t;
  u_x_bound : Rabs (u_x t) <= k_x * sqrt (xi2 t);
  sector : - k_l <= delta t <= m;
  phi_bound : Rabs (phi t) <= k_f * Rabs (et t)
}.

(** With an input gain b (13.1): y = q + (1-b) sigma et + b mu s, where q = u_x + delta et. *)
Definition y_ (b t : R) : R := u_x t + delta t * et t + (1 - b) * sigma * et t + b * mu * s t.

(** The loop at the time t: et' = y - sigma et and (zt'N zt)' = -2 s y. *)
Definition loop_at (b t : R) : Prop := et' t = y_ b t - sigma * et t /\ V' t = - 2 * s t * y_ b t.

Definition U (h t : R) : R := w_x * xi2 t + et t ^ 2 + h * V t.
Definition U' (h t : R) : R := w_x * xi2' t + 2 * et t * et' t + h * V' t.

Lemma U_derive h t :
  is_derive xi2 t (xi2' t) -> is_derive et t (et' t) -> is_derive V t (V' t) -> is_derive (U h) t (U' h t).
Proof.
  intros H1 H2 H3. unfold U, U'. evar_last.
  - apply @is_derive_plus; [apply @is_derive_plus|].
    + apply is_derive_scal, H1.
    + apply (is_derive_pow et 2 t _ H2).
    + apply is_derive_scal, H3.
  - simpl. unfold plus; simpl. ring.
Qed.

(** Sections 5, 10.4, 13.1: C5 (C5b) implies that U, with h_b = b mu ht in the place of h, decreases for every b in the
    interval. D is the larger of the two corners. *)
Theorem U_decreases b_lo b_hi ht D :
  0 < b_lo -> 0 < sigma ->
  C5 (w_x * a_2) (w_x * sqrt P_up * k_f) k_x ht D sigma ->
  Rabs (1 + ht * (m + (1 - b_lo) * sigma)) <= D ->
  Rabs (1 + ht * (- k_l + (1 - b_hi) * sigma)) <= D ->
  exists rho, 0 < rho /\ forall b t, b_lo <= b <= b_hi -> plant_at t -> loop_at b t ->
    U' (b * mu * ht) t <= - rho * (xi2 t + et t ^ 2 + y_ b t ^ 2).
Proof.
  intros Hb0 Hs HC H1 H2. destruct (C5_form _ _ _ _ _ _ HC) as [rho [Hrho F]].
  exists rho. split; [exact Hrho|]. intros b t Hb [P0 P1 P2 P3 P4] [L1 L2].
  pose proof (C5_ht _ _ _ _ _ _ HC) as Hht.
  pose proof (corner_bound ht sigma b_lo b_hi k_l m b (delta t) D Hht Hs Hb P3 H1 H2) as HD.
  set (xi := sqrt (xi2 t)) in *. assert (Hxi : 0 <= xi) by apply sqrt_pos.
  assert (Exi : xi2 t = xi ^ 2) by (unfold xi; rewrite <- Rsqr_pow2, Rsqr_sqrt; auto).
  set (v := (1 + ht * (delta t + (1 - b) * sigma)) * et t + ht * u_x t).
  assert (Hv : Rabs v <= D * Rabs (et t) + ht * k_x * xi).
  { unfold v. apply Rle_trans with (1 := Rabs_triang _ _). rewrite !Rabs_mult. apply Rplus_le_compat.
    - apply Rmult_le_compat_r; [apply Rabs_pos | exact HD].
    - rewrite (Rabs_right ht) by lra. rewrite Rmult_assoc. apply Rmult_le_compat_l; [lra | exact P2]. }
  specialize (F xi (et t) (y_ b t) v Hxi Hv).
  assert (Q1 : w_x * xi2' t <= - 2 * (w_x * a_2) * xi ^ 2 + 2 * (w_x * sqrt P_up * k_f) * xi * Rabs (et t)).
  { apply Rle_trans with (w_x * (- 2 * a_2 * xi2 t + 2 * sqrt P_up * xi * phi t)).
    - apply Rmult_le_compat_l; [lra | exact P1].
    - rewrite Exi. assert (Q : 2 * w_x * sqrt P_up * xi * phi t <= 2 * w_x * sqrt P_up * xi * (k_f * Rabs (et t))).
      { apply Rmult_le_compat_l.
        - repeat apply Rmult_le_pos; try lra. apply sqrt_pos.
        - apply Rle_trans with (2 := P4). apply Rle_abs. }
      lra. }
  assert (Q2 : 2 * et t * et' t + b * mu * ht * V' t
               = - 2 * sigma * et t ^ 2 + 2 * y_ b t * v - 2 * ht * y_ b t ^ 2).
  { rewrite L1, L2. unfold v, y_. ring. }
  unfold U'. rewrite Exi. lra.
Qed.

End Decrease.

(** ** Every larger gain *)

(** 10.4: without an input gain, C5 for sigma is C5 for every sigma' >= sigma, with the same witness. *)
Theorem C5_larger A p k_x ht D sigma sigma' :
  C5 A p k_x ht D sigma -> sigma <= sigma' -> C5 A p k_x ht D sigma'.
Proof. intros [H1 H2 H3 H4 H5 H6] Hs. split; lra. Qed.

(** 13.1: with a gain, ht' = ht sigma/sigma' serves sigma', if 0 is in the sector. *)
Theorem C5b_larger A p k_x ht D k_l mp b_lo b_hi sigma sigma' :
  0 < sigma <= sigma' -> 0 <= mp -> 0 <= k_l ->
  C5 A p k_x ht D sigma ->
  (forall b delta, b_lo <= b <= b_hi -> - k_l <= delta <= mp -> Rabs (1 + ht * (delta + (1 - b) * sigma)) <= D) ->
  let ht' := ht * sigma / sigma' in
  C5 A p k_x ht' D sigma' /\
  (forall b delta, b_lo <= b <= b_hi -> - k_l <= delta <= mp -> Rabs (1 + ht' * (delta + (1 - b) * sigma')) <= D).
Proof.
  intros Hs Hm Hkl [H1 H2 H3 H4 H5 H6] HD ht'.
  set (la := sigma / sigma'). assert (Hla : 0 < la <= 1).
  { split; [apply Rdiv_lt_0_compat; lra | apply div_le; lra]. }
  assert (Eh : ht' = la * ht) by (unfold ht', la; field; lra).
  assert (Es : sigma = la * sigma') by (unfold la; field; lra).
  split.
  - assert (K : ht' * k_x ^ 2 <= ht * k_x ^ 2) by (rewrite Eh; apply Rmult_le_compat_r; [apply pow2_ge_0 | nra]).
    split; try assumption; [rewrite Eh; nra | lra |].
    set (q := (p + k_x * D / 2) ^ 2) in *. assert (Hq : 0 <= q) by (unfold q; apply pow2_ge_0).
    assert (Q1 : q / (4 * A - ht' * k_x ^ 2) <= q / (4 * A - ht * k_x ^ 2)).
    { unfold Rdiv. apply Rmult_le_compat_l; [exact Hq|]. apply Rinv_le_contravar; lra. }
    assert (Q2 : 0 <= q / (4 * A - ht * k_x ^ 2)) by (apply Rmult_le_pos; [exact Hq | left; apply Rinv_0_lt_compat; lra]).
    assert (Q3 : D ^ 2 / (4 * ht') = D ^ 2 / (4 * ht) / la) by (rewrite Eh; field; lra).
    apply Rmult_lt_reg_l with la; [lra|]. rewrite <- Es, Q3.
    replace (la * (D ^ 2 / (4 * ht) / la + q / (4 * A - ht' * k_x ^ 2)))
      with (D ^ 2 / (4 * ht) + la * (q / (4 * A - ht' * k_x ^ 2))) by (field; lra).
    assert (la * (q / (4 * A - ht' * k_x ^ 2)) <= 1 * (q / (4 * A - ht * k_x ^ 2))); [|lra].
    apply Rmult_le_compat; try lra. apply Rmult_le_pos; [exact Hq|]. left. apply Rinv_0_lt_compat. lra.
  - intros b delta Hb Hd. pose proof (HD b delta Hb Hd) as B1. pose proof (HD b 0 Hb ltac:(lra)) as B2.
    apply Rabs_le_between in B1. apply Rabs_le_between in B2. apply Rabs_le_between.
    replace (1 + ht' * (delta + (1 - b) * sigma'))
      with (la * (1 + ht * (delta + (1 - b) * sigma)) + (1 - la) * (1 + ht * (0 + (1 - b) * sigma)))
      by (rewrite Eh, Es; ring).
    split; nra.
Qed.

(** 13.1, condition (B), is asked for at the two ends of the interval of gains: so it holds in between. *)
Theorem B_at_the_ends ht sigma b_lo b_hi b :
  0 < ht -> 0 < sigma -> b_lo <= b <= b_hi ->
  (1 + ht * (1 - b_lo) * sigma) ^ 2 <= 4 * ht * sigma -> (1 + ht * (1 - b_hi) * sigma) ^ 2 <= 4 * ht * sigma ->
  (1 + ht * (1 - b) * sigma) ^ 2 <= 4 * ht * sigma.
Proof.
  intros Hh Hs Hb H1 H2. assert (P : 0 < ht * sigma) by (apply Rmult_lt_0_compat; assumption).
  set (r := sqrt (4 * ht * sigma)). assert (Er : r * r = 4 * ht * sigma) by (apply sqrt_sqrt; lra).
  assert (Hr : 0 < r) by (apply sqrt_lt_R0; lra).
  assert (U : 1 + ht * (1 - b) * sigma <= r).
  { apply Rle_trans with (1 + ht * (1 - b_lo) * sigma); nra. }
  assert (L : - r <= 1 + ht * (1 - b) * sigma).
  { apply Rle_trans with (1 + ht * (1 - b_hi) * sigma); nra. }
  nra.
Qed.

(** 13.1, condition (B): where m < 0 is used as it is, positivity of the form for sigma and ht gives it for sigma' and
    ht' = ht sigma/sigma'. q2 is what the form has in xi^2 and xi phi: it does not change. *)
Definition form_b (q2 ht b delta sigma u_x et y : R) : R :=
  q2 + 2 * sigma * et ^ 2 - 2 * y * ((1 + ht * (delta + (1 - b) * sigma)) * et + ht * u_x) + 2 * ht * y ^ 2.

Theorem B_larger q2 ht b delta sigma sigma' u_x et :
  0 < ht -> 0 < sigma <= sigma' ->
  (1 + ht * (1 - b) * sigma) ^ 2 <= 4 * ht * sigma ->
  let la := sigma / sigma' in
  forall y, form_b q2 ht b delta sigma u_x et (la * y) <= form_b q2 (ht * la) b delta sigma' u_x et y.
Proof.
  intros Hh Hs HB la y. assert (Hla : 0 < la <= 1) by (split; [apply Rdiv_lt_0_compat; lra | apply div_le; lra]).
  assert (Es : sigma = la * sigma') by (unfold la; field; lra).
  assert (E : form_b q2 (ht * la) b delta sigma' u_x et y - form_b q2 ht b delta sigma u_x et (la * y)
              = (1 - la) / la * (2 * sigma * et ^ 2 - 2 * (la * y) * (1 + ht * (1 - b) * sigma) * et + 2 * ht * (la * y) ^ 2)).
  { unfold form_b. rewrite Es. field. lra. }
  assert (P : 0 <= 2 * sigma * et ^ 2 - 2 * (la * y) * (1 + ht * (1 - b) * sigma) * et + 2 * ht * (la * y) ^ 2).
  { set (z := la * y). set (q := 1 + ht * (1 - b) * sigma) in *.
    assert (0 <= 2 * ht * (2 * sigma * et ^ 2 - 2 * z * q * et + 2 * ht * z ^ 2)).
    { replace (2 * ht * (2 * sigma * et ^ 2 - 2 * z * q * et + 2 * ht * z ^ 2))
        with ((2 * ht * z - q * et) ^ 2 + (4 * ht * sigma - q ^ 2) * et ^ 2) by ring.
      pose proof (pow2_ge_0 (2 * ht * z - q * et)). pose proof (pow2_ge_0 et).
      assert (0 <= (4 * ht * sigma - q ^ 2) * et ^ 2) by (apply Rmult_le_pos; lra). lra. }
    apply Rnot_lt_le. intros C. nra. }
  assert (0 <= (1 - la) / la * (2 * sigma * et ^ 2 - 2 * (la * y) * (1 + ht * (1 - b) * sigma) * et + 2 * ht * (la * y) ^ 2)).
  { apply Rmult_le_pos; [|exact P]. apply Rmult_le_pos; [lra|]. left. apply Rinv_0_lt_compat. lra. }
  lra.
Qed.
