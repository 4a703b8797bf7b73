(** Section 13.7, (M): U' = -F for the matrix inequality F, and a lower bound of F at finitely many points holds on their convex hull,
    and between two sigma or two input gains; without an input gain, for every larger sigma too. (Jm): the two matrices and what is between. *)

From Coq Require Import Reals Lra Lia.
From Coquelicot Require Import Coquelicot.
From SigmaStar Require Import Sums.
Local Open Scope R_scope.

Section MatrixInequality.
(** The dimension of x, and the numbers of U. kp = 2h/mu; with an input gain kp = 2 ht and h = b mu ht. *)
Variable d_x : nat.
Variables w_x kp : R.

Definition dot (a x : nat -> R) : R := sum d_x (fun i => a i * x i).
(** x'A z *)
Definition bilinear (A : nat -> nat -> R) (x z : nat -> R) : R := sum d_x (fun i => sum d_x (fun j => x i * A i j * z j)).
Definition apply (A : nat -> nat -> R) (x : nat -> R) (i : nat) : R := dot (A i) x.

(** The derivatives at one point: J, g of f, and r, d of q. *)
Record slopes := { J : nat -> nat -> R; gv : nat -> R; rv : nat -> R; dv : R }.

(** F of (M) as a quadratic form in (x, e, y); x'(PJ + J'P)x = 2 x'PJx, and Pd = P'. b is the input gain (1 without). *)
Definition F (P Pd : nat -> nat -> R) (D : slopes) (sigma b : R) (x : nat -> R) (e y : R) : R :=
  - w_x * (bilinear Pd x x + 2 * bilinear P x (apply (J D) x)) - 2 * w_x * bilinear P x (gv D) * e
  - kp * dot (rv D) x * y + 2 * sigma * e ^ 2 - (2 + kp * (dv D + (1 - b) * sigma)) * e * y + kp * y ^ 2.

(** ** The hull *)

Definition mix (K : nat) (la : nat -> R) (D : nat -> slopes) : slopes :=
  {| J := fun i j => sum K (fun k => la k * J (D k) i j);
     gv := fun i => sum K (fun k => la k * gv (D k) i);
     rv := fun i => sum K (fun k => la k * rv (D k) i);
     dv := sum K (fun k => la k * dv (D k)) |}.

Lemma sum_swap m k (f : nat -> nat -> R) : sum m (fun i => sum k (fun j => f i j)) = sum k (fun j => sum m (fun i => f i j)).
Proof.
  induction m as [|m IH]; simpl; [symmetry; apply sum_zero; reflexivity|]. rewrite IH, <- sum_plus. reflexivity.
Qed.

Lemma sum_scal_r m f a : sum m f * a = sum m (fun i => f i * a).
Proof. rewrite Rmult_comm, <- sum_scal. apply sum_ext. intros; ring. Qed.

Lemma dot_mix K la (a : nat -> nat -> R) x :
  dot (fun i => sum K (fun k => la k * a k i)) x = sum K (fun k => la k * dot (a k) x).
Proof.
  unfold dot. rewrite (sum_ext d_x _ (fun i => sum K (fun k => la k * (a k i * x i)))).
  - rewrite sum_swap. apply sum_ext. intros k _. rewrite sum_scal. reflexivity.
  - intros i _. rewrite sum_scal_r. apply sum_ext. intros; ring.
Qed.

Lemma bilinear_mix P x K la (z : nat -> nat -> R) :
  bilinear P x (fun i => sum K (fun k => la k * z k i)) = sum K (fun k => la k * bilinear P x (z k)).
Proof.
  unfold bilinear. rewrite (sum_ext d_x _ (fun i => sum K (fun k => la k * sum d_x (fun j => x i * P i j * z k j)))).
  - rewrite sum_swap. apply sum_ext. intros k _. rewrite sum_scal. reflexivity.
  - intros i _. rewrite (sum_ext d_x _ (fun j => sum K (fun k => la k * (x i * P i j * z k j)))).
    + rewrite sum_swap. apply sum_ext. intros k _. rewrite sum_scal. reflexivity.
    + intros j _. rewrite <- sum_scal. apply sum_ext. intros; ring.
Qed.

Lemma bilinear_ext P x z z' : (forall i, z i = z' i) -> bilinear P x z = bilinear P x z'.
Proof. intros E. unfold bilinear. apply sum_ext. intros i _. apply sum_ext. intros j _. rewrite E. reflexivity. Qed.

(** F is affine in (J, g, r, d). *)
Theorem F_mix P Pd K la D sigma b x e y :
  sum K la = 1 -> F P Pd (mix K la D) sigma b x e y = sum K (fun k => la k * F P Pd (D k) sigma b x e y).
Proof.
  intros H1. unfold F, mix; simpl J; simpl gv; simpl rv; simpl dv.
  rewrite (bilinear_ext P x (apply (fun i j => sum K (fun k => la k * J (D k) i j)) x)
             (fun i => sum K (fun k => la k * apply (J (D k)) x i))) by (intros i; unfold apply; apply dot_mix).
  rewrite !bilinear_mix, dot_mix.
  change (fun k => la k * bilinear P x (fun i => apply (J (D k)) x i)) with (fun k => la k * bilinear P x (apply (J (D k)) x)).
  change (fun k => la k * bilinear P x (fun i => gv (D k) i)) with (fun k => la k * bilinear P x (gv (D k))).
  change (fun k => la k * dot (fun i => rv (D k) i) x) with (fun k => la k * dot (rv (D k)) x).
  set (A := - w_x * bilinear Pd x x + 2 * sigma * e ^ 2 - (2 + kp * ((1 - b) * sigma)) * e * y + kp * y ^ 2).
  rewrite (sum_ext K (fun k => la k * (- w_x * (bilinear Pd x x + 2 * bilinear P x (apply (J (D k)) x))
      - 2 * w_x * bilinear P x (gv (D k)) * e - kp * dot (rv (D k)) x * y + 2 * sigma * e ^ 2
      - (2 + kp * (dv (D k) + (1 - b) * sigma)) * e * y + kp * y ^ 2))
    (fun k => A * la k + (- 2 * w_x * (la k * bilinear P x (apply (J (D k)) x)) + (- 2 * w_x * e * (la k * bilinear P x (gv (D k)))
       + (- kp * y * (la k * dot (rv (D k)) x) + - kp * e * y * (la k * dv (D k))))))) by (intros; unfold A; ring).
  rewrite !sum_plus, !sum_scal, H1. unfold A. ring.
Qed.

(** Positive at finitely many points, so on their hull. *)
Theorem F_hull P Pd K la D sigma b x e y lower :
  (forall k, (k < K)%nat -> 0 <= la k) -> sum K la = 1 ->
  (forall k, (k < K)%nat -> lower <= F P Pd (D k) sigma b x e y) ->
  lower <= F P Pd (mix K la D) sigma b x e y.
Proof.
  intros H0 H1 HF. rewrite (F_mix P Pd K la D sigma b x e y H1).
  replace lower with (lower * sum K la) by (rewrite H1; ring). rewrite <- sum_scal.
  apply sum_le. intros k Hk. pose proof (H0 k Hk). pose proof (HF k Hk). nra.
Qed.

(** The same between two gains sigma, and between two input gains. *)
Theorem F_between_sigma P Pd D s0 s1 th b x e y lower :
  0 <= th <= 1 -> lower <= F P Pd D s0 b x e y -> lower <= F P Pd D s1 b x e y ->
  lower <= F P Pd D ((1 - th) * s0 + th * s1) b x e y.
Proof.
  intros Ht H0 H1. replace (F P Pd D ((1 - th) * s0 + th * s1) b x e y)
    with ((1 - th) * F P Pd D s0 b x e y + th * F P Pd D s1 b x e y) by (unfold F; ring). nra.
Qed.

Theorem F_between_b P Pd D sigma b0 b1 th x e y lower :
  0 <= th <= 1 -> lower <= F P Pd D sigma b0 x e y -> lower <= F P Pd D sigma b1 x e y ->
  lower <= F P Pd D sigma ((1 - th) * b0 + th * b1) x e y.
Proof.
  intros Ht H0 H1. replace (F P Pd D sigma ((1 - th) * b0 + th * b1) x e y)
    with ((1 - th) * F P Pd D sigma b0 x e y + th * F P Pd D sigma b1 x e y) by (unfold F; ring). nra.
Qed.

(** ** What the margins give *)

(** J + de I. *)
Definition shifted (de : R) (D : slopes) : slopes :=
  {| J := fun i j => J D i j + (if Nat.eq_dec i j then de else 0); gv := gv D; rv := rv D; dv := dv D |}.

Lemma sum_one m (i : nat) a (x : nat -> R) : (i < m)%nat -> sum m (fun j => (if Nat.eq_dec i j then a else 0) * x j) = a * x i.
Proof.
  induction m as [|m IH]; intros Hi; [lia|]. simpl. destruct (Nat.eq_dec i m) as [E|E].
  - subst i. rewrite sum_zero; [ring|]. intros j Hj. destruct (Nat.eq_dec m j) as [E|E]; [lia | ring].
  - rewrite IH by lia. ring.
Qed.

Lemma bilinear_shifted P D de x :
  bilinear P x (apply (J (shifted de D)) x) = bilinear P x (apply (J D) x) + de * bilinear P x x.
Proof.
  unfold bilinear. rewrite <- sum_scal, <- sum_plus. apply sum_ext. intros i _.
  rewrite <- sum_scal, <- sum_plus. apply sum_ext. intros j Hj. unfold apply, dot, shifted; simpl J.
  rewrite (sum_ext d_x _ (fun k => J D j k * x k + (if Nat.eq_dec j k then de else 0) * x k)) by (intros; ring).
  rewrite sum_plus, sum_one by exact Hj. ring.
Qed.

(** Proposition 13.7.2: what is asked for at tau and with J + de I gives it with a margin for J at every gain sigma. *)
Theorem F_margin P Pd D de tau sigma x e y :
  F P Pd D sigma 1 x e y = F P Pd (shifted de D) tau 1 x e y + 2 * w_x * de * bilinear P x x + 2 * (sigma - tau) * e ^ 2.
Proof. unfold F. rewrite bilinear_shifted. simpl gv; simpl rv; simpl dv. ring. Qed.

(** ** The derivative of U *)

(** Functions of time: x and P with their derivatives, e, s = M'N zeta and V = zeta'N zeta of [Loop]. *)
Variables (x x' : nat -> R -> R) (P P' : nat -> nat -> R -> R) (e e' s V V' : R -> R).
Variables (mu b sigma : R).
Variable D : R -> slopes.
Hypothesis mu_pos : 0 < mu.
Hypothesis b_pos : 0 < b.

Let xt (t : R) (i : nat) := x i t.
Let Pt (t : R) (i j : nat) := P i j t.
Let Pt' (t : R) (i j : nat) := P' i j t.

(** y = q + (1-b) sigma e + b mu s, where q = r x + d e. *)
Definition y_m (t : R) : R := dot (rv (D t)) (xt t) + dv (D t) * e t + (1 - b) * sigma * e t + b * mu * s t.

(** The differences to the periodic solution at the time t: x' = Jx + ge by (13.7a), and the loop. *)
Record differences_at (t : R) : Prop := {
  P_symmetric : forall i j, P i j t = P j i t;
  P_derive : forall i j, is_derive (P i j) t (P' i j t);
  x_derive : forall i, is_derive (x i) t (apply (J (D t)) (xt t) i + gv (D t) i * e t);
  e_derive : is_derive e t (y_m t - sigma * e t);
  V_derive : is_derive V t (- 2 * s t * y_m t)
}.

Definition U_m (t : R) : R := w_x * bilinear (Pt t) (xt t) (xt t) + e t ^ 2 + b * mu * (kp / 2) * V t.

Lemma bilinear_sym A (u v : nat -> R) : (forall i j, A i j = A j i) -> bilinear A u v = bilinear A v u.
Proof.
  intros HA. unfold bilinear. rewrite sum_swap. apply sum_ext. intros i _. apply sum_ext. intros j _. rewrite (HA j i). ring.
Qed.

Lemma bilinear_plus A (u v z : nat -> R) a :
  bilinear A u (fun i => v i + z i * a) = bilinear A u v + bilinear A u z * a.
Proof.
  unfold bilinear. rewrite sum_scal_r, <- sum_plus. apply sum_ext. intros i _.
  rewrite sum_scal_r, <- sum_plus. apply sum_ext. intros j _. ring.
Qed.

(** F in terms of the differences x' and u = r x + d e, with the margin for J: what [PlantBounds.v] takes for granted of a plant. *)
Theorem F_of_differences A Ad G de tau b' u v y :
  F A Ad (shifted de G) tau b' u v y
  = - w_x * (bilinear Ad u u + 2 * bilinear A u (fun i => apply (J G) u i + gv G i * v) + 2 * de * bilinear A u u)
    - kp * (dot (rv G) u + dv G * v + (1 - b') * tau * v) * y + 2 * tau * v ^ 2 - 2 * v * y + kp * y ^ 2.
Proof.
  rewrite bilinear_plus. unfold F. rewrite bilinear_shifted. simpl gv; simpl rv; simpl dv.
  change (fun i => apply (J G) u i) with (apply (J G) u). ring.
Qed.

Theorem U_m_derive t : differences_at t ->
  is_derive U_m t (- F (Pt t) (Pt' t) (D t) sigma b (xt t) (e t) (y_m t)).
Proof.
  intros [HS HP Hx He HV]. set (xd := fun i => apply (J (D t)) (xt t) i + gv (D t) i * e t).
  assert (Q : is_derive (fun t => bilinear (Pt t) (xt t) (xt t)) t
                (bilinear (Pt' t) (xt t) (xt t) + 2 * bilinear (Pt t) (xt t) xd)).
  { replace (bilinear (Pt' t) (xt t) (xt t) + 2 * bilinear (Pt t) (xt t) xd)
      with (bilinear (Pt' t) (xt t) (xt t) + (bilinear (Pt t) xd (xt t) + bilinear (Pt t) (xt t) xd))
      by (rewrite (bilinear_sym (Pt t) xd (xt t)) by (intros; apply HS); ring).
    unfold bilinear. rewrite <- !sum_plus.
    apply (sum_derive d_x (fun i t => sum d_x (fun j => xt t i * Pt t i j * xt t j))
      (fun i t => sum d_x (fun j => xt t i * Pt' t i j * xt t j)
        + (sum d_x (fun j => xd i * Pt t i j * xt t j) + sum d_x (fun j => xt t i * Pt t i j * xd j)))).
    intros i _. rewrite <- !sum_plus.
    apply (sum_derive d_x (fun j t => xt t i * Pt t i j * xt t j)
      (fun j t => xt t i * Pt' t i j * xt t j + (xd i * Pt t i j * xt t j + xt t i * Pt t i j * xd j))).
    intros j _. unfold xt, Pt, Pt'. evar_last.
    - apply (is_derive_mult (fun t => x i t * P i j t) (x j)).
      + apply (is_derive_mult (x i) (P i j)); [apply Hx | apply HP | intros; apply Rmult_comm].
      + apply Hx.
      + intros; apply Rmult_comm.
    - unfold plus, mult, xd, xt; simpl. ring. }
  unfold U_m. evar_last.
  - apply @is_derive_plus; [apply @is_derive_plus|].
    + apply is_derive_scal, Q.
    + apply (is_derive_pow e 2 t _ He).
    + apply is_derive_scal, HV.
  - unfold xd. rewrite bilinear_plus. unfold plus; simpl pred; simpl (INR 2).
    assert (Es : s t = (y_m t - (dot (rv (D t)) (xt t) + dv (D t) * e t + (1 - b) * sigma * e t)) / (b * mu)).
    { unfold y_m. field. lra. }
    rewrite Es. unfold F. simpl. change (fun i => apply (J (D t)) (xt t) i) with (apply (J (D t)) (xt t)). field. lra.
Qed.

(** ** Joint metrics *)

(** F and, of (13.7e), G as quadratic forms in (x, e, y). *)
Definition F_joint (A : nat -> nat -> R) (p : nat -> R) (w k : R) (G : slopes) (s : R) (u : nat -> R) (v y : R) : R :=
  - 2 * bilinear A u (apply (J G) u) - 2 * (bilinear A u (gv G) - s * dot p u) * v - 2 * dot p (apply (J G) u) * v
  - (2 * dot p u + k * dot (rv G) u) * y + (2 * s * w - 2 * dot p (gv G)) * v ^ 2 - (2 * w + k * dv G) * v * y + k * y ^ 2.
Definition G_joint (A : nat -> nat -> R) (w k : R) (p : nat -> R) (w_1 tau : R) (G : slopes) (u : nat -> R) (v y : R) : R :=
  - 2 * bilinear A u (apply (J G) u) - 2 * (bilinear A u (gv G) - tau * dot p u) * v - k * dot (rv G) u * y
  + 2 * tau * (w_1 + w) * v ^ 2 - (2 * w + k * dv G) * v * y + k * y ^ 2.

Lemma dot_plus a u v z : dot a (fun i => u i + v i * z) = dot a u + dot a v * z.
Proof. unfold dot. rewrite sum_scal_r, <- sum_plus. apply sum_ext. intros; ring. Qed.

Lemma bilinear_between l A B u z : bilinear (fun i j => l * A i j + (1 - l) * B i j) u z = l * bilinear A u z + (1 - l) * bilinear B u z.
Proof.
  unfold bilinear. rewrite <- !sum_scal, <- sum_plus. apply sum_ext. intros i _.
  rewrite <- !sum_scal, <- sum_plus. apply sum_ext. intros j _. ring.
Qed.

(** Proposition 13.7.6. *)
Theorem F_joint_between l tau A B p w_1 w_2 k_1 k_2 G u v y : l <> 0 ->
  F_joint (fun i j => l * A i j + (1 - l) * B i j) (fun i => l * p i) (l * w_1 + (1 - l) * w_2) (l * k_1 + (1 - l) * k_2) G (tau / l) u v y
  = l * F_joint A p w_1 k_1 G tau u v y + (1 - l) * G_joint B w_2 k_2 p w_1 tau G u v y + 2 * tau * w_2 * (1 - l) ^ 2 / l * v ^ 2.
Proof.
  intros Hl. unfold F_joint, G_joint. rewrite !bilinear_between.
  assert (E : forall z, dot (fun i => l * p i) z = l * dot p z).
  { intros z. unfold dot. rewrite <- sum_scal. apply sum_ext. intros; ring. }
  rewrite !E. field. exact Hl.
Qed.

(** Both in terms of the differences x' and r x + d e: [near_form] and [far_form] of [PlantBounds.v]. *)
Theorem joint_of_differences A B p w_1 w_2 k_1 k_2 G tau u v y :
  let a := fun i => apply (J G) u i + gv G i * v in
  F_joint A p w_1 k_1 G tau u v y
  = - (2 * bilinear A u a + 2 * (y - tau * v) * dot p u + 2 * v * dot p a + 2 * w_1 * v * (y - tau * v))
    + k_1 * y * (y - (dot (rv G) u + dv G * v)) /\
  G_joint B w_2 k_2 p w_1 tau G u v y
  = - (2 * bilinear B u a) + 2 * tau * v * dot p u + 2 * tau * (w_1 + w_2) * v ^ 2 - 2 * w_2 * v * y
    + k_2 * y * (y - (dot (rv G) u + dv G * v)).
Proof.
  intros a. unfold a, F_joint, G_joint. rewrite !bilinear_plus, dot_plus. change (fun i => apply (J G) u i) with (apply (J G) u).
  split; ring.
Qed.

End MatrixInequality.
