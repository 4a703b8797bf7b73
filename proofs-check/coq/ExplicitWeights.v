(** Section 1: explicit weights, a list and a tail coef l^-(1+eps). W2 and W3 are asked for inside the list and across the junction. *)

From Coq Require Import Reals ZArith List Lra Lia.
From SigmaStar Require Import Sums Weights WeightSum.
Local Open Scope R_scope.

Definition explicit (values : list R) (coef eps : R) (l : nat) : R :=
  match nth_error values l with Some v => v | None => coef * power 2 eps l end.

Section Explicit.
Variables (values : list R) (coef eps : R).
Let L := length values.
Let n := explicit values coef eps.
Hypothesis L_pos : (1 <= L)%nat.
Hypothesis coef_pos : 0 < coef.
Hypothesis eps_range : 0 < eps <= 1.
Hypothesis values_pos : Forall (fun v => 0 < v) values.
Hypothesis first : n 1%nat < n O.
Hypothesis list_W2 : forall l, (1 <= l < L)%nat -> INR (S l) * n (S l) <= INR l * n l.
Hypothesis list_W3 : forall l, (1 <= l < L)%nat -> INR l ^ 2 * n l <= INR (S l) ^ 2 * n (S l).

Let W := power_weights 2 eps ltac:(lra) eps_range.
Let eps_pos : 0 < eps := proj1 eps_range.

Lemma explicit_tail l : (L <= l)%nat -> n l = coef * power 2 eps l.
Proof. intros H. unfold n, explicit. rewrite (proj2 (nth_error_None values l)) by exact H. reflexivity. Qed.

Lemma explicit_pos l : 0 < n l.
Proof.
  destruct (le_lt_dec L l) as [H|H].
  - rewrite explicit_tail by exact H. apply Rmult_lt_0_compat; [exact coef_pos | apply (n_pos _ W)].
  - unfold n, explicit. destruct (nth_error values l) as [v|] eqn:E.
    + rewrite Forall_forall in values_pos. apply values_pos. apply nth_error_In with l. exact E.
    + apply nth_error_None in E. unfold L in H. lia.
Qed.

(** The sum: the list, M weights of the tail, and what is at most missing. *)
Definition explicit_total (M : nat) : R :=
  sum L n + coef * (sum M (fun i => power 2 eps (L + i)) + tail_sum eps (INR (L + M))).

Lemma tail_bound k m : sum k (fun i => power 2 eps (S m + i)) <= tail_sum eps (INR (S m)) - tail_sum eps (INR (S m) + INR k).
Proof.
  induction k as [|k IH]; [cbn [sum]; change (INR 0) with 0; rewrite Rplus_0_r; lra|]. cbn [sum]. rewrite (S_INR k), <- Rplus_assoc.
  pose proof (tail_step eps (INR (S m + k)) eps_pos ltac:(apply lt_0_INR; lia)) as T. change (S m + k)%nat with (S (m + k)) in T |- *.
  rewrite power_S.
  assert (E : INR (S (m + k)) = INR (S m) + INR k) by (rewrite !S_INR, plus_INR; ring).
  rewrite E in T. rewrite E. lra.
Qed.

Theorem explicit_sum M : forall N, n O + sum1 N n <= explicit_total M.
Proof.
  intros N. assert (E0 : n O + sum1 N n = sum (S N) n) by (unfold sum1; rewrite sum_first; reflexivity). rewrite E0.
  unfold explicit_total.
  assert (P : forall i, 0 < power 2 eps i) by (apply (n_pos _ W)).
  assert (Up : sum (S N) n <= sum (L + (S N + M)) n).
  { replace (L + (S N + M))%nat with (S N + (L + M))%nat by lia. rewrite sum_split.
    assert (0 <= sum (L + M) (fun i => n (S N + i)%nat)) by (apply sum_nonneg; intros; left; apply explicit_pos). lra. }
  apply Rle_trans with (1 := Up). rewrite sum_split. apply Rplus_le_compat_l.
  rewrite (sum_ext (S N + M) _ (fun i => coef * power 2 eps (L + i))) by (intros i _; apply explicit_tail; lia).
  rewrite sum_scal. apply Rmult_le_compat_l; [lra|].
  replace (S N + M)%nat with (M + S N)%nat by lia. rewrite sum_split. apply Rplus_le_compat_l.
  destruct (L + M)%nat as [|m] eqn:Em; [lia|].
  rewrite (sum_ext (S N) _ (fun i => power 2 eps (S m + i))) by (intros i _; f_equal; lia).
  apply Rle_trans with (1 := tail_bound (S N) m). pose proof (tail_pos eps (INR (S m) + INR (S N)) eps_pos). lra.
Qed.

Theorem explicit_weights : weights n.
Proof.
  split.
  - apply explicit_pos.
  - exists (explicit_total 0). apply explicit_sum.
  - intros l Hl. destruct (le_lt_dec L l) as [H|H]; [|apply list_W2; lia].
    rewrite !explicit_tail by lia. pose proof (W2 _ W l Hl) as Q.
    replace (INR (S l) * (coef * power 2 eps (S l))) with (coef * (INR (S l) * power 2 eps (S l))) by ring.
    replace (INR l * (coef * power 2 eps l)) with (coef * (INR l * power 2 eps l)) by ring.
    apply Rmult_le_compat_l; lra.
  - intros l Hl. destruct (le_lt_dec L l) as [H|H]; [|apply list_W3; lia].
    rewrite !explicit_tail by lia. pose proof (W3 _ W l Hl) as Q.
    replace (INR l ^ 2 * (coef * power 2 eps l)) with (coef * (INR l ^ 2 * power 2 eps l)) by ring.
    replace (INR (S l) ^ 2 * (coef * power 2 eps (S l))) with (coef * (INR (S l) ^ 2 * power 2 eps (S l))) by ring.
    apply Rmult_le_compat_l; lra.
  - exact first.
Qed.

End Explicit.

(** ** A form of which enclosures are quick to compute *)

Lemma sum_powers eps M L : (1 <= L)%nat -> sum M (fun i => power 2 eps (L + i)) = powers eps M (Z.of_nat L).
Proof.
  revert L. induction M as [|M IH]; intros L HL; [reflexivity|].
  rewrite sum_first. cbn [powers]. rewrite Nat.add_0_r.
  replace (Z.succ (Z.of_nat L)) with (Z.of_nat (S L)) by lia. rewrite <- IH by lia. f_equal.
  - destruct L as [|l]; [lia|]. rewrite power_S, INR_IZR_INZ. reflexivity.
  - apply sum_ext. intros i _. f_equal. lia.
Qed.

Lemma explicit_total_powers values coef eps M : (1 <= length values)%nat ->
  explicit_total values coef eps M
  = sum (length values) (explicit values coef eps)
    + coef * (powers eps M (Z.of_nat (length values)) + tail_sum eps (IZR (Z.of_nat (length values + M)))).
Proof. intros H. unfold explicit_total. rewrite sum_powers, INR_IZR_INZ by exact H. reflexivity. Qed.

Lemma explicit_total_roots values coef M : (1 <= length values)%nat ->
  explicit_total values coef (1 / 2) M
  = sum (length values) (explicit values coef (1 / 2))
    + coef * (roots M (Z.of_nat (length values)) + tail_sum (1 / 2) (IZR (Z.of_nat (length values + M)))).
Proof. intros H. rewrite explicit_total_powers, powers_half by (exact H || lia). reflexivity. Qed.
