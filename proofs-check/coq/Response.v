(** Section 2, (2.1) and (2.2): what T_N is. Every answer zeta to a harmonic v of frequency om has zeta*N zeta = T_N(om/w) |v|^2/w^2, at
    every frequency om >= 0, the poles included, for every number N of oscillators. *)

From Coq Require Import Reals ZArith Lra Lia.
From Coquelicot Require Import Coquelicot.
From SigmaStar Require Import Sums Transfer Transfers.
Local Open Scope R_scope.

Section Response.
Variable n : nat -> R.
Hypothesis n_pos : forall l, 0 < n l.
Variables w mu om : R.
Hypothesis w_pos : 0 < w.
Hypothesis mu_pos : 0 < mu.
Hypothesis om_nonneg : 0 <= om.
Variable N : nat.

(** Complex amplitudes: of zeta (a component 0 and N pairs), of the input v, and of y = v + mu s with s = M'N zeta. *)
Variables (z0 : C) (za zb : nat -> C) (v : C).
Definition s_c : C := (n O * fst z0 + sum1 N (fun l => n l * fst (za l)), n O * snd z0 + sum1 N (fun l => n l * snd (za l))).
Definition y_c : C := (v + mu * s_c)%C.
Definition energy_c : R := n O * Cmod z0 ^ 2 + sum1 N (fun l => n l * (Cmod (za l) ^ 2 + Cmod (zb l) ^ 2)).

(** zeta' = Phi zeta - M y, for signals e^(i om t). *)
Record answers : Prop := {
  ans_0 : (Ci * om * z0 = - y_c)%C;
  ans_a : forall l, (1 <= l <= N)%nat -> (Ci * om * za l = (INR l * w)%R * zb l - y_c)%C;
  ans_b : forall l, (1 <= l <= N)%nat -> (Ci * om * zb l = - ((INR l * w)%R * za l))%C
}.

Hypothesis H : answers.
Let nu := mu / w.
Let x := om / w.

Lemma om_x : om = x * w.
Proof. unfold x. field. lra. Qed.

(** The equations in real and imaginary parts. *)
Lemma parts (k : R) (a b y : C) : (Ci * om * a = k * b - y)%C ->
  - (om * snd a) = k * fst b - fst y /\ om * fst a = k * snd b - snd y.
Proof. intros E. apply (f_equal fst) in E as E1. apply (f_equal snd) in E as E2. simpl in E1, E2. split; lra. Qed.

Lemma parts_0 : om * snd z0 = fst y_c /\ om * fst z0 = - snd y_c.
Proof.
  assert (E : (Ci * om * z0 = 0%R * 0 - y_c)%C) by (rewrite (ans_0 H); ring).
  destruct (parts _ _ _ _ E) as [E1 E2]. change (fst (RtoC 0)) with 0 in E1. change (snd (RtoC 0)) with 0 in E2. split; lra.
Qed.

Lemma parts_a l : (1 <= l <= N)%nat ->
  - (om * snd (za l)) = INR l * w * fst (zb l) - fst y_c /\ om * fst (za l) = INR l * w * snd (zb l) - snd y_c.
Proof.
  intros Hl. exact (parts _ _ _ _ (ans_a H l Hl)).
Qed.

Lemma parts_b l : (1 <= l <= N)%nat ->
  om * snd (zb l) = INR l * w * fst (za l) /\ om * fst (zb l) = - (INR l * w * snd (za l)).
Proof.
  intros Hl.
  assert (E : (Ci * om * zb l = (- (INR l * w))%R * za l - 0)%C).
  { rewrite (ans_b H l Hl). apply injective_projections; simpl; ring. }
  destruct (parts _ _ _ _ E) as [E1 E2]. change (fst (RtoC 0)) with 0 in E1. change (snd (RtoC 0)) with 0 in E2. split; lra.
Qed.

(** (l^2 - x^2) w zeta_l is -i x y in the first component and l y in the second. *)
Lemma solve_l l : (1 <= l <= N)%nat ->
  (INR l ^ 2 - x ^ 2) * w * fst (za l) = x * snd y_c /\ (INR l ^ 2 - x ^ 2) * w * snd (za l) = - (x * fst y_c)
  /\ (INR l ^ 2 - x ^ 2) * w * fst (zb l) = INR l * fst y_c /\ (INR l ^ 2 - x ^ 2) * w * snd (zb l) = INR l * snd y_c.
Proof.
  intros Hl. destruct (parts_a l Hl) as [A1 A2]. destruct (parts_b l Hl) as [B1 B2]. rewrite om_x in *.
  assert (Hp : 0 < INR l) by (apply lt_0_INR; lia).
  set (ar := fst (za l)) in *. set (ai := snd (za l)) in *. set (br := fst (zb l)) in *. set (bi := snd (zb l)) in *.
  set (yr := fst y_c) in *. set (yi := snd y_c) in *. set (L := INR l) in *.
  assert (B1' : x * bi = L * ar) by (apply Rmult_eq_reg_r with w; lra).
  assert (B2' : x * br = - (L * ai)) by (apply Rmult_eq_reg_r with w; lra).
  repeat split.
  - replace ((L ^ 2 - x ^ 2) * w * ar) with (L * w * (L * ar) - x * (x * w * ar)) by ring. rewrite <- B1', A2. ring.
  - replace ((L ^ 2 - x ^ 2) * w * ai) with (- (L * w * - (L * ai)) + x * - (x * w * ai)) by ring. rewrite <- B2', A1. ring.
  - replace ((L ^ 2 - x ^ 2) * w * br) with (L * (L * w * br) - x * w * (x * br)) by ring. rewrite B2'.
    replace (L * w * br) with (yr - x * w * ai) by lra. ring.
  - replace ((L ^ 2 - x ^ 2) * w * bi) with (L * (L * w * bi) - x * w * (x * bi)) by ring. rewrite B1'.
    replace (L * w * bi) with (yi + x * w * ar) by lra. ring.
Qed.

Let nu_pos : 0 < nu.
Proof. apply Rdiv_lt_0_compat; assumption. Qed.

(** Away from the poles: s = -(i/w) g_N y, and (1 + i nu g_N) y = v. *)
Theorem response_regular : regular N x ->
  s_c = (g n N x / w * snd y_c, - (g n N x / w * fst y_c)) /\ energy_c = g' n N x / w ^ 2 * Cmod y_c ^ 2
  /\ Cmod v ^ 2 = (1 + nu ^ 2 * g n N x ^ 2) * Cmod y_c ^ 2.
Proof.
  intros Reg. assert (Hx : x <> 0) by (intros E; apply (Reg 0%Z); [lia | lra]).
  assert (Hl : forall l, (1 <= l <= N)%nat -> INR l - x <> 0 /\ - INR l - x <> 0 /\ INR l ^ 2 - x ^ 2 <> 0).
  { intros l Hl. pose proof (Reg (Z.of_nat l) ltac:(lia)) as R1. pose proof (Reg (- Z.of_nat l)%Z ltac:(lia)) as R2.
    rewrite opp_IZR, <- INR_IZR_INZ in R2. rewrite <- INR_IZR_INZ in R1.
    repeat split; try lra. replace (INR l ^ 2 - x ^ 2) with ((INR l - x) * (INR l + x)) by ring.
    apply Rmult_integral_contrapositive; split; lra. }
  destruct parts_0 as [Z1 Z2]. rewrite om_x in Z1, Z2.
  assert (Eg : g n N x = - n O / x + sum N (fun i => n (S i) * x / (INR (S i) ^ 2 - x ^ 2))).
  { unfold g, zsum, sum1. f_equal; [unfold c; simpl; field; lra|]. apply sum_ext. intros i Hi.
    destruct (Hl (S i) ltac:(lia)) as [P1 [P2 P3]]. rewrite c_nat, c_neg, opp_IZR, <- INR_IZR_INZ by lia. 
    replace (INR (S i) ^ 2 - x ^ 2) with ((INR (S i) - x) * - (- INR (S i) - x)) by ring. field. split; assumption. }
  assert (Eg' : g' n N x = n O / x ^ 2 + sum N (fun i => n (S i) * (INR (S i) ^ 2 + x ^ 2) / (INR (S i) ^ 2 - x ^ 2) ^ 2)).
  { unfold g', zsum, sum1. f_equal; [unfold c; simpl; field; lra|]. apply sum_ext. intros i Hi.
    destruct (Hl (S i) ltac:(lia)) as [P1 [P2 P3]]. rewrite c_nat, c_neg, opp_IZR, <- INR_IZR_INZ by lia.
    replace (INR (S i) ^ 2 - x ^ 2) with ((INR (S i) - x) * - (- INR (S i) - x)) by ring. field. split; assumption. }
  assert (Ef : forall l, (1 <= l <= N)%nat -> fst (za l) = x / (INR l ^ 2 - x ^ 2) * (snd y_c / w)
                  /\ snd (za l) = - (x / (INR l ^ 2 - x ^ 2) * (fst y_c / w))
                  /\ fst (zb l) = INR l / (INR l ^ 2 - x ^ 2) * (fst y_c / w)
                  /\ snd (zb l) = INR l / (INR l ^ 2 - x ^ 2) * (snd y_c / w)).
  { intros l Hlr. destruct (solve_l l Hlr) as [S1 [S2 [S3 S4]]]. destruct (Hl l Hlr) as [_ [_ P3]].
    assert (Q : (INR l ^ 2 - x ^ 2) * w <> 0) by (apply Rmult_integral_contrapositive; split; lra).
    repeat split; apply (Rmult_eq_reg_l ((INR l ^ 2 - x ^ 2) * w)); try exact Q; [rewrite S1|rewrite S2|rewrite S3|rewrite S4]; field; split; lra. }
  assert (Z1' : snd z0 = fst y_c / w / x) by (apply (Rmult_eq_reg_l (x * w)); [rewrite Z1; field; split; lra | apply Rmult_integral_contrapositive; split; lra]).
  assert (Z2' : fst z0 = - (snd y_c / w / x)) by (apply (Rmult_eq_reg_l (x * w)); [rewrite Z2; field; split; lra | apply Rmult_integral_contrapositive; split; lra]).
  assert (Es : s_c = (g n N x / w * snd y_c, - (g n N x / w * fst y_c))).
  { unfold s_c. rewrite Z1', Z2', Eg. unfold sum1. f_equal.
    - rewrite (sum_ext N _ (fun i => snd y_c / w * (n (S i) * x / (INR (S i) ^ 2 - x ^ 2)))).
      + rewrite sum_scal. field. split; lra.
      + intros i Hi. destruct (Ef (S i) ltac:(lia)) as [-> _]. destruct (Hl (S i) ltac:(lia)) as [_ [_ P3]]. field. split; [exact P3 | lra].
    - rewrite (sum_ext N _ (fun i => - (fst y_c / w) * (n (S i) * x / (INR (S i) ^ 2 - x ^ 2)))).
      + rewrite sum_scal. field. split; lra.
      + intros i Hi. destruct (Ef (S i) ltac:(lia)) as [_ [-> _]]. destruct (Hl (S i) ltac:(lia)) as [_ [_ P3]]. field. split; [exact P3 | lra]. }
  split; [exact Es|]. split.
  - unfold energy_c. rewrite Eg'. unfold sum1.
    rewrite (sum_ext N _ (fun i => Cmod y_c ^ 2 / w ^ 2 * (n (S i) * (INR (S i) ^ 2 + x ^ 2) / (INR (S i) ^ 2 - x ^ 2) ^ 2))).
    + rewrite sum_scal, !Cmod2, Z1', Z2'. field. split; lra.
    + intros i Hi. rewrite !Cmod2. destruct (Ef (S i) ltac:(lia)) as [-> [-> [-> ->]]].
      destruct (Hl (S i) ltac:(lia)) as [_ [_ P3]]. field. split; [exact P3 | lra].
  - assert (V1 : fst v = fst y_c - nu * g n N x * snd y_c).
    { unfold nu. change (fst y_c) with (fst v + (mu * fst s_c - 0 * snd s_c)) at 1. rewrite Es. cbn [fst snd]. field. lra. }
    assert (V2 : snd v = snd y_c + nu * g n N x * fst y_c).
    { unfold nu. change (snd y_c) with (snd v + (mu * snd s_c + 0 * fst s_c)) at 1. rewrite Es. cbn [fst snd]. field. lra. }
    rewrite !Cmod2, V1, V2. ring.
Qed.

(** At a pole m <= N y vanishes, and with it every component but those of m. *)
Lemma response_pole m : (1 <= m <= N)%nat -> x = INR m ->
  fst y_c = 0 /\ snd y_c = 0 /\ energy_c = 2 * n m * Cmod (za m) ^ 2 /\ Cmod v ^ 2 = mu ^ 2 * n m ^ 2 * Cmod (za m) ^ 2.
Proof.
  intros Hm Ex. assert (Hp : 0 < INR m) by (apply lt_0_INR; lia).
  destruct (solve_l m Hm) as [S1 [S2 [S3 S4]]]. rewrite Ex in S1, S2, S3, S4.
  assert (Y1 : fst y_c = 0) by (apply (Rmult_eq_reg_l (INR m)); lra).
  assert (Y2 : snd y_c = 0) by (apply (Rmult_eq_reg_l (INR m)); lra).
  assert (Zero : forall l, (1 <= l <= N)%nat -> l <> m -> fst (za l) = 0 /\ snd (za l) = 0 /\ fst (zb l) = 0 /\ snd (zb l) = 0).
  { intros l Hl Ne. destruct (solve_l l Hl) as [Q1 [Q2 [Q3 Q4]]]. rewrite Ex, Y1, Y2 in *.
    assert (Hlp : 0 < INR l) by (apply lt_0_INR; lia).
    assert (Q : (INR l ^ 2 - INR m ^ 2) * w <> 0).
    { replace ((INR l ^ 2 - INR m ^ 2) * w) with ((INR l - INR m) * (INR l + INR m) * w) by ring.
      assert (INR l <> INR m) by (apply not_INR; exact Ne).
      repeat (apply Rmult_integral_contrapositive; split); lra. }
    repeat split; apply (Rmult_eq_reg_l ((INR l ^ 2 - INR m ^ 2) * w)); try exact Q; lra. }
  destruct parts_0 as [Z1 Z2]. rewrite om_x, Ex, Y1 in Z1. rewrite om_x, Ex, Y2 in Z2.
  assert (Hq : INR m * w <> 0) by (apply Rmult_integral_contrapositive; split; lra).
  assert (Z1' : snd z0 = 0) by (apply (Rmult_eq_reg_l (INR m * w)); lra).
  assert (Z2' : fst z0 = 0) by (apply (Rmult_eq_reg_l (INR m * w)); lra).
  destruct (parts_b m Hm) as [B1 B2]. rewrite om_x, Ex in B1, B2.
  assert (B1' : snd (zb m) = fst (za m)) by (apply (Rmult_eq_reg_l (INR m * w)); lra).
  assert (B2' : fst (zb m) = - snd (za m)) by (apply (Rmult_eq_reg_l (INR m * w)); lra).
  assert (Only : forall f, (forall l, (1 <= l <= N)%nat -> l <> m -> f l = 0) -> sum1 N f = f m).
  { intros f Hf. unfold sum1. replace N with ((m - 1) + S (N - m))%nat by lia. rewrite sum_split, sum_first, Nat.add_0_r.
    replace (S (m - 1)) with m by lia.
    rewrite sum_zero by (intros i Hi; apply Hf; lia). rewrite sum_zero by (intros i Hi; apply Hf; lia). ring. }
  split; [exact Y1|]. split; [exact Y2|].
  assert (Es1 : fst s_c = n m * fst (za m)).
  { unfold s_c. simpl fst at 1. rewrite Z2', (Only (fun l => n l * fst (za l))); [ring|].
    intros l Hl Ne. destruct (Zero l Hl Ne) as [-> _]. ring. }
  assert (Es2 : snd s_c = n m * snd (za m)).
  { unfold s_c. simpl snd at 1. rewrite Z1', (Only (fun l => n l * snd (za l))); [ring|].
    intros l Hl Ne. destruct (Zero l Hl Ne) as [_ [-> _]]. ring. }
  split.
  - unfold energy_c. rewrite (Only (fun l => n l * (Cmod (za l) ^ 2 + Cmod (zb l) ^ 2))).
    + rewrite !Cmod2, Z1', Z2', B1', B2'. ring.
    + intros l Hl Ne. rewrite !Cmod2. destruct (Zero l Hl Ne) as [-> [-> [-> ->]]]. ring.
  - change (fst y_c) with (fst v + (mu * fst s_c - 0 * snd s_c)) in Y1.
    change (snd y_c) with (snd v + (mu * snd s_c + 0 * fst s_c)) in Y2. rewrite Es1, Es2 in *.
    rewrite !Cmod2. replace (fst v) with (- (mu * (n m * fst (za m)))) by lra.
    replace (snd v) with (- (mu * (n m * snd (za m)))) by lra. ring.
Qed.

Lemma response_zero : x = 0 ->
  fst y_c = 0 /\ snd y_c = 0 /\ energy_c = n O * Cmod z0 ^ 2 /\ Cmod v ^ 2 = mu ^ 2 * n O ^ 2 * Cmod z0 ^ 2.
Proof.
  intros Ex. destruct parts_0 as [Z1 Z2]. rewrite om_x, Ex in Z1, Z2.
  assert (Y1 : fst y_c = 0) by lra. assert (Y2 : snd y_c = 0) by lra.
  assert (Zero : forall l, (1 <= l <= N)%nat -> fst (za l) = 0 /\ snd (za l) = 0 /\ fst (zb l) = 0 /\ snd (zb l) = 0).
  { intros l Hl. destruct (solve_l l Hl) as [Q1 [Q2 [Q3 Q4]]]. rewrite Ex, Y1, Y2 in *.
    assert (Hlp : 0 < INR l) by (apply lt_0_INR; lia).
    assert (Q : (INR l ^ 2 - 0 ^ 2) * w <> 0) by (replace ((INR l ^ 2 - 0 ^ 2) * w) with (INR l * INR l * w) by ring; repeat (apply Rmult_integral_contrapositive; split); lra).
    repeat split; apply (Rmult_eq_reg_l ((INR l ^ 2 - 0 ^ 2) * w)); try exact Q; lra. }
  split; [exact Y1|]. split; [exact Y2|].
  assert (None : forall f, (forall l, (1 <= l <= N)%nat -> f l = 0) -> sum1 N f = 0).
  { intros f Hf. unfold sum1. apply sum_zero. intros i Hi. apply Hf. lia. }
  assert (Es1 : fst s_c = n O * fst z0).
  { unfold s_c. simpl fst at 1. rewrite (None (fun l => n l * fst (za l))); [ring|].
    intros l Hl. destruct (Zero l Hl) as [-> _]. ring. }
  assert (Es2 : snd s_c = n O * snd z0).
  { unfold s_c. simpl snd at 1. rewrite (None (fun l => n l * snd (za l))); [ring|].
    intros l Hl. destruct (Zero l Hl) as [_ [-> _]]. ring. }
  split.
  - unfold energy_c. rewrite (None (fun l => n l * (Cmod (za l) ^ 2 + Cmod (zb l) ^ 2))); [ring|].
    intros l Hl. rewrite !Cmod2. destruct (Zero l Hl) as [-> [-> [-> ->]]]. ring.
  - change (fst y_c) with (fst v + (mu * fst s_c - 0 * snd s_c)) in Y1.
    change (snd y_c) with (snd v + (mu * snd s_c + 0 * fst s_c)) in Y2. rewrite Es1, Es2 in *.
    rewrite !Cmod2. replace (fst v) with (- (mu * (n O * fst z0))) by lra.
    replace (snd v) with (- (mu * (n O * snd z0))) by lra. ring.
Qed.

(** Every frequency om >= 0 is 0, that of an oscillator, or none of the internal model. *)
Lemma frequencies : x = 0 \/ (exists m, (1 <= m <= N)%nat /\ x = INR m) \/ regular N x.
Proof.
  destruct (Req_dec x 0) as [Ex|Ex]; [left; exact Ex | right].
  destruct (Classical_Prop.classic (exists m, (1 <= m <= N)%nat /\ x = INR m)) as [Pole|No]; [left; exact Pole | right].
  assert (Hx : 0 <= x) by (apply Rmult_le_pos; [exact om_nonneg | left; apply Rinv_0_lt_compat, w_pos]).
  intros l Hl E. apply No. exists (Z.to_nat l).
  assert (0 <= l)%Z by (apply le_IZR; lra).
  assert (l <> 0)%Z by (intros E0; subst l; lra).
  split; [lia|]. rewrite INR_IZR_INZ, Z2Nat.id by lia. lra.
Qed.

(** (2.1) and (2.2), of every answer, at every frequency om >= 0. *)
Theorem response : energy_c = T n nu N x / w ^ 2 * Cmod v ^ 2.
Proof.
  destruct frequencies as [Ex|[[m [Hm Em]]|Reg]].
  - destruct (response_zero Ex) as [_ [_ [E1 E2]]]. rewrite E1, E2, Ex, T_at_0. unfold nu. pose proof (n_pos O). field. repeat split; lra.
  - destruct (response_pole m Hm Em) as [_ [_ [E1 E2]]]. rewrite E1, E2, Em, (T_at_pole n nu n_pos nu_pos) by exact Hm.
    unfold nu. pose proof (n_pos m). field. repeat split; lra.
  - destruct (response_regular Reg) as [_ [E1 E2]]. rewrite E1, E2, (T_regular n nu N x Reg). unfold quotient.
    assert (0 < 1 + nu ^ 2 * g n N x ^ 2) by (pose proof (pow2_ge_0 (nu * g n N x)); nra). field. split; lra.
Qed.

(** Section 3: |y| <= |v|, of every answer, at every frequency om >= 0. *)
Theorem response_y : Cmod y_c <= Cmod v.
Proof.
  apply square_le; [apply Cmod_ge_0|].
  destruct frequencies as [Ex|[[m [Hm Em]]|Reg]].
  - destruct (response_zero Ex) as [Y1 [Y2 _]]. rewrite (Cmod2 y_c), Y1, Y2. pose proof (pow2_ge_0 (Cmod v)). lra.
  - destruct (response_pole m Hm Em) as [Y1 [Y2 _]]. rewrite (Cmod2 y_c), Y1, Y2. pose proof (pow2_ge_0 (Cmod v)). lra.
  - destruct (response_regular Reg) as [_ [_ E2]]. rewrite E2. pose proof (pow2_ge_0 (nu * g n N x)).
    pose proof (pow2_ge_0 (Cmod y_c)). nra.
Qed.

End Response.
