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

Definition positive_until (q : query) (b : R) : Prop := forall t, 0 <= t <= b -> 0 < volume q t.

Definition inverted_between (q : query) (a b : R) : Prop := exists t, a <= t <= b /\ volume q t <= 0.

(** The claims no_inversion, inversion and time_of_inversion, with an inversion in the place of a
    contact. *)
Definition holds_of_element (q : query) (c : claim) : Prop :=
  match c with
  | no_collision => positive_until q 1
  | collision => inverted_between q 0 1
  | time_of_impact lower upper =>
      inverted_between q (Q2R lower) (Q2R upper) /\ 0 <= Q2R lower /\ Q2R upper <= 1 /\
      (Q2R lower = 0 /\ Q2R upper = 0 \/ Q2R lower < Q2R upper /\ positive_until q (Q2R lower))
  end.

(** ** The checker *)

(** -det(w_0, w_1, w_2) of the corners a-b, a-c, a-d. *)
Definition volume_form (ws : list vector_form) : form :=
  match ws with
  | a :: b :: c :: _ => scale (-1) (f_dot a (f_cross b c))
  | _ => []
  end.

Definition keeps_volume (sc : scene) (a b : Q) : bool :=
  match moments [a; b] with
  | None => false
  | Some ms => is_positive bisections (volume_form (corner_forms sc ms))
  end.

(** The intervals follow one another from a to b without a gap. *)
Fixpoint keeps_volume_in_all (sc : scene) (a b : Q) (intervals : list (Q * Q)) : bool :=
  match intervals with
  | [] => false
  | (from, to) :: rest =>
      Qeq_bool from a && keeps_volume sc from to &&
      match rest with
      | [] => Qeq_bool to b
      | _ => keeps_volume_in_all sc to b rest
      end
  end.

Definition is_inverted_at (sc : scene) (a b : Q) (t : time) : bool :=
  match t with
  | at_time t =>
      Qle_bool a t && Qle_bool t b &&
      match moments [t] with
      | None => false
      | Some ms => is_not_positive_at None (volume_form (corner_forms sc ms))
      end
  | at_root lower upper g =>
      Qle_bool a lower && Qle_bool lower upper && Qle_bool upper b &&
      match moments [lower; upper] with
      | None => false
      | Some ms =>
          let g := on_interval ms g in
          changes_sign g && is_not_positive_at (Some g) (volume_form (corner_forms sc ms))
      end
  end.

Definition check_inversion (q : query) (c : claim) (intervals : list (Q * Q)) (t : option time) : bool :=
  match kind_of q, scene_of q (Separation 0 l2) with
  | vertex_face, Some sc =>
      let inverted_in (a b : Q) := match t with Some t => is_inverted_at sc a b t | None => false end in
      match c with
      | no_collision => keeps_volume_in_all sc 0 1 intervals
      | collision => inverted_in 0 1
      | time_of_impact lower upper =>
          if Qeq_bool lower 0 && Qeq_bool upper 0 then inverted_in 0 0
          else
            Qle_bool 0 lower && Qle_bool upper 1 && negb (Qle_bool upper lower) &&
            keeps_volume_in_all sc 0 lower intervals && inverted_in lower upper
      end
  | _, _ => false
  end%Q.

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

Lemma keeps_volume_sound a b t : keeps_volume sc a b = true -> Q2R a <= t <= Q2R b -> 0 <= t <= 1 ->
  0 < volume q t.
Proof.
  unfold keeps_volume. destruct (moments [a; b]) as [ms |] eqn:Em; [| discriminate]. intros E Hab Ht.
  destruct (moments_of_interval _ _ _ _ Em Hab) as (u & k & Hu & Hms).
  destruct (volume_form_value ms u k t Hms Ht) as (n & Hn & V).
  pose proof (is_positive_sound _ _ u E Hu) as P. rewrite V in P.
  apply Rmult_lt_reg_l with n; [exact Hn |]. lra.
Qed.

Lemma keeps_volume_in_all_sound : forall xs a b, keeps_volume_in_all sc a b xs = true ->
  forall t, Q2R a <= t <= Q2R b -> 0 <= t <= 1 -> 0 < volume q t.
Proof.
  induction xs as [| [x y] xs IH]; intros a b E t Hab Ht; [discriminate |].
  cbn [keeps_volume_in_all] in E. rewrite !andb_true_iff in E. destruct E as ((Ex & Ek) & Er).
  apply Qeq_bool_eq, Qeq_eqR in Ex.
  destruct (Rle_dec t (Q2R y)); [apply (keeps_volume_sound x y); [exact Ek | lra | exact Ht] |].
  destruct xs as [| z xs]; [apply Qeq_bool_eq, Qeq_eqR in Er; lra |].
  apply (IH _ _ Er); lra.
Qed.

Lemma is_inverted_at_sound a b t : is_inverted_at sc a b t = true -> 0 <= Q2R a -> Q2R b <= 1 ->
  inverted_between q (Q2R a) (Q2R b).
Proof.
  assert (S : forall g ms u k t, is_moment ms u k t -> 0 <= t <= 1 -> 0 <= u <= 1 ->
    match g with None => u = 0 | Some g => hd 0%Z g <> 0%Z /\ at_u u g = 0 end ->
    is_not_positive_at g (volume_form (corner_forms sc ms)) = true -> volume q t <= 0).
  { intros g ms u k x Hms Hx Hu Hg N. destruct (volume_form_value ms u k x Hms Hx) as (n & Hn & V).
    pose proof (not_positive_at u Hu g Hg _ N) as P. rewrite V in P. nra. }
  unfold is_inverted_at. destruct t as [t | lower upper g]; intros E Ha Hb.
  - destruct (moments [t]) as [ms |] eqn:Em; [| rewrite andb_false_r in E; discriminate].
    rewrite !andb_true_iff in E. destruct E as ((Ea & Eb) & Ep).
    apply Qle_bool_iff, Qle_Rle in Ea, Eb. destruct (moments_of_time _ _ Em) as (k & Hms).
    exists (Q2R t). split; [lra |]. exact (S None ms 0 k _ Hms ltac:(lra) ltac:(lra) eq_refl Ep).
  - destruct (moments [lower; upper]) as [ms |] eqn:Em; [| rewrite andb_false_r in E; discriminate].
    rewrite !andb_true_iff in E. destruct E as (((Ea & Eab) & Eb) & Eg & Ep).
    apply Qle_bool_iff, Qle_Rle in Ea, Eb, Eab.
    destruct (changes_sign_sound _ Eg) as (H0 & u & Hu & Hr).
    destruct (moments_at_u _ _ _ u Em) as (k & Hms). eexists. split; [|
      exact (S (Some (on_interval ms g)) ms u k _ Hms ltac:(nra) Hu (conj H0 Hr) Ep)]. nra.
Qed.
End Tetrahedron.

(** Every accepted claim is true. *)
Theorem check_inversion_sound q c intervals t :
  check_inversion q c intervals t = true -> holds_of_element q c.
Proof.
  unfold check_inversion. destruct (kind_of q) eqn:K; [| discriminate].
  destruct (scene_of q (Separation 0 l2)) as [sc |] eqn:E; [| discriminate]. apply scene_of_sound in E.
  pose proof Q2R_0 as E0. pose proof Q2R_1 as E1.
  assert (C : forall a b, match t with Some t => is_inverted_at sc a b t | None => false end = true ->
    0 <= Q2R a -> Q2R b <= 1 -> inverted_between q (Q2R a) (Q2R b)).
  { intros a b Ec. destruct t; [| discriminate]. eapply is_inverted_at_sound; eassumption. }
  destruct c as [| | lower upper]; cbv zeta; intros Ec; cbn [holds_of_element].
  - intros x Hx. apply (keeps_volume_in_all_sound q sc K E _ _ _ Ec); lra.
  - rewrite <- E0, <- E1. apply (C _ _ Ec); lra.
  - destruct (Qeq_bool lower 0 && Qeq_bool upper 0) eqn:El.
    + apply andb_prop in El as [El Eu]. apply Qeq_bool_eq, Qeq_eqR in El, Eu.
      rewrite El, Eu. apply C in Ec; [| lra ..]. rewrite E0 in *. repeat split; auto; lra.
    + rewrite !andb_true_iff in Ec. destruct Ec as ((((Hl & Hu) & Hlu) & Es) & Ec).
      apply Qle_bool_iff, Qle_Rle in Hl, Hu. rewrite E0 in Hl. rewrite E1 in Hu.
      repeat split; [apply (C _ _ Ec); assumption | exact Hl | exact Hu |]. right.
      assert (Q2R lower < Q2R upper) by (apply Rnot_le_lt; intros L; apply Rle_Qle in L;
        apply Qle_bool_iff in L; rewrite L in Hlu; discriminate).
      split; [assumption |]. intros x Hx. apply (keeps_volume_in_all_sound q sc K E _ _ _ Es); lra.
Qed.

Print Assumptions check_inversion_sound.
