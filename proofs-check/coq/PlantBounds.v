(** Sections 5, 10.4, 13.1 and 13.7: what is known of a plant, and what it contributes to U' in the error box. Known of it are bounding functions
    ([within]), or the values that stand in their place for the formulas of a plant, with a rate or with (M) ([bounded_decline]), or the two
    matrix inequalities of (Jm) ([bounded_joint]). *)

From Coq Require Import Reals Lra Lia.
From Coquelicot Require Import Coquelicot.
From SigmaStar Require Import Sums Containment Sizes.
Local Open Scope R_scope.

Section PlantBounds.
Variable c : numbers.

(** ** What is taken for granted of a plant

    The states are in any normed space. The bounds of derivatives are stated as what they say of differences (13.7a): a bound of
    a derivative on the convex set |x| <= X, |e| <= E is one of the difference quotients there, and an inequality that is affine in the
    derivatives holds of their averages. *)

Context {X : NormedModule R_AbsRing}.
Variables (f : R -> X -> R -> X) (q : R -> X -> R -> R).
(** J_0 t = df/dx(t,0,0), F below. P_1 t v = v' P_x(t) v, P below, and P_1' t v a = v' P_x'(t) v + 2 v' P_x(t) a is its derivative along
    v' = a. With joint metrics P_1 and p_1 v = p'v are of the near one, P_2 of the far one; else p_1 and P_2 are not used. *)
Record forms := {
  J_0 : R -> X -> X; P_1 : R -> X -> R; P_1' : R -> X -> X -> R;
  p_1 : X -> R; P_2 : R -> X -> R; P_2' : R -> X -> X -> R
}.
Variable m : forms.
Local Notation F := (J_0 m).
Local Notation P := (P_1 m).
Local Notation P' := (P_1' m).

Record quadratic_form : Prop := {
  form_low : forall t v, p_low c * norm v ^ 2 <= P t v;
  form_up : forall t v, P t v <= p_up c * norm v ^ 2;
  form_derive : forall t (v : R -> X) a, is_derive v t a -> is_derive (fun t => P t (v t)) t (P' t (v t) a);
  form_plus : forall t v a b, P' t v (plus a b) <= P' t v a + 2 * sqrt (P t v) * sqrt (P t b)
}.

(** Of a metric (A, p, w): A <= P_up, |p|, and that it is not below diag(x_low, 0) nor diag(0, e_low). *)
Record metric_form (x : extent) (A : R -> X -> R) (A' : R -> X -> X -> R) (p : X -> R) : Prop := {
  metric_low_x : forall t v e, x_low x * norm v ^ 2 <= A t v + 2 * e * p v + weight x * e ^ 2;
  metric_low_e : forall t v e, e_low x * e ^ 2 <= A t v + 2 * e * p v + weight x * e ^ 2;
  metric_up : forall t v, A t v <= P_up x * norm v ^ 2;
  metric_cross : forall v, Rabs (p v) <= cross x * norm v;
  metric_derive : forall t (v : R -> X) a, is_derive v t a -> is_derive (fun t => A t (v t)) t (A' t (v t) a);
  metric_cross_derive : forall t (v : R -> X) a, is_derive v t a -> is_derive (fun t => p (v t)) t (p a)
}.

(** The bounds of the derivatives, each at the arguments at which section 5 takes it: b_qx; b_qe, and q_e_max where it is given, as the slope
    of q in e; b_fe. *)
Record bounded_q : Prop := {
  bounded_qx : forall t v v' e, norm v <= X_b c -> norm v' <= X_b c -> Rabs e <= E_q c ->
    Rabs (q t v e - q t v' e) <= b_x c * norm (minus v v');
  bounded_qe : forall t v e e', norm v <= X_q c -> Rabs e <= E_b c -> Rabs e' <= E_b c ->
    exists delta, q t v e - q t v e' = delta * (e - e') /\ - k_l c <= delta <= most c
}.

Definition bounded_fe : Prop := forall t v e e', norm v <= X_f c -> Rabs e <= E_b c -> Rabs e' <= E_b c ->
  norm (minus (f t v e) (f t v e')) <= k_f c * Rabs (e - e').

(** A rate of contraction of df/dx in the same P. *)
Definition bounded_rate (a : R) : Prop := forall t v v' e, norm v <= X_b c -> norm v' <= X_b c -> Rabs e <= E_f c ->
  P' t (minus v v') (minus (f t v e) (f t v' e)) <= - 2 * a * P t (minus v v').

Record within (o : functions) : Prop := {
  (** (1.3). *)
  within_triple : forall t v, P' t v (F t v) <= - 2 * alpha c * P t v;
  (** b_fxx, b_fex: df/dx along the segment from xp, at e, against F (the proof of Lemma 5.1). *)
  within_fx : forall t v xp e, norm xp <= x_per c -> norm (minus v xp) <= D_x c -> Rabs e <= E_f c ->
    norm (minus (minus (f t v e) (f t xp e)) (F t (minus v xp))) <= bend c o * norm (minus v xp);
  (** [rate], where it is given. *)
  within_rate : match rate c with None => True | Some a => bounded_rate (a (X_b c) (E_f c)) end
}.

(** The form of (M) with p' in the place of (x'Px)': it is -U' at the gain tau, and b of 13.1 (1 without). *)
Definition form_at (b tau p' u d y : R) : R :=
  - w_x c * p' - 2 * ht c * (u + (1 - b) * tau * d) * y + 2 * tau * d ^ 2 - 2 * d * y + 2 * ht c * y ^ 2.

(** The values for the formulas of a plant, in its coordinates around the orbit (11): with (M) that F >= 0 at (xt, et, y), at both ends of b,
    for the averages of the derivatives between the points. *)
Definition bounded_decline (d : decline) : Prop :=
  match d with
  | by_norms _ rate _ => bounded_fe /\ bounded_rate (value rate)
  | by_matrix k =>
      forall b t v xp e ep y, b = b_lo c \/ b = b_hi c ->
        norm v <= X_m k -> Rabs e <= E_m k -> norm xp <= X_per_m k -> Rabs ep <= E_per_m k ->
        0 <= form_at b (tau_m k) (P' t (minus v xp) (minus (f t v e) (f t xp ep)) + 2 * delta_m k * P t (minus v xp))
               (q t v e - q t xp ep) (e - ep) y
  end.

(** (Jm): the forms F of the near metric at the threshold, and G of (13.7e), are not below the diagonal ones, likewise. u is the
    difference of q, d that of e. *)
Definition near_form (j : joint) (t : R) (x a : X) (u d y : R) : R :=
  - (P' t x a + 2 * (y - tau_j j * d) * p_1 m x + 2 * d * p_1 m a + 2 * weight (near_x j) * d * (y - tau_j j * d))
  + k_p (near_m j) * y * (y - u).
Definition far_form (j : joint) (t : R) (x a : X) (u d y : R) : R :=
  - P_2' m t x a + 2 * tau_j j * d * p_1 m x + 2 * tau_j j * (weight (near_x j) + weight (far_x j)) * d ^ 2
  - 2 * weight (far_x j) * d * y + k_p (far_m j) * y * (y - u).
Definition least_form (k : metric) (x : X) (d y : R) : R := c_x k * norm x ^ 2 + c_e k * d ^ 2 + c_y k * y ^ 2.
Definition bounded_joint (j : joint) : Prop :=
  forall t v xp e ep y, norm v <= X_j j -> Rabs e <= E_j j -> norm xp <= X_j j -> Rabs ep <= E_j j ->
    let x := minus v xp in let a := minus (f t v e) (f t xp ep) in let u := q t v e - q t xp ep in
    least_form (near_m j) x (e - ep) y <= near_form j t x a u (e - ep) y /\
    least_form (far_m j) x (e - ep) y <= far_form j t x a u (e - ep) y.

(** What is taken for granted, of each kind. *)
Definition about : Prop :=
  match known c with
  | by_functions o => quadratic_form /\ bounded_q /\ bounded_fe /\ within o
  | by_formulas k => quadratic_form /\ bounded_q /\ bounded_decline (of_decline k)
  | by_metrics j =>
      metric_form (near_x j) P P' (p_1 m) /\ metric_form (far_x j) (P_2 m) (P_2' m) (fun _ => 0) /\ bounded_joint j
  end.

(** ** The proof *)

Hypothesis form : quadratic_form.
Hypothesis of_q : bounded_q.
Hypothesis boxes : 0 < D_x c /\ 0 < D_e c.
Hypothesis conditions : by_square c.

Let p_low_pos : 0 < p_low c. Proof. apply (signs_w _ conditions). Qed.
Let p_up_pos : 0 < p_up c. Proof. apply (signs_w _ conditions). Qed.

Lemma P_nonneg t v : 0 <= P t v.
Proof.
  apply Rle_trans with (2 := form_low form t v). apply Rmult_le_pos; [lra | apply pow2_ge_0].
Qed.

Lemma norm_le_xi t v : norm v <= sqrt (P t v) / sqrt (p_low c).
Proof.
  assert (S : 0 < sqrt (p_low c)) by (apply sqrt_lt_R0; lra).
  apply le_div; [exact S|].
  rewrite <- (sqrt_pow2 (norm v)) by apply norm_ge_0. rewrite <- sqrt_mult by (try apply pow2_ge_0; lra).
  apply sqrt_le_1_alt. pose proof (form_low form t v). lra.
Qed.

Lemma xi_le_norm t v : sqrt (P t v) <= sqrt (p_up c) * norm v.
Proof.
  rewrite <- (sqrt_pow2 (norm v)) at 1 by apply norm_ge_0. rewrite <- sqrt_mult by (try apply pow2_ge_0; lra).
  apply sqrt_le_1_alt. pose proof (form_up form t v). lra.
Qed.

Lemma xi_square t v : sqrt (P t v) ^ 2 = P t v.
Proof. rewrite <- Rsqr_pow2. apply Rsqr_sqrt, P_nonneg. Qed.

Let D_x_pos : 0 < D_x c. Proof. apply boxes. Qed.
Let D_e_pos : 0 < D_e c. Proof. apply boxes. Qed.

Lemma E_at_le p : e_per c <= E_at c p <= E_b c.
Proof. unfold E_at, E_b. destruct p; lra. Qed.

Lemma X_at_le p : x_per c <= X_at c p <= X_b c.
Proof. unfold X_at, X_b. destruct p; lra. Qed.

(** The part in x of a difference of f, at e: Lemma 5.1, with a_2. *)
Lemma state_part o t v xp e : known c = by_functions o -> within o -> norm xp <= x_per c -> norm (minus v xp) <= D_x c -> Rabs e <= E_f c ->
  P' t (minus v xp) (minus (f t v e) (f t xp e)) <= - 2 * a_2 c * P t (minus v xp).
Proof.
  intros K W Hp Hd He.
  set (xi := sqrt (P t (minus v xp))).
  assert (Hxi : 0 <= xi) by apply sqrt_pos.
  assert (A1 : P' t (minus v xp) (minus (f t v e) (f t xp e)) <= - 2 * (alpha c - gam c o) * P t (minus v xp)).
  { set (r := minus (minus (f t v e) (f t xp e)) (F t (minus v xp))).
    assert (E : minus (f t v e) (f t xp e) = plus (F t (minus v xp)) r).
    { unfold r, minus. rewrite (plus_comm (F t _)), <- plus_assoc, plus_opp_l, plus_zero_r. reflexivity. }
    rewrite E. apply Rle_trans with (1 := form_plus form t (minus v xp) (F t (minus v xp)) r).
    pose proof (within_triple o W t (minus v xp)) as T1.
    pose proof (within_fx o W t v xp e Hp Hd He) as T2. fold r in T2. fold xi.
    assert (Sl : 0 < sqrt (p_low c)) by (apply sqrt_lt_R0; lra).
    assert (T3 : sqrt (P t r) <= sqrt (p_up c) * (bend c o * norm (minus v xp))).
    { apply Rle_trans with (1 := xi_le_norm t r). apply Rmult_le_compat_l; [apply sqrt_pos | exact T2]. }
    assert (T4 : xi * sqrt (P t r) <= gam c o * P t (minus v xp)).
    { assert (Eg : gam c o = sqrt (p_up c) / sqrt (p_low c) * bend c o) by (unfold gam; rewrite sqrt_div by lra; reflexivity).
      rewrite Eg, <- (xi_square t (minus v xp)). fold xi. set (G := bend c o) in *.
      destruct (Rle_lt_dec 0 G) as [HG|HG].
      - apply Rle_trans with (xi * (sqrt (p_up c) * (G * (xi / sqrt (p_low c))))).
        + apply Rmult_le_compat_l; [exact Hxi|]. apply Rle_trans with (1 := T3).
          apply Rmult_le_compat_l; [apply sqrt_pos|]. apply Rmult_le_compat_l; [exact HG | apply norm_le_xi].
        + right. field. lra.
      - (* then nothing differs *)
        assert (N0 : norm (minus v xp) = 0).
        { pose proof (norm_ge_0 r). pose proof (norm_ge_0 (minus v xp)).
          apply Rle_antisym; [|assumption]. apply Rnot_lt_le. intros C.
          assert (0 < - G * norm (minus v xp)) by (apply Rmult_lt_0_compat; lra). lra. }
        assert (X0 : xi = 0).
        { apply Rle_antisym; [|exact Hxi]. unfold xi. apply Rle_trans with (1 := xi_le_norm t _). rewrite N0. lra. }
        rewrite X0. right. ring. }
    nra. }
  unfold a_2. rewrite K. pose proof (within_rate o W) as Wr.
  destruct (rate c) as [a|]; [|exact A1].
  rewrite max2_Rmax. unfold Rmax. destruct (Rle_dec (alpha c - gam c o) (a (X_b c) (E_f c))) as [_|_]; [|exact A1].
  assert (Nv : norm v <= X_b c).
  { replace v with (plus xp (minus v xp)).
    - apply Rle_trans with (1 := norm_triangle _ _). unfold X_b. lra.
    - unfold minus. rewrite plus_comm, <- plus_assoc, plus_opp_l, plus_zero_r. reflexivity. }
  apply Wr; [exact Nv | unfold X_b; lra | exact He].
Qed.

(** ** The error box *)

Definition near (v xp : X) (e ep : R) : Prop :=
  norm xp <= x_per c /\ Rabs ep <= e_per c /\ norm (minus v xp) < D_x c /\ Rabs (e - ep) < D_e c.

Lemma near_norm v xp e ep : near v xp e ep -> norm v <= X_b c.
Proof.
  intros [Hxp [_ [Hx _]]]. replace v with (plus xp (minus v xp)).
  - apply Rle_trans with (1 := norm_triangle _ _). unfold X_b. lra.
  - unfold minus. rewrite plus_comm, <- plus_assoc, plus_opp_l, plus_zero_r. reflexivity.
Qed.

Lemma near_e v xp e ep : near v xp e ep -> Rabs e <= E_b c.
Proof.
  intros [_ [Hep [_ He]]]. replace e with (ep + (e - ep)) by ring. apply Rle_trans with (1 := Rabs_triang _ _). unfold E_b. lra.
Qed.

(** The point of the corner: where x is moved, e is [ec]; where e is moved, x is [vc]. *)
Lemma corner v xp e ep p : near v xp e ep -> exists ec vc, Rabs ec <= E_at c p /\ norm vc <= X_at c p /\
  ((ec = ep /\ vc = v) \/ (ec = e /\ vc = xp)).
Proof.
  intros H. pose proof (near_norm _ _ _ _ H). pose proof (near_e _ _ _ _ H). destruct H as [Hxp [Hep [Hx He]]].
  assert (Rabs ep <= E_b c) by (unfold E_b; lra). assert (norm xp <= X_b c) by (unfold X_b; lra).
  destruct p; [exists ep, v | exists e, xp | exists ep, v]; unfold E_at, X_at; (split; [|split]); auto.
Qed.

Lemma q_part t v xp e ep : near v xp e ep -> exists u_x delta,
  q t v e - q t xp ep = u_x + delta * (e - ep) /\ Rabs u_x <= k_x c * sqrt (P t (minus v xp)) /\ - k_l c <= delta <= most c.
Proof.
  intros H. destruct of_q as [Qx Qe].
  assert (Sl : 0 < sqrt (p_low c)) by (apply sqrt_lt_R0; lra).
  destruct (corner v xp e ep (path_q c) H) as [ec [vc [H1 [H2 H3]]]].
  assert (Nxp : norm xp <= X_b c) by (destruct H as [Hxp _]; unfold X_b; lra).
  assert (Nep : Rabs ep <= E_b c) by (destruct H as [_ [Hep _]]; unfold E_b; lra).
  destruct (Qe t vc e ep H2 (near_e _ _ _ _ H) Nep) as [delta [Q1 Q2]].
  exists (q t v ec - q t xp ec), delta. split; [destruct H3 as [[-> ->]|[-> ->]]; lra|]. split; [|exact Q2].
  apply Rle_trans with (1 := Qx t v xp ec (near_norm _ _ _ _ H) Nxp H1).
  pose proof (proj1 (nonneg _ conditions)) as K0. unfold k_x in *.
  assert (B0 : 0 <= b_x c).
  { apply Rmult_le_reg_r with (/ sqrt (p_low c)); [apply Rinv_0_lt_compat, Sl|]. rewrite Rmult_0_l. exact K0. }
  replace (b_x c / sqrt (p_low c) * sqrt (P t (minus v xp))) with (b_x c * (sqrt (P t (minus v xp)) / sqrt (p_low c))) by (field; lra).
  apply Rmult_le_compat_l; [exact B0 | apply norm_le_xi].
Qed.

(** f, where the decline is by norms. *)
Lemma f_known : (forall j, known c <> by_metrics j) -> about -> of_matrix c = None ->
  bounded_fe /\
  (forall t v xp e, norm xp <= x_per c -> norm (minus v xp) <= D_x c -> norm v <= X_b c -> Rabs e <= E_f c ->
    P' t (minus v xp) (minus (f t v e) (f t xp e)) <= - 2 * a_2 c * P t (minus v xp)).
Proof.
  intros J W N. unfold about in W. destruct (known c) as [o|k|j] eqn:K; [| |destruct (J j eq_refl)].
  - destruct W as [_ [_ [Wf W]]]. split; [exact Wf|]. intros t v xp e Hxp Hx _ He. apply (state_part o); assumption.
  - destruct W as [_ [_ W]]. unfold of_matrix in N. unfold a_2. rewrite K in *.
    destruct (of_decline k) as [fe rate most|k']; [|discriminate]. destruct W as [W1 W2]. split; [exact W1|].
    intros t v xp e Hxp Hx Hv He. apply W2; try assumption. unfold X_b. lra.
Qed.

Lemma f_part t v xp e ep : (forall j, known c <> by_metrics j) -> about -> of_matrix c = None -> near v xp e ep -> exists phi, Rabs phi <= k_f c * Rabs (e - ep) /\
  P' t (minus v xp) (minus (f t v e) (f t xp ep)) <= - 2 * a_2 c * P t (minus v xp) + 2 * sqrt (p_up c) * sqrt (P t (minus v xp)) * phi.
Proof.
  intros J A N H. destruct (f_known J A N) as [Fe Fx].
  destruct (corner v xp e ep (path_f c) H) as [ef [vf [F1 [F2 F3]]]].
  assert (Nep : Rabs ep <= E_b c) by (destruct H as [_ [Hep _]]; unfold E_b; lra).
  set (xi := sqrt (P t (minus v xp))).
  set (g := minus (f t vf e) (f t vf ep)).
  assert (Gb : norm g <= k_f c * Rabs (e - ep)) by (apply Fe; [exact F2 | apply (near_e _ _ _ _ H) | exact Nep]).
  assert (Split : minus (f t v e) (f t xp ep) = plus (minus (f t v ef) (f t xp ef)) g).
  { unfold g. destruct F3 as [[-> ->]|[-> ->]]; unfold minus.
    - rewrite (plus_comm (plus (f t v ep) _)), <- (plus_assoc (f t v e)), (plus_assoc (opp (f t v ep))), plus_opp_l, plus_zero_l.
      reflexivity.
    - rewrite <- (plus_assoc (f t v e)), (plus_assoc (opp (f t xp e))), plus_opp_l, plus_zero_l. reflexivity. }
  exists (norm g). split; [rewrite Rabs_right by (apply Rle_ge, norm_ge_0); exact Gb|].
  rewrite Split. apply Rle_trans with (1 := form_plus form t _ _ g).
  pose proof (Fx t v xp ef (proj1 H) (Rlt_le _ _ (proj1 (proj2 (proj2 H)))) (near_norm _ _ _ _ H) F1) as S1. fold xi.
  assert (xi * sqrt (P t g) <= xi * (sqrt (p_up c) * norm g)).
  { apply Rmult_le_compat_l; [apply sqrt_pos | apply xi_le_norm]. }
  lra.
Qed.

End PlantBounds.

Arguments forms : clear implicits.
