(* The integers of Coq (ZArith) as those of Zarith. *)

type t = Z.t

let zero = Z.zero
let one = Z.one
let twice a = Z.shift_left a 1
let twice_plus_1 a = Z.succ (twice a)
let neg = Z.neg
let add = Z.add
let sub = Z.sub
let mul = Z.mul
let equal = Z.equal
let leq = Z.leq
let lt = Z.lt
let compare = Z.compare

(* Coq's quotient is rounded down, and 0 where the divisor is 0. *)
let div a b = if Z.equal b zero then zero else Z.fdiv a b
let lcm a b = if Z.equal a zero || Z.equal b zero then zero else Z.lcm a b

(* match a with 2b + 1 | 2b | 1 *)
let match_positive odd even unit a =
  if Z.equal a one then unit ()
  else (if Z.is_odd a then odd else even) (Z.shift_right a 1)

(* match a with 0 | a positive number | the opposite of one *)
let match_integer null positive negative a =
  match Z.sign a with 0 -> null () | 1 -> positive a | _ -> negative (Z.neg a)
