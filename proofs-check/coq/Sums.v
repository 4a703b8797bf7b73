(** Finite sums, in the three forms in which mathematics.md writes them. *)

From Coq Require Import Reals ZArith Lra Lia.
From Coquelicot Require Import Coquelicot.
Local Open Scope R_scope.

Lemma le_div a b c : 0 < c -> a * c <= b -> a <= b / c.
Proof. intros Hc H. apply Rle_div_r; assumption. Qed.

Lemma div_le a b c : 0 < c -> a <= b * c -> a / c <= b.
Proof. intros Hc H. apply Rle_div_l; assumption. Qed.

(** [sum n f] is f(0) + ... + f(n-1). *)
Fixpoint sum (n : nat) (f : nat -> R) : R :=
  match n with O => 0 | S p => sum p f + f p end.

(** [sum1 N f] is the sum of f(l) over 1 <= l <= N. *)
Definition sum1 (N : nat) (f : nat -> R) : R := sum N (fun i => f (S i)).

(** [zsum N f] is the sum of f(l) over the integers with |l| <= N. *)
Definition zsum (N : nat) (f : Z -> R) : R :=
  f 0%Z + sum1 N (fun l => f (Z.of_nat l) + f (- Z.of_nat l)%Z).

(** ** Sums from 0 *)

Lemma sum_ext n f g : (forall i, (i < n)%nat -> f i = g i) -> sum n f = sum n g.
Proof.
  induction n as [|n IH]; intros H; simpl; [reflexivity|].
  rewrite IH by (intros; apply H; lia). rewrite H by lia. reflexivity.
Qed.

Lemma sum_le n f g : (forall i, (i < n)%nat -> f i <= g i) -> sum n f <= sum n g.
Proof.
  induction n as [|n IH]; intros H; simpl; [lra|].
  apply Rplus_le_compat; [apply IH; intros; apply H; lia | apply H; lia].
Qed.

Lemma sum_zero n f : (forall i, (i < n)%nat -> f i = 0) -> sum n f = 0.
Proof.
  induction n as [|n IH]; intros H; simpl; [reflexivity|].
  rewrite IH by (intros; apply H; lia). rewrite H by lia. ring.
Qed.

Lemma sum_nonneg n f : (forall i, (i < n)%nat -> 0 <= f i) -> 0 <= sum n f.
Proof.
  intros H. replace 0 with (sum n (fun _ => 0)) by (apply sum_zero; reflexivity).
  apply sum_le, H.
Qed.

Lemma sum_plus n f g : sum n (fun i => f i + g i) = sum n f + sum n g.
Proof. induction n as [|n IH]; simpl; [ring|]. rewrite IH. ring. Qed.

Lemma sum_minus n f g : sum n (fun i => f i - g i) = sum n f - sum n g.
Proof. induction n as [|n IH]; simpl; [ring|]. rewrite IH. ring. Qed.

Lemma sum_scal n a f : sum n (fun i => a * f i) = a * sum n f.
Proof. induction n as [|n IH]; simpl; [ring|]. rewrite IH. ring. Qed.

Lemma sum_first n f : sum (S n) f = f O + sum n (fun i => f (S i)).
Proof. induction n as [|n IH]; [simpl; ring|]. simpl in *. rewrite IH. ring. Qed.

Lemma sum_split p q f : sum (p + q) f = sum p f + sum q (fun i => f (p + i)%nat).
Proof.
  induction q as [|q IH]; [rewrite Nat.add_0_r; simpl; ring|].
  rewrite Nat.add_succ_r. simpl. rewrite IH. ring.
Qed.

Lemma sum_rev n f : sum n f = sum n (fun i => f (n - 1 - i)%nat).
Proof.
  induction n as [|n IH]; [reflexivity|].
  rewrite (sum_first n (fun i => f (S n - 1 - i)%nat)). cbn [sum].
  replace (S n - 1 - 0)%nat with n by lia. rewrite Rplus_comm. f_equal.
  rewrite IH. apply sum_ext. intros i Hi. f_equal. lia.
Qed.

Lemma sum_extend p q f :
  (p <= q)%nat -> (forall i, (p <= i < q)%nat -> 0 <= f i) -> sum p f <= sum q f.
Proof.
  intros Hpq H. replace q with (p + (q - p))%nat by lia. rewrite sum_split.
  assert (0 <= sum (q - p) (fun i => f (p + i)%nat)); [|lra].
  apply sum_nonneg. intros i Hi. apply H. lia.
Qed.

Lemma sum_term n f k :
  (forall i, (i < n)%nat -> 0 <= f i) -> (k < n)%nat -> f k <= sum n f.
Proof.
  intros H Hk. replace n with (k + S (n - k - 1))%nat by lia.
  rewrite sum_split, sum_first, Nat.add_0_r.
  assert (0 <= sum k f) by (apply sum_nonneg; intros; apply H; lia).
  assert (0 <= sum (n - k - 1) (fun i => f (k + S i)%nat))
    by (apply sum_nonneg; intros; apply H; lia).
  lra.
Qed.

(** A sum of differences that dominate the terms. *)
Lemma sum_telescope n (f F : nat -> R) :
  (forall i, (i < n)%nat -> f i <= F (S i) - F i) -> sum n f <= F n - F O.
Proof.
  induction n as [|n IH]; intros H; simpl; [lra|].
  assert (sum n f <= F n - F O) by (apply IH; intros; apply H; lia).
  assert (f n <= F (S n) - F n) by (apply H; lia). lra.
Qed.

Lemma sum_derive n (f f' : nat -> R -> R) (x : R) :
  (forall i, (i < n)%nat -> is_derive (f i) x (f' i x)) ->
  is_derive (fun t => sum n (fun i => f i t)) x (sum n (fun i => f' i x)).
Proof.
  induction n as [|n IH]; intros H; simpl.
  - apply is_derive_ext with (f := fun _ => 0); [reflexivity|]. apply @is_derive_const.
  - apply @is_derive_plus; [apply IH; intros; apply H; lia | apply H; lia].
Qed.

(** The inequality of Cauchy and Schwarz. *)
Lemma cauchy_schwarz n (a b : nat -> R) :
  (sum n (fun i => a i * b i))^2 <= sum n (fun i => (a i)^2) * sum n (fun i => (b i)^2).
Proof.
  induction n as [|n IH]; [simpl; lra|]. cbn [sum].
  set (A := sum n (fun i => (a i)^2)) in *. set (B := sum n (fun i => (b i)^2)) in *.
  set (S := sum n (fun i => a i * b i)) in *.
  assert (HA : 0 <= A) by (apply sum_nonneg; intros; apply pow2_ge_0).
  assert (HB : 0 <= B) by (apply sum_nonneg; intros; apply pow2_ge_0).
  assert (H : 2 * S * (a n * b n) <= A * (b n)^2 + B * (a n)^2).
  { assert (HS : Rabs S <= sqrt A * sqrt B).
    { rewrite <- sqrt_mult by assumption. rewrite <- sqrt_Rsqr_abs.
      apply sqrt_le_1_alt. unfold Rsqr. lra. }
    assert (H1 : S * (a n * b n) <= Rabs S * Rabs (a n * b n))
      by (rewrite <- Rabs_mult; apply Rle_abs).
    rewrite (Rabs_mult (a n) (b n)) in H1.
    assert (0 <= Rabs (a n)) by apply Rabs_pos. assert (0 <= Rabs (b n)) by apply Rabs_pos.
    assert (H2 : Rabs S * (Rabs (a n) * Rabs (b n))
                 <= sqrt A * sqrt B * (Rabs (a n) * Rabs (b n)))
      by (apply Rmult_le_compat_r; [apply Rmult_le_pos; assumption | exact HS]).
    assert (H3 := pow2_ge_0 (sqrt A * Rabs (b n) - sqrt B * Rabs (a n))).
    assert (EA : sqrt A * sqrt A = A) by (apply sqrt_sqrt; assumption).
    assert (EB : sqrt B * sqrt B = B) by (apply sqrt_sqrt; assumption).
    assert (Ea : Rabs (a n) * Rabs (a n) = (a n)^2)
      by (rewrite <- Rabs_mult, Rabs_right; [ring | nra]).
    assert (Eb : Rabs (b n) * Rabs (b n) = (b n)^2)
      by (rewrite <- Rabs_mult, Rabs_right; [ring | nra]).
    replace ((sqrt A * Rabs (b n) - sqrt B * Rabs (a n))^2)
      with ((sqrt A * sqrt A) * (Rabs (b n) * Rabs (b n))
            - 2 * (sqrt A * sqrt B * (Rabs (a n) * Rabs (b n)))
            + (sqrt B * sqrt B) * (Rabs (a n) * Rabs (a n))) in H3 by ring.
    rewrite EA, EB, Ea, Eb in H3. lra. }
  replace ((S + a n * b n)^2) with (S^2 + 2 * S * (a n * b n) + (a n)^2 * (b n)^2) by ring.
  replace ((A + (a n)^2) * (B + (b n)^2))
    with (A * B + (A * (b n)^2 + B * (a n)^2) + (a n)^2 * (b n)^2) by ring.
  lra.
Qed.

(** ** Sums over the integers with |l| <= N *)

Lemma zsum_S N f :
  zsum (S N) f = zsum N f + (f (Z.of_nat (S N)) + f (- Z.of_nat (S N))%Z).
Proof. unfold zsum, sum1. cbn [sum]. ring. Qed.

Lemma zsum_ext N f g :
  (forall l, (Z.abs l <= Z.of_nat N)%Z -> f l = g l) -> zsum N f = zsum N g.
Proof.
  intros H. unfold zsum, sum1. rewrite H by lia. f_equal.
  apply sum_ext. intros i Hi. rewrite !H by lia. reflexivity.
Qed.

Lemma zsum_le N f g :
  (forall l, (Z.abs l <= Z.of_nat N)%Z -> f l <= g l) -> zsum N f <= zsum N g.
Proof.
  intros H. unfold zsum, sum1. apply Rplus_le_compat; [apply H; lia|].
  apply sum_le. intros i Hi. apply Rplus_le_compat; apply H; lia.
Qed.

Lemma zsum_nonneg N f :
  (forall l, (Z.abs l <= Z.of_nat N)%Z -> 0 <= f l) -> 0 <= zsum N f.
Proof.
  intros H. unfold zsum, sum1.
  assert (0 <= f 0%Z) by (apply H; lia).
  assert (0 <= sum N (fun i => f (Z.of_nat (S i)) + f (- Z.of_nat (S i))%Z)).
  { apply sum_nonneg. intros i Hi. apply Rplus_le_le_0_compat; apply H; lia. }
  lra.
Qed.

Lemma zsum_scal N a f : zsum N (fun l => a * f l) = a * zsum N f.
Proof.
  unfold zsum, sum1. rewrite Rmult_plus_distr_l, <- sum_scal. f_equal.
  apply sum_ext. intros; ring.
Qed.

Lemma zsum_plus N f g : zsum N (fun l => f l + g l) = zsum N f + zsum N g.
Proof.
  unfold zsum, sum1. transitivity (f 0%Z + g 0%Z + (sum N (fun i => f (Z.of_nat (S i)) + f (- Z.of_nat (S i))%Z) + sum N (fun i => g (Z.of_nat (S i)) + g (- Z.of_nat (S i))%Z))); [|ring].
  rewrite <- sum_plus. f_equal. apply sum_ext. intros; ring.
Qed.

(** The sum without the term m, which is how R is written in Lemma T. *)
Definition without (m : Z) (f : Z -> R) (l : Z) : R := if Z.eq_dec l m then 0 else f l.

Lemma without_other m f l : l <> m -> without m f l = f l.
Proof. unfold without. destruct (Z.eq_dec l m); [contradiction | reflexivity]. Qed.

Lemma without_same m f : without m f m = 0.
Proof. unfold without. destruct (Z.eq_dec m m); [reflexivity | contradiction]. Qed.

Lemma zsum_without N m f :
  (Z.abs m <= Z.of_nat N)%Z -> zsum N f = f m + zsum N (without m f).
Proof.
  induction N as [|N IH]; intros Hm.
  - assert (m = 0%Z) by lia. subst m. unfold zsum, sum1. simpl.
    rewrite without_same. ring.
  - rewrite !zsum_S. destruct (Z_le_dec (Z.abs m) (Z.of_nat N)) as [H|H].
    + rewrite (IH H). rewrite !(without_other m f) by lia. ring.
    + assert (E : zsum N (without m f) = zsum N f)
        by (apply zsum_ext; intros l Hl; apply without_other; lia).
      rewrite E. destruct (Z.eq_dec m (Z.of_nat (S N))) as [E1|E1].
      * rewrite <- E1, without_same, without_other by lia. ring.
      * assert (E2 : m = (- Z.of_nat (S N))%Z) by lia.
        rewrite <- E2, without_same, without_other by lia. ring.
Qed.

(** The terms above m and those below it, each counted from m. *)
Lemma zsum_sides N m f :
  (m <= N)%nat ->
  zsum N f = f (Z.of_nat m) + sum (N - m) (fun i => f (Z.of_nat (m + 1 + i)))
             + sum (N + m) (fun i => f (Z.of_nat m - 1 - Z.of_nat i)%Z).
Proof.
  induction N as [|N IH]; intros Hm.
  - assert (m = O) by lia. subst m. unfold zsum, sum1. simpl. ring.
  - destruct (Nat.eq_dec m (S N)) as [E|E].
    + subst m. clear IH Hm. rewrite Nat.sub_diag. cbn [sum].
      induction N as [|N IH].
      * unfold zsum, sum1. cbn [sum Nat.add]. simpl. ring.
      * rewrite zsum_S, IH. replace (S (S N) + S (S N))%nat with (S (S (S N + S N))) by lia.
        cbn [sum]. rewrite (sum_ext (S N + S N) (fun i => f (Z.of_nat (S (S N)) - 1 - Z.of_nat i)%Z)
           (fun i => f (Z.of_nat (S N) - Z.of_nat i)%Z)) by (intros; f_equal; lia).
        pose proof (sum_first (S N + S N) (fun i => f (Z.of_nat (S N) - Z.of_nat i)%Z)) as F.
        cbn [sum] in F. change (Z.of_nat 0) with 0%Z in F. rewrite Z.sub_0_r in F.
        rewrite (sum_ext (S N + S N) (fun i => f (Z.of_nat (S N) - Z.of_nat (S i))%Z)
           (fun i => f (Z.of_nat (S N) - 1 - Z.of_nat i)%Z)) in F by (intros; f_equal; lia).
        replace (Z.of_nat (S (S N)) - 1 - Z.of_nat (S N + S N))%Z
          with (Z.of_nat (S N) - Z.of_nat (S N + S N))%Z by lia.
        replace (Z.of_nat (S (S N)) - 1 - Z.of_nat (S (S N + S N)))%Z
          with (- Z.of_nat (S (S N)))%Z by lia.
        lra.
    + rewrite zsum_S, IH by lia. replace (S N - m)%nat with (S (N - m)) by lia.
      cbn [sum Nat.add]. replace (m + 1 + (N - m))%nat with (S N) by lia.
      replace (Z.of_nat m - 1 - Z.of_nat (N + m))%Z with (- Z.of_nat (S N))%Z by lia. ring.
Qed.

Lemma zsum_derive N (f f' : Z -> R -> R) (x : R) :
  (forall l, (Z.abs l <= Z.of_nat N)%Z -> is_derive (f l) x (f' l x)) ->
  is_derive (fun t => zsum N (fun l => f l t)) x (zsum N (fun l => f' l x)).
Proof.
  intros H. unfold zsum. apply @is_derive_plus; [apply H; lia|]. unfold sum1.
  apply (sum_derive N (fun i t => f (Z.of_nat (S i)) t + f (- Z.of_nat (S i))%Z t)
                      (fun i t => f' (Z.of_nat (S i)) t + f' (- Z.of_nat (S i))%Z t)).
  intros i Hi. apply @is_derive_plus; apply H; lia.
Qed.
