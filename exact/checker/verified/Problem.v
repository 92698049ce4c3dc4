(** The problem, and what a certificate claims of it: all that has to be read to understand the
    theorem of Proof.v.

    Four points move on Bézier curves, x(t) = Σ B_k(t) ω_k b_k / Σ B_k(t) ω_k for t in [0,1]. The
    control points b_0 … b_n are rational, and the weights ω_k, all positive; if these are equal the curve is
    a polynomial. [F] is the difference of a point of the one primitive and a point of the other, as
    in Wang et al. 2021, equations 3 and 4. There is a contact at the time t within the distance d if
    a difference is not longer than d. *)

Require Import Reals QArith Qreals List.
Import ListNotations.
Open Scope R_scope.

(** ** Vectors *)

Record triple (A : Type) := Triple { x_of : A; y_of : A; z_of : A }.
Arguments Triple {A}.
Arguments x_of {A}.
Arguments y_of {A}.
Arguments z_of {A}.

Definition vector := triple R.

Definition plus (a b : vector) : vector :=
  Triple (x_of a + x_of b) (y_of a + y_of b) (z_of a + z_of b).
Definition minus (a b : vector) : vector :=
  Triple (x_of a - x_of b) (y_of a - y_of b) (z_of a - z_of b).
Definition times (k : R) (a : vector) : vector := Triple (k * x_of a) (k * y_of a) (k * z_of a).
Definition dot (a b : vector) : R := x_of a * x_of b + y_of a * y_of b + z_of a * z_of b.

Definition origin : vector := Triple 0 0 0.

Fixpoint combination (weights : list R) (ws : list vector) : vector :=
  match weights, ws with
  | k :: weights', w :: ws' => plus (times k w) (combination weights' ws')
  | _, _ => origin
  end.

Definition is_convex_combination (x : vector) (ws : list vector) : Prop :=
  exists weights, length weights = length ws /\ Forall (Rle 0) weights /\
    fold_right Rplus 0 weights = 1 /\ combination weights ws = x.

Inductive norm := linf | l2.

Definition length_of (n : norm) (a : vector) : R :=
  match n with
  | linf => Rmax (Rabs (x_of a)) (Rmax (Rabs (y_of a)) (Rabs (z_of a)))
  | l2 => sqrt (dot a a)
  end.

(** ** The query *)

Inductive kind := vertex_face | edge_edge.

(** The control points, in the order of time: one more than the degree. *)
Record control := Control { point_of : triple Q; weight_of : Q }.
Definition motion := list control.

(** The four points: v f0 f1 f2, or ea0 ea1 eb0 eb1. *)
Record query := Query { kind_of : kind; point0 : motion; point1 : motion; point2 : motion; point3 : motion }.

(** The Bernstein polynomials B_k of degree n; [C] is the binomial coefficient. *)
Definition bernstein (n k : nat) (t : R) : R := C n k * (1 - t) ^ (n - k) * t ^ k.

Definition bernstein_sum (c : list R) (t : R) : R :=
  let n := (length c - 1)%nat in sum_f_R0 (fun k => bernstein n k t * nth k c 0) n.

Definition position (m : motion) (t : R) : vector :=
  let sum (f : control -> R) := bernstein_sum (map f m) t in
  let weight (p : control) := Q2R (weight_of p) in
  let mean (x : triple Q -> Q) := sum (fun p => weight p * Q2R (x (point_of p))) / sum weight in
  Triple (mean x_of) (mean y_of) (mean z_of).

(** On a straight line x(t) = (1-t) a + t b: [straight_line] of Proof.v. *)
Definition straight (a b : triple Q) : motion := [Control a 1; Control b 1].

(** The parameters of a point of the triangle, or of both edges. *)
Definition in_domain (k : kind) (u v : R) : Prop :=
  match k with
  | vertex_face => 0 <= u /\ 0 <= v /\ u + v <= 1
  | edge_edge => 0 <= u <= 1 /\ 0 <= v <= 1
  end.

Definition F (q : query) (t u v : R) : vector :=
  let p0 := position (point0 q) t in
  let p1 := position (point1 q) t in
  let p2 := position (point2 q) t in
  let p3 := position (point3 q) t in
  match kind_of q with
  | vertex_face => minus p0 (plus (plus (times (1 - u - v) p1) (times u p2)) (times v p3))
  | edge_edge =>
      minus (plus (times (1 - u) p0) (times u p1)) (plus (times (1 - v) p2) (times v p3))
  end.

(** ** Claims *)

Inductive claim := no_collision | collision | time_of_impact (lower upper : Q).

(** What a claim says of an event: a contact, or an inversion (Inversion.v). *)
Definition never_until (event : R -> Prop) (b : R) : Prop := forall t, 0 <= t <= b -> ~ event t.
Definition once_between (event : R -> Prop) (a b : R) : Prop := exists t, a <= t <= b /\ event t.

(** A time of impact [0 0] says that there is an event at 0. All other say that there is none up
    to [lower], and one between [lower] and [upper]. *)
Definition holds_of (event : R -> Prop) (c : claim) : Prop :=
  match c with
  | no_collision => never_until event 1
  | collision => once_between event 0 1
  | time_of_impact lower upper =>
      once_between event (Q2R lower) (Q2R upper) /\ 0 <= Q2R lower /\ Q2R upper <= 1 /\
      (Q2R lower = 0 /\ Q2R upper = 0 \/ Q2R lower < Q2R upper /\ never_until event (Q2R lower))
  end.

(** The distance that counts as contact, at least 0, and its norm. *)
Record separation := Separation { distance_of : Q; norm_of : norm }.

Definition contact (q : query) (s : separation) (t : R) : Prop :=
  exists u v, in_domain (kind_of q) u v /\ length_of (norm_of s) (F q t u v) <= Q2R (distance_of s).

Definition no_contact_until (q : query) (s : separation) : R -> Prop := never_until (contact q s).
Definition contact_between (q : query) (s : separation) : R -> R -> Prop := once_between (contact q s).
Definition holds (q : query) (s : separation) : claim -> Prop := holds_of (contact q s).
