(* A certificate of a step (exact/CERTIFICATES.md, "Steps"): its text, in the order and with the messages of ../step.cpp.
   Scene, separation and claim have to be read rightly; of the rest any will do that the proved checker accepts. *)

open Certificate
open Checker
module Z = Zarith

exception Not_covered of string

let max_items = 1 lsl 22
let max_arguments = 1 lsl 24
let max_direction = 1_024
(* Of a scene with thickness. *)
let max_groups = 200
let max_group = 1_000

let take_integer r least limit =
  let text = word r in
  let is_canonical x = string_of_int x = text && x >= least && x < limit in
  match if String.length text > 11 then None else int_of_string_opt text with
  | Some x when is_canonical x -> x
  | _ -> reject ("not an integer, or out of range: " ^ quoted text)

let take_count r = take_integer r 0 0x7fff_ffff

let to_double number =
  let x = Q.to_float number in
  if not (Float.is_finite x && Q.equal (Q.of_float x) number) then reject "a number that is not a double";
  x

(* The double nearest to a sum. *)
let sum a b = to_coq (Q.of_float (Q.to_float (of_coq a) +. Q.to_float (of_coq b)))

(* ---- The scene ---- *)

let take_double r =
  let number = take_number r in
  ignore (to_double number);
  to_coq number

let take_length r =
  let length = take_double r in
  if Z.sign length.qnum < 0 then reject "a distance below 0";
  length

let take_point r =
  let x_of = take_double r in
  let y_of = take_double r in
  let z_of = take_double r in
  { x_of; y_of; z_of }

let read_scene r =
  let items = ref 0 in
  let read_list keyword take =
    begin_keyword r keyword;
    let count = take_count r in
    items := !items + count;
    require_at_most max_items !items "items in the lists of a scene";
    end_line r;
    let rec read left list =
      if left = 0 then List.rev list
      else begin
        begin_line r;
        let item = take () in
        end_line r;
        read (left - 1) (item :: list)
      end
    in
    read count []
  in
  let vertices = read_list "vertices" (fun () -> let a = take_point r in (a, take_point r)) in
  let count = List.length vertices in
  let vertex () = Z.of_int (take_integer r 0 count) in
  let group () = Z.of_int (take_count r) in
  let two take = let a = take () in (a, take ()) in
  let faces = read_list "faces" (fun () -> let e = two vertex in (e, vertex ())) in
  let edges = read_list "edges" (fun () -> two vertex) in
  let points = read_list "points" vertex in
  let groups = read_list "groups" group in
  if groups <> [] && List.length groups <> count then reject "not a group for each vertex";
  let apart = read_list "apart" (fun () -> two group) in
  let radii = read_list "radii" (fun () -> take_length r) in
  let distances = read_list "separations" (fun () -> let e = two group in (e, take_length r)) in
  if List.mem (first_word r) [ "tetrahedra"; "plane_triangles" ] then
    raise (Not_covered "elements with volumes");
  let separation_of = { distance_of = to_coq Q.zero; norm_of = Linf } in
  { vertices; faces; edges; points; groups; apart; radii; distances; separation_of }

let float_of number = Q.to_float (of_coq number)

(* The greatest length, and the reach of each group as a double; none where there is no thickness. *)
let find_thickness s distance =
  let greatest = List.fold_left (fun x radius -> max x (2.0 *. float_of radius)) 0.0 s.radii in
  let halves = Hashtbl.create 16 in
  let listed = Hashtbl.create 16 in
  let add greatest ((one, other), length) =
    let length = float_of length in
    let two = (min (Z.to_int one) (Z.to_int other), max (Z.to_int one) (Z.to_int other)) in
    if Hashtbl.mem listed two then reject "two groups are listed twice";
    Hashtbl.replace listed two ();
    let half = max (length /. 2.0) (length -. (length /. 2.0)) in
    let grow group = Hashtbl.replace halves group (max half (Option.value (Hashtbl.find_opt halves group) ~default:0.0)) in
    grow one; grow other;
    max greatest length
  in
  let greatest = distance +. List.fold_left add greatest s.distances in
  if not (Float.is_finite greatest) then reject "the distances are too large";
  let radii = Array.of_list (List.map float_of s.radii) in
  let reach group =
    let number = Z.to_int group in
    if radii <> [||] && number >= Array.length radii then reject "not a radius for each group";
    let radius = if radii = [||] then 0.0 else radii.(number) in
    max radius (Option.value (Hashtbl.find_opt halves group) ~default:0.0)
  in
  let groups = if s.groups = [] && s.vertices <> [] then [ Z.zero ] else s.groups in
  let reaches = Hashtbl.create 16 in
  List.iter (fun group -> if not (Hashtbl.mem reaches group) then Hashtbl.replace reaches group (reach group)) groups;
  (greatest, Hashtbl.fold (fun group reach list -> (group, reach) :: list) reaches [])

(* ---- What is said of it, in the words of ../scene.cpp and ../summary.cpp ---- *)

let counted count one several = Printf.sprintf "%d %s" count (if count = 1 then one else several)

(* What weakens the claim; empty if nothing does. *)
let rules_text apart left_out =
  let in_order (one, other) = if Z.lt other one then (other, one) else (one, other) in
  let apart = List.sort_uniq compare (List.map in_order apart) in
  let selves, pairs = List.partition (fun (one, other) -> Z.equal one other) apart in
  let rule list one several = if list = 0 then [] else [ counted list one several ] in
  String.concat ", "
    (rule (List.length pairs) "pair of groups held apart" "pairs of groups held apart"
     @ rule (List.length selves) "group held apart from itself" "groups held apart from themselves"
     @ rule left_out "vertex left out" "vertices left out")

(* What two do not in a step without a contact. *)
let contact_text distance norm is_thick =
  let is_zero = Q.sign distance = 0 in
  if is_zero && not is_thick then "touch"
  else
    Printf.sprintf "come within%s%s (%s)" (if is_thick then " their thickness" else "")
      (if is_zero then "" else (if is_thick then " + " else " ") ^ text_of_number distance)
      (if norm = L2 then "l2" else "linf")

(* What an accepted certificate proves. *)
type proved = {
  text : string;  (* label, size of the scene, rules, separation and claim, a line each *)
  is_free : bool;
  contact : string;
  rules : string;
  scene : step;
}

(* ---- The certificate ---- *)

(* A kind of pairs: its elements, and the arguments of each of the first ones. *)
type pair_kind = {
  name : string;
  some : Step_hints.family;
  others : Step_hints.family;
  known : (Z.t * argument) list array;
}

let pair_kind name some others =
  { name; some; others; known = Array.make some.Step_hints.count [] }

type reading = { r : reader; s : step; c : setting; all_sites : site map_of; site_of : site array; until : Q.t }

let site_at reading vertex = reading.site_of.(vertex)

let take_pair reading kind =
  let find (family : Step_hints.family) =
    let number = take_count reading.r in
    match family.vertices number with
    | Some vertices -> (number, List.map (site_at reading) vertices)
    | None -> reject "there is no such element"
  in
  let a = find kind.some in
  (a, find kind.others)

(* The certificate of two elements, without its proof. *)
let certificate_of reading line claim ps qs =
  let separation =
    { distance_of = distance_of_pair reading.c ps qs; norm_of = reading.s.separation_of.norm_of }
  in
  { claim_line = line; label = ""; query = query_between ps qs; is_tetrahedron = false; separation; claim; subintervals = [];
    contact_line = 0; contact = None }

(* Reads an argument, verifies and keeps it. *)
let read_argument reading kind =
  let r = reading.r in
  let line = r.number in
  begin_line r;
  let (i, ps), (j, qs) = take_pair reading kind in
  let argument =
    if r.words <> [] then begin
      let take () = Z.of_int (take_integer r (1 - max_direction) max_direction) in
      let x_of = take () in
      let y_of = take () in
      let z_of = take () in
      let direction = By_direction { x_of; y_of; z_of } in
      if not (proves reading.c ps qs direction) then reject "the direction separates not";
      end_line r;
      direction
    end
    else begin
      end_line r;
      let c = certificate_of reading line No_collision ps qs in
      let c = { c with subintervals = read_subintervals r c.query.kind_of 0 } in
      require_small_numbers c;
      let argument = By_subintervals (List.map snd c.subintervals) in
      if not (proves reading.c ps qs argument) then begin
        let line, reason = Elaborate.fault ~until:reading.until c in
        reject ~line reason
      end;
      argument
    end
  in
  kind.known.(i) <- (Z.of_int j, argument) :: kind.known.(i)

let read_arguments reading kinds =
  let r = reading.r in
  begin_keyword r "sweep";
  ignore (one_of r [ ("x", ()); ("y", ()); ("z", ()) ]);
  end_line r;
  let count = ref 0 in
  let read kind =
    begin_keyword r kind.name;
    end_line r;
    while String.for_all (fun c -> c >= '0' && c <= '9') (first_word r) do
      incr count;
      require_at_most max_arguments !count "arguments";
      read_argument reading kind
    done
  in
  List.iter read kinds

(* The pair of the earliest contact, and its contact as the proved checker accepts it. *)
let read_contact_of_pair reading kinds lower upper =
  let r = reading.r in
  let text = printable r.text in
  begin_keyword r "pair";
  let kind = one_of r (List.map (fun kind -> (kind.name, kind)) kinds) in
  let (_, ps), (_, qs) = take_pair reading kind in
  if have_common_vertex ps qs || are_held_apart reading.c ps qs then reject "these two cannot collide";
  end_line r;
  let c = certificate_of reading 0 Collision ps qs in
  let contact_line = r.number in
  let contact = Some (read_contact r c.query.kind_of) in
  let c = { c with contact_line; contact } in
  require_small_numbers c;
  let p = List.map (fun p -> p.number) ps in
  let q = List.map (fun p -> p.number) qs in
  let accepts = proves_contact_of reading.c reading.all_sites (to_coq lower) (to_coq upper) p q in
  match Elaborate.accepted lower upper c.separation.norm_of contact accepts with
  | Some contact -> (text, p, q, contact)
  | None -> reject ~line:contact_line "the contact is not proved"

exception Missing of item * item

(* Two elements without an argument, if the search finds any. *)
let require_all_proved reading (hints : hints) =
  let gap = reading.c.gap in
  let settled in_order x y =
    let last z = List.fold_left (fun _ p -> p.number) Z.zero z.sites in
    let x, y = if (not in_order) || Z.lt (last x) (last y) then (x, y) else (y, x) in
    is_proved reading.c x y || raise (Missing (x, y))
  in
  let require name is_met =
    try if not (is_met ()) then reject "the search for pairs fails" with
    | Missing (x, y) ->
        reject (Printf.sprintf "no argument for %s %s %s" name (Z.to_string x.label) (Z.to_string y.label))
  in
  require "vertex_face" (fun () -> between gap reading.all_sites (settled false) hints.for_vertices hints.for_faces);
  require "edge_edge" (fun () -> within gap reading.all_sites (settled true) hints.for_edges);
  require "vertex_edge" (fun () -> between gap reading.all_sites (settled false) hints.for_points hints.for_bare_edges);
  require "vertex_vertex" (fun () -> within gap reading.all_sites (settled true) hints.for_two_points);
  reject "the certificate is not proved"

(* Reads and verifies the certificate that begins at the present line; what it proves, as text.
   [require_demanded line claim separation rules] rejects what is not demanded. *)
let check r scenes require_demanded =
  let text = Buffer.create 200 in
  let say line = Buffer.add_string text (line ^ "\n") in
  say ("step " ^ printable (read_label r "step"));
  let s = read_scene r in
  Option.iter (fun scenes -> if read_scene scenes <> s then reject "the scene is not the one given") scenes;
  let elements = Step_hints.elements_of s in
  let count bools = Array.fold_left (fun n b -> if b then n + 1 else n) 0 bools in
  let all = Array.length elements.takes_part in
  let taking_part = count elements.takes_part in
  say (Printf.sprintf "%d%s vertices, %d edges, %d faces" taking_part
    (if taking_part = all then "" else Printf.sprintf " of %d" all)
    (Array.length elements.edges) (Array.length elements.faces));
  let rules = rules_text s.apart (all - taking_part) in
  if rules <> "" then say ("rules " ^ rules);
  let s = { s with separation_of = read_separation r } in
  let distance = to_double (of_coq s.separation_of.distance_of) in
  let is_thick = s.radii <> [] || s.distances <> [] in
  let greatest, reaches = if is_thick then find_thickness s distance else (distance, []) in
  if is_thick then
    say (Printf.sprintf "%d radii, %d separations of groups" (List.length s.radii) (List.length s.distances));
  if List.length reaches > max_groups || List.exists (fun (group, _) -> Z.gt group (Z.of_int max_group)) reaches then
    raise (Not_covered (Printf.sprintf "thickness of more than %d groups, or one above %d" max_groups max_group));
  let line = r.number in
  begin_keyword r "claim";
  let is_earliest = one_of r [ ("no_contact", false); ("earliest", true) ] in
  let lower, upper =
    if is_earliest then take_time_of_impact r
    else begin
      let upper = take_number r in
      if Q.sign upper < 0 || Q.gt upper Q.one then reject "a time is from 0 to 1";
      (upper, Q.zero)
    end
  in
  end_line r;
  let claim_text =
    if is_earliest then "earliest " ^ text_of_number lower ^ " " ^ text_of_number upper
    else "no_contact " ^ text_of_number lower
  in
  let s_distance = of_coq s.separation_of.distance_of in
  let s_norm = s.separation_of.norm_of in
  (* Of thick primitives the norm matters at 0, too. *)
  let separation_text = text_of_separation ~is_norm_named:is_thick s_distance s_norm in
  require_demanded line claim_text separation_text rules;
  say ("separation " ^ separation_text);
  say ("claim " ^ claim_text);
  let longest x (p : Checker.q triple) =
    let larger x y = max x (Float.abs (float_of y)) in
    larger (larger (larger x p.x_of) p.y_of) p.z_of
  in
  let factor = Step_hints.factor_of (List.fold_left (fun x (p, q) -> longest (longest x p) q) greatest s.vertices) in
  let reach (group, reach) =
    (group, Z.succ (enlarged_distance factor (to_coq (Q.of_float reach))))
  in
  let hints = Step_hints.without_trees factor (List.map reach reaches) in
  let e = to_coq lower in
  let all_sites = sites_of s e hints in
  let site_of vertex = List.hd (Option.get (find_sites all_sites [ Z.of_int vertex ])) in
  let site_of = Array.init (List.length s.vertices) site_of in
  let reading = { r; s; c = setting_of s sum e hints; all_sites; site_of; until = lower } in
  let kinds =
    let open Step_hints in
    let points = points_of elements in
    [ pair_kind "vertex_face" (vertices_of elements) (faces_of elements);
      pair_kind "edge_edge" (edges_of elements) (edges_of elements);
      pair_kind "vertex_edge" points (bare_edges_of elements);
      pair_kind "vertex_vertex" points points ]
  in
  let claim, contact =
    if is_earliest then begin
      let pair, p, q, contact = read_contact_of_pair reading kinds lower upper in
      say pair;
      (Earliest (e, to_coq upper, p, q), contact)
    end
    else (No_contact e, None)
  in
  let hints =
    if is_earliest && Q.sign upper = 0 then hints
    else begin
      read_arguments reading kinds;
      let plan family known = Step_hints.plan_of (site_at reading) family known in
      let first n = let kind = List.nth kinds n in plan kind.some (fun i -> kind.known.(i)) in
      let second n = plan (List.nth kinds n).others (fun _ -> []) in
      { hints with for_vertices = first 0; for_faces = second 0; for_edges = first 1; for_points = first 2;
        for_bare_edges = second 2; for_two_points = first 3 }
    end
  in
  if not (check_step sum s claim hints contact) then require_all_proved reading hints;
  begin_keyword r "end";
  end_line r;
  { text = Buffer.contents text; is_free = claim_text = "no_contact 1"; rules; scene = s;
    contact = contact_text s_distance s_norm is_thick }
