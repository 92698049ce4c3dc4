(** The geometry over the reals: the corner theorem, directions that separate, and the conditions
    at a contact.

    A *hull* is here a convex set of vectors. It is that of the corners of a query, enlarged by the
    positive factor that makes them integers. *)

Require Import Reals QArith Qreals List Lra Psatz.
Import ListNotations.
Require Import Verified.Problem.
Open Scope R_scope.

Definition cross (a b : vector) : vector :=
  Triple (y_of a * z_of b - z_of a * y_of b) (z_of a * x_of b - x_of a * z_of b)
    (x_of a * y_of b - y_of a * x_of b).
Definition origin : vector := Triple 0 0 0.

Inductive axis := x_axis | y_axis | z_axis.
Definition component {A} (k : axis) (a : triple A) : A :=
  match k with x_axis => x_of a | y_axis => y_of a | z_axis => z_of a end.

(** ** The corners of a query *)

Definition corners (q : query) (t : R) : list vector :=
  let p0 := position (point0 q) t in
  let p1 := position (point1 q) t in
  let p2 := position (point2 q) t in
  let p3 := position (point3 q) t in
  match kind_of q with
  | vertex_face => [minus p0 p1; minus p0 p2; minus p0 p3]
  | edge_edge => [minus p0 p2; minus p1 p2; minus p1 p3; minus p0 p3]
  end.

Definition in_hull (q : query) (t : R) (x : vector) : Prop :=
  exists u v, in_domain (kind_of q) u v /\ F q t u v = x.

Definition convex (H : vector -> Prop) : Prop :=
  forall a b k, H a -> H b -> 0 <= k <= 1 -> H (plus (times (1 - k) a) (times k b)).

Ltac by_components :=
  repeat match goal with a : vector |- _ => destruct a end;
  unfold plus, minus, times, cross, dot, origin in *; cbn [x_of y_of z_of component] in *.

(** The corner theorem, first part: the hull is convex and has the corners. *)

Lemma hull_is_convex q t : convex (in_hull q t).
Proof.
  intros a b k (u & v & D & <-) (u' & v' & D' & <-) Hk.
  exists ((1 - k) * u + k * u'), ((1 - k) * v + k * v'). split.
  - destruct (kind_of q); cbn [in_domain] in *; nra.
  - unfold F. destruct (kind_of q);
      unfold plus, minus, times; cbn [x_of y_of z_of]; f_equal; ring.
Qed.

Lemma corners_are_in_hull q t w : In w (corners q t) -> in_hull q t w.
Proof.
  unfold corners, in_hull, F. destruct (kind_of q); cbn [In in_domain];
    intros C; repeat destruct C as [<- | C]; try contradiction;
    [exists 0, 0 | exists 1, 0 | exists 0, 1 | exists 0, 0 | exists 1, 0 | exists 1, 1 | exists 0, 1];
    (split; [lra |]); unfold plus, minus, times; cbn [x_of y_of z_of]; f_equal; ring.
Qed.

(** The corner theorem, second part: nothing else is in it. Where all corners are beyond a plane, so
    is the hull. *)

Lemma dot_F q t u v d : dot d (F q t u v) =
  match corners q t, kind_of q with
  | [a; b; c], vertex_face => (1 - u - v) * dot d a + u * dot d b + v * dot d c
  | [a; b; c; e], edge_edge =>
      (1 - u) * (1 - v) * dot d a + u * (1 - v) * dot d b + u * v * dot d c + (1 - u) * v * dot d e
  | _, _ => 0
  end.
Proof.
  unfold F, corners. destruct (kind_of q); unfold dot, plus, minus, times; cbn [x_of y_of z_of]; ring.
Qed.

Lemma hull_is_beyond q t d k : (forall w, In w (corners q t) -> k < dot d w) ->
  forall x, in_hull q t x -> k < dot d x.
Proof.
  intros C x (u & v & D & <-). rewrite dot_F. unfold corners in *.
  destruct (kind_of q); cbn [In in_domain] in *.
  all: set (p0 := position _ _) in *; set (p1 := position (point1 q) t) in *;
    set (p2 := position (point2 q) t) in *; set (p3 := position (point3 q) t) in *.
  - pose proof (C (minus p0 p1) ltac:(auto)). pose proof (C (minus p0 p2) ltac:(auto)).
    pose proof (C (minus p0 p3) ltac:(auto)).
    set (a := dot d (minus p0 p1)) in *. set (b := dot d (minus p0 p2)) in *.
    set (c := dot d (minus p0 p3)) in *. clearbody a b c.
    assert (0 <= u * (b - k)) by (apply Rmult_le_pos; lra).
    assert (0 <= v * (c - k)) by (apply Rmult_le_pos; lra).
    assert (0 <= (1 - u - v) * (a - k)) by (apply Rmult_le_pos; lra).
    destruct (Req_dec u 0); [destruct (Req_dec v 0) |]; nra.
  - pose proof (C (minus p0 p2) ltac:(auto)). pose proof (C (minus p1 p2) ltac:(auto)).
    pose proof (C (minus p1 p3) ltac:(auto)). pose proof (C (minus p0 p3) ltac:(auto)).
    set (a := dot d (minus p0 p2)) in *. set (b := dot d (minus p1 p2)) in *.
    set (c := dot d (minus p1 p3)) in *. set (e := dot d (minus p0 p3)) in *. clearbody a b c e.
    assert (k < (1 - u) * a + u * b) by (destruct (Req_dec u 0); nra).
    assert (k < (1 - u) * e + u * c) by (destruct (Req_dec u 0); nra).
    destruct (Req_dec v 0); nra.
Qed.

(** ** Norms *)

Definition dual_length (n : norm) (a : vector) : R :=
  match n with
  | linf => Rabs (x_of a) + Rabs (y_of a) + Rabs (z_of a)
  | l2 => sqrt (dot a a)
  end.

Lemma square_nonnegative a : 0 <= dot a a.
Proof. by_components. nra. Qed.

Lemma length_nonnegative n a : 0 <= length_of n a.
Proof.
  destruct n; cbn [length_of]; [| apply sqrt_pos].
  eapply Rle_trans; [apply Rabs_pos | apply Rmax_l].
Qed.

Lemma lagrange a b : dot a a * dot b b - dot a b * dot a b = dot (cross a b) (cross a b).
Proof. by_components. ring. Qed.

Lemma abs_product a b m : Rabs b <= m -> a * b <= Rabs a * m.
Proof.
  intros H. eapply Rle_trans; [apply Rle_abs |]. rewrite Rabs_mult.
  apply Rmult_le_compat_l; [apply Rabs_pos | exact H].
Qed.

Lemma dot_le_lengths n d x : dot d x <= dual_length n d * length_of n x.
Proof.
  destruct n; cbn [dual_length length_of].
  - set (m := Rmax _ _).
    assert (Rabs (x_of x) <= m) by apply Rmax_l.
    assert (Rabs (y_of x) <= m) by (eapply Rle_trans; [apply Rmax_l | apply Rmax_r]).
    assert (Rabs (z_of x) <= m) by (eapply Rle_trans; [apply Rmax_r | apply Rmax_r]).
    unfold dot. rewrite !Rmult_plus_distr_r.
    repeat apply Rplus_le_compat; apply abs_product; assumption.
  - rewrite <- sqrt_mult; try apply square_nonnegative.
    apply Rsqr_incr_0_var; [| apply sqrt_pos].
    rewrite Rsqr_sqrt by (apply Rmult_le_pos; apply square_nonnegative).
    pose proof (lagrange d x). pose proof (square_nonnegative (cross d x)). unfold Rsqr. lra.
Qed.

Lemma length_le_of_square n x D : 0 <= D -> dot x x <= D * D -> length_of n x <= D.
Proof.
  intros HD H. destruct n; cbn [length_of].
  - unfold dot in H. repeat apply Rmax_lub; apply Rabs_le; split; nra.
  - rewrite <- (sqrt_square D HD). apply sqrt_le_1_alt. exact H.
Qed.

Lemma length_zero n x : length_of n x <= 0 <-> x = origin.
Proof.
  split.
  - intros H. pose proof (dot_le_lengths n x x) as L. pose proof (length_nonnegative n x).
    replace (length_of n x) with 0 in L by lra. rewrite Rmult_0_r in L.
    by_components. unfold origin. f_equal; nra.
  - intros ->. apply length_le_of_square; [lra |]. unfold dot, origin. cbn [x_of y_of z_of]. lra.
Qed.

(** ** Separation *)

(** A direction in which all corners are farther than D keeps all of the hull farther than D. *)
Theorem direction_separates q s t d :
  (forall w, In w (corners q t) -> Q2R (distance_of s) * dual_length (norm_of s) d < dot d w) ->
  ~ contact q s t.
Proof.
  intros C (u & v & D & H).
  pose proof (hull_is_beyond q t d _ C (F q t u v) ltac:(exists u, v; auto)) as B.
  pose proof (dot_le_lengths (norm_of s) d (F q t u v)) as L.
  assert (0 <= dual_length (norm_of s) d).
  { destruct (norm_of s); cbn [dual_length]; [| apply sqrt_pos].
    pose proof (Rabs_pos (x_of d)). pose proof (Rabs_pos (y_of d)). pose proof (Rabs_pos (z_of d)). lra. }
  assert (dual_length (norm_of s) d * length_of (norm_of s) (F q t u v) <=
          dual_length (norm_of s) d * Q2R (distance_of s)) by (apply Rmult_le_compat_l; assumption).
  lra.
Qed.

(** L2, without square roots. *)
Lemma l2_separation d w D : 0 < dot d w -> 0 < dot d w * dot d w - D * D * dot d d ->
  D * dual_length l2 d < dot d w.
Proof.
  intros H H2. cbn [dual_length]. pose proof (sqrt_pos (dot d d)) as P.
  pose proof (sqrt_sqrt (dot d d) (square_nonnegative d)) as S.
  apply Rnot_le_lt. intros N.
  assert (dot d w * dot d w <= D * sqrt (dot d d) * (D * sqrt (dot d d))) by (apply Rmult_le_compat; lra).
  nra.
Qed.

(** The polygon's normal has one product with all corners. *)

Lemma normal_first_three a b c :
  let n := cross (minus b a) (minus c a) in dot n b = dot n a /\ dot n c = dot n a.
Proof. intros n. unfold n. by_components. split; ring. Qed.

(** ** Contact *)

Lemma three_in_hull H a b c i j k : convex H -> H a -> H b -> H c ->
  0 <= i -> 0 <= j -> 0 <= k -> i + j + k = 1 ->
  H (plus (plus (times i a) (times j b)) (times k c)).
Proof.
  intros C Ha Hb Hc Hi Hj Hk E. destruct (Req_dec k 1) as [E1 | N].
  - subst k. assert (i = 0) as -> by lra. assert (j = 0) as -> by lra.
    replace (plus (plus (times 0 a) (times 0 b)) (times 1 c)) with c; [exact Hc |].
    by_components. f_equal; ring.
  - assert (Hj' : 0 <= j / (1 - k) <= 1).
    { split; [apply Rmult_le_pos; [lra | left; apply Rinv_0_lt_compat; lra] |].
      apply (Rmult_le_reg_r (1 - k)); [lra |]. unfold Rdiv. rewrite Rmult_assoc, Rinv_l by lra. lra. }
    pose proof (C _ _ (j / (1 - k)) Ha Hb Hj') as H1.
    pose proof (C _ _ k H1 Hc ltac:(lra)) as H2.
    replace (plus (plus (times i a) (times j b)) (times k c)) with
      (plus (times (1 - k) (plus (times (1 - j / (1 - k)) a) (times (j / (1 - k)) b))) (times k c));
      [exact H2 |].
    assert (i = 1 - j - k) as -> by lra. by_components. f_equal; field; lra.
Qed.

(** Triangle: Cramer's rule. *)
Lemma triangle_contact H a b c k : convex H -> H a -> H b -> H c ->
  let i := component k (cross b c) in
  let j := component k (cross c a) in
  let l := component k (cross a b) in
  dot a (cross b c) = 0 ->
  (0 < i + j + l /\ 0 <= i /\ 0 <= j /\ 0 <= l) \/ (i + j + l < 0 /\ i <= 0 /\ j <= 0 /\ l <= 0) ->
  H origin.
Proof.
  intros C Ha Hb Hc i j l E S. set (m := i + j + l) in *.
  assert (Hm : m <> 0) by lra.
  assert (W : forall x, (0 < m /\ 0 <= x) \/ (m < 0 /\ x <= 0) -> 0 <= x / m).
  { intros x [[Hm' Hx] | [Hm' Hx]].
    - apply Rmult_le_pos; [exact Hx | left; apply Rinv_0_lt_compat; exact Hm'].
    - replace (x / m) with ((- x) / (- m)) by (field; lra).
      apply Rmult_le_pos; [lra | left; apply Rinv_0_lt_compat; lra]. }
  pose proof (three_in_hull H a b c (i / m) (j / m) (l / m) C Ha Hb Hc
    ltac:(apply W; lra) ltac:(apply W; lra) ltac:(apply W; lra) ltac:(unfold m; field; exact Hm)) as P.
  replace origin with (plus (plus (times (i / m) a) (times (j / m) b)) (times (l / m) c)); [exact P |].
  assert (G : forall x y z, i * x + j * y + l * z = 0 -> i / m * x + j / m * y + l / m * z = 0).
  { intros x y z Z. replace (i / m * x + j / m * y + l / m * z) with ((i * x + j * y + l * z) / m)
      by (field; exact Hm). rewrite Z. unfold Rdiv. ring. }
  unfold plus, times, origin. cbn [x_of y_of z_of].
  clear P. f_equal; apply G; unfold i, j, l; destruct k; clear - E; by_components;
    first [ring | (ring_simplify; ring_simplify in E; lra)].
Qed.

(** Edge: the foot of the perpendicular from the origin. *)
Lemma edge_contact H a b D : convex H -> H a -> H b ->
  let e := minus b a in
  0 < dot e e -> dot a e <= 0 -> 0 <= dot b e ->
  dot (cross a b) (cross a b) <= D * D * dot e e ->
  exists x, H x /\ dot x x <= D * D.
Proof.
  intros C Ha Hb e He H0 H1 Hd.
  set (k := - dot a e / dot e e).
  assert (Ek : k * dot e e = - dot a e) by (unfold k; field; lra).
  assert (Eb : dot b e = dot a e + dot e e) by (unfold e; by_components; ring).
  exists (plus (times (1 - k) a) (times k b)). split; [apply C; auto; split; nra |].
  apply (Rmult_le_reg_r (dot e e)); [exact He |].
  replace (dot (plus (times (1 - k) a) (times k b)) (plus (times (1 - k) a) (times k b)))
    with (dot a a + 2 * k * dot a e + k * (k * dot e e)) by (unfold e; by_components; ring).
  rewrite Ek.
  replace ((dot a a + 2 * k * dot a e + k * - dot a e) * dot e e)
    with (dot a a * dot e e + dot a e * (k * dot e e)) by ring.
  rewrite Ek.
  replace (dot (cross a b) (cross a b)) with (dot (cross a e) (cross a e)) in Hd
    by (unfold e; by_components; ring).
  rewrite <- lagrange in Hd. lra.
Qed.

(** Segment: an edge at distance 0, or a corner that is 0. *)
Lemma segment_contact H a b : convex H -> H a -> H b ->
  cross a b = origin -> dot a b <= 0 -> exists x, H x /\ dot x x <= 0 * 0.
Proof.
  intros C Ha Hb E N.
  destruct (Req_dec (dot (minus b a) (minus b a)) 0) as [Z | P].
  - exists a. split; [exact Ha |]. clear E. by_components. nra.
  - pose proof (square_nonnegative (minus b a)). pose proof (square_nonnegative a).
    pose proof (square_nonnegative b).
    apply (edge_contact H a b 0); auto; [lra | | |].
    + replace (dot a (minus b a)) with (dot a b - dot a a) by (by_components; ring). lra.
    + replace (dot b (minus b a)) with (dot b b - dot a b) by (by_components; ring). lra.
    + rewrite E. unfold dot, origin. cbn [x_of y_of z_of]. lra.
Qed.

(** Face: the foot of the perpendicular in the polygon's plane is a + u e + v f. *)
Lemma foot_in_plane a e f D :
  let n := cross e f in
  let u := dot n (cross f a) / dot n n in
  let v := dot n (cross a e) / dot n n in
  0 < dot n n -> dot n a * dot n a <= D * D * dot n n ->
  let x := plus (plus a (times u e)) (times v f) in dot x x <= D * D.
Proof.
  intros n u v Hn Hd x.
  assert (Ex : times (dot n n) x = times (dot n a) n).
  { assert (Eu : dot n n * u = dot n (cross f a)) by (unfold u; field; lra).
    assert (Ev : dot n n * v = dot n (cross a e)) by (unfold v; field; lra).
    unfold x. clearbody u v.
    replace (times (dot n n) (plus (plus a (times u e)) (times v f))) with
      (plus (plus (times (dot n n) a) (times (dot n n * u) e)) (times (dot n n * v) f))
      by (unfold plus, times; cbn [x_of y_of z_of]; f_equal; ring).
    rewrite Eu, Ev. unfold n. clear. by_components. f_equal; ring. }
  clearbody x. clear u v.
  assert (dot n n * dot n n * dot x x = dot n a * dot n a * dot n n) as E.
  { replace (dot n n * dot n n * dot x x) with (dot (times (dot n n) x) (times (dot n n) x))
      by (generalize (dot n n); intros; clear; by_components; ring).
    rewrite Ex. generalize (dot n a). intros. clear. generalize n. intros m. by_components. ring. }
  apply (Rmult_le_reg_l (dot n n * dot n n)); [nra |]. rewrite E.
  replace (dot n n * dot n n * (D * D)) with (D * D * dot n n * dot n n) by ring.
  apply Rmult_le_compat_r; lra.
Qed.

Lemma quotient_in_unit x y m : 0 < m -> 0 <= x -> 0 <= y -> x + y = m -> 0 <= x / m <= 1.
Proof.
  intros Hm Hx Hy E. split.
  - apply Rmult_le_pos; [exact Hx | left; apply Rinv_0_lt_compat; exact Hm].
  - apply (Rmult_le_reg_r m); [exact Hm |]. unfold Rdiv. rewrite Rmult_assoc, Rinv_l by lra. lra.
Qed.

Lemma triangle_face_contact H a b c D : convex H -> H a -> H b -> H c ->
  let n := cross (minus b a) (minus c a) in
  0 < dot n n -> 0 <= dot n (cross a b) -> 0 <= dot n (cross b c) -> 0 <= dot n (cross c a) ->
  dot n a * dot n a <= D * D * dot n n -> exists x, H x /\ dot x x <= D * D.
Proof.
  intros C Ha Hb Hc n Hn Hab Hbc Hca Hd.
  pose proof (foot_in_plane a (minus b a) (minus c a) D Hn Hd) as P. fold n in P.
  cbv zeta in P.
  replace (cross (minus c a) a) with (cross c a) in P by (clear; by_components; f_equal; ring).
  replace (cross a (minus b a)) with (cross a b) in P by (clear; by_components; f_equal; ring).
  set (u := dot n (cross c a) / dot n n) in *. set (v := dot n (cross a b) / dot n n) in *.
  assert (Es : dot n n = dot n (cross b c) + dot n (cross c a) + dot n (cross a b)).
  { unfold n. clear. by_components. ring. }
  eexists. split; [| exact P].
  replace (plus (plus a (times u (minus b a))) (times v (minus c a))) with
    (plus (plus (times (1 - u - v) a) (times u b)) (times v c))
    by (clear; by_components; f_equal; ring).
  assert (0 <= u) by (apply Rmult_le_pos; [lra | left; apply Rinv_0_lt_compat; lra]).
  assert (0 <= v) by (apply Rmult_le_pos; [lra | left; apply Rinv_0_lt_compat; lra]).
  assert (0 <= 1 - u - v).
  { replace (1 - u - v) with (dot n (cross b c) / dot n n).
    - apply Rmult_le_pos; [lra | left; apply Rinv_0_lt_compat; lra].
    - unfold u, v. replace (dot n (cross b c)) with (dot n n - dot n (cross c a) - dot n (cross a b)) by lra.
      field. lra. }
  apply three_in_hull; auto. ring.
Qed.

Lemma parallelogram_face_contact H a b c f D : convex H -> H a -> H b -> H c -> H f ->
  f = plus (minus a b) c ->
  let n := cross (minus b a) (minus c a) in
  0 < dot n n -> 0 <= dot n (cross a b) -> 0 <= dot n (cross b c) -> 0 <= dot n (cross c f) ->
  0 <= dot n (cross f a) ->
  dot n a * dot n a <= D * D * dot n n -> exists x, H x /\ dot x x <= D * D.
Proof.
  intros C Ha Hb Hc Hf Ef n Hn Hab Hbc Hcf Hfa Hd.
  assert (En : n = cross (minus b a) (minus f a)).
  { unfold n. rewrite Ef. clear. by_components. f_equal; ring. }
  assert (E1 : dot n (cross f a) + dot n (cross b c) = dot n n).
  { unfold n. rewrite Ef. clear. by_components. ring. }
  assert (E2 : dot n (cross a b) + dot n (cross c f) = dot n n).
  { unfold n. rewrite Ef. clear. by_components. ring. }
  clearbody n. subst n. set (n := cross (minus b a) (minus f a)) in *.
  pose proof (foot_in_plane a (minus b a) (minus f a) D Hn Hd) as P. fold n in P.
  cbv zeta in P.
  replace (cross (minus f a) a) with (cross f a) in P by (clear; by_components; f_equal; ring).
  replace (cross a (minus b a)) with (cross a b) in P by (clear; by_components; f_equal; ring).
  set (u := dot n (cross f a) / dot n n) in *. set (v := dot n (cross a b) / dot n n) in *.
  assert (0 <= u <= 1) by (apply quotient_in_unit with (dot n (cross b c)); lra).
  assert (0 <= v <= 1) by (apply quotient_in_unit with (dot n (cross c f)); lra).
  eexists. split; [| exact P].
  replace (plus (plus a (times u (minus b a))) (times v (minus f a))) with
    (plus (times (1 - v) (plus (times (1 - u) a) (times u b)))
          (times v (plus (times (1 - u) f) (times u c)))).
  - apply C; auto.
  - clearbody u v n. rewrite Ef. clear. by_components. f_equal; ring.
Qed.

(** ** The corner theorem

    The differences F(t,·,·) are the convex combinations of the corners. *)

Fixpoint combination (weights : list R) (ws : list vector) : vector :=
  match weights, ws with
  | k :: weights', w :: ws' => plus (times k w) (combination weights' ws')
  | _, _ => origin
  end.

Definition is_convex_combination (x : vector) (ws : list vector) : Prop :=
  exists weights, length weights = length ws /\ Forall (Rle 0) weights /\
    fold_right Rplus 0 weights = 1 /\ combination weights ws = x.

Theorem corner_theorem q t x : in_hull q t x <-> is_convex_combination x (corners q t).
Proof.
  split.
  - intros (u & v & D & <-). unfold F, corners, is_convex_combination in *.
    destruct (kind_of q); cbn [in_domain] in D;
      [exists [1 - u - v; u; v] | exists [(1 - u) * (1 - v); u * (1 - v); u * v; (1 - u) * v]];
      (split; [reflexivity |]; split; [repeat (apply Forall_cons; [nra |]); apply Forall_nil |]; split; [cbn [fold_right]; ring |]);
      cbn [combination]; unfold plus, minus, times, origin; cbn [x_of y_of z_of]; f_equal; ring.
  - intros (weights & L & P & S & <-). pose proof (hull_is_convex q t) as C.
    pose proof (corners_are_in_hull q t) as I. unfold corners in *.
    destruct (kind_of q) eqn:K; cbn [length] in L.
    + destruct weights as [| i [| j [| k [|]]]]; try discriminate.
      cbn [fold_right] in S. inversion_clear P as [| ? ? Hi P']. inversion_clear P' as [| ? ? Hj P].
      inversion_clear P as [| ? ? Hk _].
      match goal with |- in_hull _ _ (combination _ [?a; ?b; ?c]) =>
        replace (combination _ _) with (plus (plus (times i a) (times j b)) (times k c))
          by (cbn [combination]; clear; by_components; f_equal; ring);
        apply three_in_hull; auto; try (apply I; cbn [In]; tauto) end. lra.
    + destruct weights as [| i [| j [| k [| m [|]]]]]; try discriminate.
      cbn [fold_right] in S. inversion_clear P as [| ? ? Hi P']. inversion_clear P' as [| ? ? Hj P].
      inversion_clear P as [| ? ? Hk P']. inversion_clear P' as [| ? ? Hm _].
      exists (j + k), (k + m). split; [rewrite K; cbn [in_domain]; lra |].
      assert (i = 1 - j - k - m) as -> by lra. unfold F. rewrite K.
      cbn [combination]. unfold plus, minus, times, origin. cbn [x_of y_of z_of]. f_equal; ring.
Qed.

(** A point of a norm of at most D in linf, as the polygon's point a + (p e + q f) / m. *)
Lemma point_of_quotients a e f m p q : 0 < m ->
  times m (plus (plus a (times (p / m) e)) (times (q / m) f)) =
  plus (plus (times m a) (times p e)) (times q f).
Proof. intros Hm. by_components. f_equal; field; lra. Qed.

Lemma triangle_point H a b c p q m : convex H -> H a -> H b -> H c ->
  0 < m -> 0 <= p -> 0 <= q -> p + q <= m ->
  H (plus (plus a (times (p / m) (minus b a))) (times (q / m) (minus c a))).
Proof.
  intros C Ha Hb Hc Hm Hp Hq E.
  assert (I : 0 < / m) by (apply Rinv_0_lt_compat; exact Hm).
  replace (plus (plus a (times (p / m) (minus b a))) (times (q / m) (minus c a))) with
    (plus (plus (times (1 - p / m - q / m) a) (times (p / m) b)) (times (q / m) c))
    by (clear; by_components; f_equal; ring).
  apply three_in_hull; auto; try ring; try (apply Rmult_le_pos; lra).
  replace (1 - p / m - q / m) with ((m - p - q) * / m) by (field; lra). apply Rmult_le_pos; lra.
Qed.

Lemma parallelogram_point H a b c f p q m : convex H -> H a -> H b -> H c -> H f ->
  f = plus (minus a b) c -> 0 < m -> 0 <= p -> 0 <= q -> p <= m -> q <= m ->
  H (plus (plus a (times (p / m) (minus b a))) (times (q / m) (minus f a))).
Proof.
  intros C Ha Hb Hc Hf Ef Hm Hp Hq Hpm Hqm.
  assert (0 <= p / m <= 1) by (apply quotient_in_unit with (m - p); lra).
  assert (0 <= q / m <= 1) by (apply quotient_in_unit with (m - q); lra).
  replace (plus (plus a (times (p / m) (minus b a))) (times (q / m) (minus f a))) with
    (plus (times (1 - q / m) (plus (times (1 - p / m) a) (times (p / m) b)))
          (times (q / m) (plus (times (1 - p / m) f) (times (p / m) c)))).
  - apply C; auto.
  - rewrite Ef. generalize (p / m), (q / m). intros. clear. by_components. f_equal; ring.
Qed.

(** ** Polygons: what all queries have in common *)

Definition is_polygon (ws : list vector) : Prop :=
  match ws with
  | [a; b; c] => True
  | [a; b; c; f] => f = plus (minus a b) c
  | _ => False
  end.

Lemma corners_are_polygon q t : is_polygon (corners q t).
Proof.
  unfold corners. destruct (kind_of q); cbn [is_polygon]; [exact I |].
  unfold plus, minus. cbn [x_of y_of z_of]. f_equal; ring.
Qed.

Lemma normal_is_common ws a b c rest : is_polygon ws -> ws = a :: b :: c :: rest ->
  forall w, In w ws -> dot (cross (minus b a) (minus c a)) w = dot (cross (minus b a) (minus c a)) a.
Proof.
  intros P -> w Hw. destruct rest as [| f [|]]; cbn [is_polygon] in P; [| subst f | contradiction];
    cbn [In] in Hw; repeat destruct Hw as [<- | Hw]; try contradiction; clear; by_components; ring.
Qed.

Lemma length_times n k a : 0 <= k -> length_of n (times k a) = k * length_of n a.
Proof.
  intros Hk. destruct n; cbn [length_of times x_of y_of z_of].
  - rewrite !Rabs_mult, (Rabs_right k) by lra. rewrite !RmaxRmult by exact Hk. reflexivity.
  - replace (dot (times k a) (times k a)) with (k * k * dot a a) by (by_components; ring).
    rewrite sqrt_mult; [| nra | apply square_nonnegative]. rewrite sqrt_square by exact Hk. reflexivity.
Qed.

(** The hull, enlarged. *)
Definition enlarged (k : R) (q : query) (t : R) (x : vector) : Prop :=
  exists y, in_hull q t y /\ x = times k y.

Lemma enlarged_is_convex k q t : convex (enlarged k q t).
Proof.
  intros a b m (y & Hy & ->) (z & Hz & ->) Hm. exists (plus (times (1 - m) y) (times m z)).
  split; [apply hull_is_convex; assumption |]. clear. by_components. f_equal; ring.
Qed.

Lemma enlarged_has_corners k q t w : In w (map (times k) (corners q t)) -> enlarged k q t w.
Proof.
  intros I. apply in_map_iff in I as (y & <- & Hy). exists y. split; [| reflexivity].
  apply corners_are_in_hull. exact Hy.
Qed.

Lemma enlarged_polygon k ws : is_polygon ws -> is_polygon (map (times k) ws).
Proof.
  destruct ws as [| a [| b [| c [| f [|]]]]]; cbn [is_polygon map]; auto. intros ->.
  clear. by_components. f_equal; ring.
Qed.

Lemma enlarged_contact k q s t x : 0 < k -> enlarged k q t x ->
  length_of (norm_of s) x <= k * Q2R (distance_of s) -> contact q s t.
Proof.
  intros Hk (y & (u & v & D & <-) & ->) L. rewrite length_times in L by lra.
  exists u, v. split; [exact D |]. apply Rmult_le_reg_l with k; assumption.
Qed.
