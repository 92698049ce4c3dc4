(** What an accepted certificate of a step says of whole faces: by the theorem of pairs (Pairs.v) no two of them without
    a common vertex touch, if no edge meets a face at the start. *)

Require Import ZArith QArith Qreals Reals List Lia Lra.
Import ListNotations.
Require FunctionalExtensionality.
Require Import Verified.Problem Verified.StepProblem Verified.Geometry Verified.Checker
  Verified.Proof Verified.Step Verified.StepProof Verified.Pairs.
Open Scope R_scope.

Lemma on_edge a b x : on_segment a b x -> is_convex_combination x [a; b].
Proof.
  intros (u & D & ->). exists [1 - u; u]. split; [reflexivity |].
  split; [repeat (apply Forall_cons; [lra |]); apply Forall_nil |]. split; [cbn; ring | cbn [combination]; by_vectors].
Qed.

Lemma on_face a b c x : on_triangle (Triple a b c) x <-> is_convex_combination x [a; b; c].
Proof.
  split.
  - intros (u & v & D & ->). exists [1 - u - v; u; v]. split; [reflexivity |].
    split; [repeat (apply Forall_cons; [lra |]); apply Forall_nil |]. split; [cbn; ring | cbn [combination]; by_vectors].
  - intros (weights & L & P & S & <-). destruct weights as [| k [| l [| m [|]]]]; try discriminate L. cbn [fold_right] in S.
    for_each. exists l, m. split; [lra |]. assert (k = 1 - l - m) as -> by lra. cbn [combination]. by_vectors.
Qed.

Section Step.
Variables (s : step) (sum : Q -> Q -> Q) (T : Q).
Hypothesis is_proved : no_contact_to s sum T.
Hypothesis one_distance : has_one_distance s.
Hypothesis proper_faces : no_face_is_a_point s.
Hypothesis free_at_start : no_edge_meets_a_face_at_start s.

Let place (v : Z) : path := position (motion_of s v).
Let edge (a b : Z) : Prop := StepProblem.is_edge s [Z.min a b; Z.max a b].
Let face (f : triple Z) : Prop := In (x_of f, y_of f, z_of f) (faces s).
Let n := norm_of (separation_of s).
Let d := Q2R (distance_of (separation_of s)).

Lemma side_is_line f a b : face f -> edge_of f a b -> In (a, b) (sides s).
Proof.
  intros Hf H. apply in_flat_map. exists (x_of f, y_of f, z_of f). split; [exact Hf |].
  destruct H as [[-> ->] | [[-> ->] | [-> ->]]]; cbn; auto.
Qed.

Lemma can_collide_here p q : StepProblem.without_common_vertex p q -> p <> [] -> q <> [] ->
  (StepProblem.is_vertex s p /\ StepProblem.is_face s q \/
   StepProblem.is_edge s p /\ StepProblem.is_edge s q /\ is_before p q) ->
  forall t, 0 <= t <= Q2R T -> ~ contact (StepProblem.query_of s p q) (separation_of s) t.
Proof.
  intros N Np Nq K t Ht. destruct one_distance as (R & D & A).
  assert (separation_of s = separation_between s sum p q) as ->
    by (unfold separation_between, distance_between; rewrite R, D; destruct (separation_of s); reflexivity).
  apply is_proved; [| exact Ht]. split; [tauto |]. split; [exact N |].
  destruct p as [| v p], q as [| w q]; try contradiction. exists v, w. unfold is_held_apart. rewrite A. cbn. tauto.
Qed.

Theorem faces_do_not_touch p q : StepProblem.is_face s p -> StepProblem.is_face s q ->
  StepProblem.without_common_vertex p q -> forall t, 0 <= t <= Q2R T -> ~ touch s p q t.
Proof.
  intros (a & b & c & -> & Hp) (a' & b' & c' & -> & Hq) N t Ht (x & y & X & Y & L).
  apply (on_face (place a t) (place b t) (place c t)) in X.
  apply (on_face (place a' t) (place b' t) (place c' t)) in Y.
  assert (In3 : forall (f : triple Z) v, In v [x_of f; y_of f; z_of f] <-> vertex_of f v)
    by (clear; intros; cbn; unfold vertex_of; intuition).
  assert (Segment : forall v w t x, on_segment (place v t) (place w t) x ->
    on_segment (place (Z.min v w) t) (place (Z.max v w) t) x).
  { clear. intros v w t x H. destruct (Z.le_ge_cases v w) as [G | G];
      [rewrite Z.min_l, Z.max_r by exact G; exact H | rewrite Z.min_r, Z.max_l by exact G].
    destruct H as (u & D & ->). exists (1 - u). split; [lra | by_vectors]. }
  refine (faces_are_apart Z place edge face _ _ n d (Q2R T) _ _ _ _ (Triple a b c) (Triple a' b' c') t Hp Hq _ Ht
    (ex_intro _ x (ex_intro _ y (conj X (conj Y L))))).
  - intros f v w Hf H. destruct (Z.eq_dec v w) as [E | E]; [auto | right].
    apply line_is_edge; [apply in_or_app; left; exact (side_is_line f v w Hf H) | exact E].
  - intros f Hf. exact (proper_faces _ _ _ Hf).
  - intros v s' _. unfold place, motion_of, line.
    rewrite (FunctionalExtensionality.functional_extensionality _ _ (straight_line _ _)).
    unfold continuous_at, to_vector. by_coordinates. repeat split; continuous.
  - intros v w f E Hf M (z & Z1 & Z2). apply Segment, on_edge in Z1. apply on_face in Z2.
    refine (free_at_start _ [x_of f; y_of f; z_of f] z E _ _ Z1 Z2); [exists (x_of f), (y_of f), (z_of f); auto |].
    intros u Iu Iv. apply (M u); [| apply In3, Iv]. cbn in Iu. cbn. lia.
  - intros v w f t' (v' & w' & E & _ & I) Hf M Ht' (z & y' & <- & (u & u' & D & ->) & L').
    refine (can_collide_here [v] [x_of f; y_of f; z_of f] _ _ _ _ t' Ht' (ex_intro _ u (ex_intro _ u' (conj D L'))));
      try discriminate.
    + intros r [<- | []] Ir. apply M, In3, Ir.
    + left. split; [| exists (x_of f), (y_of f), (z_of f); auto]. exists v. split; [reflexivity |]. right.
      injection E as Ev Ew. destruct I as [I | I]; do 2 eexists; (split; [exact I | lia]).
  - intros v w v' w' t' E E' M Ht' (z & z' & Z1 & Z2 & L'). apply Segment in Z1, Z2.
    assert (M' : StepProblem.without_common_vertex [Z.min v w; Z.max v w] [Z.min v' w'; Z.max v' w']).
    { intros r Ir Ir'. apply (M r); cbn in *; lia. }
    destruct Z1 as (u & D & ->), Z2 as (u' & D' & ->).
    destruct (Z.lt_trichotomy (Z.max v w) (Z.max v' w')) as [G | [G | G]].
    + refine (can_collide_here _ _ M' _ _ _ t' Ht' (ex_intro _ u (ex_intro _ u' (conj (conj D D') L')))); try discriminate.
      right. repeat split; assumption.
    + apply (M' (Z.max v w)); [cbn; auto | rewrite G; cbn; auto].
    + assert (M2 : StepProblem.without_common_vertex [Z.min v' w'; Z.max v' w'] [Z.min v w; Z.max v w])
        by (intros r R1 R2; exact (M' r R2 R1)).
      rewrite length_of_opposite in L'.
      refine (can_collide_here _ _ M2 _ _ _ t' Ht' (ex_intro _ u' (ex_intro _ u (conj (conj D' D) L')))); try discriminate.
      right. repeat split; assumption.
  - intros v Hv Hv'. apply (N v); apply (In3 (Triple _ _ _)); assumption.
Qed.
End Step.

Theorem no_two_faces_of_a_step_touch s sum T h contact : check_step sum s (no_contact T) h contact = true ->
  has_one_distance s -> no_face_is_a_point s -> no_edge_meets_a_face_at_start s ->
  forall p q, StepProblem.is_face s p -> StepProblem.is_face s q -> StepProblem.without_common_vertex p q ->
  forall t, 0 <= t <= Q2R T -> ~ touch s p q t.
Proof. intros H. exact (faces_do_not_touch s sum T (proj2 (check_step_sound _ _ _ _ _ H))). Qed.

Print Assumptions no_two_faces_of_a_step_touch.
