(** Sections 5 and 12.3: a solution that starts below the level of C4 stays in the error box. *)

From Coq Require Import Reals Lra Lia.
From Coquelicot Require Import Coquelicot.
From SigmaStar Require Import Sums.
Local Open Scope R_scope.

Section Box.
(** The sizes of the errors as functions of time, |xt| and |et|. *)
Variables ex ee : R -> R.
Variables D_x D_e : R.
Hypothesis ex_continuous : forall t, continuous ex t.
Hypothesis ee_continuous : forall t, continuous ee t.

Definition in_box (t : R) : Prop := ex t < D_x /\ ee t < D_e.

Lemma box_open t : in_box t -> exists d, 0 < d /\ forall s, Rabs (s - t) < d -> in_box s.
Proof.
  intros [H1 H2].
  destruct (ex_continuous t (fun v => v < D_x) (open_lt D_x (ex t) H1)) as [d1 P1].
  destruct (ee_continuous t (fun v => v < D_e) (open_lt D_e (ee t) H2)) as [d2 P2].
  exists (Rmin d1 d2). split; [apply Rmin_glb_lt; apply cond_pos|].
  intros s Hs. split.
  - apply P1. apply Rlt_le_trans with (1 := Hs). apply Rmin_l.
  - apply P2. apply Rlt_le_trans with (1 := Hs). apply Rmin_r.
Qed.

(** If having been in the box up to t puts the solution into the box at t, it never leaves. *)
Lemma stays t0 t1 :
  (forall t, t0 <= t <= t1 -> (forall s, t0 <= s < t -> in_box s) -> in_box t) ->
  forall t, t0 <= t <= t1 -> in_box t.
Proof.
  intros Step.
  destruct (Rle_lt_dec t0 t1) as [Ht|Ht]; [|intros t H; lra].
  set (E := fun r => t0 <= r <= t1 /\ forall s, t0 <= s <= r -> in_box s).
  assert (I0 : in_box t0) by (apply Step; [lra | intros s Hs; lra]).
  assert (E0 : E t0) by (split; [lra | intros s Hs; replace s with t0 by lra; exact I0]).
  destruct (completeness E) as [l [Hub Hlub]].
  { exists t1. intros r [Hr _]. lra. }
  { exists t0. exact E0. }
  assert (Hl : t0 <= l <= t1).
  { split; [apply Hub, E0 | apply Hlub; intros r [Hr _]; lra]. }
  assert (Below : forall s, t0 <= s < l -> in_box s).
  { intros s Hs. destruct (Classical_Prop.classic (exists r, E r /\ s < r)) as [[r [Er Hr]]|N].
    - apply (proj2 Er). lra.
    - exfalso. assert (l <= s); [|lra]. apply Hlub. intros r Er.
      apply Rnot_lt_le. intros C. apply N. exists r. split; assumption. }
  assert (Il : in_box l) by (apply Step; assumption).
  assert (El : l = t1).
  { destruct (Req_dec l t1) as [E1|N]; [exact E1|]. exfalso.
    destruct (box_open l Il) as [d [Hd P]].
    set (r := Rmin (l + d / 2) t1).
    assert (Hr : l < r) by (apply Rmin_glb_lt; lra).
    assert (Hr1 : r <= l + d / 2) by apply Rmin_l. assert (Hr2 : r <= t1) by apply Rmin_r.
    assert (E r).
    { split; [lra|]. intros s Hs. destruct (Rlt_le_dec s l) as [C|C]; [apply Below; lra|].
      apply P. rewrite Rabs_right; lra. }
    pose proof (Hub r H). lra. }
  intros t H. destruct (Rlt_le_dec t l) as [C|C]; [apply Below; lra|]. replace t with l by lra. exact Il.
Qed.

(** Section 5. [lo_x] is w_x P_low, [lo_e] is 1, or those of a metric (13.7). U is derivable, does not grow while the solution is in the box, dominates the errors, and starts
    at most at L, which is below the level (C4): then the solution is in the box, and U <= L, for all of [t0, t1]. *)
Theorem containment (U U' : R -> R) lo_x lo_e L t0 t1 :
  0 < lo_x -> 0 < lo_e -> 0 < D_x -> 0 < D_e ->
  (forall t, t0 <= t <= t1 -> lo_x * ex t ^ 2 <= U t /\ lo_e * ee t ^ 2 <= U t) ->
  (forall t, t0 <= t <= t1 -> is_derive U t (U' t)) ->
  (forall t, t0 <= t <= t1 -> in_box t -> U' t <= 0) ->
  U t0 <= L -> L < Rmin (lo_x * D_x ^ 2) (lo_e * D_e ^ 2) ->
  forall t, t0 <= t <= t1 -> in_box t /\ U t <= L.
Proof.
  intros Hlo Hle HDx HDe Dom Der Dec U0 HL.
  assert (L1 : L < lo_x * D_x ^ 2) by (apply Rlt_le_trans with (1 := HL), Rmin_l).
  assert (L2 : L < lo_e * D_e ^ 2) by (apply Rlt_le_trans with (1 := HL), Rmin_r).
  assert (Small : forall t, t0 <= t <= t1 -> U t <= L -> in_box t).
  { intros t Ht Ut. destruct (Dom t Ht) as [P1 P2]. split; apply Rnot_le_lt; intros C.
    - assert (D_x ^ 2 <= ex t ^ 2) by (apply pow_incr; lra). nra.
    - assert (D_e ^ 2 <= ee t ^ 2) by (apply pow_incr; lra). nra. }
  assert (Falls : forall t, t0 <= t <= t1 -> (forall s, t0 <= s < t -> in_box s) -> U t <= L).
  { intros t Ht In. destruct (Req_dec t t0) as [->|N]; [exact U0|].
    destruct (MVT_gen U t0 t U') as [c [Hc E]].
    - intros x Hx. rewrite Rmin_left, Rmax_right in Hx by lra. apply Der. lra.
    - intros x Hx. rewrite Rmin_left, Rmax_right in Hx by lra.
      apply continuity_pt_filterlim. apply (ex_derive_continuous (V := R_NormedModule)). exists (U' x). apply Der. lra.
    - rewrite Rmin_left, Rmax_right in Hc by lra.
      destruct (Req_dec c t) as [->|Nc].
      + (* the mean value is taken at the end: U' <= 0 there too, by the box being open *)
        apply Rnot_lt_le. intros C.
        assert (Ut : L < U t) by exact C. clear C.
        (* there is a time before t at which U exceeds L *)
        assert (Ct : continuous U t) by (apply (ex_derive_continuous (V := R_NormedModule)); exists (U' t); apply Der; lra).
        destruct (Ct (fun v => L < v) (open_gt L (U t) Ut)) as [d P].
        set (r := Rmax (t - d / 2) ((t0 + t) / 2)).
        pose proof (cond_pos d). assert (R1 : t - d / 2 <= r) by apply Rmax_l. assert (R2 : (t0 + t) / 2 <= r) by apply Rmax_r.
        assert (R3 : r < t) by (apply Rmax_lub_lt; lra).
        assert (Ur : L < U r).
        { apply P. unfold ball; simpl; unfold AbsRing_ball, abs, minus, plus, opp; simpl.
          rewrite Rabs_left; lra. }
        destruct (MVT_gen U t0 r U') as [c' [Hc' E']].
        * intros x Hx. rewrite Rmin_left, Rmax_right in Hx by lra. apply Der. lra.
        * intros x Hx. rewrite Rmin_left, Rmax_right in Hx by lra.
          apply continuity_pt_filterlim. apply (ex_derive_continuous (V := R_NormedModule)). exists (U' x). apply Der. lra.
        * rewrite Rmin_left, Rmax_right in Hc' by lra.
          assert (U' c' <= 0) by (apply Dec; [lra | apply In; lra]). nra.
      + assert (U' c <= 0) by (apply Dec; [lra | apply In; lra]). nra. }
  intros t Ht. assert (I : in_box t).
  { revert t Ht. apply stays. intros t Ht In. apply Small, Falls; assumption. }
  split; [exact I|]. apply Falls; [exact Ht|]. intros s Hs.
  assert (J : forall s, t0 <= s <= t1 -> in_box s).
  { apply stays. intros r Hr In. apply Small; [|apply Falls]; assumption. }
  apply J. lra.
Qed.

(** Section 12.3. At samples kh: while the solution is in the box, U^t <= U_k inside the sample, where U^t dominates the errors at kh + t
    and U^h = U_(k+1); and U_0 <= L. Then the solution is in the box at all times from 0 on. *)
Theorem containment_sampled (Ut : nat -> R -> R) h lo_x L :
  0 < h -> 0 < lo_x -> 0 < D_x -> 0 < D_e ->
  (forall k t, 0 <= t <= h -> lo_x * ex (INR k * h + t) ^ 2 <= Ut k t /\ ee (INR k * h + t) ^ 2 <= Ut k t) ->
  (forall k, Ut k h = Ut (S k) 0) ->
  (forall k t, 0 < t <= h -> (forall s, 0 <= s < t -> in_box (INR k * h + s)) -> Ut k t <= Ut k 0) ->
  Ut O 0 <= L -> L < Rmin (lo_x * D_x ^ 2) (D_e ^ 2) ->
  forall k t, 0 <= t <= h -> in_box (INR k * h + t) /\ Ut k t <= L.
Proof.
  intros Hh Hlo HDx HDe Dom Next Dec U0 HL.
  assert (L1 : L < lo_x * D_x ^ 2) by (apply Rlt_le_trans with (1 := HL), Rmin_l).
  assert (L2 : L < D_e ^ 2) by (apply Rlt_le_trans with (1 := HL), Rmin_r).
  assert (Small : forall k t, 0 <= t <= h -> Ut k t <= L -> in_box (INR k * h + t)).
  { intros k t Ht Hu. destruct (Dom k t Ht) as [P1 P2]. split; apply Rnot_le_lt; intros C.
    - assert (D_x ^ 2 <= ex (INR k * h + t) ^ 2) by (apply pow_incr; lra). nra.
    - assert (D_e ^ 2 <= ee (INR k * h + t) ^ 2) by (apply pow_incr; lra). lra. }
  assert (One : forall k, Ut k 0 <= L -> forall t, 0 <= t <= h -> in_box (INR k * h + t) /\ Ut k t <= L).
  { intros k Uk.
    assert (Step : forall t, 0 <= t <= h -> (forall s, 0 <= s < t -> in_box (INR k * h + s)) -> Ut k t <= L).
    { intros t Ht In. destruct (Req_dec t 0) as [->|N]; [exact Uk|].
      apply Rle_trans with (2 := Uk). apply Dec; [lra | exact In]. }
    assert (J : forall r, INR k * h <= r <= INR k * h + h -> in_box r).
    { apply stays. intros r Hr In. replace r with (INR k * h + (r - INR k * h)) by ring.
      apply Small; [lra|]. apply Step; [lra|]. intros s Hs. apply In. lra. }
    intros t Ht. split; [apply J; lra|]. apply Step; [exact Ht|]. intros s Hs. apply J. lra. }
  intros k. induction k as [|k IH]; [apply One, U0|].
  apply One. rewrite <- Next. apply IH. lra.
Qed.

End Box.
