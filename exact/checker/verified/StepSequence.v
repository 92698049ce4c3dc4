(** A sequence of steps: whether each begins where the one before it ends, and what their accepted certificates say of the
    whole motion. No two that can collide have a contact, and no two faces touch if no edge meets a face at the start of the
    first step. *)

Require Import ZArith QArith Qreals Reals List Bool Lia Lra.
Import ListNotations.
Require FunctionalExtensionality.
Require Import Verified.Problem Verified.StepProblem Verified.Geometry Verified.Checker
  Verified.Proof Verified.Step Verified.StepProof Verified.Pairs Verified.StepPairs.
Open Scope R_scope.

(** ** The checker *)

Open Scope Z_scope.
Fixpoint all_are_equal {A B} (equal : A -> B -> bool) (xs : list A) (ys : list B) : bool :=
  match xs, ys with
  | [], [] => true
  | x :: xs', y :: ys' => equal x y && all_are_equal equal xs' ys'
  | _, _ => false
  end.
Definition equal_two {A B} (f : A -> A -> bool) (g : B -> B -> bool) (p q : A * B) : bool :=
  f (fst p) (fst q) && g (snd p) (snd q).
Definition equal_numbers (x y : Q) : bool := (Qnum x =? Qnum y) && (Zpos (Qden x) =? Zpos (Qden y)).
Definition equal_points (a b : triple Q) : bool :=
  equal_numbers (x_of a) (x_of b) && equal_numbers (y_of a) (y_of b) && equal_numbers (z_of a) (z_of b).

(** True if a step begins where the one before it ends, and the same can collide in both. *)
Definition seems_followed_by (s next : step) : bool :=
  let same {A} (equal : A -> A -> bool) (list_of : step -> list A) := all_are_equal equal (list_of next) (list_of s) in
  let two := equal_two Z.eqb Z.eqb in
  all_are_equal (fun m n => equal_points (fst m) (snd n)) (vertices next) (vertices s) &&
  same (equal_two two Z.eqb) faces && same two edges && same Z.eqb StepProblem.points && same Z.eqb groups &&
  same two apart && same equal_numbers radii && same (equal_two two equal_numbers) distances.
Fixpoint seems_sequence (s : step) (later : list step) : bool :=
  match later with [] => true | next :: later' => seems_followed_by s next && seems_sequence next later' end.
Open Scope R_scope.

Lemma all_are_equal_sound {A B C} (f : A -> C) (g : B -> C) equal :
  (forall a b, equal a b = true -> f a = g b) ->
  forall xs ys, all_are_equal equal xs ys = true -> map f xs = map g ys.
Proof.
  intros S xs. induction xs as [| x xs IH]; intros [| y ys] H; try discriminate H; [reflexivity |].
  apply andb_prop in H as [H1 H2]. cbn [map]. rewrite (S _ _ H1), (IH _ H2). reflexivity.
Qed.

Definition decides {A} (equal : A -> A -> bool) : Prop := forall a b, equal a b = true -> a = b.

Lemma decides_list {A} (equal : A -> A -> bool) : decides equal -> decides (all_are_equal equal).
Proof. intros S xs ys H. rewrite <- (map_id xs), <- (map_id ys). exact (all_are_equal_sound _ _ _ S _ _ H). Qed.
Lemma decides_two {A B} (f : A -> A -> bool) (g : B -> B -> bool) : decides f -> decides g -> decides (equal_two f g).
Proof. intros F G [a b] [a' b'] [H1%F H2%G]%andb_prop. cbn in *. congruence. Qed.
Lemma decides_integers : decides Z.eqb.
Proof. intros x y. apply Z.eqb_eq. Qed.
Lemma decides_numbers : decides equal_numbers.
Proof. intros [n d] [n' d'] [H1%Z.eqb_eq H2%Z.eqb_eq]%andb_prop. cbn in *. congruence. Qed.
Lemma decides_points : decides equal_points.
Proof.
  intros [x y z] [x' y' z'] [[H1 H2]%andb_prop H3]%andb_prop. apply decides_numbers in H1, H2, H3. cbn in *. congruence.
Qed.

Theorem seems_followed_by_sound s next : seems_followed_by s next = true -> is_followed_by s next.
Proof.
  unfold seems_followed_by. cbv zeta. rewrite !andb_true_iff. intros (((((((V & F) & E) & P) & G) & A) & R) & D).
  split; [exact (all_are_equal_sound fst snd _ (fun m n => decides_points (fst m) (snd n)) _ _ V) |].
  repeat split; (eapply decides_list; [| eassumption]); auto using decides_two, decides_integers, decides_numbers.
Qed.

Lemma seems_sequence_sound later : forall s, seems_sequence s later = true -> is_sequence s later.
Proof.
  induction later as [| next later IH]; intros s H; [exact I |]. apply andb_prop in H as [F H].
  split; [apply seems_followed_by_sound, F | apply IH, H].
Qed.

(** ** The motion is continuous *)

(** The next step takes a vertex where it is. *)
Lemma places_are_joined s next v : is_followed_by s next -> place_at s v 1 = place_at next v 0.
Proof.
  intros (E & _). unfold place_at, motion_of, line. rewrite !straight_line.
  assert (fst (ends_of next v) = snd (ends_of s v)) as ->
    by (unfold ends_of; rewrite <- (map_nth fst), <- (map_nth snd), E; reflexivity).
  generalize (to_vector (fst (ends_of s v))), (to_vector (snd (ends_of s v))), (to_vector (snd (ends_of next v))).
  intros. by_vectors.
Qed.

(** Two paths, each continuous, one behind the other. *)
Lemma joined_is_continuous (c : vector -> R) (p q : path) t : continuity (fun t => c (p t)) ->
  continuity (fun t => c (q t)) -> p 1 = q 0 -> continuity_pt (fun t => c (if Rle_dec t 1 then p t else q (t - 1))) t.
Proof.
  intros P Q J. set (early t := (t + 1 - Rabs (t - 1)) * / 2). set (late t := (t - 1 + Rabs (t - 1)) * / 2).
  assert ((fun t => c (if Rle_dec t 1 then p t else q (t - 1))) = (fun t => c (p (early t)) + c (q (late t)) - c (q 0)))
    as ->.
  { apply FunctionalExtensionality.functional_extensionality. intros x. unfold early, late.
    destruct (Rle_dec x 1); [rewrite Rabs_left1 by lra | rewrite Rabs_right by lra].
    - replace ((x + 1 - - (x - 1)) * / 2) with x by field. replace ((x - 1 + - (x - 1)) * / 2) with 0 by field. ring.
    - replace ((x + 1 - (x - 1)) * / 2) with 1 by field. replace ((x - 1 + (x - 1)) * / 2) with (x - 1) by field.
      rewrite J. ring. }
  assert (A : continuity_pt (fun t => Rabs (t - 1)) t)
    by (apply (continuity_pt_comp (fun t => t - 1) Rabs); [continuous | apply Rcontinuity_abs]).
  assert (continuity_pt (fun t => c (p (early t))) t)
    by (apply (continuity_pt_comp early (fun t => c (p t))); [unfold early; continuous | apply P]).
  assert (continuity_pt (fun t => c (q (late t))) t)
    by (apply (continuity_pt_comp late (fun t => c (q t))); [unfold late; continuous | apply Q]).
  continuous.
Qed.

Lemma start_of_sequence s later v : place_in s later v 0 = place_at s v 0.
Proof. destruct later; cbn [place_in]; [| destruct (Rle_dec 0 1); [| lra]]; reflexivity. Qed.

Theorem sequence_is_continuous later : forall s v t, is_sequence s later -> continuous_at t (place_in s later v).
Proof.
  induction later as [| next later IH]; intros s v t S; [apply place_is_continuous |]. destruct S as [E S].
  pose proof (fun t => place_is_continuous s v t) as P. pose proof (fun t => IH next v t S) as Q.
  pose proof (places_are_joined s next v E) as J. rewrite <- (start_of_sequence next later v) in J.
  repeat split; apply (joined_is_continuous _ (place_at s v) (place_in next later v) t); try exact J; intros x;
    first [apply (P x) | apply (Q x)].
Qed.

(** The step k is on its way from k to k+1, at both ends, too. *)
Theorem place_in_step later : forall s k r v t, is_sequence s later -> nth_error (s :: later) k = Some r ->
  INR k <= t <= INR k + 1 -> place_in s later v t = place_at r v (t - INR k).
Proof.
  induction later as [| next later IH]; intros s [| k] r v t S E Ht; cbn [nth_error] in E;
    [| destruct k; discriminate E | |]; try (injection E as <-; cbn [INR] in *; rewrite Rminus_0_r).
  - reflexivity.
  - cbn [place_in]. destruct (Rle_dec t 1); [reflexivity | lra].
  - destruct S as [F S]. pose proof (pos_INR k). rewrite S_INR in *. cbn [place_in].
    destruct (Rle_dec t 1) as [L | L].
    + assert (INR k = 0) as K by lra. rewrite K. apply (INR_eq k 0) in K. subst k. injection E as <-.
      replace t with 1 by lra. replace (1 - (0 + 1)) with 0 by ring. apply places_are_joined, F.
    + replace (t - (INR k + 1)) with (t - 1 - INR k) by ring. apply IH; [assumption .. | lra].
Qed.

(** Every time is in a step. *)
Lemma time_in_step (steps : list step) : forall t, 0 <= t <= INR (length steps) -> steps <> [] ->
  exists k r, nth_error steps k = Some r /\ INR k <= t <= INR k + 1.
Proof.
  induction steps as [| s steps IH]; intros t Ht N; [contradiction |]. destruct (Rle_dec t 1) as [L | L].
  - exists O, s. cbn [nth_error INR]. split; [reflexivity | lra].
  - cbn [length] in Ht. rewrite S_INR in Ht. destruct (IH (t - 1)) as (k & r & E & K); [lra | intros ->; cbn in Ht; lra |].
    exists (S k), r. rewrite S_INR. split; [exact E | lra].
Qed.

(** ** The theorems *)

(** All steps are the same but for vertices and separation. *)
Lemma same_in_all later : forall s r, is_sequence s later -> In r (s :: later) -> exists vs d,
  r = Step vs (faces s) (edges s) (StepProblem.points s) (groups s) (apart s) (radii s) (distances s) d.
Proof.
  induction later as [| next later IH]; intros s r S [<- | I];
    try (exists (vertices s), (separation_of s); destruct s; reflexivity); [contradiction |].
  destruct S as [(_ & <- & <- & <- & <- & <- & <- & <-) S]. exact (IH next r S I).
Qed.

(** The premise of both theorems: all steps are accepted with the claim [no_contact 1], and each follows the one before. *)
Definition are_accepted (sum : Q -> Q -> Q) (s : step) (later : list step) : Prop :=
  (forall r, In r (s :: later) -> exists h contact, check_step sum r (no_contact 1) h contact = true) /\
  seems_sequence s later = true.

Theorem check_sequence_sound sum s later : are_accepted sum s later ->
  is_sequence s later /\ no_contact_in_sequence sum s later.
Proof.
  intros [A H]. apply seems_sequence_sound in H. split; [exact H |]. intros k r E t Ht p q C W.
  pose proof (nth_error_In _ _ E) as I. destruct (A r I) as (h & contact & K).
  apply check_step_sound in K as [_ K]. unfold no_contact_to in K. rewrite Q2R_1 in K.
  assert (C' : can_collide r p q) by (destruct (same_in_all later s r H I) as (vs & d & ->); exact C).
  apply (K p q C' (t - INR k)); [lra |]. apply (contact_if_within r p q _ _ C').
  unfold are_within, is_on in *. rewrite !(map_ext _ _ (fun v => eq_sym (place_in_step later s k r v t H E Ht))). exact W.
Qed.

(** No edge must meet a face at the start of the first step: of no other one. *)
Theorem no_two_faces_of_a_sequence_touch sum s later : are_accepted sum s later ->
  has_one_distance s -> (forall r, In r later -> separation_of r = separation_of s) ->
  no_face_is_a_point s -> no_edge_meets_a_face_at_start s ->
  forall p q, StepProblem.is_face s p -> StepProblem.is_face s q -> StepProblem.without_common_vertex p q ->
  forall t, 0 <= t <= INR (length (s :: later)) -> ~ are_within (separation_of s) (place_in s later) p q t.
Proof.
  intros A D O P E. apply check_sequence_sound in A as [S N]. apply (faces_do_not_touch s sum); try assumption.
  - intros p q C t Ht W. destruct (time_in_step (s :: later) t Ht) as (k & r & Er & K); [discriminate |].
    apply (N k r Er t K p q C). apply nth_error_In in Er.
    assert (separation_of r = separation_of s) as Z by (destruct Er as [<- | I]; [reflexivity | exact (O r I)]).
    destruct (same_in_all later s r S Er) as (vs & d & ->). cbn [separation_of] in Z. subst d. exact W.
  - intros v t. apply sequence_is_continuous, S.
  - intros e f x He Hf M. unfold is_on.
    rewrite !(map_ext (fun v => place_in s later v 0) _ (start_of_sequence s later)). exact (E e f x He Hf M).
Qed.

Print Assumptions check_sequence_sound.
Print Assumptions no_two_faces_of_a_sequence_touch.
