(** Section 2.2: bounds of the sums R and R' of Lemma T near the pole m, for every N. *)

From Coq Require Import Reals ZArith Lra Lia.
From Coquelicot Require Import Rcomplements.
From SigmaStar Require Import Sums Weights Transfer Squares Enclose.
Local Open Scope R_scope.

(** ** Sums of reciprocals *)

Lemma ln_step a b : 0 < b <= a -> (a - b) / a <= ln a - ln b.
Proof.
  intros Hb. pose proof (ln_le (b / a) ltac:(apply Rdiv_lt_0_compat; lra)) as L.
  unfold Rdiv in L at 1. rewrite ln_mult, ln_Rinv in L; try lra; [|apply Rinv_0_lt_compat; lra].
  replace ((a - b) / a) with (1 - b / a) by (field; lra). lra.
Qed.

Lemma ln_mono a b : 0 < a <= b -> ln a <= ln b.
Proof. intros [Ha [Hb|<-]]; [left; apply ln_increasing; lra | lra]. Qed.

Lemma reciprocals M :
  sum (S M) (fun i => / (INR i + 1)) <= 1 + ln (INR (S M)).
Proof.
  rewrite sum_first. change (INR 0) with 0. replace (/ (0 + 1)) with 1 by field.
  apply Rplus_le_compat_l. apply Rle_trans with (ln (INR (S M)) - ln (INR 1)).
  - apply (sum_telescope M (fun i => / (INR (S i) + 1)) (fun i => ln (INR (S i)))).
    intros i _. pose proof (ln_step (INR (S i) + 1) (INR (S i))) as L.
    pose proof (INR_S_pos i). rewrite (S_INR (S i)).
    replace (/ (INR (S i) + 1)) with ((INR (S i) + 1 - INR (S i)) / (INR (S i) + 1)) by (field; lra).
    apply L. lra.
  - change (INR 1) with 1. rewrite ln_1. lra.
Qed.

Lemma half_reciprocals M :
  sum (S M) (fun i => / (INR i + 1 / 2)) <= 2 + ln (2 * INR (S M) - 1).
Proof.
  rewrite sum_first. change (INR 0) with 0. replace (/ (0 + 1 / 2)) with 2 by field.
  apply Rplus_le_compat_l. apply Rle_trans with (ln (2 * INR (S M) - 1) - ln (2 * INR 1 - 1)).
  - apply (sum_telescope M (fun i => / (INR (S i) + 1 / 2)) (fun i => ln (2 * INR (S i) - 1))).
    intros i _. rewrite !S_INR. pose proof (pos_INR i).
    pose proof (ln_step (2 * (INR i + 1 + 1) - 1) (2 * (INR i + 1) - 1)) as L.
    replace (/ (INR i + 1 + 1 / 2))
      with ((2 * (INR i + 1 + 1) - 1 - (2 * (INR i + 1) - 1)) / (2 * (INR i + 1 + 1) - 1)) by (field; lra).
    apply L. lra.
  - change (INR 1) with 1. replace (2 * 1 - 1) with 1 by ring. rewrite ln_1. lra.
Qed.

(** Both together, as they enter: with M = m - 1. *)
Lemma logarithms M :
  sum M (fun i => / (INR i + 1) + / 2 * / (INR i + 1 / 2)) <= 2.35 + 1.5 * ln (INR M + 1).
Proof.
  destruct M as [|M].
  - simpl sum. change (INR 0) with 0. rewrite Rplus_0_l, ln_1. lra.
  - rewrite sum_plus, sum_scal. pose proof (reciprocals M). pose proof (half_reciprocals M).
    pose proof (INR_S_pos M). assert (1 <= INR (S M)) by (apply (le_INR 1); lia).
    assert (L1 : ln (INR (S M)) <= ln (INR (S M) + 1)) by (apply ln_mono; lra).
    assert (L2 : ln (2 * INR (S M) - 1) <= ln 2 + ln (INR (S M) + 1))
      by (rewrite <- ln_mult by lra; apply ln_mono; lra).
    assert (L3 : ln 2 <= 0.7) by (interval with (i_prec 60)). lra.
Qed.

Section Poles.
Variable n : nat -> R.
Variable nu : R.
Hypothesis H : weights n.

Let n_pos := n_pos n H.

Definition A_ (m : R) : R := (PI ^ 2 - 4) / 2 * n 1%nat + (n O - n 1%nat / 2) / (m - 1 / 2) ^ 2.
Definition Rh (m : R) : R := (n O + n 1%nat * (2.35 + 1.5 * ln m)) / (m - 1 / 2) + n 1%nat / (m * (4 * m - 1)).

(** c_l <= n_1/2 but for l = 0. *)
Lemma c_le l : l <> 0%Z -> c n l <= n 1%nat / 2.
Proof.
  intros Hl. unfold c. destruct (Z.eq_dec l 0); [contradiction|].
  pose proof (n_le_n1 n H (Z.abs_nat l) ltac:(lia)). lra.
Qed.

(** The sum of a function that is 0 but at l = 0. *)
Lemma zsum_at_0 N a : zsum N (fun l => if Z.eq_dec l 0 then a else 0) = a.
Proof.
  unfold zsum, sum1. rewrite sum_zero; [simpl; ring|].
  intros i Hi. destruct (Z.eq_dec (Z.of_nat (S i)) 0); [lia|].
  destruct (Z.eq_dec (- Z.of_nat (S i)) 0); [lia|]. ring.
Qed.

Lemma near m x : (1 <= m)%nat -> Rabs (x - INR m) <= 1 / 2 -> INR m - 1 / 2 <= x <= INR m + 1 / 2 /\ 1 <= INR m.
Proof.
  intros Hm Hx. apply Rabs_le_between in Hx. assert (1 <= INR m) by (apply (le_INR 1); lia). lra.
Qed.

(** R' <= A_m. *)
Theorem Rest'_le m N x :
  (1 <= m <= N)%nat -> Rabs (x - INR m) <= 1 / 2 -> Rest' n (Z.of_nat m) N x <= A_ (INR m).
Proof.
  intros Hm Hx. pose proof (near m x ltac:(lia) Hx) as Hn.
  pose proof (n_pos 1%nat) as H1. pose proof (W4 n H) as H4.
  set (d := x - INR m) in *.
  set (q := fun l => n 1%nat / 2 * / (IZR l - x) ^ 2).
  assert (E1 : Rest' n (Z.of_nat m) N x
               <= zsum N (fun l => without (Z.of_nat m) q l
                            + (if Z.eq_dec l 0 then (n O - n 1%nat / 2) / x ^ 2 else 0))).
  { apply zsum_le. intros l Hl. unfold without. destruct (Z.eq_dec l (Z.of_nat m)) as [->|E].
    - destruct (Z.eq_dec (Z.of_nat m) 0); lia || lra.
    - unfold q. destruct (Z.eq_dec l 0) as [->|E0].
      + unfold c; simpl Z.eq_dec. right. simpl. field. lra.
      + pose proof (c_le l E0). unfold Rdiv at 1. rewrite Rplus_0_r. apply Rmult_le_compat_r; [|assumption].
        assert (0 <= (IZR l - x) ^ 2) by apply pow2_ge_0.
        destruct (Req_dec ((IZR l - x) ^ 2) 0) as [->|E2]; [rewrite Rinv_0; lra|].
        left. apply Rinv_0_lt_compat. lra. }
  rewrite zsum_plus, zsum_at_0 in E1.
  assert (E2 : zsum N (without (Z.of_nat m) q) <= n 1%nat / 2 * (PI ^ 2 - 4)).
  { rewrite (zsum_sides N m) by lia. rewrite without_same.
    assert (U : forall i, without (Z.of_nat m) q (Z.of_nat (m + 1 + i)) = n 1%nat / 2 * / (INR i + 1 - d) ^ 2).
    { intros i. rewrite without_other by lia. unfold q, d.
      rewrite <- INR_IZR_INZ, !plus_INR. change (INR 1) with 1. do 3 f_equal. ring. }
    assert (L : forall i, without (Z.of_nat m) q (Z.of_nat m - 1 - Z.of_nat i) = n 1%nat / 2 * / (INR i + 1 + d) ^ 2).
    { intros i. rewrite without_other by lia. unfold q, d.
      rewrite !minus_IZR, <- !INR_IZR_INZ. do 2 f_equal. ring. }
    rewrite (sum_ext _ _ _ (fun i _ => U i)), (sum_ext _ _ _ (fun i _ => L i)).
    assert (P : forall a i, - (1 / 2) <= a <= 1 / 2 -> 0 <= n 1%nat / 2 * / (INR i + 1 - a) ^ 2).
    { intros a i Ha. pose proof (pos_INR i). apply Rmult_le_pos; [lra|].
      left. apply Rinv_0_lt_compat, pow_lt. lra. }
    assert (Hd : - (1 / 2) <= d <= 1 / 2) by (apply Rabs_le_between; exact Hx).
    pose proof (sum_extend (N - m) (N + m) (fun i => n 1%nat / 2 * / (INR i + 1 - d) ^ 2)
                  ltac:(lia) (fun i _ => P d i Hd)) as X.
    pose proof (distance_squares (N + m) d Hx) as D. rewrite sum_plus in D.
    rewrite !sum_scal in X |- *. nra. }
  assert (E3 : (n O - n 1%nat / 2) / x ^ 2 <= (n O - n 1%nat / 2) / (INR m - 1 / 2) ^ 2).
  { unfold Rdiv. apply Rmult_le_compat_l; [lra|]. apply Rinv_le_contravar; [apply pow_lt; lra|].
    apply pow_incr. lra. }
  unfold A_. lra.
Qed.

(** The sum R: the poles 0 and -m, those below m and those above. *)
Lemma Rest_split m N x :
  (1 <= m <= N)%nat -> Rabs (x - INR m) <= 1 / 2 ->
  let f := fun l => n l * x / (INR l ^ 2 - x ^ 2) in
  Rest n (Z.of_nat m) N x
  = - (n O / x) - n m / 2 / (INR m + x)
    - sum (m - 1) (fun i => n (S i) * x / (x ^ 2 - INR (S i) ^ 2))
    + sum (N - m) (fun i => f (m + 1 + i)%nat).
Proof.
  intros Hm Hx f. pose proof (near m x ltac:(lia) Hx) as Hn.
  unfold Rest, zsum, sum1. rewrite without_other by lia.
  set (F := fun l => c n l / (IZR l - x)).
  replace N with ((m - 1) + S (N - m))%nat at 1 by lia.
  rewrite sum_split, sum_first, Nat.add_0_r.
  replace (Z.of_nat (S (m - 1))) with (Z.of_nat m) by lia.
  rewrite without_same, (without_other _ F (- Z.of_nat m)) by lia.
  assert (Pair : forall l, (1 <= l)%nat -> INR l <> x ->
            F (Z.of_nat l) + F (- Z.of_nat l)%Z = n l * x / (INR l ^ 2 - x ^ 2)).
  { intros l Hl Hlx. unfold F. rewrite c_nat, c_neg, opp_IZR, <- INR_IZR_INZ by lia.
    assert (0 < INR l) by (apply lt_0_INR; lia).
    replace (INR l ^ 2 - x ^ 2) with ((INR l - x) * (INR l + x)) by ring. field. lra. }
  assert (Below : forall i, (i < m - 1)%nat ->
            without (Z.of_nat m) F (Z.of_nat (S i)) + without (Z.of_nat m) F (- Z.of_nat (S i))%Z
            = -1 * (n (S i) * x / (x ^ 2 - INR (S i) ^ 2))).
  { intros i Hi. rewrite !without_other by lia.
    assert (INR (S i) + 1 <= INR m) by (rewrite <- S_INR; apply le_INR; lia).
    pose proof (INR_S_pos i).
    rewrite Pair by (lia || lra).
    replace (INR (S i) ^ 2 - x ^ 2) with (- ((x - INR (S i)) * (x + INR (S i)))) by ring.
    replace (x ^ 2 - INR (S i) ^ 2) with ((x - INR (S i)) * (x + INR (S i))) by ring. field. lra. }
  assert (Above : forall i, (i < N - m)%nat ->
            without (Z.of_nat m) F (Z.of_nat (S (m - 1 + S i))) + without (Z.of_nat m) F (- Z.of_nat (S (m - 1 + S i)))%Z
            = f (m + 1 + i)%nat).
  { intros i Hi. rewrite !without_other by lia. replace (S (m - 1 + S i)) with (m + 1 + i)%nat by lia.
    unfold f. apply Pair; [lia|].
    assert (INR m + 1 <= INR (m + 1 + i)) by (rewrite <- S_INR; apply le_INR; lia). lra. }
  rewrite (sum_ext _ _ _ Below), (sum_ext _ _ _ Above), sum_scal.
  unfold F. rewrite c_neg, opp_IZR, <- INR_IZR_INZ by lia.
  replace (c n 0) with (n O) by reflexivity. field. lra.
Qed.

(** The terms below m. *)
Lemma below_sum m x :
  (1 <= m)%nat -> Rabs (x - INR m) <= 1 / 2 ->
  n O / x + n m / 2 / (INR m + x) + sum (m - 1) (fun i => n (S i) * x / (x ^ 2 - INR (S i) ^ 2))
  <= n O / (INR m - 1 / 2) + n 1%nat / (INR m * (4 * INR m - 1))
     + n 1%nat / (INR m - 1 / 2) * sum (m - 1) (fun i => / (INR i + 1) + / 2 * / (INR i + 1 / 2)).
Proof.
  intros Hm Hx. pose proof (near m x Hm Hx) as Hn. pose proof (n_pos O) as H0. pose proof (n_pos 1%nat) as H1.
  set (y := INR m - 1 / 2) in *. assert (Ey : y = INR m - 1 / 2) by reflexivity.
  assert (B1 : n O / x <= n O / y).
  { unfold Rdiv. apply Rmult_le_compat_l; [lra|]. apply Rinv_le_contravar; unfold y in *; lra. }
  assert (B2 : n m / 2 / (INR m + x) <= n 1%nat / (INR m * (4 * INR m - 1))).
  { pose proof (n_upper n H m Hm) as U. apply Rle_trans with (n 1%nat / INR m / 2 / (INR m + x)).
    - unfold Rdiv. apply Rmult_le_compat_r; [left; apply Rinv_0_lt_compat; lra|]. unfold Rdiv in U. lra.
    - replace (n 1%nat / INR m / 2 / (INR m + x)) with (n 1%nat / INR m * / (2 * (INR m + x))) by (field; lra).
      replace (n 1%nat / (INR m * (4 * INR m - 1))) with (n 1%nat / INR m * / (4 * INR m - 1)) by (field; lra).
      apply Rmult_le_compat_l; [left; apply Rdiv_lt_0_compat; lra|]. apply Rinv_le_contravar; lra. }
  assert (B3 : sum (m - 1) (fun i => n (S i) * x / (x ^ 2 - INR (S i) ^ 2))
               <= n 1%nat / y * sum (m - 1) (fun i => / (INR i + 1) + / 2 * / (INR i + 1 / 2))).
  { apply Rle_trans with (sum (m - 1) (fun i => n 1%nat / y * (/ INR (S i) + / 2 * / (y - INR (S i))))).
    - apply sum_le. intros i Hi.
      assert (INR (S i) + 1 <= INR m) by (rewrite <- S_INR; apply le_INR; lia).
      set (l := INR (S i)) in *. assert (0 < l) by apply INR_S_pos.
      assert (Hy : l < y <= x) by (unfold y; lra).
      pose proof (n_upper n H (S i) ltac:(lia)) as U. fold l in U.
      assert (Q : x / (x ^ 2 - l ^ 2) <= y / (y ^ 2 - l ^ 2)).
      { assert (0 < x ^ 2 - l ^ 2) by nra. assert (0 < y ^ 2 - l ^ 2) by nra.
        apply div_le; [assumption|].
        replace (y / (y ^ 2 - l ^ 2) * (x ^ 2 - l ^ 2)) with (y * (x ^ 2 - l ^ 2) / (y ^ 2 - l ^ 2)) by (field; lra).
        apply le_div; [assumption|].
        replace (y * (x ^ 2 - l ^ 2)) with (x * (y ^ 2 - l ^ 2) + (x - y) * (x * y + l ^ 2)) by ring.
        assert (0 <= (x - y) * (x * y + l ^ 2)) by (apply Rmult_le_pos; nra). lra. }
      replace (n (S i) * x / (x ^ 2 - l ^ 2)) with (n (S i) * (x / (x ^ 2 - l ^ 2))) by (field; nra).
      apply Rle_trans with (n 1%nat / l * (y / (y ^ 2 - l ^ 2))).
      { apply Rmult_le_compat; [left; apply n_pos | | exact U | exact Q].
        left. apply Rdiv_lt_0_compat; nra. }
      replace (n 1%nat / l * (y / (y ^ 2 - l ^ 2)))
        with (n 1%nat / y * (/ l + / 2 * / (y - l)) - n 1%nat / y * / 2 * / (y + l)) by (field; split; [nra | lra]).
      assert (0 <= n 1%nat / y * / 2 * / (y + l)); [|lra].
      repeat apply Rmult_le_pos; try lra; left; apply Rinv_0_lt_compat; lra.
    - rewrite sum_scal. apply Rmult_le_compat_l; [left; apply Rdiv_lt_0_compat; unfold y; lra|].
      right. rewrite !sum_plus, !sum_scal. f_equal; [|f_equal].
      + apply sum_ext. intros i _. rewrite S_INR. reflexivity.
      + rewrite sum_rev. apply sum_ext. intros i Hi. f_equal. unfold y.
        rewrite S_INR, !minus_INR by lia. change (INR 1) with 1. field. }
  lra.
Qed.

Lemma below_le m x :
  (1 <= m)%nat -> Rabs (x - INR m) <= 1 / 2 ->
  n O / x + n m / 2 / (INR m + x) + sum (m - 1) (fun i => n (S i) * x / (x ^ 2 - INR (S i) ^ 2)) <= Rh (INR m).
Proof.
  intros Hm Hx. pose proof (near m x Hm Hx) as Hn. pose proof (n_pos 1%nat) as H1.
  apply Rle_trans with (1 := below_sum m x Hm Hx). set (y := INR m - 1 / 2) in *.
  pose proof (logarithms (m - 1)) as L. rewrite minus_INR in L by lia. change (INR 1) with 1 in L.
  replace (INR m - 1 + 1) with (INR m) in L by ring. assert (Ey : y = INR m - 1 / 2) by reflexivity.
  assert (B : n 1%nat / y * sum (m - 1) (fun i => / (INR i + 1) + / 2 * / (INR i + 1 / 2))
              <= n 1%nat / y * (2.35 + 1.5 * ln (INR m))).
  { apply Rmult_le_compat_l; [left; apply Rdiv_lt_0_compat; lra | exact L]. }
  unfold Rh. fold y. replace ((n O + n 1%nat * (2.35 + 1.5 * ln (INR m))) / y)
    with (n O / y + n 1%nat / y * (2.35 + 1.5 * ln (INR m))) by (field; lra). lra.
Qed.

(** The terms above m. *)
Lemma above_sum m N x :
  (1 <= m <= N)%nat -> Rabs (x - INR m) <= 1 / 2 ->
  sum (N - m) (fun i => n (m + 1 + i)%nat * x / (INR (m + 1 + i) ^ 2 - x ^ 2))
  <= n 1%nat / 2 * (2 / (INR m + 1) + ln (2 * (INR m + 1)) / (INR m + 1 / 2)).
Proof.
  intros Hm Hx. pose proof (near m x ltac:(lia) Hx) as Hn. pose proof (n_pos 1%nat) as H1.
  pose proof (W4 n H) as H4. set (y := INR m + 1 / 2). set (M := INR m) in *.
  assert (Term : forall i, n (m + 1 + i)%nat * x / (INR (m + 1 + i) ^ 2 - x ^ 2)
                           <= n 1%nat / 2 * / ((M + 1 + INR i - y) * (M + 1 + INR i))).
  { intros i. rewrite !plus_INR. change (INR 1) with 1. fold M. pose proof (pos_INR i).
    pose proof (n_upper n H (m + 1 + i) ltac:(lia)) as U. rewrite !plus_INR in U. change (INR 1) with 1 in U. fold M in U.
    set (l := M + 1 + INR i) in *. assert (Hl : y < l) by (unfold y, l; lra). assert (Hxy : x <= y) by (unfold y; lra).
    assert (0 < l ^ 2 - x ^ 2) by nra.
    replace (n (m + 1 + i)%nat * x / (l ^ 2 - x ^ 2)) with (n (m + 1 + i)%nat * (x / (l ^ 2 - x ^ 2))) by (field; lra).
    replace (n 1%nat / 2 * / ((l - y) * l)) with (n 1%nat / l * (/ (2 * (l - y)))) by (field; lra).
    apply Rmult_le_compat; [left; apply n_pos | left; apply Rdiv_lt_0_compat; lra | exact U |].
    apply div_le; [assumption|].
    replace (/ (2 * (l - y)) * (l ^ 2 - x ^ 2)) with ((l ^ 2 - x ^ 2) / (2 * (l - y))) by (field; lra).
    apply le_div; [lra|]. nra. }
  apply Rle_trans with (1 := sum_le _ _ _ (fun i _ => Term i)). rewrite sum_scal.
  assert (Sum : forall J, sum J (fun i => / ((M + 1 + INR i - y) * (M + 1 + INR i)))
                          <= 2 / (M + 1) + ln (2 * (M + 1)) / y).
  { intros [|J].
    - simpl sum. assert (0 <= ln (2 * (M + 1))) by (rewrite <- ln_1; apply ln_mono; lra).
      assert (0 < 2 / (M + 1)) by (apply Rdiv_lt_0_compat; lra).
      assert (0 <= ln (2 * (M + 1)) / y); [|lra].
      apply Rmult_le_pos; [lra|]. left. apply Rinv_0_lt_compat. unfold y; lra.
    - rewrite sum_first. change (INR 0) with 0.
      replace (/ ((M + 1 + 0 - y) * (M + 1 + 0))) with (2 / (M + 1)) by (unfold y; field; lra).
      apply Rplus_le_compat_l.
      pose proof (sum_telescope J (fun i => / ((M + 1 + INR (S i) - y) * (M + 1 + INR (S i))))
                    (fun i => (ln (M + 1 + INR i - y) - ln (M + 1 + INR i)) / y)) as Tl.
      apply Rle_trans with (1 := Tl ltac:(
        intros i _; cbv beta; rewrite S_INR; pose proof (pos_INR i);
        set (s := M + 1 + (INR i + 1)) in *; replace (M + 1 + INR i) with (s - 1) by (unfold s; ring);
        assert (Hs : y + 1 < s) by (unfold y, s; lra);
        pose proof (ln_step ((s - y) * (s - 1)) ((s - 1 - y) * s)) as L;
        rewrite !ln_mult in L by (unfold y in *; lra);
        replace ((ln (s - y) - ln s) / y - (ln (s - 1 - y) - ln (s - 1)) / y)
          with ((ln (s - y) + ln (s - 1) - (ln (s - 1 - y) + ln s)) / y) by (field; unfold y; lra);
        apply le_div; [unfold y; lra|];
        apply Rle_trans with (2 := L ltac:(unfold y in *; nra));
        replace (((s - y) * (s - 1) - (s - 1 - y) * s) / ((s - y) * (s - 1))) with (y * (/ (s - y) * / (s - 1)))
          by (field; unfold y in *; lra);
        replace (/ ((s - y) * s) * y) with (y * (/ (s - y) * / s)) by (field; unfold y in *; lra);
        apply Rmult_le_compat_l; [unfold y; lra|];
        apply Rmult_le_compat_l; [left; apply Rinv_0_lt_compat; lra|];
        apply Rinv_le_contravar; unfold y in *; lra)).
      change (INR 0) with 0. rewrite Rplus_0_r.
      pose proof (pos_INR J).
      assert (L1 : ln (M + 1 + INR J - y) <= ln (M + 1 + INR J)) by (apply ln_mono; unfold y; lra).
      replace (M + 1 - y) with (/ 2) by (unfold y; field).
      rewrite ln_Rinv by lra. rewrite ln_mult by lra.
      replace ((ln (M + 1 + INR J - y) - ln (M + 1 + INR J)) / y - (- ln 2 - ln (M + 1)) / y)
        with ((ln (M + 1 + INR J - y) - ln (M + 1 + INR J) + (ln 2 + ln (M + 1))) / y) by (field; unfold y; lra).
      unfold Rdiv. apply Rmult_le_compat_r; [left; apply Rinv_0_lt_compat; unfold y; lra|]. lra. }
  apply Rmult_le_compat_l; [lra | apply Sum].
Qed.

Lemma above_le m N x :
  (1 <= m <= N)%nat -> Rabs (x - INR m) <= 1 / 2 ->
  sum (N - m) (fun i => n (m + 1 + i)%nat * x / (INR (m + 1 + i) ^ 2 - x ^ 2)) <= Rh (INR m).
Proof.
  intros Hm Hx. pose proof (near m x ltac:(lia) Hx) as Hn. pose proof (n_pos 1%nat) as H1.
  pose proof (W4 n H) as H4. apply Rle_trans with (1 := above_sum m N x Hm Hx).
  set (y := INR m + 1 / 2). set (M := INR m) in *.
  assert (L1 : ln (2 * (M + 1)) <= 1.4 + ln M).
  { apply Rle_trans with (ln (4 * M)); [apply ln_mono; lra|]. rewrite ln_mult by lra.
    assert (ln 4 <= 1.4) by (interval with (i_prec 60)). lra. }
  assert (L2 : 0 <= ln M) by (rewrite <- ln_1; apply ln_mono; lra).
  assert (Q : n 1%nat / 2 * (2 / (M + 1) + ln (2 * (M + 1)) / y)
              <= (n O + n 1%nat * (2.35 + 1.5 * ln M)) / (M - 1 / 2)).
  { apply le_div; [lra|].
    assert (Y1 : (M - 1 / 2) / (M + 1) <= 1) by (apply div_le; lra).
    assert (Y2 : (M - 1 / 2) / y <= 1) by (apply div_le; unfold y; lra).
    assert (Y3 : 0 <= (M - 1 / 2) / y) by (left; apply Rdiv_lt_0_compat; unfold y; lra).
    replace (n 1%nat / 2 * (2 / (M + 1) + ln (2 * (M + 1)) / y) * (M - 1 / 2))
      with (n 1%nat * ((M - 1 / 2) / (M + 1) + ln (2 * (M + 1)) / 2 * ((M - 1 / 2) / y))) by (field; unfold y; lra).
    assert (Z : (M - 1 / 2) / (M + 1) + ln (2 * (M + 1)) / 2 * ((M - 1 / 2) / y) <= 1 + (1.4 + ln M) / 2).
    { apply Rplus_le_compat; [exact Y1|].
      apply Rle_trans with ((1.4 + ln M) / 2 * ((M - 1 / 2) / y)).
      - apply Rmult_le_compat_r; [exact Y3 | lra].
      - rewrite <- (Rmult_1_r ((1.4 + ln M) / 2)) at 2. apply Rmult_le_compat_l; [lra | exact Y2]. }
    apply Rle_trans with (n 1%nat * (1 + (1.4 + ln M) / 2)); [apply Rmult_le_compat_l; lra|]. nra. }
  assert (0 < n 1%nat / (M * (4 * M - 1))) by (apply Rdiv_lt_0_compat; [lra | nra]).
  unfold Rh. fold M. lra.
Qed.

(** |R| <= Rh_m. *)
Theorem Rest_le m N x :
  (1 <= m <= N)%nat -> Rabs (x - INR m) <= 1 / 2 -> Rabs (Rest n (Z.of_nat m) N x) <= Rh (INR m).
Proof.
  intros Hm Hx. rewrite (Rest_split m N x Hm Hx). pose proof (near m x ltac:(lia) Hx) as Hn.
  pose proof (below_le m x ltac:(lia) Hx) as B. pose proof (above_le m N x Hm Hx) as U.
  set (b := n O / x + n m / 2 / (INR m + x) + sum (m - 1) (fun i => n (S i) * x / (x ^ 2 - INR (S i) ^ 2))) in *.
  set (u := sum (N - m) (fun i => n (m + 1 + i)%nat * x / (INR (m + 1 + i) ^ 2 - x ^ 2))) in *.
  assert (Hb : 0 <= b).
  { unfold b. pose proof (n_pos O). pose proof (n_pos m).
    assert (0 < n O / x) by (apply Rdiv_lt_0_compat; lra).
    assert (0 < n m / 2 / (INR m + x)) by (repeat apply Rdiv_lt_0_compat; lra).
    assert (0 <= sum (m - 1) (fun i => n (S i) * x / (x ^ 2 - INR (S i) ^ 2))); [|lra].
    apply sum_nonneg. intros i Hi.
    assert (INR (S i) + 1 <= INR m) by (rewrite <- S_INR; apply le_INR; lia). pose proof (INR_S_pos i).
    pose proof (n_pos (S i)). left. apply Rdiv_lt_0_compat; nra. }
  assert (Hu : 0 <= u).
  { apply sum_nonneg. intros i Hi. pose proof (n_pos (m + 1 + i)%nat).
    assert (INR m + 1 <= INR (m + 1 + i)) by (rewrite <- S_INR; apply le_INR; lia).
    left. apply Rdiv_lt_0_compat; nra. }
  apply Rabs_le_between. unfold b in *. lra.
Qed.

End Poles.
