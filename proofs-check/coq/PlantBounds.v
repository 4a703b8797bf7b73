(** Sections 5, 10.4 and 13.7: what a plant contributes to U' in the error box. Known of it are bounding functions ([within]), or the
    values that stand in their place for the formulas of a plant, with a rate or with (M) ([bounded]). *)

From Coq Require Import Reals Lra Lia.
From Coquelicot Require Import Coquelicot.
From SigmaStar Require Import Sums Stability Containment Sizes.
Local Open Scope R_scope.

Section PlantBounds.
Variable c : numbers.

(** ** What is taken for granted of a plant

    The states are in any normed space. The bounds of derivatives are stated as what they say of differences (13.1): a bound of
    a derivative on the convex set |x| <= X, |e| <= E is one of the difference quotients there, and an inequality that is affine in the
    derivatives holds of their averages. *)

Context {X : NormedModule R_AbsRing}.
Variables (f : R -> X -> R -> X) (q : R -> X -> R -> R).
(** F t = df/dx(t,0,0). P t v = v' P_x(t) v, and P' t v a = v' P_x'(t) v + 2 v' P_x(t) a is its derivative along v' = a. *)
Variables (F : R -> X -> X) (P : R -> X -> R) (P' : R -> X -> X -> R).

Record quadratic_form : Prop := {
  form_low : forall t v, p_low c * norm v ^ 2 <= P t v;
  form_up : forall t v, P t v <= p_up c * norm v ^ 2;
  form_derive : forall t (v : R -> X) a, is_derive v t a -> is_derive (fun t => P t (v t)) t (P' t (v t) a);
  form_plus : forall t v a b, P' t v (plus a b) <= P' t v a + 2 * sqrt (P t v) * sqrt (P t b)
}.

Record within (o : functions) : Prop := {
    (** (1.3). *)
  within_triple : forall t v, P' t v (F t v) <= - 2 * alpha c * P t v;
  (** b_fxx, b_fex: df/dx along a segment of length at most D from xp, at e, against F (the proof of Lemma 5.1). *)
  within_fx : forall x D E, in_domain c (x + D) E ->
    forall t v xp e, norm xp <= x -> norm (minus v xp) <= D -> Rabs e <= E ->
    norm (minus (minus (f t v e) (f t xp e)) (F t (minus v xp)))
    <= (b_fxx o x 0 * x + b_fex o x E * E + b_fxx o (x + D) E * D / 2) * norm (minus v xp);
  (** [rate], where it is given: a rate of contraction of df/dx in the same P. *)
  within_rate : match rate c with
                | None => True
                | Some a => forall x E, in_domain c x E -> forall t v v' e, norm v <= x -> norm v' <= x -> Rabs e <= E ->
                    P' t (minus v v') (minus (f t v e) (f t v' e)) <= - 2 * a x E * P t (minus v v')
                end;
  within_fe : forall x E, in_domain c x E -> forall t v e e', norm v <= x -> Rabs e <= E -> Rabs e' <= E ->
    norm (minus (f t v e) (f t v e')) <= b_fe c x E * Rabs (e - e');
  within_qx : forall x E, in_domain c x E -> forall t v v' e, norm v <= x -> norm v' <= x -> Rabs e <= E ->
    Rabs (q t v e - q t v' e) <= b_qx c x E * norm (minus v v');
  (** b_qe, and q_e_max where it is given: the slope of q in e. *)
  within_qe : forall x E, in_domain c x E -> forall t v e e', norm v <= x -> Rabs e <= E -> Rabs e' <= E ->
    exists delta, q t v e - q t v e' = delta * (e - e') /\ - b_qe c x E <= delta <= b_qe c x E /\
                  match q_e_max c with None => True | Some m => delta <= m x E end
}.

(** The values for the formulas of a plant, in its coordinates around the orbit (11). *)
Definition bounded_decline (d : decline) : Prop :=
  match d with
  | by_norms fe rate _ =>
      (forall t v e e', norm v <= up_to_X fe -> Rabs e <= up_to_E fe -> Rabs e' <= up_to_E fe ->
         norm (minus (f t v e) (f t v e')) <= value fe * Rabs (e - e')) /\
      (forall t v v' e, norm v <= up_to_X rate -> norm v' <= up_to_X rate -> Rabs e <= up_to_E rate ->
         P' t (minus v v') (minus (f t v e) (f t v' e)) <= - 2 * value rate * P t (minus v v'))
  (* F >= 0 at (xt, et, y) for the averages of the derivatives between the points. *)
  | by_matrix m =>
      forall t v xp e ep y, norm v <= X_m m -> Rabs e <= E_m m -> norm xp <= X_per_m m -> Rabs ep <= E_per_m m ->
        0 <= - w_x c * (P' t (minus v xp) (minus (f t v e) (f t xp ep)) + 2 * delta_m m * P t (minus v xp))
             - 2 * ht c * (q t v e - q t xp ep) * y + 2 * tau_m m * (e - ep) ^ 2 - 2 * (e - ep) * y + 2 * ht c * y ^ 2
  end.

Record bounded (k : formulas) : Prop := {
  bounded_qx : forall t v v' e, norm v <= up_to_X (of_qx k) -> norm v' <= up_to_X (of_qx k) -> Rabs e <= up_to_E (of_qx k) ->
    Rabs (q t v e - q t v' e) <= value (of_qx k) * norm (minus v v');
  bounded_qe : forall t v e e', norm v <= up_to_X (of_qe k) -> Rabs e <= up_to_E (of_qe k) -> Rabs e' <= up_to_E (of_qe k) ->
    exists delta, q t v e - q t v e' = delta * (e - e') /\ - value (of_qe k) <= delta <= value (of_qe k) /\
      match of_decline k with
      | by_norms _ _ (Some m) => norm v <= up_to_X m -> Rabs e <= up_to_E m -> Rabs e' <= up_to_E m -> delta <= value m
      | _ => True
      end;
  bounded_f : bounded_decline (of_decline k)
}.

(** What is taken for granted, of either kind. *)
Definition as_known : Prop := match known c with by_functions o => within o | by_formulas k => bounded k end.
Definition about : Prop := quadratic_form /\ as_known.

(** ** The proof *)

Hypothesis form : quadratic_form.
Hypothesis plant : as_known.
Hypothesis conditions : stability_conditions c.

Let p_low_pos : 0 < p_low c. Proof. apply (signs_b _ conditions). Qed.
Let p_up_pos : 0 < p_up c. Proof. apply (signs_b _ conditions). Qed.

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

Let D_x_pos : 0 < D_x c. Proof. apply (signs_b _ conditions). Qed.
Let D_e_pos : 0 < D_e c. Proof. apply (signs_b _ conditions). Qed.

(** A smaller box is in the domain too. *)
Lemma in_domain_le a b a' b' : in_domain c a b -> a' <= a -> b' <= b -> in_domain c a' b'.
Proof. unfold in_domain. destruct (domain c) as [[A B]|]; [intros [H1 H2] Ha Hb; split; lra | auto]. Qed.

Lemma E_at_le p : e_per c <= E_at c p <= E_b c.
Proof. unfold E_at, E_b. destruct p; lra. Qed.

Lemma X_at_le p : x_per c <= X_at c p <= X_b c.
Proof. unfold X_at, X_b. destruct p; lra. Qed.

Lemma domain_known o : known c = by_functions o -> in_domain c (X_b c) (E_b c).
Proof. intros K. pose proof (domain_b _ conditions) as D. rewrite K in D. exact D. Qed.

(** The part in x of a difference of f, at e: Lemma 5.1, with a_2. *)
Lemma state_part o t v xp e : known c = by_functions o -> within o -> norm xp <= x_per c -> norm (minus v xp) <= D_x c -> Rabs e <= E_f c ->
  P' t (minus v xp) (minus (f t v e) (f t xp e)) <= - 2 * a_2 c * P t (minus v xp).
Proof.
  intros K W Hp Hd He.
  assert (Dom : in_domain c (x_per c + D_x c) (E_f c)).
  { apply (in_domain_le _ _ _ _ (domain_known o K)); [unfold X_b; lra | apply E_at_le]. }
  set (xi := sqrt (P t (minus v xp))).
  assert (Hxi : 0 <= xi) by apply sqrt_pos.
  assert (A1 : P' t (minus v xp) (minus (f t v e) (f t xp e)) <= - 2 * (alpha c - gam c o) * P t (minus v xp)).
  { set (r := minus (minus (f t v e) (f t xp e)) (F t (minus v xp))).
    assert (E : minus (f t v e) (f t xp e) = plus (F t (minus v xp)) r).
    { unfold r, minus. rewrite (plus_comm (F t _)), <- plus_assoc, plus_opp_l, plus_zero_r. reflexivity. }
    rewrite E. apply Rle_trans with (1 := form_plus form t (minus v xp) (F t (minus v xp)) r).
    pose proof (within_triple o W t (minus v xp)) as T1.
    pose proof (within_fx o W _ _ _ Dom t v xp e Hp Hd He) as T2. fold r in T2. fold xi.
    set (G := b_fxx o (x_per c) 0 * x_per c + b_fex o (x_per c) (E_f c) * E_f c
              + b_fxx o (x_per c + D_x c) (E_f c) * D_x c / 2) in *.
    assert (Sl : 0 < sqrt (p_low c)) by (apply sqrt_lt_R0; lra).
    assert (T3 : sqrt (P t r) <= sqrt (p_up c) * (G * norm (minus v xp))).
    { apply Rle_trans with (1 := xi_le_norm t r). apply Rmult_le_compat_l; [apply sqrt_pos | exact T2]. }
    assert (T4 : xi * sqrt (P t r) <= gam c o * P t (minus v xp)).
    { assert (Eg : gam c o = sqrt (p_up c) / sqrt (p_low c) * G) by (unfold gam, G, X_b; rewrite sqrt_div by lra; reflexivity).
      rewrite Eg, <- (xi_square t (minus v xp)). fold xi.
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
  apply (Wr (X_b c) (E_f c)); [|exact Nv | unfold X_b; lra | exact He].
  apply (in_domain_le _ _ _ _ Dom); [unfold X_b; lra | lra].
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

(** q, by the values that are given at the arguments of section 5. *)
Lemma q_known : exists b,
  k_x c = b / sqrt (p_low c) /\
  (forall t v v' e, norm v <= X_b c -> norm v' <= X_b c -> Rabs e <= E_q c -> Rabs (q t v e - q t v' e) <= b * norm (minus v v')) /\
  (forall t v e e', norm v <= X_q c -> Rabs e <= E_b c -> Rabs e' <= E_b c ->
    exists delta, q t v e - q t v e' = delta * (e - e') /\ - k_l c <= delta <= most c).
Proof.
  pose proof plant as W. unfold as_known in W. pose proof (domain_b _ conditions) as D. unfold k_x, most, one_sided, k_l.
  destruct (known c) as [o|k] eqn:K.
  - exists (b_qx c (X_b c) (E_q c)). split; [reflexivity|].
    pose proof (E_at_le (path_q c)) as E1. pose proof (X_at_le (path_q c)) as X1. fold (E_q c) in E1. fold (X_q c) in X1. split.
    + intros t v v' e. apply (within_qx o W (X_b c) (E_q c)). apply (in_domain_le _ _ _ _ D); lra.
    + intros t v e e' Hv He He'.
      assert (Dq : in_domain c (X_q c) (E_b c)) by (apply (in_domain_le _ _ _ _ D); lra).
      destruct (within_qe o W (X_q c) (E_b c) Dq t v e e' Hv He He') as [delta [Q1 [Q2 Q3]]].
      exists delta. split; [exact Q1|]. destruct (q_e_max c) as [m|]; [rewrite min2_Rmin|lra]. split; [lra|]. apply Rmin_glb; lra.
  - destruct D as [[X1 E1] [[X2 E2] D]]. exists (value (of_qx k)). split; [reflexivity|]. split.
    + intros t v v' e Hv Hv' He. apply (bounded_qx k W); lra.
    + intros t v e e' Hv He He'. destruct (bounded_qe k W t v e e') as [delta [Q1 [Q2 Q3]]]; try lra.
      exists delta. split; [exact Q1|]. destruct (of_decline k) as [fe rate [m|]|m]; try lra.
      destruct D as [_ [_ [X3 E3]]]. rewrite min2_Rmin. split; [lra|]. apply Rmin_glb; [apply Q3; lra | lra].
Qed.

Lemma q_part t v xp e ep : near v xp e ep -> exists u_x delta,
  q t v e - q t xp ep = u_x + delta * (e - ep) /\ Rabs u_x <= k_x c * sqrt (P t (minus v xp)) /\ - k_l c <= delta <= most c.
Proof.
  intros H. destruct q_known as [b [Kx [Qx Qe]]].
  assert (Sl : 0 < sqrt (p_low c)) by (apply sqrt_lt_R0; lra).
  destruct (corner v xp e ep (path_q c) H) as [ec [vc [H1 [H2 H3]]]].
  assert (Nxp : norm xp <= X_b c) by (destruct H as [Hxp _]; unfold X_b; lra).
  assert (Nep : Rabs ep <= E_b c) by (destruct H as [_ [Hep _]]; unfold E_b; lra).
  destruct (Qe t vc e ep H2 (near_e _ _ _ _ H) Nep) as [delta [Q1 Q2]].
  exists (q t v ec - q t xp ec), delta. split; [destruct H3 as [[-> ->]|[-> ->]]; lra|]. split; [|exact Q2].
  apply Rle_trans with (1 := Qx t v xp ec (near_norm _ _ _ _ H) Nxp H1).
  pose proof (proj1 (nonneg _ conditions)) as K0. rewrite Kx in *.
  assert (B0 : 0 <= b).
  { apply Rmult_le_reg_r with (/ sqrt (p_low c)); [apply Rinv_0_lt_compat, Sl|]. rewrite Rmult_0_l. exact K0. }
  replace (b / sqrt (p_low c) * sqrt (P t (minus v xp))) with (b * (sqrt (P t (minus v xp)) / sqrt (p_low c))) by (field; lra).
  apply Rmult_le_compat_l; [exact B0 | apply norm_le_xi].
Qed.

(** f, where the decline is by norms. *)
Lemma f_known : of_matrix c = None ->
  (forall t v e e', norm v <= X_f c -> Rabs e <= E_b c -> Rabs e' <= E_b c ->
    norm (minus (f t v e) (f t v e')) <= k_f c * Rabs (e - e')) /\
  (forall t v xp e, norm xp <= x_per c -> norm (minus v xp) <= D_x c -> norm v <= X_b c -> Rabs e <= E_f c ->
    P' t (minus v xp) (minus (f t v e) (f t xp e)) <= - 2 * a_2 c * P t (minus v xp)).
Proof.
  intros N. pose proof plant as W. unfold as_known in W. pose proof (domain_b _ conditions) as D. destruct (known c) as [o|k] eqn:K.
  - split.
    + intros t v e e'. unfold k_f. rewrite K. pose proof (X_at_le (path_f c)) as X1. fold (X_f c) in X1.
      apply (within_fe o W). apply (in_domain_le _ _ _ _ D); lra.
    + intros t v xp e Hxp Hx _ He. apply (state_part o); assumption.
  - destruct D as [_ [_ D]]. pose proof (bounded_f k W) as Wf. unfold of_matrix in N. rewrite K in N.
    unfold k_f, a_2. rewrite K. destruct (of_decline k) as [fe rate m|m]; [|discriminate].
    destruct D as [[X1 E1] [[X2 E2] _]]. destruct Wf as [W1 W2]. split.
    + intros t v e e' Hv He He'. apply W1; lra.
    + intros t v xp e Hxp Hx Hv He. apply W2; try lra. unfold X_b in X2. lra.
Qed.

Lemma f_part t v xp e ep : of_matrix c = None -> near v xp e ep -> exists phi, Rabs phi <= k_f c * Rabs (e - ep) /\
  P' t (minus v xp) (minus (f t v e) (f t xp ep)) <= - 2 * a_2 c * P t (minus v xp) + 2 * sqrt (p_up c) * sqrt (P t (minus v xp)) * phi.
Proof.
  intros N H. destruct (f_known N) as [Fe Fx].
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
Lemma of_matrix_known m : of_matrix c = Some m -> domain_of_decline c (by_matrix m) /\ bounded_decline (by_matrix m).
Proof.
  unfold of_matrix. intros M. pose proof plant as W. unfold as_known in W. pose proof (domain_b _ conditions) as D.
  destruct (known c) as [o|k]; [discriminate|]. destruct D as [_ [_ D]]. pose proof (bounded_f k W) as Wf.
  destruct (of_decline k) as [fe rate most|m']; [discriminate|]. injection M as ->. split; assumption.
Qed.

(** The same by (M): the square that is left of F, with the multiple of P and of et^2 that the margins give, bounds s. *)
Lemma decay_by_matrix m s : of_matrix c = Some m -> sigma c <= s -> exists rho, 0 < rho /\
  forall t v xp e ep z y, near v xp e ep -> y = q t v e - q t xp ep + mu c * z ->
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
  { pose proof (near_norm _ _ _ _ H) as Nv. pose proof (near_e _ _ _ _ H) as Ne. destruct H as [Hxp [Hep _]]. destruct D as [D1 [D2 [D3 D4]]].
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
  forall t v xp e ep z y, near v xp e ep -> y = q t v e - q t xp ep + mu c * z ->
  w_x c * P' t (minus v xp) (minus (f t v e) (f t xp ep)) + 2 * (e - ep) * (y - s * (e - ep)) + h c * (- 2 * z * y)
  <= - rho * (P t (minus v xp) + (e - ep) ^ 2 + z ^ 2).
Proof.
  intros Hs. destruct (of_matrix c) as [m|] eqn:M; [apply (decay_by_matrix m s M Hs)|].
  destruct (decay s M Hs) as [rho [Hrho Dec]]. exists rho. split; [exact Hrho|].
  intros t v xp e ep z y H Ey.
  destruct (q_part t v xp e ep H) as [u_x [delta [Q1 [Q2 Q3]]]]. destruct (f_part t v xp e ep M H) as [phi [F1 F2]].
  apply (Dec _ _ _ u_x delta phi); try assumption; [apply P_nonneg | rewrite Ey, Q1; reflexivity].
Qed.

Lemma xi_near t v xp e ep : near v xp e ep -> sqrt (P t (minus v xp)) <= sqrt (p_up c) * D_x c.
Proof.
  intros H. apply Rle_trans with (1 := xi_le_norm t _). apply Rmult_le_compat_l; [apply sqrt_pos | left; apply H].
Qed.

(** In the error box neither xi^2 nor q changes fast. *)
Theorem slopes : exists C, 0 < C /\ forall t v xp e ep, near v xp e ep ->
  P' t (minus v xp) (minus (f t v e) (f t xp ep)) <= C /\ Rabs (q t v e - q t xp ep) <= C.
Proof.
  destruct (nonneg _ conditions) as [Kx Kf].
  set (Xi := sqrt (p_up c) * D_x c).
  assert (HXi : 0 <= Xi) by (apply Rmult_le_pos; [apply sqrt_pos | lra]).
  set (Cq := k_x c * Xi + (Rabs (k_l c) + Rabs (most c)) * D_e c).
  assert (Hq : forall t v xp e ep, near v xp e ep -> Rabs (q t v e - q t xp ep) <= Cq).
  { intros t v xp e ep H. destruct (q_part t v xp e ep H) as [u_x [delta [Q1 [Q2 Q3]]]]. rewrite Q1.
    apply Rle_trans with (1 := Rabs_triang _ _). unfold Cq. apply Rplus_le_compat.
    - apply Rle_trans with (1 := Q2). apply Rmult_le_compat_l; [exact Kx | apply (xi_near t v xp e ep H)].
    - rewrite Rabs_mult. apply Rmult_le_compat; [apply Rabs_pos | apply Rabs_pos | | left; apply H].
      pose proof (Rle_abs (k_l c)). pose proof (Rle_abs (most c)). pose proof (Rabs_pos (k_l c)). pose proof (Rabs_pos (most c)).
      apply Rabs_le_between. lra. }
  assert (Hf : exists Cf, 0 <= Cf /\ forall t v xp e ep, near v xp e ep -> P' t (minus v xp) (minus (f t v e) (f t xp ep)) <= Cf).
  { destruct (of_matrix c) as [m|] eqn:M.
    - destruct (of_matrix_known m M) as [D W]. exists (2 * Rabs (tau_m m) * D_e c ^ 2 / w_x c).
      assert (T0 : 0 <= 2 * Rabs (tau_m m) * D_e c ^ 2).
      { pose proof (Rabs_pos (tau_m m)). apply Rmult_le_pos; [lra | apply pow2_ge_0]. }
      split; [apply le_div; lra|]. intros t v xp e ep H. apply le_div; [lra|].
      pose proof (C5_ _ conditions) as Hde. rewrite M in Hde.
      assert (Fm := W t v xp e ep 0). pose proof (near_norm _ _ _ _ H) as Nv. pose proof (near_e _ _ _ _ H) as Ne.
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
      destruct (f_part t v xp e ep M H) as [phi [F1 F2]].
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

End PlantBounds.

Arguments form_low {c X P P'}.
Arguments form_up {c X P P'}.
Arguments form_derive {c X P P'}.
