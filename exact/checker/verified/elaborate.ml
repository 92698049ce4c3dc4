(* A shorter interval around the root of a contact. Nothing here is to be believed: the proved checker
   checks the certificate that comes out as it does any other, against the same query and claim.

   Its witness of `at axes` needs the signs of other polynomials than the axes of the format, and these
   may be seen on a shorter interval only. *)

open Checker
module Z = Certificate.Zarith

let number q = Q.make q.qnum q.qden
let sign_of g x = Q.sign (List.fold_right (fun c sum -> Q.add (Q.of_bigint c) (Q.mul x sum)) g Q.zero)
let half = Q.of_ints 1 2

(* The interval [lower,upper], halved so many times. *)
let rec halved g lower upper halvings =
  if halvings = 0 then At_root (Certificate.to_coq lower, Certificate.to_coq upper, g)
  else
    let middle = Q.mul half (Q.add lower upper) in
    let sign = sign_of g middle in
    if sign = 0 then At_time (Certificate.to_coq middle)
    else if sign = sign_of g lower then halved g middle upper (halvings - 1)
    else halved g lower middle (halvings - 1)

let halvings = [ 16; 64; 256 ]

(* Is the certificate accepted, as it stands or with a shorter interval? *)
let check (c : Certificate.certificate) =
  let accepts contact = Checker.check c.query c.separation c.claim c.subintervals contact in
  let accepts_halved contact lower upper g count =
    accepts (Some { contact with time_of = halved g (number lower) (number upper) count })
  in
  accepts c.contact
  ||
  match c.contact with
  | Some ({ place_of = Near_axes; time_of = At_root (lower, upper, g) } as contact)
    when c.separation.norm_of = Linf && Q.lt (number lower) (number upper)
         && sign_of g (number lower) * sign_of g (number upper) < 0 ->
      List.exists (accepts_halved contact lower upper g) halvings
  | _ -> false
