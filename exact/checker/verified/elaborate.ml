(* Nothing here is to be believed: a certificate counts as accepted only if the proved checker accepts it,
   or one with a shorter interval around the root of its contact, for the same query and claim.

   The checker's witness of `at axes` needs the signs of other polynomials than the axes of the format, and these
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

(* True if the interval is within [first,last], and g has opposite signs at its ends, as the format demands. *)
let is_interval first last lower upper g =
  Q.leq first lower && Q.lt lower upper && Q.leq upper last && sign_of g lower * sign_of g upper < 0

(* The contact that is accepted, as it stands or with a shorter interval; it is to be in [first,last]. *)
let accepted first last norm contact accepts =
  let with_halvings contact lower upper g count =
    Some { contact with time_of = halved g (number lower) (number upper) count }
  in
  let shorter =
    match contact with
    | Some ({ place_of = Near_axes; time_of = At_root (lower, upper, g) } as contact)
      when norm = Linf && is_interval first last (number lower) (number upper) g ->
        List.map (with_halvings contact lower upper g) halvings
    | _ -> []
  in
  List.find_opt accepts (contact :: shorter)

(* True if the certificate is accepted. *)
let check (c : Certificate.certificate) =
  let subintervals = List.map snd c.subintervals in
  let first, last =
    match c.claim with Time_of_impact (a, b) -> (number a, number b) | _ -> (Q.zero, Q.one)
  in
  if c.is_tetrahedron then check_inversion c.query c.claim subintervals c.contact
  else
    accepted first last c.separation.norm_of c.contact
      (Checker.check c.query c.separation c.claim subintervals)
    <> None

(* The line and the reason of a certificate that was not accepted; [until]: its subintervals are to end there. *)
let fault ?until (c : Certificate.certificate) =
  let separates (_, subinterval) =
    match Checker.scene_of c.query c.separation with
    | Some scene -> (if c.is_tetrahedron then keeps_volume else separates) scene subinterval
    | None -> false
  in
  let rec first_gap reached = function
    | [] -> None
    | (line, s) :: rest ->
        let is_next = Q.equal (number s.from) reached && Q.leq (number s.from) (number s.to0) in
        if is_next then first_gap (number s.to0) rest else Some line
  in
  let separated_end =
    match c.claim with
    | No_collision -> Some (Option.value until ~default:Q.one)
    | Time_of_impact (lower, upper) when Q.sign (number upper) > 0 -> Some (number lower)
    | _ -> None
  in
  let gap = first_gap Q.zero c.subintervals in
  match List.find_opt (fun s -> not (separates s)) c.subintervals, List.rev c.subintervals with
  | Some (line, _), _ when gap = None || gap >= Some line -> (line, "the subinterval is not proved")
  | _ when gap <> None -> (Option.get gap, "the subinterval does not begin where it should")
  | _, [] when separated_end <> None -> (c.claim_line, "there is no subinterval")
  | _, (line, last) :: _ when not (Q.equal (number last.to0) (Option.get separated_end)) ->
      (line, "the last subinterval does not end where it should")
  | _ -> (c.contact_line, "the contact is not proved")
