(** Inversions of tetrahedra: the statement, the checker of their certificates, and the theorem that what
    it accepts is true.

    A tetrahedron is a query of a vertex and a face, a and b c d. Its volume is that of element.hpp, times
    six. A triangle in the plane is the tetrahedron with d = b + (0,0,1). *)

Require Import ZArith QArith Qreals Reals List Lia Lra Psatz Bool.
Import ListNotations.
Require Import Verified.Problem Verified.Form Verified.Geometry Verified.Checker Verified.Proof.
Open Scope R_scope.

(** ** Claims *)

(** det(b-a, c-a, d-a). *)
Definition volume (q : query) (t : R) : R :=
  let edge := fun p => minus (position p t) (position (point0 q) t) in
  dot (edge (point1 q)) (cross (edge (point2 q)) (edge (point3 q))).

(** The claims no_inversion, inversion and time_of_inversion, with an inversion in the place of a contact. *)
Definition holds_of_element (q : query) : claim -> Prop := holds_of (fun t => volume q t <= 0).

(** ** The checker *)

(** -det(w_0, w_1, w_2) of the corners a-b, a-c, a-d. *)
Definition volume_form (ws : list vector_form) : form :=
  match ws with
  | a :: b :: c :: _ => scale (-1) (f_dot a (f_cross b c))
  | _ => []
  end.

Definition keeps_volume (sc : scene) (s : subinterval) : bool :=
  match moments [from s; to s] with
  | Some ms => is_positive bisections (volume_form (corner_forms sc ms))
  | None => false
  end.

Definition is_inverted (sc : scene) (_ : place) (g : option form) (ms : interval) : bool :=
  is_not_positive_at g (volume_form (corner_forms sc ms)).

Definition check_inversion (q : query) (c : claim) (subintervals : list subinterval)
    (inversion : option contact_proof) : bool :=
  match kind_of q, scene_of q (Separation 0 l2) with
  | vertex_face, Some sc => check_claim (keeps_volume sc) (is_inverted sc) c subintervals inversion
  | _, _ => false
  end.

(** ** The proof *)

Section Tetrahedron.
Variables (q : query) (sc : scene).
Hypothesis Hkind : kind_of q = vertex_face.
Hypothesis Hsc : is_scene_of sc q (Separation 0 l2).

(** The form is the volume, enlarged. *)
Lemma volume_form_value ms u k t : is_moment ms u k t -> 0 <= t <= 1 ->
  exists n, 0 < n /\ at_u u (volume_form (corner_forms sc ms)) = n * volume q t.
Proof.
  intros Hms Ht. pose proof (corner_values q _ sc ms u k t Hsc Hms Ht) as V.
  pose proof (size_positive q _ sc ms u k t Hsc Hms Ht) as P. cbv zeta in V, P.
  set (n := k ^ pred (length (reach sc)) * at_u t (factor sc)) in *. unfold corners in V. rewrite Hkind in V. cbn [map] in V.
  destruct (corner_forms sc ms) as [| a [| b [| c [| ? ?]]]]; cbn [map] in V; try discriminate.
  pose proof (f_equal (fun ws => nth 0 ws origin) V) as Va. pose proof (f_equal (fun ws => nth 1 ws origin) V) as Vb.
  pose proof (f_equal (fun ws => nth 2 ws origin) V) as Vc. cbn [nth] in Va, Vb, Vc. exists (n * n * n).
  split; [apply Rmult_lt_0_compat; [apply Rmult_lt_0_compat |]; exact P |].
  unfold volume_form. rewrite at_u_scale, at_dot, at_cross, Va, Vb, Vc. unfold volume. cbv zeta.
  generalize (position (point0 q) t) (position (point1 q) t) (position (point2 q) t) (position (point3 q) t).
  clear. intros. by_components. ring.
Qed.

Lemma keeps_volume_sound x t : keeps_volume sc x = true -> Q2R (from x) <= t <= Q2R (to x) -> 0 <= t <= 1 ->
  ~ volume q t <= 0.
Proof.
  unfold keeps_volume. destruct (moments [from x; to x]) as [ms |] eqn:Em; [| discriminate]. intros E Hx Ht.
  destruct (moments_of_interval _ _ _ _ Em Hx) as (u & k & Hu & Hms).
  destruct (volume_form_value ms u k t Hms Ht) as (n & Hn & V).
  pose proof (is_positive_sound _ _ u E Hu) as P. rewrite V in P. nra.
Qed.

Lemma is_inverted_sound p g ms u k t : is_moment ms u k t -> 0 <= t <= 1 -> 0 <= u <= 1 -> is_time_of g u ->
  is_inverted sc p g ms = true -> volume q t <= 0.
Proof.
  intros Hms Ht Hu Hg N. destruct (volume_form_value ms u k t Hms Ht) as (n & Hn & V).
  pose proof (not_positive_at u Hu g Hg _ N) as P. rewrite V in P. nra.
Qed.
End Tetrahedron.

(** Every accepted claim is true. *)
Theorem check_inversion_sound q c subintervals inversion :
  check_inversion q c subintervals inversion = true -> holds_of_element q c.
Proof.
  unfold check_inversion. destruct (kind_of q) eqn:K; [| discriminate].
  destruct (scene_of q (Separation 0 l2)) as [sc |] eqn:E; [| discriminate]. apply scene_of_sound in E.
  apply check_claim_sound; [exact (keeps_volume_sound q sc K E) | exact (is_inverted_sound q sc K E)].
Qed.

Print Assumptions check_inversion_sound.
