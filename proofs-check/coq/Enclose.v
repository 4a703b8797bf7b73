(** The tactic [interval with (i_prec ...)] with enclosures computed in Coq's own integers. The library's tactic computes
    with the numbers of the machine, whose specifications are axioms; this one needs none of them. Without [i_prec] the
    library's floating-point numbers are used: always give it. *)

From Interval Require Import Specific_stdz Specific_ops.
From Interval Require Export Tactic.
Module IntegerFloat := SpecificFloat StdZRadix2.
Module EncloseTactic := IntervalTactic IntegerFloat.
Export EncloseTactic.
