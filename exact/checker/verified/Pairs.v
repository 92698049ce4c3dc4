(** The theorem of pairs (docs/theory.md, section 8.3): two faces without a common vertex come within a distance only
    if a vertex of one and the other face do, or an edge of each. The vertices move on continuous paths.

    1. Two faces that meet do so at an edge of one of them ([faces_meet_at_an_edge]): four parameters and three equations leave
       a direction in which the two points stay equal, and along it a weight becomes 0.
    2. An edge and a face that meet, while no vertex of the one is on the other and no edges meet, have independent
       directions ([crossing]): otherwise three parameters leave such a direction, too. So they meet at all times
       nearby: the weights are continuous by Cramer's rule ([crossing_is_open]).
    3. If they do not meet, they do not at all times nearby either ([apart_is_open]): they have a distance.
    4. So an edge and a face that do not meet at t=0 never do ([edge_and_face]), and neither do two faces.
    5. Faces that come within a distance meet if one of them moves by the difference, on a straight line: the case
       before, with another time ([theorem_of_pairs]). *)

Require Import Reals QArith Qreals List Lra Psatz.
Import ListNotations.
Require Import Verified.Problem Verified.Geometry.
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

Definition path := R -> vector.
Definition at_time (f : triple path) (t : R) : triple vector := Triple (x_of f t) (y_of f t) (z_of f t).

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

(** ** Directions in which two points stay equal *)

(** An end of the edge is on the face, or the edge meets one of the face's. *)
Definition edge_touches (p q : vector) (f : triple vector) : Prop :=
  on_triangle f p \/ on_triangle f q \/
  exists a b, edge_of f a b /\ meet (on_segment p q) (on_segment a b).

Ltac by_coordinates :=
  unfold segment_point, triangle_point, plus, minus, times, origin in *; cbn [x_of y_of z_of] in *.

Definition det (a b c : vector) : R := dot a (cross b c).
Definition combination (k l m : R) (a b c : vector) : vector := plus (plus (times k a) (times l b)) (times m c).

Lemma three_are_dependent a b c : det a b c = 0 ->
  exists k l m, (k <> 0 \/ l <> 0 \/ m <> 0) /\ combination k l m a b c = origin.
Proof.
  intros D. unfold combination. destruct a as [ax ay az], b as [bx b_y bz], c as [cx cy cz].
  unfold det in D. unfold cross, dot in D. by_coordinates.
  destruct (Req_dec (b_y * cz - bz * cy) 0) as [X |].
  2: { exists (b_y * cz - bz * cy), (cy * az - cz * ay), (ay * bz - az * b_y). split; [auto |]. f_equal; lra. }
  destruct (Req_dec (bz * cx - bx * cz) 0) as [Y |].
  2: { exists (bz * cx - bx * cz), (cz * ax - cx * az), (az * bx - ax * bz). split; [auto |]. f_equal; lra. }
  destruct (Req_dec (bx * cy - b_y * cx) 0) as [Z |].
  2: { exists (bx * cy - b_y * cx), (cx * ay - cy * ax), (ax * b_y - ay * bx). split; [auto |]. f_equal; lra. }
  destruct (Req_dec cx 0) as [-> |]; [| exists 0, cx, (- bx); split; [auto | f_equal; lra]].
  destruct (Req_dec cy 0) as [-> |]; [| exists 0, cy, (- b_y); split; [auto | f_equal; lra]].
  destruct (Req_dec cz 0) as [-> |]; [| exists 0, cz, (- bz); split; [auto | f_equal; lra]].
  exists 0, 0, 1. split; [lra | f_equal; lra].
Qed.

Lemma four_are_dependent a b c e :
  exists k l m n, (k <> 0 \/ l <> 0 \/ m <> 0 \/ n <> 0) /\ plus (combination k l m a b c) (times n e) = origin.
Proof.
  destruct (Req_dec (det a b c) 0) as [D | D].
  - destruct (three_are_dependent a b c D) as (k & l & m & H & E). exists k, l, m, 0.
    split; [tauto |]. rewrite E. by_coordinates. f_equal; ring.
  - exists (det e b c), (det a e c), (det a b e), (- det a b c). split; [right; right; right; lra |].
    unfold combination, det. clear. by_components. f_equal; ring.
Qed.

(** Weights w ≥ 0 that change by the rates r, one of which is negative: the greatest step that leaves all at least 0. *)
Lemma greatest_step (l : list (R * R)) : (forall w r, In (w, r) l -> 0 <= w) -> (exists w r, In (w, r) l /\ r < 0) ->
  exists h, (forall w r, In (w, r) l -> 0 <= w + h * r) /\ exists w r, In (w, r) l /\ w + h * r = 0.
Proof.
  intros W (w0 & r0 & I0 & R0).
  cut ((forall w r, In (w, r) l -> 0 <= r) \/
    exists h, 0 <= h /\ (forall w r, In (w, r) l -> 0 <= w + h * r) /\ exists w r, In (w, r) l /\ w + h * r = 0).
  { intros [C | (h & _ & C)]; [specialize (C _ _ I0); lra | eauto]. }
  clear w0 r0 I0 R0. induction l as [| [w r] l IH]; [left; intros ? ? [] |].
  pose proof (W w r (or_introl eq_refl)) as Hw.
  destruct IH as [C | (h & Hh & C & w1 & r1 & I1 & E1)]; [intros; apply (W w0 r0); right; assumption | |].
  - destruct (Rle_lt_dec 0 r) as [Hr | Hr].
    + left. intros w0 r0 [[= <- <-] | I]; eauto.
    + assert (E : w + w / - r * r = 0) by (field; lra).
      assert (0 <= w / - r) by (apply Rmult_le_pos; [| apply Rlt_le, Rinv_0_lt_compat]; lra).
      right. exists (w / - r). repeat split; [assumption | | exists w, r; split; [left |]; auto].
      intros w0 r0 [[= <- <-] | I]; [lra |]. pose proof (C _ _ I). pose proof (W _ _ (or_intror I)). nra.
  - right. destruct (Rle_lt_dec 0 (w + h * r)) as [Hr | Hr].
    + exists h. repeat split; [assumption | | exists w1, r1; split; [right |]; auto].
      intros w0 r0 [[= <- <-] | I]; eauto.
    + assert (r < 0) by nra. assert (E : w + w / - r * r = 0) by (field; lra).
      assert (0 <= w / - r) by (apply Rmult_le_pos; [| apply Rlt_le, Rinv_0_lt_compat]; lra).
      assert (w / - r <= h) by nra.
      exists (w / - r). repeat split; [assumption | | exists w, r; split; [left |]; auto].
      intros w0 r0 [[= <- <-] | I]; [lra |]. pose proof (C _ _ I). pose proof (W _ _ (or_intror I)). nra.
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
    as (h & W & w & r & I & Z).
  - intros w r I. cbn [In] in I. repeat destruct I as [[= <- <-] | I]; try contradiction; lra.
  - destruct (Rlt_le_dec k 0); [exists u, k; cbn; auto 9 |]. destruct (Rlt_le_dec l 0); [exists v, l; cbn; auto 9 |].
    destruct (Rlt_le_dec m 0); [exists u', m; cbn; auto 9 |]. destruct (Rlt_le_dec n 0); [exists v', n; cbn; auto 9 |].
    destruct (Rlt_le_dec (- k - l) 0); [exists (1 - u - v), (- k - l); cbn; auto 9 |].
    exists (1 - u' - v'), (- m - n); cbn; split; [auto 9 | lra].
  - pose proof (W u k ltac:(cbn; auto 9)). pose proof (W v l ltac:(cbn; auto 9)).
    pose proof (W _ (- k - l) ltac:(cbn; auto 9)). pose proof (W u' m ltac:(cbn; auto 9)).
    pose proof (W v' n ltac:(cbn; auto 9)). pose proof (W _ (- m - n) ltac:(cbn; auto 9)).
    assert (E' : triangle_point f (u + h * k) (v + h * l) = triangle_point g (u' + h * m) (v' + h * n)).
    { unfold combination in D. by_coordinates. injection E as Ex Ey Ez. injection D as Dx Dy Dz.
      f_equal; [apply (f_equal (Rmult h)) in Dx | apply (f_equal (Rmult h)) in Dy | apply (f_equal (Rmult h)) in Dz];
        lra. }
    assert (Z' : (u + h * k = 0 \/ v + h * l = 0 \/ 1 - (u + h * k) - (v + h * l) = 0) \/
      (u' + h * m = 0 \/ v' + h * n = 0 \/ 1 - (u' + h * m) - (v' + h * n) = 0)).
    { cbn [In] in I. repeat destruct I as [[= <- <-] | I]; try contradiction; [left | left | left | right | right | right];
        lra. }
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
  - left. replace p with (segment_point p q 0); [exact T |]. clear. destruct p. by_coordinates. f_equal; ring.
  - right. left. replace q with (segment_point p q 1); [exact T |]. clear. destruct q. by_coordinates. f_equal; ring.
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
  destruct (greatest_step [(s, k); (1 - s, - k); (u, l); (v, m); (1 - u - v, - l - m)]) as (h & W & w & r & I & Z).
  - intros w r I. cbn [In] in I. repeat destruct I as [[= <- <-] | I]; try contradiction; lra.
  - destruct (Rlt_le_dec k 0); [exists s, k; cbn; auto 9 |].
    destruct (Rlt_le_dec (- k) 0); [exists (1 - s), (- k); cbn; auto 9 |].
    destruct (Rlt_le_dec l 0); [exists u, l; cbn; auto 9 |]. destruct (Rlt_le_dec m 0); [exists v, m; cbn; auto 9 |].
    exists (1 - u - v), (- l - m); cbn; split; [auto 9 | lra].
  - apply N. pose proof (W s k ltac:(cbn; auto 9)). pose proof (W _ (- k) ltac:(cbn; auto 9)).
    pose proof (W u l ltac:(cbn; auto 9)). pose proof (W v m ltac:(cbn; auto 9)).
    pose proof (W _ (- l - m) ltac:(cbn; auto 9)).
    apply touches_at_boundary with (s + h * k) (u + h * l) (v + h * m); try lra.
    + unfold combination in C. by_coordinates. injection E as Ex Ey Ez. injection C as Cx Cy Cz.
      f_equal; [apply (f_equal (Rmult h)) in Cx | apply (f_equal (Rmult h)) in Cy | apply (f_equal (Rmult h)) in Cz];
        lra.
    + cbn [In] in I. repeat destruct I as [[= <- <-] | I]; try contradiction; lra.
Qed.

(** ** A crossing is open in time *)

(** True if P is true at all times close to t. *)
Definition around (t : R) (P : R -> Prop) : Prop := exists d, 0 < d /\ forall s, Rabs (s - t) < d -> P s.

Lemma around_both t P Q : around t P -> around t Q -> around t (fun s => P s /\ Q s).
Proof.
  intros (d & Hd & HP) (e & He & HQ). exists (Rmin d e). split; [apply Rmin_pos; assumption |].
  intros s Hs. pose proof (Rmin_l d e). pose proof (Rmin_r d e). split; [apply HP | apply HQ]; lra.
Qed.

Lemma around_close t f e : continuity_pt f t -> 0 < e -> around t (fun s => Rabs (f s - f t) < e).
Proof.
  intros C He. destruct (C e He) as (d & Hd & H). exists d. split; [exact Hd |]. intros s Hs.
  destruct (Req_dec t s) as [-> | N]; [rewrite Rminus_diag_eq, Rabs_R0; auto |].
  apply H. split; [split; [exact I | exact N] | exact Hs].
Qed.

Lemma around_positive t f : continuity_pt f t -> 0 < f t -> around t (fun s => 0 < f s).
Proof.
  intros C H. destruct (around_close t f (f t) C H) as (d & Hd & D). exists d. split; [exact Hd |].
  intros s Hs. specialize (D s Hs). apply Rabs_def2 in D. lra.
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
  combination (det r b c / det a b c) (det a r c / det a b c) (det a b r / det a b c) a b c = r.
Proof.
  intros D. unfold combination. set (k := det a b c) in *. unfold det in k. clear - D.
  subst k. unfold det in *. by_components. f_equal; field; exact D.
Qed.

Lemma crossing_is_open (p q : path) (f : triple path) t :
  continuous_at t p -> continuous_at t q -> (forall v, vertex_of f v -> continuous_at t v) ->
  ~ edge_touches (p t) (q t) (at_time f t) -> meet (on_segment (p t) (q t)) (on_triangle (at_time f t)) ->
  around t (fun t' => meet (on_segment (p t') (q t')) (on_triangle (at_time f t'))).
Proof.
  intros Cp Cq Cf N (x & (s & Hs & ->) & u & v & (Hu & Hv & Hw) & E).
  pose proof (crossing _ _ _ s u v Hs Hu Hv Hw E N) as (Hs' & D).
  destruct f as [a b c]. unfold at_time in *. cbn [x_of y_of z_of] in *.
  pose proof (Cf a (or_introl eq_refl)) as (? & ? & ?). destruct Cp as (? & ? & ?), Cq as (? & ? & ?).
  pose proof (Cf b (or_intror (or_introl eq_refl))) as (? & ? & ?).
  pose proof (Cf c (or_intror (or_intror eq_refl))) as (? & ? & ?).
  pose (e1 := fun t => minus (q t) (p t)). pose (e2 := fun t => minus (a t) (b t)). pose (e3 := fun t => minus (a t) (c t)).
  pose (r := fun t => minus (triangle_point (Triple (a t) (b t) (c t)) u v) (segment_point (p t) (q t) s)).
  assert (continuous_at t e1 /\ continuous_at t e2 /\ continuous_at t e3 /\ continuous_at t r) as (C1 & C2 & C3 & Cr).
  { unfold continuous_at, e1, e2, e3, r. by_coordinates. repeat split; continuous. }
  pose (d := fun t => det (e1 t) (e2 t) (e3 t)). change (d t <> 0) in D.
  assert (Cd : continuity_pt d t) by (apply det_is_continuous; assumption).
  assert (W : forall w g, continuity_pt g t -> g t = 0 ->
    continuity_pt (fun t => w + g t / d t) t /\ w + g t / d t = w).
  { intros w g Cg Zg. split; [continuous; exact D | rewrite Zg; field; exact D]. }
  assert (R0 : r t = origin) by (unfold r; rewrite E; clear; by_coordinates; f_equal; ring).
  pose proof (W s _ (det_is_continuous t _ _ _ Cr C2 C3)) as (CS & ES); [cbv beta; rewrite R0; unfold det; clear; by_components; ring |].
  pose proof (W u _ (det_is_continuous t _ _ _ C1 Cr C3)) as (CU & EU); [cbv beta; rewrite R0; unfold det; clear; by_components; ring |].
  pose proof (W v _ (det_is_continuous t _ _ _ C1 C2 Cr)) as (CV & EV); [cbv beta; rewrite R0; unfold det; clear; by_components; ring |].
  cbv beta in *.
  pose (S := fun t => s + det (r t) (e2 t) (e3 t) / d t). pose (U := fun t => u + det (e1 t) (r t) (e3 t) / d t).
  pose (V := fun t => v + det (e1 t) (e2 t) (r t) / d t).
  change (continuity_pt S t) in CS. change (continuity_pt U t) in CU. change (continuity_pt V t) in CV.
  change (S t = s) in ES. change (U t = u) in EU. change (V t = v) in EV.
  destruct (around_both _ _ _ (around_both _ _ _ (around_positive t S CS ltac:(lra))
      (around_both _ _ _ (around_positive t U CU ltac:(lra)) (around_positive t V CV ltac:(lra))))
    (around_both _ _ _ (around_positive t (fun t => 1 - S t) ltac:(continuous) ltac:(lra))
      (around_both _ _ _ (around_positive t (fun t => 1 - U t - V t) ltac:(continuous) ltac:(lra))
        (around_positive t (fun t => d t * d t) ltac:(continuous) ltac:(apply Rsqr_pos_lt; exact D)))))
    as (e & He & A).
  exists e. split; [exact He |]. intros t' Ht. specialize (A t' Ht) as ((? & ? & ?) & ? & ? & P).
  exists (segment_point (p t') (q t') (S t')). split; [exists (S t'); split; [lra | reflexivity] |].
  exists (U t'), (V t'). split; [lra |].
  assert (Dt : d t' <> 0) by (intros Z; rewrite Z in P; lra).
  pose proof (cramer (e1 t') (e2 t') (e3 t') (r t') Dt) as K. clear - K. unfold S, U, V, d in *.
  set (k := det (r t') _ _ / _) in *. set (l := det _ (r t') _ / _) in *. set (m := det _ _ (r t') / _) in *.
  unfold combination, e1, e2, e3, r in K. clearbody k l m. by_coordinates. injection K as Kx Ky Kz. f_equal; lra.
Qed.

(** ** To have a distance is open in time *)

(** Induction along [0,b], without the excluded middle: the conclusion is not refutable. *)
Lemma continuation (E : R -> Prop) b : 0 <= b -> E 0 ->
  (forall m, 0 <= m <= b -> ~ ~ exists d, 0 < d /\
    forall x y, 0 <= x <= m -> m - d < x -> x <= y <= b -> y < m + d -> E x -> E y) ->
  ~ ~ E b.
Proof.
  intros Hb E0 L N. destruct (completeness (fun x => 0 <= x <= b /\ E x)) as (m & U & Least).
  - exists b. intros x (? & _). lra.
  - exists 0. split; [lra | exact E0].
  - assert (0 <= m) by (apply U; split; [lra | exact E0]).
    assert (m <= b) by (apply Least; intros x (? & _); lra).
    apply (L m); [lra |]. intros (d & Hd & D).
    assert (m <= m - d); [| lra]. apply Least. intros x (Hx & Ex). apply Rnot_lt_le. intros G.
    assert (x <= m) by (apply U; auto). destruct (Rle_lt_dec b (m + d / 2)).
    + apply N. apply (D x b); auto; lra.
    + assert (m + d / 2 <= m); [| lra]. apply U. split; [lra |]. apply (D x); auto; lra.
Qed.

Definition size (a : vector) : R := Rabs (x_of a) + Rabs (y_of a) + Rabs (z_of a).
Definition apart (S : vector -> Prop) : Prop := ~ ~ exists e, 0 < e /\ forall x, S x -> e <= size x.

Lemma size_nonnegative a : 0 <= size a.
Proof. unfold size. pose proof (Rabs_pos (x_of a)). pose proof (Rabs_pos (y_of a)). pose proof (Rabs_pos (z_of a)). lra. Qed.

Lemma size_zero a : size a <= 0 -> a = origin.
Proof. unfold size. destruct a as [x y z]. cbn [x_of y_of z_of]. intros H. unfold origin. f_equal; split_Rabs; lra. Qed.

Lemma size_plus a b : size (plus a b) <= size a + size b.
Proof.
  unfold size, plus. cbn [x_of y_of z_of]. pose proof (Rabs_triang (x_of a) (x_of b)).
  pose proof (Rabs_triang (y_of a) (y_of b)). pose proof (Rabs_triang (z_of a) (z_of b)). lra.
Qed.

Lemma size_times k a : size (times k a) = Rabs k * size a.
Proof. unfold size, times. cbn [x_of y_of z_of]. rewrite !Rabs_mult. ring. Qed.

Lemma size_minus a b : size (minus a b) <= size a + size b.
Proof.
  replace (minus a b) with (plus a (times (-1) b)) by (clear; by_coordinates; f_equal; ring).
  pose proof (size_plus a (times (-1) b)) as H. rewrite size_times in H. rewrite Rabs_left in H; lra.
Qed.

(** A union of sets that change at a limited rate. *)
Lemma sweep (G : R -> vector -> Prop) L : 0 <= L ->
  (forall s s' x, 0 <= s <= 1 -> 0 <= s' <= 1 -> G s x -> exists x', G s' x' /\ size (minus x' x) <= Rabs (s' - s) * L) ->
  (forall s, 0 <= s <= 1 -> apart (G s)) -> apart (fun x => exists s, 0 <= s <= 1 /\ G s x).
Proof.
  intros HL Lip A N. apply (A 0); [lra |]. intros (e0 & He0 & S0).
  apply (continuation (fun b => exists e, 0 < e /\ forall s x, 0 <= s <= b -> s <= 1 -> G s x -> e <= size x) 1).
  - lra.
  - exists e0. split; [exact He0 |]. intros s x Hs _ Gx. replace s with 0 in Gx by lra. auto.
  - intros m Hm C. apply (A m Hm). intros (e & He & S). apply C. exists (e / 2 / (L + 1)).
    assert (B : e / 2 / (L + 1) * (L + 1) = e / 2) by (field; lra).
    assert (0 < e / 2 / (L + 1)) by (apply Rdiv_lt_0_compat; lra). set (d := e / 2 / (L + 1)) in *. split; [assumption |].
    intros x y Hx Hd Hy Hyd (e' & He' & S'). exists (Rmin (e / 2) e'). split; [apply Rmin_pos; lra |].
    intros s a Hs Hs1 Ga. destruct (Rle_lt_dec s x).
    + eapply Rle_trans; [apply Rmin_r | apply (S' s); auto; lra].
    + eapply Rle_trans; [apply Rmin_l |]. destruct (Lip s m a) as (a' & Ga' & La); [lra | lra | exact Ga |].
      specialize (S a' Ga'). assert (Rabs (m - s) <= d) by (apply Rabs_le; lra).
      pose proof (size_plus (minus a' a) a) as T. replace (plus (minus a' a) a) with a' in T
        by (clear; destruct a'; by_coordinates; f_equal; ring). nra.
  - intros (e & He & S). apply N. exists e. split; [exact He |]. intros x (s & Hs & Gx). apply (S s x); auto; lra.
Qed.

Lemma segment_and_triangle_are_apart p q f : ~ meet (on_segment p q) (on_triangle f) ->
  apart (fun x => exists s y, 0 <= s <= 1 /\ on_triangle f y /\ x = minus (segment_point p q s) y).
Proof.
  intros N. pose (point s w v := minus (segment_point p q s) (triangle_point f (w * (1 - v)) (w * v))).
  destruct f as [a b c].
  assert (A : apart (fun x => exists s, 0 <= s <= 1 /\ exists w, 0 <= w <= 1 /\ exists v, 0 <= v <= 1 /\ x = point s w v)).
  { apply (sweep (fun s x => _)) with (size (minus q p)); [apply size_nonnegative | |].
    { intros s s' x Hs Hs' (w & Hw & v & Hv & ->). exists (point s' w v). split; [eauto 6 |].
      rewrite <- size_times. apply Req_le. f_equal. unfold point. clear. by_coordinates. f_equal; ring. }
    intros s Hs. apply (sweep (fun w x => _)) with (size (minus b a) + size (minus c a)).
    { pose proof (size_nonnegative (minus b a)). pose proof (size_nonnegative (minus c a)). lra. }
    { intros w w' x Hw Hw' (v & Hv & ->). exists (point s w' v). split; [eauto 6 |].
      replace (minus _ _) with (times (w' - w) (minus (times (v - 1) (minus b a)) (times v (minus c a))))
        by (unfold point; clear; by_coordinates; f_equal; ring).
      rewrite size_times. apply Rmult_le_compat_l; [apply Rabs_pos |].
      pose proof (size_minus (times (v - 1) (minus b a)) (times v (minus c a))) as T. rewrite !size_times in T.
      pose proof (size_nonnegative (minus b a)). pose proof (size_nonnegative (minus c a)).
      assert (Rabs (v - 1) <= 1) by (apply Rabs_le; lra). assert (Rabs v <= 1) by (apply Rabs_le; lra). nra. }
    intros w Hw. apply (sweep (fun v x => _)) with (size (minus b c)); [apply size_nonnegative | |].
    { intros v v' x Hv Hv' ->. exists (point s w v'). split; [reflexivity |].
      replace (minus (point _ _ _) _) with (times w (times (v' - v) (minus b c)))
        by (unfold point; clear; by_coordinates; f_equal; ring).
      rewrite !size_times. rewrite (Rabs_right w) by lra. pose proof (size_nonnegative (minus b c)).
      assert (0 <= Rabs (v' - v) * size (minus b c)) by (apply Rmult_le_pos; [apply Rabs_pos | assumption]). nra. }
    intros v Hv C. apply C. exists (size (point s w v)). split; [| intros x ->; lra].
    apply Rnot_le_lt. intros Z. apply N. exists (segment_point p q s). split; [exists s; auto |].
    exists (w * (1 - v)), (w * v). split; [nra |]. apply size_zero in Z. unfold point in Z. clear - Z.
    by_coordinates. injection Z as X Y Z. f_equal; lra. }
  intros C. apply A. intros (e & He & S). apply C. exists e. split; [exact He |].
  intros x (s & y & Hs & (u & v & (Hu & Hv & Hw) & ->) & ->). apply S. exists s. split; [exact Hs |].
  exists (u + v). split; [lra |]. destruct (Req_dec (u + v) 0).
  - exists 0. split; [lra |]. unfold point. f_equal. f_equal; nra.
  - exists (v / (u + v)). assert (E : v / (u + v) * (u + v) = v) by (field; lra). set (k := v / (u + v)) in *.
    split; [split; nra |]. unfold point. f_equal. f_equal; lra.
Qed.

Lemma around_near (p : path) t e : continuous_at t p -> 0 < e -> around t (fun t' => size (minus (p t') (p t)) < e).
Proof.
  intros (Cx & Cy & Cz) He. assert (H : 0 < e / 3) by lra.
  destruct (around_both _ _ _ (around_close _ _ _ Cx H) (around_both _ _ _ (around_close _ _ _ Cy H) (around_close _ _ _ Cz H)))
    as (d & Hd & D).
  exists d. split; [exact Hd |]. intros t' Ht. specialize (D t' Ht). unfold size, minus. cbn [x_of y_of z_of]. lra.
Qed.

Lemma apart_is_open (p q : path) (f : triple path) t :
  continuous_at t p -> continuous_at t q -> (forall v, vertex_of f v -> continuous_at t v) ->
  ~ meet (on_segment (p t) (q t)) (on_triangle (at_time f t)) ->
  ~ ~ around t (fun t' => ~ meet (on_segment (p t') (q t')) (on_triangle (at_time f t'))).
Proof.
  intros Cp Cq Cf N C. apply (segment_and_triangle_are_apart _ _ _ N). intros (e & He & S). apply C. clear C N.
  pose (close (v : path) t' := size (minus (v t') (v t)) < e / 2).
  assert (A : forall v, continuous_at t v -> around t (close v)) by (intros v Cv; apply around_near; [exact Cv | lra]).
  destruct f as [a b c]. unfold at_time in *. cbn [x_of y_of z_of] in *.
  destruct (around_both _ _ _ (around_both _ _ _ (A p Cp) (A q Cq)) (around_both _ _ _ (A a (Cf a ltac:(cbv; auto)))
    (around_both _ _ _ (A b (Cf b ltac:(cbv; auto))) (A c (Cf c ltac:(cbv; auto)))))) as (d & Hd & D).
  exists d. split; [exact Hd |]. intros t' Ht (x & (s & Hs & ->) & u & v & (Hu & Hv & Hw) & E).
  destruct (D t' Ht) as ((Dp & Dq) & Da & Db & Dc). unfold close in *. clear - Hs Hu Hv Hw E S Dp Dq Da Db Dc.
  set (z := minus (segment_point (p t) (q t) s) (triangle_point (Triple (a t) (b t) (c t)) u v)).
  assert (B : e <= size z).
  { apply S. exists s. eexists. split; [exact Hs |]. split; [exists u, v; split; [lra |] |]; reflexivity. }
  replace z with (minus
      (triangle_point (Triple (minus (a t') (a t)) (minus (b t') (b t)) (minus (c t') (c t))) u v)
      (segment_point (minus (p t') (p t)) (minus (q t') (q t)) s)) in B
    by (unfold z; clear - E; by_coordinates; injection E as Ex Ey Ez; f_equal; lra).
  clear z S E. unfold triangle_point, segment_point in B. cbn [x_of y_of z_of] in B.
  pose proof (Rle_trans _ _ _ B (size_minus _ _)) as B1.
  pose proof (size_plus (plus (times (1 - u - v) (minus (a t') (a t))) (times u (minus (b t') (b t))))
    (times v (minus (c t') (c t)))).
  pose proof (size_plus (times (1 - u - v) (minus (a t') (a t))) (times u (minus (b t') (b t)))).
  pose proof (size_plus (times (1 - s) (minus (p t') (p t))) (times s (minus (q t') (q t)))).
  rewrite !size_times in *. rewrite (Rabs_right u), (Rabs_right v), (Rabs_right s), (Rabs_right (1 - s)),
    (Rabs_right (1 - u - v)) in * by lra.
  set (sa := size (minus (a t') (a t))) in *. set (sb := size (minus (b t') (b t))) in *.
  set (sc := size (minus (c t') (c t))) in *. set (sp := size (minus (p t') (p t))) in *.
  set (sq := size (minus (q t') (q t))) in *. clearbody sa sb sc sp sq.
  assert ((1 - s) * (e / 2 - sp) + s * (e / 2 - sq) > 0) by (destruct (Req_dec s 0); nra).
  assert (0 <= u * (e / 2 - sb)) by (apply Rmult_le_pos; lra).
  assert (0 <= v * (e / 2 - sc)) by (apply Rmult_le_pos; lra).
  assert (0 <= (1 - u - v) * (e / 2 - sa)) by (apply Rmult_le_pos; lra). lra.
Qed.

(** ** The theorem for an edge and a face *)

Theorem edge_and_face (p q : path) (f : triple path) T :
  (forall t, 0 <= t <= T -> continuous_at t p /\ continuous_at t q /\ forall v, vertex_of f v -> continuous_at t v) ->
  ~ meet (on_segment (p 0) (q 0)) (on_triangle (at_time f 0)) ->
  (forall t, 0 <= t <= T -> ~ edge_touches (p t) (q t) (at_time f t)) ->
  forall t, 0 <= t <= T -> ~ meet (on_segment (p t) (q t)) (on_triangle (at_time f t)).
Proof.
  intros C N0 N t Ht. pose (E x := forall t, 0 <= t <= x -> ~ meet (on_segment (p t) (q t)) (on_triangle (at_time f t))).
  cut (~ ~ E T); [intros G M; apply G; intros ET; apply (ET t Ht M) |].
  apply continuation; [lra | intros s Hs; replace s with 0 by lra; exact N0 |].
  intros m Hm G. destruct (C m Hm) as (Cp & Cq & Cf).
  assert (X : ~ meet (on_segment (p m) (q m)) (on_triangle (at_time f m))).
  { intros M. destruct (crossing_is_open p q f m Cp Cq Cf (N m Hm) M) as (d & Hd & D). apply G. exists d.
    split; [exact Hd |]. intros x y Hx Hxd Hy _ Ex. exfalso. apply (Ex x); [lra |]. apply D. apply Rabs_def1; lra. }
  apply (apart_is_open p q f m Cp Cq Cf X). intros (d & Hd & D). apply G. exists d. split; [exact Hd |].
  intros x y Hx Hxd Hy Hyd Ex s Hs. destruct (Rle_lt_dec s x); [apply Ex; lra |]. apply D. apply Rabs_def1; lra.
Qed.

(** ** The theorem for two faces *)

Definition continuous_until (T : R) (f : triple path) : Prop :=
  forall t, 0 <= t <= T -> forall v, vertex_of f v -> continuous_at t v.

Lemma edge_of_paths (f : triple path) t a b : edge_of (at_time f t) a b ->
  exists p q, edge_of f p q /\ a = p t /\ b = q t.
Proof. unfold edge_of. destruct f. intros [[-> ->] | [[-> ->] | [-> ->]]]; do 2 eexists; cbn; eauto 7. Qed.

Lemma edge_of_faces (f g : triple path) T p q : continuous_until T f -> continuous_until T g ->
  ~ an_edge_meets (at_time f 0) (at_time g 0) -> (forall t, 0 <= t <= T -> ~ a_pair_is meet (at_time f t) (at_time g t)) ->
  edge_of f p q -> forall t, 0 <= t <= T -> ~ meet (on_segment (p t) (q t)) (on_triangle (at_time g t)).
Proof.
  intros Cf Cg N0 N Hpq. assert (V : vertex_of f p /\ vertex_of f q) by (unfold vertex_of; unfold edge_of in Hpq; tauto).
  assert (Et : forall t, edge_of (at_time f t) (p t) (q t)).
  { intros t. destruct Hpq as [[-> ->] | [[-> ->] | [-> ->]]]; cbv; auto. }
  assert (Vt : forall t v, vertex_of f v -> vertex_of (at_time f t) (v t)).
  { intros t v [-> | [-> | ->]]; cbv; auto. }
  apply edge_and_face.
  - intros t Ht. repeat split; first [apply (Cf t Ht); apply V | apply (Cg t Ht); assumption].
  - intros M. apply N0. exists (p 0), (q 0). auto.
  - intros t Ht [P | [P | (a & b & Hab & M)]]; apply (N t Ht); [left; exists (p t) | left; exists (q t) | right; right].
    + split; [apply Vt, V | exists (p t); auto].
    + split; [apply Vt, V | exists (q t); auto].
    + exists (p t), (q t), a, b. auto.
Qed.

Lemma a_pair_is_symmetric f g : a_pair_is meet f g -> a_pair_is meet g f.
Proof.
  intros [P | [P | (p & q & a & b & Hp & Ha & x & X)]]; [right; left; exact P | left; exact P | right; right].
  exists a, b, p, q. repeat split; [exact Ha | exact Hp |]. exists x. tauto.
Qed.

Theorem faces_that_never_meet (f g : triple path) T : continuous_until T f -> continuous_until T g ->
  ~ an_edge_meets (at_time f 0) (at_time g 0) -> (forall t, 0 <= t <= T -> ~ a_pair_is meet (at_time f t) (at_time g t)) ->
  forall t, 0 <= t <= T -> ~ meet (on_triangle (at_time f t)) (on_triangle (at_time g t)).
Proof.
  intros Cf Cg N0 N t Ht M. destruct (faces_meet_at_an_edge _ _ M) as (a & b & [(Hab & E) | (Hab & E)]);
    destruct (edge_of_paths _ _ _ _ Hab) as (p & q & Hpq & -> & ->).
  - exact (edge_of_faces f g T p q Cf Cg N0 N Hpq t Ht E).
  - refine (edge_of_faces g f T p q Cg Cf _ _ Hpq t Ht E).
    + intros (x & y & [X | X]); apply N0; exists x, y; auto.
    + intros s Hs P. apply (N s Hs). apply a_pair_is_symmetric. exact P.
Qed.

Lemma length_of_opposite n a b : length_of n (minus a b) = length_of n (minus b a).
Proof.
  replace (minus a b) with (times (-1) (minus b a)) by (clear; by_components; f_equal; ring).
  destruct n; cbn [length_of times x_of y_of z_of].
  - rewrite !Rabs_mult, (Rabs_left (-1)) by lra. replace (- -1) with 1 by lra. rewrite !Rmult_1_l. reflexivity.
  - f_equal. clear; by_components; ring.
Qed.

(** The face moves by k c, while k grows. *)
Definition moved (f : triple vector) (c : vector) : triple path :=
  Triple (fun k => plus (x_of f) (times k c)) (fun k => plus (y_of f) (times k c)) (fun k => plus (z_of f) (times k c)).

Lemma moved_is_continuous f c T : continuous_until T (moved f c).
Proof.
  intros t _ v [-> | [-> | ->]]; unfold continuous_at, moved; by_coordinates; repeat split; continuous.
Qed.

Lemma on_moved_triangle f c k x : on_triangle (at_time (moved f c) k) x <->
  exists y, on_triangle f y /\ x = plus y (times k c).
Proof.
  unfold on_triangle, at_time, moved. cbn [x_of y_of z_of]. split.
  - intros (u & v & D & ->). eexists. split; [exists u, v; auto |]. by_coordinates. f_equal; ring.
  - intros (y & (u & v & D & ->) & ->). exists u, v. split; [exact D |]. by_coordinates. f_equal; ring.
Qed.

Lemma vertex_of_moved f c k v : vertex_of (at_time (moved f c) k) v -> exists w, vertex_of f w /\ v = plus w (times k c).
Proof. intros [-> | [-> | ->]]; cbn [at_time moved x_of y_of z_of]; eexists; (split; [| reflexivity]); cbv; auto. Qed.

Lemma on_edge_of_moved f c k a b x : edge_of (at_time (moved f c) k) a b -> on_segment a b x ->
  exists p q y, edge_of f p q /\ on_segment p q y /\ x = plus y (times k c).
Proof.
  intros H (u & D & ->).
  assert (exists p q, edge_of f p q /\ a = plus p (times k c) /\ b = plus q (times k c)) as (p & q & E & -> & ->).
  { destruct H as [[-> ->] | [[-> ->] | [-> ->]]]; cbn [at_time moved x_of y_of z_of]; do 2 eexists;
      (split; [| split; reflexivity]); unfold edge_of; auto. }
  exists p, q, (segment_point p q u). repeat split; [exact E | exists u; auto |]. by_coordinates. f_equal; ring.
Qed.

Lemma edge_is_in_face f a b x : edge_of f a b -> on_segment a b x -> on_triangle f x.
Proof.
  intros [[-> ->] | [[-> ->] | [-> ->]]] (u & D & ->);
    [exists u, 0 | exists (1 - u), u | exists 0, (1 - u)]; (split; [lra |]); by_coordinates; f_equal; ring.
Qed.

Theorem theorem_of_pairs (f g : triple path) n d T : continuous_until T f -> continuous_until T g ->
  ~ an_edge_meets (at_time f 0) (at_time g 0) ->
  (forall t, 0 <= t <= T -> ~ a_pair_is (within n d) (at_time f t) (at_time g t)) ->
  forall t, 0 <= t <= T -> ~ within n d (on_triangle (at_time f t)) (on_triangle (at_time g t)).
Proof.
  intros Cf Cg N0 N t Ht (x & y & X & Y & L). pose proof (length_nonnegative n (minus x y)) as H0.
  (* A common point of two sets that differ by k c is a pair of points within d. *)
  assert (W : forall k a b, 0 <= k <= 1 -> a = plus b (times k (minus x y)) -> length_of n (minus a b) <= d).
  { intros k a b Hk ->. replace (minus _ b) with (times k (minus x y)) by (clear; by_components; f_equal; ring).
    rewrite length_times by lra. nra. }
  assert (M : forall P Q : vector -> Prop, meet P Q -> within n d P Q).
  { intros P Q (z & Hp & Hq). exists z, z. repeat split; auto. apply (W 0); [lra |]. clear; by_components; f_equal; ring. }
  assert (N' : ~ meet (on_triangle (at_time f t)) (on_triangle (at_time g t))).
  { apply (faces_that_never_meet f g T Cf Cg N0); [| exact Ht]. intros s Hs P. apply (N s Hs).
    destruct P as [(v & Hv & P) | [(v & Hv & P) | (p & q & a & b & Hp & Ha & P)]];
      [left; exists v | right; left; exists v | right; right; exists p, q, a, b]; auto 6. }
  specialize (N t Ht). set (F0 := at_time f t) in *. set (G0 := at_time g t) in *. clearbody F0 G0.
  clear f g Cf Cg N0.
  set (c := minus x y) in *. destruct F0 as [a b e].
  refine (faces_that_never_meet (Triple (fun _ => a) (fun _ => b) (fun _ => e)) (moved G0 c) 1 _
    (moved_is_continuous G0 c 1) _ _ 1 ltac:(lra) _).
  - intros k _ v [-> | [-> | ->]]; repeat split; continuous.
  - intros (p & q & [(Hp & z & Z & Z') | (Hp & z & Z & Z')]); apply N'; exists z.
    + split; [exact (edge_is_in_face _ _ _ _ Hp Z) |]. apply on_moved_triangle in Z' as (z' & Z' & ->).
      replace (plus z' (times 0 c)) with z' by (clear; by_components; f_equal; ring). exact Z'.
    + split; [exact Z' |]. apply (edge_is_in_face _ _ _ _ Hp), on_moved_triangle in Z as (z' & Z & ->).
      replace (plus z' (times 0 c)) with z' by (clear; by_components; f_equal; ring). exact Z.
  - intros k Hk P. apply N. destruct P as [(v & Hv & z & <- & Z) | [(v & Hv & z & <- & Z') | (p & q & p' & q' & Hp & Hq & z & Z & Z')]].
    + left. exists v. split; [exact Hv |]. apply on_moved_triangle in Z as (z & Z & ->).
      eexists _, z. repeat split; [exact Z |]. apply (W k); auto.
    + right. left. apply vertex_of_moved in Hv as (w & Hw & ->). exists w. split; [exact Hw |].
      eexists w, _. repeat split; [exact Z' |]. rewrite length_of_opposite. apply (W k); auto.
    + right. right. destruct (on_edge_of_moved _ _ _ _ _ _ Hq Z') as (p1 & q1 & y' & H1 & Y' & ->).
      exists p, q, p1, q1. repeat split; [exact Hp | exact H1 |]. eexists _, y'. repeat split; [exact Z | exact Y' |].
      apply (W k); auto.
  - exists x. split; [exact X |]. apply on_moved_triangle. exists y. split; [exact Y |]. subst c. clear; by_components; f_equal; ring.
Qed.

(** ** An edge and a face: the edge is a face of which two vertices are equal *)

Definition face_of_edge {A} (p q : A) : triple A := Triple p q q.

Lemma on_face_of_edge p q x : on_triangle (face_of_edge p q) x <-> on_segment p q x.
Proof.
  unfold face_of_edge. split.
  - intros (u & v & D & ->). exists (u + v). split; [lra |]. by_coordinates. f_equal; ring.
  - intros (u & D & ->). exists u, 0. split; [lra |]. by_coordinates. f_equal; ring.
Qed.

(** ** The theorem for queries *)

Definition paths (f : triple motion) : triple path := Triple (position (x_of f)) (position (y_of f)) (position (z_of f)).

(** The pairs that are searched. *)
Inductive searched (f g : triple motion) : query -> Prop :=
  | vertex_of_first v : vertex_of f v -> searched f g (Query vertex_face v (x_of g) (y_of g) (z_of g))
  | vertex_of_second v : vertex_of g v -> searched f g (Query vertex_face v (x_of f) (y_of f) (z_of f))
  | two_edges p q a b : edge_of f p q -> edge_of g a b -> searched f g (Query edge_edge p q a b).

(** The order of the ends and of the edges does not matter. *)
Lemma contact_in_any_order p q a b s t : contact (Query edge_edge p q a b) s t ->
  contact (Query edge_edge q p a b) s t /\ contact (Query edge_edge a b p q) s t.
Proof.
  unfold contact, F. cbn. intros (u & v & D & L). split; [exists (1 - u), v | exists v, u]; (split; [lra |]).
  - replace (plus (times (1 - (1 - u)) _) _) with (plus (times (1 - u) (position p t)) (times u (position q t)))
      by (clear; by_coordinates; f_equal; ring). exact L.
  - rewrite length_of_opposite. exact L.
Qed.

Lemma paths_are_continuous f T : continuous_until T (paths f).
Proof.
  intros t _ v V. assert (C : forall m, continuous_at t (position m)).
  { intros m. unfold continuous_at, position. by_coordinates. repeat split; continuous. }
  destruct V as [-> | [-> | ->]]; apply C.
Qed.

Theorem no_two_faces_touch (f g : triple motion) s T : ~ an_edge_meets (at_time (paths f) 0) (at_time (paths g) 0) ->
  (forall q, searched f g q -> no_contact_until q s T) ->
  forall t, 0 <= t <= T ->
  ~ within (norm_of s) (Q2R (distance_of s)) (on_triangle (at_time (paths f) t)) (on_triangle (at_time (paths g) t)).
Proof.
  intros N0 N. apply theorem_of_pairs; try apply paths_are_continuous; [exact N0 |].
  assert (V : forall (f : triple motion) t v, vertex_of (at_time (paths f) t) v ->
    exists m, vertex_of f m /\ v = position m t).
  { intros h t v [-> | [-> | ->]]; eexists; (split; [| reflexivity]); cbv; auto. }
  assert (E : forall (f : triple motion) t a b, edge_of (at_time (paths f) t) a b ->
    exists p q, edge_of f p q /\ a = position p t /\ b = position q t).
  { intros h t a b [[-> ->] | [[-> ->] | [-> ->]]]; do 2 eexists; (split; [| split; reflexivity]); unfold edge_of; auto. }
  intros t Ht [(v & Hv & x & y & <- & (a & b & D & ->) & L) | [(v & Hv & x & y & <- & (a & b & D & ->) & L) |
    (p & q & a & b & Hp & Ha & x & y & (u & D & ->) & (v & D' & ->) & L)]].
  - apply V in Hv as (m & Hm & ->). apply (N _ (vertex_of_first f g m Hm) t Ht). exists a, b. auto.
  - apply V in Hv as (m & Hm & ->). apply (N _ (vertex_of_second f g m Hm) t Ht). exists a, b. auto.
  - apply E in Hp as (p' & q' & Hp & -> & ->). apply E in Ha as (a' & b' & Ha & -> & ->).
    apply (N _ (two_edges f g p' q' a' b' Hp Ha) t Ht). exists u, v. cbn. auto.
Qed.

Print Assumptions theorem_of_pairs.
Print Assumptions no_two_faces_touch.
