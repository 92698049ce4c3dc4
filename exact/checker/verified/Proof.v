(** The proof that what the checker accepts is true. *)

Require Import ZArith QArith Qreals Reals List Lia Lra Psatz Bool.
Import ListNotations.
Require Import Verified.Problem Verified.Form Verified.Geometry Verified.Checker.
Open Scope R_scope.

(** ** Vectors of forms are vectors, at every u *)

Definition vector_at (u : R) (a : vector_form) : vector :=
  Triple (at_u u (x_of a)) (at_u u (y_of a)) (at_u u (z_of a)).

Ltac forms := rewrite ?at_u_add, ?at_u_sub, ?at_u_mul, ?at_u_scale, ?at_u_constant.
Ltac by_forms := unfold vector_at, f_minus, f_plus, f_times, f_opposite, f_dot, f_cross, minus, plus, times, dot, cross;
  cbn [x_of y_of z_of]; try f_equal; forms; ring.

Section AtU.
Variable u : R.

Lemma at_minus a b : vector_at u (f_minus a b) = minus (vector_at u a) (vector_at u b). Proof. by_forms. Qed.
Lemma at_plus a b : vector_at u (f_plus a b) = plus (vector_at u a) (vector_at u b). Proof. by_forms. Qed.
Lemma at_times k a : vector_at u (f_times k a) = times (at_u u k) (vector_at u a). Proof. by_forms. Qed.
Lemma at_opposite a : vector_at u (f_opposite a) = times (-1) (vector_at u a). Proof. by_forms. Qed.
Lemma at_dot a b : at_u u (f_dot a b) = dot (vector_at u a) (vector_at u b). Proof. by_forms. Qed.
Lemma at_cross a b : vector_at u (f_cross a b) = cross (vector_at u a) (vector_at u b). Proof. by_forms. Qed.
Lemma at_component k a : at_u u (component k a) = component k (vector_at u a). Proof. destruct k; reflexivity. Qed.
End AtU.

(** ** Numbers *)

Lemma Q2R_0 : Q2R 0 = 0. Proof. unfold Q2R. cbn. lra. Qed.
Lemma Q2R_1 : Q2R 1 = 1. Proof. unfold Q2R. cbn. lra. Qed.

Lemma less_by_bool x y : negb (Qle_bool y x) = true -> Q2R x < Q2R y.
Proof. intros N. apply Rnot_le_lt. intros L. apply Rle_Qle, Qle_bool_iff in L. rewrite L in N. discriminate. Qed.

Lemma scaled_is_multiple m x : is_multiple m x = true -> IZR (scaled m x) = IZR m * Q2R x.
Proof.
  unfold is_multiple, scaled, Q2R. intros E. apply Z.eqb_eq in E.
  rewrite <- E at 2. rewrite !mult_IZR. field. apply not_0_IZR. lia.
Qed.

(** ** Curves *)

Lemma nth_times_each a b k : length a = length b ->
  nth k (times_each a b) 0%Z = (nth k a 0 * nth k b 0)%Z.
Proof.
  intros L. unfold times_each. change 0%Z with ((fun p : Z * Z => (fst p * snd p)%Z) (0, 0)%Z).
  rewrite map_nth, combine_nth by exact L. reflexivity.
Qed.

Lemma length_times_each a b : length a = length b -> length (times_each a b) = length a.
Proof. intros L. unfold times_each. rewrite map_length, combine_length, L. apply Nat.min_id. Qed.

(** Forms with binomials are Bernstein sums. *)
Lemma bernstein_form k t (z : list Z) (y : list R) : (length z > 0)%nat -> map IZR z = map (Rmult k) y ->
  at_u t (times_each (binomials (length z - 1)) z) = k * bernstein_sum y t.
Proof.
  intros L E. assert (Ly : length z = length y) by (rewrite <- (map_length IZR z), E; apply map_length).
  assert (Lb : length (binomials (length z - 1)) = length z)
    by (unfold binomials; rewrite elevate_length; cbn [length]; lia).
  unfold at_u, bernstein_sum. rewrite value_is_sum, length_times_each, Lb, <- Ly by exact Lb. cbv zeta.
  rewrite scal_sum. apply sum_eq. intros i Hi. rewrite nth_times_each, mult_IZR, binomials_are_C by (exact Lb || lia).
  assert (Ei : IZR (nth i z 0%Z) = k * nth i y 0).
  { rewrite <- (map_nth IZR), E. rewrite <- (map_nth (Rmult k)). rewrite Rmult_0_r. reflexivity. }
  rewrite Ei. unfold bernstein. ring.
Qed.

(** A fraction stands for a position, enlarged by m. *)
Definition is_fraction_of (p : fraction) (m : Z) (x : vector) (t : R) : Prop :=
  at_u t (denominator p) <> 0 ->
  vector_at t (numerator p) = times (IZR m * at_u t (denominator p)) x.

Lemma times_each_of_maps {A} (f g : A -> Z) l : times_each (map f l) (map g l) = map (fun x => (f x * g x)%Z) l.
Proof. induction l as [| x l IH]; [reflexivity |]. cbn [map]. rewrite <- IH. reflexivity. Qed.

Lemma times_each_associative : forall a b c, times_each (times_each a b) c = times_each a (times_each b c).
Proof.
  unfold times_each. induction a as [| x a IH]; intros [| y b] [| z c]; try reflexivity.
  cbn [combine map fst snd]. rewrite IH, Z.mul_assoc. reflexivity.
Qed.

Lemma times_each_1 : forall b a, length a = length b -> forallb (Z.eqb 1) b = true -> times_each a b = a.
Proof.
  induction b as [| y b IH]; intros [| x a] L E; try discriminate; [reflexivity |].
  cbn [forallb] in E. apply andb_prop in E as [Ey E]. apply Z.eqb_eq in Ey. subst y.
  unfold times_each in *. cbn [combine map fst snd]. rewrite IH by (auto; cbn [length] in L; lia). f_equal. lia.
Qed.

Definition coordinates_of (p : motion) : list Q :=
  flat_map (fun p => [x_of (point_of p); y_of (point_of p); z_of (point_of p)]) p.

Lemma fraction_of_sound m p t : are_weights (map weight_of p) = true ->
  forallb (is_multiple m) (coordinates_of p) = true ->
  is_fraction_of (fraction_of m p) m (position p t) t.
Proof.
  unfold are_weights, fraction_of, is_fraction_of. rewrite map_length, !andb_true_iff.
  intros ((L & _) & W) X. cbv zeta. set (k := common_multiple _) in *.
  assert (Lp : (length p > 0)%nat) by (destruct p; [discriminate | cbn [length]; lia]). clear L.
  set (ws := map (scaled k) (map weight_of p)). cbn [numerator denominator].
  assert (Lw : length ws = length p) by (unfold ws; rewrite !map_length; reflexivity).
  rewrite forallb_forall in W, X.
  assert (Sw : at_u t (times_each (binomials (length p - 1)) ws) =
    IZR k * bernstein_sum (map (fun p => Q2R (weight_of p)) p) t).
  { rewrite <- Lw. apply bernstein_form; [lia |]. unfold ws. rewrite !map_map. apply map_ext_in.
    intros c Ic. apply scaled_is_multiple, W, in_map, Ic. }
  assert (Sx : forall x : triple Q -> Q, (forall c, In c p -> is_multiple m (x (point_of c)) = true) ->
    at_u t (times_each (times_each (binomials (length p - 1)) ws) (map (fun c => scaled m (x (point_of c))) p)) =
    IZR k * IZR m * bernstein_sum (map (fun c => Q2R (weight_of c) * Q2R (x (point_of c))) p) t).
  { intros x Ix. rewrite times_each_associative. unfold ws. rewrite map_map, times_each_of_maps.
    rewrite <- (map_length (fun c => (scaled k (weight_of c) * scaled m (x (point_of c)))%Z) p) at 1.
    apply bernstein_form; [rewrite map_length; exact Lp |]. rewrite !map_map. apply map_ext_in. intros c Ic.
    rewrite mult_IZR, !scaled_is_multiple by (try apply W, in_map; auto). ring. }
  assert (Ed : at_u t (if forallb (Z.eqb 1) ws then [1%Z] else times_each (binomials (length p - 1)) ws) =
    IZR k * bernstein_sum (map (fun p => Q2R (weight_of p)) p) t).
  { rewrite <- Sw. destruct (forallb _ ws) eqn:E; [| reflexivity].
    rewrite times_each_1 by (auto; unfold binomials; rewrite elevate_length; cbn [length]; lia).
    unfold at_u, binomials. rewrite elevate_value by ring. simpl. ring. }
  rewrite Ed. intros N.
  assert (I : forall c, In c p -> forall x : triple Q -> Q, In (x (point_of c))
      [x_of (point_of c); y_of (point_of c); z_of (point_of c)] -> is_multiple m (x (point_of c)) = true).
  { intros c Ic x Ix. apply X, in_flat_map. exists c. split; assumption. }
  unfold vector_at, position, times. cbn [x_of y_of z_of].
  rewrite !Sx by (intros c Ic; apply (I c Ic); cbn [In]; auto).
  f_equal; field; intros Z; apply N; rewrite Z; ring.
Qed.

Lemma over_sound m ds p x t : is_fraction_of p m x t -> is_fraction_of (over ds p) m x t.
Proof.
  intros S. unfold over. induction (filter _ ds) as [| d rest IH]; [exact S |].
  unfold is_fraction_of in *. cbn [fold_right numerator denominator]. rewrite at_u_mul, at_times.
  intros N. rewrite IH; [clear; unfold times; cbn [x_of y_of z_of]; f_equal; ring |].
  intros Z. apply N. rewrite Z. ring.
Qed.

(** A scene stands for a query and a separation, enlarged. *)
Definition is_scene_of (sc : scene) (q : query) (s : separation) : Prop :=
  norm_in sc = norm_of s /\ 0 <= Q2R (distance_of s) /\
  (forall w, In w (corners_in sc) -> of_length (length (reach sc)) w = true) /\
  forall t, 0 <= t <= 1 -> 0 < at_u t (factor sc) /\
    at_u t (reach sc) = at_u t (factor sc) * Q2R (distance_of s) /\
    map (vector_at t) (corners_in sc) = map (times (at_u t (factor sc))) (corners q t).

Lemma at_elevated n t f : at_u t (elevated_to n f) = at_u t f.
Proof. apply elevate_value. ring. Qed.

Lemma at_even n t w : vector_at t (Triple (elevated_to n (x_of w)) (elevated_to n (y_of w))
  (elevated_to n (z_of w))) = vector_at t w.
Proof. unfold vector_at. cbn [x_of y_of z_of]. rewrite !at_elevated. reflexivity. Qed.

Lemma minus_times k a b : minus (times k a) (times k b) = times k (minus a b).
Proof. by_components. f_equal; ring. Qed.

Lemma same_denominator f g t : is_same f g = true -> at_u t f = at_u t g.
Proof.
  intros E. apply (is_zero_value _ (1 - t) t) in E. fold (at_u t (sub f g)) in E. rewrite at_u_sub in E. lra.
Qed.

Lemma scene_of_sound q s sc : scene_of q s = Some sc -> is_scene_of sc q s.
Proof.
  unfold scene_of. cbv zeta. generalize (common_multiple (distance_of s :: coordinates q)). intros m.
  destruct (_ && _ && _ && _) eqn:E; [| discriminate].
  rewrite !andb_true_iff in E. destruct E as (((Em & E) & Ew) & Ed). apply Z.ltb_lt in Em.
  rewrite !forallb_forall in E, Ew. pose proof (E _ (or_introl eq_refl)) as Es. cbn [map]. set (ds := distinct _). clearbody ds.
  assert (P : forall p, In p [point0 q; point1 q; point2 q; point3 q] ->
    forall t, is_fraction_of (over ds (fraction_of m p)) m (position p t) t).
  { intros p I t. apply over_sound, fraction_of_sound; [apply Ew, I |].
    apply forallb_forall. intros x Ix. apply E. right. apply in_flat_map. exists p. split; assumption. }
  pose proof (P (point0 q) ltac:(cbn; auto)) as P0. pose proof (P (point1 q) ltac:(cbn; auto)) as P1.
  pose proof (P (point2 q) ltac:(cbn; auto)) as P2. pose proof (P (point3 q) ltac:(cbn; auto)) as P3. clear P E Ew.
  set (p0 := over ds _) in *. set (p1 := over ds (fraction_of m (point1 q))) in *.
  set (p2 := over ds (fraction_of m (point2 q))) in *. set (p3 := over ds (fraction_of m (point3 q))) in *.
  clearbody p0 p1 p2 p3.
  destruct (_ && _ && _) eqn:E; [| discriminate]. rewrite !andb_true_iff in E. destruct E as ((Es' & Ep) & El).
  cbn [forallb] in Es'. rewrite !andb_true_iff in Es'. destruct Es' as (S1 & S2 & S3 & _).
  intros H. inversion H; subst sc; clear H. unfold is_scene_of. cbn [factor corners_in reach norm_in].
  apply Qle_bool_iff, Qle_Rle in Ed. rewrite Q2R_0 in Ed.
  split; [reflexivity |]. split; [exact Ed |]. rewrite forallb_forall in El. 
  split; [exact El |]. intros t Ht. pose proof (is_positive_sound _ _ t Ep Ht) as Hp.
  rewrite at_elevated, !at_u_scale, scaled_is_multiple by exact Es.
  split; [apply Rmult_lt_0_compat; [apply IZR_lt; exact Em | exact Hp] |]. split; [ring |].
  specialize (P0 t ltac:(lra)). specialize (P1 t). specialize (P2 t). specialize (P3 t).
  unfold is_fraction_of in P1, P2, P3. rewrite (same_denominator _ _ t S1) in P1.
  rewrite (same_denominator _ _ t S2) in P2. rewrite (same_denominator _ _ t S3) in P3.
  specialize (P1 ltac:(lra)). specialize (P2 ltac:(lra)). specialize (P3 ltac:(lra)).
  unfold corners. destruct (kind_of q); cbn [map];
    rewrite !at_even, !at_minus, ?P0, ?P1, ?P2, ?P3, !minus_times; reflexivity.
Qed.

(** An interval at u stands for the time t, enlarged by k. *)
Definition is_moment (ms : interval) (u k t : R) : Prop :=
  0 < k /\ at_u u (fst ms) = k * (1 - t) /\ at_u u (snd ms) = k * t /\
  fst ms <> [] /\ length (fst ms) = length (snd ms).

Ltac by_common_multiple ts := let m := fresh "m" in
  unfold moments; generalize (common_multiple ts); intros m; destruct (_ && _) eqn:E; [| discriminate];
  cbn [forallb] in E; rewrite !andb_true_iff in E; destruct E as (Em & E); apply Z.ltb_lt, IZR_lt in Em;
  intros H; inversion H; exists (IZR m); unfold is_moment; cbn [map fst snd];
  rewrite ?at_u_linear, ?at_u_constant, !minus_IZR, !scaled_is_multiple by tauto;
  repeat split; try exact Em; try discriminate; ring.

Lemma moments_at_u a b ms u : moments [a; b] = Some ms ->
  exists k, is_moment ms u k ((1 - u) * Q2R a + u * Q2R b).
Proof. by_common_multiple [a; b]. Qed.

Lemma moments_of_time a ms : moments [a] = Some ms -> exists k, is_moment ms 0 k (Q2R a).
Proof. by_common_multiple [a]. Qed.

Lemma moments_of_interval a b ms t : moments [a; b] = Some ms -> Q2R a <= t <= Q2R b ->
  exists u k, 0 <= u <= 1 /\ is_moment ms u k t.
Proof.
  intros E Ht.
  assert (exists u, 0 <= u <= 1 /\ t = (1 - u) * Q2R a + u * Q2R b) as (u & Hu & ->).
  { destruct (Req_dec (Q2R a) (Q2R b)) as [E' | N]; [exists 0; split; lra |].
    exists ((t - Q2R a) / (Q2R b - Q2R a)). split; [| field; lra].
    apply quotient_in_unit; lra. }
  exists u. destruct (moments_at_u a b ms u E) as (k & M). exists k. split; assumption.
Qed.

(** The time of an event is a root of the form g, or the start. *)
Definition is_time_of (g : option form) (u : R) : Prop :=
  match g with None => u = 0 | Some g => hd 0%Z g <> 0%Z /\ at_u u g = 0 end.

(** ** What a scene is at a moment *)

Section Moment.
Variables (q : query) (s : separation) (sc : scene) (ms : interval) (u k t : R).
Hypothesis Hsc : is_scene_of sc q s.
Hypothesis Hms : is_moment ms u k t.
Hypothesis Ht : 0 <= t <= 1.

Let ws := corner_forms sc ms.
Let D := reach_form sc ms.
(** The factor by which all is enlarged. *)
Let size := k ^ pred (length (reach sc)) * at_u t (factor sc).

Lemma size_positive : 0 < size.
Proof.
  destruct Hsc as (_ & _ & _ & E), Hms as (Hk & _). destruct (E t Ht) as (H & _).
  apply Rmult_lt_0_compat; [apply pow_lt; exact Hk | exact H].
Qed.

Lemma restrict_value f : length f = length (reach sc) ->
  at_u u (restrict sc ms f) = k ^ pred (length (reach sc)) * at_u t f.
Proof.
  destruct Hms as (_ & Er & Es & Hr & Hrs). unfold restrict. intros L.
  rewrite <- L, (powers_of_same_length _ _ f) by (symmetry; exact L). unfold at_u in *.
  rewrite (proj1 (substitute_value _ _ _ _ Hr Hrs f)), Er, Es.
  destruct f as [| c f]; [cbn [value]; ring | apply value_homogeneous].
Qed.

Lemma reach_value : at_u u D = size * Q2R (distance_of s).
Proof.
  destruct Hsc as (_ & _ & _ & E). destruct (E t Ht) as (_ & Er & _).
  unfold D, reach_form, size. rewrite restrict_value, Er by reflexivity. ring.
Qed.

Lemma corner_values : map (vector_at u) ws = map (times size) (corners q t).
Proof.
  destruct Hsc as (_ & _ & L & E). destruct (E t Ht) as (_ & _ & Ec).
  assert (map (times size) (corners q t) =
    map (times (k ^ pred (length (reach sc)))) (map (times (at_u t (factor sc))) (corners q t))) as ->.
  { rewrite map_map. apply map_ext. intros a. unfold size. clear. by_components. f_equal; ring. }
  rewrite <- Ec. unfold ws, corner_forms. cbv zeta. rewrite !map_map. apply map_ext_in. intros w Iw.
  specialize (L w Iw). unfold of_length in L. rewrite !andb_true_iff, !Nat.eqb_eq in L. destruct L as ((Lx & Ly) & Lz).
  unfold vector_at, times. cbn [x_of y_of z_of]. rewrite !restrict_value by assumption. reflexivity.
Qed.

Lemma form_of_corner y : In y (corners q t) -> exists w, In w ws /\ vector_at u w = times size y.
Proof.
  intros I. apply (in_map (times size)) in I. rewrite <- corner_values in I.
  apply in_map_iff in I as (w & E & Iw). eauto.
Qed.

Lemma form_is_in_hull w : In w ws -> enlarged size q t (vector_at u w).
Proof.
  intros I. apply enlarged_has_corners. rewrite <- corner_values. apply in_map. exact I.
Qed.

Lemma forms_are_polygon : is_polygon (map (vector_at u) ws).
Proof. rewrite corner_values. apply enlarged_polygon, corners_are_polygon. Qed.

Lemma polygon_of_forms a b c rest : ws = a :: b :: c :: rest ->
  is_polygon_in (enlarged size q t) (vector_at u a) (vector_at u b) (vector_at u c)
    (vector_at u (match rest with [] => c | f :: _ => f end)) (map (vector_at u) rest).
Proof.
  intros E. pose proof forms_are_polygon as P. rewrite E in P. repeat split; [apply enlarged_is_convex | exact P | |].
  - intros w I. apply (in_map_iff (vector_at u) (a :: b :: c :: rest)) in I as (y & <- & Iy).
    apply form_is_in_hull. rewrite E. exact Iy.
  - destruct rest; reflexivity.
Qed.

Lemma get_is_in_hull i : enlarged size q t (vector_at u (get ws i)).
Proof.
  apply form_is_in_hull. unfold get. pose proof forms_are_polygon as P.
  destruct ws as [| a rest]; [contradiction |].
  destruct (nth_in_or_default i (a :: rest) a) as [I | E]; [exact I |].
  cbn [hd]. rewrite E. left. reflexivity.
Qed.

(** ** Separation *)

Lemma is_zero_at_u f : is_zero f = true -> at_u u f = 0.
Proof. apply is_zero_value. Qed.

Lemma with_both_signs_sound x sums m : (exists y, In y sums /\ at_u u y = m) ->
  exists y, In y (with_both_signs D x sums) /\ at_u u y = m + at_u u D * Rabs (at_u u x).
Proof.
  intros (y & I & E). unfold with_both_signs. destruct (is_zero x) eqn:Z.
  - exists y. split; [exact I |]. rewrite (is_zero_at_u _ Z), Rabs_R0, E. ring.
  - destruct (Rle_dec 0 (at_u u x)) as [P | N].
    + exists (add y (mul D x)). split; [apply in_flat_map; exists y; cbn; auto |].
      forms. rewrite E, Rabs_right by lra. ring.
    + exists (sub y (mul D x)). split; [apply in_flat_map; exists y; cbn; auto |].
      forms. rewrite E, Rabs_left by lra. ring.
Qed.

Lemma reaches_sound d : exists y, In y (reaches D d) /\
  at_u u y = at_u u D * dual_length linf (vector_at u d).
Proof.
  unfold reaches, vector_at. cbn [dual_length x_of y_of z_of]. destruct (is_zero D) eqn:Z.
  - exists []. split; [left; reflexivity |]. rewrite (is_zero_at_u _ Z). unfold at_u. simpl. ring.
  - destruct (with_both_signs_sound (z_of d) [[]] 0) as (z & Iz & Ez);
      [exists []; split; [left; reflexivity | reflexivity] |].
    destruct (with_both_signs_sound (y_of d) _ _ (ex_intro _ z (conj Iz Ez))) as (y & Iy & Ey).
    destruct (with_both_signs_sound (x_of d) _ _ (ex_intro _ y (conj Iy Ey))) as (x & Ix & Ex).
    exists x. split; [exact Ix |]. rewrite Ex. ring.
Qed.

Hypothesis Hu : 0 <= u <= 1.

Lemma is_beyond_sound d w : is_beyond (norm_of s) D d w = true ->
  at_u u D * dual_length (norm_of s) (vector_at u d) < dot (vector_at u d) (vector_at u w).
Proof.
  unfold is_beyond. destruct (norm_of s).
  - intros E. destruct (reaches_sound d) as (y & I & V). rewrite <- V.
    rewrite forallb_forall in E. pose proof (is_positive_sound _ _ u (E _ I) Hu) as P.
    rewrite at_u_sub, at_dot in P. lra.
  - intros E. apply andb_prop in E as [E1 E2].
    pose proof (is_positive_sound _ _ u E1 Hu) as P. rewrite at_dot in P.
    apply orb_prop in E2 as [E2 | E2].
    + rewrite (is_zero_at_u _ E2). lra.
    + apply l2_separation; [exact P |].
      pose proof (is_positive_sound _ _ u E2 Hu) as P2. rewrite at_u_sub, !at_u_mul, !at_dot in P2. lra.
Qed.

Lemma checked_corners_suffice f y :
  (forall w, In w (corners_to_check ws f) -> is_beyond (norm_of s) D (direction ws f) w = true) ->
  In y (corners q t) ->
  exists w, is_beyond (norm_of s) D (direction ws f) w = true /\
    dot (vector_at u (direction ws f)) (vector_at u w) =
    dot (vector_at u (direction ws f)) (times size y).
Proof.
  intros E I. destruct (form_of_corner y I) as (w & Iw & Ew). rewrite <- Ew.
  destruct f as [i | i j | negative | c negative | c i j];
    try (exists w; split; [apply E; exact Iw | reflexivity]).
  pose proof forms_are_polygon as P.
  destruct ws as [| a [| b [| c rest]]]; cbn [map is_polygon] in P; try contradiction.
  exists a. split; [apply E; left; reflexivity |].
  pose proof (normal_is_common (map (vector_at u) (a :: b :: c :: rest)) (vector_at u a) (vector_at u b) (vector_at u c)
    (map (vector_at u) rest) P eq_refl _ (in_map (vector_at u) _ _ Iw)) as N.
  cbn [direction normal].
  assert (Ed : forall x, dot (vector_at u (with_sign negative
      (f_cross (f_minus b a) (f_minus c a)))) x =
    (if negative then -1 else 1) * dot (cross (minus (vector_at u b) (vector_at u a))
      (minus (vector_at u c) (vector_at u a))) x).
  { intros x. unfold with_sign. destruct negative; rewrite ?at_opposite, at_cross, !at_minus;
      generalize (cross (minus (vector_at u b) (vector_at u a)) (minus (vector_at u c) (vector_at u a)));
      intros; clear; by_components; ring. }
  rewrite !Ed, N. reflexivity.
Qed.

Lemma beyond_corners_no_contact f :
  forallb (is_beyond (norm_of s) D (direction ws f)) (corners_to_check ws f) = true ->
  ~ contact q s t.
Proof.
  intros E. rewrite forallb_forall in E.
  apply direction_separates with (d := vector_at u (direction ws f)). intros y Iy.
  destruct (checked_corners_suffice f y E Iy) as (w & B & Ed).
  apply is_beyond_sound in B. rewrite Ed, reach_value in B.
  apply Rmult_lt_reg_l with size; [apply size_positive |].
  replace (size * dot (vector_at u (direction ws f)) y)
    with (dot (vector_at u (direction ws f)) (times size y))
    by (generalize (vector_at u (direction ws f)); intros; clear; by_components; ring).
  lra.
Qed.

(** ** Contact *)

Variable g : option form.
Hypothesis Hg : is_time_of g u.

Definition has_sign (p : form) (sign : option comparison) : Prop :=
  match sign with
  | Some Eq => at_u u p = 0 | Some Gt => 0 < at_u u p | Some Lt => at_u u p < 0 | None => True end.

Lemma sign_on_sound n p : has_sign p (sign_on n p).
Proof.
  unfold sign_on. destruct (is_positive n p) eqn:E1; [eapply is_positive_sound; eassumption |].
  destruct (is_positive n (scale (-1) p)) eqn:E2; [| exact I].
  pose proof (is_positive_sound _ _ u E2 Hu) as P. rewrite at_u_scale in P. cbn [has_sign]. lra.
Qed.

Lemma sign_at_sound p : has_sign p (sign_at g p).
Proof.
  unfold sign_at. destruct g as [h |].
  - destruct Hg as [H0 Hr]. pose proof (sign_on_sound 0 p) as S. destruct (sign_on 0 p); [exact S |].
    destruct (divides p h p) eqn:E; [eapply divides_sound; eassumption | apply sign_on_sound].
  - unfold has_sign. rewrite Hg. assert (at_u 0 p = IZR (hd 0%Z p)) as ->.
    { unfold at_u. destruct p as [| c p]; cbn [value hd]; [reflexivity |].
      rewrite Rminus_0_r, pow1. ring. }
    destruct (Z.compare_spec (hd 0%Z p) 0) as [-> | L | L]; [reflexivity | |]; apply IZR_lt in L; exact L.
Qed.

Ltac sign_of p := pose proof (sign_at_sound p); unfold has_sign in *; destruct (sign_at g p) as [[] |]; try discriminate; lra.
Lemma zero_at p : is_zero_at g p = true -> at_u u p = 0.
Proof. unfold is_zero_at. intros. sign_of p. Qed.
Lemma positive_at p : is_positive_at g p = true -> 0 < at_u u p.
Proof. unfold is_positive_at. intros. sign_of p. Qed.
Lemma not_negative_at p : is_not_negative_at g p = true -> 0 <= at_u u p.
Proof. unfold is_not_negative_at. intros. sign_of p. Qed.
Lemma not_positive_at p : is_not_positive_at g p = true -> at_u u p <= 0.
Proof. unfold is_not_positive_at. intros. sign_of p. Qed.

Let H := enlarged size q t.

(** A point of the hull is within the distance. *)
Definition is_contact_seen : Prop := exists x, H x /\ length_of (norm_of s) x <= at_u u D.

Lemma distance_not_negative : 0 <= at_u u D.
Proof.
  rewrite reach_value. destruct Hsc as (_ & Hd & _). pose proof size_positive.
  apply Rmult_le_pos; lra.
Qed.

Lemma seen_by_square : (exists x, H x /\ dot x x <= at_u u D * at_u u D) -> is_contact_seen.
Proof.
  intros (x & Hx & L). exists x. split; [exact Hx |].
  apply length_le_of_square; [apply distance_not_negative | exact L].
Qed.

Lemma seen_by_zero : (exists x, H x /\ dot x x <= 0 * 0) -> is_contact_seen.
Proof.
  intros (x & Hx & L). apply seen_by_square. exists x. split; [exact Hx |].
  pose proof distance_not_negative. nra.
Qed.

Lemma seen_contact : is_contact_seen -> contact q s t.
Proof.
  intros (x & Hx & L). rewrite reach_value in L.
  exact (enlarged_contact size q s t x size_positive Hx L).
Qed.

Lemma triangle_sound a b c i : H (vector_at u a) -> H (vector_at u b) -> H (vector_at u c) ->
  proves_triangle g a b c i = true -> is_contact_seen.
Proof.
  intros Ha Hb Hc E. unfold proves_triangle in E. apply andb_prop in E as [Ed E].
  apply zero_at in Ed. rewrite at_dot, at_cross in Ed.
  apply seen_by_zero. exists origin. split; [| unfold dot, origin; cbn [x_of y_of z_of]; lra].
  apply (triangle_contact H _ _ _ i (enlarged_is_convex _ _ _) Ha Hb Hc Ed).
  rewrite <- !at_cross, <- !at_component, <- !at_u_add.
  set (sum := add _ _) in *. pose proof (sign_at_sound sum) as S.
  destruct (sign_at g sum) as [[] |]; try discriminate;
    apply andb_prop in E as [E E3]; apply andb_prop in E as [E1 E2]; [right | left]; (split; [exact S |]).
  - repeat split; apply not_positive_at; assumption.
  - repeat split; apply not_negative_at; assumption.
Qed.

Lemma segment_sound a b : H (vector_at u a) -> H (vector_at u b) ->
  proves_segment g a b = true -> is_contact_seen.
Proof.
  intros Ha Hb E. unfold proves_segment in E. rewrite !andb_true_iff in E.
  destruct E as (((E1 & E2) & E3) & E4). apply zero_at in E1, E2, E3. apply not_positive_at in E4.
  rewrite at_dot in E4. apply seen_by_zero.
  apply (segment_contact H _ _ (enlarged_is_convex _ _ _) Ha Hb); [| exact E4].
  rewrite <- at_cross. unfold vector_at, origin. rewrite E1, E2, E3. reflexivity.
Qed.

Lemma near_sound square base : is_near g D square base = true ->
  at_u u square <= at_u u D * at_u u D * at_u u base.
Proof. unfold is_near. intros E. apply not_negative_at in E. revert E. forms. lra. Qed.

Lemma vertex_sound a : H (vector_at u a) -> is_near g D (f_dot a a) [1%Z] = true -> is_contact_seen.
Proof.
  intros Ha E. apply near_sound in E. rewrite at_dot, at_u_constant in E.
  apply seen_by_square. exists (vector_at u a). split; [exact Ha | lra].
Qed.

Lemma edge_sound a b : H (vector_at u a) -> H (vector_at u b) ->
  proves_edge g D a b = true -> is_contact_seen.
Proof.
  intros Ha Hb E. unfold proves_edge in E. rewrite !andb_true_iff in E.
  destruct E as (((E1 & E2) & E3) & E4). apply positive_at in E1. apply not_positive_at in E2.
  apply not_negative_at in E3. apply near_sound in E4.
  rewrite !at_dot, ?at_cross, ?at_minus in *. apply seen_by_square.
  exact (edge_contact H _ _ _ (enlarged_is_convex _ _ _) Ha Hb E1 E2 E3 E4).
Qed.

Lemma inwards_sound n a b : is_inwards g n a b = true ->
  0 <= dot (vector_at u n) (cross (vector_at u a) (vector_at u b)).
Proof. intros E. apply not_negative_at in E. rewrite at_dot, at_cross in E. exact E. Qed.

Lemma face_sound : proves_face g D ws = true -> is_contact_seen.
Proof.
  pose proof polygon_of_forms as P. destruct ws as [| a [| b [| c rest]]]; try discriminate.
  specialize (P a b c rest eq_refl). intros E. unfold proves_face in E. cbv zeta in E. rewrite !andb_true_iff in E.
  destruct E as ((((E1 & E2) & E3) & E4) & E5). apply positive_at in E1. apply near_sound in E2.
  rewrite at_u_mul, !at_dot in E2. rewrite at_dot in E1. apply inwards_sound in E3, E4.
  assert (En : vector_at u (normal (a :: b :: c :: rest)) =
    cross (minus (vector_at u b) (vector_at u a)) (minus (vector_at u c) (vector_at u a))).
  { cbn [normal]. rewrite at_cross, !at_minus. reflexivity. }
  apply seen_by_square.
  apply (face_contact H (vector_at u a) (vector_at u b) (vector_at u c) (vector_at u (match rest with [] => c | f :: _ => f end))
    (map (vector_at u) rest)); rewrite <- ?En; try assumption.
  destruct rest; [exact (inwards_sound _ _ _ E5) |]. apply andb_prop in E5 as [E5 E6].
  split; apply inwards_sound; assumption.
Qed.

(** A witness in linf. *)

Lemma some_pair_sound {A} (p : A -> A -> bool) xs : some_pair p xs = true -> exists x y, p x y = true.
Proof.
  induction xs as [| x xs IH]; cbn [some_pair]; [discriminate |]. intros E.
  apply orb_prop in E as [E | E]; [| auto]. apply existsb_exists in E as (y & _ & E). eauto.
Qed.

Lemma within_bounds r y : is_within g r y = true -> - at_u u r <= at_u u y <= at_u u r.
Proof.
  intros E. apply andb_prop in E as [E1 E2]. apply not_negative_at in E1, E2. rewrite at_u_sub in E1. rewrite at_u_add in E2. lra.
Qed.

Lemma axes_sound : norm_of s = linf -> proves_axes g D ws = true -> is_contact_seen.
Proof.
  intros Hn. pose proof polygon_of_forms as P. destruct ws as [| a [| b [| c rest]]]; try discriminate.
  specialize (P a b c rest eq_refl). unfold proves_axes. cbv zeta. set (is_triangle := match rest with [] => true | _ => false end).
  set (f := match rest with [] => c | f :: _ => f end) in *. set (e := f_minus b a). set (f' := f_minus f a).
  intros E. apply some_pair_sound in E as (line & other & E).
  assert (exists n, is_witness_at g D is_triangle a e f' n = true) as (n & W) by (apply orb_prop in E as [E | E]; eauto).
  clear E. unfold is_witness_at in W. cbv zeta in W. set (x := f_plus _ _) in W. rewrite !andb_true_iff in W.
  destruct W as ((((Em & Ep) & Er) & Et) & (Ex & Ey) & Ez). apply positive_at in Em. apply not_negative_at in Ep, Er.
  apply within_bounds in Ex, Ey, Ez. rewrite at_u_mul in Ex, Ey, Ez. set (m := at_u u (z_of n)) in *.
  set (point := plus (plus (vector_at u a) (times (at_u u (x_of n) / m) (vector_at u e)))
    (times (at_u u (y_of n) / m) (vector_at u f'))).
  assert (Epoint : vector_at u x = times m point).
  { unfold x, point. rewrite !at_plus, !at_times. symmetry. apply point_of_quotients. exact Em. }
  exists point. split.
  - unfold point, e, f'. rewrite !at_minus. apply (polygon_point H _ _ (vector_at u c) _ (map (vector_at u) rest)); try assumption.
    unfold is_triangle in Et. destruct rest; cbn [map];
      [| apply andb_prop in Et as [Et Et2]; apply not_negative_at in Et2; rewrite at_u_sub in Et2];
      apply not_negative_at in Et; rewrite at_u_sub, ?at_u_add in Et; unfold m; lra.
  - rewrite (f_equal x_of Epoint : at_u u (x_of x) = m * x_of point) in Ex.
    rewrite (f_equal y_of Epoint : at_u u (y_of x) = m * y_of point) in Ey.
    rewrite (f_equal z_of Epoint : at_u u (z_of x) = m * z_of point) in Ez. rewrite Hn.
    repeat apply Rmax_lub; apply Rabs_le; split; apply Rmult_le_reg_l with m; lra.
Qed.

Theorem place_sound p : proves_place g sc D ws p = true -> contact q s t.
Proof.
  intros E. apply seen_contact. pose proof get_is_in_hull as G. fold H in G.
  destruct p as [i j l c | i j | i | i j | |]; cbn [proves_place] in E.
  - eapply triangle_sound; [apply G .. | exact E].
  - eapply segment_sound; [apply G .. | exact E].
  - eapply vertex_sound; [apply G | exact E].
  - eapply edge_sound; [apply G .. | exact E].
  - apply face_sound. exact E.
  - destruct Hsc as (Hn & _). rewrite Hn in E. apply axes_sound; destruct (norm_of s); auto; discriminate.
Qed.
End Moment.

(** ** The claims *)

Lemma separates_sound q s sc : is_scene_of sc q s -> forall x t, separates sc x = true ->
  Q2R (from x) <= t <= Q2R (to x) -> 0 <= t <= 1 -> ~ contact q s t.
Proof.
  intros Hsc x t E Hx Ht. unfold separates in E.
  destruct (moments [from x; to x]) as [ms |] eqn:Em; [| discriminate].
  destruct (moments_of_interval _ _ _ _ Em Hx) as (u & k & Hu & Hms).
  pose proof Hsc as (Hn & _). rewrite Hn in E.
  exact (beyond_corners_no_contact q s sc ms u k t Hsc Hms Ht Hu _ E).
Qed.

(** An event is a contact here, and elsewhere an inversion. *)
Section Claim.
Variables (event : R -> Prop) (is_free : subinterval -> bool) (is_event : place -> option form -> interval -> bool).
Hypothesis Hfree : forall x t, is_free x = true -> Q2R (from x) <= t <= Q2R (to x) -> 0 <= t <= 1 -> ~ event t.
Hypothesis Hevent : forall p g ms u k t, is_moment ms u k t -> 0 <= t <= 1 -> 0 <= u <= 1 -> is_time_of g u ->
  is_event p g ms = true -> event t.

Lemma all_are_free_sound : forall xs a b, all_are_free is_free a b xs = true ->
  forall t, Q2R a <= t <= Q2R b -> 0 <= t <= 1 -> ~ event t.
Proof.
  induction xs as [| x xs IH]; intros a b E t Hab Ht; [discriminate |].
  cbn [all_are_free] in E. apply andb_prop in E as [E Er]. rewrite !andb_true_iff in E.
  destruct E as ((Ea & _) & Es). apply Qeq_bool_eq, Qeq_eqR in Ea.
  destruct (Rle_dec t (Q2R (to x))) as [Hle | Hgt]; [apply (Hfree x t Es); lra |].
  destruct xs as [| y xs]; [apply Qeq_bool_eq, Qeq_eqR in Er; lra |]. apply (IH _ _ Er); lra.
Qed.

Lemma event_sound a b c : proves_event is_event a b c = true -> 0 <= Q2R a -> Q2R b <= 1 ->
  once_between event (Q2R a) (Q2R b).
Proof.
  unfold proves_event. intros E Ha Hb. destruct (time_of c) as [t | lower upper g].
  - destruct (moments [t]) as [ms |] eqn:Em; [| rewrite andb_false_r in E; discriminate].
    rewrite !andb_true_iff in E. destruct E as ((Ea & Eb) & Ep).
    apply Qle_bool_iff, Qle_Rle in Ea, Eb. destruct (moments_of_time _ _ Em) as (k & Hms).
    exists (Q2R t). split; [lra |]. exact (Hevent _ None ms 0 k _ Hms ltac:(lra) ltac:(lra) eq_refl Ep).
  - destruct (moments [lower; upper]) as [ms |] eqn:Em; [| rewrite andb_false_r in E; discriminate].
    rewrite !andb_true_iff in E. destruct E as (((Ea & Eab) & Eb) & Eg & Ep).
    apply Qle_bool_iff, Qle_Rle in Ea, Eb, Eab. destruct (changes_sign_sound _ Eg) as (H0 & u & Hu & Hr).
    destruct (moments_at_u _ _ _ u Em) as (k & Hms). eexists. split; [|
      exact (Hevent _ (Some (on_interval ms g)) ms u k _ Hms ltac:(nra) Hu (conj H0 Hr) Ep)]. nra.
Qed.

Lemma check_claim_sound c xs contact : check_claim is_free is_event c xs contact = true -> holds_of event c.
Proof.
  pose proof Q2R_0 as E0. pose proof Q2R_1 as E1. unfold check_claim. cbv zeta.
  assert (C : forall a b, match contact with Some p => proves_event is_event a b p | None => false end = true ->
    0 <= Q2R a -> Q2R b <= 1 -> once_between event (Q2R a) (Q2R b))
    by (intros a b; destruct contact; [apply event_sound | discriminate]).
  destruct c as [| | lower upper]; intros Ec; cbn [holds_of].
  - intros t Ht. apply (all_are_free_sound _ _ _ Ec); lra.
  - rewrite <- E0, <- E1. apply (C _ _ Ec); lra.
  - destruct (Qeq_bool lower 0 && Qeq_bool upper 0) eqn:El.
    + apply andb_prop in El as [El Eu]. apply Qeq_bool_eq, Qeq_eqR in El, Eu.
      rewrite El, Eu. apply C in Ec; [| lra ..]. rewrite E0 in *. repeat split; auto; lra.
    + rewrite !andb_true_iff in Ec. destruct Ec as ((((Hl & Hu) & Hlu) & Es) & Ec).
      apply Qle_bool_iff, Qle_Rle in Hl, Hu. apply less_by_bool in Hlu. rewrite E0 in Hl. rewrite E1 in Hu.
      repeat split; [apply (C _ _ Ec); assumption | exact Hl | exact Hu |]. right.
      split; [assumption |]. intros t Ht. apply (all_are_free_sound _ _ _ Es); lra.
Qed.
End Claim.

Lemma contact_sound q s sc : is_scene_of sc q s -> forall p g ms u k t, is_moment ms u k t -> 0 <= t <= 1 ->
  0 <= u <= 1 -> is_time_of g u -> is_contact sc p g ms = true -> contact q s t.
Proof. intros Hsc p g ms u k t Hms Ht Hu Hg E. exact (place_sound q s sc ms u k t Hsc Hms Ht Hu g Hg _ E). Qed.

(** Every accepted claim is true. *)
Theorem check_sound q s c subintervals contact :
  check q s c subintervals contact = true -> holds q s c.
Proof.
  unfold check. destruct (scene_of q s) as [sc |] eqn:E; [| discriminate]. apply scene_of_sound in E.
  apply check_claim_sound; [exact (separates_sound q s sc E) | exact (contact_sound q s sc E)].
Qed.

(** The case without a separation: the two primitives have a common point, F = 0. *)
Corollary contact_at_distance_0 q n t :
  contact q (Separation 0 n) t <-> exists u v, in_domain (kind_of q) u v /\ F q t u v = origin.
Proof.
  unfold contact. cbn [distance_of norm_of]. rewrite Q2R_0.
  split; intros (u & v & D & E); exists u, v; (split; [exact D | apply (length_zero n); exact E]).
Qed.

(** What is accepted is a curve: the weights are positive. *)
Corollary accepted_weights q s c subintervals contact : check q s c subintervals contact = true ->
  forall p, In p [point0 q; point1 q; point2 q; point3 q] ->
  p <> [] /\ forall b, In b p -> 0 < Q2R (weight_of b).
Proof.
  unfold check, scene_of. cbv zeta. destruct (_ && _ && _ && _) eqn:E; [| discriminate]. intros _ p Ip.
  rewrite !andb_true_iff, !forallb_forall in E. destruct E as ((_ & W) & _). specialize (W p Ip).
  unfold are_weights in W. rewrite !andb_true_iff, forallb_forall in W. destruct W as ((L & W) & _).
  split; [intros ->; discriminate |]. intros b Ib. specialize (W _ (in_map weight_of _ _ Ib)).
  rewrite <- Q2R_0. exact (less_by_bool _ _ W).
Qed.

Definition to_vector (a : triple Q) : vector := Triple (Q2R (x_of a)) (Q2R (y_of a)) (Q2R (z_of a)).

(** Straight lines are the curves of degree 1. *)
Corollary straight_line a b t :
  position (straight a b) t = plus (times (1 - t) (to_vector a)) (times t (to_vector b)).
Proof.
  unfold position, straight, bernstein_sum, bernstein, to_vector, plus, times, C.
  cbn [map length Nat.sub sum_f_R0 nth x_of y_of z_of point_of weight_of]. rewrite Q2R_1. simpl. f_equal; field; lra.
Qed.

Print Assumptions check_sound.
Print Assumptions contact_at_distance_0.
Print Assumptions accepted_weights.
Print Assumptions straight_line.
