(** Section 2: the transfer function of the internal model, and what its values are at the poles and beside them. *)

From Coq Require Import Reals ZArith Lra Lia.
From Coquelicot Require Import Coquelicot.
From SigmaStar Require Import Sums Weights.
Local Open Scope R_scope.

Section Transfer.

(** The weights n_l, and nu = mu/w. *)
Variable n : nat -> R.
Variable nu : R.
Hypothesis n_pos : forall l, 0 < n l.
Hypothesis nu_pos : 0 < nu.

(** c_0 = n_0 and c_l = n_|l|/2. *)
Definition c (l : Z) : R := if Z.eq_dec l 0 then n O else n (Z.abs_nat l) / 2.

(** g_N(x) and its derivative, (2.1). *)
Definition g (N : nat) (x : R) : R := zsum N (fun l => c l / (IZR l - x)).
Definition g' (N : nat) (x : R) : R := zsum N (fun l => c l / (IZR l - x) ^ 2).

(** T_N(x): the quotient of (2.1), and at a pole the number of (2.2), to which the quotient tends there
    ([T_continuous_at_pole]). *)
Definition quotient (N : nat) (x : R) : R := g' N x / (1 + nu ^ 2 * g N x ^ 2).
Definition T (N : nat) (x : R) : R :=
  if Req_EM_T x (IZR (Int_part x)) then
    if Z_le_dec (Z.abs (Int_part x)) (Z.of_nat N) then 1 / (nu ^ 2 * c (Int_part x))
    else quotient N x
  else quotient N x.

(** The sums of Lemma T, without the pole m. *)
Definition Rest (m : Z) (N : nat) (x : R) : R := zsum N (without m (fun l => c l / (IZR l - x))).
Definition Rest' (m : Z) (N : nat) (x : R) : R := zsum N (without m (fun l => c l / (IZR l - x) ^ 2)).

Lemma c_pos l : 0 < c l.
Proof. unfold c. pose proof (n_pos O). pose proof (n_pos (Z.abs_nat l)). destruct (Z.eq_dec l 0); lra. Qed.

Lemma c_even l : c (- l) = c l.
Proof.
  unfold c. destruct (Z.eq_dec l 0) as [->|E]; [reflexivity|].
  destruct (Z.eq_dec (- l) 0); [lia|]. f_equal. f_equal. lia.
Qed.

Lemma c_nat l : (1 <= l)%nat -> c (Z.of_nat l) = n l / 2.
Proof. intros Hl. unfold c. destruct (Z.eq_dec (Z.of_nat l) 0); [lia|]. do 2 f_equal. lia. Qed.

Lemma c_neg l : (1 <= l)%nat -> c (- Z.of_nat l) = n l / 2.
Proof. intros Hl. rewrite c_even. apply c_nat, Hl. Qed.

(** x is no pole. *)
Definition regular (N : nat) (x : R) : Prop := forall l, (Z.abs l <= Z.of_nat N)%Z -> IZR l <> x.

Lemma T_regular N x : regular N x -> T N x = quotient N x.
Proof.
  intros Hx. unfold T. destruct (Req_EM_T x _) as [E|_]; [|reflexivity].
  destruct (Z_le_dec _ _) as [Hl|_]; [|reflexivity].
  exfalso. apply (Hx _ Hl). symmetry; exact E.
Qed.

Lemma Int_part_IZR m : Int_part (IZR m) = m.
Proof. unfold Int_part. rewrite <- (tech_up (IZR m) (m + 1)); [ring| |]; rewrite plus_IZR; lra. Qed.

(** (2.2) *)
Lemma T_pole N m : (Z.abs m <= Z.of_nat N)%Z -> T N (IZR m) = 1 / (nu ^ 2 * c m).
Proof.
  intros Hm. unfold T. rewrite Int_part_IZR.
  destruct (Req_EM_T _ _) as [_|E]; [|contradiction].
  destruct (Z_le_dec _ _); [reflexivity | contradiction].
Qed.

Theorem T_at_0 N : T N 0 = 1 / (nu ^ 2 * n O).
Proof. rewrite (T_pole N 0) by lia. reflexivity. Qed.

Theorem T_at_pole N l : (1 <= l <= N)%nat -> T N (INR l) = 2 / (nu ^ 2 * n l).
Proof.
  intros Hl. rewrite INR_IZR_INZ, T_pole by lia. rewrite c_nat by lia.
  pose proof (n_pos l). field. lra.
Qed.

(** g_N' is the derivative of g_N, and T_N that of arctan(nu g_N)/nu, (2.1). *)
Lemma g_derive N x : regular N x -> is_derive (g N) x (g' N x).
Proof.
  intros Hx. unfold g, g'.
  apply (zsum_derive N (fun l t => c l / (IZR l - t)) (fun l t => c l / (IZR l - t) ^ 2)).
  intros l Hl. specialize (Hx l Hl). auto_derive; [lra|]. field. lra.
Qed.

Theorem T_is_phase_derivative N x :
  regular N x -> is_derive (fun t => atan (nu * g N t) / nu) x (T N x).
Proof.
  intros Hx. rewrite T_regular by exact Hx.
  pose proof (g_derive N x Hx) as D.
  evar_last.
  - apply @is_derive_scal_l with (k := / nu).
    apply (is_derive_comp atan (fun t => nu * g N t)).
    + apply is_derive_Reals, derivable_pt_lim_atan.
    + apply (is_derive_scal (g N) x nu _ D).
  - unfold quotient, scal; simpl; unfold mult; simpl.
    assert (0 < 1 + (nu * g N x) ^ 2) by (pose proof (pow2_ge_0 (nu * g N x)); lra).
    field. split; [|lra]. unfold Rsqr in *. nra.
Qed.

Lemma near_pole_regular m N x : Rabs (x - IZR m) < 1 -> x <> IZR m -> regular N x.
Proof.
  intros Hx Hne l _ E. apply Hne. f_equal. subst x.
  rewrite <- minus_IZR, <- abs_IZR in Hx. apply lt_IZR in Hx.
  assert (l = m) by lia. subst; reflexivity.
Qed.

Lemma denominator_pos m N x : 0 < (x - IZR m) ^ 2 + nu ^ 2 * (c m - Rest m N x * (x - IZR m)) ^ 2.
Proof.
  set (d := x - IZR m). pose proof (c_pos m). assert (0 < nu ^ 2) by nra.
  destruct (Req_dec d 0) as [->|Hd].
  - replace (c m - Rest m N x * 0) with (c m) by ring.
    assert (0 < nu ^ 2 * c m ^ 2) by (apply Rmult_lt_0_compat; nra). lra.
  - assert (0 < d ^ 2) by nra.
    assert (0 <= nu ^ 2 * (c m - Rest m N x * d) ^ 2) by (apply Rmult_le_pos; [lra | apply pow2_ge_0]). lra.
Qed.

(** Section 2.2: the form in which the removable singularity at m is multiplied out. *)
Theorem T_pole_free m N x :
  (Z.abs m <= Z.of_nat N)%Z -> Rabs (x - IZR m) < 1 ->
  let d := x - IZR m in
  T N x = (c m + Rest' m N x * d ^ 2) / (d ^ 2 + nu ^ 2 * (c m - Rest m N x * d) ^ 2).
Proof.
  intros Hm Hx d. pose proof (denominator_pos m N x) as HD. fold d in HD.
  pose proof (c_pos m) as Hc.
  destruct (Req_dec x (IZR m)) as [E|E].
  - rewrite E at 1. rewrite T_pole by exact Hm. unfold d in *. rewrite E in *.
    replace (IZR m - IZR m) with 0 by ring. field. lra.
  - rewrite T_regular by (apply near_pole_regular with (m := m); assumption).
    unfold quotient, g, g'. rewrite (zsum_without N m (fun l => c l / (IZR l - x)) Hm).
    rewrite (zsum_without N m (fun l => c l / (IZR l - x) ^ 2) Hm).
    fold (Rest m N x) (Rest' m N x). unfold d in *.
    assert (H0 : x - IZR m <> 0) by lra.
    set (r := Rest m N x) in *. set (r' := Rest' m N x).
    assert (0 < 1 + nu ^ 2 * (c m / (IZR m - x) + r) ^ 2).
    { pose proof (pow2_ge_0 (nu * (c m / (IZR m - x) + r))). nra. }
    apply (Rmult_eq_reg_r ((1 + nu ^ 2 * (c m / (IZR m - x) + r) ^ 2)
        * ((x - IZR m) ^ 2 + nu ^ 2 * (c m - r * (x - IZR m)) ^ 2))); [|nra].
    transitivity ((c m / (IZR m - x) ^ 2 + r') * ((x - IZR m) ^ 2 + nu ^ 2 * (c m - r * (x - IZR m)) ^ 2)).
    { field. split; [nra|lra]. }
    transitivity ((c m + r' * (x - IZR m) ^ 2) * (1 + nu ^ 2 * (c m / (IZR m - x) + r) ^ 2)).
    { field. lra. }
    field. nra.
Qed.

Lemma Rest'_nonneg m N x : 0 <= Rest' m N x.
Proof.
  apply zsum_nonneg. intros l _. unfold without. destruct (Z.eq_dec l m); [lra|].
  unfold Rdiv. apply Rmult_le_pos; [left; apply c_pos|].
  destruct (Req_dec ((IZR l - x) ^ 2) 0) as [->|E]; [rewrite Rinv_0; lra|].
  left. apply Rinv_0_lt_compat. pose proof (pow2_ge_0 (IZR l - x)). lra.
Qed.

(** Lemma T (one pole). *)
Theorem Lemma_T m N x :
  (Z.abs m <= Z.of_nat N)%Z -> Rabs (x - IZR m) <= 1 / 2 ->
  T N x <= (1 / nu ^ 2 + Rest m N x ^ 2) / c m + Rest' m N x.
Proof.
  intros Hm Hx. rewrite (T_pole_free m N x Hm) by lra.
  pose proof (denominator_pos m N x) as HD. pose proof (c_pos m) as Hc.
  pose proof (Rest'_nonneg m N x) as Hr'.
  set (r := Rest m N x) in *. set (r' := Rest' m N x) in *. set (d := x - IZR m) in *.
  assert (Hnu : 0 < nu ^ 2) by nra.
  apply Rle_div_l; [exact HD|].
  set (D := d ^ 2 + nu ^ 2 * (c m - r * d) ^ 2) in *.
  assert (H1 : c m <= (1 / nu ^ 2 + r ^ 2) / c m * D).
  { replace ((1 / nu ^ 2 + r ^ 2) / c m * D) with ((1 + nu ^ 2 * r ^ 2) * D / (nu ^ 2 * c m)) by (field; lra).
    apply Rle_div_r; [nra|].
    assert (E : (1 + nu ^ 2 * r ^ 2) * D
                = nu ^ 2 * c m ^ 2 + ((1 + nu ^ 2 * r ^ 2) * d - nu ^ 2 * r * c m) ^ 2)
      by (unfold D; ring).
    rewrite E. pose proof (pow2_ge_0 ((1 + nu ^ 2 * r ^ 2) * d - nu ^ 2 * r * c m)). lra. }
  assert (H2 : r' * d ^ 2 <= r' * D).
  { apply Rmult_le_compat_l; [exact Hr'|]. unfold D.
    pose proof (pow2_ge_0 (c m - r * d)). nra. }
  rewrite Rmult_plus_distr_r. lra.
Qed.

(** Away from the poles T_N is at most g_N'. *)
Lemma T_le_g' N x : regular N x -> T N x <= g' N x.
Proof.
  intros Hx. rewrite T_regular by exact Hx. unfold quotient.
  assert (0 <= g' N x).
  { apply zsum_nonneg. intros l Hl. specialize (Hx l Hl).
    left. apply Rdiv_lt_0_compat; [apply c_pos|]. nra. }
  pose proof (pow2_ge_0 (nu * g N x)).
  apply Rle_div_l; nra.
Qed.

(** T_N is continuous at its poles too. *)
Lemma without_continuous m N x (f : Z -> R -> R) :
  (forall l, (Z.abs l <= Z.of_nat N)%Z -> l <> m -> continuous (f l) x) ->
  continuous (fun t => zsum N (without m (fun l => f l t))) x.
Proof.
  intros H. unfold zsum, sum1.
  assert (P : forall l, (Z.abs l <= Z.of_nat N)%Z -> continuous (fun t => without m (fun l => f l t) l) x).
  { intros l Hl. unfold without. destruct (Z.eq_dec l m); [apply continuous_const | apply H; assumption]. }
  apply (continuous_plus (V := R_NormedModule)); [apply P; lia|].
  assert (Q : forall k, (k <= N)%nat -> continuous (fun t => sum k (fun i =>
      without m (fun l => f l t) (Z.of_nat (S i)) + without m (fun l => f l t) (- Z.of_nat (S i))%Z)) x).
  { induction k as [|k IH]; intros Hk; cbn [sum]; [apply continuous_const|].
    apply (continuous_plus (V := R_NormedModule)); [apply IH; lia|].
    apply (continuous_plus (V := R_NormedModule)); apply P; lia. }
  apply Q, le_n.
Qed.

Theorem T_continuous_at_pole N m : (Z.abs m <= Z.of_nat N)%Z -> continuous (T N) (IZR m).
Proof.
  intros Hm.
  apply (continuous_ext_loc (U := R_UniformSpace) (T N) (fun x =>
    (c m + Rest' m N x * (x - IZR m) ^ 2)
      * / ((x - IZR m) ^ 2 + nu ^ 2 * (c m - Rest m N x * (x - IZR m)) ^ 2))).
  { exists (mkposreal 1 Rlt_0_1). intros x Hx. symmetry. apply (T_pole_free m N x Hm), Hx. }
  assert (Hl : forall l, l <> m -> IZR l - IZR m <> 0).
  { intros l Hl E. apply Hl, eq_IZR. lra. }
  assert (C1 : continuous (fun x => Rest m N x) (IZR m)).
  { unfold Rest. apply (without_continuous m N (IZR m) (fun l x => c l / (IZR l - x))). intros l _ Hne. specialize (Hl l Hne).
    apply (ex_derive_continuous (V := R_NormedModule)). auto_derive. exact Hl. }
  assert (C2 : continuous (fun x => Rest' m N x) (IZR m)).
  { unfold Rest'. apply (without_continuous m N (IZR m) (fun l x => c l / (IZR l - x) ^ 2)). intros l _ Hne. specialize (Hl l Hne).
    apply (ex_derive_continuous (V := R_NormedModule)). auto_derive. nra. }
  assert (C3 : forall k, continuous (fun x => (x - IZR m) ^ k) (IZR m)).
  { intros k. apply (ex_derive_continuous (V := R_NormedModule)). auto_derive. exact I. }
  assert (C4 : continuous (fun x => x - IZR m) (IZR m)).
  { apply (ex_derive_continuous (V := R_NormedModule)). auto_derive. exact I. }
  apply (continuous_mult (K := R_AbsRing)).
  - apply (continuous_plus (V := R_NormedModule)); [apply continuous_const|].
    apply (continuous_mult (K := R_AbsRing)); [exact C2 | apply C3].
  - apply (continuous_comp (fun x => (x - IZR m) ^ 2 + nu ^ 2 * (c m - Rest m N x * (x - IZR m)) ^ 2) Rinv).
    + apply (continuous_plus (V := R_NormedModule)); [apply C3|].
      apply (continuous_mult (K := R_AbsRing)); [apply continuous_const|].
      apply (continuous_comp (fun x => c m - Rest m N x * (x - IZR m)) (fun y => y ^ 2)).
      * apply (continuous_minus (V := R_NormedModule)); [apply continuous_const|].
        apply (continuous_mult (K := R_AbsRing)); assumption.
      * apply (ex_derive_continuous (V := R_NormedModule)). auto_derive. exact I.
    + apply continuous_Rinv. pose proof (denominator_pos m N (IZR m)). lra.
Qed.

(** ** Beyond the last pole *)

Lemma beyond_regular N x : INR N < x -> regular N x.
Proof.
  intros Hx l Hl E. rewrite INR_IZR_INZ in Hx. rewrite <- E in Hx. apply lt_IZR in Hx. lia.
Qed.

Lemma beyond_gap N x l : INR N < x -> (Z.abs l <= Z.of_nat N)%Z -> x - INR N <= x - IZR l.
Proof.
  intros Hx Hl. rewrite INR_IZR_INZ.
  assert (IZR l <= IZR (Z.of_nat N)) by (apply IZR_le; lia). lra.
Qed.

Lemma beyond_g' N x : INR N < x -> g' N x <= - g N x / (x - INR N).
Proof.
  intros Hx. apply Rle_div_r; [lra|]. unfold g, g'.
  replace (- zsum N (fun l => c l / (IZR l - x))) with (-1 * zsum N (fun l => c l / (IZR l - x))) by ring.
  rewrite <- zsum_scal. rewrite Rmult_comm, <- zsum_scal. apply zsum_le. intros l Hl.
  pose proof (beyond_gap N x l Hx Hl) as G. pose proof (c_pos l) as Hc.
  replace (-1 * (c l / (IZR l - x))) with (c l / (x - IZR l) ^ 2 * (x - IZR l)) by (field; lra).
  replace (c l / (IZR l - x) ^ 2) with (c l / (x - IZR l) ^ 2) by (field; lra).
  rewrite Rmult_comm. apply Rmult_le_compat_l; [|lra].
  left. apply Rdiv_lt_0_compat; [exact Hc | apply pow_lt; lra].
Qed.

(** All terms of |g_N| are positive, so it is at least the one of l = 0. *)
Lemma beyond_g N x : INR N < x -> n O / x <= - g N x.
Proof.
  intros Hx. pose proof (pos_INR N) as HN.
  unfold g, zsum.
  assert (sum1 N (fun l => c (Z.of_nat l) / (IZR (Z.of_nat l) - x)
                           + c (- Z.of_nat l) / (IZR (- Z.of_nat l) - x)) <= 0).
  { unfold sum1. replace 0 with (sum N (fun _ => 0)) by (apply sum_zero; reflexivity).
    apply sum_le. intros i Hi.
    pose proof (beyond_gap N x (Z.of_nat (S i)) Hx ltac:(lia)) as G1.
    pose proof (beyond_gap N x (- Z.of_nat (S i)) Hx ltac:(lia)) as G2.
    pose proof (c_pos (Z.of_nat (S i))) as P1. pose proof (c_pos (- Z.of_nat (S i))) as P2.
    assert (forall a b, 0 < a -> b < 0 -> a / b <= 0).
    { intros a b Ha Hb. unfold Rdiv. pose proof (Rinv_lt_0_compat b Hb). nra. }
    assert (c (Z.of_nat (S i)) / (IZR (Z.of_nat (S i)) - x) <= 0) by (apply H; lra).
    assert (c (- Z.of_nat (S i)) / (IZR (- Z.of_nat (S i)) - x) <= 0) by (apply H; lra). lra. }
  replace (c 0 / (IZR 0 - x)) with (- (n O / x)) by (unfold c; simpl; field; lra). lra.
Qed.

(** Lemma T'. *)
Theorem Lemma_T' N x : INR N < x -> T N x <= 1 / (2 * nu * (x - INR N)).
Proof.
  intros Hx. rewrite T_regular by (apply beyond_regular; exact Hx). unfold quotient.
  pose proof (beyond_g' N x Hx) as H1. set (y := - g N x) in *.
  assert (Ey : g N x ^ 2 = y ^ 2) by (unfold y; ring). rewrite Ey.
  assert (0 < 1 + nu ^ 2 * y ^ 2) by (pose proof (pow2_ge_0 (nu * y)); nra).
  apply Rle_trans with (y / (x - INR N) / (1 + nu ^ 2 * y ^ 2)).
  { apply Rmult_le_compat_r; [left; apply Rinv_0_lt_compat; assumption | exact H1]. }
  replace (y / (x - INR N) / (1 + nu ^ 2 * y ^ 2))
    with (2 * nu * y / (1 + nu ^ 2 * y ^ 2) * (1 / (2 * nu * (x - INR N)))) by (field; split; [nra|lra]).
  rewrite <- (Rmult_1_l (1 / (2 * nu * (x - INR N)))) at 2.
  apply Rmult_le_compat_r; [left; apply Rdiv_lt_0_compat; nra|].
  apply Rle_div_l; [assumption|]. pose proof (pow2_ge_0 (1 - nu * y)). nra.
Qed.

(** Lemma T'', for real x. *)
Theorem Lemma_T'' N x : INR N < x -> T N x <= x / (nu ^ 2 * n O * (x - INR N)).
Proof.
  intros Hx. rewrite T_regular by (apply beyond_regular; exact Hx). unfold quotient.
  pose proof (beyond_g' N x Hx) as H1. pose proof (beyond_g N x Hx) as H2.
  pose proof (pos_INR N). pose proof (n_pos O) as Hn.
  set (y := - g N x) in *. replace (g N x ^ 2) with (y ^ 2) by (unfold y; ring).
  assert (Hy : 0 < y) by (apply Rlt_le_trans with (2 := H2); apply Rdiv_lt_0_compat; lra).
  assert (H3 : n O <= y * x) by (apply Rle_div_l in H2; lra).
  assert (0 < nu ^ 2) by nra.
  assert (0 < 1 + nu ^ 2 * y ^ 2) by nra.
  apply Rle_div_l; [assumption|]. apply Rle_trans with (1 := H1).
  apply Rle_div_l; [lra|].
  replace (x / (nu ^ 2 * n O * (x - INR N)) * (1 + nu ^ 2 * y ^ 2) * (x - INR N))
    with (x * (1 + nu ^ 2 * y ^ 2) / (nu ^ 2 * n O)) by (field; lra).
  apply Rle_div_r; [nra|]. nra.
Qed.

End Transfer.

(** Lemma T'' at the integers: every k, every N. *)
Theorem Lemma_T''_integers n nu (H : weights n) (Hnu : 0 < nu) N k :
  (1 <= k)%nat -> T n nu N (INR k) <= 2 / (nu ^ 2 * n k).
Proof.
  intros Hk. pose proof (n_pos n H) as Hn.
  destruct (le_lt_dec k N) as [L|L].
  - rewrite T_at_pole by (assumption || lia). lra.
  - assert (HkN : INR N + 1 <= INR k) by (rewrite <- S_INR; apply le_INR; lia).
    pose proof (pos_INR N).
    apply Rle_trans with (1 := Lemma_T'' n nu Hn Hnu N (INR k) ltac:(lra)).
    assert (A : n k <= n 1%nat / INR k) by (apply n_upper; assumption).
    apply Rle_div_r in A; [|lra]. pose proof (W4 n H) as W.
    assert (0 < nu ^ 2) by nra. pose proof (Hn O) as HnO. pose proof (Hn k) as Hnk.
    apply Rle_div_l; [apply Rmult_lt_0_compat; nra|].
    replace (2 / (nu ^ 2 * n k) * (nu ^ 2 * n O * (INR k - INR N)))
      with (2 * n O * (INR k - INR N) / n k) by (field; lra).
    apply Rle_div_r; [exact Hnk|].
    assert (INR k * n k <= n O) by nra. nra.
Qed.
