(** Sections 5, 10.4 and 13.7: what is known of a plant, and what it contributes to U' in the error box. Known of it are bounding functions ([within]), or the
    values that stand in their place for the formulas of a plant, with a rate or with (M) ([bounded]). *)

From Coq Require Import Reals Lra Lia.
From Coquelicot Require Import Coquelicot.
From SigmaStar Require Import Sums Containment Sizes.
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

End PlantBounds.

Arguments form_low {c X P P'}.
Arguments form_up {c X P P'}.
Arguments form_derive {c X P P'}.
