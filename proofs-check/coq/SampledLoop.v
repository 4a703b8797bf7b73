(** Sections 12, 13.1 and 13.4: the regulator at samples with N oscillators, and its balance, with an input gain and with a
    delay of one sample. One step from the sample k to the next. *)

From Coq Require Import Reals ZArith Lra Lia.
From SigmaStar Require Import Sums.
Local Open Scope R_scope.

Section SampledLoop.
Variable n : nat -> R.
Variable N : nat.
Hypothesis n_pos : forall l, 0 < n l.

(** A vector of the oscillators: a component 0 and, for 1 <= l <= N, a pair. *)
Record vector := { v0 : R; va : nat -> R; vb : nat -> R }.

(** R = e^(Phi h): rotations by the angles l w h. Only that they are rotations is used. *)
Variables cs sn : nat -> R.
Hypothesis rotation : forall l, cs l ^ 2 + sn l ^ 2 = 1.
Definition rot (z : vector) : vector :=
  {| v0 := v0 z; va := fun l => cs l * va z l + sn l * vb z l; vb := fun l => - sn l * va z l + cs l * vb z l |}.

(** z + a M, M'N z, z'N z; b1 = M'N R M and bM = M'N M. *)
Definition addM (z : vector) (a : R) : vector := {| v0 := v0 z + a; va := fun l => va z l + a; vb := vb z |}.
Definition MN (z : vector) : R := n O * v0 z + sum1 N (fun l => n l * va z l).
Definition norm2 (z : vector) : R := n O * v0 z ^ 2 + sum1 N (fun l => n l * (va z l ^ 2 + vb z l ^ 2)).
Definition bM : R := n O + sum1 N n.
Definition b1 : R := n O + sum1 N (fun l => n l * cs l).

(** Equality of the components that count. *)
Definition same (x y : vector) : Prop :=
  v0 x = v0 y /\ forall l, (1 <= l <= N)%nat -> va x l = va y l /\ vb x l = vb y l.

Lemma norm2_same x y : same x y -> norm2 x = norm2 y.
Proof.
  intros [E0 E]. unfold norm2, sum1. rewrite E0. f_equal. apply sum_ext. intros i Hi.
  destruct (E (S i) ltac:(lia)) as [-> ->]. reflexivity.
Qed.

(** R'NR = N. *)
Lemma norm2_rot z : norm2 (rot z) = norm2 z.
Proof.
  unfold norm2, rot, sum1; simpl v0; simpl va; simpl vb. f_equal. apply sum_ext. intros i _.
  pose proof (rotation (S i)) as E.
  replace (n (S i) * ((cs (S i) * va z (S i) + sn (S i) * vb z (S i)) ^ 2 + (- sn (S i) * va z (S i) + cs (S i) * vb z (S i)) ^ 2))
    with (n (S i) * ((cs (S i) ^ 2 + sn (S i) ^ 2) * (va z (S i) ^ 2 + vb z (S i) ^ 2))) by ring.
  rewrite E. ring.
Qed.

Lemma norm2_addM z a : norm2 (addM z a) = norm2 z + 2 * a * MN z + a ^ 2 * bM.
Proof.
  unfold norm2, addM, MN, bM, sum1; simpl v0; simpl va; simpl vb.
  rewrite (sum_ext N (fun i => n (S i) * ((va z (S i) + a) ^ 2 + vb z (S i) ^ 2))
             (fun i => n (S i) * (va z (S i) ^ 2 + vb z (S i) ^ 2) + (2 * a * (n (S i) * va z (S i)) + a ^ 2 * n (S i))))
    by (intros; ring).
  rewrite !sum_plus, !sum_scal. ring.
Qed.

Lemma MN_addM z a : MN (rot (addM z a)) = MN (rot z) + a * b1.
Proof.
  unfold MN, rot, addM, b1, sum1; simpl v0; simpl va; simpl vb.
  rewrite (sum_ext N (fun i => n (S i) * (cs (S i) * (va z (S i) + a) + sn (S i) * vb z (S i)))
             (fun i => n (S i) * (cs (S i) * va z (S i) + sn (S i) * vb z (S i)) + a * (n (S i) * cs (S i))))
    by (intros; ring).
  rewrite sum_plus, sum_scal. ring.
Qed.

(** |b1| <= M'N M. *)
Theorem b1_bound : Rabs b1 <= bM.
Proof.
  unfold b1, bM. apply Rle_trans with (1 := Rabs_triang _ _).
  rewrite (Rabs_right (n O)) by (pose proof (n_pos O); lra). apply Rplus_le_compat_l. unfold sum1.
  assert (B : forall k, Rabs (sum k (fun i => n (S i) * cs (S i))) <= sum k (fun i => n (S i))).
  { induction k as [|k IH]; simpl sum; [rewrite Rabs_R0; lra|].
    apply Rle_trans with (1 := Rabs_triang _ _). apply Rplus_le_compat; [exact IH|].
    rewrite Rabs_mult, (Rabs_right (n (S k))) by (pose proof (n_pos (S k)); lra).
    rewrite <- (Rmult_1_r (n (S k))) at 2. apply Rmult_le_compat_l; [pose proof (n_pos (S k)); lra|].
    pose proof (rotation (S k)) as E. pose proof (pow2_ge_0 (sn (S k))).
    rewrite <- sqrt_Rsqr_abs, <- sqrt_1. apply sqrt_le_1_alt. unfold Rsqr. lra. }
  apply B.
Qed.

Variables h sigma K b : R.
Hypothesis K_pos : 0 < K.
Hypothesis b_pos : 0 < b.

(** ** The law of section 12, with an input gain b (13.1) *)

(** (12.1), and e_(k+1) = e_k + h (qb + b u_k): the mean of e' over the sample. *)
Definition zeta (z : vector) (e : R) : vector := addM z (- e).
Definition v_k (z : vector) (e : R) : R := MN (rot (zeta z e)).
Definition u_k (z : vector) (e : R) : R := - sigma * e + K * v_k z e.
Definition z_next (z : vector) (e : R) : vector := addM (rot (zeta z e)) ((1 - h * sigma) * e).
Definition e_next (z : vector) (e qb : R) : R := e + h * (qb + b * u_k z e).
Definition y_k (z : vector) (e qb : R) : R := qb + (1 - b) * sigma * e + b * K * v_k z e.

Theorem step_e z e qb : e_next z e qb = (1 - h * sigma) * e + h * y_k z e qb.
Proof. unfold e_next, y_k, u_k. ring. Qed.

Theorem step_zeta z e qb :
  same (zeta (z_next z e) (e_next z e qb)) (addM (rot (zeta z e)) (- (h * y_k z e qb))).
Proof.
  rewrite step_e. split; [|intros l Hl; split]; unfold zeta, z_next, addM, rot; simpl; ring.
Qed.

(** (12.2), with b K for K and qb + (1-b) sigma e for qb where there is a gain. *)
Theorem balance z e qb :
  let y := y_k z e qb in
  norm2 (zeta (z_next z e) (e_next z e qb))
  = norm2 (zeta z e) - 2 * h / (b * K) * ((1 - b * K * h * bM / 2) * y ^ 2 - y * (qb + (1 - b) * sigma * e)).
Proof.
  intros y. rewrite (norm2_same _ _ (step_zeta z e qb)), norm2_addM, norm2_rot. fold y. fold (v_k z e).
  assert (E : v_k z e = (y - (qb + (1 - b) * sigma * e)) / (b * K)) by (unfold y, y_k; field; lra).
  rewrite E. field. lra.
Qed.

(** 1 - K h M'NM/2 >= 1/(1 + theta), whatever N. *)
Theorem balance_margin Nb2 : 0 < h -> bM <= Nb2 -> b * K * h * Nb2 < 2 ->
  1 - b * K * h * Nb2 / 2 <= 1 - b * K * h * bM / 2 /\ 0 < 1 - b * K * h * Nb2 / 2.
Proof.
  intros Hh HN HS. assert (0 < b * K * h) by (repeat apply Rmult_lt_0_compat; assumption).
  assert (b * K * h * bM <= b * K * h * Nb2) by (apply Rmult_le_compat_l; lra). lra.
Qed.

(** Without input and with b = 1 the norm falls by h K (2 - h K bM) v_k^2. *)
Theorem free_fall z e : b = 1 ->
  norm2 (zeta (z_next z e) (e_next z e 0)) = norm2 (zeta z e) - h * K * (2 - h * K * bM) * v_k z e ^ 2.
Proof.
  intros Hb. rewrite balance. unfold y_k. rewrite Hb. field. lra.
Qed.

(** ** The law of 13.4: the computation takes one sample *)

(** The state: e, the prediction et of e, z, and the control u that was computed before. vt = (u + sigma et)/K. *)
Definition vt (et u : R) : R := (u + sigma * et) / K.
Definition yd (et u qb : R) : R := qb + (1 - b) * sigma * et + b * K * vt et u.
Definition e_next_d (e u qb : R) : R := e + h * (qb + b * u).
Definition et_next (e et : R) : R := e - h * sigma * et.
Definition z_next_d (z : vector) (e et : R) : vector := addM (rot (zeta z e)) (et_next e et).
Definition u_next (z : vector) (e et : R) : R :=
  - sigma * et_next e et + K * MN (rot (addM (z_next_d z e et) (- et_next e et))).

(** What 13.4 says of the law: it needs e_k only. *)
Theorem u_next_early z e et : u_next z e et = - sigma * et_next e et + K * MN (rot (rot (zeta z e))).
Proof.
  unfold u_next. do 2 f_equal. unfold MN, sum1. f_equal.
  - unfold rot, z_next_d, addM; simpl. ring.
  - apply sum_ext. intros i _. unfold rot, z_next_d, addM; simpl. ring.
Qed.

Theorem step_e_delay e et u qb : e_next_d e u qb = et_next e et + h * yd et u qb.
Proof. unfold e_next_d, et_next, yd, vt. field. lra. Qed.

(** With y_- the y of the sample before, so that e = et + h y_-. *)
Theorem step_e_delay2 e et u qb y_ : e = et + h * y_ ->
  e_next_d e u qb = (1 - h * sigma) * e + h * (yd et u qb + h * sigma * y_).
Proof. intros E. rewrite (step_e_delay e et). unfold et_next. rewrite E. ring. Qed.

Theorem step_zeta_delay z e et u qb :
  same (zeta (z_next_d z e et) (e_next_d e u qb)) (addM (rot (zeta z e)) (- (h * yd et u qb))).
Proof.
  rewrite (step_e_delay e et). split; [|intros l Hl; split]; unfold zeta, z_next_d, addM, rot; simpl; ring.
Qed.

(** M'NR zeta = vt - h b1 y_-, where u was computed by the law. *)
Theorem delayed_output z e et u y_ :
  e = et + h * y_ -> u = - sigma * et + K * MN (rot (addM z (- et))) ->
  MN (rot (zeta z e)) = vt et u - h * b1 * y_.
Proof.
  intros E Eu. unfold vt, zeta. rewrite Eu, E, !MN_addM. field. lra.
Qed.

(** The balance of 13.4, for a u that the law computed at the sample before. At a first step u is not such a one. *)
Theorem balance_delay z e et u qb y_ :
  e = et + h * y_ -> u = - sigma * et + K * MN (rot (addM z (- et))) ->
  let y := yd et u qb in
  norm2 (zeta (z_next_d z e et) (e_next_d e u qb))
  = norm2 (zeta z e) - 2 * h / (b * K) * ((1 - b * K * h * bM / 2) * y ^ 2 - b * K * h * b1 * y * y_
                                          - y * (qb + (1 - b) * sigma * et)).
Proof.
  intros E Eu y. rewrite (norm2_same _ _ (step_zeta_delay z e et u qb)), norm2_addM, norm2_rot. fold y.
  rewrite (delayed_output z e et u y_ E Eu).
  assert (Ev : vt et u = (y - (qb + (1 - b) * sigma * et)) / (b * K)) by (unfold y, yd; field; lra).
  rewrite Ev. field. lra.
Qed.

End SampledLoop.
