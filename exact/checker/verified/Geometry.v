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

(** Three points suffice in what follows. *)
Definition convex (H : vector -> Prop) : Prop := forall a b c i j k, H a -> H b -> H c ->
  0 <= i -> 0 <= j -> 0 <= k -> i + j + k = 1 -> H (plus (plus (times i a) (times j b)) (times k c)).

Ltac by_components :=
  repeat match goal with a : vector |- _ => destruct a end;
  unfold plus, minus, times, cross, dot, origin in *; cbn [x_of y_of z_of component] in *.

(** ** The corner theorem

    The differences F(t,·,·) are the convex combinations of the corners. *)

Lemma hull_is_convex q t : convex (in_hull q t).
Proof.
  intros a b c i j k (u & v & D & <-) (u' & v' & D' & <-) (u'' & v'' & D'' & <-) Hi Hj Hk E.
  exists (i * u + j * u' + k * u''), (i * v + j * v' + k * v''). assert (k = 1 - i - j) as -> by lra. split.
  - destruct (kind_of q); cbn [in_domain] in *; repeat split; nra.
  - unfold F. destruct (kind_of q); unfold plus, minus, times; cbn [x_of y_of z_of]; f_equal; ring.
Qed.

Lemma corners_are_in_hull q t w : In w (corners q t) -> in_hull q t w.
Proof.
  unfold corners, in_hull, F. destruct (kind_of q); cbn [In in_domain];
    intros C; repeat destruct C as [<- | C]; try contradiction;
    [exists 0, 0 | exists 1, 0 | exists 0, 1 | exists 0, 0 | exists 1, 0 | exists 1, 1 | exists 0, 1];
    (split; [lra |]); unfold plus, minus, times; cbn [x_of y_of z_of]; f_equal; ring.
Qed.

Theorem corner_theorem q t x : in_hull q t x <-> is_convex_combination x (corners q t).
Proof.
  split.
  - intros (u & v & D & <-). unfold F, corners, is_convex_combination in *.
    destruct (kind_of q); cbn [in_domain] in D;
      [exists [1 - u - v; u; v] | exists [(1 - u) * (1 - v); u * (1 - v); u * v; (1 - u) * v]];
      (split; [reflexivity |]; split; [repeat (apply Forall_cons; [nra |]); apply Forall_nil |]; split; [cbn [fold_right]; ring |]);
      cbn [combination]; unfold plus, minus, times, origin; cbn [x_of y_of z_of]; f_equal; ring.
  - intros (weights & L & P & S & <-). unfold in_hull, F, corners in *.
    destruct (kind_of q); destruct weights as [| i [| j [| k [| m weights]]]]; try destruct weights; try discriminate L;
      cbn [fold_right] in S; repeat match goal with P : Forall _ (_ :: _) |- _ => inversion_clear P end;
      [exists j, k; assert (i = 1 - j - k) as -> by lra |
       exists (j + k), (k + m); assert (i = 1 - j - k - m) as -> by lra]; (split; [cbn [in_domain]; lra |]);
      cbn [combination]; unfold plus, minus, times, origin; cbn [x_of y_of z_of]; f_equal; ring.
Qed.

(** Where all of them are beyond a plane, so are their convex combinations. *)
Lemma combination_is_beyond d k : forall ws, (forall w, In w ws -> k < dot d w) ->
  forall weights, length weights = length ws -> Forall (Rle 0) weights -> let sum := fold_right Rplus 0 weights in
  k * sum <= dot d (combination weights ws) /\ (0 < sum -> k * sum < dot d (combination weights ws)).
Proof.
  induction ws as [| w ws IH]; intros C [| x weights] L P; try discriminate; cbn [combination fold_right].
  - unfold dot, origin. cbn [x_of y_of z_of]. lra.
  - inversion_clear P as [| ? ? Hx P']. pose proof (C w (or_introl eq_refl)).
    destruct (IH (fun v I => C v (or_intror I)) weights ltac:(cbn in L; lia) P') as [A B].
    replace (dot d (plus _ _)) with (x * dot d w + dot d (combination weights ws)) by (clear; by_components; ring).
    split; [nra |]. intros S. destruct (Rle_lt_or_eq_dec 0 x Hx) as [G | <-]; [nra |]. specialize (B ltac:(lra)). lra.
Qed.

Lemma hull_is_beyond q t d k : (forall w, In w (corners q t) -> k < dot d w) ->
  forall x, in_hull q t x -> k < dot d x.
Proof.
  intros C x I. apply corner_theorem in I as (weights & L & P & S & <-).
  destruct (combination_is_beyond d k _ C _ L P) as [_ B]. rewrite S in B. lra.
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

Lemma dual_length_nonnegative n a : 0 <= dual_length n a.
Proof. destruct n; [| apply sqrt_pos]. repeat apply Rplus_le_le_0_compat; apply Rabs_pos. Qed.

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
  pose proof (Rmult_le_compat_l _ _ _ (dual_length_nonnegative (norm_of s) d) H). lra.
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

(** ** Contact *)

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
  pose proof (C a b c (i / m) (j / m) (l / m) Ha Hb Hc
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
  assert (0 <= k <= 1) by (split; nra).
  exists (plus (plus (times (1 - k) a) (times k b)) (times 0 b)). split; [apply C; auto; lra |].
  apply (Rmult_le_reg_r (dot e e)); [exact He |].
  replace (dot (plus _ _) _) with (dot a a + 2 * k * dot a e + k * (k * dot e e)) by (unfold e; by_components; ring).
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

(** A point of the polygon, as a + (p e + q f) / m. *)
Lemma point_of_quotients a e f m p q : 0 < m ->
  times m (plus (plus a (times (p / m) e)) (times (q / m) f)) =
  plus (plus (times m a) (times p e)) (times q f).
Proof. intros Hm. by_components. f_equal; field; lra. Qed.

Lemma expansion a b c x :
  plus (plus (times (dot x (cross b c)) a) (times (dot x (cross c a)) b)) (times (dot x (cross a b)) c) =
  times (dot a (cross b c)) x.
Proof. by_components. f_equal; ring. Qed.

Lemma square_of_times k a : dot (times k a) (times k a) = k * k * dot a a.
Proof. by_components. ring. Qed.

(** Face: the foot of the perpendicular in the polygon's plane is a + u e + v f. *)
Lemma foot_in_plane a e f D :
  let n := cross e f in
  let u := dot n (cross f a) / dot n n in
  let v := dot n (cross a e) / dot n n in
  0 < dot n n -> dot n a * dot n a <= D * D * dot n n ->
  let x := plus (plus a (times u e)) (times v f) in dot x x <= D * D.
Proof.
  intros n u v Hn Hd x. assert (Ex : times (dot n n) x = times (dot a n) n).
  { unfold x, u, v. rewrite point_of_quotients by exact Hn. exact (expansion a e f n). }
  apply (f_equal (fun y => dot y y)) in Ex. cbv beta in Ex. rewrite !square_of_times in Ex.
  replace (dot a n) with (dot n a) in Ex by (unfold dot; ring).
  apply (Rmult_le_reg_l (dot n n * dot n n)); [nra |]. rewrite Ex. nra.
Qed.

Lemma quotient_in_unit x m : 0 < m -> 0 <= x <= m -> 0 <= x / m <= 1.
Proof.
  intros Hm Hx. split; [apply Rmult_le_pos; [| left; apply Rinv_0_lt_compat]; lra |].
  apply (Rmult_le_reg_r m); [exact Hm |]. unfold Rdiv. rewrite Rmult_assoc, Rinv_l; lra.
Qed.

(** ** Polygons: what all queries have in common *)

Definition is_polygon (ws : list vector) : Prop :=
  match ws with
  | [a; b; c] => True
  | [a; b; c; f] => f = plus (minus a b) c
  | _ => False
  end.

(** A polygon in a convex set; f is the corner before a. *)
Definition is_polygon_in (H : vector -> Prop) (a b c f : vector) (rest : list vector) : Prop :=
  convex H /\ is_polygon (a :: b :: c :: rest) /\ (forall w, In w (a :: b :: c :: rest) -> H w) /\
  f = match rest with [] => c | f :: _ => f end.

Lemma polygon_point H a b c f rest p q m : is_polygon_in H a b c f rest -> 0 < m -> 0 <= p -> 0 <= q ->
  match rest with [] => p + q <= m | _ => p <= m /\ q <= m end ->
  H (plus (plus a (times (p / m) (minus b a))) (times (q / m) (minus f a))).
Proof.
  intros (C & P & J & Ef) Hm Hp Hq E. assert (p <= m /\ q <= m) by (destruct rest; lra).
  assert (S : (p + q) / m = p / m + q / m) by (field; lra). pose proof (quotient_in_unit (p + q) m Hm).
  pose proof (quotient_in_unit p m Hm ltac:(lra)). pose proof (quotient_in_unit q m Hm ltac:(lra)).
  set (x := p / m) in *. set (y := q / m) in *. clearbody x y.
  assert (T : x + y <= 1 -> H (plus (plus a (times x (minus b a))) (times y (minus f a)))).
  { intros L. replace (plus _ _) with (plus (plus (times (1 - x - y) a) (times x b)) (times y f))
      by (clear; by_components; f_equal; ring).
    assert (H f) by (apply J; subst f; destruct rest; cbn [In]; auto).
    apply C; try assumption; try (apply J; cbn [In]; tauto); lra. }
  destruct (Rle_lt_dec (x + y) 1) as [L | L]; [exact (T L) |].
  destruct rest as [| f' [|]]; [lra | | contradiction]. cbn [is_polygon] in P. subst f'. subst f.
  replace (plus _ _) with (plus (plus (times (x + y - 1) c) (times (1 - y) b)) (times (1 - x) (plus (minus a b) c)))
    by (clear; by_components; f_equal; ring).
  apply C; try (apply J; cbn [In]; tauto); lra.
Qed.

Lemma face_contact H a b c f rest D : is_polygon_in H a b c f rest -> let n := cross (minus b a) (minus c a) in
  0 < dot n n -> 0 <= dot n (cross a b) -> 0 <= dot n (cross b c) ->
  match rest with [] => 0 <= dot n (cross c a) | f :: _ => 0 <= dot n (cross c f) /\ 0 <= dot n (cross f a) end ->
  dot n a * dot n a <= D * D * dot n n -> exists x, H x /\ dot x x <= D * D.
Proof.
  intros I n Hn Hab Hbc Hca Hd. pose proof I as (_ & P & _ & Ef).
  assert (En : n = cross (minus b a) (minus f a) /\ 0 <= dot n (cross f a) /\
    match rest with [] => dot n (cross f a) + dot n (cross a b) <= dot n n
    | _ => dot n (cross f a) <= dot n n /\ dot n (cross a b) <= dot n n end).
  { subst f. destruct rest as [| f [|]]; [| cbn [is_polygon] in P | contradiction].
    - repeat split; [exact Hca |]. replace (dot n n) with (dot n (cross b c) + dot n (cross c a) + dot n (cross a b))
        by (unfold n; clear; by_components; ring). lra.
    - assert (dot n (cross f a) + dot n (cross b c) = dot n n) by (subst n f; clear; by_components; ring).
      assert (dot n (cross a b) + dot n (cross c f) = dot n n) by (subst n f; clear; by_components; ring).
      repeat split; try lra. subst n f. clear. by_components. f_equal; ring. }
  destruct En as (En & Hfa & Hr). clear P. clearbody n. subst n.
  pose proof (foot_in_plane a (minus b a) (minus f a) D Hn Hd) as P. set (n := cross (minus b a) (minus f a)) in *. cbv zeta in P.
  replace (cross (minus f a) a) with (cross f a) in P by (clear; by_components; f_equal; ring).
  replace (cross a (minus b a)) with (cross a b) in P by (clear; by_components; f_equal; ring).
  eexists. split; [| exact P]. exact (polygon_point H a b c f rest _ _ _ I Hn Hfa Hab Hr).
Qed.

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
  - rewrite square_of_times, sqrt_mult; [| nra | apply square_nonnegative]. rewrite sqrt_square by exact Hk. reflexivity.
Qed.

(** The hull, enlarged. *)
Definition enlarged (k : R) (q : query) (t : R) (x : vector) : Prop :=
  exists y, in_hull q t y /\ x = times k y.

Lemma enlarged_is_convex k q t : convex (enlarged k q t).
Proof.
  intros a b c i j l (x & Hx & ->) (y & Hy & ->) (z & Hz & ->) Hi Hj Hl E.
  exists (plus (plus (times i x) (times j y)) (times l z)).
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
