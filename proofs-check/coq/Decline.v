(** Sections 5, 10.4, 13.1 and 13.7: in the error box U' is at most a negative multiple of xt^2 + et^2 + s^2 + y^2, by C5 of what is known in
    norms, by (M) or by (Jm), for every gain from sigma on and every input gain. *)

From Coq Require Import Reals Lra Lia.
From Coquelicot Require Import Coquelicot.
From SigmaStar Require Import Sums Stability Containment Sizes PlantBounds.
Local Open Scope R_scope.

Section Decline.
Variable c : numbers.
Context {X : NormedModule R_AbsRing}.
Variables (f : R -> X -> R -> X) (q : R -> X -> R -> R).
Variable m : forms X.
Local Notation P := (P_1 m).
Local Notation P' := (P_1' m).
Hypothesis plant : about c f q m.
Hypothesis conditions : stability_conditions c.

(** ** U *)

(** The share of the near metric at the gain s; with an input gain that of h (Theorem G2). *)
Definition share (s : R) : R :=
  match known c with
  | by_metrics j => tau_j j / s
  | _ => match gain c with None => 1 | Some _ => threshold c / s end
  end.

(** U = W + of_zeta |zeta|_N^2, and the derivative of W along v' = a, e' = r. *)
Definition W (s t : R) (v : X) (e : R) : R :=
  match known c with
  | by_metrics j =>
      share s * (P t v + 2 * e * p_1 m v + weight (near_x j) * e ^ 2) + (1 - share s) * (P_2 m t v + weight (far_x j) * e ^ 2)
  | _ => w_x c * P t v + e ^ 2
  end.
Definition W' (s t : R) (v : X) (e : R) (a : X) (r : R) : R :=
  match known c with
  | by_metrics j =>
      share s * (P' t v a + 2 * r * p_1 m v + 2 * e * p_1 m a + 2 * weight (near_x j) * e * r)
      + (1 - share s) * (P_2' m t v a + 2 * weight (far_x j) * e * r)
  | _ => w_x c * P' t v a + 2 * e * r
  end.
Definition of_zeta (s b : R) : R :=
  match known c with
  | by_metrics j => (share s * k_p (near_m j) + (1 - share s) * k_p (far_m j)) * mu c / 2
  | _ => b * share s * h c
  end.

(** What U is at most on the set; and what times |x|^2 and e^2 it is not below. *)
Definition mixed (s : R) (of : metric -> extent -> R) (other : R) : R :=
  match known c with
  | by_metrics j => share s * of (near_m j) (near_x j) + (1 - share s) * of (far_m j) (far_x j)
  | _ => other
  end.
Definition top (s : R) : R := mixed s (level_of c) (level c).
Definition lo_x (s : R) : R := mixed s (fun _ => x_low) (w_x c * p_low c).
Definition lo_e (s : R) : R := mixed s (fun _ => e_low) 1.

(** U' <= -rho (xt^2 + et^2 + s^2 + y^2) in the error box; rho serves every N and solution. *)
Definition declining (s b rho : R) : Prop :=
  forall t v xp e ep z y, near c v xp e ep -> y = q t v e - q t xp ep + (1 - b) * s * (e - ep) + b * mu c * z ->
  W' s t (minus v xp) (e - ep) (minus (f t v e) (f t xp ep)) (y - s * (e - ep)) + of_zeta s b * (- 2 * z * y)
  <= - rho * (norm (minus v xp) ^ 2 + (e - ep) ^ 2 + z ^ 2 + y ^ 2).

Record descent (s b : R) : Prop := {
  W_derive : forall t (v : R -> X) (e : R -> R) a r, is_derive v t a -> is_derive e t r ->
    is_derive (fun t => W s t (v t) (e t)) t (W' s t (v t) (e t) a r);
  W_low : forall t v e, lo_x s * norm v ^ 2 <= W s t v e /\ lo_e s * e ^ 2 <= W s t v e;
  W_up : exists C, 0 < C /\ forall t v e, W s t v e <= C * (norm v ^ 2 + e ^ 2);
  W_start : forall t v e Z, norm v <= d_X c -> Rabs e <= d_E c -> 0 <= Z <= d_Z c ^ 2 -> W s t v e + of_zeta s b * Z <= top s;
  low_pos : 0 < lo_x s /\ 0 < lo_e s /\ 0 < of_zeta s b;
  top_below : top s < Rmin (lo_x s * D_x c ^ 2) (lo_e s * D_e c ^ 2);
  W_falls : exists rho, 0 < rho /\ declining s b rho
}.

Let mu_pos : 0 < mu c. Proof. apply (signs_b _ conditions). Qed.
Let sigma_pos : 0 < sigma c. Proof. apply (signs_b _ conditions). Qed.
Let D_x_pos : 0 < D_x c. Proof. apply (signs_b _ conditions). Qed.
Let D_e_pos : 0 < D_e c. Proof. apply (signs_b _ conditions). Qed.

Let b_range : 0 < b_lo c /\ b_lo c <= 1 /\ 1 <= b_hi c. Proof. exact (signs_g _ conditions). Qed.

(** ** By a square: C5 or (M) *)

Section Square.
Hypothesis no_joint : forall j, known c <> by_metrics j.

Let square : by_square c.
Proof. pose proof (stability _ conditions) as S. unfold of_its_kind in S. destruct (known c) as [o|k|j] eqn:K; [exact S | exact S | destruct (no_joint j eq_refl)]. Qed.
Let form : quadratic_form c m.
Proof. pose proof plant as A. unfold about in A. destruct (known c) as [o|k|j] eqn:K; [apply A | apply A | destruct (no_joint j eq_refl)]. Qed.
Let of_q : bounded_q c q.
Proof. pose proof plant as A. unfold about in A. destruct (known c) as [o|k|j] eqn:K; [apply A | apply A | destruct (no_joint j eq_refl)]. Qed.
Let p_low_pos : 0 < p_low c. Proof. apply (signs_w _ square). Qed.
Let p_up_pos : 0 < p_up c. Proof. apply (signs_w _ square). Qed.
Let w_x_pos : 0 < w_x c. Proof. apply (signs_w _ square). Qed.
Let h_pos : 0 < h c. Proof. apply (signs_w _ square). Qed.
Let P_nonneg := P_nonneg c m form square.
Let q_part := q_part c q m form of_q (conj D_x_pos D_e_pos) square.

Lemma square_forms s b t v e a r :
  W s t v e = w_x c * P t v + e ^ 2 /\ W' s t v e a r = w_x c * P' t v a + 2 * e * r /\ of_zeta s b = b * share s * h c /\
  top s = level c /\ lo_x s = w_x c * p_low c /\ lo_e s = 1.
Proof.
  unfold W, W', of_zeta, top, lo_x, lo_e, mixed. destruct (known c) as [o|k|j] eqn:K; [| |destruct (no_joint j eq_refl)]; repeat split.
Qed.

Lemma ht_pos : 0 < ht c.
Proof. unfold ht. apply Rdiv_lt_0_compat; lra. Qed.

Lemma threshold_pos : 0 < threshold c <= sigma c.
Proof. pose proof (C5b _ square) as Q. unfold threshold. destruct (of_matrix c); lra. Qed.

Lemma share_range s : sigma c <= s -> 0 < share s <= 1.
Proof.
  intros Hs. pose proof threshold_pos as T. unfold share.
  destruct (known c) as [o|k|j] eqn:K; [| |destruct (no_joint j eq_refl)]; (destruct (gain c); [|lra]);
    (split; [apply Rdiv_lt_0_compat; lra | apply div_le; lra]).
Qed.

(** What an error of the gain leaves: 2 (s - tau) et^2, with an input gain (1 - share) times what (B) says is not negative. *)
Definition left_over (s b d y : R) : R :=
  match gain c with
  | None => 2 * (s - threshold c) * d ^ 2
  | Some _ =>
      (1 - share s) * (2 * s * d ^ 2 - 2 * (1 + ht c * (1 - b) * threshold c) * d * y + 2 * ht c * share s * y ^ 2)
  end.

(** -U' at the gain s is the form at the threshold in share y, and this. *)
Lemma at_threshold s b p' u d y z : sigma c <= s -> b_lo c <= b <= b_hi c ->
  y = u + (1 - b) * s * d + b * mu c * z ->
  - (w_x c * p' + 2 * d * (y - s * d) + b * share s * h c * (- 2 * z * y))
  = form_at c b (threshold c) p' u d (share s * y) + left_over s b d y.
Proof.
  intros Hs Hb Ey. pose proof threshold_pos as T.
  assert (Eh : h c = ht c * mu c) by (unfold ht; field; lra). rewrite Eh.
  assert (Ez : b * mu c * z = y - u - (1 - b) * s * d) by lra.
  replace (b * share s * (ht c * mu c) * (-2 * z * y)) with (- 2 * share s * ht c * (b * mu c * z) * y) by ring. rewrite Ez.
  assert (L : match gain c with None => share s = 1 /\ b = 1 | Some _ => threshold c = share s * s end).
  { unfold share, b_lo, b_hi in *. destruct (known c) as [o|k|j] eqn:K; [| |destruct (no_joint j eq_refl)];
      (destruct (gain c); [field; lra | split; lra]). }
  unfold form_at, left_over. destruct (gain c).
  - rewrite L. ring.
  - destruct L as [-> ->]. ring.
Qed.

(** (B) at b. *)
Lemma B_at b i : gain c = Some i -> b_lo c <= b <= b_hi c ->
  (1 + ht c * (1 - b) * threshold c) ^ 2 < 4 * ht c * threshold c.
Proof.
  intros G Hb. pose proof (C5B _ square) as Q. rewrite G in Q. destruct Q as [Q1 Q2]. pose proof ht_pos. pose proof threshold_pos.
  (* a square is convex *)
  set (t := ht c * threshold c). assert (Ht : 0 < t) by (apply Rmult_lt_0_compat; lra).
  replace (ht c * (1 - b) * threshold c) with ((1 - b) * t) by (unfold t; ring).
  replace (ht c * (1 - b_lo c) * threshold c) with ((1 - b_lo c) * t) in Q1 by (unfold t; ring).
  replace (ht c * (1 - b_hi c) * threshold c) with ((1 - b_hi c) * t) in Q2 by (unfold t; ring).
  set (r := 4 * ht c * threshold c) in *.
  assert (U : (1 - b) * t <= (1 - b_lo c) * t) by (apply Rmult_le_compat_r; lra).
  assert (L : (1 - b_hi c) * t <= (1 - b) * t) by (apply Rmult_le_compat_r; lra).
  destruct (Rle_lt_dec 0 (1 + (1 - b) * t)) as [N|N].
  - apply Rle_lt_trans with (2 := Q1). apply pow_incr. lra.
  - apply Rle_lt_trans with (2 := Q2). replace ((1 + (1 - b) * t) ^ 2) with ((- (1 + (1 - b) * t)) ^ 2) by ring.
    replace ((1 + (1 - b_hi c) * t) ^ 2) with ((- (1 + (1 - b_hi c) * t)) ^ 2) by ring. apply pow_incr. lra.
Qed.

(** It is not negative, and above 0 in et beyond the threshold. *)
Lemma left_over_le s b : sigma c <= s -> b_lo c <= b <= b_hi c -> exists eps,
  0 <= eps /\ (threshold c < s -> 0 < eps) /\ forall d y, eps * d ^ 2 <= left_over s b d y.
Proof.
  intros Hs Hb. pose proof threshold_pos as T. unfold left_over. destruct (gain c) as [i|] eqn:G.
  - pose proof (B_at b i G Hb) as B. pose proof (share_range s Hs) as S. pose proof ht_pos as H.
    assert (Es : threshold c = share s * s).
    { unfold share. rewrite G. destruct (known c) as [o|k|j] eqn:K; [| |destruct (no_joint j eq_refl)]; field; lra. }
    set (l := share s) in *. set (r := 1 + ht c * (1 - b) * threshold c) in *. set (hl := ht c * l).
    assert (Hhl : 0 < hl) by (apply Rmult_lt_0_compat; lra).
    assert (B' : r ^ 2 < 4 * hl * s) by (replace (4 * hl * s) with (4 * ht c * threshold c) by (rewrite Es; unfold hl; ring); exact B).
    exists ((1 - l) * ((4 * hl * s - r ^ 2) / (2 * hl))).
    assert (E0 : 0 < (4 * hl * s - r ^ 2) / (2 * hl)) by (apply Rdiv_lt_0_compat; lra).
    split; [apply Rmult_le_pos; lra|]. split.
    + intros Ht. apply Rmult_lt_0_compat; [|exact E0].
      assert (l * s < 1 * s) by lra. assert (l < 1) by (apply Rmult_lt_reg_r with s; lra). lra.
    + intros d y. rewrite Rmult_assoc. apply Rmult_le_compat_l; [lra|].
      assert (E : 2 * s * d ^ 2 - 2 * r * d * y + 2 * ht c * l * y ^ 2 - (4 * hl * s - r ^ 2) / (2 * hl) * d ^ 2
                  = (2 * hl * y - r * d) ^ 2 / (2 * hl)) by (unfold hl; field; unfold hl in Hhl; split; lra).
      assert (0 <= (2 * hl * y - r * d) ^ 2 / (2 * hl)).
      { apply Rmult_le_pos; [apply pow2_ge_0 | left; apply Rinv_0_lt_compat; lra]. }
      lra.
  - exists (2 * (s - threshold c)). split; [lra|]. split; [lra|]. intros; lra.
Qed.

(** C5 at sigma. *)
Lemma base_by_norms : of_matrix c = None -> exists rho, 0 < rho /\
  forall b t v xp e ep y, b_lo c <= b <= b_hi c -> near c v xp e ep ->
  rho * (P t (minus v xp) + (e - ep) ^ 2 + y ^ 2)
  <= form_at c b (threshold c) (P' t (minus v xp) (minus (f t v e) (f t xp ep))) (q t v e - q t xp ep) (e - ep) y.
Proof.
  intros N. pose proof ht_pos as Hht. pose proof (C5_ _ square) as Q5. pose proof (C5b _ square) as Q5b. rewrite N in Q5, Q5b.
  destruct (nonneg _ square) as [Kx Kf].
  assert (Hsize : forall b delta, b_lo c <= b <= b_hi c -> - k_l c <= delta <= most c ->
            Rabs (1 + ht c * (delta + (1 - b) * sigma c)) <= size c).
  { intros b delta Hb Hd. unfold size. rewrite max2_Rmax.
    apply (corner_bound (ht c) (sigma c) (b_lo c) (b_hi c) (k_l c) (most c)); try assumption; [apply Rmax_l|].
    replace (1 + ht c * (- k_l c + (1 - b_hi c) * sigma c)) with (1 - ht c * (k_l c - (1 - b_hi c) * sigma c)) by ring. apply Rmax_r. }
  assert (C : C5 (w_x c * a_2 c) (w_x c * sqrt (p_up c) * k_f c) (k_x c) (ht c) (size c) (sigma c)).
  { split; try assumption.
    - apply Rmult_le_pos; [|exact Kf]. apply Rmult_le_pos; [lra | apply sqrt_pos].
    - unfold size. rewrite max2_Rmax. apply Rle_trans with (2 := Rmax_l _ _). apply Rabs_pos. }
  destruct (C5_form _ _ _ _ _ _ C) as [rho [Hrho Fm]]. exists rho. split; [exact Hrho|].
  intros b t v xp e ep y Hb H.
  destruct (q_part t v xp e ep H) as [u_x [delta [Q1 [Q2 Q3]]]].
  destruct (f_part c f q m form (conj D_x_pos D_e_pos) square t v xp e ep no_joint plant N H) as [phi [F1 F2]].
  set (d := e - ep) in *. set (xi2 := P t (minus v xp)) in *. set (xi2' := P' t (minus v xp) (minus (f t v e) (f t xp ep))) in *.
  set (xi := sqrt xi2) in *. assert (Hxi : 0 <= xi) by apply sqrt_pos.
  assert (Exi : xi2 = xi ^ 2) by (unfold xi; rewrite <- Rsqr_pow2, Rsqr_sqrt; [reflexivity | apply P_nonneg]).
  set (v' := (1 + ht c * (delta + (1 - b) * sigma c)) * d + ht c * u_x).
  assert (Hv : Rabs v' <= size c * Rabs d + ht c * k_x c * xi).
  { unfold v'. apply Rle_trans with (1 := Rabs_triang _ _). rewrite !Rabs_mult. apply Rplus_le_compat.
    - apply Rmult_le_compat_r; [apply Rabs_pos | apply Hsize; assumption].
    - rewrite (Rabs_right (ht c)) by lra. rewrite Rmult_assoc. apply Rmult_le_compat_l; [lra | exact Q2]. }
  specialize (Fm xi d y v' Hxi Hv).
  assert (S1 : w_x c * xi2' <= - 2 * (w_x c * a_2 c) * xi ^ 2 + 2 * (w_x c * sqrt (p_up c) * k_f c) * xi * Rabs d).
  { apply Rle_trans with (w_x c * (- 2 * a_2 c * xi2 + 2 * sqrt (p_up c) * xi * phi)).
    - apply Rmult_le_compat_l; [lra | exact F2].
    - rewrite Exi. assert (2 * w_x c * sqrt (p_up c) * xi * phi <= 2 * w_x c * sqrt (p_up c) * xi * (k_f c * Rabs d)).
      { apply Rmult_le_compat_l.
        - repeat apply Rmult_le_pos; try lra. apply sqrt_pos.
        - apply Rle_trans with (2 := F1). apply Rle_abs. }
      lra. }
  assert (Et : threshold c = sigma c) by (unfold threshold; rewrite N; reflexivity).
  unfold form_at. rewrite Et, Q1, Exi.
  replace (- w_x c * xi2' - 2 * ht c * (u_x + delta * d + (1 - b) * sigma c * d) * y + 2 * sigma c * d ^ 2 - 2 * d * y + 2 * ht c * y ^ 2)
    with (- (w_x c * xi2') + 2 * sigma c * d ^ 2 - 2 * y * v' + 2 * ht c * y ^ 2) by (unfold v'; ring). lra.
Qed.

(** (M): a margin in xi, and a square. *)
Lemma base_by_matrix k : of_matrix c = Some k ->
  forall b t v xp e ep y, b_lo c <= b <= b_hi c -> near c v xp e ep ->
  let d := e - ep in let u := q t v e - q t xp ep in
  2 * w_x c * delta_m k * P t (minus v xp) + 2 * ht c * (y - ((u + (1 - b) * threshold c * d) / 2 + d / (2 * ht c))) ^ 2
  <= form_at c b (threshold c) (P' t (minus v xp) (minus (f t v e) (f t xp ep))) u d y.
Proof.
  intros M b t v xp e ep y Hb H d u. pose proof ht_pos as Hht.
  assert (Et : threshold c = tau_m k) by (unfold threshold; rewrite M; reflexivity). rewrite Et.
  set (p0 := P t (minus v xp)). set (p' := P' t (minus v xp) (minus (f t v e) (f t xp ep))).
  assert (Fm : forall b', b' = b_lo c \/ b' = b_hi c -> forall r, 0 <= form_at c b' (tau_m k) (p' + 2 * delta_m k * p0) u d r).
  { intros b' E r. pose proof plant as A. unfold about in A. pose proof (domain_b _ square) as D. unfold of_matrix in M.
    destruct (known c) as [o|v'|j]; [discriminate| |discriminate]. destruct A as [_ [_ A]]. destruct D as [_ [_ D]].
    destruct (of_decline v') as [|k']; [discriminate|]. injection M as ->. simpl in A, D. destruct D as [D1 [D2 [D3 D4]]].
    pose proof (near_norm c _ _ _ _ H) as Nv. pose proof (near_e c _ _ _ _ H) as Ne. destruct H as [Hxp [Hep _]].
    apply (A b' t v xp e ep r E); lra. }
  (* affine in b *)
  assert (Fb : forall r, 0 <= form_at c b (tau_m k) (p' + 2 * delta_m k * p0) u d r).
  { intros r. pose proof (Fm _ (or_introl eq_refl) r) as F0. pose proof (Fm _ (or_intror eq_refl) r) as F1. unfold form_at in *.
    set (g := 2 * ht c * tau_m k * d * r). destruct (Rle_lt_dec 0 g) as [G|G]; unfold g in G; nra. }
  set (r := (u + (1 - b) * tau_m k * d) / 2 + d / (2 * ht c)). specialize (Fb r).
  assert (E : form_at c b (tau_m k) p' u d y
              = form_at c b (tau_m k) (p' + 2 * delta_m k * p0) u d r + 2 * w_x c * delta_m k * p0 + 2 * ht c * (y - r) ^ 2).
  { unfold form_at, r. field. lra. }
  rewrite E. lra.
Qed.

(** From y up to a known part to y, s and the rest. *)
Lemma collect s b K rho : 0 < rho -> 0 <= K -> sigma c <= s -> b_lo c <= b <= b_hi c -> exists rho', 0 < rho' /\
  forall n2 p0 d u g y z, 0 <= n2 -> p_low c * n2 <= p0 -> u ^ 2 <= K * (p0 + d ^ 2) -> (share s * y - g) ^ 2 <= K * (p0 + d ^ 2) ->
  y = u + (1 - b) * s * d + b * mu c * z ->
  rho' * (n2 + d ^ 2 + z ^ 2 + y ^ 2) <= rho * (p0 + d ^ 2 + g ^ 2).
Proof.
  intros Hr HK Hs Hb. pose proof (share_range s Hs) as S. set (l := share s) in *.
  assert (Bm : 0 < b * mu c) by (apply Rmult_lt_0_compat; lra).
  set (C1 := 2 * (1 + K) / l ^ 2). set (C2 := 3 * (C1 + K + ((1 - b) * s) ^ 2) / (b * mu c) ^ 2).
  assert (L2 : 0 < l ^ 2) by (apply pow_lt; lra). assert (B2 : 0 < (b * mu c) ^ 2) by (apply pow_lt; lra).
  assert (H1 : 0 < C1) by (apply Rdiv_lt_0_compat; lra).
  assert (H2 : 0 < C2) by (apply Rdiv_lt_0_compat; [pose proof (pow2_ge_0 ((1 - b) * s)); lra | exact B2]).
  assert (H3 : 0 < / p_low c) by (apply Rinv_0_lt_compat; lra).
  set (C := / p_low c + 1 + C1 + C2). exists (rho / C). split; [apply Rdiv_lt_0_compat; unfold C; lra|].
  intros n2 p0 d u g y z Hn Hp Hu Hy Ey.
  assert (P0 : 0 <= p0) by (apply Rle_trans with (2 := Hp), Rmult_le_pos; lra).
  set (D := p0 + d ^ 2 + g ^ 2). pose proof (pow2_ge_0 d) as D0. pose proof (pow2_ge_0 g) as G0.
  assert (HD : 0 <= D) by (unfold D; lra). assert (KD : 0 <= K * g ^ 2) by (apply Rmult_le_pos; lra).
  assert (KP : 0 <= K * (p0 + d ^ 2)) by (apply Rmult_le_pos; lra).
  assert (Q1 : y ^ 2 <= C1 * D).
  { replace (C1 * D) with (2 * (1 + K) * D / l ^ 2) by (unfold C1; field; lra). apply Rmult_le_reg_r with (l ^ 2); [exact L2|].
    replace (2 * (1 + K) * D / l ^ 2 * l ^ 2) with (2 * (1 + K) * D) by (field; lra).
    replace (y ^ 2 * l ^ 2) with ((l * y) ^ 2) by ring. pose proof (pow2_ge_0 (l * y - 2 * g)). unfold D. lra. }
  assert (Q2 : z ^ 2 <= C2 * D).
  { replace (C2 * D) with (3 * (C1 + K + ((1 - b) * s) ^ 2) * D / (b * mu c) ^ 2) by (unfold C2; field; lra).
    apply Rmult_le_reg_r with ((b * mu c) ^ 2); [exact B2|].
    replace (3 * (C1 + K + ((1 - b) * s) ^ 2) * D / (b * mu c) ^ 2 * (b * mu c) ^ 2) with (3 * (C1 + K + ((1 - b) * s) ^ 2) * D) by (field; lra).
    replace (z ^ 2 * (b * mu c) ^ 2) with ((y - u - (1 - b) * s * d) ^ 2) by (rewrite Ey; ring).
    set (k := (1 - b) * s) in *.
    assert (R0 : (y - u - k * d) ^ 2 <= 3 * (y ^ 2 + u ^ 2 + k ^ 2 * d ^ 2)).
    { pose proof (pow2_ge_0 (y + u)). pose proof (pow2_ge_0 (y + k * d)). pose proof (pow2_ge_0 (u - k * d)).
      replace (k ^ 2 * d ^ 2) with ((k * d) ^ 2) by ring. lra. }
    assert (R1 : k ^ 2 * d ^ 2 <= k ^ 2 * D) by (apply Rmult_le_compat_l; [apply pow2_ge_0 | unfold D; lra]).
    unfold D in *. lra. }
  assert (Q3 : n2 <= / p_low c * D).
  { apply Rmult_le_reg_l with (p_low c); [lra|]. replace (p_low c * (/ p_low c * D)) with D by (field; lra). unfold D. lra. }
  apply Rle_trans with (rho / C * (C * D)).
  - apply Rmult_le_compat_l; [left; apply Rdiv_lt_0_compat; unfold C; lra|]. unfold C. assert (d ^ 2 <= D) by (unfold D; lra). lra.
  - right. field. unfold C. lra.
Qed.

(** The difference of q in the box. *)
Lemma q_square : exists K, 0 <= K /\ forall t v xp e ep, near c v xp e ep ->
  (q t v e - q t xp ep) ^ 2 <= K * (P t (minus v xp) + (e - ep) ^ 2).
Proof.
  set (K := 2 * (k_x c ^ 2 + (k_l c ^ 2 + most c ^ 2))). exists K.
  pose proof (pow2_ge_0 (k_x c)) as K0. pose proof (pow2_ge_0 (k_l c)). pose proof (pow2_ge_0 (most c)). split; [unfold K; lra|].
  intros t v xp e ep Near. destruct (q_part t v xp e ep Near) as [u_x [delta [E [Q2 Q3]]]]. rewrite E.
  set (p0 := P t (minus v xp)) in *. set (d := e - ep) in *. assert (P0 : 0 <= p0) by apply P_nonneg.
  assert (R1 : u_x ^ 2 <= k_x c ^ 2 * p0).
  { replace p0 with (sqrt p0 ^ 2) by (rewrite <- Rsqr_pow2; apply Rsqr_sqrt, P0).
    rewrite <- Rpow_mult_distr, <- (pow2_abs u_x). apply pow_incr. split; [apply Rabs_pos | exact Q2]. }
  assert (R2 : delta ^ 2 <= k_l c ^ 2 + most c ^ 2).
  { destruct (Rle_lt_dec 0 delta).
    - assert (delta ^ 2 <= most c ^ 2) by (apply pow_incr; lra). lra.
    - assert ((- delta) ^ 2 <= k_l c ^ 2) by (apply pow_incr; lra). lra. }
  assert (R3 : delta ^ 2 * d ^ 2 <= (k_l c ^ 2 + most c ^ 2) * d ^ 2) by (apply Rmult_le_compat_r; [apply pow2_ge_0 | exact R2]).
  pose proof (pow2_ge_0 (u_x - delta * d)) as R4. pose proof (pow2_ge_0 d) as D0. unfold K.
  assert (0 <= k_x c ^ 2 * d ^ 2) by (apply Rmult_le_pos; lra).
  assert (0 <= (k_l c ^ 2 + most c ^ 2) * p0) by (apply Rmult_le_pos; lra). nra.
Qed.

Lemma square_falls s b : sigma c <= s -> b_lo c <= b <= b_hi c -> exists rho, 0 < rho /\ declining s b rho.
Proof.
  intros Hs Hb. pose proof ht_pos as Hht. pose proof threshold_pos as T. pose proof (share_range s Hs) as S.
  destruct q_square as [K [HK Hq]]. destruct (left_over_le s b Hs Hb) as [eps [He0 [He1 He]]].
  (* -U' is at least rho (xi^2 + et^2 + g^2), where share y is g up to what is known *)
  assert (A : exists rho K', 0 < rho /\ 0 <= K' /\ forall t v xp e ep y, near c v xp e ep -> exists g,
            (share s * y - g) ^ 2 <= K' * (P t (minus v xp) + (e - ep) ^ 2) /\
            rho * (P t (minus v xp) + (e - ep) ^ 2 + g ^ 2)
            <= form_at c b (threshold c) (P' t (minus v xp) (minus (f t v e) (f t xp ep))) (q t v e - q t xp ep) (e - ep) (share s * y)
               + left_over s b (e - ep) y).
  { destruct (of_matrix c) as [k|] eqn:M.
    - pose proof (C5_ _ square) as Hde. pose proof (C5b _ square) as Hta. rewrite M in Hde, Hta.
      assert (Et : threshold c = tau_m k) by (unfold threshold; rewrite M; reflexivity).
      set (a := 2 * w_x c * delta_m k). set (kp := 2 * ht c).
      assert (Ha : 0 < a) by (unfold a; apply Rmult_lt_0_compat; [lra | exact Hde]). assert (Hk : 0 < kp) by (unfold kp; lra).
      assert (Hep : 0 < eps) by (apply He1; lra).
      set (low := Rmin a (Rmin eps kp)). set (k1 := ((1 - b) * threshold c / 2 + / kp)).
      exists low, (K / 2 + 2 * k1 ^ 2). split; [unfold low; repeat apply Rmin_glb_lt; assumption|].
      split; [pose proof (pow2_ge_0 k1); lra|].
      intros t v xp e ep y H. pose proof (base_by_matrix k M b t v xp e ep (share s * y) Hb H) as B. cbv zeta in B.
      pose proof (Hq t v xp e ep H) as Q. pose proof (He (e - ep) y) as L.
      set (u := q t v e - q t xp ep) in *. set (d := e - ep) in *. set (p0 := P t (minus v xp)) in *.
      assert (P0 : 0 <= p0) by apply P_nonneg. pose proof (pow2_ge_0 d) as D0.
      set (r := (u + (1 - b) * threshold c * d) / 2 + d / (2 * ht c)) in *. exists (share s * y - r). split.
      + replace (share s * y - (share s * y - r)) with r by ring.
        assert (Er : r = u / 2 + k1 * d) by (unfold r, k1, kp; field; lra). rewrite Er.
        pose proof (pow2_ge_0 (u / 2 - k1 * d)). pose proof (pow2_ge_0 k1).
        assert (0 <= 2 * k1 ^ 2 * p0) by (apply Rmult_le_pos; lra). nra.
      + assert (L1 : low <= a) by apply Rmin_l. assert (L2 : low <= eps) by (apply Rle_trans with (1 := Rmin_r _ _), Rmin_l).
        assert (L3 : low <= kp) by (apply Rle_trans with (1 := Rmin_r _ _), Rmin_r).
        set (g := share s * y - r) in *. pose proof (pow2_ge_0 g) as G0.
        assert (low * p0 <= a * p0) by (apply Rmult_le_compat_r; assumption).
        assert (low * d ^ 2 <= eps * d ^ 2) by (apply Rmult_le_compat_r; assumption).
        assert (low * g ^ 2 <= kp * g ^ 2) by (apply Rmult_le_compat_r; assumption). unfold a, kp in *. lra.
    - destruct (base_by_norms M) as [rho [Hrho B]]. exists rho, 0. split; [exact Hrho|]. split; [lra|].
      intros t v xp e ep y H. exists (share s * y). split; [right; ring|].
      pose proof (B b t v xp e ep (share s * y) Hb H). pose proof (He (e - ep) y). pose proof (pow2_ge_0 (e - ep)).
      assert (0 <= eps * (e - ep) ^ 2) by (apply Rmult_le_pos; lra). lra. }
  destruct A as [rho [K' [Hrho [HK' A]]]].
  destruct (collect s b (K + K') rho Hrho ltac:(lra) Hs Hb) as [rho' [Hrho' B]]. exists rho'. split; [exact Hrho'|].
  intros t v xp e ep z y H Ey. destruct (A t v xp e ep y H) as [g [G1 G2]].
  destruct (square_forms s b t (minus v xp) (e - ep) (minus (f t v e) (f t xp ep)) (y - s * (e - ep))) as [_ [E1 [E2 _]]]. rewrite E1, E2.
  rewrite <- (at_threshold s b _ _ _ y z Hs Hb Ey) in G2.
  assert (P0 : 0 <= P t (minus v xp) + (e - ep) ^ 2) by (pose proof (P_nonneg t (minus v xp)); pose proof (pow2_ge_0 (e - ep)); lra).
  assert (0 <= K * (P t (minus v xp) + (e - ep) ^ 2)) by (apply Rmult_le_pos; lra).
  assert (0 <= K' * (P t (minus v xp) + (e - ep) ^ 2)) by (apply Rmult_le_pos; lra).
  pose proof (Hq t v xp e ep H).
  pose proof (B (norm (minus v xp) ^ 2) (P t (minus v xp)) (e - ep) (q t v e - q t xp ep) g y z (pow2_ge_0 _)
                (form_low c m form t _) ltac:(lra) ltac:(lra) Ey). lra.
Qed.

Lemma square_descent s b : sigma c <= s -> b_lo c <= b <= b_hi c -> descent s b.
Proof.
  intros Hs Hb. pose proof (share_range s Hs) as S.
  pose proof (fun t v e a r => square_forms s b t v e a r) as E.
  assert (Ew : forall t v e, W s t v e = w_x c * P t v + e ^ 2) by (intros t v e; apply (E t v e v 0)).
  destruct (E 0 zero 0 zero 0) as [_ [_ [Ez [Et [Ex Ee]]]]].
  assert (Hz : 0 < b * share s * h c) by (repeat apply Rmult_lt_0_compat; lra).
  split; rewrite ?Ez, ?Et, ?Ex, ?Ee.
  - intros t v e a r Hv He. destruct (E t (v t) (e t) a r) as [_ [-> _]].
    apply (is_derive_ext (fun t => w_x c * P t (v t) + e t ^ 2)); [intros; symmetry; apply Ew|]. evar_last.
    + apply @is_derive_plus; [apply is_derive_scal, (form_derive c m form t v a Hv) | apply (is_derive_pow e 2 t _ He)].
    + unfold plus; simpl. ring.
  - intros t v e. rewrite Ew. pose proof (form_low c m form t v) as Lo. pose proof (P_nonneg t v). pose proof (pow2_ge_0 e).
    assert (0 <= w_x c * P t v) by (apply Rmult_le_pos; lra).
    assert (w_x c * (p_low c * norm v ^ 2) <= w_x c * P t v) by (apply Rmult_le_compat_l; lra). lra.
  - exists (w_x c * p_up c + 1). assert (0 < w_x c * p_up c) by (apply Rmult_lt_0_compat; lra). split; [lra|].
    intros t v e. rewrite Ew. pose proof (form_up c m form t v). pose proof (pow2_ge_0 e). pose proof (pow2_ge_0 (norm v)).
    assert (w_x c * P t v <= w_x c * (p_up c * norm v ^ 2)) by (apply Rmult_le_compat_l; lra).
    assert (0 <= w_x c * p_up c * e ^ 2) by (apply Rmult_le_pos; lra). lra.
  - intros t v e Z Nv Ne HZ. rewrite Ew. unfold level.
    assert (A1 : w_x c * P t v <= w_x c * p_up c * d_X c ^ 2).
    { rewrite Rmult_assoc. apply Rmult_le_compat_l; [lra|]. apply Rle_trans with (1 := form_up c m form t v). apply Rmult_le_compat_l; [lra|].
      apply pow_incr. split; [apply norm_ge_0 | exact Nv]. }
    assert (A2 : e ^ 2 <= d_E c ^ 2).
    { rewrite <- (pow2_abs e). apply pow_incr. split; [apply Rabs_pos | exact Ne]. }
    assert (A3 : b * share s * h c * Z <= b_hi c * h c * d_Z c ^ 2).
    { apply Rmult_le_compat; try lra. apply Rmult_le_compat_r; [lra|].
      apply Rle_trans with (b * 1); [apply Rmult_le_compat_l; lra | lra]. }
    lra.
  - repeat split; [apply Rmult_lt_0_compat; lra | lra | exact Hz].
  - rewrite Rmult_1_l, <- min2_Rmin. apply (C4 _ square).
  - apply square_falls; assumption.
Qed.

End Square.

(** ** By joint metrics *)

(** Proposition 13.7.6: at the gain s = tau/l, -U' of the metric between the two is the form between F and G, and something nonnegative more. *)
Theorem joint_between j s t x a u d y z : known c = by_metrics j -> 0 < s -> y = u + mu c * z ->
  - (W' s t x d a (y - s * d) + of_zeta s 1 * (- 2 * z * y))
  = share s * near_form m j t x a u d y + (1 - share s) * far_form m j t x a u d y
    + 2 * s * weight (far_x j) * (1 - share s) ^ 2 * d ^ 2.
Proof.
  intros K Hs Ey. unfold W', of_zeta, near_form, far_form.
  assert (Et : tau_j j = share s * s) by (unfold share; rewrite K; field; lra). rewrite K, Et.
  assert (Ez : mu c * z = y - u) by lra. set (l := share s).
  replace ((l * k_p (near_m j) + (1 - l) * k_p (far_m j)) * mu c / 2 * (-2 * z * y))
    with (- (l * k_p (near_m j) + (1 - l) * k_p (far_m j)) * (mu c * z) * y) by field.
  rewrite Ez. ring.
Qed.

Section Joint.
Variable j : joint.
Hypothesis known_j : known c = by_metrics j.

Let joint_ : by_joint c j.
Proof. pose proof (stability _ conditions) as S. unfold of_its_kind in S. rewrite known_j in S. exact S. Qed.
Let near_ : metric_form (near_x j) P P' (p_1 m). Proof. pose proof plant as A. unfold about in A. rewrite known_j in A. apply A. Qed.
Let far_ : metric_form (far_x j) (P_2 m) (P_2' m) (fun _ => 0).
Proof. pose proof plant as A. unfold about in A. rewrite known_j in A. apply A. Qed.
Let forms_ : bounded_joint f q m j. Proof. pose proof plant as A. unfold about in A. rewrite known_j in A. apply A. Qed.

Lemma joint_share s : sigma c <= s -> 0 < share s <= 1.
Proof.
  intros Hs. pose proof (C5s _ _ joint_). pose proof (proj1 (signs_j _ _ joint_)). unfold share. rewrite known_j.
  split; [apply Rdiv_lt_0_compat; lra | apply div_le; lra].
Qed.

(** A mean of two numbers above 0. *)
Lemma mean_pos l a b : 0 < l <= 1 -> 0 < a -> 0 < b -> 0 < l * a + (1 - l) * b.
Proof. intros. assert (0 < l * a) by (apply Rmult_lt_0_compat; lra). assert (0 <= (1 - l) * b) by (apply Rmult_le_pos; lra). lra. Qed.

(** And of two inequalities. *)
Lemma mean_le l a b a' b' : 0 < l <= 1 -> a <= a' -> b <= b' -> l * a + (1 - l) * b <= l * a' + (1 - l) * b'.
Proof.
  intros. assert (l * a <= l * a') by (apply Rmult_le_compat_l; lra). assert ((1 - l) * b <= (1 - l) * b') by (apply Rmult_le_compat_l; lra).
  lra.
Qed.

Lemma joint_falls s : sigma c <= s -> exists rho, 0 < rho /\ declining s 1 rho.
Proof.
  intros Hs. pose proof (joint_share s Hs) as S. destruct (signs_j _ _ joint_) as [Tj [[[N1 [N2 [N3 N4]]] [N5 _]] [[F1 [F2 [F3 F4]]] [F5 _]]]].
  set (l := share s) in *.
  set (cx := l * c_x (near_m j) + (1 - l) * c_x (far_m j)). set (ce := l * c_e (near_m j) + (1 - l) * c_e (far_m j)).
  set (cy := l * c_y (near_m j) + (1 - l) * c_y (far_m j)). set (k := l * k_p (near_m j) + (1 - l) * k_p (far_m j)).
  set (w := l * weight (near_x j) + (1 - l) * weight (far_x j)).
  assert (Hcx : 0 < cx) by (apply mean_pos; assumption). assert (Hce : 0 < ce) by (apply mean_pos; assumption).
  assert (Hcy : 0 < cy) by (apply mean_pos; assumption). assert (Hk : 0 < k) by (apply mean_pos; assumption).
  set (cr := cross (near_x j)).
  (* -U' as a function of y: it is quadratic, above 0, so it bounds the slope of the linear part, and with it u *)
  set (low := Rmin cx (Rmin ce cy)). assert (Hl : 0 < low) by (unfold low; repeat apply Rmin_glb_lt; assumption).
  set (C0 := 8 * (l ^ 2 * cr ^ 2 + w ^ 2)).
  assert (H0 : 0 <= C0) by (unfold C0; pose proof (pow2_ge_0 w); assert (0 <= l ^ 2 * cr ^ 2) by (apply Rmult_le_pos; apply pow2_ge_0); lra).
  set (C1 := 3 * (/ low + 4 / k + C0 / k ^ 2 / low) / mu c ^ 2).
  assert (K2 : 0 < k ^ 2) by (apply pow_lt, Hk).
  assert (I1 : 0 < / low) by (apply Rinv_0_lt_compat, Hl). assert (I2 : 0 < 4 / k) by (apply Rdiv_lt_0_compat; lra).
  assert (I3 : 0 <= C0 / k ^ 2 / low).
  { apply Rmult_le_pos; [|lra]. apply Rmult_le_pos; [exact H0|]. left. apply Rinv_0_lt_compat, K2. }
  assert (H1 : 0 < C1) by (unfold C1; apply Rdiv_lt_0_compat; [lra | apply pow_lt; lra]).
  exists (/ (/ low + C1)). split; [apply Rinv_0_lt_compat; lra|].
  intros t v xp e ep z y H Ey.
  assert (Eu : y = q t v e - q t xp ep + mu c * z) by (rewrite Ey; ring). clear Ey.
  pose proof (near_norm c _ _ _ _ H) as Nv. pose proof (near_e c _ _ _ _ H) as Ne. destruct H as [Hxp [Hep _]].
  pose proof (C5x _ _ joint_) as Jx. pose proof (C5e _ _ joint_) as Je.
  assert (Xb : x_per c <= X_b c) by (unfold X_b; lra). assert (Eb : e_per c <= E_b c) by (unfold E_b; lra).
  assert (Fm : forall r, least_form (near_m j) (minus v xp) (e - ep) r
                   <= near_form m j t (minus v xp) (minus (f t v e) (f t xp ep)) (q t v e - q t xp ep) (e - ep) r /\
                 least_form (far_m j) (minus v xp) (e - ep) r
                   <= far_form m j t (minus v xp) (minus (f t v e) (f t xp ep)) (q t v e - q t xp ep) (e - ep) r).
  { intros r. apply forms_; lra. }
  set (x := minus v xp) in *. set (a := minus (f t v e) (f t xp ep)) in *. set (d := e - ep) in *. set (u := q t v e - q t xp ep) in *.
  set (Phi := fun r => l * near_form m j t x a u d r + (1 - l) * far_form m j t x a u d r + 2 * s * weight (far_x j) * (1 - l) ^ 2 * d ^ 2).
  assert (Lo : forall r, cx * norm x ^ 2 + ce * d ^ 2 + cy * r ^ 2 <= Phi r).
  { intros r. destruct (Fm r) as [Q1 Q2]. pose proof (mean_le l _ _ _ _ S Q1 Q2) as Q. unfold Phi.
    assert (0 <= 2 * s * weight (far_x j) * (1 - l) ^ 2 * d ^ 2).
    { apply Rmult_le_pos; [|apply pow2_ge_0]. apply Rmult_le_pos; [|apply pow2_ge_0]. apply Rmult_le_pos; lra. }
    apply Rle_trans with (l * least_form (near_m j) x d r + (1 - l) * least_form (far_m j) x d r); [|lra].
    right. unfold least_form, cx, ce, cy. ring. }
  set (B := k * u + 2 * l * p_1 m x + 2 * w * d).
  assert (Quad : forall r, Phi r = Phi y + (r - y) * (k * (r + y) - B)).
  { intros r. unfold Phi, near_form, far_form, B, k, w. ring. }
  set (n2 := norm x ^ 2) in *. assert (N0 : 0 <= n2) by apply pow2_ge_0. pose proof (pow2_ge_0 d) as D0. pose proof (pow2_ge_0 y) as Y0.
  assert (Phi0 : forall r, 0 <= Phi r).
  { intros r. apply Rle_trans with (2 := Lo r). pose proof (pow2_ge_0 r).
    assert (0 <= cx * n2) by (apply Rmult_le_pos; lra). assert (0 <= ce * d ^ 2) by (apply Rmult_le_pos; lra).
    assert (0 <= cy * r ^ 2) by (apply Rmult_le_pos; lra). lra. }
  assert (Disc : (2 * k * y - B) ^ 2 <= 4 * k * Phi y).
  { pose proof (Phi0 (B / (2 * k))) as Z. rewrite Quad in Z.
    assert (E : (B / (2 * k) - y) * (k * (B / (2 * k) + y) - B) = - ((2 * k * y - B) ^ 2 / (4 * k))) by (field; lra). rewrite E in Z.
    assert ((2 * k * y - B) ^ 2 / (4 * k) <= Phi y) by lra. apply Rmult_le_reg_r with (/ (4 * k)); [apply Rinv_0_lt_compat; lra|].
    replace (4 * k * Phi y * / (4 * k)) with (Phi y) by (field; lra). exact H. }
  assert (Low : low * (n2 + d ^ 2 + y ^ 2) <= Phi y).
  { apply Rle_trans with (2 := Lo y). fold n2.
    assert (L1 : low <= cx) by apply Rmin_l. assert (L2 : low <= ce) by (apply Rle_trans with (1 := Rmin_r _ _), Rmin_l).
    assert (L3 : low <= cy) by (apply Rle_trans with (1 := Rmin_r _ _), Rmin_r).
    assert (low * n2 <= cx * n2) by (apply Rmult_le_compat_r; assumption).
    assert (low * d ^ 2 <= ce * d ^ 2) by (apply Rmult_le_compat_r; assumption).
    assert (low * y ^ 2 <= cy * y ^ 2) by (apply Rmult_le_compat_r; assumption). lra. }
  assert (Sum : n2 + d ^ 2 + y ^ 2 <= / low * Phi y).
  { apply Rmult_le_reg_l with low; [exact Hl|]. replace (low * (/ low * Phi y)) with (Phi y) by (field; lra). exact Low. }
  set (g := 2 * l * p_1 m x + 2 * w * d).
  assert (G : g ^ 2 <= C0 * (n2 + d ^ 2)).
  { pose proof (metric_cross _ _ _ _ near_ x) as Cr. fold cr in Cr.
    assert (P2 : p_1 m x ^ 2 <= cr ^ 2 * n2).
    { unfold n2. rewrite <- Rpow_mult_distr, <- (pow2_abs (p_1 m x)). apply pow_incr. split; [apply Rabs_pos | exact Cr]. }
    assert (l ^ 2 * p_1 m x ^ 2 <= l ^ 2 * (cr ^ 2 * n2)) by (apply Rmult_le_compat_l; [apply pow2_ge_0 | exact P2]).
    pose proof (pow2_ge_0 (l * p_1 m x - w * d)). pose proof (pow2_ge_0 w).
    assert (0 <= w ^ 2 * n2) by (apply Rmult_le_pos; lra).
    assert (0 <= l ^ 2 * cr ^ 2 * d ^ 2) by (apply Rmult_le_pos; [apply Rmult_le_pos; apply pow2_ge_0 | lra]).
    unfold g, C0. replace ((2 * l * p_1 m x + 2 * w * d) ^ 2) with (8 * (l ^ 2 * p_1 m x ^ 2) + 8 * (w ^ 2 * d ^ 2) - 4 * (l * p_1 m x - w * d) ^ 2) by ring.
    lra. }
  assert (Z : z ^ 2 <= C1 * Phi y).
  { apply Rmult_le_reg_r with (mu c ^ 2); [apply pow_lt; lra|].
    replace (C1 * Phi y * mu c ^ 2) with (3 * (/ low * Phi y + 4 / k * Phi y + C0 / k ^ 2 / low * Phi y)) by (unfold C1; field; lra).
    replace (z ^ 2 * mu c ^ 2) with ((y + (B - 2 * k * y) / k - g / k) ^ 2)
      by (replace (z ^ 2 * mu c ^ 2) with ((y - u) ^ 2) by (rewrite Eu; ring); unfold B, g; field; lra).
    set (A2 := (B - 2 * k * y) / k). set (A3 := g / k).
    assert (R0 : (y + A2 - A3) ^ 2 <= 3 * (y ^ 2 + A2 ^ 2 + A3 ^ 2)).
    { pose proof (pow2_ge_0 (y - A2)). pose proof (pow2_ge_0 (y + A3)). pose proof (pow2_ge_0 (A2 + A3)). lra. }
    assert (R2 : A2 ^ 2 <= 4 / k * Phi y).
    { apply Rmult_le_reg_r with (k ^ 2); [exact K2|]. unfold A2. replace (((B - 2 * k * y) / k) ^ 2 * k ^ 2) with ((2 * k * y - B) ^ 2) by (field; lra).
      replace (4 / k * Phi y * k ^ 2) with (4 * k * Phi y) by (field; lra). exact Disc. }
    assert (R3 : A3 ^ 2 <= C0 / k ^ 2 / low * Phi y).
    { apply Rmult_le_reg_r with (k ^ 2); [exact K2|]. unfold A3. replace ((g / k) ^ 2 * k ^ 2) with (g ^ 2) by (field; lra).
      replace (C0 / k ^ 2 / low * Phi y * k ^ 2) with (C0 * (/ low * Phi y)) by (field; lra).
      apply Rle_trans with (1 := G). apply Rmult_le_compat_l; [exact H0 | lra]. }
    lra. }
  pose proof (joint_between j s t x a u d y z known_j ltac:(lra) Eu) as E. fold l in E. fold (Phi y) in E.
  assert (Den : 0 < / low + C1) by lra. set (den := / low + C1) in *.
  assert (Q : / den * (n2 + d ^ 2 + z ^ 2 + y ^ 2) <= Phi y).
  { apply Rmult_le_reg_l with den; [exact Den|].
    replace (den * (/ den * (n2 + d ^ 2 + z ^ 2 + y ^ 2))) with (n2 + d ^ 2 + z ^ 2 + y ^ 2) by (field; lra). unfold den. lra. }
  lra.
Qed.

Lemma joint_descent s : sigma c <= s -> descent s 1.
Proof.
  intros Hs. pose proof (joint_share s Hs) as S. destruct (signs_j _ _ joint_) as [Tj [Sn Sf]].
  destruct Sn as [[N1 _] [N5 [N6 [N7 [N8 N9]]]]]. destruct Sf as [[F1 _] [F5 [F6 [F7 [F8 F9]]]]].
  assert (Ew : forall t v e, W s t v e = share s * (P t v + 2 * e * p_1 m v + weight (near_x j) * e ^ 2)
                                     + (1 - share s) * (P_2 m t v + 2 * e * 0 + weight (far_x j) * e ^ 2)).
  { intros t v e. unfold W. rewrite known_j. ring. }
  assert (Em : forall of other, mixed s of other = share s * of (near_m j) (near_x j) + (1 - share s) * of (far_m j) (far_x j)).
  { intros. unfold mixed. rewrite known_j. reflexivity. }
  assert (Ez : of_zeta s 1 = (share s * k_p (near_m j) + (1 - share s) * k_p (far_m j)) * mu c / 2).
  { unfold of_zeta. rewrite known_j. reflexivity. }
  assert (Hz : 0 < of_zeta s 1).
  { rewrite Ez. pose proof (mean_pos _ _ _ S N1 F1). apply Rdiv_lt_0_compat; [apply Rmult_lt_0_compat; lra | lra]. }
  set (l := share s) in *.
  split; unfold lo_x, lo_e, top; rewrite ?Em.
  - intros t v e a r Hv He.
    set (g := fun t => l * (P t (v t) + 2 * (e t * p_1 m (v t)) + weight (near_x j) * e t ^ 2)
                       + (1 - l) * (P_2 m t (v t) + weight (far_x j) * e t ^ 2)).
    assert (Eg : forall r', g r' = W s r' (v r') (e r')) by (intros r'; rewrite Ew; unfold g; ring).
    apply (is_derive_ext g _ _ _ Eg). unfold g.
    unfold W'. rewrite known_j. evar_last.
    + apply @is_derive_plus; apply is_derive_scal; [apply @is_derive_plus; [apply @is_derive_plus|] | apply @is_derive_plus].
      * apply (metric_derive _ _ _ _ near_ t v a Hv).
      * apply is_derive_scal. apply (is_derive_mult e (fun t => p_1 m (v t)) t r (p_1 m a) He (metric_cross_derive _ _ _ _ near_ t v a Hv)).
        intros; apply Rmult_comm.
      * apply is_derive_scal. apply (is_derive_pow e 2 t _ He).
      * apply (metric_derive _ _ _ _ far_ t v a Hv).
      * apply is_derive_scal. apply (is_derive_pow e 2 t _ He).
    + fold l. unfold plus, mult; simpl. ring.
  - intros t v e. rewrite Ew. split.
    + apply Rle_trans with (l * (x_low (near_x j) * norm v ^ 2) + (1 - l) * (x_low (far_x j) * norm v ^ 2)); [right; ring|].
      apply mean_le; [exact S | apply (metric_low_x _ _ _ _ near_) | apply (metric_low_x _ _ _ _ far_)].
    + apply Rle_trans with (l * (e_low (near_x j) * e ^ 2) + (1 - l) * (e_low (far_x j) * e ^ 2)); [right; ring|].
      apply mean_le; [exact S | apply (metric_low_e _ _ _ _ near_) | apply (metric_low_e _ _ _ _ far_)].
  - set (C := fun x : extent => P_up x + cross x + weight x).
    assert (Up : forall x A A' (g : X -> R), 0 <= P_up x -> 0 <= cross x -> 0 <= weight x -> metric_form x A A' g ->
              forall t v e, A t v + 2 * e * g v + weight x * e ^ 2 <= C x * (norm v ^ 2 + e ^ 2)).
    { intros x A A' g Hp Hc Hw M t v e. pose proof (metric_up _ _ _ _ M t v) as U1. pose proof (metric_cross _ _ _ _ M v) as U2.
      pose proof (norm_ge_0 v) as V0. pose proof (pow2_ge_0 (norm v)) as V1. pose proof (pow2_ge_0 e) as E0. pose proof (Rabs_pos e) as E1.
      assert (U3 : e * g v <= Rabs e * (cross x * norm v)).
      { apply Rle_trans with (1 := Rle_abs _). rewrite Rabs_mult. apply Rmult_le_compat_l; assumption. }
      assert (U4 : 2 * (Rabs e * norm v) <= norm v ^ 2 + e ^ 2) by (rewrite <- (pow2_abs e); pose proof (pow2_ge_0 (norm v - Rabs e)); lra).
      assert (U5 : cross x * (2 * (Rabs e * norm v)) <= cross x * (norm v ^ 2 + e ^ 2)) by (apply Rmult_le_compat_l; assumption).
      assert (0 <= P_up x * e ^ 2) by (apply Rmult_le_pos; assumption). assert (0 <= weight x * norm v ^ 2) by (apply Rmult_le_pos; assumption).
      unfold C. lra. }
    exists (l * C (near_x j) + (1 - l) * C (far_x j) + 1).
    assert (0 <= l * C (near_x j)) by (apply Rmult_le_pos; unfold C; lra). assert (0 <= (1 - l) * C (far_x j)) by (apply Rmult_le_pos; unfold C; lra).
    split; [lra|]. intros t v e. rewrite Ew.
    pose proof (mean_le l _ _ _ _ S (Up _ _ _ _ N7 N6 N5 near_ t v e) (Up _ _ _ _ F7 F6 F5 far_ t v e)) as Q.
    pose proof (pow2_ge_0 (norm v)). pose proof (pow2_ge_0 e). cbv beta in Q. lra.
  - intros t v e Z Nv Ne HZ. rewrite Ew, Ez.
    assert (Up : forall k x A A' (g : X -> R), 0 <= P_up x -> 0 <= cross x -> 0 <= weight x -> 0 < k_p k -> metric_form x A A' g ->
              A t v + 2 * e * g v + weight x * e ^ 2 + k_p k * mu c / 2 * Z <= level_of c k x).
    { intros k x A A' g Hp Hc Hw Hk M. pose proof (metric_up _ _ _ _ M t v) as U1. pose proof (metric_cross _ _ _ _ M v) as U2.
      pose proof (norm_ge_0 v) as V0. pose proof (Rabs_pos e) as E1.
      assert (A1 : P_up x * norm v ^ 2 <= P_up x * d_X c ^ 2) by (apply Rmult_le_compat_l; [exact Hp | apply pow_incr; lra]).
      assert (A2 : weight x * e ^ 2 <= weight x * d_E c ^ 2).
      { apply Rmult_le_compat_l; [exact Hw|]. rewrite <- (pow2_abs e). apply pow_incr. lra. }
      assert (A3 : e * g v <= d_E c * (cross x * d_X c)).
      { apply Rle_trans with (1 := Rle_abs _). rewrite Rabs_mult. apply Rmult_le_compat; [exact E1 | apply Rabs_pos | exact Ne|].
        apply Rle_trans with (1 := U2). apply Rmult_le_compat_l; lra. }
      assert (A4 : k_p k * mu c / 2 * Z <= k_p k * mu c / 2 * d_Z c ^ 2).
      { apply Rmult_le_compat_l; [|lra]. left. apply Rdiv_lt_0_compat; [apply Rmult_lt_0_compat; lra | lra]. }
      unfold level_of. lra. }
    pose proof (mean_le l _ _ _ _ S (Up (near_m j) _ _ _ _ N7 N6 N5 N1 near_) (Up (far_m j) _ _ _ _ F7 F6 F5 F1 far_)) as Q.
    cbv beta in Q. lra.
  - repeat split; [apply mean_pos; assumption | apply mean_pos; assumption | exact Hz].
  - pose proof (C4_near _ _ joint_) as Q1. pose proof (C4_far _ _ joint_) as Q2. unfold C4_of in Q1, Q2. rewrite min2_Rmin in Q1, Q2.
    pose proof (Rmin_l (x_low (near_x j) * D_x c ^ 2) (e_low (near_x j) * D_e c ^ 2)).
    pose proof (Rmin_r (x_low (near_x j) * D_x c ^ 2) (e_low (near_x j) * D_e c ^ 2)).
    pose proof (Rmin_l (x_low (far_x j) * D_x c ^ 2) (e_low (far_x j) * D_e c ^ 2)).
    pose proof (Rmin_r (x_low (far_x j) * D_x c ^ 2) (e_low (far_x j) * D_e c ^ 2)).
    assert (Below : forall a b a' b', a < a' -> b < b' -> l * a + (1 - l) * b < l * a' + (1 - l) * b').
    { intros a b a' b' Ha Hb. assert (l * a < l * a') by (apply Rmult_lt_compat_l; lra).
      assert ((1 - l) * b <= (1 - l) * b') by (apply Rmult_le_compat_l; lra). lra. }
    apply Rmin_glb_lt.
    + apply Rlt_le_trans with (l * (x_low (near_x j) * D_x c ^ 2) + (1 - l) * (x_low (far_x j) * D_x c ^ 2)); [apply Below; lra | right; ring].
    + apply Rlt_le_trans with (l * (e_low (near_x j) * D_e c ^ 2) + (1 - l) * (e_low (far_x j) * D_e c ^ 2)); [apply Below; lra | right; ring].
  - apply joint_falls; assumption.
Qed.

End Joint.

(** What Claim.v takes of it all. *)
Theorem descends s b : sigma c <= s -> b_lo c <= b <= b_hi c -> descent s b.
Proof.
  intros Hs Hb. destruct (known c) as [o|k|j] eqn:K.
  - apply square_descent; try assumption. intros j. rewrite K. discriminate.
  - apply square_descent; try assumption. intros j. rewrite K. discriminate.
  - pose proof (stability _ conditions) as S. unfold of_its_kind in S. rewrite K in S. pose proof (gain_j _ _ S) as G.
    unfold b_lo, b_hi in Hb. destruct (gain c); [destruct G|]. replace b with 1 by lra. apply (joint_descent j K s Hs).
Qed.

End Decline.

Arguments descent c {X} f q m s b.
