(** Sections 1, 3 and 13.1: the loop of the plant e' = q + b u and the regulator with N oscillators, for every N. *)

From Coq Require Import Reals ZArith Lra Lia.
From Coquelicot Require Import Coquelicot.
From SigmaStar Require Import Sums.
Local Open Scope R_scope.

(** [ring] and [field] where the type of the equation is R under another name. *)
Ltac real_eq := unfold minus, plus, opp, scal; simpl; unfold mult; simpl;
  repeat match goal with |- context [RInt ?f ?a ?b] =>
    let r := fresh "r" in let E := fresh in remember (RInt f a b : R) as r eqn:E; clear E end;
  match goal with |- @eq _ ?a ?b => change (@eq R a b) end.

Section Loop.
Variable n : nat -> R.
Variable N : nat.
Variables w sigma mu b : R.

(** The state z has the components z0 and, for 1 <= l <= N, za l and zb l. All are functions of time, as e and q are. *)
Variables (e q z0 : R -> R) (za zb : nat -> R -> R).

(** zeta = z - M e, with M = (1, 1, 0, 1, 0, ...). *)
Definition zeta0 (t : R) : R := z0 t - e t.
Definition zetaa (l : nat) (t : R) : R := za l t - e t.
Definition zetab (l : nat) (t : R) : R := zb l t.

(** s = M'N zeta, and zeta'N zeta. *)
Definition s_ (t : R) : R := n O * zeta0 t + sum1 N (fun l => n l * zetaa l t).
Definition V_ (t : R) : R := n O * zeta0 t ^ 2 + sum1 N (fun l => n l * (zetaa l t ^ 2 + zetab l t ^ 2)).

(** The regulator's output u = -sigma e + mu M'N (z - M e), and y = q + (1-b) sigma e + b mu s. *)
Definition u_ (t : R) : R := - sigma * e t + mu * s_ t.
Definition y (t : R) : R := q t + (1 - b) * sigma * e t + b * mu * s_ t.

(** The equations: e' = q + b u and z' = Phi z - (Phi + sigma I) M e, block by block. *)
Record equations_at (t : R) : Prop := {
  eq_e : is_derive e t (q t + b * u_ t);
  eq_z0 : is_derive z0 t (- sigma * e t);
  eq_za : forall l, (1 <= l <= N)%nat -> is_derive (za l) t (INR l * w * zb l t - sigma * e t);
  eq_zb : forall l, (1 <= l <= N)%nat -> is_derive (zb l) t (- (INR l * w) * za l t + INR l * w * e t)
}.

(** (1.1), and with a gain b 13.1: e' = y - sigma e. *)
Theorem loop_e t : equations_at t -> is_derive e t (y t - sigma * e t).
Proof. intros [H _ _ _]. evar_last; [exact H|]. unfold y, u_. ring. Qed.

(** (1.1), 13.1: zeta' = Phi zeta - M y. *)
Theorem loop_zeta0 t : equations_at t -> is_derive zeta0 t (- y t).
Proof.
  intros H. pose proof (loop_e t H) as He. destruct H as [_ H0 _ _]. unfold zeta0. evar_last.
  - apply @is_derive_minus; [exact H0 | exact He].
  - unfold minus, plus, opp; simpl. ring.
Qed.

Theorem loop_zetaa t l : equations_at t -> (1 <= l <= N)%nat ->
  is_derive (zetaa l) t (INR l * w * zetab l t - y t).
Proof.
  intros H Hl. pose proof (loop_e t H) as He. destruct H as [_ _ Ha _]. unfold zetaa. evar_last.
  - apply @is_derive_minus; [apply Ha, Hl | exact He].
  - unfold minus, plus, opp, zetab; simpl. ring.
Qed.

Theorem loop_zetab t l : equations_at t -> (1 <= l <= N)%nat ->
  is_derive (zetab l) t (- (INR l * w) * zetaa l t).
Proof.
  intros [_ _ _ Hb] Hl. unfold zetab. evar_last; [apply Hb, Hl|]. unfold zetaa. ring.
Qed.

(** The energy identity: (zeta'N zeta)' = -2 s y, for every N. *)
Theorem energy t : equations_at t -> is_derive V_ t (- 2 * s_ t * y t).
Proof.
  intros H. unfold V_. evar_last.
  - apply @is_derive_plus.
    + apply is_derive_scal. apply (is_derive_pow zeta0 2 t _ (loop_zeta0 t H)).
    + unfold sum1. apply (sum_derive N (fun i t => n (S i) * (zetaa (S i) t ^ 2 + zetab (S i) t ^ 2))
        (fun i t => n (S i) * (- 2 * zetaa (S i) t * y t))).
      intros i Hi. evar_last.
      * apply is_derive_scal. apply @is_derive_plus.
        -- apply (is_derive_pow (zetaa (S i)) 2 t _ (loop_zetaa t (S i) H ltac:(lia))).
        -- apply (is_derive_pow (zetab (S i)) 2 t _ (loop_zetab t (S i) H ltac:(lia))).
      * unfold plus; simpl pred; simpl (INR 2). cbn [AbelianGroup.sort]. simpl. ring.
  - unfold plus, s_, sum1; simpl pred; simpl.
    rewrite (sum_ext N _ (fun i => - 2 * y t * (n (S i) * zetaa (S i) t))) by (intros; ring).
    rewrite sum_scal. ring.
Qed.

(** (1.2): with b = 1, (zeta'N zeta)' = -2 mu s^2 - 2 s q. *)
Theorem energy_unit_gain t : b = 1 -> equations_at t -> is_derive V_ t (- 2 * mu * s_ t ^ 2 - 2 * s_ t * q t).
Proof. intros Hb H. evar_last; [apply energy, H|]. unfold y. rewrite Hb. ring. Qed.

(** The dissipation in y: what C5b completes to a square. *)
Theorem energy_in_y t : b * mu <> 0 -> equations_at t ->
  is_derive (fun t => b * mu * V_ t) t (- 2 * y t ^ 2 + 2 * y t * (q t + (1 - b) * sigma * e t)).
Proof.
  intros Hb H. evar_last; [apply is_derive_scal, energy, H|]. unfold y. ring.
Qed.

(** Section 3: zeta'N zeta rises by at most q^2/(2 mu) per unit of time. *)
Theorem rise t : b = 1 -> 0 < mu -> equations_at t ->
  exists v, is_derive V_ t v /\ v <= q t ^ 2 / (2 * mu).
Proof.
  intros Hb Hmu H. eexists. split; [apply energy_unit_gain; assumption|].
  apply le_div; [lra|]. pose proof (pow2_ge_0 (2 * mu * s_ t + q t)). nra.
Qed.

(** ** Over a period *)

Section Period.
Variable T : R.
Hypothesis T_pos : 0 < T.
Hypothesis solves : forall t, equations_at t.
Hypothesis q_continuous : forall t, continuous q t.
Hypothesis e_periodic : e T = e 0.
Hypothesis z0_periodic : z0 T = z0 0.
Hypothesis za_periodic : forall l, (1 <= l <= N)%nat -> za l T = za l 0.
Hypothesis zb_periodic : forall l, (1 <= l <= N)%nat -> zb l T = zb l 0.

Let derivable_continuous (f : R -> R) (f' t : R) : is_derive f t f' -> continuous f t.
Proof. intros H. apply (ex_derive_continuous (V := R_NormedModule)). exists f'. exact H. Qed.

Lemma e_continuous t : continuous e t.
Proof. apply (derivable_continuous e _ t (loop_e t (solves t))). Qed.

Lemma sum_continuous k (f : nat -> R -> R) t :
  (forall i, (i < k)%nat -> continuous (f i) t) -> continuous (fun t => sum k (fun i => f i t)) t.
Proof.
  induction k as [|k IH]; intros H; cbn [sum]; [apply continuous_const|].
  apply (continuous_plus (V := R_NormedModule)); [apply IH; intros; apply H; lia | apply H; lia].
Qed.

Lemma s_continuous t : continuous s_ t.
Proof.
  unfold s_. apply (continuous_plus (V := R_NormedModule)).
  - apply (continuous_mult (K := R_AbsRing)); [apply continuous_const|].
    apply (derivable_continuous zeta0 _ t (loop_zeta0 t (solves t))).
  - unfold sum1. apply (sum_continuous N (fun i t => n (S i) * zetaa (S i) t)). intros i Hi.
    apply (continuous_mult (K := R_AbsRing)); [apply continuous_const|].
    apply (derivable_continuous (zetaa (S i)) _ t (loop_zetaa t (S i) (solves t) ltac:(lia))).
Qed.

Lemma y_continuous t : continuous y t.
Proof.
  unfold y. apply (continuous_plus (V := R_NormedModule)); [apply (continuous_plus (V := R_NormedModule))|].
  - apply q_continuous.
  - apply (continuous_mult (K := R_AbsRing)); [apply continuous_const | apply e_continuous].
  - apply (continuous_mult (K := R_AbsRing)); [apply continuous_const | apply s_continuous].
Qed.

Lemma V_periodic : V_ T = V_ 0.
Proof.
  unfold V_, zeta0, zetaa, zetab. rewrite e_periodic, z0_periodic. f_equal. unfold sum1.
  apply sum_ext. intros i Hi. rewrite za_periodic, zb_periodic by lia. reflexivity.
Qed.

Lemma integrable (f : R -> R) : (forall t, continuous f t) -> ex_RInt f 0 T.
Proof. intros H. apply (ex_RInt_continuous (V := R_CompleteNormedModule)). intros; apply H. Qed.

Lemma continuous_product (f g : R -> R) (t : R) : continuous f t -> continuous g t -> continuous (fun t => f t * g t) t.
Proof. intros Hf Hg. apply (continuous_mult (K := R_AbsRing)); assumption. Qed.

Lemma continuous_square (f : R -> R) (t : R) : continuous f t -> continuous (fun t => f t ^ 2) t.
Proof.
  intros H. apply (continuous_ext (fun t => f t * f t)); [intros r; change (f r * f r = f r ^ 2); ring|]. apply continuous_product; exact H.
Qed.

(** The integral of s y over a period is 0. *)
Lemma integral_s_y : RInt (fun t => s_ t * y t) 0 T = 0.
Proof.
  apply is_RInt_unique. evar_last.
  - apply (is_RInt_ext (fun t => scal (- / 2) (- 2 * s_ t * y t))).
    { intros t _. real_eq. field. }
    apply (is_RInt_scal (V := R_NormedModule)).
    apply (is_RInt_derive (V := R_CompleteNormedModule) V_ (fun t => - 2 * s_ t * y t)).
    + intros t _. apply energy, solves.
    + intros t _. apply continuous_product; [apply continuous_product; [apply continuous_const | apply s_continuous] | apply y_continuous].
  - rewrite V_periodic. real_eq. ring.
Qed.

(** (3.1), first identity, with b = 1: |y|^2 + |mu s|^2 = |q|^2. *)
Theorem energy_identity_q : b = 1 ->
  RInt (fun t => y t ^ 2) 0 T + RInt (fun t => (mu * s_ t) ^ 2) 0 T = RInt (fun t => q t ^ 2) 0 T.
Proof.
  intros Hb.
  assert (I1 : ex_RInt (fun t => y t ^ 2) 0 T) by (apply integrable; intros; apply continuous_square, y_continuous).
  assert (I2 : ex_RInt (fun t => (mu * s_ t) ^ 2) 0 T).
  { apply integrable. intros t. apply (continuous_square (fun t => mu * s_ t)).
    apply continuous_product; [apply continuous_const | apply s_continuous]. }
  assert (I3 : ex_RInt (fun t => s_ t * y t) 0 T) by (apply integrable; intros; apply continuous_product; [apply s_continuous | apply y_continuous]).
  rewrite <- (RInt_plus (V := R_CompleteNormedModule)) by assumption.
  rewrite (RInt_ext (V := R_CompleteNormedModule) (fun t => q t ^ 2)
             (fun t => minus (plus (y t ^ 2) ((mu * s_ t) ^ 2)) (scal (2 * mu) (s_ t * y t)))).
  2:{ intros t _. real_eq. unfold y. rewrite Hb. ring. }
  rewrite (RInt_minus (V := R_CompleteNormedModule)).
  - rewrite (RInt_scal (V := R_CompleteNormedModule)) by exact I3. rewrite integral_s_y.
    real_eq. ring.
  - apply (ex_RInt_plus (V := R_NormedModule)); assumption.
  - apply (ex_RInt_scal (V := R_NormedModule)); exact I3.
Qed.

(** (3.1), second identity, for every b: |e'|^2 + sigma^2 |e|^2 = |y|^2, where e' = y - sigma e. *)
Theorem energy_identity_e :
  RInt (fun t => (y t - sigma * e t) ^ 2) 0 T + sigma ^ 2 * RInt (fun t => e t ^ 2) 0 T = RInt (fun t => y t ^ 2) 0 T.
Proof.
  assert (Cd : forall t, continuous (fun t => y t - sigma * e t) t).
  { intros t. apply (continuous_minus (V := R_NormedModule)); [apply y_continuous|].
    apply continuous_product; [apply continuous_const | apply e_continuous]. }
  assert (I0 : RInt (fun t => 2 * e t * (y t - sigma * e t)) 0 T = 0).
  { apply is_RInt_unique. evar_last.
    - apply (is_RInt_derive (V := R_CompleteNormedModule) (fun t => e t ^ 2) (fun t => 2 * e t * (y t - sigma * e t))).
      + intros t _. evar_last; [apply (is_derive_pow e 2 t _ (loop_e t (solves t)))|]. simpl. ring.
      + intros t _. apply continuous_product; [apply continuous_product; [apply continuous_const | apply e_continuous] | apply Cd].
    - rewrite e_periodic. unfold minus, plus, opp; simpl. ring. }
  assert (I1 : ex_RInt (fun t => (y t - sigma * e t) ^ 2) 0 T) by (apply integrable; intros; apply (continuous_square (fun t => y t - sigma * e t)), Cd).
  assert (I2 : ex_RInt (fun t => e t ^ 2) 0 T) by (apply integrable; intros; apply continuous_square, e_continuous).
  assert (I3 : ex_RInt (fun t => 2 * e t * (y t - sigma * e t)) 0 T).
  { apply integrable. intros t. apply continuous_product; [apply continuous_product; [apply continuous_const | apply e_continuous] | apply Cd]. }
  rewrite (RInt_ext (V := R_CompleteNormedModule) (fun t => y t ^ 2)
             (fun t => plus (plus ((y t - sigma * e t) ^ 2) (scal (sigma ^ 2) (e t ^ 2))) (scal sigma (2 * e t * (y t - sigma * e t))))).
  2:{ intros t _. real_eq. ring. }
  rewrite (RInt_plus (V := R_CompleteNormedModule)), (RInt_plus (V := R_CompleteNormedModule)),
          !(RInt_scal (V := R_CompleteNormedModule)), I0; try assumption.
  - real_eq. ring.
  - apply (ex_RInt_scal (V := R_NormedModule)); assumption.
  - apply (ex_RInt_plus (V := R_NormedModule)); [assumption|]. apply (ex_RInt_scal (V := R_NormedModule)); assumption.
  - apply (ex_RInt_scal (V := R_NormedModule)); assumption.
Qed.

(** (3.1): y has zero mean (the integrator), and so has e. *)
Theorem mean_y_zero : RInt y 0 T = 0.
Proof.
  apply is_RInt_unique. evar_last.
  - apply (is_RInt_ext (fun t => scal (-1) (- y t))).
    { intros t _. real_eq. ring. }
    apply (is_RInt_scal (V := R_NormedModule)).
    apply (is_RInt_derive (V := R_CompleteNormedModule) zeta0 (fun t => - y t)).
    + intros t _. apply loop_zeta0, solves.
    + intros t _. apply (continuous_opp (V := R_NormedModule)), y_continuous.
  - unfold zeta0. rewrite e_periodic, z0_periodic. real_eq. ring.
Qed.

Theorem mean_e_zero : sigma <> 0 -> RInt e 0 T = 0.
Proof.
  intros Hs. apply is_RInt_unique. evar_last.
  - apply (is_RInt_ext (fun t => scal (- / sigma) (- sigma * e t))).
    { intros t _. real_eq. field. exact Hs. }
    apply (is_RInt_scal (V := R_NormedModule)).
    apply (is_RInt_derive (V := R_CompleteNormedModule) z0 (fun t => - sigma * e t)).
    + intros t _. apply (eq_z0 t (solves t)).
    + intros t _. apply continuous_product; [apply continuous_const | apply e_continuous].
  - rewrite z0_periodic. real_eq. ring.
Qed.

End Period.
End Loop.
