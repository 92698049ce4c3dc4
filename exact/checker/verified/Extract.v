(** The checker as OCaml. Integers become Zarith's, through integers.ml; what stands here and there is
    to be believed. *)

Require Import ZArith Extraction ExtrOcamlBasic.
Require Import Verified.Checker Verified.Inversion Verified.Problem Verified.Step Verified.StepSequence.

Extract Inductive positive => "Integers.t"
  [ "Integers.twice_plus_1" "Integers.twice" "Integers.one" ] "Integers.match_positive".
Extract Inductive Z => "Integers.t" [ "Integers.zero" "" "Integers.neg" ] "Integers.match_integer".

Extract Constant Z.add => "Integers.add".
Extract Constant Z.sub => "Integers.sub".
Extract Constant Z.mul => "Integers.mul".
Extract Constant Z.div => "Integers.div".
Extract Constant Z.lcm => "Integers.lcm".
Extract Constant Z.eqb => "Integers.equal".
Extract Constant Z.leb => "Integers.leq".
Extract Constant Z.ltb => "Integers.lt".
Extract Constant Z.compare =>
  "(fun a b -> let sign = Integers.compare a b in if sign = 0 then Eq else if sign < 0 then Lt else Gt)".

Extraction "checker.ml" check check_inversion check_step seems_followed_by.
