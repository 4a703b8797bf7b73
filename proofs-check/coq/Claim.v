(** Sections 5, 10.4, 13.1 and 13.7: what a certificate in continuous time says, with every number in it a parameter ([Sizes.v]). From its
    conditions of stability, what is known of the plant ([PlantBounds.v]) and a periodic solution of the stated size follows: every
    solution from the initial set stays in the error box, U does not grow, xt, et and s are square integrable, and the errors of
    x and e tend to 0; for every N, every sigma' >= sigma and every input gain of the interval. With the existence of the periodic
    solution (sections 10.3 and 13.7), which is a hypothesis here, follows [certified]. *)

From Coq Require Import Reals Lra Lia.
From Coquelicot Require Import Coquelicot.
From SigmaStar Require Import Sums Weights Transfer Loop Stability Containment Vanish Sizes Differences PlantBounds Decline.
Local Open Scope R_scope.

Section Claim.
Variable c : numbers.

Context {X : NormedModule R_AbsRing}.
Variables (f : R -> X -> R -> X) (q : R -> X -> R -> R).
Variable m : forms X.

(** ** Solutions *)

Record state : Type := { of_x : R -> X; of_e : R -> R; of_z0 : R -> R; of_za : nat -> R -> R; of_zb : nat -> R -> R }.

(** x' = f, and the loop (1.1) with N oscillators, the gain s and the input gain b, at the time t. *)
Record solves (N : nat) (s b : R) (y : state) (t : R) : Prop := {
  solves_x : is_derive (of_x y) t (f t (of_x y t) (of_e y t));
  solves_loop : equations_at (n c) N (w c) s (mu c) b (of_e y) (fun t => q t (of_x y t) (of_e y t))
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
Definition Ut (s b : R) (N : nat) (y p : state) (t : R) : R := W c m s t (xt y p t) (et y p t) + of_zeta c s b * Vt N y p t.
(** |xt|^2 + et^2 + s^2. *)
Definition dissipated (N : nat) (y p : state) (t : R) : R := norm (xt y p t) ^ 2 + et y p t ^ 2 + st N y p t ^ 2.

(** What is claimed of the periodic solution p, with rho: whatever solves the loop on [t0, t1] and starts in the set stays in the error
    box, and U falls by what is dissipated. *)
Definition falls (N : nat) (s b : R) (p : state) (rho : R) : Prop :=
  forall y t0 t1, t0 <= t1 -> (forall t, t0 <= t <= t1 -> solves N s b y t) -> starts N y t0 ->
  forall t, t0 <= t <= t1 ->
  norm (xt y p t) < D_x c /\ Rabs (et y p t) < D_e c /\ Ut s b N y p t <= top c s /\
  forall r, t0 <= r <= t -> Ut s b N y p t + rho * RInt (dissipated N y p) r t <= Ut s b N y p r.

(** And if it solves the loop for all time, the errors tend to 0. *)
Definition errors_vanish (N : nat) (s b : R) (p : state) : Prop :=
  forall y t0, (forall t, t0 <= t -> solves N s b y t) -> starts N y t0 ->
  forall eps, 0 < eps -> exists t1, forall t, t1 <= t -> norm (xt y p t) < eps /\ Rabs (et y p t) < eps.

Definition attracts (N : nat) (s b : R) (p : state) (rho : R) : Prop := falls N s b p rho /\ errors_vanish N s b p.

(** ** The proof *)

Hypothesis n_pos : forall l, 0 < n c l.
Section Gains.
Hypothesis conditions : stability_conditions c.
(** Of [descends] in Decline.v. *)
Variables s b : R.
Hypothesis descent_ : descent c f q m s b.

Let D_x_pos : 0 < D_x c. Proof. apply (signs_b _ conditions). Qed.
Let D_e_pos : 0 < D_e c. Proof. apply (signs_b _ conditions). Qed.
Let mu_pos : 0 < mu c. Proof. apply (signs_b _ conditions). Qed.
Let k_pos : 0 < of_zeta c s b. Proof. apply (low_pos _ _ _ _ _ _ descent_). Qed.

(** ** Along a solution *)

Section Along.
Variables (N : nat) (p y : state).
Hypothesis weight_sum : n c O + sum1 N (n c) <= n_bar2 c.
Hypothesis p_solves : forall t, solves N s b p t.
Hypothesis p_sized : sized N p.

Definition yt (t : R) : R :=
  Loop.y (n c) N s (mu c) b (et y p) (fun t => q t (of_x y t) (of_e y t) - q t (of_x p t) (of_e p t))
    (fun t => of_z0 y t - of_z0 p t) (fun l t => of_za y l t - of_za p l t) t.
Definition Wt' (t : R) : R :=
  W' c m s t (xt y p t) (et y p t) (minus (f t (of_x y t) (of_e y t)) (f t (of_x p t) (of_e p t))) (yt t - s * et y p t).
Definition U'_ (t : R) : R := Wt' t + of_zeta c s b * (- 2 * st N y p t * yt t).

Lemma difference_loop t : solves N s b y t ->
  equations_at (n c) N (w c) s (mu c) b (et y p) (fun t => q t (of_x y t) (of_e y t) - q t (of_x p t) (of_e p t))
    (fun t => of_z0 y t - of_z0 p t) (fun l t => of_za y l t - of_za p l t) (fun l t => of_zb y l t - of_zb p l t) t.
Proof. intros H. apply equations_difference; [apply H | apply (p_solves t)]. Qed.

Lemma xt_derive t : solves N s b y t ->
  is_derive (xt y p) t (minus (f t (of_x y t) (of_e y t)) (f t (of_x p t) (of_e p t))).
Proof.
  intros H. unfold xt. apply (is_derive_minus (K := R_AbsRing) (V := X)); [apply H | apply (p_solves t)].
Qed.

Lemma W_derive_ t : solves N s b y t -> is_derive (fun t => W c m s t (xt y p t) (et y p t)) t (Wt' t).
Proof.
  intros H. apply (W_derive _ _ _ _ _ _ descent_); [apply xt_derive, H | apply (loop_e _ _ _ _ _ _ _ _ _ _ _ t (difference_loop t H))].
Qed.

Lemma U_derive_ t : solves N s b y t -> is_derive (Ut s b N y p) t (U'_ t).
Proof.
  intros H. unfold Ut, U'_. apply @is_derive_plus; [apply W_derive_, H|].
  apply is_derive_scal. apply (energy _ _ _ _ _ _ _ _ _ _ _ t (difference_loop t H)).
Qed.

Let derivable_continuous (g : R -> R) (g' t : R) : is_derive g t g' -> continuous g t.
Proof. intros D. apply (ex_derive_continuous (V := R_NormedModule)). exists g'. exact D. Qed.

Lemma xt_continuous t : solves N s b y t -> continuous (fun t => norm (xt y p t)) t.
Proof.
  intros H. apply (continuous_comp (xt y p) norm).
  - apply (ex_derive_continuous (K := R_AbsRing) (V := X)). eexists. apply xt_derive, H.
  - apply filterlim_norm.
Qed.

Lemma et_continuous t : solves N s b y t -> continuous (et y p) t.
Proof. intros H. apply (derivable_continuous _ _ t (loop_e _ _ _ _ _ _ _ _ _ _ _ t (difference_loop t H))). Qed.

Lemma dissipated_continuous t : solves N s b y t -> continuous (dissipated N y p) t.
Proof.
  intros H. unfold dissipated.
  assert (Sq : forall g : R -> R, continuous g t -> continuous (fun t => g t ^ 2) t).
  { intros g Hg. apply (continuous_ext (fun t => g t * g t)); [intros r; simpl; ring|].
    apply (continuous_mult (K := R_AbsRing)); exact Hg. }
  apply (continuous_plus (V := R_NormedModule)); [apply (continuous_plus (V := R_NormedModule))|].
  - apply (Sq (fun t => norm (xt y p t))), xt_continuous, H.
  - apply Sq, et_continuous, H.
  - apply (Sq (st N y p)). apply (s_continuous_at _ _ _ _ _ _ _ _ _ _ _ t (difference_loop t H)).
Qed.

(** In the error box U falls. *)
Lemma U'_le rho t : norm (xt y p t) < D_x c -> Rabs (et y p t) < D_e c -> declining c f q m s b rho ->
  U'_ t <= - rho * (dissipated N y p t + yt t ^ 2).
Proof.
  intros Hx He Dec. destruct (p_sized t) as [Sx [Se _]]. unfold U'_, Wt', dissipated.
  apply (Dec t (of_x y t) (of_x p t) (of_e y t) (of_e p t) (st N y p t)); [repeat split; assumption|]. unfold yt, Loop.y, st, et. ring.
Qed.

(** At the start U is at most the level of C4. *)
Lemma U_start t : starts N y t -> Ut s b N y p t <= top c s.
Proof.
  intros [Hx [He Hz]]. destruct (p_sized t) as [Sx [Se Sz]].
  destruct (signs_0 _ conditions) as [X0 [E0 Z0]].
  assert (Nx : norm (xt y p t) <= d_X c).
  { unfold xt, minus, d_X. apply Rle_trans with (1 := norm_triangle _ _). rewrite norm_opp. lra. }
  assert (Ne : Rabs (et y p t) <= d_E c).
  { unfold et, d_E. apply Rle_trans with (Rabs (of_e y t) + Rabs (- of_e p t)); [apply Rabs_triang | rewrite Rabs_Ropp; lra]. }
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
  apply (W_start _ _ _ _ _ _ descent_); [exact Nx | exact Ne|]. split; [|exact A3].
  unfold Vt. unfold et at 1. rewrite (V_difference (n c) N (of_e y) (of_z0 y) (of_e p) (of_z0 p) (of_za y) (of_zb y) (of_za p) (of_zb p)).
  apply square_nonneg, n_pos.
Qed.

End Along.

Lemma dissipated_nonneg N y p t : 0 <= dissipated N y p t.
Proof. unfold dissipated. pose proof (pow2_ge_0 (norm (xt y p t))). pose proof (pow2_ge_0 (et y p t)). pose proof (pow2_ge_0 (st N y p t)). lra. Qed.

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
  assert (Mn : forall a u v, Rabs (Rmin a u - Rmin a v) <= Rabs (u - v)).
  { intros a u v. unfold Rmin. destruct (Rle_dec a u), (Rle_dec a v); unfold Rabs;
      repeat match goal with |- context [Rcase_abs ?x] => destruct (Rcase_abs x) end; lra. }
  unfold clamp. apply Rle_trans with (1 := M _ _ _). apply Mn.
Qed.

(** Theorem 5 up to its last step: a start in the set stays in the box, and U falls by what is dissipated. *)
Lemma falls_ rho : 0 < rho -> declining c f q m s b rho ->
  forall N p, n c O + sum1 N (n c) <= n_bar2 c -> (forall t, solves N s b p t) -> sized N p -> falls N s b p rho.
Proof.
  intros Hrho Dec N p Hn Hp Hsz y t0 t1 H01 Hy Hst. destruct (low_pos _ _ _ _ _ _ descent_) as [Lx [Le _]].
  set (k := clamp t0 t1).
  assert (Kin : forall t, solves N s b y (k t)) by (intros t; apply Hy, clamp_between, H01).
  assert (Kc : forall g : R -> R, (forall t, t0 <= t <= t1 -> continuous g t) -> forall t, continuous (fun t => g (k t)) t).
  { intros g Hg t. apply (continuous_comp k g); [apply clamp_continuous | apply Hg, clamp_between, H01]. }
  assert (In : forall t, t0 <= t <= t1 ->
            in_box (fun t => norm (xt y p (k t))) (fun t => Rabs (et y p (k t))) (D_x c) (D_e c) t /\ Ut s b N y p t <= top c s).
  { apply containment with (U' := U'_ N p y) (lo_x := lo_x c s) (lo_e := lo_e c s); try assumption.
    - apply (Kc (fun t => norm (xt y p t))). intros t Ht. apply (xt_continuous N p y Hp t (Hy t Ht)).
    - apply (Kc (fun t => Rabs (et y p t))). intros t Ht.
      apply (continuous_comp (et y p) Rabs); [apply (et_continuous N p y Hp t (Hy t Ht)) | apply (filterlim_norm (V := R_NormedModule))].
    - intros t Ht. unfold k. rewrite clamp_same by exact Ht. rewrite pow2_abs.
      destruct (W_low _ _ _ _ _ _ descent_ t (xt y p t) (et y p t)) as [A1 A2].
      assert (V0 : 0 <= Vt N y p t).
      { unfold Vt. unfold et at 1. rewrite (V_difference (n c) N (of_e y) (of_z0 y) (of_e p) (of_z0 p) (of_za y) (of_zb y) (of_za p) (of_zb p)).
        apply square_nonneg, n_pos. }
      assert (0 <= of_zeta c s b * Vt N y p t) by (apply Rmult_le_pos; lra). unfold Ut. split; lra.
    - intros t Ht. apply (U_derive_ N p y Hp t (Hy t Ht)).
    - intros t Ht [B1 B2]. unfold k in B1, B2. rewrite clamp_same in B1, B2 by exact Ht.
      apply Rle_trans with (1 := U'_le N p y Hsz rho t B1 B2 Dec).
      pose proof (pow2_ge_0 (yt N p y t)). pose proof (dissipated_nonneg N y p t).
      assert (0 <= rho * (dissipated N y p t + yt N p y t ^ 2)) by (apply Rmult_le_pos; lra). lra.
    - apply (U_start N p y Hn Hsz t0 Hst).
    - apply (top_below _ _ _ _ _ _ descent_). }
  intros t Ht. destruct (In t Ht) as [[B1 B2] B3]. unfold k in B1, B2. rewrite clamp_same in B1, B2 by exact Ht.
  repeat split; try assumption.
  intros r Hr.
  (* What is dissipated, continued beyond [t0, t1]. *)
  set (g := fun t => dissipated N y p (k t)).
  assert (Gc : forall t, continuous g t).
  { apply Kc. intros v Hv. apply (dissipated_continuous N p y Hp v (Hy v Hv)). }
  assert (Gi : forall a b, ex_RInt g a b) by (intros a0 b0; apply (ex_RInt_continuous (V := R_CompleteNormedModule)); intros; apply Gc).
  rewrite (RInt_ext (V := R_CompleteNormedModule) (dissipated N y p) g).
  2:{ intros v Hv. rewrite Rmin_left, Rmax_right in Hv by lra. unfold g, k. rewrite clamp_same by lra. reflexivity. }
  destruct (Req_dec r t) as [->|Hne].
  { rewrite RInt_point. change (zero : R) with 0. lra. }
  set (G := fun v => Ut s b N y p v + rho * RInt g r v).
  assert (WD : forall v, t0 <= v <= t1 -> is_derive G v (U'_ N p y v + rho * g v)).
  { intros v Hv. unfold G. apply (is_derive_plus (V := R_NormedModule)); [apply (U_derive_ N p y Hp v (Hy v Hv))|].
    apply is_derive_scal. apply (is_derive_RInt g (RInt g r) r v).
    - apply filter_forall. intros b0. apply (RInt_correct (V := R_CompleteNormedModule)), Gi.
    - apply Gc. }
  destruct (MVT_gen G r t (fun v => U'_ N p y v + rho * g v)) as [v [Hv E]].
  - intros v Hv. rewrite Rmin_left, Rmax_right in Hv by lra. apply WD. lra.
  - intros v Hv. rewrite Rmin_left, Rmax_right in Hv by lra.
    apply continuity_pt_filterlim. apply (ex_derive_continuous (V := R_NormedModule)). eexists. apply WD. lra.
  - rewrite Rmin_left, Rmax_right in Hv by lra.
    destruct (In v ltac:(lra)) as [[C1 C2] _]. unfold k in C1, C2. rewrite clamp_same in C1, C2 by lra.
    pose proof (U'_le N p y Hsz rho v C1 C2 Dec) as Q.
    assert (Eg : g v = dissipated N y p v) by (unfold g, k; rewrite clamp_same by lra; reflexivity).
    rewrite Eg in E.
    assert (0 <= rho * yt N p y v ^ 2) by (apply Rmult_le_pos; [lra | apply pow2_ge_0]).
    assert ((U'_ N p y v + rho * dissipated N y p v) * (t - r) <= 0 * (t - r)) by (apply Rmult_le_compat_r; lra).
    assert (E0 : G r = Ut s b N y p r).
    { unfold G. rewrite RInt_point. change (zero : R) with 0. ring. }
    change (G t <= Ut s b N y p r). lra.
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

(** The integral of what is dissipated is bounded, so that of W is, and W does not rise fast: it tends to 0. *)
Lemma errors_tend_ rho : 0 < rho -> declining c f q m s b rho ->
  forall N p, n c O + sum1 N (n c) <= n_bar2 c -> (forall t, solves N s b p t) -> sized N p ->
  falls N s b p rho -> errors_vanish N s b p.
Proof.
  intros Hrho Dec N p Hn Hp Hsz Hf y t0 Hy Hst eps He. set (k := of_zeta c s b). set (L := top c s).
  destruct (low_pos _ _ _ _ _ _ descent_) as [Lx [Le _]].
  destruct (W_up _ _ _ _ _ _ descent_) as [C [HC Up]].
  assert (Wpos : forall t, 0 <= W c m s t (xt y p t) (et y p t)).
  { intros t. apply Rle_trans with (2 := proj1 (W_low _ _ _ _ _ _ descent_ t _ _)). apply Rmult_le_pos; [lra | apply pow2_ge_0]. }
  assert (In : forall t, t0 <= t ->
            norm (xt y p t) < D_x c /\ Rabs (et y p t) < D_e c /\ Ut s b N y p t <= L /\ RInt (dissipated N y p) t0 t <= L / rho).
  { intros t Ht.
    destruct (Hf y t0 t Ht (fun r Hr => Hy r (proj1 Hr)) Hst t ltac:(lra)) as [B1 [B2 [B3 B4]]].
    specialize (B4 t0 ltac:(lra)). pose proof (U_start N p y Hn Hsz t0 Hst) as B5.
    repeat split; try assumption. apply le_div; [exact Hrho|].
    assert (U0 : 0 <= Ut s b N y p t).
    { unfold Ut. pose proof (Wpos t). pose proof (Vt_nonneg N p y t). assert (0 <= of_zeta c s b * Vt N y p t) by (apply Rmult_le_pos; lra). lra. }
    unfold L. lra. }
  assert (B0 : 0 <= n_bar2 c).
  { apply Rle_trans with (2 := Hn). apply Rplus_le_le_0_compat; [left; apply n_pos | apply sum_nonneg; intros; left; apply n_pos]. }
  (* W' = U' + 2 k s y <= -rho y^2 + 2 k s y <= k^2 s^2/rho *)
  assert (Slope : forall t, t0 <= t -> Wt' N p y t <= k * (n_bar2 c * L) / rho + 1).
  { intros t Ht. destruct (In t Ht) as [B1 [B2 [B3 _]]].
    pose proof (U'_le N p y Hsz rho t B1 B2 Dec) as F. unfold U'_ in F. fold k in F.
    set (v := yt N p y t) in *. set (z := st N y p t) in *.
    assert (Hz : k * z ^ 2 <= n_bar2 c * L).
    { pose proof (st_square N p y t Hn) as Q. fold z in Q. pose proof (Wpos t). unfold Ut in B3. fold k in B3.
      assert (n_bar2 c * (k * Vt N y p t) <= n_bar2 c * L) by (apply Rmult_le_compat_l; lra).
      assert (k * z ^ 2 <= k * (n_bar2 c * Vt N y p t)) by (apply Rmult_le_compat_l; [unfold k; lra | exact Q]). lra. }
    assert (Hk : k * (k * z ^ 2) / rho <= k * (n_bar2 c * L) / rho).
    { unfold Rdiv. apply Rmult_le_compat_r; [left; apply Rinv_0_lt_compat, Hrho|]. apply Rmult_le_compat_l; [unfold k; lra | exact Hz]. }
    assert (Sq : 2 * k * z * v - rho * v ^ 2 <= k * (k * z ^ 2) / rho).
    { assert (E : k * (k * z ^ 2) / rho - (2 * k * z * v - rho * v ^ 2) = (rho * v - k * z) ^ 2 / rho) by (field; lra).
      assert (0 <= (rho * v - k * z) ^ 2 / rho) by (apply Rmult_le_pos; [apply pow2_ge_0 | left; apply Rinv_0_lt_compat, Hrho]). lra. }
    pose proof (dissipated_nonneg N y p t). assert (0 <= rho * dissipated N y p t) by (apply Rmult_le_pos; lra). lra. }
  assert (Dw : forall t, t0 <= t -> is_derive (fun t => W c m s t (xt y p t) (et y p t)) t (Wt' N p y t)).
  { intros t Ht. apply (W_derive_ N p y Hp t (Hy t Ht)). }
  assert (K0 : 0 < k * (n_bar2 c * L) / rho + 1).
  { assert (0 <= L).
    { destruct (In t0 ltac:(lra)) as [_ [_ [B3 _]]]. apply Rle_trans with (2 := B3). unfold Ut. pose proof (Wpos t0). pose proof (Vt_nonneg N p y t0).
      assert (0 <= of_zeta c s b * Vt N y p t0) by (apply Rmult_le_pos; lra). lra. }
    assert (0 <= k * (n_bar2 c * L) / rho); [|lra].
    apply Rmult_le_pos; [|left; apply Rinv_0_lt_compat, Hrho]. apply Rmult_le_pos; [unfold k; lra | apply Rmult_le_pos; assumption]. }
  set (low := Rmin (lo_x c s) (lo_e c s)). assert (Hlow : 0 < low) by (apply Rmin_glb_lt; assumption).
  destruct (vanishes (fun t => W c m s t (xt y p t) (et y p t)) (Wt' N p y) t0 _ (C * (L / rho)) K0) with (eps := low * eps ^ 2) as [t1 [T1 V1]].
  - intros t _. apply Wpos.
  - exact Dw.
  - exact Slope.
  - intros t Ht.
    assert (Cd : forall r, t0 <= r -> continuous (dissipated N y p) r) by (intros r Hr; apply (dissipated_continuous N p y Hp r (Hy r Hr))).
    apply Rle_trans with (C * RInt (dissipated N y p) t0 t).
    + assert (Id : ex_RInt (dissipated N y p) t0 t).
      { apply (ex_RInt_continuous (V := R_CompleteNormedModule)). intros r Hr. rewrite Rmin_left, Rmax_right in Hr by lra. apply Cd. lra. }
      change (C * RInt (dissipated N y p) t0 t) with (scal C (RInt (V := R_CompleteNormedModule) (dissipated N y p) t0 t)).
      rewrite <- (RInt_scal (V := R_CompleteNormedModule)) by exact Id.
      apply RInt_le; [exact Ht | | apply (ex_RInt_scal (V := R_NormedModule)), Id |].
      * apply (ex_RInt_continuous (V := R_CompleteNormedModule)). intros r Hr. rewrite Rmin_left, Rmax_right in Hr by lra.
        apply (ex_derive_continuous (V := R_NormedModule)). eexists. apply Dw. lra.
      * intros r _. apply Rle_trans with (1 := Up r _ _). change (C * (norm (xt y p r) ^ 2 + et y p r ^ 2) <= C * dissipated N y p r).
        apply Rmult_le_compat_l; [lra|]. unfold dissipated. pose proof (pow2_ge_0 (st N y p r)). lra.
    + apply Rmult_le_compat_l; [lra|]. apply (In t Ht).
  - apply Rmult_lt_0_compat; [exact Hlow | apply pow_lt, He].
  - exists t1. intros t Ht. specialize (V1 t Ht). cbv beta in V1. destruct (W_low _ _ _ _ _ _ descent_ t (xt y p t) (et y p t)) as [A1 A2].
    assert (M : forall lo v, low <= lo -> 0 <= v -> lo * v ^ 2 <= W c m s t (xt y p t) (et y p t) -> v < eps).
    { intros lo v Hlo Hv Q. apply Rnot_le_lt. intros F. assert (eps ^ 2 <= v ^ 2) by (apply pow_incr; lra).
      pose proof (pow2_ge_0 v). assert (low * eps ^ 2 <= low * v ^ 2) by (apply Rmult_le_compat_l; lra).
      assert (low * v ^ 2 <= lo * v ^ 2) by (apply Rmult_le_compat_r; assumption). lra. }
    split; [apply (M (lo_x c s) _ (Rmin_l _ _) (norm_ge_0 _) A1) | apply (M (lo_e c s) _ (Rmin_r _ _) (Rabs_pos _))].
    rewrite pow2_abs. exact A2.
Qed.

End Gains.

(** Theorem 5 up to its last step: a start in the set stays in the box, U falls by what is dissipated, and the errors of x and e tend to 0. *)
Theorem attracting : about c f q m -> stability_conditions c -> forall s b, sigma c <= s -> b_lo c <= b <= b_hi c ->
  exists rho, 0 < rho /\
  forall N p, n c O + sum1 N (n c) <= n_bar2 c -> (forall t, solves N s b p t) -> sized N p -> attracts N s b p rho.
Proof.
  intros A S s b Hs Hb. pose proof (descends c f q m A S s b Hs Hb) as D. destruct (W_falls _ _ _ _ _ _ D) as [rho [Hrho Dec]].
  exists rho. split; [exact Hrho|]. intros N p Hn Hp Hsz. pose proof (falls_ S s b D rho Hrho Dec N p Hn Hp Hsz) as Fa.
  split; [exact Fa | apply (errors_tend_ S s b D rho Hrho Dec N p Hn Hp Hsz Fa)].
Qed.

(** ** With the existence of the periodic solution *)

(** T_N <= k_0 + k_1 x^2 with nu at b_lo: at integers where the base frequency is matched, else everywhere. *)
Definition transfer_bound : Prop :=
  if matched c
  then w c * period c = 2 * PI /\ forall N k, T (n c) (nu_lo c) N (IZR k) <= k_0 c + k_1 c * IZR k ^ 2
  else forall N x, T (n c) (nu_lo c) N x <= k_0 c + k_1 c * x ^ 2.

(** Theorem 10 of section 10.3, with an input gain G1 of 13.1, with (E) Theorem 13.7.5 or 13.7.8, of this plant. Not proved in Coq: Schauder's
    theorem is behind it. It takes of the plant what [about] does not say: that f and q are C2 and periodic, f(t,0,0) = 0, the bounds b_f, b_q,
    b_qt, their mean squares and those of the harmonics, and the second triple; of the formulas of a plant the orbit, the forcing and the
    values at (X_p, E_p) of section 11, and the matrix inequalities of (E). *)
Definition periodic_exists : Prop :=
  existence_conditions c -> weights (n c) -> transfer_bound ->
  forall N s b, sigma c <= s -> b_lo c <= b <= b_hi c -> exists p, (forall t, solves N s b p t) /\ periodic N p /\ sized N p.

Definition certified : Prop :=
  forall s b, sigma c <= s -> b_lo c <= b <= b_hi c -> exists rho, 0 < rho /\
  forall N, exists p, (forall t, solves N s b p t) /\ periodic N p /\ sized N p /\ attracts N s b p rho.

(** What a certificate says: with its conditions, the transfer bound and the sum of the weights, which are about numbers alone, and
    [periodic_exists]. *)
Theorem claim :
  about c f q m -> stability_conditions c -> periodic_exists ->
  existence_conditions c -> weights (n c) -> transfer_bound -> (forall N, n c O + sum1 N (n c) <= n_bar2 c) ->
  certified.
Proof.
  intros A S Ex H1 H2 H3 H4 s b Hs Hb. destruct (attracting A S s b Hs Hb) as [rho [Hrho At]].
  exists rho. split; [exact Hrho|]. intros N. destruct (Ex H1 H2 H3 N s b Hs Hb) as [p [P1 [P2 P3]]].
  exists p. split; [exact P1|]. split; [exact P2|]. split; [exact P3|]. apply (At N p (H4 N) P1 P3).
Qed.

End Claim.
