(** The problem, and what a certificate claims of it: all that has to be read to understand the
    theorem of Proof.v.

    Four points move on straight lines, x(t) = (1-t) x(0) + t x(1) for t in [0,1]; their coordinates
    are rational. [F] is the difference of a point of the one primitive and a point of the other, as
    in Wang et al. 2021, equations 3 and 4. There is a contact at the time t within the distance d if
    a difference is not longer than d. *)

Require Import Reals QArith Qreals.
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

Inductive norm := linf | l2.

Definition length_of (n : norm) (a : vector) : R :=
  match n with
  | linf => Rmax (Rabs (x_of a)) (Rmax (Rabs (y_of a)) (Rabs (z_of a)))
  | l2 => sqrt (dot a a)
  end.

(** ** The query *)

Inductive kind := vertex_face | edge_edge.

(** The coordinates at t=0 and at t=1. *)
Record motion := Motion { at_start : triple Q; at_end : triple Q }.

(** The four points: v f0 f1 f2, or ea0 ea1 eb0 eb1. *)
Record query := Query { kind_of : kind; point0 : motion; point1 : motion; point2 : motion; point3 : motion }.

Definition to_vector (a : triple Q) : vector := Triple (Q2R (x_of a)) (Q2R (y_of a)) (Q2R (z_of a)).

Definition position (m : motion) (t : R) : vector :=
  plus (times (1 - t) (to_vector (at_start m))) (times t (to_vector (at_end m))).

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

(** The distance that counts as contact, at least 0, and its norm. *)
Record separation := Separation { distance_of : Q; norm_of : norm }.

Definition contact (q : query) (s : separation) (t : R) : Prop :=
  exists u v, in_domain (kind_of q) u v /\ length_of (norm_of s) (F q t u v) <= Q2R (distance_of s).

Inductive claim := no_collision | collision | time_of_impact (lower upper : Q).

Definition no_contact_until (q : query) (s : separation) (b : R) : Prop :=
  forall t, 0 <= t <= b -> ~ contact q s t.

Definition contact_between (q : query) (s : separation) (a b : R) : Prop :=
  exists t, a <= t <= b /\ contact q s t.

(** A time of impact [0 0] says that there is a contact at 0. All other say that there is none up
    to [lower], and one between [lower] and [upper]. *)
Definition holds (q : query) (s : separation) (c : claim) : Prop :=
  match c with
  | no_collision => no_contact_until q s 1
  | collision => contact_between q s 0 1
  | time_of_impact lower upper =>
      contact_between q s (Q2R lower) (Q2R upper) /\ 0 <= Q2R lower /\ Q2R upper <= 1 /\
      (Q2R lower = 0 /\ Q2R upper = 0 \/
       Q2R lower < Q2R upper /\ no_contact_until q s (Q2R lower))
  end.
