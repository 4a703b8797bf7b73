(** How the conditions of a certificate are decided: every quantity of [Sizes.v] is enclosed once, from the enclosures of those before
    it, and then every condition. All by [interval] in Coq's own integers ([Enclose.v]); what a tactic here does wrong leaves a
    statement unproved. *)

From Coq Require Import Reals ZArith List Lra Lia.
From SigmaStar Require Import Sums Weights WeightSum ExplicitWeights Transfer Matched Claim.
From SigmaStar Require Export Enclose Sizes.
Local Open Scope R_scope.

(** [b] with [new] in the place of [old], and the choices that this decides made. *)
Ltac put old new b :=
  let p := eval pattern old in b in
  match p with ?g _ => eval cbv beta iota delta [fst snd] in (g new) end.

(** [b] with the fields of the record [R], which is what [c] stands for. *)
Ltac opened c R b :=
  let b := lazymatch b with context [known c] => let v := eval cbv beta iota delta [known] in (known R) in put (known c) v b | _ => b end in
  let b := lazymatch b with context [rate c] => let v := eval cbv beta iota delta [rate] in (rate R) in put (rate c) v b | _ => b end in
  let b := lazymatch b with context [b_q_rms c] => let v := eval cbv beta iota delta [b_q_rms] in (b_q_rms R) in put (b_q_rms c) v b | _ => b end in
  let b := lazymatch b with context [b_qt_rms c] => let v := eval cbv beta iota delta [b_qt_rms] in (b_qt_rms R) in put (b_qt_rms c) v b | _ => b end in
  let b := lazymatch b with context [b_fx c] => let v := eval cbv beta iota delta [b_fx] in (b_fx R) in put (b_fx c) v b | _ => b end in
  let b := lazymatch b with context [q_e_max c] => let v := eval cbv beta iota delta [q_e_max] in (q_e_max R) in put (q_e_max c) v b | _ => b end in
  let b := lazymatch b with context [q_tx c] => let v := eval cbv beta iota delta [q_tx] in (q_tx R) in put (q_tx c) v b | _ => b end in
  let b := lazymatch b with context [q_te c] => let v := eval cbv beta iota delta [q_te] in (q_te R) in put (q_te c) v b | _ => b end in
  let b := lazymatch b with context [forcing c] => let v := eval cbv beta iota delta [forcing] in (forcing R) in put (forcing c) v b | _ => b end in
  let b := lazymatch b with context [matched c] => let v := eval cbv beta iota delta [matched] in (matched R) in put (matched c) v b | _ => b end in
  let b := lazymatch b with context [n c] => let v := eval cbv beta iota delta [n] in (n R) in put (n c) v b | _ => b end in
  let b := lazymatch b with context [Z_0 c] => let v := eval cbv beta iota delta [Z_0] in (Z_0 R) in put (Z_0 c) v b | _ => b end in
  let b := lazymatch b with context [gain c] => let v := eval cbv beta iota delta [gain] in (gain R) in put (gain c) v b | _ => b end in
  let b := lazymatch b with context [existence c] => let v := eval cbv beta iota delta [existence] in (existence R) in put (existence c) v b | _ => b end in
  let b := lazymatch b with context [refined c] => let v := eval cbv beta iota delta [refined] in (refined R) in put (refined c) v b | _ => b end in
  let b := lazymatch b with context [damped c] => let v := eval cbv beta iota delta [damped] in (damped R) in put (damped c) v b | _ => b end in
  let b := lazymatch b with context [domain c] => let v := eval cbv beta iota delta [domain] in (domain R) in put (domain c) v b | _ => b end in
  let b := lazymatch b with context [path_f c] => let v := eval cbv beta iota delta [path_f] in (path_f R) in put (path_f c) v b | _ => b end in
  let b := lazymatch b with context [path_q c] => let v := eval cbv beta iota delta [path_q] in (path_q R) in put (path_q c) v b | _ => b end in
  let b := lazymatch b with context [b_fe c] => let v := eval cbv beta iota delta [b_fe] in (b_fe R) in put (b_fe c) v b | _ => b end in
  let b := lazymatch b with context [b_qe c] => let v := eval cbv beta iota delta [b_qe] in (b_qe R) in put (b_qe c) v b | _ => b end in
  let b := lazymatch b with context [b_qx c] => let v := eval cbv beta iota delta [b_qx] in (b_qx R) in put (b_qx c) v b | _ => b end in
  let b := lazymatch b with context [period c] => let v := eval cbv beta iota delta [period] in (period R) in put (period c) v b | _ => b end in
  let b := lazymatch b with context [p_low c] => let v := eval cbv beta iota delta [p_low] in (p_low R) in put (p_low c) v b | _ => b end in
  let b := lazymatch b with context [p_up c] => let v := eval cbv beta iota delta [p_up] in (p_up R) in put (p_up c) v b | _ => b end in
  let b := lazymatch b with context [alpha c] => let v := eval cbv beta iota delta [alpha] in (alpha R) in put (alpha c) v b | _ => b end in
  let b := lazymatch b with context [p_low' c] => let v := eval cbv beta iota delta [p_low'] in (p_low' R) in put (p_low' c) v b | _ => b end in
  let b := lazymatch b with context [p_up' c] => let v := eval cbv beta iota delta [p_up'] in (p_up' R) in put (p_up' c) v b | _ => b end in
  let b := lazymatch b with context [alpha' c] => let v := eval cbv beta iota delta [alpha'] in (alpha' R) in put (alpha' c) v b | _ => b end in
  let b := lazymatch b with context [mu c] => let v := eval cbv beta iota delta [mu] in (mu R) in put (mu c) v b | _ => b end in
  let b := lazymatch b with context [w c] => let v := eval cbv beta iota delta [w] in (w R) in put (w c) v b | _ => b end in
  let b := lazymatch b with context [sigma c] => let v := eval cbv beta iota delta [sigma] in (sigma R) in put (sigma c) v b | _ => b end in
  let b := lazymatch b with context [X_0 c] => let v := eval cbv beta iota delta [X_0] in (X_0 R) in put (X_0 c) v b | _ => b end in
  let b := lazymatch b with context [E_0 c] => let v := eval cbv beta iota delta [E_0] in (E_0 R) in put (E_0 c) v b | _ => b end in
  let b := lazymatch b with context [X_p c] => let v := eval cbv beta iota delta [X_p] in (X_p R) in put (X_p c) v b | _ => b end in
  let b := lazymatch b with context [E_p c] => let v := eval cbv beta iota delta [E_p] in (E_p R) in put (E_p c) v b | _ => b end in
  let b := lazymatch b with context [r_x c] => let v := eval cbv beta iota delta [r_x] in (r_x R) in put (r_x c) v b | _ => b end in
  let b := lazymatch b with context [r_e c] => let v := eval cbv beta iota delta [r_e] in (r_e R) in put (r_e c) v b | _ => b end in
  let b := lazymatch b with context [r_d c] => let v := eval cbv beta iota delta [r_d] in (r_d R) in put (r_d c) v b | _ => b end in
  let b := lazymatch b with context [D_x c] => let v := eval cbv beta iota delta [D_x] in (D_x R) in put (D_x c) v b | _ => b end in
  let b := lazymatch b with context [D_e c] => let v := eval cbv beta iota delta [D_e] in (D_e R) in put (D_e c) v b | _ => b end in
  let b := lazymatch b with context [w_x c] => let v := eval cbv beta iota delta [w_x] in (w_x R) in put (w_x c) v b | _ => b end in
  let b := lazymatch b with context [h c] => let v := eval cbv beta iota delta [h] in (h R) in put (h c) v b | _ => b end in
  let b := lazymatch b with context [k_0 c] => let v := eval cbv beta iota delta [k_0] in (k_0 R) in put (k_0 c) v b | _ => b end in
  let b := lazymatch b with context [k_1 c] => let v := eval cbv beta iota delta [k_1] in (k_1 R) in put (k_1 c) v b | _ => b end in
  eval cbv beta iota delta
    [kap kap_small fst snd b_f b_fxx b_fex b_q b_qt of_qx of_qe of_decline up_to_X up_to_E value X_m E_m X_per_m E_per_m delta_m tau_m
     low high half k_p c_x c_e c_y weight cross P_up x_low e_low X_j E_j tau_j near_m near_x far_m far_x X_i E_i tau_i form_i] in b.

(** Encloses [v], which is [b] by definition, with [p] bits. *)
Ltac note_with p v b :=
  let H := fresh "enclosed" in
  interval_intro b with (i_prec p) as H;
  match type of H with
  | ?lo <= _ <= ?hi => change (lo <= v <= hi) in H
  | _ => fail 1 "no enclosure of" v
  end.

Ltac note v b := note_with constr:(120%positive) v b.

(** Enclosures that are not needed any more make every later one slower. *)
Ltac forget v := match goal with H : _ <= v <= _ |- _ => clear H end.
Ltac keep_sizes c :=
  repeat match goal with
  | H : _ <= ?v <= _ |- _ => lazymatch v with e_per c => fail | x_per c => fail | Z_per c => fail | b_lo c => fail | b_hi c => fail | _ => clear H end
  end.

(** In operations of which enclosures are known. Bounding functions and harmonics are put in this form before anything is noted of them:
    what is noted is found again by its words. *)
Ltac plain b := eval cbv beta iota zeta delta [least E_at X_at coth tanh_exp min2 max2 explicit nth_error power Rpower C_k r_0 r_t] in b.

(** What is computed of others, by its definition. *)
Ltac note_computed_with p c R v :=
  let b := eval red in v in
  let b := eval cbv beta delta [beta2 sup_of rms_of z_mean capped one_sided least_by worst] in b in
  let b := opened c R b in
  let b := plain b in
  note_with p v b.
Ltac note_computed c R v := note_computed_with constr:(120%positive) c R v.
(** What differences of nearly equal numbers make: with a gain of 1e-10 they take some 180 bits from what is left. *)
Ltac note_difference c R v := note_computed_with constr:(320%positive) c R v.

(** A sum over the harmonics [f]. *)
Ltac note_harmonics c R v :=
  let b := eval red in v in
  let b := eval cbv beta iota zeta delta [of_harmonics C_0 C_k r_0 hd tl twice_sum T_bar Z.succ Z.add Pos.succ Pos.add Pos.add_carry] in b in
  let b := opened c R b in
  let b := eval cbv beta iota zeta delta [min2 explicit nth_error power Rpower Z.to_nat Pos.to_nat Pos.iter_op Nat.add INR] in b in
  note v b.

(** The mean squares [r], which are [means c] or [last c], and what follows of them. *)
Ltac note_means c R r :=
  let part p :=
    let v := constr:(p r) in
    let b := eval cbv beta iota delta [R_x R_e R_d means last fst snd] in v in
    let b := opened c R b in note v b in
  part R_x; part R_e; part R_d;
  note_computed c R constr:(along c r); note_computed c R constr:(d_0 c r); note_computed c R constr:(bends c r);
  note_computed c R constr:(d_1 c r);
  note_computed c R constr:(R_q c r); note_computed c R constr:(R_1 c r);
  note_computed c R constr:(sup_e c r); note_computed c R constr:(rms_e c r); note_computed c R constr:(rms_d c r).

(** The sum of the weights; for eps = 1/2 in square roots. *)
Ltac note_weight_sum c R :=
  let v := eval cbv beta iota delta [n_bar2] in (n_bar2 R) in
  let E := fresh "E" in
  lazymatch v with
  | power_total ?n0 ?eps ?M =>
      first [assert (E := power_total_roots n0 M : v = _) | assert (E := power_total_powers n0 eps M)]
  | explicit_total ?l ?a ?eps ?M =>
      first [assert (E := explicit_total_roots l a M (le_n_S _ _ (Nat.le_0_l _)) : v = _)
            |assert (E := explicit_total_powers l a eps M (le_n_S _ _ (Nat.le_0_l _)))]
  end;
  match type of E with
  | _ = ?b =>
      let b' := eval cbv beta iota delta
        [sum length explicit nth_error power roots powers tail_sum Rpower Nat.add Z.succ Z.add Z.of_nat Pos.of_succ_nat Pos.succ Pos.add
         Pos.add_carry] in b in
      let H := fresh "enclosed" in
      interval_intro b' with (i_prec 90) as H;
      match type of H with ?lo <= _ <= ?hi => change (lo <= b <= hi) in H; rewrite <- E in H; change (lo <= n_bar2 c <= hi) in H end
  end; clear E.

(** Enclosures of everything in 10.2 to 10.4. *)
Ltac note_existence c :=
  let R := eval red in c in
  note_difference c R constr:(Om c); note_computed c R constr:(sg c); note_difference c R constr:(beta2_s c);
  note_difference c R constr:(bt c); note_difference c R constr:(tau c);
  note_computed c R constr:(b_lo c); note_computed c R constr:(b_hi c); note_computed c R constr:(d_b c); note_computed c R constr:(c_m c);
  note_computed c R constr:(nu_lo c); note_computed c R constr:(c_ex c);
  let k := eval cbv beta iota delta [known] in (known R) in
  match k with
  | by_functions ?o =>
      let o := plain o in
      note_computed c R constr:(F_p c o); note_computed c R constr:(bent c o); note_computed c R constr:(Q_p c o);
      note_computed c R constr:(Qt_p c o); note_computed c R constr:(Qt_start c o); note_computed c R constr:(secant c o)
  | _ => idtac
  end;
  note_computed c R constr:(a_1 c); note_computed c R constr:(Fe_p c); note_computed c R constr:(Qe_p c);
  note_computed c R constr:(Qx_p c);
  let f := eval cbv beta iota delta [forcing] in (forcing R) in
  match f with
  | None => idtac
  | Some ?f =>
      let f := plain f in
      note_harmonics c R constr:(sup_h c f); note_harmonics c R constr:(rms_h c f); note_harmonics c R constr:(rate_h c f);
      note_computed c R constr:(rest_t c f); note_harmonics c R constr:(rms_0 f); note_harmonics c R constr:(rms_m f);
      note_harmonics c R constr:(z_harmonics c f)
  end;
  let i := eval cbv beta iota delta [existence] in (existence R) in
  match i with
  | None => idtac
  | Some ?i =>
      note_computed c R constr:(Q_m c); note_computed c R constr:(rms_v c i); note_computed c R constr:(rms_by_x c i);
      note_computed c R constr:(rms_by_e c i)
  end;
  note_computed c R constr:(Q_start c); note_computed c R constr:(Fx_p c); note_computed c R constr:(beta2 c (a_1 c));
  note_computed c R constr:(x_gain c); note_computed c R constr:(from_rms c);
  match k with
  | by_functions ?o => let o := plain o in forget (F_p c o); forget (bent c o); forget (secant c o)
  | _ => idtac
  end;
  forget (c_ex c); forget (beta2_s c); forget (beta2 c (a_1 c));
  note_means c R constr:(last c); note_means c R constr:(means c);
  let d := eval cbv beta iota delta [damped] in (damped R) in
  match d with
  | None => idtac
  | Some ?k =>
      note_computed c R constr:(most_p c); note_computed c R constr:(slope c k); note_computed c R constr:(g_k c k);
      note_computed c R constr:(R_t c k (means c)); note_computed c R constr:(R_t c k (last c));
      note_computed c R constr:(slope_t c k (means c)); note_computed c R constr:(slope_t c k (last c))
  end;
  note_computed c R constr:(e_per c); note_computed c R constr:(x_per c);
  note_computed c R constr:(swing c); note_computed c R constr:(Z_per c).

(** Enclosures of everything in section 5, from those of the sizes. *)
Ltac note_stability c :=
  let R := eval red in c in
  keep_sizes c;
  note_computed c R constr:(X_b c); note_computed c R constr:(E_b c);
  let k := eval cbv beta iota delta [known] in (known R) in
  match k with
  | by_metrics _ => idtac
  | _ =>
      note_computed c R constr:(E_f c); note_computed c R constr:(E_q c); note_computed c R constr:(X_f c); note_computed c R constr:(X_q c);
      note_computed c R constr:(b_x c); note_computed c R constr:(k_x c); note_computed c R constr:(k_l c); note_computed c R constr:(most c);
      note_computed c R constr:(k_f c);
      match k with by_functions ?o => let o := plain o in note_computed c R constr:(bend c o); note_computed c R constr:(gam c o) | _ => idtac end;
      note_computed c R constr:(a_2 c); note_computed c R constr:(ht c); note_computed c R constr:(size c)
  end;
  note_computed c R constr:(d_X c); note_computed c R constr:(d_E c);
  let z := eval cbv beta iota delta [Z_0] in (Z_0 R) in
  match z with None => idtac | _ => note_weight_sum c R end;
  note_computed c R constr:(d_Z c); note_computed c R constr:(level c).

(** An inequality between two quantities with enclosures: as one of their difference. *)
Ltac decide_difference :=
  match goal with |- _ < _ => apply Rminus_lt | |- _ <= _ => apply Rminus_le end; interval with (i_prec 120).

(** That a size of the periodic solution is at most a number: by one of the bounds of which it is the smallest where that is
    exact, as it is where there is no x. *)
Ltac decide_size :=
  lazymatch goal with
  | |- ?v <= ?bound =>
      first
      [ decide_difference
      | let b := eval red in v in change v with b; solve [repeat first [apply min2_l; decide_difference | apply min2_r]]
      | fail 1 "this size is not proved:" v bound ]
  end.

(** That a size is not negative: where there is no x it is 0, and an enclosure of the smaller of two numbers is not that sharp. *)
Ltac decide_nonneg c :=
  lazymatch goal with
  | |- 0 <= ?v =>
      let R := eval red in c in
      let b := eval red in v in
      let b := opened c R b in change (0 <= b); solve [repeat apply min2_nonneg; decide_difference]
  end.

(** One condition; where it is not proved, Coq shows it. *)
Ltac decide_one c :=
  lazymatch goal with
  | |- ?g =>
      first
      [ let R := eval red in c in
        let b := eval cbv beta delta [in_domain complete gain_range covers domain_of_decline of_matrix threshold one_sided G_x G_e G_d least_by by_existence undamped signs_of C4_of
             level_of] in g in
        let b := opened c R b in
        let b := eval cbv beta iota zeta delta [min2 max2 tanh_exp r_t] in b in
        change b;
        repeat match goal with
          |- _ /\ _ => split | |- True => exact I end;
        first [decide_difference | apply Rle_refl | decide_nonneg c | lazymatch goal with |- ?leaf => fail 3 "this condition is not proved:" leaf "of" g end]
      | fail 1 "this condition is not proved:" g ]
  end.

(** All conditions on existence, or on stability. *)
Ltac decide_conditions c :=
  constructor;
  lazymatch goal with
  | |- of_its_kind _ =>
      let R := eval red in c in
      let k := eval cbv beta iota delta [known] in (known R) in
      match k with by_metrics ?j => change (by_joint c j) | _ => change (by_square c) end; constructor; decide_one c
  | _ => decide_one c
  end.

(** ** The transfer bound *)

Lemma below_S (Q : nat -> Prop) K :
  (forall k, (1 <= k < K)%nat -> Q k) -> Q K -> forall k, (1 <= k < S K)%nat -> Q k.
Proof. intros H HK k Hk. destruct (Nat.eq_dec k K) as [->|E]; [exact HK | apply H; lia]. Qed.

(** A comparison with a weight of the power family. *)
Ltac decide_weight c :=
  let R := eval red in c in
  let v := eval cbv beta iota delta [n] in (n R) in
  lazymatch goal with
  | |- ?g =>
      first
      [ change (n c) with v; cbv beta iota delta [explicit nth_error power];
        rewrite ?INR_IZR_INZ; cbn [Z.of_nat Pos.of_succ_nat Pos.succ];
        try rewrite Rpower_half by lra;
        match goal with |- ?g => let b := opened c R g in let b := eval cbv beta delta [Rpower] in b in change b end;
        decide_difference
      | fail 1 "this comparison of the transfer bound is not proved:" g ]
  end.

(** W1 to W4, and the sum of all weights: of the power family, or of a list whose weights are compared one by one. *)
Ltac decide_listed :=
  cbv beta iota delta [explicit nth_error power];
  rewrite ?INR_IZR_INZ; cbn [Z.of_nat Pos.of_succ_nat Pos.succ];
  try rewrite Rpower_half by lra;
  first [lra | unfold Rpower; decide_difference].

Ltac decide_explicit :=
  first
  [ apply le_n_S, Nat.le_0_l
  | match goal with |- Forall _ _ => repeat constructor; decide_difference end
  | cbn [length]; repeat (apply below_S; [|decide_listed]); intros l Hl; exfalso; lia
  | split; decide_difference
  | decide_listed ].

Ltac decide_weights c :=
  let R := eval red in c in
  let v := eval cbv beta iota delta [n] in (n R) in
  change (weights v);
  lazymatch v with
  | power _ _ => apply power_weights; [|split]; decide_difference
  | _ => apply explicit_weights; decide_explicit
  end.

Ltac decide_weight_sum c :=
  let R := eval red in c in
  let v := eval cbv beta iota delta [n] in (n R) in
  let b := eval cbv beta iota delta [n_bar2] in (n_bar2 R) in
  change (forall N, v O + sum1 N v <= b);
  lazymatch v with
  | power _ _ => apply power_sum; decide_difference
  | _ => apply explicit_sum; decide_explicit
  end.

(** (2.3) with the tail from K on. *)
Ltac decide_matched c W K :=
  let R := eval red in c in
  unfold transfer_bound, nu_lo, b_lo;
  let g := eval cbv beta iota delta [gain] in (gain R) in change (gain c) with g; cbv beta iota;
  let m := eval cbv beta iota delta [matched] in (matched R) in change (matched c) with m; cbv beta iota;
  split;
  [let b := eval cbv beta iota delta [w period] in (w R * period R = 2 * PI) in change b;
   first [lra | field; repeat split; apply Rgt_not_eq; interval with (i_prec 60)]
  |apply (fun nu => matched_criterion _ _ W nu _ _ K);
   [match goal with |- ?g => let b := opened c R g in change b end; interval with (i_prec 60)|lia|decide_weight c| |decide_weight c];
   repeat (apply below_S; [|decide_weight c]); intros k Hk; exfalso; lia].
