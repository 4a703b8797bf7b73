(** Section 1: the sum of all weights of the power family is at most a finite sum and three terms of the Euler-Maclaurin formula. *)

From Coq Require Import Reals ZArith Lra Lia.
From Coquelicot Require Import Coquelicot.
From SigmaStar Require Import Sums Weights.
Local Open Scope R_scope.

(** A function that is 0 at 0 and does not fall is not negative. *)
Lemma rises (g g' : R -> R) :
  g 0 = 0 -> (forall u, 0 <= u <= 1 -> is_derive g u (g' u)) -> (forall u, 0 <= u <= 1 -> 0 <= g' u) ->
  forall u, 0 <= u <= 1 -> 0 <= g u.
Proof.
  intros G0 D N u Hu. destruct (MVT_gen g 0 u g') as [v [Hv E]].
  - intros v Hv. rewrite Rmin_left, Rmax_right in Hv by lra. apply D. lra.
  - intros v Hv. rewrite Rmin_left, Rmax_right in Hv by lra.
    apply continuity_pt_filterlim. apply (ex_derive_continuous (V := R_NormedModule)). eexists. apply D. lra.
  - rewrite Rmin_left, Rmax_right in Hv by lra. rewrite G0 in E.
    assert (0 <= g' v * (u - 0)) by (apply Rmult_le_pos; [apply N; lra | lra]). lra.
Qed.

Section EulerMaclaurin.
(** f has the antiderivative -F and the derivatives f1 to f4 beyond 0, and f4 >= 0. *)
Variables F f f1 f2 f3 f4 : R -> R.
Hypothesis dF : forall t, 0 < t -> is_derive F t (- f t).
Hypothesis df : forall t, 0 < t -> is_derive f t (f1 t).
Hypothesis df1 : forall t, 0 < t -> is_derive f1 t (f2 t).
Hypothesis df2 : forall t, 0 < t -> is_derive f2 t (f3 t).
Hypothesis df3 : forall t, 0 < t -> is_derive f3 t (f4 t).
Hypothesis f4_nonneg : forall t, 0 < t -> 0 <= f4 t.

(** The derivative of A + u B + u^2 C. *)
Lemma combined (A B C : R -> R) A' B' C' u : is_derive A u A' -> is_derive B u B' -> is_derive C u C' ->
  is_derive (fun u => A u + u * B u + u ^ 2 * C u) u (A' + (B u + u * B') + (2 * u * C u + u ^ 2 * C')).
Proof.
  intros HA HB HC.
  assert (D : forall (g h : R -> R) g' h', is_derive g u g' -> is_derive h u h' ->
            is_derive (fun u => g u * h u) u (g' * h u + g u * h')).
  { intros g k g' k' Hg Hk. apply (is_derive_mult (K := R_AbsRing) g k u g' k' Hg Hk). intros; apply Rmult_comm. }
  apply (is_derive_plus (V := R_NormedModule)); [apply (is_derive_plus (V := R_NormedModule))|].
  - exact HA.
  - evar_last; [apply (D (fun u => u)); [apply (is_derive_id (K := R_AbsRing)) | exact HB]|]. unfold one; simpl. ring.
  - apply (D (fun u => u ^ 2)); [|exact HC]. auto_derive; [exact I | ring].
Qed.

Lemma shifted (g g' : R -> R) x u a k : is_derive g (x + u) (g' (x + u)) ->
  is_derive (fun u => a * (g (x + u) - k)) u (a * g' (x + u)).
Proof.
  intros H. apply is_derive_scal. evar_last.
  - apply (is_derive_minus (V := R_NormedModule)); [|apply (is_derive_const (V := R_NormedModule))].
    apply (is_derive_comp (V := R_NormedModule) g (fun u => x + u) u); [exact H|].
    apply (is_derive_plus (V := R_NormedModule)); [apply (is_derive_const (V := R_NormedModule)) | apply (is_derive_id (K := R_AbsRing))].
  - unfold scal, minus, plus, opp, zero, one; simpl. unfold mult; simpl. ring.
Qed.

(** The trapezoid with its first correction is at most the integral. *)
Lemma trapezoid x u : 0 < x -> 0 <= u <= 1 ->
  0 <= -1 * (F (x + u) - F x) + u * (- / 2 * (f (x + u) - - f x)) + u ^ 2 * (/ 12 * (f1 (x + u) - f1 x)).
Proof.
  intros Hx Hu.
  set (d3 := fun u => u ^ 2 / 12 * f4 (x + u)).
  set (d2 := fun u => / 6 * (f1 (x + u) - f1 x) + u * (- / 6 * (f2 (x + u) - 0)) + u ^ 2 * (/ 12 * (f3 (x + u) - 0))).
  set (d1 := fun u => / 2 * (f (x + u) - f x) + u * (- / 3 * (f1 (x + u) - - / 2 * f1 x)) + u ^ 2 * (/ 12 * (f2 (x + u) - 0))).
  assert (D2 : forall u, 0 <= u <= 1 -> 0 <= d2 u).
  { apply (rises d2 d3).
    - unfold d2. rewrite Rplus_0_r. ring.
    - intros v Hv. unfold d2. evar_last; [apply combined; [apply shifted, df1 | apply shifted, df2 | apply shifted, df3]; lra|].
      unfold d3. cbv beta. field.
    - intros v Hv. unfold d3. apply Rmult_le_pos; [pose proof (pow2_ge_0 v); lra | apply f4_nonneg; lra]. }
  assert (D1 : forall u, 0 <= u <= 1 -> 0 <= d1 u).
  { apply (rises d1 d2); [| |exact D2].
    - unfold d1. rewrite Rplus_0_r. ring.
    - intros v Hv. unfold d1. evar_last; [apply combined; [apply shifted, df | apply shifted, df1 | apply shifted, df2]; lra|].
      unfold d2. cbv beta. field. }
  revert u Hu. apply (rises _ d1); [| |exact D1].
  - rewrite Rplus_0_r. ring.
  - intros v Hv. evar_last; [apply combined; [apply (shifted F (fun t => - f t)), dF | apply shifted, df | apply shifted, df1]; lra|].
    unfold d1. cbv beta. field.
Qed.

End EulerMaclaurin.

(** The derivative of a power. *)
Lemma Rpower_derive a t : 0 < t -> is_derive (fun t => Rpower t a) t (a * Rpower t (a - 1)).
Proof.
  intros Ht. unfold Rpower. auto_derive; [exact Ht|].
  replace ((a - 1) * ln t) with (a * ln t + - ln t) by ring.
  rewrite exp_plus, exp_Ropp, exp_ln by exact Ht. field. lra.
Qed.

(** G(x) = x^-eps/eps + x^-(1+eps)/2 + (1+eps) x^-(2+eps)/12: the sum of l^-(1+eps) from x on, and a little more. *)
Definition tail_sum (eps x : R) : R :=
  Rpower x (- eps) / eps + Rpower x (- (1 + eps)) / 2 + (1 + eps) * Rpower x (- (2 + eps)) / 12.

Lemma tail_step eps x : 0 < eps -> 0 < x -> Rpower x (- (1 + eps)) <= tail_sum eps x - tail_sum eps (x + 1).
Proof.
  intros He Hx.
  pose proof (trapezoid (fun t => Rpower t (- eps) / eps) (fun t => Rpower t (- eps - 1))
    (fun t => (- eps - 1) * Rpower t (- eps - 1 - 1))
    (fun t => (- eps - 1) * ((- eps - 1 - 1) * Rpower t (- eps - 1 - 1 - 1)))
    (fun t => (- eps - 1) * ((- eps - 1 - 1) * ((- eps - 1 - 1 - 1) * Rpower t (- eps - 1 - 1 - 1 - 1))))
    (fun t => (- eps - 1) * ((- eps - 1 - 1) * ((- eps - 1 - 1 - 1) * ((- eps - 1 - 1 - 1 - 1) * Rpower t (- eps - 1 - 1 - 1 - 1 - 1)))))) as Q.
  cbv beta in Q.
  assert (E1 : - (1 + eps) = - eps - 1) by ring. assert (E2 : - (2 + eps) = - eps - 1 - 1) by ring.
  unfold tail_sum. rewrite E1, E2.
  match type of Q with ?a -> ?b -> ?d -> ?e -> ?g -> ?k -> forall x u, _ =>
    enough (S : a /\ b /\ d /\ e /\ g /\ k) by
      (destruct S as [S1 [S2 [S3 [S4 [S5 S6]]]]]; specialize (Q S1 S2 S3 S4 S5 S6 x 1 Hx ltac:(lra)); lra) end.
  clear Q. split; [|split; [|split; [|split; [|split]]]].
  - intros t Ht. evar_last.
    + apply (is_derive_ext (fun t => / eps * Rpower t (- eps)) (fun t => Rpower t (- eps) / eps)); [intros r; apply Rmult_comm|].
      apply is_derive_scal, Rpower_derive, Ht.
    + field. lra.
  - intros t Ht. apply Rpower_derive, Ht.
  - intros t Ht. apply is_derive_scal, Rpower_derive, Ht.
  - intros t Ht. apply is_derive_scal, is_derive_scal, Rpower_derive, Ht.
  - intros t Ht. apply is_derive_scal, is_derive_scal, is_derive_scal, Rpower_derive, Ht.
  - intros t Ht. pose proof (exp_pos ((- eps - 1 - 1 - 1 - 1 - 1) * ln t)) as P. fold (Rpower t (- eps - 1 - 1 - 1 - 1 - 1)) in P.
    replace ((- eps - 1) * ((- eps - 1 - 1) * ((- eps - 1 - 1 - 1) * ((- eps - 1 - 1 - 1 - 1) * Rpower t (- eps - 1 - 1 - 1 - 1 - 1)))))
      with ((1 + eps) * ((2 + eps) * ((3 + eps) * ((4 + eps) * Rpower t (- eps - 1 - 1 - 1 - 1 - 1))))) by ring.
    repeat apply Rmult_le_pos; lra.
Qed.

Lemma tail_pos eps x : 0 < eps -> 0 <= tail_sum eps x.
Proof.
  intros He. unfold tail_sum, Rpower.
  pose proof (exp_pos (- eps * ln x)). pose proof (exp_pos (- (1 + eps) * ln x)). pose proof (exp_pos (- (2 + eps) * ln x)).
  assert (0 <= exp (- eps * ln x) / eps) by (left; apply Rdiv_lt_0_compat; lra).
  assert (0 <= (1 + eps) * exp (- (2 + eps) * ln x)) by (apply Rmult_le_pos; lra). lra.
Qed.

(** n_0 and the weights 1 to L, and what is at most missing. *)
Definition power_total (n_0 eps : R) (L : nat) : R :=
  n_0 + sum1 L (power n_0 eps) + tail_sum eps (INR (S L)).

Theorem power_sum n_0 eps L : 0 < eps -> forall N, power n_0 eps O + sum1 N (power n_0 eps) <= power_total n_0 eps L.
Proof.
  intros He N. unfold power_total. simpl power at 1. unfold sum1.
  destruct (le_lt_dec N L) as [H|H].
  - replace L with (N + (L - N))%nat at 1 by lia. rewrite sum_split.
    assert (0 <= sum (L - N) (fun i => power n_0 eps (S (N + i)))).
    { apply sum_nonneg. intros i _. left. apply exp_pos. }
    pose proof (tail_pos eps (INR (S L)) He). lra.
  - replace N with (L + (N - L))%nat by lia. rewrite sum_split.
    assert (Q : forall k, sum k (fun i => power n_0 eps (S (L + i))) <= tail_sum eps (INR (S L)) - tail_sum eps (INR (S L) + INR k)).
    { induction k as [|k IH]; [simpl; rewrite Rplus_0_r; lra|]. cbn [sum]. rewrite (S_INR k), <- Rplus_assoc.
      pose proof (tail_step eps (INR (S (L + k))) He (INR_S_pos _)) as T. rewrite power_S.
      assert (E : INR (S (L + k)) = INR (S L) + INR k) by (rewrite !S_INR, plus_INR; ring).
      rewrite E in T. rewrite E. lra. }
    specialize (Q (N - L)%nat). pose proof (tail_pos eps (INR (S L) + INR (N - L)) He). lra.
Qed.

(** ** Forms of which enclosures are quick to compute *)

(** l^-(1+eps) for L integers from l on; for eps = 1/2 as 1/(l sqrt l). *)
Fixpoint powers (eps : R) (L : nat) (l : Z) : R :=
  match L with O => 0 | S k => Rpower (IZR l) (- (1 + eps)) + powers eps k (Z.succ l) end.
Fixpoint roots (L : nat) (l : Z) : R :=
  match L with O => 0 | S k => / (IZR l * sqrt (IZR l)) + roots k (Z.succ l) end.

Lemma sum1_powers n_0 eps L : sum1 L (power n_0 eps) = powers eps L 1.
Proof.
  unfold sum1.
  enough (Q : forall k, sum L (fun i => power n_0 eps (S (k + i))) = powers eps L (Z.of_nat (S k))) by apply (Q O).
  induction L as [|L IH]; intros k; [reflexivity|].
  rewrite sum_first. cbn [powers]. rewrite power_S, Nat.add_0_r, <- INR_IZR_INZ. f_equal.
  replace (Z.succ (Z.of_nat (S k))) with (Z.of_nat (S (S k))) by lia.
  rewrite <- IH. apply sum_ext. intros i _. f_equal. lia.
Qed.

Lemma Rpower_half x : 0 < x -> Rpower x (- (1 + 1 / 2)) = / (x * sqrt x).
Proof.
  intros H. rewrite Rpower_Ropp. f_equal. rewrite Rpower_plus, Rpower_1 by exact H. f_equal.
  replace (1 / 2) with (/ 2) by field. apply Rpower_sqrt, H.
Qed.

Lemma powers_half L l : (0 < l)%Z -> powers (1 / 2) L l = roots L l.
Proof.
  revert l. induction L as [|L IH]; intros l Hl; [reflexivity|]. cbn [powers roots]. rewrite IH by lia. f_equal.
  apply Rpower_half, IZR_lt, Hl.
Qed.

Lemma power_total_powers n_0 eps L :
  power_total n_0 eps L = n_0 + powers eps L 1 + tail_sum eps (IZR (Z.of_nat (S L))).
Proof. unfold power_total. rewrite sum1_powers, INR_IZR_INZ. reflexivity. Qed.

Lemma power_total_roots n_0 L :
  power_total n_0 (1 / 2) L = n_0 + roots L 1 + tail_sum (1 / 2) (IZR (Z.of_nat (S L))).
Proof. rewrite power_total_powers, powers_half by lia. reflexivity. Qed.
