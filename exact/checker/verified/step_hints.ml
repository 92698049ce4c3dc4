(* Nothing here is to be believed: numbers of edges, the factor of space, reaches and trees, which the proved checker of
   steps needs as hints. *)

open Checker
module Z = Certificate.Zarith

(* ---- Elements ---- *)

type elements = {
  takes_part : bool array;  (* of vertices *)
  has_edge : bool array;
  edges : (int * int) array;  (* the smaller vertex first; in the order of their numbers *)
  is_bare : bool array;  (* of edges: of no face *)
  faces : (int * int * int) array;
}

let sorted_without_repetition codes =
  let codes = Array.of_list codes in
  Array.sort (fun (a : int) b -> compare a b) codes;
  let count = Array.length codes in
  List.init count Fun.id
  |> List.filter_map (fun n -> if n > 0 && codes.(n) = codes.(n - 1) then None else Some codes.(n))
  |> Array.of_list

let elements_of (s : step) =
  let count = List.length s.vertices in
  let int = Z.to_int in
  let faces = Array.of_list (List.rev (List.rev_map (fun ((a, b), c) -> (int a, int b, int c)) s.faces)) in
  let code a b = (max a b * (count + 1)) + min a b in
  let sides =
    Array.fold_left (fun l (a, b, c) -> code a b :: code b c :: code c a :: l) [] faces
    |> sorted_without_repetition
  in
  let lines =
    List.rev_append (List.rev_map (fun (a, b) -> code (int a) (int b)) s.edges) (Array.to_list sides)
    |> sorted_without_repetition
  in
  let takes_part = Array.make count false in
  let has_edge = Array.make count false in
  let ends line = (line mod (count + 1), line / (count + 1)) in
  let mark line =
    let a, b = ends line in
    List.iter (fun v -> takes_part.(v) <- true; if a <> b then has_edge.(v) <- true) [ a; b ]
  in
  Array.iter mark lines;
  List.iter (fun v -> takes_part.(int v) <- true) s.points;
  let is_edge line = let a, b = ends line in a <> b in
  let codes = Array.of_list (List.filter is_edge (Array.to_list lines)) in
  let of_faces = Hashtbl.create (Array.length sides) in
  Array.iter (fun side -> Hashtbl.replace of_faces side ()) sides;
  { takes_part; has_edge; faces; edges = Array.map ends codes;
    is_bare = Array.map (fun line -> not (Hashtbl.mem of_faces line)) codes }

(* The vertices of elements by their numbers, and how many numbers there are. *)
type family = { count : int; vertices : int -> int list option }

let family count takes_part vertices =
  let find n = if n < count && takes_part n then Some (vertices n) else None in
  { count; vertices = find }

let vertices_of e =
  family (Array.length e.takes_part) (fun v -> e.takes_part.(v)) (fun v -> [ v ])
let points_of e =
  family (Array.length e.takes_part) (fun v -> e.takes_part.(v) && not e.has_edge.(v)) (fun v -> [ v ])
let ends e n = let a, b = e.edges.(n) in [ a; b ]
let edges_of e = family (Array.length e.edges) (fun _ -> true) (ends e)
let bare_edges_of e = family (Array.length e.edges) (fun n -> e.is_bare.(n)) (ends e)
let faces_of e =
  family (Array.length e.faces) (fun _ -> true) (fun n -> let a, b, c = e.faces.(n) in [ a; b; c ])

(* ---- Trees ---- *)

let bits_of_code = 20

(* The bits of a number, with two zeros behind each. *)
let spread x =
  let rec spread x n = if n = bits_of_code then 0 else ((x lsr n) land 1) lsl (3 * n) lor spread x (n + 1) in
  spread x 0

(* A tree of the elements in the order of the Z curve through their middles, and the arguments of each. *)
let plan_of site_of family arguments =
  let numbers = List.filter (fun n -> family.vertices n <> None) (List.init family.count Fun.id) in
  let item n =
    let vertices = Option.get (family.vertices n) in
    let sites = List.map site_of vertices in
    let middle of_axis =
      let add sum s =
        let r = of_axis s.ranges in
        sum + Z.to_int r.low0 + Z.to_int r.high1
      in
      List.fold_left add 0 sites / List.length sites
    in
    (n, vertices, [| middle (fun b -> b.x_of); middle (fun b -> b.y_of); middle (fun b -> b.z_of) |])
  in
  let items = Array.of_list (List.rev (List.rev_map item numbers)) in
  if items = [||] then None
  else begin
    let extreme choose k = Array.fold_left (fun x (_, _, m) -> choose x m.(k)) (let _, _, m = items.(0) in m.(k)) items in
    let lowest = Array.init 3 (extreme min) in
    let length = max 1 (List.fold_left max 0 (List.init 3 (fun k -> extreme max k - lowest.(k)))) in
    let rec shift n = if length lsr n < 1 lsl bits_of_code then n else shift (n + 1) in
    let shift = shift 0 in
    let code (_, _, m) =
      let bits k = spread ((m.(k) - lowest.(k)) lsr shift) lsl k in
      bits 0 lor bits 1 lor bits 2
    in
    let coded = Array.map (fun item -> (code item, item)) items in
    Array.stable_sort (fun ((a : int), _) (b, _) -> compare a b) coded;
    let rec plan first last =
      if last - first = 1 then
        let _, (n, vertices, _) = coded.(first) in
        One (List.map Z.of_int vertices, Z.of_int n, arguments n)
      else
        let middle = (first + last) / 2 in
        let left = plan first middle in
        Two (left, plan middle last)
    in
    Some (plan 0 (Array.length coded))
  end

(* ---- Enlargement ---- *)

(* The factor that makes the greatest length just less than 2^50, so that integers stay small. *)
let factor_of greatest =
  let _, exponent = Float.frexp greatest in
  let shift = 50 - exponent in
  if shift >= 0 then { qnum = Z.shift_left Z.one shift; qden = Z.one }
  else { qnum = Z.one; qden = Z.shift_left Z.one (-shift) }

let without_trees factor group_reaches =
  { factor_of = factor; group_reaches; for_vertices = None; for_faces = None; for_edges = None;
    for_points = None; for_bare_edges = None; for_two_points = None }
