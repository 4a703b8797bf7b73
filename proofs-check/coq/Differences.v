(** Section 5: what two solutions of the loop have to do with each other, and the size of zeta. *)

From Coq Require Import Reals Lra Lia.
From Coquelicot Require Import Coquelicot.
From SigmaStar Require Import Sums Loop.
Local Open Scope R_scope.

(** ** The squared norm |.|_N *)

Section Size.
Variable n : nat -> R.
Hypothesis n_pos : forall l, 0 < n l.

(** zeta'N zeta for zeta = (v0, va 1, vb 1, ..., va N, vb N). *)
Definition square (N : nat) (v0 : R) (va vb : nat -> R) : R :=
  n O * v0 ^ 2 + sum1 N (fun l => n l * (va l ^ 2 + vb l ^ 2)).

Lemma square_nonneg N v0 va vb : 0 <= square N v0 va vb.
Proof.
  unfold square, sum1. apply Rplus_le_le_0_compat.
  - apply Rmult_le_pos; [left; apply n_pos | apply pow2_ge_0].
  - apply sum_nonneg. intros i _. apply Rmult_le_pos; [left; apply n_pos|].
    apply Rplus_le_le_0_compat; apply pow2_ge_0.
Qed.

(** For th > 0: (a + b)^2 <= (1 + th) a^2 + (1 + 1/th) b^2. *)
Lemma square_split th N a0 aa ab b0 ba bb : 0 < th ->
  square N (a0 + b0) (fun l => aa l + ba l) (fun l => ab l + bb l)
  <= (1 + th) * square N a0 aa ab + (1 + / th) * square N b0 ba bb.
Proof.
  intros Hth. assert (Hi : 0 < / th) by (apply Rinv_0_lt_compat, Hth).
  assert (P : forall a b, (a + b) ^ 2 <= (1 + th) * a ^ 2 + (1 + / th) * b ^ 2).
  { intros a b. assert (E : (1 + th) * a ^ 2 + (1 + / th) * b ^ 2 - (a + b) ^ 2 = / th * (th * a - b) ^ 2) by (field; lra).
    assert (0 <= / th * (th * a - b) ^ 2) by (apply Rmult_le_pos; [lra | apply pow2_ge_0]). lra. }
  unfold square, sum1.
  replace ((1 + th) * (n 0%nat * a0 ^ 2 + sum N (fun i => n (S i) * (aa (S i) ^ 2 + ab (S i) ^ 2))) +
           (1 + / th) * (n 0%nat * b0 ^ 2 + sum N (fun i => n (S i) * (ba (S i) ^ 2 + bb (S i) ^ 2))))
    with (n 0%nat * ((1 + th) * a0 ^ 2 + (1 + / th) * b0 ^ 2)
          + ((1 + th) * sum N (fun i => n (S i) * (aa (S i) ^ 2 + ab (S i) ^ 2))
             + (1 + / th) * sum N (fun i => n (S i) * (ba (S i) ^ 2 + bb (S i) ^ 2)))) by ring.
  rewrite <- !sum_scal, <- sum_plus. apply Rplus_le_compat.
  - apply Rmult_le_compat_l; [left; apply n_pos | apply P].
  - apply sum_le. intros i _.
    pose proof (P (aa (S i)) (ba (S i))). pose proof (P (ab (S i)) (bb (S i))).
    replace ((1 + th) * (n (S i) * (aa (S i) ^ 2 + ab (S i) ^ 2)) + (1 + / th) * (n (S i) * (ba (S i) ^ 2 + bb (S i) ^ 2)))
      with (n (S i) * (((1 + th) * aa (S i) ^ 2 + (1 + / th) * ba (S i) ^ 2)
                       + ((1 + th) * ab (S i) ^ 2 + (1 + / th) * bb (S i) ^ 2))) by ring.
    apply Rmult_le_compat_l; [left; apply n_pos | lra].
Qed.

(** The triangle inequality of |.|_N, in squares. *)
Lemma square_triangle A B N a0 aa ab b0 ba bb : 0 <= A -> 0 <= B ->
  square N a0 aa ab <= A ^ 2 -> square N b0 ba bb <= B ^ 2 ->
  square N (a0 + b0) (fun l => aa l + ba l) (fun l => ab l + bb l) <= (A + B) ^ 2.
Proof.
  intros HA HB Ha Hb. apply Rnot_lt_le. intros C.
  set (q := square N (a0 + b0) (fun l => aa l + ba l) (fun l => ab l + bb l)) in *.
  (* With A + eps and B + eps the bound holds for every eps > 0. *)
  assert (Q : forall eps, 0 < eps -> q <= (A + B + 2 * eps) ^ 2).
  { intros eps He. pose proof (square_split ((B + eps) / (A + eps)) N a0 aa ab b0 ba bb
      ltac:(apply Rdiv_lt_0_compat; lra)) as S. fold q in S.
    assert (I1 : 0 < (B + eps) / (A + eps)) by (apply Rdiv_lt_0_compat; lra).
    assert (I2 : 0 < (A + eps) / (B + eps)) by (apply Rdiv_lt_0_compat; lra).
    assert (E2 : / ((B + eps) / (A + eps)) = (A + eps) / (B + eps)) by (field; lra). rewrite E2 in S.
    assert (A ^ 2 <= (A + eps) ^ 2) by (apply pow_incr; lra). assert (B ^ 2 <= (B + eps) ^ 2) by (apply pow_incr; lra).
    assert (S1 : (1 + (B + eps) / (A + eps)) * square N a0 aa ab <= (1 + (B + eps) / (A + eps)) * (A + eps) ^ 2)
      by (apply Rmult_le_compat_l; lra).
    assert (S2 : (1 + (A + eps) / (B + eps)) * square N b0 ba bb <= (1 + (A + eps) / (B + eps)) * (B + eps) ^ 2)
      by (apply Rmult_le_compat_l; lra).
    replace ((A + B + 2 * eps) ^ 2)
      with ((1 + (B + eps) / (A + eps)) * (A + eps) ^ 2 + (1 + (A + eps) / (B + eps)) * (B + eps) ^ 2)
      by (field; lra). lra. }
  set (g := q - (A + B) ^ 2) in *. assert (Hg : 0 < g) by (unfold g; lra).
  set (K := 4 * (A + B) + 4). assert (HK : 0 < K) by (unfold K; lra).
  set (eps := Rmin 1 (g / (2 * K))).
  assert (He : 0 < eps) by (apply Rmin_glb_lt; [lra | apply Rdiv_lt_0_compat; lra]).
  assert (He1 : eps <= 1) by apply Rmin_l. assert (He2 : eps * (2 * K) <= g).
  { apply Rle_trans with (g / (2 * K) * (2 * K)); [apply Rmult_le_compat_r; [lra | apply Rmin_r] | right; field; lra]. }
  specialize (Q eps He).
  assert ((A + B + 2 * eps) ^ 2 <= (A + B) ^ 2 + eps * K).
  { unfold K. assert (0 <= 4 * eps * (1 - eps)) by (apply Rmult_le_pos; lra). lra. }
  unfold g in He2. lra.
Qed.

Lemma square_opp N a0 aa ab :
  square N (- a0) (fun l => - aa l) (fun l => - ab l) = square N a0 aa ab.
Proof. unfold square, sum1. f_equal; [ring|]. apply sum_ext. intros i _. ring. Qed.

(** |M e|_N^2 = (n_0 + ... + n_N) e^2. *)
Lemma square_M N e : square N e (fun _ => e) (fun _ => 0) = (n O + sum1 N n) * e ^ 2.
Proof.
  unfold square, sum1. rewrite (sum_ext N _ (fun i => e ^ 2 * n (S i))) by (intros; ring).
  rewrite sum_scal. ring.
Qed.

(** Cauchy-Schwarz: s^2 <= |M|_N^2 |zeta|_N^2. *)
Lemma s_square N v0 va vb :
  (n O * v0 + sum1 N (fun l => n l * va l)) ^ 2 <= (n O + sum1 N n) * square N v0 va vb.
Proof.
  set (W := n O + sum1 N n). set (s := n O * v0 + sum1 N (fun l => n l * va l)).
  assert (HW : 0 < W).
  { unfold W, sum1. pose proof (n_pos O). assert (0 <= sum N (fun i => n (S i))) by (apply sum_nonneg; intros; left; apply n_pos). lra. }
  pose proof (square_nonneg N (v0 - s / W) (fun l => va l - s / W) vb) as Q.
  assert (E : square N (v0 - s / W) (fun l => va l - s / W) vb = square N v0 va vb - 2 * (s / W) * s + (s / W) ^ 2 * W).
  { unfold square, sum1.
    rewrite (sum_ext N (fun i => n (S i) * ((va (S i) - s / W) ^ 2 + vb (S i) ^ 2))
      (fun i => (n (S i) * (va (S i) ^ 2 + vb (S i) ^ 2) - 2 * (s / W) * (n (S i) * va (S i))) + (s / W) ^ 2 * n (S i))) by (intros; ring).
    rewrite sum_plus, sum_minus, !sum_scal.
    assert (Es : sum N (fun i => n (S i) * va (S i)) = s - n O * v0) by (unfold s, sum1; ring).
    assert (Ew : sum N (fun i => n (S i)) = W - n O) by (unfold W, sum1; ring).
    rewrite Es, Ew. ring. }
  rewrite E in Q. replace (square N v0 va vb - 2 * (s / W) * s + (s / W) ^ 2 * W) with ((W * square N v0 va vb - s ^ 2) / W) in Q by (field; lra).
  assert (0 <= W * square N v0 va vb - s ^ 2); [|lra].
  replace (W * square N v0 va vb - s ^ 2) with ((W * square N v0 va vb - s ^ 2) / W * W) by (field; lra).
  apply Rmult_le_pos; lra.
Qed.

End Size.

(** ** The difference of two solutions *)

Section Difference.
Variables (n : nat -> R) (N : nat) (w sigma mu b : R).
Variables (e1 q1 z1 e2 q2 z2 : R -> R) (za1 zb1 za2 zb2 : nat -> R -> R).

Let e t := e1 t - e2 t.
Let q t := q1 t - q2 t.
Let z0 t := z1 t - z2 t.
Let za l t := za1 l t - za2 l t.
Let zb l t := zb1 l t - zb2 l t.

Lemma s_difference t : s_ n N e z0 za t = s_ n N e1 z1 za1 t - s_ n N e2 z2 za2 t.
Proof.
  unfold s_, zeta0, zetaa, sum1.
  rewrite (sum_ext N _ (fun i => n (S i) * (za1 (S i) t - e1 t) - n (S i) * (za2 (S i) t - e2 t)))
    by (intros; unfold za, e; ring).
  rewrite sum_minus. unfold z0, e. ring.
Qed.

(** The loop is linear: the difference solves it for the difference of q. *)
Lemma equations_difference t :
  equations_at n N w sigma mu b e1 q1 z1 za1 zb1 t -> equations_at n N w sigma mu b e2 q2 z2 za2 zb2 t ->
  equations_at n N w sigma mu b e q z0 za zb t.
Proof.
  intros [A1 A2 A3 A4] [B1 B2 B3 B4]. split.
  - unfold e. evar_last; [apply @is_derive_minus; [exact A1 | exact B1]|].
    unfold u_. rewrite s_difference. unfold q, e, minus, plus, opp; simpl. ring.
  - unfold z0. evar_last; [apply @is_derive_minus; [exact A2 | exact B2]|].
    unfold e, minus, plus, opp; simpl. ring.
  - intros l Hl. unfold za. evar_last; [apply @is_derive_minus; [apply A3, Hl | apply B3, Hl]|].
    unfold zb, e, minus, plus, opp; simpl. ring.
  - intros l Hl. unfold zb. evar_last; [apply @is_derive_minus; [apply A4, Hl | apply B4, Hl]|].
    unfold za, e, minus, plus, opp; simpl. ring.
Qed.

(** V of the difference is the squared norm of zeta - zeta_p. *)
Lemma V_difference t :
  V_ n N e z0 za zb t
  = square n N ((z1 t - e1 t) - (z2 t - e2 t)) (fun l => (za1 l t - e1 t) - (za2 l t - e2 t)) (fun l => zb1 l t - zb2 l t).
Proof.
  unfold V_, square, zeta0, zetaa, zetab, sum1. f_equal; [unfold z0, e; ring|].
  apply sum_ext. intros i _. unfold za, zb, e. ring.
Qed.

End Difference.

(** s is continuous where the loop's equations hold. *)
Lemma s_continuous_at n N w sigma mu b e q z0 za zb t :
  equations_at n N w sigma mu b e q z0 za zb t -> continuous (s_ n N e z0 za) t.
Proof.
  intros H. pose proof (loop_e _ _ _ _ _ _ _ _ _ _ _ t H) as He.
  assert (C : forall (v : R -> R) v', is_derive v t v' -> continuous v t).
  { intros v v' D. apply (ex_derive_continuous (V := R_NormedModule)). exists v'. exact D. }
  pose proof (C _ _ He) as Ce. unfold s_, zeta0, zetaa.
  assert (M : forall a (v : R -> R), continuous v t -> continuous (fun t => a * v t) t).
  { intros a v Hv. apply (continuous_mult (K := R_AbsRing)); [apply continuous_const | exact Hv]. }
  apply (continuous_plus (V := R_NormedModule)).
  - apply (M _ (fun t => z0 t - e t)). apply (continuous_minus (V := R_NormedModule)); [apply (C _ _ (eq_z0 _ _ _ _ _ _ _ _ _ _ _ _ H)) | exact Ce].
  - unfold sum1. apply (sum_continuous N (fun i t => n (S i) * (za (S i) t - e t))). intros i Hi.
    apply (M _ (fun t => za (S i) t - e t)).
    apply (continuous_minus (V := R_NormedModule)); [|exact Ce].
    apply (C _ _ (eq_za _ _ _ _ _ _ _ _ _ _ _ _ H (S i) ltac:(lia))).
Qed.
