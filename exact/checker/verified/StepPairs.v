(** What an accepted certificate of a step says of whole faces: by the theorem of pairs (Pairs.v) no two of them without
    a common vertex touch, if no edge meets a face at the start. *)

Require Import ZArith QArith Qreals Reals List Lia Lra.
Import ListNotations.
Require FunctionalExtensionality.
Require Import Verified.Problem Verified.StepProblem Verified.Geometry Verified.Checker
  Verified.Proof Verified.Step Verified.StepProof Verified.Pairs.
Open Scope R_scope.

Ltac by_weights l := exists l; split; [reflexivity |]; split; [repeat (apply Forall_cons; [lra |]); apply Forall_nil |];
  split; [cbn; ring | cbn [combination]; by_vectors].

Lemma on_vertex a x : a = x <-> is_convex_combination x [a].
Proof.
  split; [intros ->; by_weights [1] |]. intros ([| k [|]] & L & _ & S & <-); try discriminate L. cbn [fold_right] in S.
  assert (k = 1) as -> by lra. cbn [combination]. by_vectors.
Qed.

Lemma on_edge a b x : on_segment a b x <-> is_convex_combination x [a; b].
Proof.
  split; [intros (u & D & ->); by_weights [1 - u; u] |].
  intros ([| k [| l [|]]] & L & P & S & <-); try discriminate L. cbn [fold_right] in S. for_each.
  exists l. split; [lra |]. assert (k = 1 - l) as -> by lra. cbn [combination]. by_vectors.
Qed.

Lemma on_face a b c x : on_triangle (Triple a b c) x <-> is_convex_combination x [a; b; c].
Proof.
  split; [intros (u & v & D & ->); by_weights [1 - u - v; u; v] |].
  intros ([| k [| l [| m [|]]]] & L & P & S & <-); try discriminate L. cbn [fold_right] in S. for_each.
  exists l, m. split; [lra |]. assert (k = 1 - l - m) as -> by lra. cbn [combination]. by_vectors.
Qed.

(** Two that can collide and are within the distance have a contact. *)
Lemma contact_if_within s p q d t : can_collide s p q -> are_within d (place_at s) p q t ->
  contact (StepProblem.query_of s p q) d t.
Proof.
  intros ([[(v & -> & _) (a & b & c & -> & _)] | [[(a & b & -> & _) [(a' & b' & -> & _) _]] |
    [[[(v & -> & _) _] [(a & b & -> & _) _]] | [[(v & -> & _) _] [[(w & -> & _) _] _]]]]] & _) (x & y & X & Y & L);
    unfold is_on in X, Y; cbn [map] in X, Y; try apply on_vertex in X as <-.
  1: apply on_face in Y as (u & u' & D & ->).
  2: apply on_edge in X as (u & D & ->), Y as (u' & D' & ->).
  3: apply on_edge, (segment_is_in_face (Triple (place_at s a t) (place_at s b t) (place_at s a t))) in Y
    as (u & u' & D & ->); [| unfold vertex_of; cbn; auto ..].
  4: apply on_vertex in Y as <-; set (w' := place_at s w t) in *; destruct (segment_is_in_face (Triple w' w' w') w' w' w'
    (or_introl eq_refl) (or_introl eq_refl) (start_of_segment w' w')) as (u & u' & D & E); rewrite E in L.
  all: exists u, u'; split; [first [exact D | exact (conj D D')] | exact L].
Qed.

(** Vertices on any continuous paths: those of one step, or of a sequence of steps. *)
Section Paths.
Variables (s : step) (sum : Q -> Q -> Q) (place : Z -> path) (T : R).
Hypothesis are_apart : forall p q, can_collide s p q -> forall t, 0 <= t <= T ->
  ~ are_within (separation_between s sum p q) place p q t.
Hypothesis places_are_continuous : forall v t, continuous_at t (place v).
Hypothesis one_distance : has_one_distance s.
Hypothesis proper_faces : no_face_is_a_point s.
Hypothesis free_at_start : forall e f x, StepProblem.is_edge s e -> StepProblem.is_face s f ->
  StepProblem.without_common_vertex e f -> is_on place e 0 x -> ~ is_on place f 0 x.

Let edge (a b : Z) : Prop := StepProblem.is_edge s [Z.min a b; Z.max a b].
Let face (f : triple Z) : Prop := In (x_of f, y_of f, z_of f) (faces s).

Lemma side_is_line f a b : face f -> edge_of f a b -> In (a, b) (sides s).
Proof.
  intros Hf H. apply in_flat_map. exists (x_of f, y_of f, z_of f). split; [exact Hf |].
  destruct H as [[-> ->] | [[-> ->] | [-> ->]]]; cbn; auto.
Qed.

Lemma are_apart_here p q : StepProblem.without_common_vertex p q -> p <> [] -> q <> [] ->
  (StepProblem.is_vertex s p /\ StepProblem.is_face s q \/
   StepProblem.is_edge s p /\ StepProblem.is_edge s q /\ is_before p q) ->
  forall t, 0 <= t <= T -> ~ are_within (separation_of s) place p q t.
Proof.
  intros N Np Nq K. destruct one_distance as (R & D & A).
  assert (separation_of s = separation_between s sum p q) as ->
    by (unfold separation_between, distance_between; rewrite R, D; destruct (separation_of s); reflexivity).
  apply are_apart. split; [tauto |]. split; [exact N |].
  destruct p as [| v p], q as [| w q]; try contradiction. exists v, w. unfold is_held_apart. rewrite A. cbn. tauto.
Qed.

Theorem faces_do_not_touch p q : StepProblem.is_face s p -> StepProblem.is_face s q ->
  StepProblem.without_common_vertex p q -> forall t, 0 <= t <= T -> ~ are_within (separation_of s) place p q t.
Proof.
  intros (a & b & c & -> & Hp) (a' & b' & c' & -> & Hq) N t Ht (x & y & X & Y & L). apply on_face in X, Y.
  assert (In3 : forall (f : triple Z) v, In v [x_of f; y_of f; z_of f] <-> vertex_of f v)
    by (clear; intros; cbn; unfold vertex_of; intuition).
  assert (Segment : forall v w t x, on_segment (place v t) (place w t) x -> is_on place [Z.min v w; Z.max v w] t x).
  { clear. intros v w t x H. apply on_edge. destruct (Z.le_ge_cases v w) as [G | G];
      [rewrite Z.min_l, Z.max_r by exact G; exact H | rewrite Z.min_r, Z.max_l by exact G].
    destruct H as (u & D & ->). exists (1 - u). split; [lra | by_vectors]. }
  assert (Face : forall f, face f -> StepProblem.is_face s [x_of f; y_of f; z_of f])
    by (intros f Hf; exists (x_of f), (y_of f), (z_of f); auto).
  refine (faces_are_apart Z place edge face _ _ (norm_of (separation_of s)) (Q2R (distance_of (separation_of s))) T
    _ _ _ _ (Triple a b c) (Triple a' b' c') t Hp Hq _ Ht (ex_intro _ x (ex_intro _ y (conj X (conj Y L))))).
  - intros f v w Hf H. destruct (Z.eq_dec v w) as [E | E]; [auto | right].
    apply line_is_edge; [apply in_or_app; left; exact (side_is_line f v w Hf H) | exact E].
  - intros f Hf. exact (proper_faces _ _ _ Hf).
  - intros v t' _. apply places_are_continuous.
  - intros v w f E Hf M (z & Z1 & Z2). apply Segment in Z1. apply on_face in Z2.
    refine (free_at_start _ _ z E (Face f Hf) _ Z1 Z2).
    intros u Iu Iv. apply (M u); [| apply In3, Iv]. cbn in Iu. cbn. lia.
  - intros v w f t' (v' & w' & E & _ & I) Hf M Ht' (z & y' & Z1 & Z2 & L'). apply on_vertex in Z1. apply on_face in Z2.
    refine (are_apart_here [v] [x_of f; y_of f; z_of f] _ _ _ _ t' Ht'
      (ex_intro _ z (ex_intro _ y' (conj Z1 (conj Z2 L'))))); try discriminate.
    + intros r [<- | []] Ir. apply M, In3, Ir.
    + left. split; [| exact (Face f Hf)]. exists v. split; [reflexivity |]. right.
      injection E as Ev Ew. destruct I as [I | I]; do 2 eexists; (split; [exact I | lia]).
  - intros v w v' w' t' E E' M Ht' (z & z' & Z1 & Z2 & L'). apply Segment in Z1, Z2.
    assert (M' : StepProblem.without_common_vertex [Z.min v w; Z.max v w] [Z.min v' w'; Z.max v' w']).
    { intros r Ir Ir'. apply (M r); cbn in *; lia. }
    destruct (Z.lt_trichotomy (Z.max v w) (Z.max v' w')) as [G | [G | G]].
    + refine (are_apart_here _ _ M' _ _ _ t' Ht' (ex_intro _ z (ex_intro _ z' (conj Z1 (conj Z2 L'))))); try discriminate.
      right. repeat split; assumption.
    + apply (M' (Z.max v w)); [cbn; auto | rewrite G; cbn; auto].
    + assert (M2 : StepProblem.without_common_vertex [Z.min v' w'; Z.max v' w'] [Z.min v w; Z.max v w])
        by (intros r R1 R2; exact (M' r R2 R1)).
      rewrite length_of_opposite in L'.
      refine (are_apart_here _ _ M2 _ _ _ t' Ht' (ex_intro _ z' (ex_intro _ z (conj Z2 (conj Z1 L'))))); try discriminate.
      right. repeat split; assumption.
  - intros v Hv Hv'. apply (N v); apply (In3 (Triple _ _ _)); assumption.
Qed.
End Paths.

Lemma place_is_continuous s v t : continuous_at t (place_at s v).
Proof.
  unfold place_at, motion_of, line. rewrite (FunctionalExtensionality.functional_extensionality _ _ (straight_line _ _)).
  unfold continuous_at, to_vector. by_coordinates. repeat split; continuous.
Qed.

Theorem no_two_faces_of_a_step_touch s sum T h contact : check_step sum s (no_contact T) h contact = true ->
  has_one_distance s -> no_face_is_a_point s -> no_edge_meets_a_face_at_start s ->
  forall p q, StepProblem.is_face s p -> StepProblem.is_face s q -> StepProblem.without_common_vertex p q ->
  forall t, 0 <= t <= Q2R T -> ~ touch s p q t.
Proof.
  intros H. destruct (check_step_sound _ _ _ _ _ H) as [_ K]. apply (faces_do_not_touch s sum (place_at s)).
  - intros p q C t Ht W. exact (K p q C t Ht (contact_if_within s p q _ t C W)).
  - apply place_is_continuous.
Qed.
Print Assumptions no_two_faces_of_a_step_touch.
