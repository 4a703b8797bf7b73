(** What is not negative, has a bounded integral and does not rise too fast tends to 0 (a one-sided lemma of Barbalat). *)

From Coq Require Import Reals Lra Lia.
From Coquelicot Require Import Coquelicot.
Local Open Scope R_scope.

Section Vanish.
Variables g g' : R -> R.
Variables t0 C I : R.
Hypothesis C_pos : 0 < C.
Hypothesis g_nonneg : forall t, t0 <= t -> 0 <= g t.
Hypothesis g_derive : forall t, t0 <= t -> is_derive g t (g' t).
Hypothesis g_slope : forall t, t0 <= t -> g' t <= C.
Hypothesis g_integral : forall t, t0 <= t -> RInt g t0 t <= I.

Let g_continuous t : t0 <= t -> continuous g t.
Proof. intros H. apply (ex_derive_continuous (V := R_NormedModule)). eexists. apply g_derive, H. Qed.

Let g_integrable a b : t0 <= a -> a <= b -> ex_RInt g a b.
Proof.
  intros Ha Hb. apply (ex_RInt_continuous (V := R_CompleteNormedModule)). intros t Ht.
  rewrite Rmin_left, Rmax_right in Ht by lra. apply g_continuous. lra.
Qed.

(** Where g is eps, it has been eps/2 for a while. *)
Lemma has_been eps t r : t0 <= r -> t - eps / (2 * C) <= r <= t -> eps <= g t -> eps / 2 <= g r.
Proof.
  intros H0 Hr He. destruct (Req_dec r t) as [->|Hne].
  { destruct (Rle_lt_dec 0 eps); [lra|]. pose proof (g_nonneg t H0). lra. }
  destruct (MVT_gen g r t g') as [v [Hv E]].
  - intros v Hv. rewrite Rmin_left, Rmax_right in Hv by lra. apply g_derive. lra.
  - intros v Hv. rewrite Rmin_left, Rmax_right in Hv by lra. apply continuity_pt_filterlim, g_continuous. lra.
  - rewrite Rmin_left, Rmax_right in Hv by lra.
    assert (g' v * (t - r) <= C * (t - r)) by (apply Rmult_le_compat_r; [lra | apply g_slope; lra]).
    assert (C * (t - r) <= C * (eps / (2 * C))) by (apply Rmult_le_compat_l; lra).
    replace (C * (eps / (2 * C))) with (eps / 2) in * by (field; lra). lra.
Qed.

Theorem vanishes : forall eps, 0 < eps -> exists t1, t0 <= t1 /\ forall t, t1 <= t -> g t < eps.
Proof.
  intros eps He. apply Classical_Prop.NNPP. intros N.
  assert (Often : forall t1, t0 <= t1 -> exists t, t1 <= t /\ eps <= g t).
  { intros t1 H1. apply Classical_Prop.NNPP. intros M. apply N. exists t1. split; [exact H1|].
    intros t Ht. apply Rnot_le_lt. intros L. apply M. exists t. split; assumption. }
  set (d := eps / (2 * C)). assert (Hd : 0 < d) by (apply Rdiv_lt_0_compat; lra).
  set (k := d * (eps / 2)). assert (Hk : 0 < k) by (apply Rmult_lt_0_compat; lra).
  assert (Grows : forall n, exists t, t0 <= t /\ INR n * k <= RInt g t0 t).
  { induction n as [|n [r [Hr IH]]].
    - exists t0. split; [lra|]. rewrite RInt_point. simpl. change (zero : R) with 0. lra.
    - destruct (Often (r + d) ltac:(lra)) as [t [Ht Hg]]. exists t. split; [lra|]. rewrite S_INR.
      assert (E1 : RInt g t0 r + RInt g r t = RInt g t0 t)
        by (apply (RInt_Chasles (V := R_CompleteNormedModule)); apply g_integrable; lra).
      assert (E2 : RInt g r (t - d) + RInt g (t - d) t = RInt g r t)
        by (apply (RInt_Chasles (V := R_CompleteNormedModule)); apply g_integrable; lra).
      assert (0 <= RInt g r (t - d)).
      { apply RInt_ge_0; [lra | apply g_integrable; lra | intros v Hv; apply g_nonneg; lra]. }
      assert (k <= RInt g (t - d) t).
      { apply Rle_trans with (RInt (fun _ => eps / 2) (t - d) t).
        - rewrite RInt_const. unfold scal; simpl; unfold mult; simpl. right. unfold k. ring.
        - apply RInt_le; [lra | apply ex_RInt_const | apply g_integrable; lra|].
          intros v Hv. apply (has_been eps t); [lra | fold d; lra | exact Hg]. }
      lra. }
  destruct (archimed (I / k)) as [A _]. set (n := up (I / k)) in *.
  assert (Hn : I / k < INR (Z.to_nat (Z.max 0 n))).
  { rewrite INR_IZR_INZ, Z2Nat.id by lia. apply Rlt_le_trans with (1 := A). apply IZR_le. lia. }
  destruct (Grows (Z.to_nat (Z.max 0 n))) as [t [Ht Q]]. pose proof (g_integral t Ht) as B.
  assert (I < INR (Z.to_nat (Z.max 0 n)) * k).
  { apply Rmult_lt_compat_r with (r := k) in Hn; [|exact Hk]. replace (I / k * k) with I in Hn by (field; lra). exact Hn. }
  lra.
Qed.

End Vanish.
