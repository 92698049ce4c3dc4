(* A certificate as text and as what it says: syntax and limits (exact/CERTIFICATES.md), no
   mathematics. In the order and with the messages of ../certificate.cpp. *)

let max_line_bytes = 65_536
let max_label_bytes = 1_024
let max_number_bits = 16_384
let max_subintervals = 4_096
let max_root_degree = 256
let max_curve_degree = 8
let max_scaled_bits = 65_536

(* The line at fault, or 0 for that at which the reader stands, and the reason. *)
exception Rejection of int * string

let reject ?(line = 0) reason = raise (Rejection (line, reason))

let require_at_most limit count what =
  if count > limit then reject (Printf.sprintf "more than %d %s" limit what)

(* Any byte that is not printable ASCII as \xHH. *)
let printable text =
  let shown c =
    if c >= ' ' && c <= '~' then String.make 1 c else Printf.sprintf "\\x%02x" (Char.code c)
  in
  String.concat "" (List.map shown (List.of_seq (String.to_seq text)))

let quoted word =
  if String.length word > 40 then "'" ^ printable (String.sub word 0 40) ^ "...'"
  else "'" ^ printable word ^ "'"

let starts_with prefix text = String.starts_with ~prefix text
let behind count text = String.sub text count (String.length text - count)

(* ---- Numbers ---- *)

let bits x = max 1 (Z.numbits x)

let parse_digits digits base =
  let is_digit c = (c >= '0' && c <= '9') || (base = 16 && c >= 'a' && c <= 'f') in
  if digits = "" || not (String.for_all is_digit digits) then reject "not a number";
  require_at_most
    (if base = 10 then 4_933 else max_number_bits / 4)
    (String.length digits) "digits in a number";
  let number = Z.of_string_base base digits in
  require_at_most max_number_bits (bits number) "bits in a number";
  number

let parse_decimal digits =
  let number = parse_digits digits 10 in
  if String.length digits > 1 && digits.[0] = '0' then reject "an integer with leading zeros";
  number

(* The parts before and behind a separator, or [missing] for the second. *)
let parted text separator missing =
  match String.index_opt text separator with
  | None -> (text, missing)
  | Some place -> (String.sub text 0 place, behind (place + 1) text)

let parse_power_of_two text =
  let is_signed = starts_with "-" text || starts_with "+" text in
  let digits = if is_signed then behind 1 text else text in
  require_at_most 6 (String.length digits) "digits in a power of two";
  let power = Z.to_int (parse_digits digits 10) in
  if starts_with "-" text then -power else power

let parse_hexadecimal text =
  let digits, power = parted text 'p' "" in
  let whole, fraction = parted digits '.' "" in
  if whole = "" || String.ends_with ~suffix:"." digits then reject "not a number";
  let exponent = parse_power_of_two power - (4 * String.length fraction) in
  let number = parse_digits (whole ^ fraction) 16 in
  if exponent > max_number_bits - bits number || 1 - exponent > max_number_bits then
    reject "too large or small a power of two";
  if exponent > 0 then Q.of_bigint (Z.shift_left number exponent)
  else Q.make number (Z.shift_left Z.one (-exponent))

let parse_fraction text =
  let above, below = parted text '/' "1" in
  let above = parse_decimal above in
  let below = parse_decimal below in
  if Z.equal below Z.zero then reject "a denominator that is 0";
  Q.make above below

let signed_number word parse is_zero negated =
  try
    let is_negative = starts_with "-" word in
    let number = parse (if is_negative then behind 1 word else word) in
    if is_negative && is_zero number && not (starts_with "-0x" word) then
      reject "a zero with a sign";
    if is_negative then negated number else number
  with Rejection (line, reason) -> reject ~line (reason ^ ": " ^ quoted word)

let parse_integer word = signed_number word parse_decimal (Z.equal Z.zero) Z.neg

let parse_number word =
  let parse text =
    if starts_with "0x" text then parse_hexadecimal (behind 2 text) else parse_fraction text
  in
  signed_number word parse (fun x -> Q.sign x = 0) Q.neg

(* The shorter of the fraction and the hexadecimal float whose first digit is 1. *)
let text_of_number number =
  let fraction = Q.to_string number in
  if Q.sign number = 0 || Z.popcount (Q.den number) <> 1 then fraction
  else
    let above = Z.abs (Q.num number) in
    let zeros = Z.trailing_zeros above in
    let digits = Z.shift_right above zeros in
    let behind_point = Z.numbits digits - 1 in
    let power = zeros + behind_point - Z.trailing_zeros (Q.den number) in
    let digits = Z.format "%x" (Z.shift_left digits ((4 - (behind_point mod 4)) mod 4)) in
    let digits =
      if String.length digits > 1 then String.sub digits 0 1 ^ "." ^ behind 1 digits else digits
    in
    let sign = if Q.sign number < 0 then "-" else "" in
    let text = Printf.sprintf "%s0x%sp%s%d" sign digits (if power < 0 then "" else "+") power in
    if String.length text < String.length fraction then text else fraction

(* ---- Lines and words ---- *)

type reader = {
  channel : in_channel;
  chunk : Bytes.t;
  mutable used : int;
  mutable filled : int;
  mutable number : int;  (* of the line, from 1 *)
  mutable at_end : bool;
  mutable fault : string option;  (* why the line cannot be read *)
  mutable text : string;
  mutable words : string list;  (* that are left *)
}

let reader_of channel =
  { channel; chunk = Bytes.create 65_536; used = 0; filled = 0; number = 0; at_end = false;
    fault = None; text = ""; words = [] }

let read_line r =
  let line = Buffer.create 80 in
  let rec read is_too_long =
    if r.used = r.filled then begin
      r.filled <- input r.channel r.chunk 0 (Bytes.length r.chunk);
      r.used <- 0
    end;
    if r.filled = 0 then (false, is_too_long)
    else
      let last =
        match Bytes.index_from_opt r.chunk r.used '\n' with
        | Some place when place < r.filled -> place
        | _ -> r.filled
      in
      let room = max_line_bytes - Buffer.length line in
      Buffer.add_subbytes line r.chunk r.used (min room (last - r.used));
      let is_too_long = is_too_long || last - r.used > room in
      let is_ended = last < r.filled in
      r.used <- (if is_ended then last + 1 else last);
      if is_ended then (true, is_too_long) else read is_too_long
  in
  let is_ended, is_too_long = read false in
  r.text <- Buffer.contents line;
  r.at_end <- (not is_ended) && r.text = "";
  r.fault <-
    (if r.at_end then Some "the stream ends within a certificate"
     else if is_too_long then Some "the line is too long"
     else if not is_ended then Some "the last line is not ended by a newline"
     else None);
  if not r.at_end then r.number <- r.number + 1

let rec advance r =
  read_line r;
  let is_comment = r.text = "" || r.text.[0] = '#' in
  if is_comment && r.fault = None && r.number > 1 then advance r

let first_word r = fst (parted r.text ' ' "")

let word r =
  match r.words with
  | [] -> reject "the line has too few words"
  | word :: rest -> r.words <- rest; word

let begin_line r =
  Option.iter (fun fault -> reject fault) r.fault;
  r.words <- String.split_on_char ' ' r.text

let begin_keyword r keyword =
  begin_line r;
  if word r <> keyword then
    reject (Printf.sprintf "expected '%s', found %s" keyword (quoted (first_word r)))

let one_of r choices =
  let found = word r in
  match List.assoc_opt found choices with
  | Some choice -> choice
  | None -> reject ("unknown word: " ^ quoted found)

let end_line r =
  if r.words <> [] then reject "the line has too many words";
  advance r

(* ---- Certificates ---- *)

(* The extracted module has integers of its own. *)
module Zarith = Z
open Checker
module Z = Zarith

type certificate = {
  claim_line : int;
  label : string;
  query : query;
  is_tetrahedron : bool;  (* its contacts are inversions *)
  separation : separation;
  claim : claim;
  subintervals : (int * subinterval) list;  (* with their lines *)
  contact_line : int;
  contact : contact_proof option;
}

let to_coq number = { qnum = Q.num number; qden = Q.den number }
let of_coq number = Q.make number.qnum number.qden
let take_number r = parse_number (word r)
let take_axis r = one_of r [ ("x", X_axis); ("y", Y_axis); ("z", Z_axis) ]

let take_corner r kind =
  let corners = [ ("0", O); ("1", S O); ("2", S (S O)); ("3", S (S (S O))) ] in
  let corner = one_of r corners in
  if corner = S (S (S O)) && kind = Vertex_face then reject "a vertex_face has no corner 3";
  corner

let take_is_negative r = one_of r [ ("+", false); ("-", true) ]

(* Words are taken in the order of the line. *)
let take_feature ~is_tetrahedron r kind =
  let corner () = take_corner r kind in
  let take =
    if is_tetrahedron then one_of r [ ("face", fun () -> one_of r [ ("-", Of_face true) ]) ]
    else
      one_of r
        [
          ("vertex", fun () -> Of_vertex (corner ()));
          ("edge", fun () -> let i = corner () in Of_edge (i, corner ()));
          ("face", fun () -> Of_face (take_is_negative r));
          ("axis", fun () -> let k = take_axis r in Of_axis (k, take_is_negative r));
          ("cross", fun () -> let k = take_axis r in let i = corner () in Of_cross (k, i, corner ()));
        ]
  in
  take ()

let claim_words is_tetrahedron =
  if is_tetrahedron then ("no_inversion", "inversion", "time_of_inversion")
  else ("no_collision", "collision", "time_of_impact")

let take_place r kind =
  let corner () = take_corner r kind in
  let triangle () =
    let i = corner () in
    let j = corner () in
    let l = corner () in
    In_triangle (i, j, l, take_axis r)
  in
  let take =
    one_of r
      [
        ("vertex", fun () -> Near_vertex (corner ()));
        ("segment", fun () -> let i = corner () in On_segment (i, corner ()));
        ("triangle", triangle);
        ("edge", fun () -> let i = corner () in Near_edge (i, corner ()));
        ("face", fun () -> Near_face);
        ("axes", fun () -> Near_axes);
      ]
  in
  take ()

let take_time r =
  let is_root = one_of r [ ("time", false); ("root", true) ] in
  let lower = to_coq (take_number r) in
  if not is_root then At_time lower
  else begin
    let upper = to_coq (take_number r) in
    let rec take count =
      if r.words = [] then []
      else begin
        let coefficient = parse_integer (word r) in
        require_at_most (max_root_degree + 1) (count + 1) "coefficients in a polynomial";
        coefficient :: take (count + 1)
      end
    in
    let g = take 0 in
    if List.length g < 2 then reject "a polynomial of a degree below 1";
    if Z.equal (List.nth g (List.length g - 1)) Z.zero then
      reject "a polynomial whose leading coefficient is 0";
    At_root (lower, upper, g)
  end

let read_label r keyword =
  begin_keyword r keyword;
  let place = String.length keyword + 1 in
  let label = if String.length r.text > place then behind place r.text else "" in
  require_at_most max_label_bytes (String.length label) "bytes in a label";
  advance r;
  label

let read_separation r =
  begin_keyword r "separation";
  let distance = take_number r in
  if Q.sign distance < 0 then reject "a distance below 0";
  let norm = one_of r [ ("linf", Linf); ("l2", L2) ] in
  end_line r;
  { distance_of = to_coq distance; norm_of = norm }

let take_time_of_impact r =
  let lower = take_number r in
  let upper = take_number r in
  let is_at_start = Q.sign lower = 0 && Q.sign upper = 0 in
  let is_interval = Q.sign lower >= 0 && Q.lt lower upper && Q.leq upper Q.one in
  if not (is_at_start || is_interval) then
    reject "a time of impact is 0 0, or LO HI with 0 <= LO < HI <= 1";
  (lower, upper)

let read_claim ~is_tetrahedron r =
  begin_keyword r "claim";
  let take_times () =
    let lower, upper = take_time_of_impact r in
    Time_of_impact (to_coq lower, to_coq upper)
  in
  let no_collision, collision, time_of_impact = claim_words is_tetrahedron in
  let take =
    one_of r
      [ (no_collision, fun () -> No_collision); (collision, fun () -> Collision);
        (time_of_impact, take_times) ]
  in
  let claim = take () in
  end_line r;
  claim

let rec read_subintervals ?(is_tetrahedron = false) r kind count =
  if first_word r <> "separate" then []
  else begin
    require_at_most max_subintervals (count + 1) "subintervals";
    let line = r.number in
    begin_keyword r "separate";
    let from = to_coq (take_number r) in
    let to0 = to_coq (take_number r) in
    let feature_of = take_feature ~is_tetrahedron r kind in
    end_line r;
    let subinterval = (line, { from; to0; feature_of }) in
    subinterval :: read_subintervals ~is_tetrahedron r kind (count + 1)
  end

(* The place of an inversion is not looked at. *)
let read_contact ?(is_tetrahedron = false) r kind =
  begin_keyword r "contact";
  let time_of = take_time r in
  end_line r;
  begin_keyword r "at";
  let place_of = if is_tetrahedron then one_of r [ ("plane", Near_face) ] else take_place r kind in
  end_line r;
  { time_of; place_of }

let weight_1 = to_coq Q.one

(* A line `point X Y Z`, or `point X Y Z W` on a rational curve. *)
let read_point r is_rational =
  begin_keyword r "point";
  let x_of = to_coq (take_number r) in
  let y_of = to_coq (take_number r) in
  let z_of = to_coq (take_number r) in
  let weight_of = if is_rational then to_coq (take_number r) else weight_1 in
  if Z.sign weight_of.qnum <= 0 then reject "a weight that is not positive";
  end_line r;
  { point_of = { x_of; y_of; z_of }; weight_of }

(* [count] times what [read] reads, in this order. *)
let rec repeated count read =
  if count = 0 then [] else let first = read () in first :: repeated (count - 1) read

let read_curve r =
  begin_line r;
  let is_rational = one_of r [ ("curve", false); ("rational", true) ] in
  let degree = parse_integer (word r) in
  if Z.sign degree < 0 || Z.gt degree (Z.of_int max_curve_degree) then
    reject (Printf.sprintf "a degree that is not 0 to %d" max_curve_degree);
  end_line r;
  repeated (Z.to_int degree + 1) (fun () -> read_point r is_rational)

(* Straight lines: all points at t=0, then at t=1; or four curves. *)
let read_motions r =
  if List.mem (first_word r) [ "curve"; "rational" ] then repeated 4 (fun () -> read_curve r)
  else
    let starts = repeated 4 (fun () -> read_point r false) in
    let ends = repeated 4 (fun () -> read_point r false) in
    List.map2 (fun start last -> [ start; last ]) starts ends

(* Reads the certificate that begins at the present line and goes behind its `end`. *)
let read_certificate r take_label =
  begin_keyword r "query";
  let kind, is_tetrahedron =
    one_of r
      [ ("vertex_face", (Vertex_face, false)); ("edge_edge", (Edge_edge, false));
        ("tetrahedron", (Vertex_face, true)) ]
  in
  end_line r;
  let label = if first_word r = "label" then read_label r "label" else "" in
  take_label label;
  let query =
    match read_motions r with
    | [ point0; point1; point2; point3 ] -> { kind_of = kind; point0; point1; point2; point3 }
    | _ -> assert false
  in
  let separation =
    if first_word r = "separation" && not is_tetrahedron then read_separation r
    else { distance_of = to_coq Q.zero; norm_of = Linf }
  in
  let claim_line = r.number in
  let claim = read_claim ~is_tetrahedron r in
  let is_at_start = match claim with Time_of_impact (_, b) -> Z.sign b.qnum = 0 | _ -> false in
  let subintervals =
    if claim = Collision || is_at_start then [] else read_subintervals ~is_tetrahedron r kind 0
  in
  let contact_line = r.number in
  let contact = if claim = No_collision then None else Some (read_contact ~is_tetrahedron r kind) in
  begin_keyword r "end";
  end_line r;
  { claim_line; label; query; is_tetrahedron; separation; claim; subintervals; contact_line; contact }

(* Rejects coordinates, weights and times that are too large over their common denominator. *)
let require_small numbers line =
  let sum = List.fold_left (fun sum x -> sum + bits x.qden) 0 numbers in
  let greatest = List.fold_left (fun most x -> max most (bits x.qnum)) 0 numbers in
  if sum + greatest > max_scaled_bits then begin
    let denominator = List.fold_left (fun m x -> Z.lcm m x.qden) Z.one numbers in
    let is_large x = bits (Z.mul (Z.divexact denominator x.qden) x.qnum) > max_scaled_bits in
    if List.exists is_large numbers then
      reject ~line "numbers too large over their common denominator"
  end

let require_small_numbers c =
  let of_control p = [ p.point_of.x_of; p.point_of.y_of; p.point_of.z_of ] in
  let q = c.query in
  let points = [ q.point0; q.point1; q.point2; q.point3 ] in
  List.iter
    (fun point -> require_small (List.map (fun p -> p.weight_of) point) c.claim_line)
    points;
  require_small
    (c.separation.distance_of :: List.concat_map (List.concat_map of_control) points)
    c.claim_line;
  List.iter (fun (line, s) -> require_small [ s.from; s.to0 ] line) c.subintervals;
  match c.contact with
  | Some { time_of = At_root (lower, upper, _); _ } -> require_small [ lower; upper ] c.contact_line
  | _ -> ()

(* ---- Demands ---- *)

let text_of_claim is_tetrahedron claim =
  let no_collision, collision, time_of_impact = claim_words is_tetrahedron in
  match claim with
  | No_collision -> no_collision
  | Collision -> collision
  | Time_of_impact (lower, upper) ->
      Printf.sprintf "%s %s %s" time_of_impact
        (text_of_number (of_coq lower)) (text_of_number (of_coq upper))

(* At distance 0 the norm does not matter, and is not named unless [is_norm_named]. *)
let text_of_separation ?(is_norm_named = false) distance norm =
  let text = text_of_number distance in
  if Q.sign distance = 0 && not is_norm_named then text else text ^ (if norm = L2 then " l2" else " linf")

let demanded_claim words =
  if words = "free" || words = "sequence" then words
  else
    let parts = String.split_on_char ' ' words in
    let numbers = List.tl parts in
    let count = List.length numbers in
    let is_form =
      match List.hd parts with
      | "no_collision" | "collision" | "no_inversion" | "inversion" -> count = 0
      | "time_of_impact" | "time_of_inversion" | "earliest" -> count = 0 || count = 2
      | "intersections" | "welded_intersections" -> count = 0 || count = 1
      | "no_contact" -> count = 1
      | _ -> false
    in
    if not is_form then reject ("not a claim: " ^ quoted words);
    String.concat " "
      (List.hd parts :: List.map (fun x -> text_of_number (parse_number x)) numbers)

(* The double nearest to a decimal number, where the text is one. *)
let decimal text =
  let is_decimal =
    text <> "" && String.for_all (fun c -> String.contains "0123456789.eE+-" c) text
    && text.[0] <> '+'
  in
  match if is_decimal then float_of_string_opt text else None with
  | Some x when Float.is_finite x ->
      let digits = fst (parted (String.lowercase_ascii text) 'e' "") in
      let is_zero = not (String.exists (fun c -> c >= '1' && c <= '9') digits) in
      if x = 0.0 && not is_zero then None else Some (Q.of_float x)
  | _ -> None

let demanded_separation distance norm =
  if norm <> "linf" && norm <> "l2" then reject ("not a norm: " ^ quoted norm);
  let number = match decimal distance with Some x -> x | None -> parse_number distance in
  if Q.sign number < 0 then reject "a distance below 0";
  text_of_separation ~is_norm_named:true number (if norm = "l2" then L2 else Linf)
