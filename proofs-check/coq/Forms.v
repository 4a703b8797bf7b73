(** Quadratic forms in two to four variables: when they are positive. *)

From Coq Require Import Reals Lra Lia.
From SigmaStar Require Import Sums.
Local Open Scope R_scope.

(** Two variables, with the margin that the minors leave. *)
Lemma form2_margin al be ga : 0 < al -> be ^ 2 < 4 * al * ga ->
  exists r, 0 < r /\ forall x y, r * (x ^ 2 + y ^ 2) <= al * x ^ 2 - be * x * y + ga * y ^ 2.
Proof.
  intros Ha Hd. pose proof (pow2_ge_0 be). assert (Hg : 0 < ga) by (apply Rnot_le_lt; intros E; nra).
  set (r := (4 * al * ga - be ^ 2) / (4 * (al + ga))).
  assert (Er : r * (4 * (al + ga)) = 4 * al * ga - be ^ 2) by (unfold r; field; lra).
  assert (Hr : 0 < r) by (apply Rdiv_lt_0_compat; lra).
  exists r. split; [exact Hr|]. intros x y.
  assert (H1 : r < al) by (apply Rnot_le_lt; intros E; nra).
  assert (H2 : be ^ 2 <= 4 * (al - r) * (ga - r)) by nra.
  assert (H3 : 0 <= 4 * (al - r) * ((al - r) * x ^ 2 - be * x * y + (ga - r) * y ^ 2)).
  { replace (4 * (al - r) * ((al - r) * x ^ 2 - be * x * y + (ga - r) * y ^ 2))
      with ((2 * (al - r) * x - be * y) ^ 2 + (4 * (al - r) * (ga - r) - be ^ 2) * y ^ 2) by ring.
    pose proof (pow2_ge_0 (2 * (al - r) * x - be * y)). pose proof (pow2_ge_0 y).
    assert (0 <= (4 * (al - r) * (ga - r) - be ^ 2) * y ^ 2) by (apply Rmult_le_pos; lra). lra. }
  assert (H4 : 0 <= (al - r) * x ^ 2 - be * x * y + (ga - r) * y ^ 2).
  { apply Rnot_lt_le. intros E. nra. }
  lra.
Qed.

Definition form2 a b c x y := a * x ^ 2 + 2 * b * x * y + c * y ^ 2.
Definition minor2 a b c := a * c - b ^ 2.

Definition form3 a b c d e f x y z :=
  a * x ^ 2 + 2 * b * x * y + 2 * c * x * z + d * y ^ 2 + 2 * e * y * z + f * z ^ 2.
(** The determinant of the symmetric matrix with the rows (a b c), (. d e), (. . f). *)
Definition minor3 a b c d e f := a * d * f + 2 * b * c * e - a * e ^ 2 - d * c ^ 2 - f * b ^ 2.

Definition form4 a b c d e f g h i j x y z u :=
  a * x ^ 2 + 2 * b * x * y + 2 * c * x * z + 2 * d * x * u + e * y ^ 2 + 2 * f * y * z + 2 * g * y * u
  + h * z ^ 2 + 2 * i * z * u + j * u ^ 2.
(** The determinant of the symmetric matrix with the rows (a b c d), (. e f g), (. . h i), (. . . j). *)
Definition minor4 a b c d e f g h i j :=
  a * minor3 e f g h i j
  - b * (b * (h * j - i ^ 2) - f * (c * j - d * i) + g * (c * i - d * h))
  + c * (b * (f * j - g * i) - e * (c * j - d * i) + g * (c * g - d * f))
  - d * (b * (f * i - g * h) - e * (c * i - d * h) + f * (c * g - d * f)).

Lemma square_pos x : x <> 0 -> 0 < x ^ 2.
Proof. intros Hx. assert (H := pow2_ge_0 x). assert (x ^ 2 <> 0) by (apply pow_nonzero; exact Hx). lra. Qed.

Lemma form2_pos a b c : 0 < a -> 0 < minor2 a b c ->
  forall x y, x <> 0 \/ y <> 0 -> 0 < form2 a b c x y.
Proof.
  unfold minor2, form2. intros Ha Hm x y Hxy.
  assert (E : a * (a * x ^ 2 + 2 * b * x * y + c * y ^ 2) = (a * x + b * y) ^ 2 + (a * c - b ^ 2) * y ^ 2) by ring.
  assert (P : 0 < (a * x + b * y) ^ 2 + (a * c - b ^ 2) * y ^ 2).
  { destruct (Req_dec y 0) as [->|Hy].
    - assert (0 < (a * x + b * 0) ^ 2); [|lra]. apply square_pos. destruct Hxy as [Hx|Hx]; nra.
    - pose proof (pow2_ge_0 (a * x + b * y)). pose proof (square_pos y Hy).
      assert (0 < (a * c - b ^ 2) * y ^ 2) by (apply Rmult_lt_0_compat; lra). lra. }
  rewrite <- E in P. apply Rnot_le_lt. intros E1. nra.
Qed.

(** Section 12.3, (C5h): three leading minors (Sylvester). *)
Theorem form3_pos a b c d e f : 0 < a -> 0 < minor2 a b d -> 0 < minor3 a b c d e f ->
  forall x y z, x <> 0 \/ y <> 0 \/ z <> 0 -> 0 < form3 a b c d e f x y z.
Proof.
  intros Ha H2 H3 x y z Hn.
  assert (E : a * form3 a b c d e f x y z
              = (a * x + b * y + c * z) ^ 2 + form2 (a * d - b ^ 2) (a * e - b * c) (a * f - c ^ 2) y z)
    by (unfold form3, form2; ring).
  assert (M : minor2 (a * d - b ^ 2) (a * e - b * c) (a * f - c ^ 2) = a * minor3 a b c d e f)
    by (unfold minor2, minor3; ring).
  assert (P : 0 < a * form3 a b c d e f x y z).
  { rewrite E. pose proof (pow2_ge_0 (a * x + b * y + c * z)).
    destruct (Req_dec y 0) as [Ey|Ey]; [destruct (Req_dec z 0) as [Ez|Ez]|].
    - subst y z. unfold form2. assert (0 < (a * x + b * 0 + c * 0) ^ 2); [|lra].
      apply square_pos. destruct Hn as [Hx|[Hx|Hx]]; [|contradiction|contradiction].
      replace (a * x + b * 0 + c * 0) with (a * x) by ring. apply Rmult_integral_contrapositive; split; lra || exact Hx.
    - assert (0 < form2 (a * d - b ^ 2) (a * e - b * c) (a * f - c ^ 2) y z); [|lra].
      apply form2_pos; [exact H2 | rewrite M; apply Rmult_lt_0_compat; assumption | right; exact Ez].
    - assert (0 < form2 (a * d - b ^ 2) (a * e - b * c) (a * f - c ^ 2) y z); [|lra].
      apply form2_pos; [exact H2 | rewrite M; apply Rmult_lt_0_compat; assumption | left; exact Ey]. }
  apply Rnot_le_lt. intros E1. nra.
Qed.

(** Section 13.4, (C5d): four leading minors. *)
Theorem form4_pos a b c d e f g h i j :
  0 < a -> 0 < minor2 a b e -> 0 < minor3 a b c e f h -> 0 < minor4 a b c d e f g h i j ->
  forall x y z u, x <> 0 \/ y <> 0 \/ z <> 0 \/ u <> 0 -> 0 < form4 a b c d e f g h i j x y z u.
Proof.
  intros Ha H2 H3 H4 x y z u Hn.
  set (E2 := a * e - b ^ 2). set (F2 := a * f - b * c). set (G2 := a * g - b * d).
  set (Hh := a * h - c ^ 2). set (I2 := a * i - c * d). set (J2 := a * j - d ^ 2).
  assert (E : a * form4 a b c d e f g h i j x y z u
              = (a * x + b * y + c * z + d * u) ^ 2 + form3 E2 F2 G2 Hh I2 J2 y z u)
    by (unfold form4, form3, E2, F2, G2, Hh, I2, J2; ring).
  assert (M2 : minor2 E2 F2 Hh = a * minor3 a b c e f h) by (unfold minor2, minor3, E2, F2, Hh; ring).
  assert (M3 : minor3 E2 F2 G2 Hh I2 J2 = a ^ 2 * minor4 a b c d e f g h i j)
    by (unfold minor3, minor4, minor3, E2, F2, G2, Hh, I2, J2; ring).
  assert (Q : y <> 0 \/ z <> 0 \/ u <> 0 -> 0 < form3 E2 F2 G2 Hh I2 J2 y z u).
  { apply form3_pos; [exact H2 | rewrite M2; apply Rmult_lt_0_compat; assumption |].
    rewrite M3. apply Rmult_lt_0_compat; [apply pow_lt; exact Ha | exact H4]. }
  assert (P : 0 < a * form4 a b c d e f g h i j x y z u).
  { rewrite E. pose proof (pow2_ge_0 (a * x + b * y + c * z + d * u)).
    destruct (Req_dec y 0) as [Ey|Ey]; [destruct (Req_dec z 0) as [Ez|Ez]; [destruct (Req_dec u 0) as [Eu|Eu]|]|].
    - subst y z u. unfold form3. assert (0 < (a * x + b * 0 + c * 0 + d * 0) ^ 2); [|lra].
      apply square_pos. assert (Hx : x <> 0) by tauto.
      replace (a * x + b * 0 + c * 0 + d * 0) with (a * x) by ring.
      apply Rmult_integral_contrapositive; split; lra || exact Hx.
    - assert (0 < form3 E2 F2 G2 Hh I2 J2 y z u) by (apply Q; tauto). lra.
    - assert (0 < form3 E2 F2 G2 Hh I2 J2 y z u) by (apply Q; tauto). lra.
    - assert (0 < form3 E2 F2 G2 Hh I2 J2 y z u) by (apply Q; tauto). lra. }
  apply Rnot_le_lt. intros E1. nra.
Qed.
