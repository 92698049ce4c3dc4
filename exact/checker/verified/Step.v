(** The checker of certificates of steps.

    Every pair that can collide is met by a search through two trees: pairs of nodes whose boxes an axis keeps apart are
    left out, pairs of elements have an argument. The trees are made elsewhere; what is seen here is that their leaves are
    all elements, and boxes are made here. Space is enlarged by a factor, and coordinates at both ends of the step are
    enclosed by integers. Vertices move on straight lines: what is beyond a plane at both ends is beyond it on the way. *)

Require Import ZArith QArith List Bool FMapPositive.
Import ListNotations.
Require Import Verified.Problem Verified.StepProblem Verified.Geometry Verified.Checker.
Open Scope Z_scope.

(** ** Maps of numbers, sets of numbers and of pairs *)

Definition map_of := PositiveMap.t.
Definition empty {A} : map_of A := PositiveMap.empty A.

Definition key (z : Z) : positive :=
  match z with Z0 => 1 | Zpos p => p~1 | Zneg p => p~0 end%positive.
Definition find_in {A} (m : map_of A) (z : Z) : option A := PositiveMap.find (key z) m.
Definition add_to {A} (z : Z) (a : A) (m : map_of A) : map_of A := PositiveMap.add (key z) a m.

Definition numbers := map_of unit.
Definition has (m : numbers) (z : Z) : bool := match find_in m z with Some _ => true | None => false end.
Definition with_number (z : Z) (m : numbers) : numbers := add_to z tt m.

Definition pairs := map_of numbers.
Definition at_number (m : pairs) (a : Z) : numbers :=
  match find_in m a with Some n => n | None => @empty unit end.
Definition has_pair (m : pairs) (a b : Z) : bool := has (at_number m a) b.
Definition with_pair (a b : Z) (m : pairs) : pairs := add_to a (with_number b (at_number m a)) m.

(** ** Sites *)

(** The integers around a coordinate, at the start and at the end. *)
Record range := Range { low0 : Z; high0 : Z; low1 : Z; high1 : Z }.
Definition box := triple range.

(** [reach]: of two vertices, the sum of their reaches and the distance of all is not below their own distance. *)
Record site := Site { number : Z; group : Z; reach_of : Z; moves : triple Q * triple Q; ranges : box }.

Inductive argument := by_direction (d : triple Z) | by_subintervals (subintervals : list subinterval).

(** An element, its label, and arguments for pairs of it and those with other labels. *)
Record item := Item { sites : list site; label : Z; arguments : list (Z * argument) }.

(** What is the same for all pairs: the step and its sums, the factor of space, the end of the time in question, the enlarged
    distance of all, and groups that are held apart, in both orders. *)
Record setting := Setting {
  the_step : step; the_sum : Q -> Q -> Q; space : Q; upper : Q; gap : Z; held : pairs }.

(** The greatest integer that is not above (n/d) k, and the least that is not below. *)
Definition down (k : Q) (n d : Z) : Z := n * Qnum k / (d * Zpos (Qden k)).
Definition up (k : Q) (n d : Z) : Z := - down k (- n) d.
Definition enlarged_distance (k : Q) (d : Q) : Z := Z.max 0 (up k (Qnum d) (Zpos (Qden d))).

Definition range_of (k e a b : Q) : range :=
  let an := Qnum a in let ad := Zpos (Qden a) in
  let bd := Zpos (Qden b) in let ed := Zpos (Qden e) in
  let n := an * bd * (ed - Qnum e) + Qnum b * ad * Qnum e in
  let d := ad * bd * ed in
  Range (down k an ad) (up k an ad) (down k n d) (up k n d).

Definition box_of_motion (k e : Q) (m : triple Q * triple Q) : box :=
  let '(a, b) := m in
  Triple (range_of k e (x_of a) (x_of b)) (range_of k e (y_of a) (y_of b)) (range_of k e (z_of a) (z_of b)).

(** The sites of all vertices whose group has a reach. *)
Fixpoint add_sites (k e : Q) (reach : Z -> option Z) (n : Z) (vs : list (triple Q * triple Q)) (gs : list Z)
    (m : map_of site) : map_of site :=
  match vs with
  | [] => m
  | v :: vs' =>
      let g := hd 0 gs in
      add_sites k e reach (n + 1) vs' (tl gs)
        match reach g with
        | Some r => add_to n (Site n g r v (box_of_motion k e v)) m
        | None => m
        end
  end.

Fixpoint find_sites (m : map_of site) (e : element) : option (list site) :=
  match e with
  | [] => Some []
  | v :: e' =>
      match find_in m v, find_sites m e' with
      | Some p, Some ps => Some (p :: ps)
      | _, _ => None
      end
  end.

(** ** Directions *)

(** The least product of a vector and a point of a box, or the greatest one. *)
Definition extreme (low high : range -> Z) (d : triple Z) (b : box) : Z :=
  let product k r := k * (if k <? 0 then high r else low r) in
  product (x_of d) (x_of b) + product (y_of d) (y_of b) + product (z_of d) (z_of b).

(** True if d keeps all of [ps] above all of [qs] by a distance. *)
Definition is_above (distance : Z) (d : triple Z) (ps qs : list site) : bool :=
  let reach := distance * (Z.abs (x_of d) + Z.abs (y_of d) + Z.abs (z_of d)) in
  forallb (fun p =>
    let at_start := extreme low0 high0 d (ranges p) in
    let at_end := extreme low1 high1 d (ranges p) in
    forallb (fun q =>
      (extreme high0 low0 d (ranges q) + reach <? at_start) &&
      (extreme high1 low1 d (ranges q) + reach <? at_end)) qs) ps.

Definition is_axis_between (distance : Z) (ps qs : list site) : bool :=
  existsb (fun d => is_above distance d ps qs || is_above distance d qs ps)
    [Triple 1 0 0; Triple 0 1 0; Triple 0 0 1].

(** ** Pairs *)

Definition distance_of_pair (c : setting) (ps qs : list site) : Q :=
  distance_between (the_step c) (the_sum c) (map group ps) (map group qs).

(** True if the distance of all is that of each pair. *)
Definition is_thin (s : step) : bool := match radii s, distances s with [], [] => true | _, _ => false end.

Definition enlarged_between (c : setting) (ps qs : list site) : Z :=
  if is_thin (the_step c) then gap c else enlarged_distance (space c) (distance_of_pair c ps qs).

Definition query_between (ps qs : list site) : query :=
  query_of_motions (map (fun p => line (moves p)) ps) (map (fun q => line (moves q)) qs).

Definition scene_between (c : setting) (ps qs : list site) : option scene :=
  scene_of (query_between ps qs)
    (Separation (distance_of_pair c ps qs) (norm_of (separation_of (the_step c)))).

(** True if the argument keeps two elements apart. *)
Definition proves (c : setting) (ps qs : list site) (a : argument) : bool :=
  match a with
  | by_direction d => is_above (enlarged_between c ps qs) d ps qs
  | by_subintervals subintervals =>
      match scene_between c ps qs with
      | Some sc => all_are_free (separates sc) 0 (upper c) subintervals
      | None => false
      end
  end.

Definition have_common_vertex (ps qs : list site) : bool :=
  existsb (fun p => existsb (fun q => number p =? number q) qs) ps.
Definition are_held_apart (c : setting) (ps qs : list site) : bool :=
  forallb (fun p => forallb (fun q => has_pair (held c) (group p) (group q)) qs) ps.

Fixpoint proved_with (c : setting) (ps qs : list site) (other : Z) (xs : list (Z * argument)) : bool :=
  match xs with
  | [] => false
  | (l, a) :: rest => if l =? other then proves c ps qs a else proved_with c ps qs other rest
  end.

(** True if two elements are proved not to touch, or cannot collide. *)
Definition is_proved (c : setting) (x y : item) : bool :=
  let ps := sites x in
  let qs := sites y in
  have_common_vertex ps qs || proved_with c ps qs (label y) (arguments x) ||
  are_held_apart c ps qs || is_axis_between (enlarged_between c ps qs) ps qs.

(** The same in the order of the elements. *)
Definition is_proved_in_order (c : setting) (x y : item) : bool :=
  let last_of (z : item) := last (map number (sites z)) 0 in
  if last_of x <? last_of y then is_proved c x y else is_proved c y x.

(** ** Trees *)

Inductive plan := one (e : element) (l : Z) (xs : list (Z * argument)) | two (p q : plan).
Inductive box_tree := box_leaf (b : box) (x : item) | box_node (b : box) (l r : box_tree).

Definition box_of (t : box_tree) : box := match t with box_leaf b _ => b | box_node b _ _ => b end.

Definition map_triple {A B} (f : A -> A -> B) (a b : triple A) : triple B :=
  Triple (f (x_of a) (x_of b)) (f (y_of a) (y_of b)) (f (z_of a) (z_of b)).
Definition range_around (a b : range) : range :=
  Range (Z.min (low0 a) (low0 b)) (Z.max (high0 a) (high0 b)) (Z.min (low1 a) (low1 b)) (Z.max (high1 a) (high1 b)).
Definition around : box -> box -> box := map_triple range_around.

(** The box of an element, enlarged: by the reach on both sides, and by the distance of all above. *)
Definition box_around (gap : Z) (p : site) (ps : list site) : box :=
  let reach := fold_left (fun r q => Z.max r (reach_of q)) ps (reach_of p) in
  let b := fold_left (fun b q => around b (ranges q)) ps (ranges p) in
  let enlarge r _ := Range (low0 r - reach) (high0 r + reach + gap) (low1 r - reach) (high1 r + reach + gap) in
  map_triple enlarge b b.

Fixpoint grow (gap : Z) (m : map_of site) (p : plan) : option box_tree :=
  match p with
  | one e l xs =>
      match find_sites m e with
      | Some (q :: qs) => Some (box_leaf (box_around gap q qs) (Item (q :: qs) l xs))
      | _ => None
      end
  | two p q =>
      match grow gap m p, grow gap m q with
      | Some l, Some r => Some (box_node (around (box_of l) (box_of r)) l r)
      | _, _ => None
      end
  end.

Definition is_below (a b : range) : bool := (high0 a <? low0 b) && (high1 a <? low1 b).
Definition are_apart (a b : range) : bool := is_below a b || is_below b a.
Definition are_boxes_apart (a b : box) : bool :=
  are_apart (x_of a) (x_of b) || are_apart (y_of a) (y_of b) || are_apart (z_of a) (z_of b).

(** True if all pairs of an element of the one tree and one of the other are proved, or apart. *)
Fixpoint search (is_pair_proved : item -> item -> bool) (a : box_tree) : box_tree -> bool :=
  fix search_a (b : box_tree) : bool :=
    are_boxes_apart (box_of a) (box_of b) ||
    match a, b with
    | box_leaf _ x, box_leaf _ y => is_pair_proved x y
    | box_leaf _ _, box_node _ l r => search_a l && search_a r
    | box_node _ l r, box_leaf _ _ => search is_pair_proved l b && search is_pair_proved r b
    | box_node _ l r, box_node _ l' r' =>
        search is_pair_proved l l' && search is_pair_proved l r' &&
        search is_pair_proved r l' && search is_pair_proved r r'
    end.

(** The same of one tree, each two once. *)
Fixpoint search_within (is_pair_proved : item -> item -> bool) (a : box_tree) : bool :=
  match a with
  | box_leaf _ _ => true
  | box_node _ l r =>
      search_within is_pair_proved l && search_within is_pair_proved r && search is_pair_proved l r
  end.

(** ** All elements are there *)

(** The sides of faces; these and the edges. (The lists of StepProblem.v would take a deep stack.) *)
Definition side_list (s : step) : list (Z * Z) :=
  fold_left (fun l t => let '(a, b, c) := t in (a, b) :: (b, c) :: (c, a) :: l) (faces s) [].
Definition line_list (s : step) : list (Z * Z) := rev_append (edges s) (side_list s).

Fixpoint fold_plan {A} (f : element -> Z -> A -> A) (p : plan) (x : A) : A :=
  match p with
  | one e l _ => f e l x
  | two p q => fold_plan f q (fold_plan f p x)
  end.
Definition fold_plans {A} (f : element -> Z -> A -> A) (p : option plan) (x : A) : A :=
  match p with Some p => fold_plan f p x | None => x end.

Definition vertices_in (p : option plan) : numbers :=
  fold_plans (fun e _ m => match e with [v] => with_number v m | _ => m end) p (@empty unit).
Definition edges_in (p : option plan) : pairs :=
  fold_plans (fun e _ m => match e with [a; b] => with_pair a b m | _ => m end) p (@empty numbers).
Definition labelled (p : option plan) : map_of element :=
  fold_plans (fun e l m => add_to l e m) p (@empty element).

Definition has_vertices (s : step) (lines : list (Z * Z)) (m : numbers) : bool :=
  forallb (fun e => has m (fst e) && has m (snd e)) lines && forallb (has m) (points s).

(** Faces have their numbers as labels. *)
Fixpoint has_faces (m : map_of element) (n : Z) (fs : list (Z * Z * Z)) : bool :=
  match fs with
  | [] => true
  | (a, b, c) :: rest =>
      match find_in m n with
      | Some [i; j; k] => (i =? a) && (j =? b) && (k =? c) && has_faces m (n + 1) rest
      | _ => false
      end
  end.

Definition is_loop (e : Z * Z) : bool := fst e =? snd e.
Definition has_edge (m : pairs) (e : Z * Z) : bool :=
  is_loop e || has_pair m (Z.min (fst e) (snd e)) (Z.max (fst e) (snd e)).

(** Vertices without an edge are points, or the ends of an edge that is none. *)
Definition ends (lines : list (Z * Z)) : numbers :=
  fold_left (fun m e => if is_loop e then m else with_number (fst e) (with_number (snd e) m)) lines (@empty unit).
Definition has_points (s : step) (lines : list (Z * Z)) (m : numbers) : bool :=
  let all (is_there : Z -> bool) :=
    forallb is_there (points s) && forallb (fun e => negb (is_loop e) || is_there (fst e)) lines in
  all (has m) || (let m' := ends lines in all (fun v => has m v || has m' v)).

Definition sides_in (s : step) : pairs :=
  fold_left (fun m e => with_pair (Z.min (fst e) (snd e)) (Z.max (fst e) (snd e)) m) (side_list s) (@empty numbers).
Definition has_bare_edges (s : step) (m : pairs) : bool :=
  forallb (has_edge m) (edges s) || (let m' := sides_in s in forallb (fun e => has_edge m e || has_edge m' e) (edges s)).

(** ** No contact *)

(** What is not to be believed. *)
Record hints := Hints {
  factor_of : Q; group_reaches : list (Z * Z);
  for_vertices : option plan; for_faces : option plan; for_edges : option plan;
  for_points : option plan; for_bare_edges : option plan; for_two_points : option plan }.

Definition reach_in (s : step) (h : hints) : Z -> option Z :=
  if is_thin s then fun _ => Some 0
  else find_in (fold_left (fun m x => add_to (fst x) (snd x) m) (group_reaches h) (@empty Z)).

Definition are_reaches (c : setting) (h : hints) : bool :=
  is_thin (the_step c) ||
  forallb (fun x => forallb (fun y =>
    enlarged_distance (space c) (distance_between (the_step c) (the_sum c) [fst x] [fst y]) <=?
    gap c + snd x + snd y) (group_reaches h)) (group_reaches h).

Definition held_in (s : step) : pairs :=
  fold_left (fun m x => with_pair (fst x) (snd x) (with_pair (snd x) (fst x) m)) (apart s) (@empty numbers).
Definition setting_of (s : step) (sum : Q -> Q -> Q) (e : Q) (h : hints) : setting :=
  Setting s sum (factor_of h) e (enlarged_distance (factor_of h) (distance_of (separation_of s))) (held_in s).

Definition sites_of (s : step) (e : Q) (h : hints) : map_of site :=
  add_sites (factor_of h) e (reach_in s h) 0 (vertices s) (groups s) (@empty site).

Definition between (gap : Z) (m : map_of site) (is_pair_proved : item -> item -> bool) (p q : option plan) : bool :=
  match p, q with
  | Some p, Some q =>
      match grow gap m p, grow gap m q with
      | Some a, Some b => search is_pair_proved a b
      | _, _ => false
      end
  | _, _ => true
  end.
Definition within (gap : Z) (m : map_of site) (is_pair_proved : item -> item -> bool) (p : option plan) : bool :=
  match p with
  | Some p => match grow gap m p with Some a => search_within is_pair_proved a | None => false end
  | None => true
  end.

Definition proves_no_contact (c : setting) (m : map_of site) (h : hints) : bool :=
  let s := the_step c in
  let lines := line_list s in
  (0 <? Qnum (space c)) && are_reaches c h &&
  has_vertices s lines (vertices_in (for_vertices h)) && has_faces (labelled (for_faces h)) 0 (faces s) &&
  forallb (has_edge (edges_in (for_edges h))) lines &&
  has_points s lines (vertices_in (for_points h)) && has_points s lines (vertices_in (for_two_points h)) &&
  has_bare_edges s (edges_in (for_bare_edges h)) &&
  between (gap c) m (is_proved c) (for_vertices h) (for_faces h) &&
  within (gap c) m (is_proved_in_order c) (for_edges h) &&
  between (gap c) m (is_proved c) (for_points h) (for_bare_edges h) &&
  within (gap c) m (is_proved_in_order c) (for_two_points h).

(** ** A contact of two that can collide *)

Definition joins (a b : Z) (e : Z * Z) : bool :=
  (fst e =? a) && (snd e =? b) || (fst e =? b) && (snd e =? a).

Definition seems_face (s : step) (p : element) : bool :=
  match p with
  | [a; b; c] => existsb (fun t => let '(x, y, z) := t in (x =? a) && (y =? b) && (z =? c)) (faces s)
  | _ => false
  end.
Definition seems_edge_of (l : list (Z * Z)) (p : element) : bool :=
  match p with [a; b] => (a <? b) && existsb (joins a b) l | _ => false end.
Definition seems_edge (s : step) : element -> bool := seems_edge_of (line_list s).
Definition seems_bare_edge (s : step) (p : element) : bool :=
  seems_edge s p && negb (seems_edge_of (side_list s) p).
Definition has_end (v : Z) (e : Z * Z) : bool := (v =? fst e) || (v =? snd e).
Definition seems_vertex (s : step) (p : element) : bool :=
  match p with
  | [v] => existsb (Z.eqb v) (points s) || existsb (has_end v) (line_list s)
  | _ => false
  end.
Definition seems_point (s : step) (p : element) : bool :=
  match p with
  | [v] => seems_vertex s p && negb (existsb (fun e => negb (is_loop e) && has_end v e) (line_list s))
  | _ => false
  end.
Definition seems_before (p q : element) : bool := last p 0 <? last q 0.

Definition seem_to_collide (c : setting) (ps qs : list site) : bool :=
  let s := the_step c in
  let p := map number ps in
  let q := map number qs in
  (seems_vertex s p && seems_face s q || seems_edge s p && seems_edge s q && seems_before p q ||
   seems_point s p && seems_bare_edge s q || seems_point s p && seems_point s q && seems_before p q) &&
  negb (have_common_vertex ps qs) &&
  existsb (fun x => existsb (fun y =>
    negb (existsb (joins (group x) (group y)) (apart s))) qs) ps.

Definition proves_contact_of (c : setting) (m : map_of site) (lower upper : Q) (p q : element)
    (contact : option contact_proof) : bool :=
  match contact, find_sites m p, find_sites m q with
  | Some x, Some ps, Some qs =>
      seem_to_collide c ps qs &&
      match scene_between c ps qs with Some sc => proves_event (is_contact sc) lower upper x | None => false end
  | _, _, _ => false
  end.

(** ** The checker *)

Definition check_step (sum : Q -> Q -> Q) (s : step) (claim : step_claim) (h : hints)
    (contact : option contact_proof) : bool :=
  let e := match claim with no_contact upper => upper | earliest lower _ _ _ => lower end in
  let c := setting_of s sum e h in
  let m := sites_of s e h in
  match claim with
  | no_contact upper => Qle_bool 0 upper && Qle_bool upper 1 && proves_no_contact c m h
  | earliest lower upper p q =>
      proves_contact_of c m lower upper p q contact &&
      (Qeq_bool lower 0 && Qeq_bool upper 0 ||
       Qle_bool 0 lower && Qle_bool upper 1 && negb (Qle_bool upper lower) && proves_no_contact c m h)
  end.
