(** The checker of certificates of queries, and the theorem that what it accepts is true. *)

Require Import ZArith QArith Qreals Reals List Lia Lra Psatz Bool.
Import ListNotations.
Require Import Verified.Problem Verified.Form Verified.Geometry.
Open Scope Z_scope.

(** * Definitions *)

(** ** Certificates *)

(** The name of the direction that separates. Corners are numbered from 0. *)
Inductive feature :=
| of_vertex (i : nat)
| of_edge (i j : nat)
| of_face (negative : bool)
| of_axis (k : axis) (negative : bool)
| of_cross (k : axis) (i j : nat).

(** No contact in [from,to]. *)
Record subinterval := Subinterval { from : Q; to : Q; feature_of : feature }.

(** The time of a contact: a number, or a root of g_0 + g_1 t + … in (lower,upper). *)
Inductive time := at_time (t : Q) | at_root (lower upper : Q) (g : list Z).

(** The place of the contact. *)
Inductive place :=
| in_triangle (i j l : nat) (k : axis)
| on_segment (i j : nat)
| near_vertex (i : nat)
| near_edge (i j : nat)
| near_face
| near_axes.

Record contact_proof := ContactProof { time_of : time; place_of : place }.

(** ** Vectors of forms *)

Definition vector_form := triple form.

Definition f_minus (a b : vector_form) : vector_form :=
  Triple (sub (x_of a) (x_of b)) (sub (y_of a) (y_of b)) (sub (z_of a) (z_of b)).
Definition f_plus (a b : vector_form) : vector_form :=
  Triple (add (x_of a) (x_of b)) (add (y_of a) (y_of b)) (add (z_of a) (z_of b)).
Definition f_times (k : form) (a : vector_form) : vector_form :=
  Triple (mul k (x_of a)) (mul k (y_of a)) (mul k (z_of a)).
Definition f_opposite (a : vector_form) : vector_form :=
  Triple (scale (-1) (x_of a)) (scale (-1) (y_of a)) (scale (-1) (z_of a)).
Definition f_dot (a b : vector_form) : form :=
  add (add (mul (x_of a) (x_of b)) (mul (y_of a) (y_of b))) (mul (z_of a) (z_of b)).
Definition f_cross (a b : vector_form) : vector_form :=
  Triple (sub (mul (y_of a) (z_of b)) (mul (z_of a) (y_of b)))
    (sub (mul (z_of a) (x_of b)) (mul (x_of a) (z_of b)))
    (sub (mul (x_of a) (y_of b)) (mul (y_of a) (x_of b))).
Definition f_unit (k : axis) : vector_form :=
  match k with
  | x_axis => Triple [1] [] []
  | y_axis => Triple [] [1] []
  | z_axis => Triple [] [] [1]
  end.
Definition f_origin : vector_form := Triple [] [] [].

(** ** Integers

    Coordinates and distance are multiplied by a common multiple of their denominators, weights and
    times by one of theirs. That it is a common multiple is seen, not assumed. *)

Definition scaled (m : Z) (x : Q) : Z := Qnum x * (m / Zpos (Qden x)).
Definition is_multiple (m : Z) (x : Q) : bool := m / Zpos (Qden x) * Zpos (Qden x) =? m.
Definition common_multiple (xs : list Q) : Z := fold_left (fun m x => Z.lcm m (Zpos (Qden x))) xs 1.

Definition coordinates (q : query) : list Q :=
  flat_map (flat_map (fun p => [x_of (point_of p); y_of (point_of p); z_of (point_of p)]))
    [point0 q; point1 q; point2 q; point3 q].

(** True if there are weights, all positive. *)
Definition are_weights (weights : list Q) : bool :=
  negb (Nat.eqb (length weights) 0) && forallb (fun w => negb (Qle_bool w 0)) weights &&
  forallb (is_multiple (common_multiple weights)) weights.

(** ** Curves *)

(** The position of a point, enlarged. *)
Record fraction := Fraction { numerator : vector_form; denominator : form }.

Definition times_each (a b : list Z) : list Z := map (fun p => fst p * snd p) (combine a b).

Definition fraction_of (m : Z) (p : motion) : fraction :=
  let weights := map weight_of p in
  let ws := map (scaled (common_multiple weights)) weights in
  let c := times_each (binomials (length p - 1)) ws in
  let times_coordinate (x : triple Q -> Q) := times_each c (map (fun p => scaled m (x (point_of p))) p) in
  Fraction (Triple (times_coordinate x_of) (times_coordinate y_of) (times_coordinate z_of))
    (if forallb (Z.eqb 1) ws then [1] else c).

Definition is_same (a b : form) : bool := is_zero (sub a b).

(** The different forms that are not 1. *)
Definition distinct (fs : list form) : list form :=
  fold_right (fun f rest => if existsb (is_same f) ([1] :: rest) then rest else f :: rest) [] fs.

(** The fraction, multiplied by all denominators but its own. *)
Definition over (denominators : list form) (p : fraction) : fraction :=
  fold_right (fun d p => Fraction (f_times d (numerator p)) (mul d (denominator p))) p
    (filter (fun d => negb (is_same d (denominator p))) denominators).

(** The facts about all subintervals, as forms of t in [0,1]: the factor of space, positive, and
    enlarged by it the corners and the distance; these are of one degree. *)
Record scene := Scene { factor : form; corners_in : list vector_form; reach : form; norm_in : norm }.

Definition elevated_to (n : nat) (f : form) : form := elevate (n - length f) f.

Definition of_length (n : nat) (w : vector_form) : bool :=
  Nat.eqb (length (x_of w)) n && Nat.eqb (length (y_of w)) n && Nat.eqb (length (z_of w)) n.

Definition scene_of (q : query) (s : separation) : option scene :=
  let points := [point0 q; point1 q; point2 q; point3 q] in
  let numbers := distance_of s :: coordinates q in
  let m := common_multiple numbers in
  if (0 <? m) && forallb (is_multiple m) numbers &&
     forallb (fun p => are_weights (map weight_of p)) points && Qle_bool 0 (distance_of s) then
    let fractions := map (fraction_of m) points in
    match map (over (distinct (map denominator fractions))) fractions with
    | [p0; p1; p2; p3] =>
        let common := denominator p0 in
        let w := fun a b => f_minus (numerator a) (numerator b) in
        let corners :=
          match kind_of q with
          | vertex_face => [w p0 p1; w p0 p2; w p0 p3]
          | edge_edge => [w p0 p2; w p1 p2; w p1 p3; w p0 p3]
          end in
        let n := fold_right (fun w n => Nat.max (length (x_of w)) n) (length common) corners in
        let even := elevated_to n in
        let corners := map (fun w => Triple (even (x_of w)) (even (y_of w)) (even (z_of w))) corners in
        let reach := even (scale (scaled m (distance_of s)) common) in
        if forallb (fun p => is_same (denominator p) common) [p1; p2; p3] && is_positive 0 common &&
           forallb (of_length (length reach)) corners then
          Some (Scene (scale m common) corners reach (norm_of s))
        else None
    | _ => None
    end
  else None.

(** 1-t and t, both multiplied by one number, as forms of an interval from its start to its end; of a
    single time, constants. *)
Definition interval := (form * form)%type.

Definition moments (times : list Q) : option interval :=
  let m := common_multiple times in
  if (0 <? m) && forallb (is_multiple m) times then
    Some (map (fun t => m - scaled m t) times, map (scaled m) times)
  else None.

(** A form of the scene on the interval. *)
Definition restrict (sc : scene) (ms : interval) : form -> form :=
  substitute (powers (fst ms) (reach sc)) (snd ms).

Definition corner_forms (sc : scene) (ms : interval) : list vector_form :=
  let restrict := restrict sc ms in
  map (fun w => Triple (restrict (x_of w)) (restrict (y_of w)) (restrict (z_of w))) (corners_in sc).
Definition reach_form (sc : scene) (ms : interval) : form := restrict sc ms (reach sc).

Definition get (ws : list vector_form) (i : nat) : vector_form := nth i ws (hd f_origin ws).

Definition normal (ws : list vector_form) : vector_form :=
  match ws with
  | a :: b :: c :: _ => f_cross (f_minus b a) (f_minus c a)
  | _ => f_origin
  end.

(** ** Separation *)

Definition bisections : nat := 128.

Definition with_sign (negative : bool) (d : vector_form) : vector_form :=
  if negative then f_opposite d else d.

Definition direction (ws : list vector_form) (f : feature) : vector_form :=
  match f with
  | of_vertex i => get ws i
  | of_edge i j =>
      let w := get ws i in
      let e := f_minus (get ws j) w in
      f_minus (f_times (f_dot e e) w) (f_times (f_dot w e) e)
  | of_face negative => with_sign negative (normal ws)
  | of_axis k negative => with_sign negative (f_unit k)
  | of_cross k i j => f_cross (f_unit k) (f_minus (get ws j) (get ws i))
  end.

(** D (σ·d) for every vector σ of signs; the greatest is D‖d‖₁. *)
Definition with_both_signs (D x : form) (sums : list form) : list form :=
  if is_zero x then sums
  else let y := mul D x in flat_map (fun s => [add s y; sub s y]) sums.
Definition reaches (D : form) (d : vector_form) : list form :=
  if is_zero D then [[]]
  else with_both_signs D (x_of d) (with_both_signs D (y_of d) (with_both_signs D (z_of d) [[]])).

(** True if d·w > D‖d‖* on the interval. *)
Definition is_beyond (n : norm) (D : form) (d w : vector_form) : bool :=
  let p := f_dot d w in
  match n with
  | linf => forallb (fun s => is_positive bisections (sub p s)) (reaches D d)
  | l2 =>
      is_positive bisections p &&
      (is_zero D || is_positive bisections (sub (mul p p) (mul (mul D D) (f_dot d d))))
  end.

(** One corner of a face is enough: the normal's product is the same with all. *)
Definition corners_to_check (ws : list vector_form) (f : feature) : list vector_form :=
  match f, ws with
  | of_face _, w :: _ => [w]
  | _, _ => ws
  end.

Definition separates (sc : scene) (s : subinterval) : bool :=
  match moments [from s; to s] with
  | None => false
  | Some ms =>
      let ws := corner_forms sc ms in
      let d := direction ws (feature_of s) in
      forallb (is_beyond (norm_in sc) (reach_form sc ms) d) (corners_to_check ws (feature_of s))
  end.

(** ** Contact *)

(** The sign of p on the interval, if it is seen. *)
Definition sign_on (bisections : nat) (p : form) : option comparison :=
  if is_positive bisections p then Some Gt
  else if is_positive bisections (scale (-1) p) then Some Lt
  else None.

(** The sign of p at the root of g, or at the start. What costs least is tried first. *)
Definition sign_at (g : option form) (p : form) : option comparison :=
  match g with
  | None => Some (hd 0 p ?= 0)
  | Some g =>
      match sign_on 0 p with
      | Some sign => Some sign
      | None => if divides p g p then Some Eq else sign_on bisections p
      end
  end.

Definition is_zero_at g p := match sign_at g p with Some Eq => true | _ => false end.
Definition is_positive_at g p := match sign_at g p with Some Gt => true | _ => false end.
Definition is_not_negative_at g p := match sign_at g p with Some Gt | Some Eq => true | _ => false end.
Definition is_not_positive_at g p := match sign_at g p with Some Lt | Some Eq => true | _ => false end.

Definition proves_triangle g (a b c : vector_form) (k : axis) : bool :=
  let bc := f_cross b c in
  let i := component k bc in
  let j := component k (f_cross c a) in
  let l := component k (f_cross a b) in
  let sum := add (add i j) l in
  is_zero_at g (f_dot a bc) &&
  match sign_at g sum with
  | Some Gt => is_not_negative_at g i && is_not_negative_at g j && is_not_negative_at g l
  | Some Lt => is_not_positive_at g i && is_not_positive_at g j && is_not_positive_at g l
  | _ => false
  end.

Definition proves_segment g (a b : vector_form) : bool :=
  let n := f_cross a b in
  is_zero_at g (x_of n) && is_zero_at g (y_of n) && is_zero_at g (z_of n) &&
  is_not_positive_at g (f_dot a b).

(** square ≤ D² |base|² *)
Definition is_near g (D square base : form) : bool :=
  is_not_negative_at g (sub (mul (mul D D) base) square).

Definition proves_edge g (D : form) (a b : vector_form) : bool :=
  let e := f_minus b a in
  let n := f_cross a b in
  is_positive_at g (f_dot e e) && is_not_positive_at g (f_dot a e) &&
  is_not_negative_at g (f_dot b e) && is_near g D (f_dot n n) (f_dot e e).

Definition is_inwards g (n a b : vector_form) : bool := is_not_negative_at g (f_dot n (f_cross a b)).

Definition proves_face g (D : form) (ws : list vector_form) : bool :=
  let n := normal ws in
  match ws with
  | a :: b :: c :: rest =>
      let h := f_dot n a in
      is_positive_at g (f_dot n n) && is_near g D (mul h h) (f_dot n n) &&
      is_inwards g n a b && is_inwards g n b c &&
      match rest with
      | [] => is_inwards g n c a
      | f :: _ => is_inwards g n c f && is_inwards g n f a
      end
  | _ => false
  end.

(** A contact in linf, by a witness. The points a + u e + v f of the polygon that are within D on
    every axis are a polygon in the plane of (u,v), which has a vertex: where two lines meet of those
    of the polygon's sides and of the planes at ±D. A line is (α,β,γ): α u + β v + γ = 0. *)
Definition is_within g (r y : form) : bool := is_not_negative_at g (sub r y) && is_not_negative_at g (add r y).

Definition is_witness_at g (D : form) (is_triangle : bool) (a e f n : vector_form) : bool :=
  let p := x_of n in
  let q := y_of n in
  let m := z_of n in
  is_positive_at g m && is_not_negative_at g p && is_not_negative_at g q &&
  (if is_triangle then is_not_negative_at g (sub m (add p q))
   else is_not_negative_at g (sub m p) && is_not_negative_at g (sub m q)) &&
  let x := f_plus (f_plus (f_times m a) (f_times p e)) (f_times q f) in
  let r := mul D m in
  is_within g r (x_of x) && is_within g r (y_of x) && is_within g r (z_of x).

Definition is_witness g (D : form) (is_triangle : bool) (a e f line other : vector_form) : bool :=
  let n := f_cross line other in
  is_witness_at g D is_triangle a e f n || is_witness_at g D is_triangle a e f (f_opposite n).

Definition lines (D : form) (is_triangle : bool) (a e f : vector_form) : list vector_form :=
  let slab (k : axis) (D : form) := Triple (component k e) (component k f) (sub (component k a) D) in
  let minus_D := scale (-1) D in
  [Triple [1] [] []; Triple [] [1] []] ++
  (if is_triangle then [Triple [1] [1] [-1]] else [Triple [1] [] [-1]; Triple [] [1] [-1]]) ++
  [slab x_axis D; slab x_axis minus_D; slab y_axis D; slab y_axis minus_D; slab z_axis D;
   slab z_axis minus_D].

Fixpoint some_pair {A} (p : A -> A -> bool) (xs : list A) : bool :=
  match xs with
  | [] => false
  | x :: rest => existsb (p x) rest || some_pair p rest
  end.

Definition proves_axes g (D : form) (ws : list vector_form) : bool :=
  match ws with
  | a :: b :: c :: rest =>
      let is_triangle := match rest with [] => true | _ => false end in
      let e := f_minus b a in
      let f := f_minus (match rest with [] => c | f :: _ => f end) a in
      some_pair (is_witness g D is_triangle a e f) (lines D is_triangle a e f)
  | _ => false
  end.

Definition proves_place g (sc : scene) (D : form) (ws : list vector_form) (p : place) : bool :=
  match p with
  | in_triangle i j l k => proves_triangle g (get ws i) (get ws j) (get ws l) k
  | on_segment i j => proves_segment g (get ws i) (get ws j)
  | near_vertex i => is_near g D (f_dot (get ws i) (get ws i)) [1]
  | near_edge i j => proves_edge g D (get ws i) (get ws j)
  | near_face => proves_face g D ws
  | near_axes => match norm_in sc with linf => proves_axes g D ws | l2 => false end
  end.

(** g_0 + g_1 t + … as a form, enlarged. What it says of t is of no account: any form that changes its
    sign will do. *)
Definition on_interval (ms : interval) (g : list Z) : form :=
  substitute (powers (add (fst ms) (snd ms)) g) (snd ms) g.

(** ** The checker *)

Section Claim.
(** What is seen on a subinterval: no event; at the root of a form, or at the start of an interval: an event. *)
Variable is_free : subinterval -> bool.
Variable is_event : place -> option form -> interval -> bool.

(** The subintervals follow one another from a to b without a gap. *)
Fixpoint all_are_free (a b : Q) (subintervals : list subinterval) : bool :=
  match subintervals with
  | [] => false
  | s :: rest =>
      Qeq_bool (from s) a && Qle_bool (from s) (to s) && is_free s &&
      match rest with
      | [] => Qeq_bool (to s) b
      | _ => all_are_free (to s) b rest
      end
  end.

(** An event in [a,b]. *)
Definition proves_event (a b : Q) (c : contact_proof) : bool :=
  match time_of c with
  | at_time t =>
      Qle_bool a t && Qle_bool t b &&
      match moments [t] with Some ms => is_event (place_of c) None ms | None => false end
  | at_root lower upper g =>
      Qle_bool a lower && Qle_bool lower upper && Qle_bool upper b &&
      match moments [lower; upper] with
      | Some ms => let g := on_interval ms g in changes_sign g && is_event (place_of c) (Some g) ms
      | None => false
      end
  end.

Definition check_claim (c : claim) (subintervals : list subinterval) (contact : option contact_proof) : bool :=
  let event_in (a b : Q) := match contact with Some p => proves_event a b p | None => false end in
  match c with
  | no_collision => all_are_free 0 1 subintervals
  | collision => event_in 0 1
  | time_of_impact lower upper =>
      if Qeq_bool lower 0 && Qeq_bool upper 0 then event_in 0 0
      else
        Qle_bool 0 lower && Qle_bool upper 1 && negb (Qle_bool upper lower) &&
        all_are_free 0 lower subintervals && event_in lower upper
  end%Q.
End Claim.

Definition is_contact (sc : scene) (p : place) (g : option form) (ms : interval) : bool :=
  proves_place g sc (reach_form sc ms) (corner_forms sc ms) p.

Definition check (q : query) (s : separation) (c : claim) (subintervals : list subinterval)
    (contact : option contact_proof) : bool :=
  match scene_of q s with
  | Some sc => check_claim (separates sc) (is_contact sc) c subintervals contact
  | None => false
  end.
