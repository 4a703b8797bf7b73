(** That a plant can be within bounding functions as [PlantBounds.v] means it: a linear one with one state, x' = -a x + b e and
    e' = d(t) + g x + k e + u, whatever the weights and the other numbers are. *)

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
(** P_x = 1. *)
Let P (_ v : R) : R := v ^ 2.
Let P' (_ v v' : R) : R := 2 * v * v'.

Variable c : numbers.
Hypothesis low : p_low c <= 1.
Hypothesis up : 1 <= p_up c.

Let N (v : R) : norm v = Rabs v. Proof. reflexivity. Qed.
Let M (u v : R) : minus u v = u - v. Proof. reflexivity. Qed.
Let A (u v : R) : plus u v = u + v. Proof. reflexivity. Qed.

Lemma scalar_form : quadratic_form c (X := R_NormedModule) P P'.
Proof.
  split; unfold P, P'.
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

Theorem scalar_plant_within : about c (X := R_NormedModule) f q F P P'.
Proof.
  split; [apply scalar_form | unfold as_known; rewrite bounding; split].
  - intros t v. unfold P', P, F. pose proof (pow2_ge_0 v).
    assert (alpha c * v ^ 2 <= a * v ^ 2) by (apply Rmult_le_compat_r; lra). lra.
  - destruct no_curvature as [E1 E2]. rewrite E1, E2. intros x D E _ t v xp e _ _ _. rewrite N, !M. unfold f, F.
    assert (E0 : - a * v + b * e - (- a * xp + b * e) - - a * (v - xp) = 0) by ring.
    apply Rle_trans with (Rabs 0); [right; apply (f_equal Rabs); exact E0 | rewrite Rabs_R0; right].
    change (0 = (0 * x + 0 * E + 0 * D / 2) * Rabs (v - xp)). field.
  - rewrite no_rate. exact I.
  - intros x E _ t v e e' _ _ _.
    assert (E1 : - a * v + b * e - (- a * v + b * e') = b * (e - e')) by ring.
    change (Rabs (- a * v + b * e - (- a * v + b * e')) <= b_fe c x E * Rabs (e - e')). rewrite E1, Rabs_mult.
    apply Rmult_le_compat_r; [apply Rabs_pos | apply of_f].
  - intros x E _ t v v' e _ _ _.
    assert (E1 : d t + g * v + k * e - (d t + g * v' + k * e) = g * (v - v')) by ring.
    change (Rabs (d t + g * v + k * e - (d t + g * v' + k * e)) <= b_qx c x E * Rabs (v - v')). rewrite E1, Rabs_mult.
    apply Rmult_le_compat_r; [apply Rabs_pos | apply of_q].
  - intros x E _ t v e e' _ _ _. exists k. unfold q. rewrite no_side. split; [ring|]. split; [|exact I].
    apply Rabs_le_between, of_q.
Qed.

End ByFunctions.

(** By the values of its formulas, with a rate, or with (M). *)
Section ByFormulas.
Variable v : formulas.
Hypothesis values : known c = by_formulas v.
Hypothesis of_q : Rabs g <= value (of_qx v) /\ Rabs k <= value (of_qe v).
Hypothesis of_f : match of_decline v with
                  | by_norms fe rate most =>
                      Rabs b <= value fe /\ value rate <= a /\ match most with None => True | Some m => k <= value m end
                  | by_matrix m => forall x e y : R,
                      0 <= - w_x c * (2 * x * (- a * x + b * e) + 2 * delta_m m * x ^ 2) - 2 * ht c * (g * x + k * e) * y
                           + 2 * tau_m m * e ^ 2 - 2 * e * y + 2 * ht c * y ^ 2
                  end.

Theorem scalar_plant_bounded : about c (X := R_NormedModule) f q F P P'.
Proof.
  split; [apply scalar_form | unfold as_known; rewrite values; split].
  - intros t x x' e _ _ _. change (Rabs (d t + g * x + k * e - (d t + g * x' + k * e)) <= value (of_qx v) * Rabs (x - x')).
    replace (d t + g * x + k * e - (d t + g * x' + k * e)) with (g * (x - x')) by ring. rewrite Rabs_mult.
    apply Rmult_le_compat_r; [apply Rabs_pos | apply of_q].
  - intros t x e e' _ _ _. exists k. unfold q. split; [ring|]. split; [apply Rabs_le_between, of_q|].
    destruct (of_decline v) as [fe rate [m|]|m]; try exact I. intros _ _ _. apply of_f.
  - destruct (of_decline v) as [fe rate most|m]; cbn [bounded_decline].
    + destruct of_f as [Hb [Ha _]]. split.
      * intros t x e e' _ _ _. change (Rabs (- a * x + b * e - (- a * x + b * e')) <= value fe * Rabs (e - e')).
        replace (- a * x + b * e - (- a * x + b * e')) with (b * (e - e')) by ring. rewrite Rabs_mult.
        apply Rmult_le_compat_r; [apply Rabs_pos | exact Hb].
      * intros t x x' e _ _ _. rewrite !M. unfold P', P, f. pose proof (pow2_ge_0 (x - x')).
        assert (value rate * (x - x') ^ 2 <= a * (x - x') ^ 2) by (apply Rmult_le_compat_r; lra).
        change (2 * (x - x') * (- a * x + b * e - (- a * x' + b * e)) <= - 2 * value rate * (x - x') ^ 2). lra.
    + intros t x x' e e' y _ _ _ _.
      change (0 <= - w_x c * (2 * (x - x') * (- a * x + b * e - (- a * x' + b * e')) + 2 * delta_m m * (x - x') ^ 2)
                   - 2 * ht c * (q t x e - q t x' e') * y + 2 * tau_m m * (e - e') ^ 2 - 2 * (e - e') * y + 2 * ht c * y ^ 2).
      apply Rle_trans with (1 := of_f (x - x') (e - e') y). unfold q. right. ring.
Qed.
End ByFormulas.

End ScalarPlant.
