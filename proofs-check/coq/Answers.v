(** Sections 3, 10.2, 10.4, 13.1 and 13.5: the answers e_j, y_j, u_j of the loop itself to one harmonic q_j of the frequency om. Away
    from the poles of G, e_j is q_j over the denominator of [Transfers] with G = (i/w) g_N; at the poles e_j = y_j = 0. So the bounds
    of [Transfers] and [Harmonics] hold at every frequency om >= 0, for every number N of oscillators. *)

From Coq Require Import Reals ZArith Lra Lia.
From Coquelicot Require Import Coquelicot.
From SigmaStar Require Import Sums Transfer Transfers Harmonics Response.
Local Open Scope R_scope.

Section Answers.
Variable n : nat -> R.
Variables w mu sigma b kap om : R.
Hypothesis w_pos : 0 < w.
Hypothesis sigma_pos : 0 < sigma.
Hypothesis b_pos : 0 < b.
Hypothesis kap_nonneg : 0 <= kap.
Hypothesis om_nonneg : 0 <= om.
Variable N : nat.

(** Complex amplitudes of z (a component 0 and N pairs), e and q. *)
Variables (z0 : C) (za zb : nat -> C) (e q : C).

(** M'N zeta with zeta = z - M e, and u = -sigma e + mu M'N zeta. *)
Definition s_a : C := s_c n N (z0 - e)%C (fun l => (za l - e)%C).
Definition u_a : C := (- sigma * e + mu * s_a)%C.

(** The loop of [Loop] for signals e^(i om t): e' = q + b u and z' = Phi z - (Phi + sigma I) M e. With kap the input is q - kap e
    (10.4); without it kap = 0. *)
Record loop_answers : Prop := {
  la_e : (Ci * om * e = q - kap * e + b * u_a)%C;
  la_0 : (Ci * om * z0 = - sigma * e)%C;
  la_a : forall l, (1 <= l <= N)%nat -> (Ci * om * za l = (INR l * w)%R * zb l - sigma * e)%C;
  la_b : forall l, (1 <= l <= N)%nat -> (Ci * om * zb l = - ((INR l * w)%R * za l) + (INR l * w)%R * e)%C
}.

Hypothesis H : loop_answers.

(** y = (i om + sigma) e is v + b mu s, where v = q - kap e + (1-b) sigma e. *)
Definition y_a : C := ((Ci * om + sigma) * e)%C.
Let v : C := (q - kap * e + ((1 - b) * sigma)%R * e)%C.

Lemma y_a_is : y_c n (b * mu) N (z0 - e)%C (fun l => (za l - e)%C) v = y_a.
Proof.
  unfold y_a, y_c, v. fold s_a.
  replace ((Ci * om + sigma) * e)%C with (Ci * om * e + sigma * e)%C by ring. rewrite (la_e H). unfold u_a.
  rewrite !RtoC_mult, RtoC_minus. ring.
Qed.

Lemma zeta_answers : answers n w (b * mu) om N (z0 - e)%C (fun l => (za l - e)%C) zb v.
Proof.
  split.
  - rewrite y_a_is. unfold y_a. replace (Ci * om * (z0 - e))%C with (Ci * om * z0 - Ci * om * e)%C by ring. rewrite (la_0 H). ring.
  - intros l Hl. rewrite y_a_is. unfold y_a. replace (Ci * om * (za l - e))%C with (Ci * om * za l - Ci * om * e)%C by ring.
    rewrite (la_a H l Hl). ring.
  - intros l Hl. rewrite (la_b H l Hl). ring.
Qed.

(** G/i at this frequency. *)
Definition eta_ : R := g n N (om / w) / w.

Lemma denominator_nonzero : denominator sigma om mu b eta_ kap <> RtoC 0.
Proof.
  intros E. pose proof (denominator_min sigma om mu b eta_ kap) as M. rewrite E, Cmod_0 in M.
  assert (0 < (b * sigma + kap) * sigma + om ^ 2).
  { assert (0 < b * sigma) by (apply Rmult_lt_0_compat; assumption). pose proof (pow2_ge_0 om). nra. }
  nra.
Qed.

(** Away from the poles. *)
Lemma answer_equation : regular N (om / w) -> (denominator sigma om mu b eta_ kap * e)%C = q.
Proof.
  intros Reg. destruct (response_regular n w (b * mu) om w_pos om_nonneg N _ _ _ _ zeta_answers Reg) as [Es _].
  rewrite y_a_is in Es. fold s_a in Es.
  assert (Eg : s_a = (- (Ci * eta_) * y_a)%C).
  { rewrite Es. unfold eta_. apply injective_projections; simpl; field; lra. }
  pose proof (la_e H) as E. unfold u_a in E. rewrite Eg in E. unfold y_a in E.
  assert (E' : q = (Ci * om * e + kap * e - b * (- sigma * e + mu * (- (Ci * eta_) * ((Ci * om + sigma) * e))))%C).
  { rewrite E. ring. }
  rewrite E'. unfold denominator. rewrite RtoC_plus, !RtoC_mult. ring.
Qed.

Theorem answer_regular : regular N (om / w) -> e = (q / denominator sigma om mu b eta_ kap)%C.
Proof.
  intros Reg. rewrite <- (answer_equation Reg). field. apply denominator_nonzero.
Qed.

(** At the poles 0, w, ..., Nw of G. *)
Theorem answer_pole : (exists m, (m <= N)%nat /\ om = INR m * w) -> y_a = RtoC 0 /\ e = RtoC 0.
Proof.
  intros [m [Hm Em]].
  assert (Ex : om / w = INR m) by (rewrite Em; field; lra).
  assert (Ey : y_a = RtoC 0).
  { rewrite <- y_a_is. destruct m as [|m].
    - destruct (response_zero n w (b * mu) om w_pos om_nonneg N _ _ _ _ zeta_answers Ex) as [Y1 [Y2 _]].
      apply injective_projections; assumption.
    - destruct (response_pole n w (b * mu) om w_pos om_nonneg N _ _ _ _ zeta_answers (S m) ltac:(lia) Ex) as [Y1 [Y2 _]].
      apply injective_projections; assumption. }
  split; [exact Ey|]. unfold y_a in Ey. destruct (Ceq_dec e 0) as [E|E]; [exact E|]. exfalso.
  assert (Hd : (Ci * om + sigma)%C <> RtoC 0).
  { intros D. apply (f_equal fst) in D. simpl in D. lra. }
  exact (Cmult_neq_0 _ _ Hd E Ey).
Qed.

(** At every frequency. *)
Theorem answer : (denominator sigma om mu b eta_ kap * e)%C = q \/ e = RtoC 0.
Proof.
  destruct (frequencies w om w_pos om_nonneg N) as [Ex|[[m [Hm Ex]]|Reg]].
  - right. apply answer_pole. exists O. split; [lia|]. rewrite <- (Rmult_1_r om). simpl.
    apply (Rmult_eq_reg_r (/ w)); [|apply Rinv_neq_0_compat; lra]. unfold Rdiv in Ex. lra.
  - right. apply answer_pole. exists m. split; [lia|]. rewrite <- Ex. field. lra.
  - left. apply answer_equation, Reg.
Qed.

(** So every bound of [Transfers] holds of the loop's own answer at every frequency. *)
Theorem om_e_answer : Rabs om * Cmod e <= d_ b * Cmod q.
Proof.
  destruct answer as [E|E].
  - exact (om_e_bound sigma om mu b eta_ sigma_pos e q kap b_pos kap_nonneg E).
  - rewrite E, Cmod_0, Rmult_0_r. apply Rmult_le_pos; [|apply Cmod_ge_0]. unfold d_. destruct (Rle_dec (1 / 2) b) as [B|B]; [lra|].
    left. apply Rinv_0_lt_compat. apply Rmult_lt_0_compat; [lra|]. apply sqrt_lt_R0, Rmult_lt_0_compat; lra.
Qed.

Theorem e_answer_kap b_lo : 0 < b_lo <= b -> Cmod e <= g_k sigma b_lo kap * Cmod q.
Proof.
  intros Hb. destruct answer as [E|E].
  - exact (e_bound_kap sigma om mu b eta_ sigma_pos e q b_lo kap Hb kap_nonneg E).
  - rewrite E, Cmod_0. apply Rmult_le_pos; [|apply Cmod_ge_0].
    assert (0 < b_lo * sigma) by (apply Rmult_lt_0_compat; lra).
    unfold g_k. destruct (Rle_dec kap ((2 - b_lo) * sigma)) as [B|B]; left; apply Rinv_0_lt_compat; [lra|].
    apply Rmult_lt_0_compat; [lra|]. apply sqrt_lt_R0, Rmult_lt_0_compat; [lra|]. apply Rnot_le_lt in B. lra.
Qed.

(** Without kap. *)
Theorem e_answer : kap = 0 -> Cmod e <= Cmod q * sqrt (sigma ^ 2 + om ^ 2) / (b * sigma ^ 2 + om ^ 2).
Proof.
  intros K. destruct answer as [E|E].
  - rewrite K in E. exact (e_bound sigma om mu b eta_ sigma_pos e q b_pos E).
  - rewrite E, Cmod_0. apply Rmult_le_pos; [apply Rmult_le_pos; [apply Cmod_ge_0 | apply sqrt_pos]|].
    left. apply Rinv_0_lt_compat. assert (0 < b * sigma ^ 2) by (apply Rmult_lt_0_compat; nra). pose proof (pow2_ge_0 om). lra.
Qed.

(** |y_j| <= |q_j|/c_b; with b = 1, c_b = 1: |S| <= 1. *)
Theorem y_answer : kap = 0 -> c2_ b * Cmod y_a ^ 2 <= Cmod q ^ 2.
Proof.
  intros K. pose proof (c2_pos b b_pos) as Hc. destruct answer as [E|E].
  - rewrite K in E. pose proof (y_bound sigma om mu b eta_ e q y_a b_pos E eq_refl) as B.
    set (Y2 := (b * mu * eta_) ^ 2) in *. assert (HY : 0 <= Y2) by apply pow2_ge_0.
    apply Rle_trans with (c2_ b * (Cmod q ^ 2 / (c2_ b * (1 + Y2)))); [apply Rmult_le_compat_l; lra|].
    replace (c2_ b * (Cmod q ^ 2 / (c2_ b * (1 + Y2)))) with (Cmod q ^ 2 / (1 + Y2)) by (field; lra).
    apply div_le; [lra|]. pose proof (pow2_ge_0 (Cmod q)). nra.
  - unfold y_a. rewrite E, Cmult_0_r, Cmod_0. pose proof (pow2_ge_0 (Cmod q)). lra.
Qed.

Theorem u_answer : kap = 0 -> Cmod u_a <= sqrt (lam b) * Cmod q / b.
Proof.
  intros K. pose proof (la_e H) as Ee. rewrite K in Ee.
  assert (Eu : (Ci * om * e = q + b * u_a)%C) by (rewrite Ee; ring).
  destruct answer as [E|E].
  - rewrite K in E. exact (u_bound sigma om mu b eta_ sigma_pos e q u_a b_pos E Eu).
  - rewrite E, Cmult_0_r in Eu.
    assert (Ebu : (b * u_a = - q)%C) by (replace (b * u_a)%C with (q + b * u_a - q)%C by ring; rewrite <- Eu; ring).
    assert (M : b * Cmod u_a = Cmod q) by (rewrite <- (Cmod_opp q), <- Ebu, Cmod_mult, Cmod_R, Rabs_right; lra).
    assert (L : 1 <= sqrt (lam b)).
    { rewrite <- sqrt_1. apply sqrt_le_1_alt. unfold lam.
      assert (1 <= sqrt (1 + 8 * b)) by (rewrite <- sqrt_1 at 1; apply sqrt_le_1_alt; lra).
      assert (0 < 2 / (4 * b - 1 + sqrt (1 + 8 * b))) by (apply Rdiv_lt_0_compat; lra). lra. }
    apply le_div; [exact b_pos|]. rewrite Rmult_comm, M. pose proof (Cmod_ge_0 q). nra.
Qed.

End Answers.

(** 10.2 for the loop without an input gain: sup|e| of the answers to J harmonics of the period T, whatever w is. *)
Section Sup.
Variable n : nat -> R.
Variables w mu sigma T : R.
Hypothesis w_pos : 0 < w.
Hypothesis sigma_pos : 0 < sigma.
Hypothesis T_pos : 0 < T.
Variables N J : nat.

(** z, e and q of the harmonic S j, for j < J. *)
Variables (z0 : nat -> C) (za zb : nat -> nat -> C) (e q : nat -> C).
Hypothesis H : forall j, (j < J)%nat -> loop_answers n w mu sigma 1 0 (om T (S j)) N (z0 j) (za j) (zb j) (e j) (q j).

Lemma all_answers j : (j < J)%nat ->
  (denominator sigma (om T (S j)) mu 1 (eta_ n w (om T (S j)) N) 0 * e j)%C = q j \/ e j = RtoC 0.
Proof.
  intros Hj. eapply answer; try lra.
  - left. apply om_pos, T_pos.
  - apply H, Hj.
Qed.

Theorem sup_e_answer t : Rabs (signal T e J t) <= sqrt (bt2 T sigma J) * sqrt (rms2 q J).
Proof.
  apply (sup_e T sigma sigma_pos e q mu (fun j => eta_ n w (om T (S j)) N)). exact all_answers.
Qed.

Theorem sup_e_answer_derivative dq t : (forall j, (j < J)%nat -> Cmod (dq j) = om T (S j) * Cmod (q j)) ->
  Rabs (signal T e J t) <= sqrt (tau2 T sigma J) * sqrt (rms2 dq J).
Proof.
  apply (sup_e_derivative T sigma T_pos sigma_pos e q dq mu (fun j => eta_ n w (om T (S j)) N)). exact all_answers.
Qed.

End Sup.
