(** Sections 5, 10.3, 10.4, 13.1 and 13.7: the numbers of a certificate in continuous time, and what is computed of them. Nothing is proved here:
    these are the formulas in which a certificate's theorem ([Claim.v]) is stated. *)

From Coq Require Import Reals ZArith List Lra.
Local Open Scope R_scope.

(** The smaller and the larger of two numbers, in operations of which enclosures are known. *)
Definition min2 (a b : R) : R := (a + b - Rabs (a - b)) / 2.
Definition max2 (a b : R) : R := (a + b + Rabs (a - b)) / 2.

Lemma min2_Rmin a b : min2 a b = Rmin a b.
Proof. unfold min2, Rmin. destruct (Rle_dec a b); [rewrite Rabs_left1 | rewrite Rabs_right]; lra. Qed.

Lemma max2_Rmax a b : max2 a b = Rmax a b.
Proof. unfold max2, Rmax. destruct (Rle_dec a b); [rewrite Rabs_left1 | rewrite Rabs_right]; lra. Qed.

Lemma min2_l a b d : a <= d -> min2 a b <= d.
Proof. rewrite min2_Rmin. intros H. apply Rle_trans with (2 := H), Rmin_l. Qed.

Lemma min2_nonneg a b : 0 <= a -> 0 <= b -> 0 <= min2 a b.
Proof. rewrite min2_Rmin. apply Rmin_glb. Qed.

Lemma min2_r a b d : b <= d -> min2 a b <= d.
Proof. rewrite min2_Rmin. intros H. apply Rle_trans with (2 := H), Rmin_r. Qed.

(** coth(y) for y > 0. *)
Definition coth (y : R) : R := (1 + exp (- 2 * y)) / (1 - exp (- 2 * y)).

(** tanh, in a form of which enclosures are known. *)
Definition tanh_exp (x : R) : R := 1 - 2 / (exp (2 * x) + 1).

Lemma tanh_exp_tanh x : tanh_exp x = tanh x.
Proof.
  unfold tanh_exp, tanh, sinh, cosh. pose proof (exp_pos x). pose proof (exp_pos (- x)).
  assert (E : exp (2 * x) = exp x * exp x) by (rewrite <- exp_plus; f_equal; ring).
  assert (I : exp (- x) = / exp x) by apply exp_Ropp. rewrite E, I. field. nra.
Qed.

(** Along which corner a difference is split (section 5); the straight path has the bounds of both. *)
Inductive path := x_first | e_first | straight.

(** A function of (X, E). *)
Definition bound := R -> R -> R.

(** The term -kap e of the map of existence (10.4), and whether kap <= sigma is used. *)
Record damping := { kap : R; kap_small : bool }.

(** q(t,0,0) = sum of c_k e^(ik Om t) + rest (10.1): C_0, C_1, ... bound |c_k|, r_0 and r_t the root mean squares of the rest and of its
    derivative. *)
Record harmonics := { C_k : list R; r_0 : R; r_t : option R }.

(** 2 (term(k, a) + term(k+1, b) + ...) for the list a, b, ... *)
Fixpoint twice_sum (term : Z -> R -> R) (k : Z) (l : list R) : R :=
  match l with nil => 0 | cons a l => 2 * term k a + twice_sum term (Z.succ k) l end.

(** The sum over k >= 1. *)
Definition of_harmonics (f : harmonics) (term : Z -> R -> R) : R := twice_sum term 1 (tl (C_k f)).
Definition C_0 (f : harmonics) : R := hd 0 (C_k f).

(** ** What is known of the plant *)

(** The bounding functions that a specification has and the formulas of a plant do not (11.3). *)
Record functions := { b_f : bound; b_fxx : bound; b_fex : bound; b_q : bound; b_qt : bound }.

(** One value of the table of 11.3: it holds for |x| <= up_to_X, |e| <= up_to_E. *)
Record entry := { up_to_X : R; up_to_E : R; value : R }.

(** (M) of 13.7, for a point within (X_m, E_m) and one of the periodic solution within (X_per_m, E_per_m), with J + delta_m I at the
    gain tau_m. *)
Record matrix := { X_m : R; E_m : R; X_per_m : R; E_per_m : R; delta_m : R; tau_m : R }.

(** What makes U decrease: C5 with bounds of df/de, of dq/de from above and the rate, or (M). *)
Inductive decline := by_norms (fe rate : entry) (most : option entry) | by_matrix (m : matrix).

(** Of the formulas of a plant, for stability: the bounds of dq/dx and dq/de, and the above. *)
Record formulas := { of_qx : entry; of_qe : entry; of_decline : decline }.

(** Of one of two metrics (13.7): k_p, and c_x, c_e, c_y, of which its matrix is not below the diagonal one. *)
Record metric := { k_p : R; c_x : R; c_e : R; c_y : R }.

(** Its w, |p|, and P_up, x_low, e_low. *)
Record extent := { weight : R; cross : R; P_up : R; x_low : R; e_low : R }.

(** (Jm) of 13.7 at points within (X_j, E_j), with the threshold tau_j. *)
Record joint := { X_j : R; E_j : R; tau_j : R; near_m : metric; near_x : extent; far_m : metric; far_x : extent }.

Inductive knowledge := by_functions (o : functions) | by_formulas (v : formulas) | by_metrics (j : joint).

(** (E) of 13.7 at points within (X_i, E_i), with the threshold tau_i: by one matrix with k_p, c_x, c_y, or by two metrics. *)
Inductive existence_form := one (k c c' : R) | two (near far : metric).
Record inequality := { X_i : R; E_i : R; tau_i : R; form_i : existence_form }.

(** b_lo and b_hi of 13.1, and whether 1/2 <= b_lo is used. *)
Record input_gain := { low : R; high : R; half : bool }.

(** The specification, the claim and the witness of a certificate. *)
Record numbers := {
  (* The specification: section 1 and 10.1. The second triple is that of existence. *)
  period : R; p_low : R; p_up : R; alpha : R; p_low' : R; p_up' : R; alpha' : R;
  mu : R; w : R; matched : bool;
  n : nat -> R;
  n_bar2 : R; (* at least n_0 + n_1 + ... *)
  known : knowledge;
  b_fe : bound; b_qe : bound; b_qx : bound; (* of a plant's formulas: at (X_p, E_p) *)
  b_q_rms : option bound; b_qt_rms : option bound; b_fx : option bound; q_e_max : option bound; rate : option bound;
  q_tx : option bound; q_te : option bound; forcing : option harmonics;
  domain : option (R * R);
  (* The claim. Without Z_0 the regulator sets z = M e at its first instant (13.7). *)
  sigma : R; X_0 : R; E_0 : R; Z_0 : option R;
  (* The witness. *)
  gain : option input_gain;
  X_p : R; E_p : R; r_x : R; r_e : R; r_d : R; damped : option damping; existence : option inequality;
  refined : option (R * R * R);
  D_x : R; D_e : R; w_x : R; h : R; k_0 : R; k_1 : R; path_f : path; path_q : path
}.

(** The bounding functions hold at (X, E). *)
Definition in_domain (c : numbers) (X E : R) : Prop :=
  match domain c with None => True | Some (X_dom, E_dom) => X <= X_dom /\ E <= E_dom end.

(** The smaller of a function and of another one, where that is given. *)
Definition least (given : option bound) (b : bound) : bound :=
  fun X E => match given with None => b X E | Some g => min2 (g X E) (b X E) end.

Section Sizes.
Variable c : numbers.

(** The smaller of a number and of what the functions give that a plant's formulas do not have. *)
Definition capped (of : functions -> R) (v : R) : R :=
  match known c with by_functions o => min2 (of o) v | _ => v end.

(** ** Section 10.2 *)

Definition Om : R := 2 * PI / period c.
Definition sg : R := sqrt (sigma c ^ 2 + Om ^ 2).
(** beta_s^2(s) = (T/(2 s)) coth(s T/2). *)
Definition beta2 (s : R) : R := period c / (2 * s) * coth (s * period c / 2).
Definition beta2_s : R := beta2 (sigma c).
Definition bt : R := sqrt (beta2_s - 1 / sigma c ^ 2).
Definition tau : R := sqrt (period c ^ 2 / 12 - beta2_s + 1 / sigma c ^ 2) / sigma c.

(** ** Section 13.1 *)

Definition b_lo : R := match gain c with None => 1 | Some g => low g end.
Definition b_hi : R := match gain c with None => 1 | Some g => high g end.
Definition gain_range : Prop := 0 < b_lo /\ b_lo <= 1 /\ 1 <= b_hi.
(** d, c_m, and nu at b_lo. *)
Definition d_b : R :=
  match gain c with None => 1 | Some g => if half g then 1 else 1 / (2 * sqrt (low g * (1 - low g))) end.
Definition c_m : R := match gain c with None => 1 | Some g => min2 (low g) (2 / sqrt (3 + high g)) end.
Definition nu_lo : R := b_lo * mu c / w c.

(** ** Section 10.3: the bounding functions at (X_p, E_p) *)

(** c of the triple of existence, and a_1. *)
Definition c_ex : R := sqrt (p_up' c / p_low' c).
Definition F_p (o : functions) : R := b_fxx o (X_p c) 0.
Definition bent (o : functions) : R := alpha' c - c_ex * F_p o * X_p c / 2.
Definition a_1 : R :=
  match known c, rate c with
  | by_functions o, None => bent o
  | by_functions o, Some a => max2 (bent o) (a (X_p c) 0)
  | _, None => 0
  | _, Some a => a (X_p c) 0
  end.
Definition Fe_p : R := b_fe c (X_p c) (E_p c).
Definition Qe_p : R := b_qe c (X_p c) (E_p c).
Definition Qx_p : R := b_qx c (X_p c) (E_p c).
Definition Q_p (o : functions) : R := least (b_q_rms c) (b_q o) (X_p c) (E_p c).
Definition Qt_p (o : functions) : R := least (b_qt_rms c) (b_qt o) (X_p c) (E_p c).
Definition Qt_start (o : functions) : R := least (b_qt_rms c) (b_qt o) 0 0.

(** With q_0: what the answer to the harmonics is at most, and the derivative of the harmonics and of the rest. *)
Definition sup_h (f : harmonics) : R := of_harmonics f (fun k a => a / sqrt (sigma c ^ 2 + (IZR k * Om) ^ 2)) / b_lo.
Definition rms_h (f : harmonics) : R := sqrt (of_harmonics f (fun k a => a ^ 2 / (sigma c ^ 2 + (IZR k * Om) ^ 2))) / b_lo.
Definition rate_h (f : harmonics) : R := sqrt (of_harmonics f (fun k a => (IZR k * Om * a) ^ 2)).
Definition rest_t (f : harmonics) : R :=
  match known c, r_t f with
  | by_functions o, None => Qt_start o + rate_h f
  | by_functions o, Some r => min2 r (Qt_start o + rate_h f)
  | _, None => 0
  | _, Some r => r
  end.
Definition rms_0 (f : harmonics) : R := sqrt (C_0 f ^ 2 + of_harmonics f (fun _ a => a ^ 2)) + r_0 f.

(** Q_0. *)
Definition Q_start : R :=
  match known c, forcing c with
  | by_functions o, None => least (b_q_rms c) (b_q o) 0 0
  | by_functions o, Some f => min2 (rms_0 f) (least (b_q_rms c) (b_q o) 0 0)
  | _, None => 0
  | _, Some f => rms_0 f
  end.
Definition secant (o : functions) : R := b_f o (X_p c) 0 / X_p c + F_p o * X_p c.
Definition Fx_p : R :=
  match known c, b_fx c with
  | by_functions o, None => secant o
  | by_functions o, Some b => min2 (b (X_p c) 0) (secant o)
  | _, None => 0
  | _, Some b => b (X_p c) 0
  end.
(** (c/a_1) b_fe and K_2(a_1) b_fe. *)
Definition x_gain : R := c_ex / a_1 * Fe_p.
Definition from_rms : R := c_ex * sqrt (beta2 a_1) * Fe_p.

(** The mean squares at which R_q and R_1 are taken: those of the map of existence, and those of the solution. *)
Definition means : R * R * R := (r_x c, r_e c, r_d c).
Definition last : R * R * R := match refined c with None => means | Some r => r end.
Definition R_x (r : R * R * R) : R := fst (fst r).
Definition R_e (r : R * R * R) : R := snd (fst r).
Definition R_d (r : R * R * R) : R := snd r.

Definition R_q (r : R * R * R) : R := capped Q_p (Q_start + Qx_p * R_x r + Qe_p * R_e r).
Definition along (r : R * R * R) : R := Qx_p * (Fx_p * R_x r + Fe_p * R_e r) + Qe_p * R_d r.
(** d_0 and d_1: of q - q(t,0,0). *)
Definition d_0 (r : R * R * R) : R := Qx_p * R_x r + Qe_p * R_e r.
Definition bends (r : R * R * R) : R :=
  match q_tx c, q_te c with
  | Some q_tx, Some q_te => q_tx (X_p c) (E_p c) * R_x r + q_te (X_p c) (E_p c) * R_e r + along r
  | _, _ => 0
  end.
Definition d_1 (r : R * R * R) : R :=
  match known c, q_tx c, q_te c with
  | by_functions o, Some _, Some _ => min2 (Qt_p o + Qt_start o + along r) (bends r)
  | by_functions o, _, _ => Qt_p o + Qt_start o + along r
  | _, _, _ => bends r
  end.
Definition R_1 (r : R * R * R) : R :=
  match known c, forcing c with
  | by_functions o, None => Qt_p o + along r
  | by_functions o, Some f => min2 (Qt_p o + along r) (rate_h f + rest_t f + d_1 r)
  | _, None => 0
  | _, Some f => rate_h f + rest_t f + d_1 r
  end.

(** What follows of sup|e|, rms(e), rms(e') for an input with these root mean squares of itself and of its derivative, and at r. *)
Definition sup_of (q q' : R) : R := min2 (bt / b_lo * q) (tau / b_lo * q').
Definition rms_of (q q' : R) : R := min2 (q / (b_lo * sg)) (q' / (Om * (b_lo * sg))).

(** (13.7d): Q_m, and what (E) says of a solution, by the worse of two metrics. *)
Definition rms_m (f : harmonics) : R := sqrt (of_harmonics f (fun _ a => a ^ 2)) + r_0 f.
Definition Q_m : R := match forcing c with None => 0 | Some f => rms_m f end.
Definition worst (i : inequality) (of : metric -> R) : R :=
  match form_i i with
  | one k c_1 c_2 => of {| k_p := k; c_x := c_1; c_e := 2 * (sigma c - tau_i i); c_y := c_2 |}
  | two near far => max2 (of near) (of far)
  end.
Definition rms_v (i : inequality) : R := worst i (fun m => k_p m / c_y m) * Q_m.
Definition rms_by_x (i : inequality) : R := worst i (fun m => k_p m / (2 * sqrt (c_x m * c_y m))) * Q_m.
Definition rms_by_e (i : inequality) : R := worst i (fun m => k_p m / (2 * sqrt (c_e m * c_y m))) * Q_m.
(** The least with a bound that (E) gives. *)
Definition least_by (by_E : inequality -> R) (v : R) : R := match existence c with None => v | Some i => min2 v (by_E i) end.
Definition sup_e (r : R * R * R) : R :=
  let e := min2 (sup_of (R_q r) (R_1 r)) (sqrt (period c * R_e r * R_d r)) in
  least_by (fun i => bt * rms_v i)
  match forcing c with
  | None => e
  | Some f => min2 e (sup_h f + sup_of (r_0 f) (rest_t f) + sup_of (d_0 r) (d_1 r))
  end.
Definition rms_e (r : R * R * R) : R :=
  let e := rms_of (R_q r) (R_1 r) in
  least_by (fun i => match gain c with None => min2 (rms_v i / sg) (rms_by_e i) | Some _ => rms_v i / sg end)
  match forcing c with
  | None => e
  | Some f => min2 e (rms_h f + rms_of (r_0 f) (rest_t f) + rms_of (d_0 r) (d_1 r))
  end.
Definition rms_d (r : R * R * R) : R := least_by rms_v (min2 (d_b * R_q r) (R_1 r / (b_lo * sg))).

(** ** Section 10.4: with -kap e in the linear part *)

Definition most_p : R := match q_e_max c with None => Qe_p | Some m => min2 (m (X_p c) (E_p c)) Qe_p end.
Definition slope (k : damping) : R := max2 (most_p + kap k) (Qe_p - kap k).
Definition g_k (k : damping) : R :=
  if kap_small k then 1 / (b_lo * sigma c + kap k) else 1 / (2 * sqrt (sigma c * (kap k - (1 - b_lo) * sigma c))).
Definition R_t (k : damping) (r : R * R * R) : R := Q_start + Qx_p * R_x r + slope k * R_e r.
Definition slope_t (k : damping) (r : R * R * R) : R :=
  match gain c with None => R_t k r + kap k * R_e r | Some _ => d_b * R_t k r end.

(** G of 10.3: the smallest of what bounds the mean squares of the solution. *)
Definition G_x (r : R * R * R) : R := least_by rms_by_x (x_gain * R_e r).
Definition G_e (r : R * R * R) : R :=
  match damped c with None => rms_e r | Some k => min2 (rms_e r) (g_k k * R_t k r) end.
Definition G_d (r : R * R * R) : R :=
  match damped c with None => rms_d r | Some k => min2 (rms_d r) (slope_t k r) end.

(** Of a plant's formulas all is given that stands in the place of the functions: no 0 above is used. *)
Definition complete : Prop :=
  match known c with
  | by_functions _ => True
  | _ =>
      match rate c, b_fx c, q_tx c, q_te c, forcing c with
      | Some _, Some _, Some _, Some _, Some f => match r_t f with None => False | Some _ => True end
      | _, _, _, _, _ => False
      end
  end.

(** 1 + x (1-b) y at the two ends of b, in squares: of (B), C5B and E4. *)
Definition undamped (x y z : R) (less : R -> R -> Prop) : Prop :=
  less ((1 + x * (1 - b_lo) * y) ^ 2) z /\ less ((1 + x * (1 - b_hi) * y) ^ 2) z.

(** (E): it is about formulas, its numbers are above 0, E1 to E4. *)
Definition by_existence (i : inequality) : Prop :=
  match known c with by_functions _ => False | _ => True end /\
  X_p c <= X_i i /\ E_p c <= E_i i /\
  match form_i i with
  | one k c_1 c_2 =>
      tau_i i < sigma c /\ (0 < tau_i i /\ 0 < k /\ 0 < c_1 /\ 0 < c_2) /\
      match gain c with None => True | Some _ => undamped (k / 2) (tau_i i) (2 * tau_i i * (k - c_2)) Rle end
  | two m m' =>
      tau_i i <= sigma c /\ (0 < tau_i i /\ 0 < k_p m /\ 0 < c_x m /\ 0 < c_e m /\ 0 < c_y m) /\
      (0 < k_p m' /\ 0 < c_x m' /\ 0 < c_e m' /\ 0 < c_y m') /\ match gain c with None => True | Some _ => False end
  end.

(** The sizes of the periodic solution. *)
Definition e_per : R := min2 (E_p c) (sup_e last).
Definition x_per : R := min2 (X_p c) (min2 (x_gain * e_per) (from_rms * R_e last)).

(** S1 to S3, the signs they need, and that the functions hold up to (X_p, E_p). What a choice leaves out is excluded with it: in Coq
    1/0 = 0, and the root of a negative number is 0. *)
Record existence_conditions : Prop := {
  complete_p : complete;
  signs_p : 0 < sigma c /\ 0 < X_p c /\ 0 < E_p c /\ 0 < r_x c /\ 0 < r_e c /\ 0 < r_d c;
  signs_s : (0 < period c /\ 0 < mu c /\ 0 < w c) /\ 0 < p_low' c <= p_up' c;
  gain_p : gain_range /\ match gain c with None => True | Some g => if half g then 1 / 2 <= low g else low g < 1 end;
  domain_p : in_domain c (X_p c) (E_p c);
  S1 : 0 < a_1;
  damping_p : match damped c with
              | None => True
              | Some k =>
                  0 < kap k /\
                  (if kap_small k then kap k <= (2 - b_lo) * sigma c else (1 - b_lo) * sigma c < kap k) /\
                  match q_e_max c with None => True | Some m => - Qe_p <= m (X_p c) (E_p c) end
              end;
  S2 : match existence c with
       | Some i =>
           by_existence i /\ min2 (x_gain * E_p c) (from_rms * r_e c) < X_p c /\
           G_x means < r_x c /\ sup_e means < E_p c /\ G_e means < r_e c /\ G_d means < r_d c
       | None =>
           (min2 (x_gain * E_p c) (from_rms * r_e c) <= X_p c /\ x_gain * r_e c <= r_x c) /\
           match damped c with
           | None => sup_e means <= E_p c /\ rms_e means <= r_e c /\ rms_d means <= r_d c
           | Some k => sqrt (period c * r_e c * r_d c) <= E_p c /\ g_k k * R_t k means <= r_e c /\ slope_t k means <= r_d c
           end
       end;
  S3 : match refined c with
       | None => True
       | Some _ =>
           (0 < R_x last /\ 0 < R_e last /\ 0 < R_d last) /\ G_x last < R_x last /\ G_e last < R_e last /\ G_d last < R_d last
       end;
  (* Else a bounding function is negative, and no solution has these sizes. *)
  signs_per : 0 <= x_per /\ 0 <= e_per
}.

(** (3.2), and its form for q_0: T_N at k Om/w is at most T_bar(k). *)
Definition T_bar (k : Z) : R :=
  let line := k_0 c + k_1 c * (IZR k * Om / w c) ^ 2 in
  if matched c then min2 line (2 / (nu_lo ^ 2 * n c (Z.to_nat k))) else line.
Definition z_mean (q q' : R) : R := (k_0 c / w c ^ 2 * q ^ 2 + k_1 c / w c ^ 4 * q' ^ 2) / c_m ^ 2.
Definition z_harmonics (f : harmonics) : R :=
  sqrt (1 / (nu_lo ^ 2 * n c O) * C_0 f ^ 2 + of_harmonics f (fun k a => T_bar k * a ^ 2)) / w c / c_m.
Definition swing : R := period c / (2 * b_lo ^ 3 * mu c) * R_q last ^ 2.
Definition Z_per : R :=
  let plain := swing + z_mean (R_q last) (R_1 last) in
  sqrt match forcing c with
       | None => plain
       | Some f =>
           min2 plain (swing + (z_harmonics f + sqrt (z_mean (r_0 f) (rest_t f)) + sqrt (z_mean (d_0 last) (d_1 last))) ^ 2)
       end.

(** ** Section 5 *)

Definition X_b : R := x_per + D_x c.
Definition E_b : R := e_per + D_e c.
Definition E_at (p : path) : R := match p with x_first => e_per | _ => E_b end.
Definition X_at (p : path) : R := match p with e_first => x_per | _ => X_b end.
Definition E_f : R := E_at (path_f c).
Definition E_q : R := E_at (path_q c).
Definition X_f : R := X_at (path_f c).
Definition X_q : R := X_at (path_q c).

(** Joint metrics use neither these nor a_2, and with (M) neither k_f nor a_2 is used. *)
Definition b_x : R :=
  match known c with by_functions _ => b_qx c X_b E_q | by_formulas v => value (of_qx v) | by_metrics _ => 0 end.
Definition k_x : R := b_x / sqrt (p_low c).
Definition k_l : R :=
  match known c with by_functions _ => b_qe c X_q E_b | by_formulas v => value (of_qe v) | by_metrics _ => 0 end.
(** dq/de from above, where that is given. *)
Definition one_sided : option R :=
  match known c with
  | by_functions _ => match q_e_max c with None => None | Some m => Some (m X_q E_b) end
  | by_formulas v => match of_decline v with by_norms _ _ (Some m) => Some (value m) | _ => None end
  | by_metrics _ => None
  end.
Definition most : R := match one_sided with None => k_l | Some m => min2 m k_l end.
Definition k_f : R :=
  match known c with
  | by_functions _ => b_fe c X_f E_b
  | by_formulas v => match of_decline v with by_norms fe _ _ => value fe | by_matrix _ => 0 end
  | by_metrics _ => 0
  end.
(** What bounds df/dx - F by curvature (Lemma 5.1), and gamma. *)
Definition bend (o : functions) : R := b_fxx o x_per 0 * x_per + b_fex o x_per E_f * E_f + b_fxx o X_b E_f * D_x c / 2.
Definition gam (o : functions) : R := sqrt (p_up c / p_low c) * bend o.
Definition a_2 : R :=
  match known c with
  | by_functions o => match rate c with None => alpha c - gam o | Some a => max2 (alpha c - gam o) (a X_b E_f) end
  | by_formulas v => match of_decline v with by_norms _ rate _ => value rate | by_matrix _ => 0 end
  | by_metrics _ => 0
  end.
Definition ht : R := h c / mu c.
Definition size : R :=
  max2 (Rabs (1 + ht * (most + (1 - b_lo) * sigma c))) (Rabs (1 - ht * (k_l - (1 - b_hi) * sigma c))).

Definition d_X : R := X_0 c + x_per.
Definition d_E : R := E_0 c + e_per.
Definition d_Z : R := match Z_0 c with None => Z_per | Some z => z + sqrt (n_bar2 c) * E_0 c + Z_per end.
(** The left side of C4; and of C4 and C4f for a metric. *)
Definition level : R := w_x c * p_up c * d_X ^ 2 + d_E ^ 2 + b_hi * h c * d_Z ^ 2.
Definition level_of (m : metric) (x : extent) : R :=
  P_up x * d_X ^ 2 + 2 * cross x * d_X * d_E + weight x * d_E ^ 2 + k_p m * mu c / 2 * d_Z ^ 2.

(** The arguments of section 5 are those up to which a value holds. *)
Definition covers (v : entry) (X E : R) : Prop := X <= up_to_X v /\ E <= up_to_E v.
Definition domain_of_decline (d : decline) : Prop :=
  match d with
  | by_norms fe rate m =>
      covers fe X_f E_b /\ covers rate X_b E_f /\ match m with None => True | Some m => covers m X_q E_b end
  | by_matrix m => X_b <= X_m m /\ E_b <= E_m m /\ x_per <= X_per_m m /\ e_per <= E_per_m m
  end.

(** (M) in the place of C5 and C5b, and the threshold. *)
Definition of_matrix : option matrix :=
  match known c with by_formulas v => match of_decline v with by_norms _ _ _ => None | by_matrix m => Some m end | _ => None end.
Definition threshold : R := match of_matrix with None => sigma c | Some m => tau_m m end.

Definition signs_of (m : metric) (x : extent) : Prop :=
  (0 < k_p m /\ 0 < c_x m /\ 0 < c_e m /\ 0 < c_y m) /\ 0 <= weight x /\ 0 <= cross x /\ 0 <= P_up x /\ 0 < x_low x /\ 0 < e_low x.
Definition C4_of (m : metric) (x : extent) : Prop := level_of m x < min2 (x_low x * D_x c ^ 2) (e_low x * D_e c ^ 2).

(** C4, C5 and C5b of (10.5), M of 10.1, the signs they need, and that what is known of the plant holds up to (X_b, E_b); with (M) its
    margins and C5m; with an input gain (B), with (M) C5B. *)
Record by_square : Prop := {
  signs_w : 0 < p_low c /\ 0 < p_up c /\ 0 < w_x c /\ 0 < h c;
  nonneg : 0 <= k_x /\ 0 <= k_f;
  domain_b : match known c with
             | by_formulas v => covers (of_qx v) X_b E_q /\ covers (of_qe v) X_q E_b /\ domain_of_decline (of_decline v)
             | _ => in_domain c X_b E_b
             end;
  M_b : match one_sided with None => True | Some m => - k_l <= m end;
  C4 : level < min2 (w_x c * p_low c * D_x c ^ 2) (D_e c ^ 2);
  C5_ : match of_matrix with None => ht * k_x ^ 2 < 4 * (w_x c * a_2) | Some m => 0 < delta_m m end;
  C5b : match of_matrix with
        | None =>
            size ^ 2 / (4 * ht)
            + (w_x c * sqrt (p_up c) * k_f + k_x * size / 2) ^ 2 / (4 * (w_x c * a_2) - ht * k_x ^ 2) < sigma c
        | Some m => 0 < tau_m m /\ tau_m m < sigma c
        end;
  C5B : match gain c with None => True | Some _ => undamped ht threshold (4 * ht * threshold) Rlt end
}.

(** (Jm): C4, C4f, C5x, C5e and C5s, without an input gain. *)
Record by_joint (j : joint) : Prop := {
  signs_j : 0 < tau_j j /\ signs_of (near_m j) (near_x j) /\ signs_of (far_m j) (far_x j);
  gain_j : match gain c with None => True | Some _ => False end;
  C5x : X_b <= X_j j;
  C5e : E_b <= E_j j;
  C4_near : C4_of (near_m j) (near_x j);
  C4_far : C4_of (far_m j) (far_x j);
  C5s : tau_j j <= sigma c
}.

Definition of_its_kind : Prop := match known c with by_metrics j => by_joint j | _ => by_square end.

(** The conditions of stability. *)
Record stability_conditions : Prop := {
  signs_b : 0 < mu c /\ 0 < sigma c /\ 0 < D_x c /\ 0 < D_e c;
  signs_0 : 0 <= X_0 c /\ 0 <= E_0 c /\ match Z_0 c with None => True | Some z => 0 <= z end;
  signs_g : gain_range;
  stability : of_its_kind
}.

End Sizes.
