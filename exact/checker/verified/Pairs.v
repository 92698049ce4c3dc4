(** The theorem of pairs (docs/theory.md, section 8.3): primitives without a common vertex come within a distance
    only if a vertex and a face do, or two edges. The vertices move on continuous paths.

    1. Two faces that meet do so at an edge of one of them ([faces_meet_at_an_edge]): four parameters and three
       equations leave a direction in which the two points stay equal, and along it a weight becomes 0.
    2. An edge and a face that meet, while no vertex of the one is on the other and no edges meet, have independent
       directions ([crossing]): otherwise three parameters leave such a direction, too. So they meet at all times
       nearby: the weights are continuous by Cramer's rule ([crossing_is_open]).
    3. If they do not meet, they do not at all times nearby either ([apart_is_open]): a direction keeps their vertices
       apart ([direction_or_combination]).
    4. So an edge and a face that do not meet at t=0 never do ([edge_and_face]), and neither do two faces.
    5. Faces that come within a distance meet if one of them moves by the difference, on a straight line: the case
       before, with another time ([theorem_of_pairs]).
    6. In a mesh, an edge or a face of two equal vertices and vertices without edges are cases of these
       ([theorem_of_pairs_in_a_mesh]). *)

Require Import Reals QArith Qreals List Lra Psatz.
Import ListNotations.
Require FunctionalExtensionality.
Require Import Verified.Problem Verified.Geometry Verified.Proof.
Open Scope R_scope.

(** ** What is stated *)

Definition segment_point (a b : vector) (u : R) : vector := plus (times (1 - u) a) (times u b).
Definition triangle_point (f : triple vector) (u v : R) : vector :=
  plus (plus (times (1 - u - v) (x_of f)) (times u (y_of f))) (times v (z_of f)).

Definition on_segment (a b x : vector) : Prop := exists u, 0 <= u <= 1 /\ x = segment_point a b u.
Definition on_triangle (f : triple vector) (x : vector) : Prop :=
  exists u v, (0 <= u /\ 0 <= v /\ u + v <= 1) /\ x = triangle_point f u v.

(** A face has three vertices: points or paths. Some of them may be equal: an edge is the face of its ends, one of
    them twice. *)
Definition vertex_of {A} (f : triple A) (v : A) : Prop := v = x_of f \/ v = y_of f \/ v = z_of f.
Definition edge_of {A} (f : triple A) (a b : A) : Prop :=
  (a = x_of f /\ b = y_of f) \/ (a = y_of f /\ b = z_of f) \/ (a = z_of f /\ b = x_of f).

Definition image {A B} (m : A -> B) (f : triple A) : triple B := Triple (m (x_of f)) (m (y_of f)) (m (z_of f)).

Definition path := R -> vector.
Definition at_time (f : triple path) (t : R) : triple vector := image (fun p => p t) f.

Definition continuous_at (t : R) (p : path) : Prop :=
  continuity_pt (fun t => x_of (p t)) t /\ continuity_pt (fun t => y_of (p t)) t /\
  continuity_pt (fun t => z_of (p t)) t.

(** Two sets of points have a common one; they are within a distance. *)
Definition meet (P Q : vector -> Prop) : Prop := exists x, P x /\ Q x.
Definition within (n : norm) (d : R) (P Q : vector -> Prop) : Prop :=
  exists x y, P x /\ Q y /\ length_of n (minus x y) <= d.

(** A vertex of the one and the other face are near each other, or an edge of each: these pairs are searched. *)
Definition a_pair_is (near : (vector -> Prop) -> (vector -> Prop) -> Prop) (f g : triple vector) : Prop :=
  (exists v, vertex_of f v /\ near (eq v) (on_triangle g)) \/
  (exists v, vertex_of g v /\ near (eq v) (on_triangle f)) \/
  (exists p q a b, edge_of f p q /\ edge_of g a b /\ near (on_segment p q) (on_segment a b)).

(** An edge of one has a common point with the other: what must not be at t=0. *)
Definition an_edge_meets (f g : triple vector) : Prop := exists a b,
  edge_of f a b /\ meet (on_segment a b) (on_triangle g) \/ edge_of g a b /\ meet (on_segment a b) (on_triangle f).

Ltac by_vectors := clear; unfold segment_point, triangle_point in *; by_components; f_equal; ring.

Lemma vertices_of_edge {A} (f : triple A) a b : edge_of f a b -> vertex_of f a /\ vertex_of f b.
Proof. unfold edge_of, vertex_of. tauto. Qed.

Lemma vertex_of_image {A B} (m : A -> B) f b : vertex_of (image m f) b <-> exists a, vertex_of f a /\ b = m a.
Proof.
  split; [intros [-> | [-> | ->]] | intros (a & [-> | [-> | ->]] & ->)]; unfold vertex_of, image; cbn; eauto.
Qed.

Lemma edge_of_image {A B} (m : A -> B) f c d :
  edge_of (image m f) c d <-> exists a b, edge_of f a b /\ c = m a /\ d = m b.
Proof.
  unfold edge_of, image. cbn [x_of y_of z_of]. split.
  - intros [[-> ->] | [[-> ->] | [-> ->]]]; eauto 9.
  - intros (a & b & [[-> ->] | [[-> ->] | [-> ->]]] & -> & ->); auto.
Qed.

Lemma start_of_segment a b : on_segment a b a.
Proof. exists 0. split; [lra | by_vectors]. Qed.

(** ** Directions in which two points stay equal *)

(** An end of the edge is on the face, or the edge meets one of the face's. *)
Definition edge_touches (p q : vector) (f : triple vector) : Prop :=
  on_triangle f p \/ on_triangle f q \/
  exists a b, edge_of f a b /\ meet (on_segment p q) (on_segment a b).

Ltac by_coordinates :=
  unfold segment_point, triangle_point, plus, minus, times, origin in *; cbn [x_of y_of z_of] in *.

Definition det (a b c : vector) : R := dot a (cross b c).
Definition combination_of_three (k l m : R) (a b c : vector) : vector := plus (plus (times k a) (times l b)) (times m c).

(** Cramer's rule. *)
Lemma expansion a b c x :
  combination_of_three (det x b c) (det a x c) (det a b x) a b c = times (det a b c) x.
Proof. unfold combination_of_three, det. by_vectors. Qed.

Lemma three_are_dependent a b c : det a b c = 0 ->
  exists k l m, (k <> 0 \/ l <> 0 \/ m <> 0) /\ combination_of_three k l m a b c = origin.
Proof.
  intros D. assert (N : forall x, dot x x = 0 -> x = origin) by (clear; intros; by_components; f_equal; nra).
  destruct (Req_dec (dot (cross b c) (cross b c)) 0) as [X |].
  2: { do 3 eexists. split; [left | rewrite (expansion a b c (cross b c)), D; by_vectors]. assumption. }
  apply N in X. destruct (Req_dec (dot c c) 0) as [Y |].
  - apply N in Y. subst c. exists 0, 0, 1. split; [lra | unfold combination_of_three; by_vectors].
  - exists 0, (dot c c), (- dot b c). split; [auto |].
    transitivity (cross c (cross b c)); [unfold combination_of_three; by_vectors | rewrite X; by_vectors].
Qed.

Lemma four_are_dependent a b c e :
  exists k l m n, (k <> 0 \/ l <> 0 \/ m <> 0 \/ n <> 0) /\ plus (combination_of_three k l m a b c) (times n e) = origin.
Proof.
  destruct (Req_dec (det a b c) 0) as [D | D].
  - destruct (three_are_dependent a b c D) as (k & l & m & H & E). exists k, l, m, 0.
    split; [tauto |]. rewrite E. by_vectors.
  - exists (det e b c), (det a e c), (det a b e), (- det a b c). split; [lra |]. rewrite expansion. by_vectors.
Qed.

Ltac for_each := repeat match goal with P : Forall _ (_ :: _) |- _ => inversion_clear P end; cbn [fst snd] in *.

(** Weights w ≥ 0 that change by rates r, one of them negative: the greatest step that leaves all at least 0. *)
Lemma greatest_step (l : list (R * R)) : Forall (fun p => 0 <= fst p) l -> Forall (fun p => 0 <= snd p) l \/
  exists h, 0 <= h /\ Forall (fun p => 0 <= fst p + h * snd p) l /\ Exists (fun p => fst p + h * snd p = 0) l.
Proof.
  induction l as [| [w r] l IH]; intros W; [left; constructor |]. inversion_clear W as [| ? ? Hw W']. cbn [fst] in Hw.
  set (goal := exists h, _). assert (G : r < 0 -> (forall p, In p l -> 0 <= fst p + w / - r * snd p) -> goal).
  { intros Hr C. apply Forall_forall in C. assert (w + w / - r * r = 0) by (field; lra). exists (w / - r).
    repeat split; [apply Rmult_le_pos; [| apply Rlt_le, Rinv_0_lt_compat]; lra | constructor; cbn; auto; lra | left; assumption]. }
  destruct (IH W') as [C | (h & Hh & C & Z)]; rewrite Forall_forall in W'.
  - destruct (Rle_lt_dec 0 r) as [Hr | Hr]; [left; constructor; assumption |]. right. apply G; [exact Hr |].
    rewrite Forall_forall in C. intros p I. pose proof (C p I). pose proof (W' p I).
    assert (0 <= w / - r) by (apply Rmult_le_pos; [| apply Rlt_le, Rinv_0_lt_compat]; lra). cbn beta in *. nra.
  - right. destruct (Rle_lt_dec 0 (w + h * r)) as [Hr | Hr]; [exists h; auto |].
    apply G; [nra |]. rewrite Forall_forall in C. intros p I. pose proof (C p I). pose proof (W' p I).
    assert (r < 0) by nra. assert (w / - r * - r = w) by (field; lra). assert (0 <= w / - r <= h) by nra. cbn beta in *. nra.
Qed.

(** ** Two faces that meet: an edge of one of them meets the other *)

Lemma side_of_triangle f u v : 0 <= u -> 0 <= v -> u + v <= 1 -> u = 0 \/ v = 0 \/ 1 - u - v = 0 ->
  exists a b, edge_of f a b /\ on_segment a b (triangle_point f u v).
Proof.
  intros Hu Hv Hw. unfold edge_of, on_segment. destruct f as [a b c]. by_coordinates. intros [-> | [-> | E]].
  - exists c, a. split; [tauto |]. exists (1 - v). split; [lra |]. f_equal; ring.
  - exists a, b. split; [tauto |]. exists u. split; [lra |]. f_equal; ring.
  - exists b, c. split; [tauto |]. exists v. split; [lra |]. replace u with (1 - v) by lra. f_equal; ring.
Qed.

Theorem faces_meet_at_an_edge f g : meet (on_triangle f) (on_triangle g) -> an_edge_meets f g.
Proof.
  intros (x & (u & v & (Hu & Hv & Hs) & ->) & u' & v' & (Hu' & Hv' & Hs') & E).
  destruct (four_are_dependent (minus (y_of f) (x_of f)) (minus (z_of f) (x_of f))
    (minus (x_of g) (y_of g)) (minus (x_of g) (z_of g))) as (k & l & m & n & N & D).
  destruct (greatest_step [(u, k); (v, l); (1 - u - v, - k - l); (u', m); (v', n); (1 - u' - v', - m - n)])
    as [W | (h & _ & W & Z)]; [repeat (apply Forall_cons; [cbn; lra |]); apply Forall_nil | for_each; lra |].
  - for_each. rewrite !Exists_cons, Exists_nil in Z. cbn [fst snd] in Z.
    assert (E' : triangle_point f (u + h * k) (v + h * l) = triangle_point g (u' + h * m) (v' + h * n)).
    { unfold combination_of_three in D. by_coordinates. injection E as Ex Ey Ez. injection D as Dx Dy Dz.
      f_equal; [apply (f_equal (Rmult h)) in Dx | apply (f_equal (Rmult h)) in Dy | apply (f_equal (Rmult h)) in Dz];
        lra. }
    assert (Z' : (u + h * k = 0 \/ v + h * l = 0 \/ 1 - (u + h * k) - (v + h * l) = 0) \/
      (u' + h * m = 0 \/ v' + h * n = 0 \/ 1 - (u' + h * m) - (v' + h * n) = 0)) by lra.
    destruct Z' as [Z' | Z']; [destruct (side_of_triangle f (u + h * k) (v + h * l)) as (a & b & Hab & S); try lra |
      destruct (side_of_triangle g (u' + h * m) (v' + h * n)) as (a & b & Hab & S); try lra];
      exists a, b; [left | right]; (split; [exact Hab |]); eexists; (split; [exact S |]).
    + rewrite E'. do 2 eexists. split; [| reflexivity]. lra.
    + rewrite <- E'. do 2 eexists. split; [| reflexivity]. lra.
Qed.

(** ** An edge and a face that meet and do not touch *)

Lemma touches_at_boundary p q f s u v : 0 <= s <= 1 -> 0 <= u -> 0 <= v -> u + v <= 1 ->
  segment_point p q s = triangle_point f u v -> s = 0 \/ s = 1 \/ u = 0 \/ v = 0 \/ 1 - u - v = 0 ->
  edge_touches p q f.
Proof.
  intros Hs Hu Hv Hw E B. unfold edge_touches.
  assert (T : on_triangle f (segment_point p q s)) by (rewrite E; exists u, v; repeat split; lra).
  destruct B as [-> | [-> | B]].
  - left. replace p with (segment_point p q 0); [exact T |]. by_vectors.
  - right. left. replace q with (segment_point p q 1); [exact T |]. by_vectors.
  - right. right. destruct (side_of_triangle f u v Hu Hv Hw B) as (a & b & Hab & S). exists a, b. split; [exact Hab |].
    exists (segment_point p q s). split; [exists s; auto | rewrite E; exact S].
Qed.

Lemma crossing p q f s u v : 0 <= s <= 1 -> 0 <= u -> 0 <= v -> u + v <= 1 ->
  segment_point p q s = triangle_point f u v -> ~ edge_touches p q f ->
  (0 < s /\ 0 < 1 - s /\ 0 < u /\ 0 < v /\ 0 < 1 - u - v) /\
  det (minus q p) (minus (x_of f) (y_of f)) (minus (x_of f) (z_of f)) <> 0.
Proof.
  intros Hs Hu Hv Hw E N.
  pose proof (fun B => N (touches_at_boundary p q f s u v Hs Hu Hv Hw E B)). split; [lra |]. intros D.
  destruct (three_are_dependent _ _ _ D) as (k & l & m & N' & C).
  destruct (greatest_step [(s, k); (1 - s, - k); (u, l); (v, m); (1 - u - v, - l - m)]) as [W | (h & _ & W & Z)];
    [repeat (apply Forall_cons; [cbn; lra |]); apply Forall_nil | for_each; lra |].
  for_each. rewrite !Exists_cons, Exists_nil in Z. cbn [fst snd] in Z. apply N.
  apply touches_at_boundary with (s + h * k) (u + h * l) (v + h * m); try lra.
  unfold combination_of_three in C. by_coordinates. injection E as Ex Ey Ez. injection C as Cx Cy Cz.
  f_equal; [apply (f_equal (Rmult h)) in Cx | apply (f_equal (Rmult h)) in Cy | apply (f_equal (Rmult h)) in Cz]; lra.
Qed.

(** ** A crossing is open in time *)

(** True if P is true at all times close to t. *)
Definition around (t : R) (P : R -> Prop) : Prop := exists d, 0 < d /\ forall s, Rabs (s - t) < d -> P s.

Lemma around_positive t f : continuity_pt f t -> 0 < f t -> around t (fun s => 0 < f s).
Proof.
  intros C H. destruct (C (f t) H) as (d & Hd & D). exists d. split; [exact Hd |]. intros s Hs.
  destruct (Req_dec t s) as [<- | N]; [exact H |].
  specialize (D s (conj (conj I N) Hs)). apply Rabs_def2 in D. lra.
Qed.

Lemma around_all t (fs : list (R -> R)) : Forall (fun f => continuity_pt f t /\ 0 < f t) fs ->
  around t (fun s => Forall (fun f => 0 < f s) fs).
Proof.
  induction 1 as [| f fs (C & P) _ (e & He & A)]; [exists 1; split; [lra | constructor] |].
  destruct (around_positive t f C P) as (d & Hd & B). exists (Rmin d e). split; [apply Rmin_pos; assumption |].
  intros s Hs. pose proof (Rmin_l d e). pose proof (Rmin_r d e). constructor; [apply B | apply A]; lra.
Qed.

Ltac continuous := cbv beta; repeat match goal with
  | |- _ => assumption
  | |- continuity_pt (fun t => @?f t + @?g t) _ => apply (continuity_pt_plus f g)
  | |- continuity_pt (fun t => @?f t - @?g t) _ => apply (continuity_pt_minus f g)
  | |- continuity_pt (fun t => @?f t * @?g t) _ => apply (continuity_pt_mult f g)
  | |- continuity_pt (fun t => @?f t / @?g t) _ => apply (continuity_pt_div f g)
  | |- continuity_pt (fun t => t) _ => apply derivable_continuous_pt, derivable_pt_id
  | |- continuity_pt (fun _ => _) _ => apply continuity_pt_const; intros ? ?; reflexivity
  end.

Lemma det_is_continuous t (a b c : path) : continuous_at t a -> continuous_at t b -> continuous_at t c ->
  continuity_pt (fun t => det (a t) (b t) (c t)) t.
Proof.
  intros (? & ? & ?) (? & ? & ?) (? & ? & ?). unfold det, dot, cross. cbn [x_of y_of z_of]. continuous.
Qed.

Lemma cramer a b c r : det a b c <> 0 ->
  combination_of_three (det r b c / det a b c) (det a r c / det a b c) (det a b r / det a b c) a b c = r.
Proof.
  intros D. transitivity (times (/ det a b c) (combination_of_three (det r b c) (det a r c) (det a b r) a b c)).
  - unfold combination_of_three, Rdiv. generalize (/ det a b c). intros. by_vectors.
  - rewrite expansion. clear - D. generalize dependent (det a b c). intros. by_components. f_equal; field; assumption.
Qed.

Lemma crossing_is_open (p q : path) (f : triple path) t :
  continuous_at t p -> continuous_at t q -> (forall v, vertex_of f v -> continuous_at t v) ->
  ~ edge_touches (p t) (q t) (at_time f t) -> meet (on_segment (p t) (q t)) (on_triangle (at_time f t)) ->
  around t (fun t' => meet (on_segment (p t') (q t')) (on_triangle (at_time f t'))).
Proof.
  intros Cp Cq Cf N (x & (s & Hs & ->) & u & v & (Hu & Hv & Hw) & E).
  pose proof (crossing _ _ _ s u v Hs Hu Hv Hw E N) as (Hs' & D).
  destruct f as [a b c]. unfold at_time, image in *. cbn [x_of y_of z_of] in *.
  pose proof (Cf a (or_introl eq_refl)) as (? & ? & ?). destruct Cp as (? & ? & ?), Cq as (? & ? & ?).
  pose proof (Cf b (or_intror (or_introl eq_refl))) as (? & ? & ?).
  pose proof (Cf c (or_intror (or_intror eq_refl))) as (? & ? & ?).
  pose (e1 := fun t => minus (q t) (p t)). pose (e2 := fun t => minus (a t) (b t)).
  pose (e3 := fun t => minus (a t) (c t)).
  pose (r := fun t => minus (triangle_point (Triple (a t) (b t) (c t)) u v) (segment_point (p t) (q t) s)).
  assert (continuous_at t e1 /\ continuous_at t e2 /\ continuous_at t e3 /\ continuous_at t r) as (C1 & C2 & C3 & Cr).
  { unfold continuous_at, e1, e2, e3, r. by_coordinates. repeat split; continuous. }
  pose (d := fun t => det (e1 t) (e2 t) (e3 t)). change (d t <> 0) in D.
  assert (Cd : continuity_pt d t) by (apply det_is_continuous; assumption).
  assert (W : forall w g, continuity_pt g t -> g t = 0 ->
    continuity_pt (fun t => w + g t / d t) t /\ w + g t / d t = w).
  { intros w g Cg Zg. split; [continuous; exact D | rewrite Zg; field; exact D]. }
  assert (R0 : r t = origin) by (unfold r; rewrite E; by_vectors).
  assert (O : forall a b, det origin a b = 0 /\ det a origin b = 0 /\ det a b origin = 0)
    by (clear; intros; unfold det; by_components; repeat split; ring).
  pose proof (W s _ (det_is_continuous t _ _ _ Cr C2 C3) ltac:(cbv beta; rewrite R0; apply O)) as (CS & ES).
  pose proof (W u _ (det_is_continuous t _ _ _ C1 Cr C3) ltac:(cbv beta; rewrite R0; apply O)) as (CU & EU).
  pose proof (W v _ (det_is_continuous t _ _ _ C1 C2 Cr) ltac:(cbv beta; rewrite R0; apply O)) as (CV & EV).
  pose (S := fun t => s + det (r t) (e2 t) (e3 t) / d t). pose (U := fun t => u + det (e1 t) (r t) (e3 t) / d t).
  pose (V := fun t => v + det (e1 t) (e2 t) (r t) / d t).
  change (continuity_pt S t) in CS. change (continuity_pt U t) in CU. change (continuity_pt V t) in CV.
  change (S t = s) in ES. change (U t = u) in EU. change (V t = v) in EV.
  destruct (around_all t [S; U; V; fun t => 1 - S t; fun t => 1 - U t - V t; fun t => d t * d t]) as (e & He & A).
  { repeat (apply Forall_cons; [split; [continuous | first [lra | apply Rsqr_pos_lt, D]] |]). apply Forall_nil. }
  exists e. split; [exact He |]. intros t' Ht. specialize (A t' Ht). for_each.
  exists (segment_point (p t') (q t') (S t')). split; [exists (S t'); split; [lra | reflexivity] |].
  exists (U t'), (V t'). split; [lra |].
  assert (Dt : d t' <> 0) by (intros Z; rewrite Z in *; lra).
  pose proof (cramer (e1 t') (e2 t') (e3 t') (r t') Dt) as K. clear - K. unfold S, U, V, d in *.
  set (k := det (r t') _ _ / _) in *. set (l := det _ (r t') _ / _) in *. set (m := det _ _ (r t') / _) in *.
  unfold combination_of_three, e1, e2, e3, r in K. clearbody k l m. by_coordinates. injection K as Kx Ky Kz. f_equal; lra.
Qed.

(** ** To be apart is open in time *)

Lemma small_step d w ws : (forall x, In x ws -> 0 < dot d x) ->
  exists e, 0 < e /\ forall k x, 0 < k <= e -> In x ws -> 0 < dot (plus d (times k w)) x.
Proof.
  induction ws as [| x ws IH]; intros P; [exists 1; split; [lra | intros ? ? ? []] |].
  destruct IH as (e & He & G); [intros; apply P; right; assumption |]. pose proof (P x (or_introl eq_refl)) as Px.
  pose proof (Rabs_pos (dot w x)). assert (N : - Rabs (dot w x) <= dot w x) by (split_Rabs; lra).
  set (r := Rabs (dot w x)) in *. assert (L : dot d x / (r + 1) * (r + 1) = dot d x) by (field; lra).
  assert (0 < dot d x / (r + 1)) by (apply Rdiv_lt_0_compat; lra). set (h := dot d x / (r + 1)) in *.
  exists (Rmin e h). split; [apply Rmin_pos; assumption |]. intros k y Hk [<- | I].
  - pose proof (Rmin_r e h). replace (dot (plus d (times k w)) x) with (dot d x + k * dot w x) by (clear; by_components; ring). nra.
  - pose proof (Rmin_l e h). apply G; [lra | exact I].
Qed.

Lemma combination_times c ws : forall weights,
  combination (map (Rmult c) weights) ws = times c (combination weights ws) /\
  fold_right Rplus 0 (map (Rmult c) weights) = c * fold_right Rplus 0 weights.
Proof.
  induction ws as [| w ws IH]; intros [| k weights]; cbn [combination map fold_right]; try (split; [by_vectors | ring]).
  - split; [by_vectors |]. induction weights as [| l weights IHw]; cbn [map fold_right] in *; lra.
  - destruct (IH weights) as [-> ->]. split; [by_vectors | ring].
Qed.

(** Vectors have a direction in common, or the origin is among their convex combinations: by induction, with the others
    moved along one of the vectors until they are perpendicular to the direction found. *)
Theorem direction_or_combination : forall n ws, length ws = n ->
  (exists d, forall w, In w ws -> 0 < dot d w) \/ is_convex_combination origin ws.
Proof.
  induction n as [| n IH]; intros [| w ws] L; try discriminate; [left; exists origin; intros ? [] |]. injection L as L.
  destruct (Req_dec (dot w w) 0) as [Z | Z].
  { right. exists (1 :: map (fun _ => 0) ws). assert (w = origin) as -> by (clear - Z; by_components; f_equal; nra).
    cbn [length combination fold_right]. rewrite map_length. clear. repeat split.
    - constructor; [lra |]. apply Forall_forall. intros x I. apply in_map_iff in I as (? & <- & _). lra.
    - induction ws; cbn [map fold_right]; lra.
    - assert (combination (map (fun _ => 0) ws) ws = origin) as ->; [| by_vectors].
      induction ws as [| x ws E]; cbn [map combination]; [reflexivity |]. rewrite E. by_vectors. }
  pose proof (square_nonnegative w). destruct (IH ws L) as [(d & D) | (weights & Lw & P & S & E)].
  2: { right. exists (0 :: weights). cbn [length combination fold_right]. rewrite E, S, Lw.
    repeat split; [constructor; [lra | exact P] | lra | by_vectors]. }
  destruct (Rlt_le_dec 0 (dot d w)) as [G | G]; [left; exists d; intros x [<- | I]; auto |].
  set (move := fun x => minus (times (dot d x) w) (times (dot d w) x)).
  destruct (IH (map move ws) ltac:(rewrite map_length; exact L)) as [(d' & D') | (weights & Lw & P & S & E)].
  - left. pose (d'' := minus (times (dot d' w) d) (times (dot d w) d')).
    destruct (small_step d'' w ws) as (e & He & P).
    { intros x I. specialize (D' (move x) (in_map move ws x I)). unfold d'', move in *.
      replace (dot (minus _ _) x) with (dot d' (minus (times (dot d x) w) (times (dot d w) x)))
        by (clear; by_components; ring). exact D'. }
    exists (plus d'' (times e w)). intros x [<- | I]; [| apply P; [lra | exact I]].
    replace (dot (plus d'' _) w) with (e * dot w w) by (unfold d''; clear; by_components; ring). nra.
  - right. rewrite map_length in Lw.
    assert (T : forall weights, combination weights (map move ws) =
      minus (times (dot d (combination weights ws)) w) (times (dot d w) (combination weights ws))).
    { unfold move. clear. induction ws as [| x ws IH]; intros [| k weights]; cbn [combination map]; [by_vectors .. |].
      rewrite IH. by_vectors. }
    destruct (combination_is_beyond d 0 ws D weights Lw P) as [_ B]. rewrite T in E. rewrite S in B.
    set (x := combination weights ws) in *. assert (K : 0 < dot d x - dot d w) by lra.
    exists (map (Rmult (/ (dot d x - dot d w))) (dot d x :: map (Rmult (- dot d w)) weights)).
    destruct (combination_times (/ (dot d x - dot d w)) (w :: ws) (dot d x :: map (Rmult (- dot d w)) weights)) as [-> ->].
    cbn [combination fold_right]. destruct (combination_times (- dot d w) ws weights) as [-> ->]. fold x. rewrite S.
    pose proof (Rinv_0_lt_compat _ K). repeat split.
    + cbn [length map]. rewrite !map_length, Lw. reflexivity.
    + apply Forall_forall. intros y I. apply in_map_iff in I as (z & <- & I). apply Rmult_le_pos; [lra |].
      destruct I as [<- | I]; [lra |]. apply in_map_iff in I as (k & <- & I). rewrite Forall_forall in P. specialize (P k I). nra.
    + field. lra.
    + replace (plus _ _) with (minus (times (dot d x) w) (times (dot d w) x)) by by_vectors. rewrite E. by_vectors.
Qed.

(** An edge and a face meet where the origin is a convex combination of the differences of their vertices. *)
Definition differences (p q : vector) (f : triple vector) : list vector :=
  [minus p (x_of f); minus p (y_of f); minus p (z_of f); minus q (x_of f); minus q (y_of f); minus q (z_of f)].

Lemma meet_iff p q f :
  meet (on_segment p q) (on_triangle f) <-> is_convex_combination origin (differences p q f).
Proof.
  unfold differences. destruct f as [a b c]. cbn [x_of y_of z_of]. split.
  - intros (x & (s & Hs & ->) & u & v & D & E).
    exists [(1 - s) * (1 - u - v); (1 - s) * u; (1 - s) * v; s * (1 - u - v); s * u; s * v].
    split; [reflexivity |]. split; [repeat (apply Forall_cons; [apply Rmult_le_pos; lra |]); apply Forall_nil |].
    split; [cbn [fold_right]; ring |].
    transitivity (minus (segment_point p q s) (triangle_point (Triple a b c) u v)); [cbn [combination] | rewrite E]; by_vectors.
  - intros (weights & L & P & S & E).
    destruct weights as [| k [| l [| m [| k' [| l' [| m' [|]]]]]]]; try discriminate L. cbn [fold_right] in S.
    for_each.
    exists (segment_point p q (k' + l' + m')). split; [exists (k' + l' + m'); split; [lra | reflexivity] |].
    exists (l + l'), (m + m'). split; [lra |]. assert (k = 1 - l - m - k' - l' - m') as -> by lra. clear - E.
    cbn [combination] in E. by_coordinates. injection E as Ex Ey Ez. f_equal; lra.
Qed.

Lemma apart_is_open (p q : path) (f : triple path) t :
  continuous_at t p -> continuous_at t q -> (forall v, vertex_of f v -> continuous_at t v) ->
  ~ meet (on_segment (p t) (q t)) (on_triangle (at_time f t)) ->
  around t (fun t' => ~ meet (on_segment (p t') (q t')) (on_triangle (at_time f t'))).
Proof.
  intros Cp Cq Cf N.
  destruct (direction_or_combination _ (differences (p t) (q t) (at_time f t)) eq_refl) as [(d & D) | O];
    [| destruct (N (proj2 (meet_iff _ _ _) O))].
  pose (between (x y : path) (t : R) := minus (x t) (y t)).
  pose (ws := [between p (x_of f); between p (y_of f); between p (z_of f);
    between q (x_of f); between q (y_of f); between q (z_of f)]).
  assert (Ew : forall t', differences (p t') (q t') (at_time f t') = map (fun w => w t') ws) by reflexivity.
  destruct (around_all t (map (fun w t => dot d (w t)) ws)) as (e & He & A).
  { apply Forall_map, Forall_forall. intros w I. split; [| apply D; rewrite Ew; apply (in_map (fun w => w t) ws w I)].
    destruct (Cf (x_of f) (or_introl eq_refl)) as (? & ? & ?), (Cf (y_of f) (or_intror (or_introl eq_refl))) as (? & ? & ?),
      (Cf (z_of f) (or_intror (or_intror eq_refl))) as (? & ? & ?), Cp as (? & ? & ?), Cq as (? & ? & ?).
    cbn [In ws] in I. repeat destruct I as [<- | I]; try contradiction; unfold dot, between, minus; cbn [x_of y_of z_of]; continuous. }
  exists e. split; [exact He |]. intros t' Ht M. apply meet_iff in M as (weights & L & P & S & E). rewrite Ew in L, E.
  specialize (A t' Ht). rewrite Forall_map, Forall_forall in A.
  destruct (combination_is_beyond d 0 (map (fun w => w t') ws)) with (weights := weights) as [_ B]; try assumption.
  - intros w I. apply in_map_iff in I as (v & <- & I). exact (A v I).
  - rewrite S, E in B. specialize (B ltac:(lra)). unfold dot, origin in B. cbn [x_of y_of z_of] in B. lra.
Qed.

(** ** The theorem for an edge and a face *)

Theorem edge_and_face (p q : path) (f : triple path) T :
  (forall t, 0 <= t <= T -> continuous_at t p /\ continuous_at t q /\ forall v, vertex_of f v -> continuous_at t v) ->
  ~ meet (on_segment (p 0) (q 0)) (on_triangle (at_time f 0)) ->
  (forall t, 0 <= t <= T -> ~ edge_touches (p t) (q t) (at_time f t)) ->
  forall t, 0 <= t <= T -> ~ meet (on_segment (p t) (q t)) (on_triangle (at_time f t)).
Proof.
  intros C N0 N t Ht M. pose (free x := forall s, 0 <= s <= x -> ~ meet (on_segment (p s) (q s)) (on_triangle (at_time f s))).
  destruct (completeness (fun x => 0 <= x <= t /\ free x)) as (m & U & Least).
  - exists t. intros x (? & _). lra.
  - exists 0. split; [lra |]. intros s Hs. replace s with 0 by lra. exact N0.
  - assert (Hm : 0 <= m <= t).
    { split; [| apply Least; intros x (? & _); lra]. apply U. split; [lra |]. intros s Hs. replace s with 0 by lra. exact N0. }
    destruct (C m ltac:(lra)) as (Cp & Cq & Cf).
    assert (X : ~ meet (on_segment (p m) (q m)) (on_triangle (at_time f m))).
    { intros X. destruct (crossing_is_open p q f m Cp Cq Cf (N m ltac:(lra)) X) as (d & Hd & D).
      assert (m <= m - d); [| lra]. apply Least. intros x (Hx & F). apply Rnot_lt_le. intros G.
      pose proof (U x (conj Hx F)). apply (F x ltac:(lra)), D, Rabs_def1; lra. }
    destruct (apart_is_open p q f m Cp Cq Cf X) as (d & Hd & D).
    pose proof (Rmin_l t (m + d / 2)) as Hl. pose proof (Rmin_r t (m + d / 2)) as Hr.
    set (x := Rmin t (m + d / 2)) in *. assert (F : free x).
    { intros s Hs X'. destruct (Rlt_le_dec (m - d) s) as [G | G]; [exact (D s ltac:(apply Rabs_def1; lra) X') |].
      assert (m <= s); [| lra]. apply Least. intros y (Hy & F). apply Rnot_lt_le. intros G'. exact (F s ltac:(lra) X'). }
    assert (0 <= x) by (apply Rmin_glb; lra). pose proof (U x (conj (conj H Hl) F)).
    assert (x = t) by (unfold x, Rmin in *; destruct (Rle_dec t (m + d / 2)); lra).
    apply (F t); [lra | exact M].
Qed.

(** ** The theorem for two faces *)

Definition continuous_until (T : R) (f : triple path) : Prop :=
  forall t, 0 <= t <= T -> forall v, vertex_of f v -> continuous_at t v.

Lemma edge_of_one (f g : triple path) T p q : continuous_until T f -> continuous_until T g ->
  ~ an_edge_meets (at_time f 0) (at_time g 0) ->
  (forall t, 0 <= t <= T -> ~ a_pair_is meet (at_time f t) (at_time g t)) ->
  edge_of f p q -> forall t, 0 <= t <= T -> ~ meet (on_segment (p t) (q t)) (on_triangle (at_time g t)).
Proof.
  intros Cf Cg N0 N Hpq. pose proof (vertices_of_edge _ _ _ Hpq) as V.
  assert (Et : forall t, edge_of (at_time f t) (p t) (q t)) by (intros t; apply edge_of_image; eauto).
  assert (Vt : forall t v, vertex_of f v -> vertex_of (at_time f t) (v t)) by (intros; apply vertex_of_image; eauto).
  apply edge_and_face.
  - intros t Ht. repeat split; first [apply (Cf t Ht); apply V | apply (Cg t Ht); assumption].
  - intros M. apply N0. exists (p 0), (q 0). auto.
  - intros t Ht [P | [P | (a & b & Hab & M)]]; apply (N t Ht); [left; exists (p t) | left; exists (q t) | right; right].
    + split; [apply Vt, V | exists (p t); auto].
    + split; [apply Vt, V | exists (q t); auto].
    + exists (p t), (q t), a, b. auto.
Qed.

Theorem faces_that_never_meet (f g : triple path) T : continuous_until T f -> continuous_until T g ->
  ~ an_edge_meets (at_time f 0) (at_time g 0) ->
  (forall t, 0 <= t <= T -> ~ a_pair_is meet (at_time f t) (at_time g t)) ->
  forall t, 0 <= t <= T -> ~ meet (on_triangle (at_time f t)) (on_triangle (at_time g t)).
Proof.
  intros Cf Cg N0 N t Ht M. destruct (faces_meet_at_an_edge _ _ M) as (a & b & [(Hab & E) | (Hab & E)]);
    apply edge_of_image in Hab as (p & q & Hpq & -> & ->).
  - exact (edge_of_one f g T p q Cf Cg N0 N Hpq t Ht E).
  - refine (edge_of_one g f T p q Cg Cf _ _ Hpq t Ht E).
    + intros (x & y & [X | X]); apply N0; exists x, y; auto.
    + intros s Hs [P | [P | (p' & q' & a & b & Hp & Ha & x & X & Y)]]; apply (N s Hs);
        [right; left; exact P | left; exact P | right; right]. exists a, b, p', q'. repeat split; auto. exists x. auto.
Qed.

(** ** Within a distance *)

Lemma length_of_opposite n a b : length_of n (minus a b) = length_of n (minus b a).
Proof.
  replace (minus a b) with (times (-1) (minus b a)) by by_vectors. destruct n; cbn [length_of times x_of y_of z_of].
  - rewrite !Rabs_mult, (Rabs_left (-1)) by lra. replace (- -1) with 1 by lra. rewrite !Rmult_1_l. reflexivity.
  - f_equal. clear; by_components; ring.
Qed.

Lemma within_symmetric n d P Q : within n d P Q -> within n d Q P.
Proof. intros (x & y & X & Y & L). exists y, x. rewrite length_of_opposite. auto. Qed.

Lemma within_larger n d (P Q P' Q' : vector -> Prop) : within n d P Q ->
  (forall x, P x -> P' x) -> (forall x, Q x -> Q' x) -> within n d P' Q'.
Proof. intros (x & y & X & Y & L) HP HQ. exists x, y. auto. Qed.

(** The face is moved by k c, while k grows. *)
Definition moved (f : triple vector) (c : vector) : triple path := image (fun a k => plus a (times k c)) f.

Lemma on_moved_triangle f c k x : on_triangle (at_time (moved f c) k) x <->
  exists y, on_triangle f y /\ x = plus y (times k c).
Proof.
  unfold on_triangle, at_time, moved, image. cbn [x_of y_of z_of]. split.
  - intros (u & v & D & ->). eexists. split; [exists u, v; auto |]. by_coordinates. f_equal; ring.
  - intros (y & (u & v & D & ->) & ->). exists u, v. split; [exact D |]. by_coordinates. f_equal; ring.
Qed.

Lemma segment_is_in_face f a b x : vertex_of f a -> vertex_of f b -> on_segment a b x -> on_triangle f x.
Proof.
  assert (V : forall a, vertex_of f a -> exists u v, (0 <= u /\ 0 <= v /\ u + v <= 1) /\ a = triangle_point f u v).
  { intros c [-> | [-> | ->]]; [exists 0, 0 | exists 1, 0 | exists 0, 1]; (split; [lra |]);
      destruct f as [p q r]; cbv [triangle_point x_of y_of z_of]; by_vectors. }
  intros Ha Hb (k & Hk & ->). apply V in Ha as (u & v & D & ->). apply V in Hb as (u' & v' & D' & ->).
  exists ((1 - k) * u + k * u'), ((1 - k) * v + k * v'). split; [nra |]. by_coordinates. f_equal; ring.
Qed.

Theorem theorem_of_pairs (f g : triple path) n d T : continuous_until T f -> continuous_until T g ->
  ~ an_edge_meets (at_time f 0) (at_time g 0) ->
  (forall t, 0 <= t <= T -> ~ a_pair_is (within n d) (at_time f t) (at_time g t)) ->
  forall t, 0 <= t <= T -> ~ within n d (on_triangle (at_time f t)) (on_triangle (at_time g t)).
Proof.
  intros Cf Cg N0 N t Ht (x & y & X & Y & L). pose proof (length_nonnegative n (minus x y)).
  set (c := minus x y) in *.
  assert (W : forall k a, 0 <= k <= 1 -> length_of n (minus (plus a (times k c)) a) <= d).
  { intros k a Hk. replace (minus _ a) with (times k c) by by_vectors. rewrite length_times by lra. nra. }
  assert (N' : ~ meet (on_triangle (at_time f t)) (on_triangle (at_time g t))).
  { assert (M : forall P Q : vector -> Prop, meet P Q -> within n d P Q).
    { intros P Q (z & Hp & Hq). exists z, z. repeat split; auto.
      replace (minus z z) with (minus (plus z (times 0 c)) z) by by_vectors. apply W. lra. }
    apply (faces_that_never_meet f g T Cf Cg N0); [| exact Ht]. intros s Hs P. apply (N s Hs).
    destruct P as [(v & Hv & P) | [(v & Hv & P) | (p & q & a & b & Hp & Ha & P)]];
      [left; exists v | right; left; exists v | right; right; exists p, q, a, b]; auto 6. }
  specialize (N t Ht). set (F0 := at_time f t) in *. set (G0 := at_time g t) in *. clearbody F0 G0.
  clear f g Cf Cg N0. destruct F0 as [a b e].
  refine (faces_that_never_meet (Triple (fun _ => a) (fun _ => b) (fun _ => e)) (moved G0 c) 1 _ _ _ _ 1 ltac:(lra) _).
  - intros k _ v [-> | [-> | ->]]; repeat split; continuous.
  - intros k _ v V. apply vertex_of_image in V as (w & _ & ->). clear. unfold continuous_at. by_coordinates.
    repeat split; continuous.
  - assert (Z0 : forall z, on_triangle (at_time (moved G0 c) 0) z -> on_triangle G0 z).
    { intros z Z. apply on_moved_triangle in Z as (y' & Y' & ->).
      replace (plus y' (times 0 c)) with y' by by_vectors. exact Y'. }
    intros (p & q & [(Hp & z & Z & Z') | (Hp & z & Z & Z')]); apply N'; exists z;
      destruct (vertices_of_edge _ _ _ Hp) as (Vp & Vq); apply (segment_is_in_face _ p q z Vp Vq) in Z; auto.
  - intros k Hk P. apply N.
    destruct P as [(v & Hv & z & <- & Z) | [(v & Hv & z & <- & Z) | (p & q & p' & q' & Hp & Hq & z & Z & u & D & ->)]].
    + left. exists v. split; [exact Hv |]. apply on_moved_triangle in Z as (y' & Z & ->).
      exists (plus y' (times k c)), y'. auto.
    + right. left. apply vertex_of_image in Hv as (w' & Hw & ->). apply vertex_of_image in Hw as (w & Hw & ->).
      exists w. split; [exact Hw |]. apply within_symmetric. exists (plus w (times k c)), w. auto.
    + right. right. apply edge_of_image in Hq as (p1' & q1' & Hq & -> & ->).
      apply edge_of_image in Hq as (p1 & q1 & Hq & -> & ->). exists p, q, p1, q1. repeat split; auto.
      eexists _, (segment_point p1 q1 u). repeat split; [exact Z | exists u; auto |].
      replace (segment_point _ _ u) with (plus (segment_point p1 q1 u) (times k c)) by by_vectors. auto.
  - exists x. split; [exact X |]. apply on_moved_triangle. exists y. split; [exact Y |]. subst c. by_vectors.
Qed.

(** ** The theorem for an edge and a face: the edge is a face of which two vertices are equal *)

Lemma on_face_of_edge p q x : on_triangle (Triple p q q) x <-> on_segment p q x.
Proof.
  split.
  - intros (u & v & D & ->). exists (u + v). split; [lra |]. by_coordinates. f_equal; ring.
  - intros (u & D & ->). exists u, 0. split; [lra |]. by_coordinates. f_equal; ring.
Qed.

Theorem theorem_of_pairs_with_an_edge (p q : path) (g : triple path) n d T :
  (forall t, 0 <= t <= T -> continuous_at t p /\ continuous_at t q) -> continuous_until T g ->
  ~ meet (on_segment (p 0) (q 0)) (on_triangle (at_time g 0)) ->
  (forall t, 0 <= t <= T -> ~ within n d (eq (p t)) (on_triangle (at_time g t)) /\
    ~ within n d (eq (q t)) (on_triangle (at_time g t)) /\
    forall a b, edge_of (at_time g t) a b -> ~ within n d (on_segment (p t) (q t)) (on_segment a b)) ->
  forall t, 0 <= t <= T -> ~ within n d (on_segment (p t) (q t)) (on_triangle (at_time g t)).
Proof.
  intros C Cg N0 N t Ht W. refine (theorem_of_pairs (Triple p q q) g n d T _ Cg _ _ t Ht _).
  - intros s Hs v [-> | [-> | ->]]; apply (C s Hs).
  - intros (a & b & [(Hab & x & X & Y) | (Hab & x & X & Y)]); apply vertices_of_edge in Hab as (Ha & Hb);
      apply (segment_is_in_face _ a b x Ha Hb) in X; apply N0; exists x; split; auto; apply on_face_of_edge; auto.
  - clear t Ht W. intros t Ht P. destruct (N t Ht) as (Np & Nq & Ne). set (G := at_time g t) in *.
    destruct P as [(v & [-> | [-> | ->]] & P) | [(v & Hv & P) | (a & b & a' & b' & Hab & Hab' & P)]];
      [exact (Np P) | exact (Nq P) | exact (Nq P) | |].
    + assert (exists a b, edge_of G a b /\ on_segment a b v) as (a & b & Hab & V).
      { destruct Hv as [-> | [-> | ->]]; do 2 eexists; (split; [| apply start_of_segment]); unfold edge_of; auto. }
      apply (Ne a b Hab), within_symmetric.
      refine (within_larger _ _ _ _ _ _ P _ (fun x => proj1 (on_face_of_edge _ _ x))). intros x <-. exact V.
    + apply (Ne a' b' Hab'). refine (within_larger _ _ _ _ _ _ P _ (fun x X => X)). intros x X.
      apply vertices_of_edge in Hab as (Ha & Hb). apply on_face_of_edge. exact (segment_is_in_face _ a b x Ha Hb X).
  - exact (within_larger _ _ _ _ _ _ W (fun x => proj2 (on_face_of_edge _ _ x)) (fun x X => X)).
Qed.

(** ** The theorem for a mesh *)

Section Mesh.

(** Vertices, of which some have edges, of which some are in faces. *)
Variable V : Type.
Variable place : V -> path.
Variable is_edge : V -> V -> Prop.
Variable is_face : triple V -> Prop.

Inductive primitive := a_vertex (v : V) | an_edge (a b : V) | a_face (f : triple V).

Definition in_mesh (P : primitive) : Prop :=
  match P with a_vertex _ => True | an_edge a b => is_edge a b | a_face f => is_face f end.

Definition has_vertex (P : primitive) (v : V) : Prop :=
  match P with a_vertex w => v = w | an_edge a b => v = a \/ v = b | a_face f => vertex_of f v end.

Definition points (P : primitive) (t : R) : vector -> Prop :=
  match P with
  | a_vertex v => eq (place v t)
  | an_edge a b => on_segment (place a t) (place b t)
  | a_face f => on_triangle (at_time (image place f) t)
  end.

Definition without_common_vertex (P Q : primitive) : Prop := forall v, has_vertex P v -> ~ has_vertex Q v.

(** The pairs that are searched, if they have no common vertex. *)
Definition without_edge (v : V) : Prop := forall w, ~ is_edge v w.
Definition without_face (a b : V) : Prop := forall f, is_face f -> ~ (vertex_of f a /\ vertex_of f b).
Definition is_searched (P Q : primitive) : Prop :=
  match P, Q with
  | a_vertex _, a_face _ => True
  | an_edge _ _, an_edge _ _ => True
  | a_vertex v, an_edge a b => without_edge v /\ without_face a b
  | a_vertex v, a_vertex w => without_edge v /\ without_edge w
  | _, _ => False
  end.

(** The pairs of which nothing is said: an edge leads from the vertex to the edge, or one or two to the vertex. *)
Definition is_excluded (P Q : primitive) : Prop :=
  match P, Q with
  | a_vertex v, an_edge a b | an_edge a b, a_vertex v => is_edge v a \/ is_edge v b
  | a_vertex v, a_vertex w => is_edge v w \/ exists x, is_edge v x /\ is_edge x w
  | _, _ => False
  end.

Hypothesis edges_have_no_direction : forall a b, is_edge a b -> is_edge b a.
Hypothesis faces_have_edges : forall f a b, is_face f -> edge_of f a b -> a = b \/ is_edge a b.
Hypothesis no_vertex_is_named_three_times : forall f, is_face f -> ~ (x_of f = y_of f /\ y_of f = z_of f).

Variable n : norm.
Variables d T : R.
Hypothesis places_are_continuous : forall v t, 0 <= t <= T -> continuous_at t (place v).
Hypothesis free_at_start : forall a b f, is_edge a b -> is_face f ->
  without_common_vertex (an_edge a b) (a_face f) -> ~ meet (points (an_edge a b) 0) (points (a_face f) 0).

Lemma vertex_has_edge f v : is_face f -> vertex_of f v -> exists w, is_edge v w /\ vertex_of f w.
Proof.
  intros Hf. pose proof (no_vertex_is_named_three_times f Hf) as N. pose proof (faces_have_edges f) as E.
  unfold edge_of, vertex_of in *. destruct f as [a b c]. cbn [x_of y_of z_of] in *.
  destruct (E a b Hf ltac:(auto)), (E b c Hf ltac:(auto)), (E c a Hf ltac:(auto));
    try (exfalso; apply N; split; congruence); intros [-> | [-> | ->]]; subst; eauto 6.
Qed.

(** An edge from a vertex to itself is a part of another. *)
Lemma proper_edge f t a b : is_face f -> edge_of (at_time (image place f) t) a b ->
  exists x y, is_edge x y /\ vertex_of f x /\ vertex_of f y /\
    forall c, on_segment a b c -> on_segment (place x t) (place y t) c.
Proof.
  intros Hf H. apply edge_of_image in H as (p & q & H & -> & ->). apply edge_of_image in H as (x & y & H & -> & ->).
  pose proof (vertices_of_edge _ _ _ H) as (Vx & Vy).
  destruct (faces_have_edges f x y Hf H) as [<- | E]; [| exists x, y; auto].
  destruct (vertex_has_edge f x Hf Vx) as (z & E & Vz). exists x, z. repeat split; auto.
  intros c (u & _ & ->). exists 0. split; [lra | by_vectors].
Qed.

Lemma face_is_continuous f : continuous_until T (image place f).
Proof. intros t Ht v Hv. apply vertex_of_image in Hv as (x & _ & ->). exact (places_are_continuous x t Ht). Qed.

(** Edges and faces: of the pairs that are searched these two kinds suffice. *)
Section Faces.
Hypothesis vertices_and_faces : forall v w f t, is_edge v w -> is_face f -> ~ vertex_of f v -> 0 <= t <= T ->
  ~ within n d (points (a_vertex v) t) (points (a_face f) t).
Hypothesis edges_and_edges : forall a b a' b' t, is_edge a b -> is_edge a' b' ->
  without_common_vertex (an_edge a b) (an_edge a' b') -> 0 <= t <= T ->
  ~ within n d (points (an_edge a b) t) (points (an_edge a' b') t).

Lemma edge_and_face_are_apart a b f t : is_edge a b -> is_face f ->
  without_common_vertex (an_edge a b) (a_face f) -> 0 <= t <= T ->
  ~ within n d (points (an_edge a b) t) (points (a_face f) t).
Proof.
  intros E Hf N Ht. revert t Ht. apply theorem_of_pairs_with_an_edge.
  - intros t Ht. split; apply places_are_continuous; exact Ht.
  - apply face_is_continuous.
  - exact (free_at_start a b f E Hf N).
  - intros t Ht. repeat split.
    + apply (vertices_and_faces a b f t E Hf); [apply N; cbn; auto | exact Ht].
    + apply (vertices_and_faces b a f t (edges_have_no_direction _ _ E) Hf); [apply N; cbn; auto | exact Ht].
    + intros a' b' H W. destruct (proper_edge f t a' b' Hf H) as (x & y & Exy & Vx & Vy & S).
      apply (edges_and_edges a b x y t E Exy); [| exact Ht | exact (within_larger _ _ _ _ _ _ W (fun c C => C) S)].
      intros v Hv [-> | ->]; apply (N _ Hv); assumption.
Qed.

Lemma faces_are_apart f g t : is_face f -> is_face g -> without_common_vertex (a_face f) (a_face g) -> 0 <= t <= T ->
  ~ within n d (points (a_face f) t) (points (a_face g) t).
Proof.
  intros Hf Hg N Ht. assert (N' : without_common_vertex (a_face g) (a_face f)) by (intros v Vg Vf; exact (N v Vf Vg)).
  assert (Free : forall f g, is_face f -> is_face g -> without_common_vertex (a_face f) (a_face g) -> forall a b,
    edge_of (at_time (image place f) 0) a b -> ~ meet (on_segment a b) (points (a_face g) 0)).
  { intros h k Hh Hk M a b Hab (z & Z & Z'). destruct (proper_edge h 0 a b Hh Hab) as (x & y & E & Vx & Vy & S).
    apply (free_at_start x y k E Hk); [| exists z; split; [apply S, Z | exact Z']].
    intros v [-> | ->]; apply M; assumption. }
  revert t Ht. apply theorem_of_pairs; try apply face_is_continuous.
  - intros (a & b & [(Hab & M) | (Hab & M)]); [apply (Free f g Hf Hg N a b Hab M) |].
    apply (Free g f Hg Hf N' a b Hab M).
  - intros t Ht [(v & Hv & W) | [(v & Hv & W) | (a & b & a' & b' & Hab & Hab' & W)]].
    + apply vertex_of_image in Hv as (p & Hv & ->). apply vertex_of_image in Hv as (x & Hx & ->).
      destruct (vertex_has_edge f x Hf Hx) as (y & E & _). exact (vertices_and_faces x y g t E Hg (N x Hx) Ht W).
    + apply vertex_of_image in Hv as (p & Hv & ->). apply vertex_of_image in Hv as (x & Hx & ->).
      destruct (vertex_has_edge g x Hg Hx) as (y & E & _). exact (vertices_and_faces x y f t E Hf (N' x Hx) Ht W).
    + destruct (proper_edge f t a b Hf Hab) as (x & y & E & Vx & Vy & S).
      destruct (proper_edge g t a' b' Hg Hab') as (x' & y' & E' & Vx' & Vy' & S').
      apply (edges_and_edges x y x' y' t E E'); [| exact Ht | exact (within_larger _ _ _ _ _ _ W S S')].
      intros v Hv Hv'. apply (N v); [destruct Hv as [-> | ->] | destruct Hv' as [-> | ->]]; assumption.
Qed.

End Faces.

Hypothesis searched_are_apart : forall P Q, in_mesh P -> in_mesh Q -> without_common_vertex P Q -> is_searched P Q ->
  forall t, 0 <= t <= T -> ~ within n d (points P t) (points Q t).

Lemma vertex_and_face_are_apart v f t : is_face f -> ~ vertex_of f v -> 0 <= t <= T ->
  ~ within n d (points (a_vertex v) t) (points (a_face f) t).
Proof.
  intros Hf N Ht. refine (searched_are_apart (a_vertex v) (a_face f) I Hf _ I t Ht). intros w -> W. exact (N W).
Qed.

Lemma edges_are_apart a b a' b' t : is_edge a b -> is_edge a' b' ->
  without_common_vertex (an_edge a b) (an_edge a' b') -> 0 <= t <= T ->
  ~ within n d (points (an_edge a b) t) (points (an_edge a' b') t).
Proof. intros E E' N Ht. exact (searched_are_apart (an_edge a b) (an_edge a' b') E E' N I t Ht). Qed.

Lemma vertex_and_edge_are_apart v a b t : is_edge a b -> without_common_vertex (a_vertex v) (an_edge a b) ->
  ~ is_excluded (a_vertex v) (an_edge a b) -> 0 <= t <= T ->
  ~ within n d (points (a_vertex v) t) (points (an_edge a b) t).
Proof.
  intros E N X Ht W. cbn [is_excluded] in X. assert (F : without_edge v).
  { intros x Ex. apply (edges_are_apart v x a b t Ex E); [| exact Ht |].
    - intros w [-> | ->] Hw; [exact (N v eq_refl Hw) | destruct Hw as [-> | ->]; auto].
    - refine (within_larger _ _ _ _ _ _ W _ (fun c C => C)). intros c <-. apply start_of_segment. }
  refine (searched_are_apart (a_vertex v) (an_edge a b) I E N _ t Ht W). split; [exact F |].
  intros f Hf (Ha & Hb). apply (vertex_and_face_are_apart v f t Hf); [| exact Ht |].
  - intros Hv. destruct (vertex_has_edge f v Hf Hv) as (w & Ew & _). exact (F w Ew).
  - refine (within_larger _ _ _ _ _ _ W (fun c C => C) _). intros c.
    apply segment_is_in_face; apply vertex_of_image; [exists (place a) | exists (place b)];
      (split; [apply vertex_of_image; eauto | reflexivity]).
Qed.

Lemma vertices_are_apart v w t : v <> w -> ~ is_excluded (a_vertex v) (a_vertex w) -> 0 <= t <= T ->
  ~ within n d (points (a_vertex v) t) (points (a_vertex w) t).
Proof.
  intros N X Ht W. assert (F : forall v w, v <> w -> ~ is_excluded (a_vertex v) (a_vertex w) ->
    within n d (points (a_vertex v) t) (points (a_vertex w) t) -> without_edge v).
  { clear v w N X W. cbn [is_excluded]. intros v w N X W x E. apply (vertex_and_edge_are_apart w v x t E); auto.
    - intros y -> [-> | ->]; auto.
    - cbn [is_excluded]. intros [E' | E']; apply X; eauto 6.
    - apply within_symmetric in W. refine (within_larger _ _ _ _ _ _ W (fun c C => C) _).
      intros c <-. apply start_of_segment. }
  refine (searched_are_apart (a_vertex v) (a_vertex w) I I _ _ t Ht W).
  - intros x -> E. exact (N E).
  - split; [exact (F v w N X W) |]. apply (F w v); [auto | | apply within_symmetric, W].
    cbn [is_excluded] in *. intros [E | (x & E & E')]; apply X; eauto 7.
Qed.

Theorem theorem_of_pairs_in_a_mesh P Q t : in_mesh P -> in_mesh Q -> without_common_vertex P Q -> ~ is_excluded P Q ->
  0 <= t <= T -> ~ within n d (points P t) (points Q t).
Proof.
  intros HP HQ N X Ht. assert (N' : without_common_vertex Q P) by (intros v Hq Hp; exact (N v Hp Hq)).
  assert (S : ~ within n d (points Q t) (points P t) -> ~ within n d (points P t) (points Q t))
    by auto using within_symmetric.
  destruct P as [v | a b | f], Q as [w | a' b' | g]; cbn [in_mesh] in HP, HQ.
  - apply vertices_are_apart; auto. intros <-. exact (N v eq_refl eq_refl).
  - apply vertex_and_edge_are_apart; auto.
  - apply vertex_and_face_are_apart; auto. exact (N v eq_refl).
  - apply S, vertex_and_edge_are_apart; auto.
  - apply edges_are_apart; auto.
  - apply edge_and_face_are_apart; eauto using vertex_and_face_are_apart, edges_are_apart.
  - apply S, vertex_and_face_are_apart; auto. exact (N' w eq_refl).
  - apply S, edge_and_face_are_apart; eauto using vertex_and_face_are_apart, edges_are_apart.
  - apply faces_are_apart; eauto using vertex_and_face_are_apart, edges_are_apart.
Qed.

End Mesh.

(** ** The theorem for two faces and queries *)

(** The queries of the pairs of two faces. *)
Inductive query_of (f g : triple motion) : query -> Prop :=
  | vertex_of_first v : vertex_of f v -> query_of f g (Query vertex_face v (x_of g) (y_of g) (z_of g))
  | vertex_of_second v : vertex_of g v -> query_of f g (Query vertex_face v (x_of f) (y_of f) (z_of f))
  | edges_of_both p q a b : edge_of f p q -> edge_of g a b -> query_of f g (Query edge_edge p q a b).

Definition on_a_straight_line (m : motion) : Prop := exists a b, m = straight a b.

(* Unfolding it would take long. *)
Local Opaque position.

Theorem no_two_faces_touch (f g : triple motion) s T :
  (forall m, vertex_of f m \/ vertex_of g m -> on_a_straight_line m) ->
  ~ an_edge_meets (image (fun m => position m 0) f) (image (fun m => position m 0) g) ->
  (forall q, query_of f g q -> no_contact_until q s T) ->
  forall t, 0 <= t <= T -> ~ within (norm_of s) (Q2R (distance_of s))
    (on_triangle (image (fun m => position m t) f)) (on_triangle (image (fun m => position m t) g)).
Proof.
  intros L0 N0 N. assert (C : forall h, (forall m, vertex_of h m -> on_a_straight_line m) ->
    continuous_until T (image position h)).
  { intros h Hh t _ v Hv. apply vertex_of_image in Hv as (m & Hm & ->). destruct (Hh m Hm) as (a & b & ->).
    rewrite (FunctionalExtensionality.functional_extensionality _ _ (straight_line a b)). unfold continuous_at, to_vector. by_coordinates.
    repeat split; continuous. }
  assert (Cf : continuous_until T (image position f)) by auto.
  assert (Cg : continuous_until T (image position g)) by auto.
  apply (theorem_of_pairs (image position f) (image position g) _ _ T Cf Cg N0).
  intros t Ht [(v & Hv & x & y & <- & (a & b & D & ->) & L) | [(v & Hv & x & y & <- & (a & b & D & ->) & L) |
    (p & q & a & b & Hp & Ha & x & y & (u & D & ->) & (v & D' & ->) & L)]].
  - apply (vertex_of_image (fun m => position m t)) in Hv as (m & Hm & ->).
    apply (N _ (vertex_of_first f g m Hm) t Ht). exists a, b. auto.
  - apply (vertex_of_image (fun m => position m t)) in Hv as (m & Hm & ->).
    apply (N _ (vertex_of_second f g m Hm) t Ht). exists a, b. auto.
  - apply (edge_of_image (fun m => position m t)) in Hp as (p' & q' & Hp & -> & ->).
    apply (edge_of_image (fun m => position m t)) in Ha as (a' & b' & Ha & -> & ->).
    apply (N _ (edges_of_both f g p' q' a' b' Hp Ha) t Ht). exists u, v. cbn. auto.
Qed.

Print Assumptions theorem_of_pairs_in_a_mesh.
Print Assumptions no_two_faces_touch.
