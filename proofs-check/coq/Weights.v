(** Section 1: the weights n_l of the oscillators. *)

From Coq Require Import Reals ZArith Lra Lia.
From Coquelicot Require Import Coquelicot.
From SigmaStar Require Import Sums.
Local Open Scope R_scope.

(** W1 to W4. The partial sums of W1 increase, so that they are bounded says that the series converges. *)
Record weights (n : nat -> R) : Prop := {
  n_pos : forall l, 0 < n l;
  W1 : exists Nbar2, forall N, n O + sum1 N n <= Nbar2;
  W2 : forall l, (1 <= l)%nat -> INR (S l) * n (S l) <= INR l * n l;
  W3 : forall l, (1 <= l)%nat -> INR l ^ 2 * n l <= INR (S l) ^ 2 * n (S l);
  W4 : n 1%nat < n O
}.

Section Consequences.
Variable n : nat -> R.
Hypothesis H : weights n.

Lemma W2_le l m : (1 <= l <= m)%nat -> INR m * n m <= INR l * n l.
Proof.
  intros [Hl Hm]. induction Hm as [|m Hm IH]; [lra|].
  apply Rle_trans with (2 := IH). apply (W2 n H). lia.
Qed.

Lemma W3_le l m : (1 <= l <= m)%nat -> INR l ^ 2 * n l <= INR m ^ 2 * n m.
Proof.
  intros [Hl Hm]. induction Hm as [|m Hm IH]; [lra|].
  apply Rle_trans with (1 := IH). apply (W3 n H). lia.
Qed.

(** n_1/l^2 <= n_l <= n_1/l. *)
Lemma n_upper l : (1 <= l)%nat -> n l <= n 1%nat / INR l.
Proof.
  intros Hl. assert (0 < INR l) by (apply lt_0_INR; lia).
  apply Rle_div_r; [lra|]. pose proof (W2_le 1 l) as W. simpl in W.
  specialize (W (conj (le_n 1) Hl)). lra.
Qed.

Lemma n_lower l : (1 <= l)%nat -> n 1%nat / INR l ^ 2 <= n l.
Proof.
  intros Hl. assert (0 < INR l) by (apply lt_0_INR; lia).
  apply Rle_div_l; [apply pow_lt; lra|].
  pose proof (W3_le 1 l (conj (le_n 1) Hl)) as W. simpl INR in W. lra.
Qed.

Lemma n_le_n1 l : (1 <= l)%nat -> n l <= n 1%nat.
Proof.
  intros Hl. apply Rle_trans with (1 := n_upper l Hl).
  assert (1 <= INR l) by (apply (le_INR 1 l); lia).
  pose proof (n_pos n H 1). apply Rle_div_l; nra.
Qed.

(** The remaining strict inequalities follow from W2. *)
Lemma n_decreases l : n (S l) < n l.
Proof.
  destruct l as [|l]; [apply (W4 n H)|].
  pose proof (W2 n H (S l) ltac:(lia)) as W. rewrite (S_INR (S l)) in W.
  assert (0 < INR (S l)) by (apply lt_0_INR; lia).
  pose proof (n_pos n H (S (S l))). nra.
Qed.

End Consequences.

(** The paper's family, generalised in its first member: n_l = l^-(1+eps). *)
Definition power (n_0 eps : R) (l : nat) : R :=
  match l with O => n_0 | _ => Rpower (INR l) (- (1 + eps)) end.

Lemma power_S n_0 eps l : power n_0 eps (S l) = Rpower (INR (S l)) (- (1 + eps)).
Proof. reflexivity. Qed.

Lemma INR_S_pos l : 0 < INR (S l).
Proof. apply lt_0_INR; lia. Qed.

(** l n_l = l^-eps and l^2 n_l = l^(1-eps). *)
Lemma power_l n_0 eps l : (1 <= l)%nat -> INR l * power n_0 eps l = Rpower (INR l) (- eps).
Proof.
  intros Hl. destruct l as [|l]; [lia|]. rewrite power_S.
  rewrite <- (Rpower_1 (INR (S l))) at 1 by apply INR_S_pos.
  rewrite <- Rpower_plus. f_equal. ring.
Qed.

Lemma power_l2 n_0 eps l : (1 <= l)%nat -> INR l ^ 2 * power n_0 eps l = Rpower (INR l) (1 - eps).
Proof.
  intros Hl. replace (INR l ^ 2 * power n_0 eps l) with (INR l * (INR l * power n_0 eps l)) by ring.
  rewrite power_l by assumption.
  rewrite <- (Rpower_1 (INR l)) at 1 by (apply lt_0_INR; lia).
  rewrite <- Rpower_plus. reflexivity.
Qed.

Lemma Rpower_mono a b x : 0 < a <= b -> 0 <= x -> Rpower a x <= Rpower b x.
Proof.
  intros [Ha Hb] Hx. apply Rle_Rpower_l; [exact Hx | lra].
Qed.

Lemma Rpower_anti a b x : 0 < a <= b -> 0 <= x -> Rpower b (- x) <= Rpower a (- x).
Proof.
  intros Hab Hx. rewrite !Rpower_Ropp. apply Rinv_le_contravar.
  - apply exp_pos.
  - apply Rpower_mono; assumption.
Qed.

Lemma exp_ge x : 1 + x <= exp x.
Proof. destruct (Req_dec x 0) as [->|Hx]; [rewrite exp_0; lra | left; apply exp_ineq1; exact Hx]. Qed.

Lemma ln_le x : 0 < x -> ln x <= x - 1.
Proof. intros Hx. pose proof (exp_ge (ln x)) as H. rewrite exp_ln in H by exact Hx. lra. Qed.

(** What W1 needs: the terms are below the differences of -l^-eps/eps. *)
Lemma power_telescope eps l :
  0 < eps ->
  Rpower (INR (S (S l))) (- (1 + eps))
  <= - Rpower (INR (S (S l))) (- eps) / eps + Rpower (INR (S l)) (- eps) / eps.
Proof.
  intros He. set (a := INR (S l)). set (b := INR (S (S l))).
  assert (Ha : 0 < a) by apply INR_S_pos.
  assert (Hb : b = a + 1) by (unfold a, b; rewrite (S_INR (S l)); ring).
  assert (E : Rpower b (- (1 + eps)) = Rpower b (- eps) * / b).
  { replace (- (1 + eps)) with (- eps + - 1) by ring.
    rewrite Rpower_plus. f_equal. unfold Rpower. replace (- 1 * ln b) with (- ln b) by ring.
    rewrite exp_Ropp, exp_ln by lra. reflexivity. }
  assert (F : Rpower b (- eps) * (1 + eps * / b) <= Rpower a (- eps)).
  { assert (L : / b <= ln b - ln a).
    { assert (L : ln (a * / b) <= a * / b - 1)
        by (apply ln_le; apply Rmult_lt_0_compat; [lra | apply Rinv_0_lt_compat; lra]).
      assert (0 < / b) by (apply Rinv_0_lt_compat; lra).
      rewrite ln_mult, ln_Rinv in L by lra.
      replace (a * / b) with (1 - / b) in L by (rewrite Hb; field; lra). lra. }
    replace (Rpower a (- eps)) with (Rpower b (- eps) * exp (eps * (ln b - ln a))).
    - apply Rmult_le_compat_l; [left; apply exp_pos|].
      apply Rle_trans with (2 := exp_ge _). assert (eps * / b <= eps * (ln b - ln a)) by nra. lra.
    - unfold Rpower. rewrite <- exp_plus. f_equal. ring. }
  rewrite E.
  replace (- Rpower b (- eps) / eps + Rpower a (- eps) / eps)
    with ((Rpower a (- eps) - Rpower b (- eps)) / eps) by (field; lra).
  apply le_div; [exact He|]. lra.
Qed.

(** Section 1: the power family has W1 to W4. *)
Theorem power_weights n_0 eps : 1 < n_0 -> 0 < eps <= 1 -> weights (power n_0 eps).
Proof.
  intros Hn He. split.
  - intros [|l]; [simpl; lra | apply exp_pos].
  - exists (n_0 + 1 + 1 / eps). intros [|N].
    { unfold sum1. simpl. assert (0 < 1 / eps) by (apply Rdiv_lt_0_compat; lra). lra. }
    unfold sum1. rewrite sum_first.
    pose proof (sum_telescope N (fun i => power n_0 eps (S (S i)))
                  (fun i => - Rpower (INR (S i)) (- eps) / eps)) as F.
    specialize (F ltac:(intros i _; pose proof (power_telescope eps i ltac:(lra)) as P;
                        cbv beta; change (power n_0 eps (S (S i))) with (Rpower (INR (S (S i))) (- (1 + eps)));
                        unfold Rdiv in *; lra)).
    assert (0 < Rpower (INR (S N)) (- eps) / eps)
      by (apply Rdiv_lt_0_compat; [apply exp_pos | lra]).
    assert (E1 : Rpower 1 (- eps) = 1) by (unfold Rpower; rewrite ln_1, Rmult_0_r, exp_0; reflexivity).
    assert (E2 : power n_0 eps 1 = 1) by (simpl; unfold Rpower; rewrite ln_1, Rmult_0_r, exp_0; reflexivity).
    cbv beta in F. change (INR 1) with 1 in F. rewrite E1 in F. rewrite E2. simpl (power n_0 eps 0).
    unfold Rdiv in *. lra.
  - intros l Hl. rewrite !power_l by lia. apply Rpower_anti; [|lra].
    split; [apply lt_0_INR; lia | apply le_INR; lia].
  - intros l Hl. rewrite !power_l2 by lia. apply Rpower_mono; [|lra].
    split; [apply lt_0_INR; lia | apply le_INR; lia].
  - simpl. unfold Rpower. rewrite ln_1, Rmult_0_r, exp_0. lra.
Qed.
