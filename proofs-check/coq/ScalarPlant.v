(** That a plant can be within bounding functions as [PlantBounds.v] means it: a linear one with one state, x' = -a x + b e and
    e' = d(t) + g x + k e + u, in the metric x^2, or in two joint metrics a x^2 + w e^2; whatever the weights of the oscillators are. *)

From Coq Require Import Reals Lra.
From Coquelicot Require Import Coquelicot.
From SigmaStar Require Import Sizes PlantBounds.
Local Open Scope R_scope.

Section ScalarPlant.
Variables a b g k : R.
Variable d : R -> R.

Let f (_ x e : R) : R := - a * x + b * e.
Let q (t x e : R) : R := d t + g * x + k * e.
Let F (_ v : R) : R := - a * v.
(** P_x = 1, but with joint metrics. *)
Let P (_ v : R) : R := v ^ 2.
Let P' (_ v v' : R) : R := 2 * v * v'.
Let m : forms R_NormedModule :=
  {| J_0 := F; P_1 := P; P_1' := P'; p_1 := fun _ => 0; P_2 := P; P_2' := P' |}.

Variable c : numbers.
Hypothesis low : p_low c <= 1.
Hypothesis up : 1 <= p_up c.

Let N (v : R) : norm v = Rabs v. Proof. reflexivity. Qed.
Let M (u v : R) : minus u v = u - v. Proof. reflexivity. Qed.
Let A (u v : R) : plus u v = u + v. Proof. reflexivity. Qed.

Lemma scalar_form : quadratic_form c m.
Proof.
  split; cbn [m P_1 P_1']; unfold P, P'.
  - intros _ v. rewrite N, pow2_abs. pose proof (pow2_ge_0 v).
    assert (p_low c * v ^ 2 <= 1 * v ^ 2) by (apply Rmult_le_compat_r; lra). lra.
  - intros _ v. rewrite N, pow2_abs. pose proof (pow2_ge_0 v).
    assert (1 * v ^ 2 <= p_up c * v ^ 2) by (apply Rmult_le_compat_r; lra). lra.
  - intros t v v' D. evar_last; [apply (is_derive_pow v 2 t _ D)|]. simpl. ring.
  - intros _ v u r. rewrite A.
    assert (S : forall z : R, sqrt (z ^ 2) = Rabs z) by (intros z; rewrite <- Rsqr_pow2; apply sqrt_Rsqr_abs).
    rewrite !S. pose proof (Rle_abs (v * r)) as Q. rewrite Rabs_mult in Q.
    change (2 * v * (u + r) <= 2 * v * u + 2 * Rabs v * Rabs r). lra.
Qed.

Lemma scalar_q : Rabs g <= b_x c -> - k_l c <= k <= most c -> bounded_q c q.
Proof.
  intros Hg Hk. split.
  - intros t v v' e _ _ _. change (Rabs (d t + g * v + k * e - (d t + g * v' + k * e)) <= b_x c * Rabs (v - v')).
    replace (d t + g * v + k * e - (d t + g * v' + k * e)) with (g * (v - v')) by ring. rewrite Rabs_mult.
    apply Rmult_le_compat_r; [apply Rabs_pos | exact Hg].
  - intros t v e e' _ _ _. exists k. split; [unfold q; ring | exact Hk].
Qed.

Lemma scalar_fe : Rabs b <= k_f c -> bounded_fe c (X := R_NormedModule) f.
Proof.
  intros Hb t v e e' _ _ _. change (Rabs (- a * v + b * e - (- a * v + b * e')) <= k_f c * Rabs (e - e')).
  replace (- a * v + b * e - (- a * v + b * e')) with (b * (e - e')) by ring. rewrite Rabs_mult.
  apply Rmult_le_compat_r; [apply Rabs_pos | exact Hb].
Qed.

(** By bounding functions. *)
Section ByFunctions.
Variable o : functions.
Hypothesis bounding : known c = by_functions o.
Hypothesis decays : alpha c <= a.
Hypothesis no_curvature : b_fxx o = (fun _ _ => 0) /\ b_fex o = (fun _ _ => 0).
Hypothesis no_rate : rate c = None.
Hypothesis no_side : q_e_max c = None.
Hypothesis of_f : forall x e, Rabs b <= b_fe c x e.
Hypothesis of_q : forall x e, Rabs g <= b_qx c x e /\ Rabs k <= b_qe c x e.

Theorem scalar_plant_within : about c (X := R_NormedModule) f q m.
Proof.
  unfold about. rewrite bounding. split; [apply scalar_form|]. split; [|split; [|split]]; cbn [m P_1 P_1' J_0].
  - assert (E : b_x c = b_qx c (X_b c) (E_q c) /\ k_l c = b_qe c (X_q c) (E_b c) /\ most c = k_l c).
    { repeat split; unfold most, one_sided, b_x, k_l; rewrite bounding; try rewrite no_side; reflexivity. }
    destruct E as [E1 [E2 E3]]. apply scalar_q; rewrite ?E3, ?E1, ?E2; try apply of_q.
    apply Rabs_le_between, of_q.
  - apply scalar_fe. unfold k_f. rewrite bounding. apply of_f.
  - intros t v. unfold P', P, F. pose proof (pow2_ge_0 v).
    assert (alpha c * v ^ 2 <= a * v ^ 2) by (apply Rmult_le_compat_r; lra). lra.
  - intros t v xp e _ _ _. unfold bend. destruct no_curvature as [-> ->]. rewrite N, !M. unfold f, F.
    assert (E0 : - a * v + b * e - (- a * xp + b * e) - - a * (v - xp) = 0) by ring.
    apply Rle_trans with (Rabs 0); [right; apply (f_equal Rabs); exact E0 | rewrite Rabs_R0; right].
    change (0 = (0 * x_per c + 0 * E_f c + 0 * D_x c / 2) * Rabs (v - xp)). field.
  - rewrite no_rate. exact I.
Qed.

End ByFunctions.

(** By the values of its formulas, with a rate, or with (M). *)
Section ByFormulas.
Variable v : formulas.
Hypothesis values : known c = by_formulas v.
Hypothesis of_q : Rabs g <= value (of_qx v) /\ - value (of_qe v) <= k <= most c.
Hypothesis of_f : match of_decline v with
                  | by_norms fe rate _ => Rabs b <= value fe /\ value rate <= a
                  | by_matrix n => forall i x e y : R, i = b_lo c \/ i = b_hi c ->
                      0 <= form_at c i (tau_m n) (2 * x * (- a * x + b * e) + 2 * delta_m n * x ^ 2) (g * x + k * e) e y
                  end.

Theorem scalar_plant_bounded : about c (X := R_NormedModule) f q m.
Proof.
  unfold about. rewrite values. split; [apply scalar_form|]. split.
  - apply scalar_q; [unfold b_x | unfold k_l]; rewrite values; apply of_q.
  - assert (Fe : match of_decline v with by_norms fe _ _ => value fe = k_f c | _ => True end).
    { unfold k_f. rewrite values. destruct (of_decline v); auto. }
    destruct (of_decline v) as [fe rate most|n]; cbn [bounded_decline m P_1 P_1'].
    + destruct of_f as [Hb Ha]. split; [apply scalar_fe; rewrite <- Fe; exact Hb|].
      intros t x x' e _ _ _. pose proof (pow2_ge_0 (x - x')).
      assert (value rate * (x - x') ^ 2 <= a * (x - x') ^ 2) by (apply Rmult_le_compat_r; lra).
      change (2 * (x - x') * (- a * x + b * e - (- a * x' + b * e)) <= - 2 * value rate * (x - x') ^ 2). lra.
    + intros i t x x' e e' y Hi _ _ _ _. apply Rle_trans with (1 := of_f i (x - x') (e - e') y Hi). right.
      change (form_at c i (tau_m n) (2 * (x - x') * (- a * (x - x') + b * (e - e')) + 2 * delta_m n * (x - x') ^ 2)
                (g * (x - x') + k * (e - e')) (e - e') y
              = form_at c i (tau_m n) (2 * (x - x') * (- a * x + b * e - (- a * x' + b * e')) + 2 * delta_m n * (x - x') ^ 2)
                (d t + g * x + k * e - (d t + g * x' + k * e')) (e - e') y). unfold form_at. ring.
Qed.
End ByFormulas.

(** By joint metrics r_1 x^2 + w e^2 and r_2 x^2 + w e^2, the w of each its own. *)
Section ByMetrics.
Variable j : joint.
Hypothesis metrics : known c = by_metrics j.
Variables r_1 r_2 : R.
Let m_j : forms R_NormedModule :=
  {| J_0 := F; P_1 := fun _ v => r_1 * v ^ 2; P_1' := fun _ v v' => r_1 * (2 * v * v'); p_1 := fun _ => 0;
     P_2 := fun _ v => r_2 * v ^ 2; P_2' := fun _ v v' => r_2 * (2 * v * v') |}.
Let extent_of (r : R) (x : extent) : Prop :=
  0 <= weight x /\ 0 <= cross x /\ 0 <= r /\ r <= P_up x /\ x_low x <= r /\ e_low x <= weight x.
Hypothesis extents : extent_of r_1 (near_x j) /\ extent_of r_2 (far_x j).
Hypothesis of_forms : forall x e y : R,
  least_form (near_m j) (x : R_NormedModule) e y <= near_form m_j j 0 x (- a * x + b * e) (g * x + k * e) e y /\
  least_form (far_m j) (x : R_NormedModule) e y <= far_form m_j j 0 x (- a * x + b * e) (g * x + k * e) e y.

Theorem scalar_plant_joint : about c (X := R_NormedModule) f q m_j.
Proof.
  assert (Form : forall r x, extent_of r x ->
            metric_form (X := R_NormedModule) x (fun _ v => r * v ^ 2) (fun _ v v' => r * (2 * v * v')) (fun _ => 0)).
  { intros r x [Hw [Hc [Hr [Hp [Hx He]]]]]. split.
    - intros _ v e. rewrite N, pow2_abs. pose proof (pow2_ge_0 v). pose proof (pow2_ge_0 e).
      assert (x_low x * v ^ 2 <= r * v ^ 2) by (apply Rmult_le_compat_r; lra).
      assert (0 <= weight x * e ^ 2) by (apply Rmult_le_pos; lra). lra.
    - intros _ v e. pose proof (pow2_ge_0 v). pose proof (pow2_ge_0 e).
      assert (e_low x * e ^ 2 <= weight x * e ^ 2) by (apply Rmult_le_compat_r; lra).
      assert (0 <= r * v ^ 2) by (apply Rmult_le_pos; lra). lra.
    - intros _ v. rewrite N, pow2_abs. pose proof (pow2_ge_0 v). apply Rmult_le_compat_r; lra.
    - intros v. rewrite Rabs_R0. apply Rmult_le_pos; [exact Hc | apply norm_ge_0].
    - intros t v v' D. evar_last; [apply is_derive_scal, (is_derive_pow v 2 t _ D)|]. simpl. ring.
    - intros t v v' _. apply (is_derive_const (V := R_NormedModule)). }
  unfold about. rewrite metrics. split; [apply Form, extents|]. split; [apply Form, extents|].
  intros t v xp e ep y _ _ _ _ x z u.
  assert (Eu : u = g * (v - xp) + k * (e - ep)) by (unfold u, q; ring).
  assert (Ez : z = - a * (v - xp) + b * (e - ep)).
  { change (- a * v + b * e - (- a * xp + b * ep) = - a * (v - xp) + b * (e - ep)). ring. }
  rewrite Eu, Ez. apply (of_forms (v - xp) (e - ep) y).
Qed.
End ByMetrics.

End ScalarPlant.
