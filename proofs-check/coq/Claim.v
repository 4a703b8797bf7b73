(** Sections 5 and 10.4: what a certificate in continuous time says, with every number in it a parameter ([Sizes.v]). From its
    conditions C4, C5, C5b or C5m, what is known of the plant ([PlantBounds.v]) and a periodic solution of the stated size follows: every
    solution from the initial set stays in the error box, U does not grow, xi, et and s are square integrable, and the errors of
    x and e tend to 0; for every N and every sigma' >= sigma. With the existence of the periodic
    solution (section 10.3), which is a hypothesis here, follows [certified]. *)

From Coq Require Import Reals Lra Lia.
From Coquelicot Require Import Coquelicot.
From SigmaStar Require Import Sums Weights Transfer Loop Stability Containment Vanish Sizes Differences PlantBounds Decline.
Local Open Scope R_scope.

Section Claim.
Variable c : numbers.

Context {X : NormedModule R_AbsRing}.
Variables (f : R -> X -> R -> X) (q : R -> X -> R -> R).
Variables (F : R -> X -> X) (P : R -> X -> R) (P' : R -> X -> X -> R).

(** ** Solutions *)

Record state : Type := { of_x : R -> X; of_e : R -> R; of_z0 : R -> R; of_za : nat -> R -> R; of_zb : nat -> R -> R }.

(** x' = f, and the loop (1.1) with N oscillators and the gain s, at the time t. *)
Record solves (N : nat) (s : R) (y : state) (t : R) : Prop := {
  solves_x : is_derive (of_x y) t (f t (of_x y t) (of_e y t));
  solves_loop : equations_at (n c) N (w c) s (mu c) 1 (of_e y) (fun t => q t (of_x y t) (of_e y t))
                  (of_z0 y) (of_za y) (of_zb y) t
}.

(** zeta'N zeta with zeta = z - M e, and z'N z. *)
Definition zeta_square (N : nat) (y : state) (t : R) : R :=
  square (n c) N (of_z0 y t - of_e y t) (fun l => of_za y l t - of_e y t) (fun l => of_zb y l t).
Definition z_square (N : nat) (y : state) (t : R) : R :=
  square (n c) N (of_z0 y t) (fun l => of_za y l t) (fun l => of_zb y l t).

(** The size of the periodic solution that is stated. *)
Definition sized (N : nat) (y : state) : Prop := forall t,
  norm (of_x y t) <= x_per c /\ Rabs (of_e y t) <= e_per c /\ zeta_square N y t <= Z_per c ^ 2.

Definition periodic (N : nat) (y : state) : Prop := forall t,
  of_x y (t + period c) = of_x y t /\ of_e y (t + period c) = of_e y t /\ of_z0 y (t + period c) = of_z0 y t /\
  forall l, (1 <= l <= N)%nat -> of_za y l (t + period c) = of_za y l t /\ of_zb y l (t + period c) = of_zb y l t.

(** The initial set at the time t. *)
Definition starts (N : nat) (y : state) (t : R) : Prop :=
  norm (of_x y t) <= X_0 c /\ Rabs (of_e y t) <= E_0 c /\
  match Z_0 c with
  | Some z => z_square N y t <= z ^ 2
  | None => of_z0 y t = of_e y t /\ forall l, (1 <= l <= N)%nat -> of_za y l t = of_e y t /\ of_zb y l t = 0
  end.

(** xt, et, s = M'N zt, and U, of two solutions. *)
Definition xt (y p : state) (t : R) : X := minus (of_x y t) (of_x p t).
Definition et (y p : state) (t : R) : R := of_e y t - of_e p t.
Definition st (N : nat) (y p : state) (t : R) : R :=
  s_ (n c) N (et y p) (fun t => of_z0 y t - of_z0 p t) (fun l t => of_za y l t - of_za p l t) t.
Definition Vt (N : nat) (y p : state) (t : R) : R :=
  V_ (n c) N (et y p) (fun t => of_z0 y t - of_z0 p t) (fun l t => of_za y l t - of_za p l t)
    (fun l t => of_zb y l t - of_zb p l t) t.
Definition Ut (N : nat) (y p : state) (t : R) : R := w_x c * P t (xt y p t) + et y p t ^ 2 + h c * Vt N y p t.
(** xi^2 + et^2 + s^2. *)
Definition dissipated (N : nat) (y p : state) (t : R) : R := P t (xt y p t) + et y p t ^ 2 + st N y p t ^ 2.

(** What is claimed of the periodic solution p, with rho: whatever solves the loop on [t0, t1] and starts in the set stays in the error
    box, and U falls by what is dissipated. *)
Definition falls (N : nat) (s : R) (p : state) (rho : R) : Prop :=
  forall y t0 t1, t0 <= t1 -> (forall t, t0 <= t <= t1 -> solves N s y t) -> starts N y t0 ->
  forall t, t0 <= t <= t1 ->
  norm (xt y p t) < D_x c /\ Rabs (et y p t) < D_e c /\ Ut N y p t <= level c /\
  forall r, t0 <= r <= t -> Ut N y p t + rho * RInt (dissipated N y p) r t <= Ut N y p r.

(** And if it solves the loop for all time, the errors tend to 0. *)
Definition errors_vanish (N : nat) (s : R) (p : state) : Prop :=
  forall y t0, (forall t, t0 <= t -> solves N s y t) -> starts N y t0 ->
  forall eps, 0 < eps -> exists t1, forall t, t1 <= t -> norm (xt y p t) < eps /\ Rabs (et y p t) < eps.

Definition attracts (N : nat) (s : R) (p : state) (rho : R) : Prop := falls N s p rho /\ errors_vanish N s p.

(** ** The proof *)

Hypothesis n_pos : forall l, 0 < n c l.
Hypothesis plant : about c f q F P P'.
Hypothesis conditions : stability_conditions c.

Let form : quadratic_form c P P' := proj1 plant.
Let p_low_pos : 0 < p_low c. Proof. apply (signs_b _ conditions). Qed.
Let p_up_pos : 0 < p_up c. Proof. apply (signs_b _ conditions). Qed.
Let D_x_pos : 0 < D_x c. Proof. apply (signs_b _ conditions). Qed.
Let D_e_pos : 0 < D_e c. Proof. apply (signs_b _ conditions). Qed.
Let h_pos : 0 < h c. Proof. apply (signs_b _ conditions). Qed.
Let mu_pos : 0 < mu c. Proof. apply (signs_b _ conditions). Qed.
Let w_x_pos : 0 < w_x c. Proof. apply (signs_b _ conditions). Qed.
Let P_nonneg : forall t v, 0 <= P t v := P_nonneg c P P' form conditions.

(** U' <= -rho (xi^2 + et^2 + s^2) in the error box ([declines]). *)
Definition declining (s rho : R) : Prop :=
  forall t v xp e ep z y, near c v xp e ep -> y = q t v e - q t xp ep + mu c * z ->
  w_x c * P' t (minus v xp) (minus (f t v e) (f t xp ep)) + 2 * (e - ep) * (y - s * (e - ep)) + h c * (- 2 * z * y)
  <= - rho * (P t (minus v xp) + (e - ep) ^ 2 + z ^ 2).

(** ** Along a solution *)

Section Along.
Variables (N : nat) (s : R) (p y : state).
Hypothesis gain : sigma c <= s.
Hypothesis weight_sum : n c O + sum1 N (n c) <= n_bar2 c.
Hypothesis p_solves : forall t, solves N s p t.
Hypothesis p_sized : sized N p.

Definition U'_ (t : R) : R :=
  w_x c * P' t (xt y p t) (minus (f t (of_x y t) (of_e y t)) (f t (of_x p t) (of_e p t)))
  + 2 * et y p t * (Loop.y (n c) N s (mu c) 1 (et y p)
                      (fun t => q t (of_x y t) (of_e y t) - q t (of_x p t) (of_e p t))
                      (fun t => of_z0 y t - of_z0 p t) (fun l t => of_za y l t - of_za p l t) t - s * et y p t)
  + h c * (- 2 * st N y p t * Loop.y (n c) N s (mu c) 1 (et y p)
                      (fun t => q t (of_x y t) (of_e y t) - q t (of_x p t) (of_e p t))
                      (fun t => of_z0 y t - of_z0 p t) (fun l t => of_za y l t - of_za p l t) t).

Lemma difference_loop t : solves N s y t ->
  equations_at (n c) N (w c) s (mu c) 1 (et y p) (fun t => q t (of_x y t) (of_e y t) - q t (of_x p t) (of_e p t))
    (fun t => of_z0 y t - of_z0 p t) (fun l t => of_za y l t - of_za p l t) (fun l t => of_zb y l t - of_zb p l t) t.
Proof. intros H. apply equations_difference; [apply H | apply (p_solves t)]. Qed.

Lemma xt_derive t : solves N s y t ->
  is_derive (xt y p) t (minus (f t (of_x y t) (of_e y t)) (f t (of_x p t) (of_e p t))).
Proof.
  intros H. unfold xt. apply (is_derive_minus (K := R_AbsRing) (V := X)); [apply H | apply (p_solves t)].
Qed.

Lemma U_derive_ t : solves N s y t -> is_derive (Ut N y p) t (U'_ t).
Proof.
  intros H. pose proof (difference_loop t H) as L. unfold Ut, U'_. evar_last.
  - apply @is_derive_plus; [apply @is_derive_plus|].
    + apply is_derive_scal. apply (form_derive form t (xt y p)). apply xt_derive, H.
    + apply (is_derive_pow (et y p) 2 t _ (loop_e _ _ _ _ _ _ _ _ _ _ _ t L)).
    + apply is_derive_scal. apply (energy _ _ _ _ _ _ _ _ _ _ _ t L).
  - unfold plus; simpl. unfold st. ring.
Qed.

Let derivable_continuous (g : R -> R) (g' t : R) : is_derive g t g' -> continuous g t.
Proof. intros D. apply (ex_derive_continuous (V := R_NormedModule)). exists g'. exact D. Qed.

Lemma xt_continuous t : solves N s y t -> continuous (fun t => norm (xt y p t)) t.
Proof.
  intros H. apply (continuous_comp (xt y p) norm).
  - apply (ex_derive_continuous (K := R_AbsRing) (V := X)). eexists. apply xt_derive, H.
  - apply filterlim_norm.
Qed.

Lemma et_continuous t : solves N s y t -> continuous (et y p) t.
Proof. intros H. apply (derivable_continuous _ _ t (loop_e _ _ _ _ _ _ _ _ _ _ _ t (difference_loop t H))). Qed.

Lemma dissipated_continuous t : solves N s y t -> continuous (dissipated N y p) t.
Proof.
  intros H. unfold dissipated.
  assert (Sq : forall g : R -> R, continuous g t -> continuous (fun t => g t ^ 2) t).
  { intros g Hg. apply (continuous_ext (fun t => g t * g t)); [intros r; simpl; ring|].
    apply (continuous_mult (K := R_AbsRing)); exact Hg. }
  apply (continuous_plus (V := R_NormedModule)); [apply (continuous_plus (V := R_NormedModule))|].
  - apply (derivable_continuous _ _ t (form_derive form t (xt y p) _ (xt_derive t H))).
  - apply Sq, et_continuous, H.
  - apply (Sq (st N y p)). apply (s_continuous_at _ _ _ _ _ _ _ _ _ _ _ t (difference_loop t H)).
Qed.

(** In the error box U falls. *)
Lemma U'_le rho t : solves N s y t -> norm (xt y p t) < D_x c -> Rabs (et y p t) < D_e c ->
  declining s rho ->
  U'_ t <= - rho * dissipated N y p t.
Proof.
  intros H Hx He Dec. destruct (p_sized t) as [Sx [Se _]].
  unfold U'_, dissipated. apply (Dec t); [repeat split; assumption|]. unfold Loop.y, st, et. ring.
Qed.

(** At the start U is at most the level of C4. *)
Lemma U_start t : starts N y t -> Ut N y p t <= level c.
Proof.
  intros [Hx [He Hz]]. destruct (p_sized t) as [Sx [Se Sz]].
  destruct (signs_0 _ conditions) as [X0 [E0 Z0]].
  assert (Nx : norm (xt y p t) <= d_X c).
  { unfold xt, minus, d_X. apply Rle_trans with (1 := norm_triangle _ _). rewrite norm_opp. lra. }
  assert (Ne : Rabs (et y p t) <= d_E c).
  { unfold et, d_E. apply Rle_trans with (Rabs (of_e y t) + Rabs (- of_e p t)); [apply Rabs_triang | rewrite Rabs_Ropp; lra]. }
  assert (A1 : P t (xt y p t) <= p_up c * d_X c ^ 2).
  { apply Rle_trans with (1 := form_up form t _). apply Rmult_le_compat_l; [lra|].
    apply pow_incr. split; [apply norm_ge_0 | exact Nx]. }
  assert (A2 : et y p t ^ 2 <= d_E c ^ 2).
  { rewrite <- (pow2_abs (et y p t)). apply pow_incr. split; [apply Rabs_pos | exact Ne]. }
  assert (A3 : Vt N y p t <= d_Z c ^ 2).
  { unfold Vt. unfold et at 1. rewrite (V_difference (n c) N (of_e y) (of_z0 y) (of_e p) (of_z0 p) (of_za y) (of_zb y) (of_za p) (of_zb p)).
    assert (Sz' : square (n c) N (- (of_z0 p t - of_e p t)) (fun l => - (of_za p l t - of_e p t)) (fun l => - of_zb p l t)
                  <= Z_per c ^ 2).
    { rewrite square_opp. exact Sz. }
    assert (Zp : 0 <= Z_per c) by apply sqrt_pos.
    unfold d_Z. destruct (Z_0 c) as [z|].
    - (* z, then M e, then the periodic solution *)
      assert (Nb : 0 <= sqrt (n_bar2 c)) by apply sqrt_pos.
      assert (Sm : square (n c) N (- of_e y t) (fun _ => - of_e y t) (fun _ => - 0) <= (sqrt (n_bar2 c) * E_0 c) ^ 2).
      { rewrite square_opp. rewrite square_M, Rpow_mult_distr.
        assert (B0 : 0 <= n c O + sum1 N (n c)).
        { apply Rplus_le_le_0_compat; [left; apply n_pos | apply sum_nonneg; intros; left; apply n_pos]. }
        assert (Es : sqrt (n_bar2 c) ^ 2 = n_bar2 c) by (rewrite <- Rsqr_pow2; apply Rsqr_sqrt; lra). rewrite Es.
        apply Rmult_le_compat; [exact B0 | apply pow2_ge_0 | exact weight_sum |].
        rewrite <- (pow2_abs (of_e y t)). apply pow_incr. split; [apply Rabs_pos | exact He]. }
      assert (M0 : 0 <= sqrt (n_bar2 c) * E_0 c) by (apply Rmult_le_pos; lra).
      pose proof (square_triangle (n c) n_pos z (sqrt (n_bar2 c) * E_0 c) N _ _ _ _ _ _ Z0 M0 Hz Sm) as T1.
      pose proof (square_triangle (n c) n_pos (z + sqrt (n_bar2 c) * E_0 c) (Z_per c) N _ _ _ _ _ _ ltac:(lra) Zp T1 Sz') as T2.
      apply Rle_trans with (2 := T2). right. unfold square, sum1. apply f_equal2; [ring|]. apply sum_ext. intros i _. ring.
    - (* zeta = 0 *)
      destruct Hz as [Hz0 Hzl]. apply Rle_trans with (2 := Sz'). right. unfold square, sum1. apply f_equal2.
      + rewrite Hz0. ring.
      + apply sum_ext. intros i Hi. destruct (Hzl (S i) ltac:(lia)) as [-> ->]. ring. }
  unfold Ut, level.
  assert (w_x c * P t (xt y p t) <= w_x c * (p_up c * d_X c ^ 2)) by (apply Rmult_le_compat_l; lra).
  assert (h c * Vt N y p t <= h c * d_Z c ^ 2) by (apply Rmult_le_compat_l; lra). lra.
Qed.

End Along.

(** A time kept between t0 and t1. *)
Definition clamp (t0 t1 t : R) : R := Rmax t0 (Rmin t1 t).

Lemma clamp_between t0 t1 t : t0 <= t1 -> t0 <= clamp t0 t1 t <= t1.
Proof. intros H. unfold clamp, Rmax, Rmin. destruct (Rle_dec t1 t); destruct (Rle_dec t0 _); lra. Qed.

Lemma clamp_same t0 t1 t : t0 <= t <= t1 -> clamp t0 t1 t = t.
Proof. intros H. unfold clamp, Rmax, Rmin. destruct (Rle_dec t1 t); destruct (Rle_dec t0 _); lra. Qed.

Lemma clamp_continuous t0 t1 t : continuous (clamp t0 t1) t.
Proof.
  apply filterlim_locally. intros eps. exists eps. intros r Hr.
  unfold ball in *; simpl in *; unfold AbsRing_ball, abs, minus, plus, opp in *; simpl in *.
  apply Rle_lt_trans with (2 := Hr). change (Rabs (clamp t0 t1 r - clamp t0 t1 t) <= Rabs (r - t)).
  assert (M : forall a u v, Rabs (Rmax a u - Rmax a v) <= Rabs (u - v)).
  { intros a u v. unfold Rmax. destruct (Rle_dec a u), (Rle_dec a v); unfold Rabs;
      repeat match goal with |- context [Rcase_abs ?x] => destruct (Rcase_abs x) end; lra. }
  assert (m : forall a u v, Rabs (Rmin a u - Rmin a v) <= Rabs (u - v)).
  { intros a u v. unfold Rmin. destruct (Rle_dec a u), (Rle_dec a v); unfold Rabs;
      repeat match goal with |- context [Rcase_abs ?x] => destruct (Rcase_abs x) end; lra. }
  unfold clamp. apply Rle_trans with (1 := M _ _ _). apply m.
Qed.

(** Theorem 5 up to its last step: a start in the set stays in the box, and U falls by what is dissipated. *)
Theorem stays_and_falls s : sigma c <= s -> exists rho, 0 < rho /\
  forall N p, n c O + sum1 N (n c) <= n_bar2 c -> (forall t, solves N s p t) -> sized N p -> falls N s p rho.
Proof.
  intros Hs. destruct (declines c f q F P P' form (proj2 plant) conditions s Hs) as [rho [Hrho Dec]]. exists rho. split; [exact Hrho|].
  intros N p Hn Hp Hsz y t0 t1 H01 Hy Hst.
  set (k := clamp t0 t1).
  assert (Kin : forall t, solves N s y (k t)) by (intros t; apply Hy, clamp_between, H01).
  assert (Kc : forall g : R -> R, (forall t, t0 <= t <= t1 -> continuous g t) -> forall t, continuous (fun t => g (k t)) t).
  { intros g Hg t. apply (continuous_comp k g); [apply clamp_continuous | apply Hg, clamp_between, H01]. }
  assert (L4 : level c < Rmin (w_x c * p_low c * D_x c ^ 2) (D_e c ^ 2)).
  { rewrite <- min2_Rmin. apply (C4 _ conditions). }
  assert (In : forall t, t0 <= t <= t1 ->
            in_box (fun t => norm (xt y p (k t))) (fun t => Rabs (et y p (k t))) (D_x c) (D_e c) t /\ Ut N y p t <= level c).
  { apply containment with (U' := U'_ N s p y) (lo_x := w_x c * p_low c); try assumption.
    - apply (Kc (fun t => norm (xt y p t))). intros t Ht. apply (xt_continuous N s p y Hp t (Hy t Ht)).
    - apply (Kc (fun t => Rabs (et y p t))). intros t Ht.
      apply (continuous_comp (et y p) Rabs); [apply (et_continuous N s p y Hp t (Hy t Ht)) | apply (filterlim_norm (V := R_NormedModule))].
    - apply Rmult_lt_0_compat; lra.
    - intros t Ht. unfold k. rewrite clamp_same by exact Ht. rewrite pow2_abs.
      pose proof (form_low form t (xt y p t)) as Lo. pose proof (P_nonneg t (xt y p t)) as P0.
      assert (V0 : 0 <= Vt N y p t).
      { unfold Vt. unfold et at 1. rewrite (V_difference (n c) N (of_e y) (of_z0 y) (of_e p) (of_z0 p) (of_za y) (of_zb y) (of_za p) (of_zb p)).
        apply square_nonneg, n_pos. }
      assert (0 <= h c * Vt N y p t) by (apply Rmult_le_pos; lra).
      assert (0 <= w_x c * P t (xt y p t)) by (apply Rmult_le_pos; lra).
      assert (w_x c * (p_low c * norm (xt y p t) ^ 2) <= w_x c * P t (xt y p t)) by (apply Rmult_le_compat_l; lra).
      pose proof (pow2_ge_0 (et y p t)). unfold Ut. split; lra.
    - intros t Ht. apply (U_derive_ N s p y Hp t (Hy t Ht)).
    - intros t Ht [B1 B2]. unfold k in B1, B2. rewrite clamp_same in B1, B2 by exact Ht.
      apply Rle_trans with (1 := U'_le N s p y Hsz rho t (Hy t Ht) B1 B2 Dec).
      assert (0 <= dissipated N y p t).
      { unfold dissipated. pose proof (P_nonneg t (xt y p t)). pose proof (pow2_ge_0 (et y p t)). pose proof (pow2_ge_0 (st N y p t)). lra. }
      assert (0 <= rho * dissipated N y p t) by (apply Rmult_le_pos; lra). lra.
    - apply (U_start N p y Hn Hsz t0 Hst). }
  intros t Ht. destruct (In t Ht) as [[B1 B2] B3]. unfold k in B1, B2. rewrite clamp_same in B1, B2 by exact Ht.
  repeat split; try assumption.
  intros r Hr.
  (* What is dissipated, continued beyond [t0, t1]. *)
  set (g := fun t => dissipated N y p (k t)).
  assert (Gc : forall t, continuous g t).
  { apply Kc. intros v Hv. apply (dissipated_continuous N s p y Hp v (Hy v Hv)). }
  assert (Gi : forall a b, ex_RInt g a b) by (intros a b; apply (ex_RInt_continuous (V := R_CompleteNormedModule)); intros; apply Gc).
  rewrite (RInt_ext (V := R_CompleteNormedModule) (dissipated N y p) g).
  2:{ intros v Hv. rewrite Rmin_left, Rmax_right in Hv by lra. unfold g, k. rewrite clamp_same by lra. reflexivity. }
  destruct (Req_dec r t) as [->|Hne].
  { rewrite RInt_point. change (zero : R) with 0. lra. }
  set (W := fun v => Ut N y p v + rho * RInt g r v).
  assert (WD : forall v, t0 <= v <= t1 -> is_derive W v (U'_ N s p y v + rho * g v)).
  { intros v Hv. unfold W. apply (is_derive_plus (V := R_NormedModule)); [apply (U_derive_ N s p y Hp v (Hy v Hv))|].
    apply is_derive_scal. apply (is_derive_RInt g (RInt g r) r v).
    - apply filter_forall. intros b. apply (RInt_correct (V := R_CompleteNormedModule)), Gi.
    - apply Gc. }
  destruct (MVT_gen W r t (fun v => U'_ N s p y v + rho * g v)) as [v [Hv E]].
  - intros v Hv. rewrite Rmin_left, Rmax_right in Hv by lra. apply WD. lra.
  - intros v Hv. rewrite Rmin_left, Rmax_right in Hv by lra.
    apply continuity_pt_filterlim. apply (ex_derive_continuous (V := R_NormedModule)). eexists. apply WD. lra.
  - rewrite Rmin_left, Rmax_right in Hv by lra.
    destruct (In v ltac:(lra)) as [[C1 C2] _]. unfold k in C1, C2. rewrite clamp_same in C1, C2 by lra.
    pose proof (U'_le N s p y Hsz rho v (Hy v ltac:(lra)) C1 C2 Dec) as Q.
    assert (Eg : g v = dissipated N y p v) by (unfold g, k; rewrite clamp_same by lra; reflexivity).
    rewrite Eg in E.
    assert ((U'_ N s p y v + rho * dissipated N y p v) * (t - r) <= 0 * (t - r)) by (apply Rmult_le_compat_r; lra).
    assert (E0 : W r = Ut N y p r).
    { unfold W. rewrite RInt_point. change (zero : R) with 0. ring. }
    change (W t <= Ut N y p r). lra.
Qed.

(** ** Convergence *)

Lemma Vt_nonneg N p y t : 0 <= Vt N y p t.
Proof.
  unfold Vt. unfold et at 1. rewrite (V_difference (n c) N (of_e y) (of_z0 y) (of_e p) (of_z0 p) (of_za y) (of_zb y) (of_za p) (of_zb p)).
  apply square_nonneg, n_pos.
Qed.

Lemma st_square N p y t : n c O + sum1 N (n c) <= n_bar2 c -> st N y p t ^ 2 <= n_bar2 c * Vt N y p t.
Proof.
  intros Hn.
  assert (E : st N y p t ^ 2 <= (n c O + sum1 N (n c)) * Vt N y p t) by (apply (s_square (n c) n_pos)).
  apply Rle_trans with (1 := E). apply Rmult_le_compat_r; [apply Vt_nonneg | exact Hn].
Qed.

(** The integral of what is dissipated is bounded, and neither xi^2 nor et^2 rises too fast: both tend to 0. *)
Theorem errors_tend s rho N p : 0 < rho -> n c O + sum1 N (n c) <= n_bar2 c -> (forall t, solves N s p t) -> sized N p ->
  falls N s p rho -> errors_vanish N s p.
Proof.
  intros Hrho Hn Hp Hsz Hf y t0 Hy Hst eps He.
  assert (In : forall t, t0 <= t ->
            norm (xt y p t) < D_x c /\ Rabs (et y p t) < D_e c /\ Ut N y p t <= level c /\
            RInt (dissipated N y p) t0 t <= level c / rho).
  { intros t Ht.
    destruct (Hf y t0 t Ht (fun r Hr => Hy r (proj1 Hr)) Hst t ltac:(lra)) as [B1 [B2 [B3 B4]]].
    specialize (B4 t0 ltac:(lra)). pose proof (U_start N p y Hn Hsz t0 Hst) as B5.
    repeat split; try assumption. apply le_div; [exact Hrho|].
    assert (U0 : 0 <= Ut N y p t).
    { unfold Ut. pose proof (Vt_nonneg N p y t) as V0. pose proof (P_nonneg t (xt y p t)) as P0. pose proof (pow2_ge_0 (et y p t)).
      assert (0 <= h c * Vt N y p t) by (apply Rmult_le_pos; lra). assert (0 <= w_x c * P t (xt y p t)) by (apply Rmult_le_pos; lra). lra. }
    lra. }
  destruct (slopes c f q F P P' form (proj2 plant) conditions) as [C1 [HC1 Slow]].
  assert (Near : forall t, t0 <= t -> near c (of_x y t) (of_x p t) (of_e y t) (of_e p t)).
  { intros t Ht. destruct (In t Ht) as [B1 [B2 _]]. destruct (Hsz t) as [S1 [S2 _]]. repeat split; assumption. }
  assert (Int : forall g : R -> R, (forall t, t0 <= t -> continuous g t) -> (forall t, g t <= dissipated N y p t) ->
            forall t, t0 <= t -> RInt g t0 t <= level c / rho).
  { intros g Hc Hg t Ht. apply Rle_trans with (2 := proj2 (proj2 (proj2 (In t Ht)))).
    apply RInt_le; [exact Ht | | | intros; apply Hg];
      apply (ex_RInt_continuous (V := R_CompleteNormedModule)); intros r Hr; rewrite Rmin_left, Rmax_right in Hr by lra.
    - apply Hc. lra.
    - apply (dissipated_continuous N s p y Hp r (Hy r ltac:(lra))). }
  (* xi *)
  assert (D1 : forall t, t0 <= t -> is_derive (fun t => P t (xt y p t)) t
            (P' t (xt y p t) (minus (f t (of_x y t) (of_e y t)) (f t (of_x p t) (of_e p t))))).
  { intros t Ht. apply (form_derive form t (xt y p)), (xt_derive N s p y Hp t (Hy t Ht)). }
  destruct (vanishes (fun t => P t (xt y p t))
              (fun t => P' t (xt y p t) (minus (f t (of_x y t) (of_e y t)) (f t (of_x p t) (of_e p t))))
              t0 C1 (level c / rho) HC1) with (eps := p_low c * eps ^ 2) as [t1 [T1 V1]].
  - intros t _. apply P_nonneg.
  - exact D1.
  - intros t Ht. apply (Slow t _ _ _ _ (Near t Ht)).
  - apply Int.
    + intros t Ht. apply (ex_derive_continuous (V := R_NormedModule)). eexists. apply D1, Ht.
    + intros t. unfold dissipated. pose proof (pow2_ge_0 (et y p t)). pose proof (pow2_ge_0 (st N y p t)). lra.
  - apply Rmult_lt_0_compat; [lra | apply pow_lt, He].
  - (* et *)
    set (Y := C1 + mu c * sqrt (n_bar2 c * (level c / h c))).
    set (C2 := 2 * D_e c * (Y + Rabs s * D_e c) + 1).
    set (g' := fun t => 2 * et y p t * (Loop.y (n c) N s (mu c) 1 (et y p)
                      (fun t => q t (of_x y t) (of_e y t) - q t (of_x p t) (of_e p t))
                      (fun t => of_z0 y t - of_z0 p t) (fun l t => of_za y l t - of_za p l t) t - s * et y p t)).
    assert (D2 : forall t, t0 <= t -> is_derive (fun t => et y p t ^ 2) t (g' t)).
    { intros t Ht. pose proof (loop_e _ _ _ _ _ _ _ _ _ _ _ t (difference_loop N s p y Hp t (Hy t Ht))) as L.
      unfold g'. evar_last; [apply (is_derive_pow (et y p) 2 t _ L)|].
      simpl. ring. }
    assert (Slope : forall t, t0 <= t -> g' t <= C2 /\ 0 < C2).
    { intros t Ht. destruct (Slow t _ _ _ _ (Near t Ht)) as [_ Q]. destruct (In t Ht) as [_ [B2 [B3 _]]].
      unfold g'. unfold Loop.y.
      set (d := q t (of_x y t) (of_e y t) - q t (of_x p t) (of_e p t)) in *.
      change (s_ (n c) N (et y p) (fun t => of_z0 y t - of_z0 p t) (fun l t => of_za y l t - of_za p l t) t) with (st N y p t).
      assert (Z1 : Rabs (st N y p t) <= sqrt (n_bar2 c * (level c / h c))).
      { rewrite <- (sqrt_pow2 (Rabs (st N y p t))) by apply Rabs_pos. apply sqrt_le_1_alt. rewrite pow2_abs.
        assert (B0 : 0 <= n_bar2 c).
        { apply Rle_trans with (2 := Hn). apply Rplus_le_le_0_compat; [left; apply n_pos | apply sum_nonneg; intros; left; apply n_pos]. }
        apply Rle_trans with (1 := st_square N p y t Hn). apply Rmult_le_compat_l; [exact B0|].
        apply le_div; [exact h_pos|]. unfold Ut in B3.
        pose proof (P_nonneg t (xt y p t)) as P0. pose proof (pow2_ge_0 (et y p t)).
        assert (0 <= w_x c * P t (xt y p t)) by (apply Rmult_le_pos; lra). lra. }
      set (e := et y p t) in *. set (m := st N y p t) in *.
      assert (E0 : 0 <= Rabs e) by apply Rabs_pos.
      assert (Z4 : Rabs (d + (1 - 1) * s * e + 1 * mu c * m) <= Y).
      { replace (d + (1 - 1) * s * e + 1 * mu c * m) with (d + mu c * m) by ring.
        apply Rle_trans with (1 := Rabs_triang _ _). unfold Y. apply Rplus_le_compat.
        - exact Q.
        - rewrite Rabs_mult, (Rabs_right (mu c)) by lra. apply Rmult_le_compat_l; [lra | exact Z1]. }
      set (v := d + (1 - 1) * s * e + 1 * mu c * m) in *.
      assert (Y0 : 0 <= Y) by (apply Rle_trans with (2 := Z4), Rabs_pos).
      assert (Z5 : Rabs (v - s * e) <= Y + Rabs s * D_e c).
      { unfold Rminus. apply Rle_trans with (1 := Rabs_triang _ _). rewrite Rabs_Ropp, Rabs_mult. apply Rplus_le_compat; [exact Z4|].
        apply Rmult_le_compat_l; [apply Rabs_pos | lra]. }
      assert (S0 : 0 <= Rabs s * D_e c) by (apply Rmult_le_pos; [apply Rabs_pos | lra]).
      assert (Z6 : e * (v - s * e) <= D_e c * (Y + Rabs s * D_e c)).
      { apply Rle_trans with (1 := Rle_abs _). rewrite Rabs_mult. apply Rmult_le_compat; [exact E0 | apply Rabs_pos | lra | exact Z5]. }
      assert (0 <= D_e c * (Y + Rabs s * D_e c)) by (apply Rmult_le_pos; lra).
      unfold C2. split; lra. }
    destruct (vanishes (fun t => et y p t ^ 2) g' t0 C2 (level c / rho) (proj2 (Slope t0 ltac:(lra)))) with (eps := eps ^ 2) as [t2 [T2 V2]].
    + intros t _. apply pow2_ge_0.
    + exact D2.
    + intros t Ht. apply Slope, Ht.
    + apply Int.
      * intros t Ht. apply (ex_derive_continuous (V := R_NormedModule)). eexists. apply D2, Ht.
      * intros t. unfold dissipated. pose proof (P_nonneg t (xt y p t)). pose proof (pow2_ge_0 (st N y p t)). lra.
    + apply pow_lt, He.
    + exists (Rmax t1 t2). intros t Ht. pose proof (Rmax_l t1 t2). pose proof (Rmax_r t1 t2).
      specialize (V1 t ltac:(lra)). specialize (V2 t ltac:(lra)). simpl in V1. cbv beta in V2.
      split; apply Rnot_le_lt; intros L.
      * assert (eps ^ 2 <= norm (xt y p t) ^ 2) by (apply pow_incr; lra).
        pose proof (form_low form t (xt y p t)).
        assert (p_low c * eps ^ 2 <= p_low c * norm (xt y p t) ^ 2) by (apply Rmult_le_compat_l; lra). lra.
      * assert (eps ^ 2 <= Rabs (et y p t) ^ 2) by (apply pow_incr; lra). rewrite pow2_abs in *. lra.
Qed.

(** ** With the existence of the periodic solution *)

(** T_N <= k_0 + k_1 x^2: at integers where the base frequency is matched, else everywhere. *)
Definition transfer_bound : Prop :=
  if matched c
  then w c * period c = 2 * PI /\ forall N k, T (n c) (mu c / w c) N (IZR k) <= k_0 c + k_1 c * IZR k ^ 2
  else forall N x, T (n c) (mu c / w c) N x <= k_0 c + k_1 c * x ^ 2.

(** Theorem 10 of section 10.3, of this plant. Not proved in Coq: Schauder's theorem is behind it. It takes of the plant what [about]
    does not say: that f and q are C2 and periodic, f(t,0,0) = 0, the bounds b_f, b_q, b_qt, their mean squares and those of the
    harmonics, and the second triple; of the
    formulas of a plant the orbit, the forcing and the values at (X_p, E_p) of section 11. *)
Definition existence_10_3 : Prop :=
  existence_conditions c -> weights (n c) -> transfer_bound ->
  forall N s, sigma c <= s -> exists p, (forall t, solves N s p t) /\ periodic N p /\ sized N p.

Definition certified : Prop :=
  forall s, sigma c <= s -> exists rho, 0 < rho /\
  forall N, exists p, (forall t, solves N s p t) /\ periodic N p /\ sized N p /\ attracts N s p rho.

(** What a certificate says: with its conditions, the transfer bound and the sum of the weights, which are about numbers alone, and
    Theorem 10. *)
Theorem claim :
  existence_10_3 ->
  existence_conditions c -> weights (n c) -> transfer_bound -> (forall N, n c O + sum1 N (n c) <= n_bar2 c) ->
  certified.
Proof.
  intros Ex H1 H2 H3 H4 s Hs. destruct (stays_and_falls s Hs) as [rho [Hrho A]].
  exists rho. split; [exact Hrho|]. intros N. destruct (Ex H1 H2 H3 N s Hs) as [p [P1 [P2 P3]]].
  exists p. split; [exact P1|]. split; [exact P2|]. split; [exact P3|].
  pose proof (A N p (H4 N) P1 P3) as Fa. split; [exact Fa|]. apply (errors_tend s rho N p Hrho (H4 N) P1 P3 Fa).
Qed.

End Claim.
