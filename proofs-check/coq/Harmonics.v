(** Sections 3 and 10.2: bounds of sup|e| from those of the harmonics, for every number J of them. The rms of a signal of J
    harmonics is that of its amplitudes by definition: Parseval is not used. *)

From Coq Require Import Reals ZArith Lra Lia.
From Coquelicot Require Import Coquelicot.
From SigmaStar Require Import Sums Squares Transfers.
Local Open Scope R_scope.

(** The sum of 1/j^2 is at most pi^2/6. *)
Lemma even_odd J f : sum (2 * J) f = sum J (fun i => f (2 * i)%nat) + sum J (fun i => f (2 * i + 1)%nat).
Proof.
  induction J as [|J IH]; [simpl; ring|].
  replace (2 * S J)%nat with (S (S (2 * J))) by lia. cbn [sum]. rewrite IH.
  replace (S (2 * J)) with (2 * J + 1)%nat by lia. ring.
Qed.

Theorem squares J : sum J (fun j => / INR (S j) ^ 2) <= PI ^ 2 / 6.
Proof.
  assert (Pos : forall j, 0 < INR (S j)) by (intros; apply lt_0_INR; lia).
  assert (Ext : sum J (fun j => / INR (S j) ^ 2) <= sum (2 * J) (fun j => / INR (S j) ^ 2)).
  { apply sum_extend; [lia|]. intros i _. left. apply Rinv_0_lt_compat, pow_lt, Pos. }
  rewrite even_odd in Ext.
  rewrite (sum_ext J (fun i => / INR (S (2 * i)) ^ 2) (fun i => / 4 * / (INR i + 1 / 2) ^ 2)) in Ext.
  2:{ intros i _. rewrite S_INR, mult_INR. change (INR 2) with 2. pose proof (pos_INR i). field. lra. }
  rewrite (sum_ext J (fun i => / INR (S (2 * i + 1)) ^ 2) (fun i => / 4 * / INR (S i) ^ 2)) in Ext.
  2:{ intros i _. replace (S (2 * i + 1)) with (2 * S i)%nat by lia. rewrite mult_INR. change (INR 2) with 2.
      pose proof (Pos i). field. lra. }
  rewrite !sum_scal in Ext. pose proof (half_squares J). lra.
Qed.

Section Harmonics.
Variables T sigma : R.
Hypothesis T_pos : 0 < T.
Hypothesis sigma_pos : 0 < sigma.

Definition om (j : nat) : R := 2 * PI * INR j / T.

Lemma om_pos j : 0 < om (S j).
Proof.
  pose proof PI_RGT_0. pose proof (lt_0_INR (S j) ltac:(lia)). unfold om.
  apply Rdiv_lt_0_compat; [nra | exact T_pos].
Qed.

(** The first J terms (and their mirror images) of bt^2 and tau^2. *)
Definition bt2 (J : nat) : R := 2 * sum J (fun j => / (sigma ^ 2 + om (S j) ^ 2)).
Definition tau2 (J : nat) : R := 2 * sum J (fun j => / (om (S j) ^ 2 * (sigma ^ 2 + om (S j) ^ 2))).

Lemma inverse_om_squares J : 2 * sum J (fun j => / om (S j) ^ 2) <= T ^ 2 / 12.
Proof.
  pose proof PI_RGT_0 as Hpi. rewrite (sum_ext J _ (fun j => T ^ 2 / (4 * PI ^ 2) * / INR (S j) ^ 2)).
  - rewrite sum_scal. pose proof (squares J) as Q.
    assert (0 < T ^ 2 / (4 * PI ^ 2)) by (apply Rdiv_lt_0_compat; nra).
    assert (T ^ 2 / (4 * PI ^ 2) * sum J (fun j => / INR (S j) ^ 2) <= T ^ 2 / (4 * PI ^ 2) * (PI ^ 2 / 6))
      by (apply Rmult_le_compat_l; lra).
    replace (T ^ 2 / 12) with (2 * (T ^ 2 / (4 * PI ^ 2) * (PI ^ 2 / 6))) by (field; lra). lra.
  - intros j _. unfold om. pose proof (lt_0_INR (S j) ltac:(lia)). field. repeat split; lra.
Qed.

(** bt^2 <= T^2/12. *)
Theorem bt_bound J : bt2 J <= T ^ 2 / 12.
Proof.
  apply Rle_trans with (2 := inverse_om_squares J). unfold bt2. apply Rmult_le_compat_l; [lra|].
  apply sum_le. intros j _. pose proof (om_pos j). apply Rinv_le_contravar; nra.
Qed.

(** tau <= T/(sqrt(12) sigma). *)
Theorem tau_bound J : tau2 J <= T ^ 2 / (12 * sigma ^ 2).
Proof.
  replace (T ^ 2 / (12 * sigma ^ 2)) with (/ sigma ^ 2 * (T ^ 2 / 12)) by (field; lra).
  apply Rle_trans with (/ sigma ^ 2 * (2 * sum J (fun j => / om (S j) ^ 2))).
  - unfold tau2. replace (/ sigma ^ 2 * (2 * sum J (fun j => / om (S j) ^ 2)))
      with (2 * (/ sigma ^ 2 * sum J (fun j => / om (S j) ^ 2))) by ring.
    rewrite <- (sum_scal J (/ sigma ^ 2)). apply Rmult_le_compat_l; [lra|]. apply sum_le. intros j _. pose proof (om_pos j).
    rewrite <- Rinv_mult. assert (0 < sigma ^ 2) by nra. assert (0 < om (S j) ^ 2) by nra.
    apply Rinv_le_contravar; nra.
  - apply Rmult_le_compat_l; [left; apply Rinv_0_lt_compat; nra | apply inverse_om_squares].
Qed.

(** A signal of J harmonics without mean, and its mean square, by definition this sum. *)
Definition signal (c : nat -> C) (J : nat) (t : R) : R :=
  sum J (fun j => 2 * (fst (c j) * cos (om (S j) * t) - snd (c j) * sin (om (S j) * t))).
Definition rms2 (c : nat -> C) (J : nat) : R := 2 * sum J (fun j => Cmod (c j) ^ 2).

Lemma one_harmonic (c : C) a : fst c * cos a - snd c * sin a <= Cmod c.
Proof.
  apply square_le; [apply Cmod_ge_0|]. rewrite Cmod2. pose proof (sin2_cos2 a) as E. unfold Rsqr in E.
  pose proof (pow2_ge_0 (fst c * sin a + snd c * cos a)).
  replace (fst c ^ 2 + snd c ^ 2) with ((fst c ^ 2 + snd c ^ 2) * (sin a * sin a + cos a * cos a)) by (rewrite E; ring).
  nra.
Qed.

(** Cauchy and Schwarz over the harmonics: |c_j| <= f_j |q_j| gives sup|e| <= sqrt(2 sum f_j^2) rms(q). *)
Theorem sup_from_harmonics (e q : nat -> C) (f : nat -> R) J t :
  (forall j, (j < J)%nat -> 0 <= f j) ->
  (forall j, (j < J)%nat -> Cmod (e j) <= f j * Cmod (q j)) ->
  Rabs (signal e J t) <= sqrt (2 * sum J (fun j => f j ^ 2)) * sqrt (rms2 q J).
Proof.
  intros Hf He.
  assert (B : Rabs (signal e J t) <= 2 * sum J (fun j => f j * Cmod (q j))).
  { rewrite <- sum_scal. apply Rabs_le_between. split.
    - apply Ropp_le_cancel. rewrite Ropp_involutive. unfold signal.
      replace (- sum J (fun j => 2 * (fst (e j) * cos (om (S j) * t) - snd (e j) * sin (om (S j) * t))))
        with (-1 * sum J (fun j => 2 * (fst (e j) * cos (om (S j) * t) - snd (e j) * sin (om (S j) * t)))) by ring.
      rewrite <- sum_scal. apply sum_le. intros j Hj. pose proof (He j Hj).
      pose proof (one_harmonic (Copp (e j)) (om (S j) * t)) as O. rewrite Cmod_opp in O. simpl in O. lra.
    - apply sum_le. intros j Hj. pose proof (He j Hj). pose proof (one_harmonic (e j) (om (S j) * t)). lra. }
  apply Rle_trans with (1 := B).
  assert (P1 : 0 <= 2 * sum J (fun j => f j ^ 2)).
  { apply Rmult_le_pos; [lra|]. apply sum_nonneg. intros; apply pow2_ge_0. }
  assert (P2 : 0 <= rms2 q J).
  { apply Rmult_le_pos; [lra|]. apply sum_nonneg. intros; apply pow2_ge_0. }
  rewrite <- sqrt_mult by assumption. apply square_le; [apply sqrt_pos|].
  rewrite <- (Rsqr_pow2 (sqrt _)), Rsqr_sqrt by (apply Rmult_le_pos; assumption).
  pose proof (cauchy_schwarz J f (fun j => Cmod (q j))) as CS. unfold rms2. nra.
Qed.

(** 10.2: sup|e| <= bt rms(q), for every number of oscillators (eta is G/i at each harmonic; where G has a pole, e_j = 0). *)
Theorem sup_e (e q : nat -> C) (mu : R) (eta : nat -> R) J t :
  (forall j, (j < J)%nat -> (denominator sigma (om (S j)) mu 1 (eta j) 0 * e j)%C = q j \/ e j = RtoC 0) ->
  Rabs (signal e J t) <= sqrt (bt2 J) * sqrt (rms2 q J).
Proof.
  intros E. unfold bt2.
  rewrite (sum_ext J (fun j => / (sigma ^ 2 + om (S j) ^ 2)) (fun j => (/ sqrt (sigma ^ 2 + om (S j) ^ 2)) ^ 2)).
  2:{ intros j _. rewrite pow_inv, <- (Rsqr_pow2 (sqrt _)), Rsqr_sqrt; [reflexivity|]. pose proof (pow2_ge_0 (om (S j))). nra. }
  assert (P : forall j, 0 < / sqrt (sigma ^ 2 + om (S j) ^ 2)).
  { intros j. apply Rinv_0_lt_compat, sqrt_lt_R0. pose proof (pow2_ge_0 (om (S j))). nra. }
  apply sup_from_harmonics.
  - intros j _. left. apply P.
  - intros j Hj. destruct (E j Hj) as [Ej|Ej].
    + rewrite Rmult_comm. apply (e_bound_unit sigma (om (S j)) mu 1 (eta j) sigma_pos (e j) (q j) eq_refl Ej).
    + rewrite Ej, Cmod_0. apply Rmult_le_pos; [left; apply P | apply Cmod_ge_0].
Qed.

(** 10.2: sup|e| <= tau rms(q'), where q' has the harmonics om_j |q_j|. *)
Theorem sup_e_derivative (e q dq : nat -> C) (mu : R) (eta : nat -> R) J t :
  (forall j, (j < J)%nat -> (denominator sigma (om (S j)) mu 1 (eta j) 0 * e j)%C = q j \/ e j = RtoC 0) ->
  (forall j, (j < J)%nat -> Cmod (dq j) = om (S j) * Cmod (q j)) ->
  Rabs (signal e J t) <= sqrt (tau2 J) * sqrt (rms2 dq J).
Proof.
  intros E Ed. unfold tau2.
  assert (So : forall j, 0 < sigma ^ 2 + om (S j) ^ 2) by (intros j; pose proof (pow2_ge_0 (om (S j))); nra).
  rewrite (sum_ext J (fun j => / (om (S j) ^ 2 * (sigma ^ 2 + om (S j) ^ 2)))
             (fun j => (/ (om (S j) * sqrt (sigma ^ 2 + om (S j) ^ 2))) ^ 2)).
  2:{ intros j _. rewrite pow_inv, Rpow_mult_distr, <- (Rsqr_pow2 (sqrt _)), Rsqr_sqrt; [reflexivity|]. left; apply So. }
  assert (P : forall j, 0 < / (om (S j) * sqrt (sigma ^ 2 + om (S j) ^ 2))).
  { intros j. apply Rinv_0_lt_compat, Rmult_lt_0_compat; [apply om_pos | apply sqrt_lt_R0, So]. }
  apply sup_from_harmonics.
  - intros j _. left. apply P.
  - intros j Hj. rewrite (Ed j Hj). pose proof (om_pos j). pose proof (sqrt_lt_R0 _ (So j)). destruct (E j Hj) as [Ej|Ej].
    + apply Rle_trans with (1 := e_bound_unit sigma (om (S j)) mu 1 (eta j) sigma_pos (e j) (q j) eq_refl Ej).
      right. field. split; lra.
    + rewrite Ej, Cmod_0. apply Rmult_le_pos; [left; apply P | apply Rmult_le_pos; [lra | apply Cmod_ge_0]].
Qed.

End Harmonics.
