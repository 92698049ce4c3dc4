(** The proof that what the checker of steps accepts is true. *)

Require Import ZArith QArith Qreals Reals List Lia Lra Psatz Bool FMapPositive.
Import ListNotations.
Require Import Verified.Problem Verified.StepProblem Verified.Geometry Verified.Checker Verified.Proof Verified.Step.
Open Scope Z_scope.

(** ** Sets *)

Lemma key_injective x y : key x = key y -> x = y.
Proof. destruct x, y; cbn; intros E; try discriminate E; inversion E; reflexivity. Qed.

Lemma find_added {A} (m : map_of A) x (a : A) y b :
  find_in (add_to x a m) y = Some b -> y = x /\ b = a \/ find_in m y = Some b.
Proof.
  unfold find_in, add_to. destruct (Z.eq_dec y x) as [-> | N].
  - rewrite PositiveMap.gss. intros E. inversion E. auto.
  - rewrite PositiveMap.gso by (intros E; apply N, key_injective, E). auto.
Qed.

Lemma find_empty {A} y (b : A) : find_in empty y = Some b -> False.
Proof. unfold find_in, empty. rewrite PositiveMap.gempty. discriminate. Qed.

Lemma has_find m z : has m z = true <-> exists u, find_in m z = Some u.
Proof.
  unfold has. destruct (find_in m z) as [u |]; [split; eauto |].
  split; [discriminate | intros [u E]; discriminate].
Qed.

Lemma has_added x m z : has (with_number x m) z = true -> z = x \/ has m z = true.
Proof.
  rewrite !has_find. intros [u E]. apply find_added in E as [[-> _] | E]; eauto.
Qed.

Lemma has_pair_added a b m x y : has_pair (with_pair a b m) x y = true ->
  x = a /\ y = b \/ has_pair m x y = true.
Proof.
  unfold has_pair, with_pair, at_number at 1.
  destruct (find_in (add_to _ _ _) x) as [n |] eqn:E.
  - apply find_added in E as [[-> ->] | E].
    + intros H. apply has_added in H as [-> | H]; auto.
    + intros H. right. unfold at_number. rewrite E. exact H.
  - intros H. apply has_find in H as [u H]. apply find_empty in H. contradiction.
Qed.

Lemma nothing_in_empty x : has (@empty unit) x = true -> False.
Proof. rewrite has_find. intros [u E]. exact (find_empty _ _ E). Qed.
Lemma no_pair_in_empty x y : has_pair (@empty numbers) x y = true -> False.
Proof.
  unfold has_pair, at_number. destruct (find_in empty x) eqn:E; [destruct (find_empty _ _ E) | apply nothing_in_empty].
Qed.

(** ** Lists *)

Lemma in_sides s e : In e (side_list s) <-> In e (sides s).
Proof.
  unfold side_list, sides. cut (forall fs l, In e (fold_left (fun l t => let '(a, b, c) := t in
    (a, b) :: (b, c) :: (c, a) :: l) fs l) <->
    In e l \/ In e (flat_map (fun f => let '(a, b, c) := f in [(a, b); (b, c); (c, a)]) fs)).
  { intros H. rewrite H. cbn. tauto. }
  induction fs as [| [[a b] c] fs IH]; intros l; cbn [fold_left flat_map app In]; [tauto |]. rewrite IH. cbn [In]. tauto.
Qed.

Lemma in_lines s e : In e (line_list s) <-> In e (sides s ++ edges s).
Proof. unfold line_list. rewrite rev_append_rev, !in_app_iff, <- in_rev, in_sides. tauto. Qed.

Lemma every_line f s : forallb f (line_list s) = true -> forall a b, In (a, b) (sides s ++ edges s) -> f (a, b) = true.
Proof. rewrite forallb_forall. intros E a b I. apply E, in_lines, I. Qed.

(** What a fold gathers has come from somewhere. *)
Lemma fold_from {A B} (P : A -> Prop) (f : A -> B -> A) l :
  (forall x e, In e l -> P x -> P (f x e)) -> forall x, P x -> P (fold_left f l x).
Proof.
  induction l as [| e l IH]; cbn [fold_left]; intros S x H; [exact H |].
  apply IH; [intros; apply S; cbn; auto | apply S; cbn; auto].
Qed.

Lemma ends_sound s v : has (ends (line_list s)) v = true ->
  exists a b, In (a, b) (sides s ++ edges s) /\ a <> b /\ (v = a \/ v = b).
Proof.
  unfold ends. revert v.
  apply (fold_from (fun m => forall v, has m v = true ->
    exists a b, In (a, b) (sides s ++ edges s) /\ a <> b /\ (v = a \/ v = b))).
  - intros m [a b] I H v. apply in_lines in I. unfold is_loop. cbn [fst snd]. destruct (Z.eqb_spec a b) as [_ | N]; [apply H |].
    intros E. apply has_added in E as [-> | E]; [exists a, b; auto |].
    apply has_added in E as [-> | E]; [exists a, b; auto | apply H, E].
  - intros v E. destruct (nothing_in_empty _ E).
Qed.

Lemma sides_in_sound s x y : has_pair (sides_in s) x y = true ->
  exists a b, In (a, b) (sides s) /\ x = Z.min a b /\ y = Z.max a b.
Proof.
  unfold sides_in. revert x y.
  apply (fold_from (fun m => forall x y, has_pair m x y = true ->
    exists a b, In (a, b) (sides s) /\ x = Z.min a b /\ y = Z.max a b)).
  - intros m [a b] I H x y E. apply in_sides in I. cbn [fst snd] in E. apply has_pair_added in E as [[-> ->] | E];
      [exists a, b; auto | apply H, E].
  - intros x y E. destruct (no_pair_in_empty _ _ E).
Qed.

(** ** Plans *)

Fixpoint is_planned (e : element) (l : Z) (p : plan) : Prop :=
  match p with
  | one e' l' _ => e = e' /\ l = l'
  | two p q => is_planned e l p \/ is_planned e l q
  end.
Definition is_in_plan (e : element) (p : option plan) : Prop :=
  match p with Some p => exists l, is_planned e l p | None => False end.

Lemma fold_plans_from {A} (P : A -> Prop) f p :
  (forall e l x, is_in_plan e p -> P x -> P (f e l x)) -> forall x, P x -> P (fold_plans f p x).
Proof.
  destruct p as [p |]; [| auto]. cbn [fold_plans is_in_plan].
  induction p as [e l xs | p IHp q IHq]; cbn [fold_plan is_planned]; intros S x H.
  - apply S; eauto.
  - apply IHq; [intros e l y [k I]; apply S; eauto |]. apply IHp; [intros e l y [k I]; apply S; eauto | exact H].
Qed.

Lemma vertices_in_sound p v : has (vertices_in p) v = true -> is_in_plan [v] p.
Proof.
  unfold vertices_in. revert v. apply (fold_plans_from (fun m => forall v, has m v = true -> is_in_plan [v] p)).
  - intros e l m I H v E. destruct e as [| a [|]]; [apply H, E | | apply H, E].
    apply has_added in E as [-> | E]; [exact I | apply H, E].
  - intros v E. destruct (nothing_in_empty _ E).
Qed.

Lemma edges_in_sound p a b : has_pair (edges_in p) a b = true -> is_in_plan [a; b] p.
Proof.
  unfold edges_in. revert a b. apply (fold_plans_from (fun m => forall a b, has_pair m a b = true -> is_in_plan [a; b] p)).
  - intros e l m I H a b E. destruct e as [| x [| y [|]]]; try (apply H, E).
    apply has_pair_added in E as [[-> ->] | E]; [exact I | apply H, E].
  - intros a b E. destruct (no_pair_in_empty _ _ E).
Qed.

Lemma labelled_sound p n e : find_in (labelled p) n = Some e -> is_in_plan e p.
Proof.
  unfold labelled. revert n e. apply (fold_plans_from (fun m => forall n e, find_in m n = Some e -> is_in_plan e p)).
  - intros e l m I H n f E. apply find_added in E as [[_ ->] | E]; [exact I | eapply H, E].
  - intros n e E. destruct (find_empty _ _ E).
Qed.

Lemma has_faces_sound p fs : forall n, has_faces (labelled p) n fs = true ->
  forall a b c, In (a, b, c) fs -> is_in_plan [a; b; c] p.
Proof.
  induction fs as [| [[x y] z] fs IH]; cbn [has_faces]; intros n E a b c I; [contradiction |].
  destruct (find_in (labelled p) n) as [[| i [| j [| k [|]]]] |] eqn:F; try discriminate E.
  rewrite !andb_true_iff in E. destruct E as (((E1 & E2) & E3) & E4). apply Z.eqb_eq in E1, E2, E3. subst.
  destruct I as [I | I]; [inversion I; subst; eapply labelled_sound, F | eapply IH; eassumption].
Qed.

(** ** All elements are there *)

Lemma vertices_are_there s p e : has_vertices s (line_list s) (vertices_in p) = true -> is_vertex s e -> is_in_plan e p.
Proof.
  unfold has_vertices. intros E (v & -> & C). apply andb_prop in E as [E1 E2].
  apply vertices_in_sound. destruct C as [I | (a & b & I & C)].
  - rewrite forallb_forall in E2. apply E2, I.
  - pose proof (every_line _ _ E1 _ _ I) as H. cbn beta in H. apply andb_prop in H as [Ha Hb].
    destruct C as [-> | ->]; assumption.
Qed.

Lemma faces_are_there s p e : has_faces (labelled p) 0 (faces s) = true -> is_face s e -> is_in_plan e p.
Proof. intros E (a & b & c & -> & I). eapply has_faces_sound; eassumption. Qed.

Lemma has_edge_sound m a b x y : a < b -> (x = a /\ y = b) \/ (x = b /\ y = a) ->
  has_edge m (x, y) = true -> has_pair m a b = true.
Proof.
  intros L C E. unfold has_edge, is_loop in E. cbn [fst snd] in E. apply orb_prop in E as [E | E]; [apply Z.eqb_eq in E; lia |].
  replace (Z.min x y) with a in E by lia. replace (Z.max x y) with b in E by lia. exact E.
Qed.

Lemma edges_are_there s p e : forallb (has_edge (edges_in p)) (line_list s) = true -> is_edge s e -> is_in_plan e p.
Proof.
  intros E (a & b & -> & L & I). apply edges_in_sound.
  destruct I as [I | I]; apply (every_line _ _ E) in I.
  - exact (has_edge_sound _ a b a b L ltac:(auto) I).
  - exact (has_edge_sound _ a b b a L ltac:(auto) I).
Qed.

(** Two different ends are of an edge. *)
Lemma line_is_edge l a b : In (a, b) l -> a <> b -> is_edge_of l [Z.min a b; Z.max a b].
Proof.
  intros I N. exists (Z.min a b), (Z.max a b). split; [reflexivity |]. split; [lia |].
  destruct (Z.le_ge_cases a b) as [L | L]; [left | right].
  - rewrite Z.min_l, Z.max_r by exact L. exact I.
  - rewrite Z.min_r, Z.max_l by exact L. exact I.
Qed.

Lemma no_end_of_line s v a b : is_point s [v] -> In (a, b) (sides s ++ edges s) -> a <> b -> v = a \/ v = b -> False.
Proof.
  intros [_ N] I D C. apply (N _ v (line_is_edge _ a b I D)); [| left; reflexivity].
  cbn [In]. lia.
Qed.

Lemma points_are_there s p e : has_points s (line_list s) (vertices_in p) = true -> is_point s e -> is_in_plan e p.
Proof.
  unfold has_points. intros E P. pose proof P as [(v & -> & C) _]. apply vertices_in_sound.
  set (m := vertices_in p) in *. clearbody m.
  assert (A : forall is_there, (is_there v = true -> has m v = true) ->
    forallb is_there (points s) && forallb (fun e => negb (is_loop e) || is_there (fst e)) (line_list s) = true ->
    has m v = true).
  { intros is_there T H. apply andb_prop in H as [H1 H2]. apply T. destruct C as [I | (a & b & I & C)].
    - rewrite forallb_forall in H1. apply H1, I.
    - pose proof (every_line _ _ H2 _ _ I) as H. unfold is_loop in H. cbn [fst snd] in H. destruct (Z.eqb_spec a b) as [-> | N].
      + destruct C as [-> | ->]; exact H.
      + destruct (no_end_of_line s v a b P I N C). }
  apply orb_prop in E as [E | E]; [apply (A _ (fun H => H) E) |].
  apply (A (fun v => has m v || has (ends (line_list s)) v)) in E; [exact E |].
  intros H. apply orb_prop in H as [H | H]; [exact H |].
  apply ends_sound in H as (a & b & I & N & D). destruct (no_end_of_line s v a b P I N D).
Qed.

Lemma bare_edges_are_there s p e : has_bare_edges s (edges_in p) = true -> is_bare_edge s e -> is_in_plan e p.
Proof.
  unfold has_bare_edges. intros E [(a & b & -> & L & I) N]. apply edges_in_sound.
  set (m := edges_in p) in *. clearbody m.
  assert (exists x y, In (x, y) (edges s) /\ ((x = a /\ y = b) \/ (x = b /\ y = a))) as (x & y & I' & C).
  { destruct I as [I | I]; apply in_app_or in I as [I | I]; eauto 6;
      (exfalso; apply N; exists a, b; auto). }
  pose proof (fun m => has_edge_sound m a b x y L C) as S.
  apply orb_prop in E as [E | E]; rewrite forallb_forall in E; specialize (E _ I'); [exact (S m E) |].
  apply orb_prop in E as [H | H]; [exact (S m H) |]. apply S in H.
  apply sides_in_sound in H as (c & d & J & Ea & Eb). exfalso. apply N.
  subst. apply line_is_edge; [exact J | lia].
Qed.

(** ** Sites *)

Open Scope R_scope.

Lemma down_sound k n d : (0 < d)%Z -> IZR (down k n d) <= Q2R k * (IZR n / IZR d).
Proof.
  intros Hd. unfold down, Q2R. set (b := Z.pos (Qden k)). assert (0 < d * b)%Z as H by (unfold b; lia).
  pose proof (Z.mul_div_le (n * Qnum k) (d * b) H) as L. apply IZR_le in L. rewrite !mult_IZR in L.
  apply IZR_lt in Hd. assert (0 < IZR b) as Hb by (apply IZR_lt; unfold b; lia).
  apply (Rmult_le_reg_l (IZR d * IZR b)); [nra |].
  replace (IZR d * IZR b * (IZR (Qnum k) * / IZR b * (IZR n / IZR d))) with (IZR n * IZR (Qnum k)) by (field; lra).
  exact L.
Qed.

Lemma up_sound k n d : (0 < d)%Z -> Q2R k * (IZR n / IZR d) <= IZR (up k n d).
Proof.
  intros Hd. unfold up. pose proof (down_sound k (- n) d Hd) as L. rewrite opp_IZR in *.
  replace (- IZR n / IZR d) with (- (IZR n / IZR d)) in L; [lra |].
  field. apply not_0_IZR. lia.
Qed.

(** The enlarged coordinate from a to b is at 0, and at e, within a range. *)
Definition is_in_range (k e : R) (a b : Q) (r : range) : Prop :=
  IZR (low0 r) <= k * Q2R a <= IZR (high0 r) /\
  IZR (low1 r) <= k * ((1 - e) * Q2R a + e * Q2R b) <= IZR (high1 r).

Lemma range_of_sound k e a b : is_in_range (Q2R k) (Q2R e) a b (range_of k e a b).
Proof.
  unfold range_of, is_in_range. cbn [low0 high0 low1 high1].
  set (n := (_ + _)%Z). set (d := (_ * _ * _)%Z).
  assert (0 < d)%Z as Hd by (unfold d; lia).
  assert (IZR n / IZR d = (1 - Q2R e) * Q2R a + Q2R e * Q2R b) as En.
  { unfold n, d, Q2R. rewrite plus_IZR, !mult_IZR, minus_IZR.
    assert (forall p, IZR (Z.pos p) <> 0) as N by (intros p; apply not_0_IZR; lia).
    field. auto using N. }
  rewrite <- En. change (Q2R a) with (IZR (Qnum a) / IZR (Z.pos (Qden a))).
  pose proof (down_sound k (Qnum a) (Z.pos (Qden a)) ltac:(lia)).
  pose proof (up_sound k (Qnum a) (Z.pos (Qden a)) ltac:(lia)).
  pose proof (down_sound k n d Hd). pose proof (up_sound k n d Hd). repeat split; assumption.
Qed.

Lemma enlarged_distance_sound k d :
  Q2R k * Q2R d <= IZR (enlarged_distance k d) /\ 0 <= IZR (enlarged_distance k d).
Proof.
  unfold enlarged_distance. pose proof (up_sound k (Qnum d) (Z.pos (Qden d)) ltac:(lia)) as U.
  change (IZR (Qnum d) / IZR (Z.pos (Qden d))) with (Q2R d) in U. split.
  - eapply Rle_trans; [exact U |]. apply IZR_le. lia.
  - apply IZR_le. lia.
Qed.

Section NoContact.
Variables (c : setting) (h : hints) (m : map_of site).
Notation s := (the_step c).
Notation sum := (the_sum c).
Let k := Q2R (space c).
Let E := Q2R (upper c).
Hypothesis Hk : 0 < k.
Hypothesis HE : E <= 1.
Hypothesis Hm : m = add_sites (space c) (upper c) (reach_in s h) 0 (vertices s) (groups s) (@empty site).
Hypothesis Hgap : gap c = enlarged_distance (space c) (distance_of (separation_of s)).
Hypothesis Hheld : forall g l, has_pair (held c) g l = true -> In (g, l) (apart s) \/ In (l, g) (apart s).

Definition vertex_at (v : Z) (t : R) : vector := position (motion_of s v) t.

(** A site as it should be. *)
Definition is_site (p : site) : Prop :=
  moves p = ends_of s (number p) /\ group p = group_of s (number p) /\ reach_in s h (group p) = Some (reach_of p) /\
  forall i, is_in_range k E (component i (fst (moves p))) (component i (snd (moves p))) (component i (ranges p)).

Lemma add_sites_sound x p vs : forall n gs o,
  find_in (add_sites (space c) (upper c) (reach_in s h) n vs gs o) x = Some p -> find_in o x = Some p \/
  exists i v r, x = (n + Z.of_nat i)%Z /\ nth_error vs i = Some v /\ reach_in s h (nth i gs 0%Z) = Some r /\
    p = Site x (nth i gs 0%Z) r v (box_of_motion (space c) (upper c) v).
Proof.
  induction vs as [| v vs IH]; intros n gs o F; [left; exact F |]. cbn [add_sites] in F.
  apply IH in F as [F | (i & w & r & -> & Ew & Er & ->)].
  - destruct (reach_in s h (hd 0%Z gs)) as [r |] eqn:Er; [| left; exact F].
    apply find_added in F as [[-> ->] | F]; [| left; exact F].
    right. exists O, v, r. rewrite Z.add_0_r. destruct gs; auto.
  - right. exists (S i), w, r. replace (n + Z.of_nat (S i))%Z with (n + 1 + Z.of_nat i)%Z by lia.
    destruct gs; [destruct i |]; auto.
Qed.

Lemma sites_sound x p : find_in m x = Some p -> number p = x /\ is_site p.
Proof.
  rewrite Hm. intros F. apply add_sites_sound in F as [F | (i & v & r & -> & Ev & Er & ->)]; [destruct (find_empty _ _ F) |].
  rewrite Z.add_0_l. split; [reflexivity |]. unfold is_site, ends_of, group_of. cbn [moves number group reach_of ranges].
  rewrite Nat2Z.id, (nth_error_nth _ _ _ Ev). repeat (split; [first [reflexivity | exact Er] |]).
  intros j. destruct v as [a b], j; apply range_of_sound.
Qed.

Lemma find_sites_sound ps : forall q, find_sites m q = Some ps -> map number ps = q /\ Forall is_site ps.
Proof.
  induction ps as [| p ps IH]; intros [| v q] F; cbn [find_sites] in F; try discriminate F.
  - split; [reflexivity | constructor].
  - destruct (find_in m v); [destruct (find_sites m q) |]; discriminate F.
  - destruct (find_in m v) as [p' |] eqn:Ep; [| discriminate F].
    destruct (find_sites m q) as [ps' |] eqn:Es; [| discriminate F]. inversion F; subst p' ps'; clear F.
    apply sites_sound in Ep as [En Ip]. destruct (IH _ Es) as [Em Is]. cbn [map].
    rewrite En, Em. split; [reflexivity | constructor; assumption].
Qed.

(** ** Directions *)

Definition to_vector_of_integers (d : triple Z) : vector := Triple (IZR (x_of d)) (IZR (y_of d)) (IZR (z_of d)).

Lemma vertex_coordinate p i t : is_site p ->
  component i (vertex_at (number p) t) =
  (1 - t) * Q2R (component i (fst (moves p))) + t * Q2R (component i (snd (moves p))).
Proof.
  intros (Em & _). unfold vertex_at, motion_of, line. rewrite <- Em, straight_line. destruct i; reflexivity.
Qed.

Lemma product_bounds d lo hi x : IZR lo <= x <= IZR hi ->
  IZR (d * (if (d <? 0)%Z then hi else lo)) <= IZR d * x <= IZR (d * (if (d <? 0)%Z then lo else hi)).
Proof.
  intros H. rewrite !mult_IZR. destruct (Z.ltb_spec d 0) as [L | L]; [apply IZR_lt in L | apply IZR_le in L]; nra.
Qed.

Lemma extreme_sound lo hi d b x : (forall i, IZR (lo (component i b)) <= component i x <= IZR (hi (component i b))) ->
  IZR (extreme lo hi d b) <= dot (to_vector_of_integers d) x <= IZR (extreme hi lo d b).
Proof.
  intros H. pose proof (product_bounds (x_of d) _ _ _ (H x_axis)). pose proof (product_bounds (y_of d) _ _ _ (H y_axis)).
  pose proof (product_bounds (z_of d) _ _ _ (H z_axis)). unfold extreme, dot, to_vector_of_integers.
  cbn [component x_of y_of z_of] in *. rewrite !plus_IZR. lra.
Qed.

Lemma in_box p i : is_site p -> let r := component i (ranges p) in
  IZR (low0 r) <= component i (times k (vertex_at (number p) 0)) <= IZR (high0 r) /\
  IZR (low1 r) <= component i (times k (vertex_at (number p) E)) <= IZR (high1 r).
Proof.
  intros P. pose proof P as (_ & _ & _ & H). destruct (H i) as [H0 H1].
  assert (V : forall t, component i (times k (vertex_at (number p) t)) =
    k * ((1 - t) * Q2R (component i (fst (moves p))) + t * Q2R (component i (snd (moves p)))))
    by (intros t; rewrite <- vertex_coordinate by exact P; destruct i; reflexivity).
  cbv zeta. rewrite !V. split; [| exact H1]. rewrite Rmult_0_l, Rplus_0_r, Rminus_0_r, Rmult_1_l. exact H0.
Qed.

Definition length_1 (d : vector) : R := Rabs (x_of d) + Rabs (y_of d) + Rabs (z_of d).

Lemma dual_length_le d n : dual_length n d <= length_1 d.
Proof.
  unfold length_1. destruct n; cbn [dual_length]; [lra |].
  set (x := x_of d). set (y := y_of d). set (z := z_of d).
  pose proof (Rabs_pos x). pose proof (Rabs_pos y). pose proof (Rabs_pos z).
  rewrite <- (sqrt_square (Rabs x + Rabs y + Rabs z)) by lra. apply sqrt_le_1_alt.
  unfold dot. fold x y z.
  assert (forall a, a * a = Rabs a * Rabs a) as S by (intros a; rewrite <- Rabs_mult, Rabs_right; [reflexivity | nra]).
  rewrite (S x), (S y), (S z). nra.
Qed.

(** d keeps the vertices p above the vertices q by the distance D, at both ends. *)
Definition keeps_above (D : R) (d : vector) (p q : element) : Prop := forall v w, In v p -> In w q ->
  forall t, t = 0 \/ t = E -> D * length_1 d < dot d (minus (vertex_at v t) (vertex_at w t)).

Lemma is_above_sound r d ps qs : Forall is_site ps -> Forall is_site qs -> is_above r d ps qs = true ->
  keeps_above (IZR r / k) (to_vector_of_integers d) (map number ps) (map number qs).
Proof.
  intros P Q A v w Iv Iw t Ht. unfold is_above in A. cbv zeta in A.
  apply in_map_iff in Iv as (p & <- & Ip). apply in_map_iff in Iw as (q & <- & Iq).
  rewrite Forall_forall in P, Q. specialize (P _ Ip). specialize (Q _ Iq).
  rewrite forallb_forall in A. specialize (A _ Ip). rewrite forallb_forall in A. specialize (A _ Iq).
  apply andb_prop in A as [A0 A1]. apply Z.ltb_lt, IZR_lt in A0, A1. rewrite plus_IZR, mult_IZR, !plus_IZR, !abs_IZR in A0, A1.
  change (Rabs (IZR (x_of d)) + Rabs (IZR (y_of d)) + Rabs (IZR (z_of d))) with (length_1 (to_vector_of_integers d)) in *.
  apply (Rmult_lt_reg_l k); [exact Hk |].
  pose proof (extreme_sound low0 high0 d (ranges p) _ (fun i => proj1 (in_box p i P))).
  pose proof (extreme_sound low0 high0 d (ranges q) _ (fun i => proj1 (in_box q i Q))).
  pose proof (extreme_sound low1 high1 d (ranges p) _ (fun i => proj2 (in_box p i P))).
  pose proof (extreme_sound low1 high1 d (ranges q) _ (fun i => proj2 (in_box q i Q))).
  set (u := to_vector_of_integers d) in *.
  replace (k * (IZR r / k * length_1 u)) with (IZR r * length_1 u) by (field; lra).
  replace (k * dot u (minus (vertex_at (number p) t) (vertex_at (number q) t))) with
    (dot u (times k (vertex_at (number p) t)) - dot u (times k (vertex_at (number q) t)))
    by (generalize (vertex_at (number p) t), (vertex_at (number q) t); intros; clear; by_components; ring).
  destruct Ht as [-> | ->]; lra.
Qed.

(** ** Kept apart at both ends, and on the way *)

Lemma vertex_on_the_way v w d t :
  let f t := dot d (minus (vertex_at v t) (vertex_at w t)) in f t = (1 - t) * f 0 + t * f 1.
Proof.
  intros f. unfold f, vertex_at, motion_of, line. rewrite !straight_line.
  repeat match goal with |- context [to_vector ?a] => generalize (to_vector a) end. intros. clear. by_components. ring.
Qed.

Lemma above_on_the_way D d p q : keeps_above D d p q -> forall t, 0 <= t <= E ->
  forall v w, In v p -> In w q -> D * length_1 d < dot d (minus (vertex_at v t) (vertex_at w t)).
Proof.
  intros H t Ht v w Iv Iw. pose proof (H v w Iv Iw 0 ltac:(auto)) as H0. pose proof (H v w Iv Iw E ltac:(auto)) as H1.
  pose proof (vertex_on_the_way v w d t) as Et. pose proof (vertex_on_the_way v w d E) as EE. cbv zeta in Et, EE.
  set (f0 := dot d (minus (vertex_at v 0) (vertex_at w 0))) in *.
  set (f1 := dot d (minus (vertex_at v 1) (vertex_at w 1))) in *.
  rewrite EE in H1. rewrite Et. destruct (Rle_dec f0 f1); nra.
Qed.

Lemma corners_are_differences p q t y : p <> [] -> q <> [] -> In y (corners (query_of s p q) t) ->
  exists v w, In v p /\ In w q /\ y = minus (vertex_at v t) (vertex_at w t).
Proof.
  assert (M : forall e i, e <> [] -> exists v, In v e /\ nth i (map (motion_of s) e) (hd [] (map (motion_of s) e)) = motion_of s v).
  { intros [| v e] i N; [contradiction |]. cbn [map hd]. change (motion_of s v :: map (motion_of s) e) with (map (motion_of s) (v :: e)).
    rewrite map_nth. exists (nth i (v :: e) v). split; [| reflexivity].
    destruct (nth_in_or_default i (v :: e) v) as [I | ->]; [exact I | left; reflexivity]. }
  intros Np Nq I. pose proof (fun i => M p i Np) as Mp. pose proof (fun i => M q i Nq) as Mq. clear M.
  assert (exists i j, y = minus (position (nth i (map (motion_of s) p) (hd [] (map (motion_of s) p))) t)
    (position (nth j (map (motion_of s) q) (hd [] (map (motion_of s) q))) t)) as (i & j & ->).
  { unfold query_of, query_of_motions, corners in I. destruct (map (motion_of s) p) as [| a [| b [| d l]]];
      cbn [kind_of point0 point1 point2 point3 In] in I; repeat destruct I as [<- | I]; try contradiction; eauto. }
  destruct (Mp i) as (v & Iv & ->), (Mq j) as (w & Iw & ->). exists v, w. auto.
Qed.

Lemma no_contact_above D d p q x : p <> [] -> q <> [] -> keeps_above D d p q -> Q2R (distance_of x) <= D -> 0 <= D ->
  forall t, 0 <= t <= E -> ~ contact (query_of s p q) x t.
Proof.
  intros Np Nq H L P t Ht. apply direction_separates with d. intros y I.
  apply (corners_are_differences p q t y Np Nq) in I as (v & w & Iv & Iw & ->).
  eapply Rle_lt_trans; [| exact (above_on_the_way D d p q H t Ht v w Iv Iw)].
  pose proof (dual_length_le d (norm_of x)).
  pose proof (dual_length_nonnegative (norm_of x) d).
  apply Rle_trans with (D * dual_length (norm_of x) d);
    [apply Rmult_le_compat_r | apply Rmult_le_compat_l]; assumption.
Qed.

Lemma keeps_below D d p q : keeps_above D d q p -> keeps_above D (times (-1) d) p q.
Proof.
  intros H v w Iv Iw t Ht. specialize (H w v Iw Iv t Ht).
  replace (length_1 (times (-1) d)) with (length_1 d).
  - eapply Rlt_le_trans; [exact H |]. right.
    generalize (vertex_at v t), (vertex_at w t). intros. clear. by_components. ring.
  - unfold length_1, times. cbn [x_of y_of z_of]. rewrite !Rabs_mult, (Rabs_left (-1)) by lra. ring.
Qed.

(** ** Distances *)

Lemma groups_of_sites ps : Forall is_site ps -> map group ps = map (group_of s) (map number ps).
Proof. intros F. rewrite map_map. apply map_ext_in. rewrite Forall_forall in F. intros p I. apply (F p I). Qed.

Lemma distance_of_sites ps qs : Forall is_site ps -> Forall is_site qs ->
  distance_of_pair c ps qs = distance_of (separation_between s sum (map number ps) (map number qs)).
Proof.
  intros P Q. unfold distance_of_pair, separation_between. cbn [distance_of].
  rewrite !groups_of_sites by assumption. reflexivity.
Qed.

Lemma enlarged_between_sound ps qs : Forall is_site ps -> Forall is_site qs ->
  Q2R (distance_of (separation_between s sum (map number ps) (map number qs))) <= IZR (enlarged_between c ps qs) / k /\
  0 <= IZR (enlarged_between c ps qs) / k.
Proof.
  intros P Q. rewrite <- distance_of_sites by assumption.
  assert (k * Q2R (distance_of_pair c ps qs) <= IZR (enlarged_between c ps qs) /\ 0 <= IZR (enlarged_between c ps qs)) as [L N].
  { unfold enlarged_between, distance_of_pair, distance_between. rewrite Hgap. unfold is_thin.
    destruct (radii s), (distances s); apply enlarged_distance_sound. }
  split; [| apply Rmult_le_pos; [exact N | left; apply Rinv_0_lt_compat; exact Hk]].
  apply (Rmult_le_reg_l k); [exact Hk |]. replace (k * (IZR (enlarged_between c ps qs) / k)) with
    (IZR (enlarged_between c ps qs)) by (field; lra). exact L.
Qed.

(** ** Pairs *)

Definition never_touch (p q : element) : Prop :=
  no_contact_until (query_of s p q) (separation_between s sum p q) E.

Definition are_sites (ps : list site) : Prop := Forall is_site ps /\ ps <> [].

Lemma above_never_touch d ps qs : are_sites ps -> are_sites qs ->
  is_above (enlarged_between c ps qs) d ps qs = true \/ is_above (enlarged_between c ps qs) d qs ps = true ->
  never_touch (map number ps) (map number qs).
Proof.
  intros [P Np] [Q Nq] A. destruct (enlarged_between_sound ps qs P Q) as [L N].
  assert (map number ps <> [] /\ map number qs <> []) as [Mp Mq]
    by (split; intros M; apply map_eq_nil in M; contradiction).
  destruct A as [A | A]; apply is_above_sound in A; try assumption; [| apply keeps_below in A];
    exact (no_contact_above _ _ _ _ _ Mp Mq A L N).
Qed.

Lemma query_of_sites ps qs : Forall is_site ps -> Forall is_site qs ->
  query_between ps qs = query_of s (map number ps) (map number qs).
Proof.
  assert (M : forall es, Forall is_site es -> map (fun p => line (moves p)) es = map (motion_of s) (map number es)).
  { intros es F. rewrite map_map. apply map_ext_in. rewrite Forall_forall in F. intros p I.
    unfold motion_of. destruct (F p I) as (-> & _). reflexivity. }
  intros P Q. unfold query_between, query_of. rewrite !M by assumption. reflexivity.
Qed.

Lemma scene_between_sound ps qs sc : Forall is_site ps -> Forall is_site qs -> scene_between c ps qs = Some sc ->
  is_scene_of sc (query_of s (map number ps) (map number qs)) (separation_between s sum (map number ps) (map number qs)).
Proof.
  unfold scene_between. intros P Q H.
  rewrite query_of_sites, distance_of_sites in H by assumption. exact (scene_of_sound _ _ _ H).
Qed.

Lemma proves_sound ps qs a : are_sites ps -> are_sites qs -> proves c ps qs a = true ->
  never_touch (map number ps) (map number qs).
Proof.
  intros P Q H. unfold proves in H. destruct a as [d | xs]; [exact (above_never_touch d ps qs P Q (or_introl H)) |].
  destruct (scene_between c ps qs) as [sc |] eqn:Es; [| discriminate H].
  apply scene_between_sound in Es; [| apply P | apply Q]. intros t Ht.
  apply (all_are_free_sound _ _ (separates_sound _ _ sc Es) _ _ _ H); rewrite ?Q2R_0; unfold E in *; lra.
Qed.

Lemma common_vertex_sound ps qs : have_common_vertex ps qs = true ->
  exists v, In v (map number ps) /\ In v (map number qs).
Proof.
  unfold have_common_vertex. intros H. apply existsb_exists in H as (p & Ip & H). apply existsb_exists in H as (q & Iq & H).
  apply Z.eqb_eq in H. exists (number p). split; [apply in_map, Ip | rewrite H; apply in_map, Iq].
Qed.

Lemma held_apart_iff ps qs : Forall is_site ps -> Forall is_site qs -> are_held_apart c ps qs = true ->
  forall v w, In v (map number ps) -> In w (map number qs) -> is_held_apart s v w.
Proof.
  intros P Q H v w Iv Iw. apply in_map_iff in Iv as (p & <- & Ip). apply in_map_iff in Iw as (q & <- & Iq).
  unfold are_held_apart in H. rewrite forallb_forall in H. specialize (H _ Ip). rewrite forallb_forall in H.
  specialize (H _ Iq). apply Hheld in H. rewrite Forall_forall in P, Q.
  destruct (P _ Ip) as (_ & Ep & _), (Q _ Iq) as (_ & Eq & _). rewrite Ep, Eq in H. exact H.
Qed.

Definition is_item (x : item) : Prop := are_sites (sites x).
Definition element_of (x : item) : element := map number (sites x).

Lemma proved_with_sound ps qs o xs : are_sites ps -> are_sites qs ->
  proved_with c ps qs o xs = true -> never_touch (map number ps) (map number qs).
Proof.
  intros P Q. induction xs as [| [l a] xs IH]; cbn [proved_with]; [discriminate |].
  destruct (Z.eqb l o); [apply proves_sound; assumption | exact IH].
Qed.

Definition is_settled (p q : element) : Prop := can_collide s p q -> never_touch p q.

Lemma is_proved_sound x y : is_item x -> is_item y -> is_proved c x y = true -> is_settled (element_of x) (element_of y).
Proof.
  intros P Q H (_ & N & v & w & Iv & Iw & A). unfold is_proved in H. cbv zeta in H.
  rewrite !orb_true_iff in H. destruct H as [[[H | H] | H] | H].
  - apply common_vertex_sound in H as (u & I & J). destruct (N u I J).
  - eapply proved_with_sound; eassumption.
  - destruct A. exact (held_apart_iff _ _ (proj1 P) (proj1 Q) H v w Iv Iw).
  - apply existsb_exists in H as (d & _ & H). apply orb_prop in H. eapply above_never_touch; eassumption.
Qed.

(** ** Boxes *)

Definition reach_of_item (x : item) : Z :=
  match sites x with [] => 0%Z | p :: ps => fold_left (fun r q => Z.max r (reach_of q)) ps (reach_of p) end.

Lemma reach_is_greatest x p : In p (sites x) -> (reach_of p <= reach_of_item x)%Z.
Proof.
  unfold reach_of_item. destruct (sites x) as [| p0 ps]; [contradiction |].
  assert (G : forall ps r, (r <= fold_left (fun r q => Z.max r (reach_of q)) ps r)%Z /\
    forall q, In q ps -> (reach_of q <= fold_left (fun r q => Z.max r (reach_of q)) ps r)%Z).
  { clear. induction ps as [| p ps IH]; cbn [fold_left]; intros r; [split; [lia | contradiction] |].
    destruct (IH (Z.max r (reach_of p))) as [L H]. split; [lia |]. intros q [-> | I]; [lia | auto]. }
  destruct (G ps (reach_of p0)) as [L H]. intros [-> | I]; [exact L | auto].
Qed.

(** The box contains all sites of the element, enlarged. *)
Definition is_around (b : box) (x : item) : Prop := forall p, In p (sites x) -> forall i,
  let r := component i (ranges p) in
  let o := component i b in
  (low0 o <= low0 r - reach_of_item x /\ high0 r + reach_of_item x + gap c <= high0 o /\
   low1 o <= low1 r - reach_of_item x /\ high1 r + reach_of_item x + gap c <= high1 o)%Z.

Definition contains (b o : box) : Prop := forall i,
  (low0 (component i b) <= low0 (component i o) /\ high0 (component i o) <= high0 (component i b) /\
   low1 (component i b) <= low1 (component i o) /\ high1 (component i o) <= high1 (component i b))%Z.

Lemma around_contains a b : contains (around a b) a /\ contains (around a b) b.
Proof. split; intros i; destruct i; cbn [component around map_triple range_around x_of y_of z_of low0 high0 low1 high1]; lia. Qed.

Lemma contains_trans a b o : contains a b -> contains b o -> contains a o.
Proof. intros H G i. specialize (H i). specialize (G i). lia. Qed.

Lemma contains_around a b x : contains a b -> is_around b x -> is_around a x.
Proof. intros H G p I i. specialize (H i). specialize (G p I i). cbv zeta in *. lia. Qed.

Lemma box_around_sound p ps l xs : is_around (box_around (gap c) p ps) (Item (p :: ps) l xs).
Proof.
  unfold box_around. cbv zeta. intros q I i. cbv zeta.
  change (fold_left (fun r q => Z.max r (reach_of q)) ps (reach_of p)) with (reach_of_item (Item (p :: ps) l xs)).
  set (rho := reach_of_item (Item (p :: ps) l xs)). set (b := fold_left _ ps (ranges p)).
  assert (C : contains b (ranges q)).
  { assert (G : forall ps o, contains (fold_left (fun b q => around b (ranges q)) ps o) o /\
      forall q, In q ps -> contains (fold_left (fun b q => around b (ranges q)) ps o) (ranges q)).
    { clear. induction ps as [| p ps IH]; cbn [fold_left]; intros o; [split; [intros i; lia | contradiction] |].
      destruct (IH (around o (ranges p))) as [L H]. destruct (around_contains o (ranges p)) as [A B].
      split; [eapply contains_trans; eassumption |]. intros q [-> | I]; [eapply contains_trans; eassumption | auto]. }
    destruct (G ps (ranges p)) as [L H]. destruct I as [-> | I]; [exact L | exact (H q I)]. }
  specialize (C i). destruct i; cbn [component map_triple x_of y_of z_of low0 high0 low1 high1] in *; lia.
Qed.

Fixpoint is_leaf (x : item) (t : box_tree) : Prop :=
  match t with box_leaf _ y => x = y | box_node _ l r => is_leaf x l \/ is_leaf x r end.

Fixpoint is_sound (t : box_tree) : Prop :=
  (forall x, is_leaf x t -> is_item x /\ is_around (box_of t) x) /\
  match t with box_leaf _ _ => True | box_node _ l r => is_sound l /\ is_sound r end.

Lemma sound_leaves t : is_sound t -> forall x, is_leaf x t -> is_item x /\ is_around (box_of t) x.
Proof. destruct t; intros [H _]; exact H. Qed.

Lemma grow_sound p : forall t, grow (gap c) m p = Some t -> is_sound t /\
  forall q l, is_planned q l p -> exists x, is_leaf x t /\ element_of x = q.
Proof.
  induction p as [q l xs | p IHp q IHq]; cbn [grow]; intros t H.
  - destruct (find_sites m q) as [[| p ps] |] eqn:F; try discriminate H. inversion H; subst t; clear H.
    apply find_sites_sound in F as [En Ip]. split.
    + cbn [is_sound is_leaf box_of]. split; [| exact I]. intros x ->.
      split; [split; [exact Ip | discriminate] | apply box_around_sound].
    + intros r l' [-> _]. exists (Item (p :: ps) l xs). split; [reflexivity | exact En].
  - destruct (grow (gap c) m p) as [a |]; [| discriminate H]. destruct (grow (gap c) m q) as [b |]; [| discriminate H].
    inversion H; subst t; clear H. destruct (IHp _ eq_refl) as [Sa La], (IHq _ eq_refl) as [Sb Lb].
    destruct (around_contains (box_of a) (box_of b)) as [Ca Cb]. split.
    + cbn [is_sound is_leaf box_of]. split; [| split; assumption].
      intros x [I | I]; [destruct (sound_leaves a Sa x I) as [G A] | destruct (sound_leaves b Sb x I) as [G A]];
        (split; [exact G |]); [exact (contains_around _ _ x Ca A) | exact (contains_around _ _ x Cb A)].
    + intros r l [I | I]; [destruct (La _ _ I) as (x & Ix & Ex) | destruct (Lb _ _ I) as (x & Ix & Ex)];
        exists x; cbn [is_leaf]; auto.
Qed.

(** ** Boxes that are apart *)

Hypothesis Hr : are_reaches c h = true.

Lemma greatest_is_one xs : xs <> [] -> exists x, In x xs /\ greatest xs = greatest [x].
Proof.
  induction xs as [| x xs IH]; intros N; [contradiction |]. destruct xs as [| y xs]; [exists x; cbn; auto |].
  destruct (IH ltac:(discriminate)) as (z & Iz & Ez). remember (y :: xs) as ys.
  cbn [greatest fold_right]. fold (greatest ys). destruct (Qle_bool x (greatest ys)) eqn:L; [exists z; cbn; auto |].
  exists x. split; [left; reflexivity |]. destruct (Qle_bool x 0) eqn:Z; [| reflexivity]. exfalso.
  apply not_true_iff_false in L. apply L, Qle_bool_iff. apply Qle_bool_iff in Z. apply (Qle_trans _ _ _ Z). rewrite Ez.
  cbn [greatest fold_right]. destruct (Qle_bool z 0) eqn:Q; [apply Qle_refl | apply Qlt_le_weak, Qnot_le_lt].
  intros G. apply Qle_bool_iff in G. rewrite G in Q. discriminate Q.
Qed.

Lemma distance_of_one_pair gs hs : gs <> [] -> hs <> [] -> exists g l, In g gs /\ In l hs /\
  distance_between s sum gs hs = distance_between s sum [g] [l].
Proof.
  intros Ng Nh. destruct gs as [| g0 gs]; [contradiction |]. destruct hs as [| h0 hs]; [contradiction |].
  destruct (greatest_is_one (flat_map (fun g => map (thickness s sum g) (h0 :: hs)) (g0 :: gs))) as (x & Ix & Ex);
    [discriminate |].
  apply in_flat_map in Ix as (g & Ig & Ix). apply in_map_iff in Ix as (l & <- & Il).
  exists g, l. split; [exact Ig |]. split; [exact Il |]. unfold distance_between. rewrite Ex. reflexivity.
Qed.

Lemma reach_in_sound g r : is_thin s = false -> reach_in s h g = Some r -> In (g, r) (group_reaches h).
Proof.
  unfold reach_in. intros ->. revert g r.
  apply (fold_from (fun m => forall g r, find_in m g = Some r -> In (g, r) (group_reaches h))).
  - intros m' [a b] I H g r F. cbn [fst snd] in F. apply find_added in F as [[-> ->] | F]; [exact I | apply H, F].
  - intros g r F. destruct (find_empty _ _ F).
Qed.

Lemma reaches_suffice x y : is_item x -> is_item y ->
  (enlarged_between c (sites x) (sites y) <= gap c + reach_of_item x + reach_of_item y)%Z.
Proof.
  intros [P Np] [Q Nq]. rewrite Forall_forall in P, Q. unfold enlarged_between, distance_of_pair.
  destruct (distance_of_one_pair (map group (sites x)) (map group (sites y))) as (g & l & Ig & Il & ->);
    try (intros M; apply map_eq_nil in M; contradiction).
  apply in_map_iff in Ig as (p & <- & Ip). apply in_map_iff in Il as (q & <- & Iq).
  pose proof (reach_is_greatest x p Ip). pose proof (reach_is_greatest y q Iq).
  destruct (P _ Ip) as (_ & _ & Rp & _), (Q _ Iq) as (_ & _ & Rq & _).
  unfold are_reaches in Hr. destruct (is_thin s) eqn:Thin.
  - unfold reach_in in Rp, Rq. rewrite Thin in Rp, Rq. injection Rp as Rp. injection Rq as Rq. lia.
  - apply (reach_in_sound _ _ Thin) in Rp, Rq. cbn [orb] in Hr. rewrite forallb_forall in Hr. specialize (Hr _ Rp).
    rewrite forallb_forall in Hr. specialize (Hr _ Rq). apply Z.leb_le in Hr. cbn [fst snd] in Hr. lia.
Qed.

Definition unit_of (i : axis) : triple Z :=
  match i with x_axis => Triple 1 0 0 | y_axis => Triple 0 1 0 | z_axis => Triple 0 0 1 end%Z.

(** A box that is below another on an axis has its element below. *)
Lemma below_is_above r i a b x y : is_around a x -> is_around b y ->
  (r <= gap c + reach_of_item x + reach_of_item y)%Z ->
  is_below (component i a) (component i b) = true -> is_above r (unit_of i) (sites y) (sites x) = true.
Proof.
  intros A B R H. unfold is_below in H. apply andb_prop in H as [H0 H1].
  apply Z.ltb_lt in H0, H1. unfold is_above. apply forallb_forall. intros q Iq. apply forallb_forall. intros p Ip.
  specialize (A p Ip i). specialize (B q Iq i). cbv zeta in A, B.
  unfold extreme. cbv zeta. apply andb_true_intro.
  destruct i; cbn [unit_of component x_of y_of z_of Z.ltb Z.compare Z.abs] in *; split; apply Z.ltb_lt; lia.
Qed.

Lemma apart_never_touch a b x y : is_item x -> is_item y -> is_around a x -> is_around b y ->
  are_boxes_apart a b = true -> never_touch (element_of x) (element_of y).
Proof.
  intros Ix Iy A B H. pose proof (reaches_suffice x y Ix Iy) as R.
  assert (exists i, are_apart (component i a) (component i b) = true) as (i & Hi).
  { unfold are_boxes_apart in H. rewrite !orb_true_iff in H.
    destruct H as [[H | H] | H]; [exists x_axis | exists y_axis | exists z_axis]; exact H. }
  apply above_never_touch with (unit_of i); try assumption.
  apply orb_prop in Hi as [Hi | Hi]; [right | left]; eapply below_is_above; try eassumption. lia.
Qed.

(** ** The search meets all pairs *)

Lemma sound_halves b l r : is_sound (box_node b l r) -> is_sound l /\ is_sound r.
Proof. intros [_ H]. exact H. Qed.

(** What holds of two if they are proved, and if their boxes are apart, holds of all. *)
Lemma search_sound (R : item -> item -> Prop) f :
  (forall x y, is_item x -> is_item y -> f x y = true -> R x y) ->
  (forall a b x y, is_item x -> is_item y -> is_around a x -> is_around b y -> are_boxes_apart a b = true -> R x y) ->
  forall a b, is_sound a -> is_sound b -> search f a b = true -> forall x y, is_leaf x a -> is_leaf y b -> R x y.
Proof.
  intros F G. induction a as [ba u | ba l IHl r IHr]; induction b as [bb v | bb l' IHl' r' IHr'];
    intros Sa Sb H x y Lx Ly; pose proof (sound_leaves _ Sa x Lx) as [Ix Ax]; pose proof (sound_leaves _ Sb y Ly) as [Iy Ay];
    cbn [search] in H; apply orb_prop in H as [H | H]; try exact (G _ _ x y Ix Iy Ax Ay H); rewrite ?andb_true_iff in H.
  - cbn [is_leaf] in *. subst. exact (F u v Ix Iy H).
  - apply sound_halves in Sb as [Sl Sr]. destruct H as [Hl Hr'].
    destruct Ly as [Ly | Ly]; [exact (IHl' Sa Sl Hl x y Lx Ly) | exact (IHr' Sa Sr Hr' x y Lx Ly)].
  - apply sound_halves in Sa as [Sl Sr]. destruct H as [Hl Hr'].
    destruct Lx as [Lx | Lx]; [exact (IHl _ Sl Sb Hl x y Lx Ly) | exact (IHr _ Sr Sb Hr' x y Lx Ly)].
  - apply sound_halves in Sa as [Sl Sr], Sb as [Sl' Sr']. destruct H as [[[H1 H2] H3] H4].
    destruct Lx as [Lx | Lx], Ly as [Ly | Ly];
      [exact (IHl _ Sl Sl' H1 x y Lx Ly) | exact (IHl _ Sl Sr' H2 x y Lx Ly) |
       exact (IHr _ Sr Sl' H3 x y Lx Ly) | exact (IHr _ Sr Sr' H4 x y Lx Ly)].
Qed.

Lemma between_sound p q : between (gap c) m (is_proved c) p q = true ->
  forall a b, is_in_plan a p -> is_in_plan b q -> is_settled a b.
Proof.
  intros H a b Ia Ib. destruct p as [p |], q as [q |]; try contradiction. destruct Ia as [la Ia], Ib as [lb Ib].
  cbn [between] in H. destruct (grow (gap c) m p) as [t |] eqn:Ep; [| discriminate H].
  destruct (grow (gap c) m q) as [u |] eqn:Eq; [| discriminate H].
  destruct (grow_sound _ _ Ep) as [Sp Lp], (grow_sound _ _ Eq) as [Sq Lq].
  destruct (Lp _ _ Ia) as (x & Lx & <-), (Lq _ _ Ib) as (y & Ly & <-).
  apply (search_sound (fun x y => is_settled (element_of x) (element_of y)) (is_proved c)) with t u; auto.
  - exact is_proved_sound.
  - intros a b v w Iv Iw A B H' _. exact (apart_never_touch a b v w Iv Iw A B H').
Qed.

(** Two elements of one kind, in their order. *)
Definition is_settled_in_order (x y : item) : Prop :=
  is_before (element_of x) (element_of y) -> is_settled (element_of x) (element_of y).

Lemma in_order_sound x y : is_item x -> is_item y -> is_proved_in_order c x y = true ->
  is_settled_in_order x y /\ is_settled_in_order y x.
Proof.
  intros Ix Iy. unfold is_proved_in_order, is_settled_in_order, is_before, element_of. cbv zeta.
  destruct (Z.ltb_spec (last (map number (sites x)) 0%Z) (last (map number (sites y)) 0%Z)) as [L | L];
    intros H; split; intros B; try lia; apply is_proved_sound; assumption.
Qed.

Lemma boxes_in_order a b x y : is_item x -> is_item y -> is_around a x -> is_around b y -> are_boxes_apart a b = true ->
  is_settled_in_order x y /\ is_settled_in_order y x.
Proof.
  intros Ix Iy A B H. split; intros _ _; [exact (apart_never_touch a b x y Ix Iy A B H) |].
  apply (apart_never_touch b a y x Iy Ix B A). revert H. unfold are_boxes_apart, are_apart.
  rewrite !orb_true_iff. tauto.
Qed.

Lemma search_within_sound a : is_sound a -> search_within (is_proved_in_order c) a = true ->
  forall x y, is_leaf x a -> is_leaf y a -> is_settled_in_order x y.
Proof.
  induction a as [b u | b l IHl r IHr]; intros S H x y Lx Ly.
  - cbn [is_leaf] in *. subst. intros B. unfold is_before in B. lia.
  - cbn [search_within] in H. rewrite !andb_true_iff in H. destruct H as [[Hl Hr'] H].
    apply sound_halves in S as [Sl Sr].
    pose proof (search_sound (fun x y => is_settled_in_order x y /\ is_settled_in_order y x) (is_proved_in_order c)
      in_order_sound boxes_in_order l r Sl Sr H) as G.
    destruct Lx as [Lx | Lx], Ly as [Ly | Ly];
      [exact (IHl Sl Hl x y Lx Ly) | apply (G x y Lx Ly) | apply (G y x Ly Lx) | exact (IHr Sr Hr' x y Lx Ly)].
Qed.

Lemma within_sound p : within (gap c) m (is_proved_in_order c) p = true ->
  forall a b, is_in_plan a p -> is_in_plan b p -> is_before a b -> is_settled a b.
Proof.
  intros H a b Ia Ib. destruct p as [p |]; [| contradiction]. destruct Ia as [la Ia], Ib as [lb Ib].
  cbn [within] in H. destruct (grow (gap c) m p) as [t |] eqn:Ep; [| discriminate H].
  destruct (grow_sound _ _ Ep) as [S L]. destruct (L _ _ Ia) as (x & Lx & <-), (L _ _ Ib) as (y & Ly & <-).
  exact (search_within_sound t S H x y Lx Ly).
Qed.
End NoContact.

(** ** The claims *)

Lemma held_sound s g l : has_pair (held_in s) g l = true -> In (g, l) (apart s) \/ In (l, g) (apart s).
Proof.
  revert g l. apply (fold_from (fun m => forall g l, has_pair m g l = true -> In (g, l) (apart s) \/ In (l, g) (apart s))).
  - intros m' [a b] I H g l F. cbn [fst snd] in F. apply has_pair_added in F as [[-> ->] | F]; [auto |].
    apply has_pair_added in F as [[-> ->] | F]; [auto | apply H, F].
  - intros g l F. destruct (no_pair_in_empty _ _ F).
Qed.

Lemma no_contact_sound s sum h e : proves_no_contact (setting_of s sum e h) (sites_of s e h) h = true ->
  Q2R e <= 1 -> no_contact_to s sum e.
Proof.
  set (c := setting_of s sum e h). unfold proves_no_contact. change (the_step c) with s. rewrite !andb_true_iff.
  intros (((((((((((Hk & Hr) & Hv) & Hf) & He) & Hp) & Hp2) & Hb) & Svf) & See) & Spb) & Spp) He1 p q C.
  assert (0 < Q2R (space c)) as K.
  { apply Z.ltb_lt in Hk. unfold Q2R. apply Rmult_lt_0_compat; [apply IZR_lt, Hk | apply Rinv_0_lt_compat, IZR_lt; lia]. }
  pose proof (fun p q => between_sound c h (sites_of s e h) K He1 eq_refl eq_refl (held_sound s) Hr p q) as B.
  pose proof (fun p => within_sound c h (sites_of s e h) K He1 eq_refl eq_refl (held_sound s) Hr p) as W.
  pose proof C as (D & _). destruct D as [[Ip Iq] | [(Ip & Iq & O) | [[Ip Iq] | (Ip & Iq & O)]]].
  - apply (B _ _ Svf p q); [eapply vertices_are_there | eapply faces_are_there | ]; eassumption.
  - apply (W _ See p q); try (eapply edges_are_there; eassumption); assumption.
  - apply (B _ _ Spb p q); [eapply points_are_there | eapply bare_edges_are_there | ]; eassumption.
  - apply (W _ Spp p q); try (eapply points_are_there; eassumption); assumption.
Qed.

(** ** The contact *)

Lemma seems_face_sound s p : seems_face s p = true -> is_face s p.
Proof.
  destruct p as [| a [| b [| d [|]]]]; try discriminate. cbn [seems_face]. intros H.
  apply existsb_exists in H as ([[x y] z] & I & H). rewrite !andb_true_iff, !Z.eqb_eq in H.
  destruct H as [[-> ->] ->]. exists a, b, d. auto.
Qed.

Lemma joins_iff l a b : existsb (joins a b) l = true <-> In (a, b) l \/ In (b, a) l.
Proof.
  rewrite existsb_exists. unfold joins. split.
  - intros ([x y] & I & H). cbn [fst snd] in H. rewrite orb_true_iff, !andb_true_iff, !Z.eqb_eq in H.
    destruct H as [[-> ->] | [-> ->]]; auto.
  - intros [I | I]; eexists; (split; [exact I |]); cbn [fst snd]; rewrite !Z.eqb_refl, ?orb_true_r; reflexivity.
Qed.

Lemma seems_edge_iff l l' p : (forall e, In e l <-> In e l') -> seems_edge_of l p = true <-> is_edge_of l' p.
Proof.
  intros S. unfold is_edge_of. destruct p as [| a [| b [| c p]]]; cbn [seems_edge_of];
    try (split; [discriminate | intros (? & ? & E & _); discriminate E]).
  rewrite andb_true_iff, Z.ltb_lt, joins_iff, !S. split; [intros [L I]; exists a, b; auto |].
  intros (x & y & E & L & I). injection E as -> ->. auto.
Qed.

Lemma seems_bare_edge_sound s p : seems_bare_edge s p = true -> is_bare_edge s p.
Proof.
  intros H. apply andb_prop in H as [E N]. split; [apply (seems_edge_iff _ _ _ (in_lines s)), E |]. intros G.
  apply (seems_edge_iff _ _ _ (in_sides s)) in G. rewrite G in N. discriminate N.
Qed.

Lemma has_end_iff v e : has_end v e = true <-> v = fst e \/ v = snd e.
Proof. unfold has_end. rewrite orb_true_iff, !Z.eqb_eq. tauto. Qed.

Lemma seems_vertex_sound s p : seems_vertex s p = true -> is_vertex s p.
Proof.
  destruct p as [| v [|]]; try discriminate. cbn [seems_vertex]. intros H. exists v. split; [reflexivity |].
  rewrite orb_true_iff, !existsb_exists in H. destruct H as [(w & I & H) | ([a b] & I & H)].
  - left. apply Z.eqb_eq in H. subst. exact I.
  - right. exists a, b. split; [apply in_lines, I | exact (proj1 (has_end_iff v (a, b)) H)].
Qed.

Lemma seems_point_sound s p : seems_point s p = true -> is_point s p.
Proof.
  destruct p as [| v [|]]; try discriminate. cbn [seems_point]. intros H. apply andb_prop in H as [V N].
  split; [apply seems_vertex_sound, V |]. intros e w (a & b & -> & L & I) Iw [-> | []].
  apply negb_true_iff in N. apply not_true_iff_false in N. apply N, existsb_exists.
  destruct I as [I | I]; apply in_lines in I; eexists; (split; [exact I |]); unfold is_loop;
    rewrite andb_true_iff, negb_true_iff, Z.eqb_neq, has_end_iff; cbn [fst snd In] in *; lia.
Qed.

Lemma contact_of_sound s sum h e lower upper p q x :
  proves_contact_of (setting_of s sum e h) (sites_of s e h) lower upper p q x = true ->
  can_collide s p q /\ (0 <= Q2R lower -> Q2R upper <= 1 -> contact_between (query_of s p q) (separation_between s sum p q) (Q2R lower) (Q2R upper)).
Proof.
  set (c := setting_of s sum e h). unfold proves_contact_of. intros H. destruct x as [x |]; [| discriminate H].
  destruct (find_sites (sites_of s e h) p) as [ps |] eqn:P; [| discriminate H].
  destruct (find_sites (sites_of s e h) q) as [qs |] eqn:Q; [| discriminate H].
  apply (find_sites_sound c h (sites_of s e h) eq_refl) in P as [<- P], Q as [<- Q].
  apply andb_prop in H as [C H]. unfold seem_to_collide in C. change (the_step c) with s in C. cbv zeta in C.
  apply andb_prop in C as [C A]. apply andb_prop in C as [S N].
  assert (can_collide s (map number ps) (map number qs)) as K.
  { split; [| split].
    - rewrite !orb_true_iff, !andb_true_iff in S. unfold seems_before in S. rewrite !Z.ltb_lt in S.
      destruct S as [[[[S1 S2] | [[S1 S2] S3]] | [S1 S2]] | [[S1 S2] S3]].
      + left. split; [apply seems_vertex_sound, S1 | apply seems_face_sound, S2].
      + right. left. split; [apply (seems_edge_iff _ _ _ (in_lines s)), S1 |].
        split; [apply (seems_edge_iff _ _ _ (in_lines s)), S2 | exact S3].
      + right. right. left. split; [apply seems_point_sound, S1 | apply seems_bare_edge_sound, S2].
      + right. right. right. split; [apply seems_point_sound, S1 |]. split; [apply seems_point_sound, S2 | exact S3].
    - intros v Iv Iw. apply negb_true_iff in N. apply not_true_iff_false in N. apply N.
      apply in_map_iff in Iv as (p & <- & Ip). apply in_map_iff in Iw as (q & Eq & Iq).
      apply existsb_exists. exists p. split; [exact Ip |]. apply existsb_exists. exists q. split; [exact Iq |].
      apply Z.eqb_eq. auto.
    - apply existsb_exists in A as (x' & Ix & A). apply existsb_exists in A as (y' & Iy & A).
      exists (number x'), (number y'). split; [apply in_map, Ix |]. split; [apply in_map, Iy |]. intros G.
      rewrite Forall_forall in P, Q. destruct (P _ Ix) as (_ & Gx & _), (Q _ Iy) as (_ & Gy & _).
      change (the_step c) with s in Gx, Gy. unfold is_held_apart in G. rewrite <- Gx, <- Gy in G.
      apply joins_iff in G. rewrite G in A. discriminate A. }
  split; [exact K |].
  destruct (scene_between c ps qs) as [sc |] eqn:Es; [| discriminate H].
  apply (scene_between_sound c h) in Es; try assumption. exact (event_sound _ _ (contact_sound _ _ sc Es) _ _ _ H).
Qed.

(** Every accepted claim is true. *)
Theorem check_step_sound sum s claim h contact : check_step sum s claim h contact = true -> step_holds s sum claim.
Proof.
  unfold check_step. intros H. destruct claim as [upper | lower upper p q]; cbn [step_holds].
  - rewrite !andb_true_iff in H. destruct H as ((L & U) & H). apply Qle_bool_iff, Qle_Rle in L, U.
    rewrite Q2R_0 in L. rewrite Q2R_1 in U. split; [lra | exact (no_contact_sound s sum h upper H U)].
  - apply andb_prop in H as [C H]. apply contact_of_sound in C as [C T]. split; [exact C |].
    apply orb_prop in H as [H | H]; rewrite !andb_true_iff in H.
    + destruct H as [L U]. apply Qeq_bool_eq, Qeq_eqR in L, U. rewrite Q2R_0 in L, U. split; [apply T |]; lra.
    + destruct H as [[[L U] N] H]. apply Qle_bool_iff, Qle_Rle in L, U. rewrite Q2R_0 in L. rewrite Q2R_1 in U.
      apply less_by_bool in N.
      split; [exact (T L U) |]. split; [exact L |]. split; [exact U |]. right.
      split; [assumption | apply (no_contact_sound s sum h lower H); lra].
Qed.

Print Assumptions check_step_sound.
