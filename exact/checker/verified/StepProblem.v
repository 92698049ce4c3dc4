(** A step of a scene, and what a certificate claims of it: what has to be read, besides Problem.v, to
    understand the theorems of StepProof.v, StepPairs.v and StepSequence.v. *)

Require Import ZArith QArith Reals Qreals List.
Import ListNotations.
Require Import Verified.Problem.
Open Scope Z_scope.

(** Vertices are numbered from 0. Without [groups] all are in group 0. [apart] are groups that are held apart; the
    thickness of two groups is their distance, or else the sum of their radii. *)
Record step := Step {
  vertices : list (triple Q * triple Q);  (* at t=0 and at t=1 *)
  faces : list (Z * Z * Z); edges : list (Z * Z); points : list Z;
  groups : list Z; apart : list (Z * Z); radii : list Q; distances : list (Z * Z * Q);
  separation_of : separation }.

(** An element is the list of its vertices: [v], an edge [a; b] with a < b, or a face [a; b; c]. *)
Definition element := list Z.
Definition without_common_vertex (p q : element) : Prop := forall v, In v p -> ~ In v q.

(** A point of an element whose vertices are at these places at the time t. Two elements within a distance. *)
Definition is_on (place : Z -> R -> vector) (e : element) (t : R) (x : vector) : Prop :=
  is_convex_combination x (map (fun v => place v t) e).
Definition are_within (d : separation) (place : Z -> R -> vector) (p q : element) (t : R) : Prop := exists x y,
  is_on place p t x /\ is_on place q t y /\ (length_of (norm_of d) (minus x y) <= Q2R (distance_of d))%R.

Inductive step_claim := no_contact (upper : Q) | earliest (lower upper : Q) (p q : element).

Section Step.
Variable s : step.
Definition sides : list (Z * Z) := flat_map (fun f => let '(a, b, c) := f in [(a, b); (b, c); (c, a)]) (faces s).
Definition is_edge_of (l : list (Z * Z)) (e : element) : Prop :=
  exists a b, e = [a; b] /\ a < b /\ (In (a, b) l \/ In (b, a) l).
Definition is_face (f : element) : Prop := exists a b c, f = [a; b; c] /\ In (a, b, c) (faces s).
Definition is_edge (e : element) : Prop := is_edge_of (sides ++ edges s) e.
Definition is_vertex (p : element) : Prop :=
  exists v, p = [v] /\ (In v (points s) \/ exists a b, In (a, b) (sides ++ edges s) /\ (v = a \/ v = b)).
Definition is_bare_edge (e : element) : Prop := is_edge e /\ ~ is_edge_of sides e.
Definition is_point (p : element) : Prop := is_vertex p /\ forall e v, is_edge e -> In v e -> ~ In v p.
Definition is_before (p q : element) : Prop := last p 0 < last q 0.
Definition group_of (v : Z) : Z := nth (Z.to_nat v) (groups s) 0.
Definition is_held_apart (v w : Z) : Prop :=
  In (group_of v, group_of w) (apart s) \/ In (group_of w, group_of v) (apart s).

Definition can_collide (p q : element) : Prop :=
  (is_vertex p /\ is_face q \/ is_edge p /\ is_edge q /\ is_before p q \/
   is_point p /\ is_bare_edge q \/ is_point p /\ is_point q /\ is_before p q) /\
  without_common_vertex p q /\ (exists v w, In v p /\ In w q /\ ~ is_held_apart v w).

(** The double nearest to a sum. *)
Variable sum : Q -> Q -> Q.
Definition thickness (g h : Z) : Q :=
  match find (fun d => let '(a, b, _) := d in (a =? g) && (b =? h) || (a =? h) && (b =? g))%bool (distances s) with
  | Some (_, distance) => distance
  | None => sum (nth (Z.to_nat g) (radii s) 0) (nth (Z.to_nat h) (radii s) 0)
  end%Q.
Definition greatest (xs : list Q) : Q := fold_right (fun x y => if Qle_bool x y then y else x) 0%Q xs.
Definition distance_between (gs hs : list Z) : Q :=
  match radii s, distances s with
  | [], [] => distance_of (separation_of s)
  | _, _ => sum (distance_of (separation_of s)) (greatest (flat_map (fun g => map (thickness g) hs) gs))
  end.
Definition separation_between (p q : element) : separation :=
  Separation (distance_between (map group_of p) (map group_of q)) (norm_of (separation_of s)).

(** Vertices move on straight lines. A vertex and an edge are as a vertex and the face e0 e1 e0, two vertices as v and the
    face w w w. *)
Definition ends_of (v : Z) : triple Q * triple Q := nth (Z.to_nat v) (vertices s) (Triple 0 0 0, Triple 0 0 0)%Q.
Definition line (e : triple Q * triple Q) : motion := straight (fst e) (snd e).
Definition query_of_motions (ps qs : list motion) : query :=
  let moving (e : list motion) (i : nat) := nth i e (hd [] e) in
  match ps with
  | [_; _] => Query edge_edge (moving ps 0) (moving ps 1) (moving qs 0) (moving qs 1)
  | _ => Query vertex_face (moving ps 0) (moving qs 0) (moving qs 1) (moving qs 2)
  end%nat.
Definition motion_of (v : Z) : motion := line (ends_of v).
Definition query_of (p q : element) : query := query_of_motions (map motion_of p) (map motion_of q).

Open Scope R_scope.
Definition no_contact_to (upper : Q) : Prop :=
  forall p q, can_collide p q -> no_contact_until (query_of p q) (separation_between p q) (Q2R upper).
Definition step_holds (c : step_claim) : Prop :=
  match c with
  | no_contact upper => 0 <= Q2R upper <= 1 /\ no_contact_to upper
  | earliest lower upper p q =>
      can_collide p q /\ contact_between (query_of p q) (separation_between p q) (Q2R lower) (Q2R upper) /\
      0 <= Q2R lower /\ Q2R upper <= 1 /\
      (Q2R lower = 0 /\ Q2R upper = 0 \/ Q2R lower < Q2R upper /\ no_contact_to lower)
  end.

(** What follows for whole faces (StepPairs.v), where one distance is that of all. *)
Definition place_at (v : Z) (t : R) : vector := position (motion_of v) t.
Definition touch : element -> element -> R -> Prop := are_within (separation_of s) place_at.
Definition has_one_distance : Prop := radii s = [] /\ distances s = [] /\ apart s = [].
Definition no_face_is_a_point : Prop := forall a b c, In (a, b, c) (faces s) -> ~ (a = b /\ b = c).
Definition no_edge_meets_a_face_at_start : Prop := forall e f x, is_edge e -> is_face f -> without_common_vertex e f ->
  is_on place_at e 0 x -> ~ is_on place_at f 0 x.
End Step.

(** A sequence of steps: each begins at the places where the one before it ends, and the same can collide in both. *)
Definition is_followed_by (s next : step) : Prop :=
  map fst (vertices next) = map snd (vertices s) /\ faces next = faces s /\ edges next = edges s /\
  points next = points s /\ groups next = groups s /\ apart next = apart s /\ radii next = radii s /\
  distances next = distances s.
Fixpoint is_sequence (s : step) (later : list step) : Prop :=
  match later with [] => True | next :: later' => is_followed_by s next /\ is_sequence next later' end.

(** One motion of all steps. The first one takes the time from 0 to 1, the next one from 1 to 2. *)
Open Scope R_scope.
Fixpoint place_in (s : step) (later : list step) (v : Z) (t : R) : vector :=
  match later with
  | next :: later' => if Rle_dec t 1 then place_at s v t else place_in next later' v (t - 1)
  | [] => place_at s v t
  end.

(** From k to k+1 no two that can collide come within the distance that the step k has for them. *)
Definition no_contact_in_sequence (sum : Q -> Q -> Q) (s : step) (later : list step) : Prop :=
  forall k r, nth_error (s :: later) k = Some r -> forall t, INR k <= t <= INR k + 1 ->
  forall p q, can_collide s p q -> ~ are_within (separation_between r sum p q) (place_in s later) p q t.
