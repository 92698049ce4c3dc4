(** Polynomials on an interval, by their Bernstein coefficients.

    A *form* c_0 … c_n is the polynomial Σ c_k r^(n-k) s^k, where r = 1-u and s = u: from the start
    (u=0) to the end (u=1) of an interval. c_k is the k-th Bernstein coefficient times a binomial, so
    the product is a convolution, and a form without a negative coefficient is nowhere negative. *)

Require Import ZArith Reals List Lia Lra Psatz Bool.
Import ListNotations.
Open Scope R_scope.

Definition form := list Z.

Fixpoint value (f : form) (r s : R) : R :=
  match f with
  | [] => 0
  | c :: f' => IZR c * r ^ length f' + s * value f' r s
  end.

(** The value of a form at u. *)
Definition at_u (u : R) (f : form) : R := value f (1 - u) u.

(** ** Products *)

(** The coefficients of c·b·r^k + t, where t has k coefficients more than b, or none. *)
Fixpoint add_multiple (c : Z) (b t : form) : form :=
  match b, t with
  | [], _ => t
  | x :: b', [] => (c * x)%Z :: add_multiple c b' []
  | x :: b', y :: t' => (c * x + y)%Z :: add_multiple c b' t'
  end.

Fixpoint mul (a b : form) : form :=
  match a with
  | [] => []
  | c :: a' =>
      match b with
      | [] => []
      | x :: b' => (c * x)%Z :: add_multiple c b' (mul a' b)
      end
  end.

Lemma add_multiple_nil c b r s :
  value (add_multiple c b []) r s = IZR c * value b r s /\
  length (add_multiple c b []) = length b.
Proof.
  induction b as [| x b [IH IHl]]; cbn [add_multiple value length]; [split; [ring | reflexivity] |].
  rewrite IHl, IH, mult_IZR. split; ring.
Qed.

Lemma add_multiple_value c k r s : forall b t, length t = (length b + k)%nat ->
  value (add_multiple c b t) r s = IZR c * r ^ k * value b r s + value t r s /\
  length (add_multiple c b t) = length t.
Proof.
  induction b as [| x b IH]; intros t E; [destruct t; cbn [add_multiple value length]; (split; [ring | reflexivity]) |].
  destruct t as [| y t]; [discriminate |]. cbn [add_multiple value length] in *.
  destruct (IH t ltac:(lia)) as [V L]. rewrite L, V, plus_IZR, mult_IZR.
  replace (length t) with (length b + k)%nat by lia. rewrite pow_add. split; [ring | reflexivity].
Qed.

Lemma mul_length a : forall x b c, length (mul (c :: a) (x :: b)) = S (length a + length b).
Proof.
  induction a as [| d a IH]; intros x b c.
  - cbn [mul length]. rewrite (proj2 (add_multiple_nil c b 0 0)). reflexivity.
  - specialize (IH x b d). remember (d :: a) as a'. cbn [mul length].
    destruct (add_multiple_value c (length a') 0 0 b (mul a' (x :: b))) as [_ L].
    + rewrite IH. subst a'. cbn [length]. lia.
    + rewrite L, IH. subst a'. cbn [length]. lia.
Qed.

Lemma mul_value a b r s : value (mul a b) r s = value a r s * value b r s.
Proof.
  destruct b as [| x b]; [destruct a; cbn [mul value]; ring |].
  induction a as [| c a IH]; [cbn [mul value]; ring |].
  destruct a as [| d a].
  - cbn [mul value length]. destruct (add_multiple_nil c b r s) as [V L].
    rewrite V, L, mult_IZR. simpl (r ^ 0). ring.
  - pose proof (mul_length a x b d) as L0. remember (d :: a) as a'.
    cbn [mul]. cbn [value].
    destruct (add_multiple_value c (length a') r s b (mul a' (x :: b))) as [V L].
    + rewrite L0. subst a'. cbn [length]. lia.
    + rewrite V, IH, L, L0, mult_IZR.
      replace (S (length a + length b)) with (length a' + length b)%nat by (subst a'; cbn [length]; lia).
      rewrite pow_add. cbn [value]. ring.
Qed.

(** ** Sums

    The shorter form is multiplied by r+s = 1. *)

Fixpoint same_length (a b : form) : bool :=
  match a, b with
  | [], [] => true
  | _ :: a', _ :: b' => same_length a' b'
  | _, _ => false
  end.

Fixpoint add_equal (a b : form) : form :=
  match a, b with
  | x :: a', y :: b' => (x + y)%Z :: add_equal a' b'
  | _, _ => []
  end.

Fixpoint elevate (n : nat) (f : form) : form :=
  match n with
  | O => f
  | S n' => elevate n' (mul [1%Z; 1%Z] f)
  end.

Definition add (a b : form) : form :=
  match a, b with
  | [], _ => b
  | _, [] => a
  | _, _ =>
      if same_length a b then add_equal a b
      else add_equal (elevate (length b - length a) a) (elevate (length a - length b) b)
  end.

Definition scale (k : Z) (f : form) : form := map (Z.mul k) f.
Definition sub (a b : form) : form := add a (scale (-1) b).

Lemma same_length_true a : forall b, same_length a b = true -> length a = length b.
Proof. induction a; intros [| y b] E; simpl in *; try discriminate; auto. Qed.

Lemma add_equal_value r s : forall a b, length a = length b ->
  value (add_equal a b) r s = value a r s + value b r s /\ length (add_equal a b) = length a.
Proof.
  induction a as [| x a IH]; intros [| y b] E; try discriminate; cbn [add_equal value length] in *;
    [split; [ring | reflexivity] |].
  destruct (IH b ltac:(lia)) as [V L]. rewrite V, L, plus_IZR.
  replace (length b) with (length a) by lia. split; [ring | reflexivity].
Qed.

Lemma elevate_length n : forall c f, length (elevate n (c :: f)) = (n + S (length f))%nat.
Proof.
  induction n as [| n IH]; intros c f; cbn [elevate]; [reflexivity |].
  pose proof (mul_length [1%Z] c f 1%Z) as L. destruct (mul [1%Z; 1%Z] (c :: f)) as [| d g];
    [discriminate |]. rewrite IH. cbn [length] in L. lia.
Qed.

Lemma elevate_value n r s : r + s = 1 -> forall f, value (elevate n f) r s = value f r s.
Proof.
  intros E. induction n as [| n IH]; intros f; cbn [elevate]; [reflexivity |].
  rewrite IH, mul_value. cbn [value length]. simpl pow.
  replace (1 * (r * 1) + s * (1 * 1 + s * 0)) with (r + s) by ring. rewrite E. ring.
Qed.

Lemma at_u_mul u a b : at_u u (mul a b) = at_u u a * at_u u b.
Proof. apply mul_value. Qed.

Lemma at_u_add u a b : at_u u (add a b) = at_u u a + at_u u b.
Proof.
  unfold at_u. destruct a as [| x a], b as [| y b]; try (cbn [add value]; ring).
  unfold add. destruct (same_length _ _) eqn:E.
  - apply add_equal_value. apply same_length_true. exact E.
  - unshelve refine (eq_trans (proj1 (add_equal_value _ _ _ _ _)) _).
    + rewrite !elevate_length. cbn [length]. lia.
    + rewrite !elevate_value by ring. reflexivity.
Qed.

Lemma at_u_scale u k a : at_u u (scale k a) = IZR k * at_u u a.
Proof.
  unfold at_u. induction a as [| x a IH]; cbn [scale map value]; [ring |].
  unfold scale in IH. rewrite IH, map_length, mult_IZR. ring.
Qed.

Lemma at_u_sub u a b : at_u u (sub a b) = at_u u a - at_u u b.
Proof. unfold sub. rewrite at_u_add, at_u_scale. simpl. ring. Qed.

Lemma at_u_constant u c : at_u u [c] = IZR c.
Proof. unfold at_u. cbn [value length]. simpl. ring. Qed.

Lemma at_u_linear u a b : at_u u [a; b] = (1 - u) * IZR a + u * IZR b.
Proof. unfold at_u. cbn [value length]. simpl. ring. Qed.

(** ** Substitution

    A form of r and s, where these are forms themselves. *)

(** The powers of r that belong to the coefficients of a form. *)
Fixpoint powers (r f : form) : list form :=
  match f with
  | [] => []
  | _ :: f' =>
      let rest := powers r f' in
      match rest with [] => [1%Z] | p :: _ => mul r p end :: rest
  end.

Fixpoint substitute (powers : list form) (s f : form) : form :=
  match f, powers with
  | c :: f', p :: rest => add_multiple c p (mul s (substitute rest s f'))
  | _, _ => []
  end.

Section Substitution.
Variables (r s : form) (x y : R).
Hypothesis Hr : r <> [].
Hypothesis Hrs : length r = length s.

Let degree := pred (length r).

Lemma mul_length_by_degree g b : length g = length r -> b <> [] -> length (mul g b) = (degree + length b)%nat.
Proof.
  unfold degree. intros E Hb. destruct g as [| c g], b as [| z b]; try congruence; [destruct r; [congruence | discriminate] |].
  rewrite mul_length, <- E. cbn [length pred]. lia.
Qed.

Lemma powers_value c : forall f, exists p, powers r (c :: f) = p :: powers r f /\
  value p x y = value r x y ^ length f /\ length p = S (length f * degree).
Proof.
  intros f. revert c. induction f as [| d f IH]; intros c.
  - exists [1%Z]. repeat split. cbn [value length]. simpl. ring.
  - destruct (IH d) as (p & E & V & L). exists (mul r p). split; [injection E as E'; cbn [powers]; rewrite E'; reflexivity |].
    rewrite mul_value, V, mul_length_by_degree, L by (reflexivity || (intros ->; discriminate)).
    cbn [length]. split; [reflexivity | lia].
Qed.

Theorem substitute_value f : value (substitute (powers r f) s f) x y = value f (value r x y) (value s x y) /\
  length (substitute (powers r f) s f) = match f with [] => O | _ :: f' => S (length f' * degree) end.
Proof.
  induction f as [| c f [IH L]]; [split; reflexivity |].
  destruct (powers_value c f) as (p & E & V & Lp). rewrite E. cbn [substitute value].
  destruct f as [| d f].
  - replace (mul s _) with (@nil Z) by (cbn [substitute]; destruct s; reflexivity).
    destruct (add_multiple_nil c p x y) as [Va La]. rewrite Va, La, V, Lp. cbn [value length]. split; [ring | reflexivity].
  - destruct (add_multiple_value c 0 x y p (mul s (substitute (powers r (d :: f)) s (d :: f)))) as [Va La].
    + rewrite mul_length_by_degree, L, Lp; [cbn [length]; lia | congruence | intros N; rewrite N in L; discriminate].
    + rewrite Va, La, mul_value, IH, V, mul_length_by_degree, L; [| congruence | intros N; rewrite N in L; discriminate].
      cbn [length]. simpl (value r x y ^ 0). split; [simpl; ring | lia].
Qed.
End Substitution.

Lemma powers_of_same_length r : forall f g, length f = length g -> powers r f = powers r g.
Proof.
  induction f as [| c f IH]; intros [| d g] E; try discriminate; [reflexivity |].
  cbn [powers]. rewrite (IH g) by (cbn [length] in E; lia). reflexivity.
Qed.

(** ** Binomials *)

Definition binomials (n : nat) : form := elevate n [1%Z].

Lemma nth_add_multiple c : forall b t k,
  nth k (add_multiple c b t) 0%Z = (c * nth k b 0 + nth k t 0)%Z.
Proof.
  induction b as [| x b IH]; intros t k; [destruct k, t; cbn [add_multiple nth]; lia |].
  destruct t as [| y t], k; cbn [add_multiple nth]; rewrite ?IH; cbn [nth]; try lia. destruct k; lia.
Qed.

Lemma elevate_last n : forall f, elevate (S n) f = mul [1%Z; 1%Z] (elevate n f).
Proof. induction n as [| n IH]; intros f; [reflexivity |]. exact (IH (mul [1%Z; 1%Z] f)). Qed.

Lemma pascal_rule f k : nth (S k) (mul [1%Z; 1%Z] f) 0%Z = (nth k f 0 + nth (S k) f 0)%Z.
Proof.
  destruct f as [| x f]; [destruct k; reflexivity |]. cbn [mul nth]. rewrite nth_add_multiple.
  destruct k as [| k]; cbn [nth mul]; [lia |]. rewrite nth_add_multiple. destruct k; cbn [nth]; lia.
Qed.

Lemma C_0 n : C n 0 = 1.
Proof. unfold C. rewrite Nat.sub_0_r. simpl (INR (fact 0)). field. apply INR_fact_neq_0. Qed.

Lemma binomials_are_C : forall n k, (k <= n)%nat -> IZR (nth k (binomials n) 0%Z) = C n k.
Proof.
  unfold binomials. induction n as [| n IH]; intros k Hk; [replace k with O by lia; rewrite C_0; reflexivity |].
  rewrite elevate_last. destruct k as [| k].
  - rewrite C_0, <- (C_0 n), <- (IH O ltac:(lia)). destruct (elevate n [1%Z]); cbn [mul nth]; [reflexivity | f_equal; lia].
  - rewrite pascal_rule, plus_IZR, (IH k ltac:(lia)). destruct (Nat.eq_dec k n) as [-> | N].
    + rewrite (pascal_step1 n n), (pascal_step1 (S n) (S n)), !Nat.sub_diag, !C_0, nth_overflow by
        (rewrite ?elevate_length; cbn [length]; lia). simpl. ring.
    + rewrite IH, pascal by lia. reflexivity.
Qed.

Lemma value_is_sum r s f : value f r s =
  let n := (length f - 1)%nat in sum_f_R0 (fun k => IZR (nth k f 0%Z) * r ^ (n - k) * s ^ k) n.
Proof.
  cbv zeta. induction f as [| c f IH]; [simpl; ring |]. destruct f as [| d f]; [simpl; ring |].
  remember (d :: f) as g. cbn [value length]. rewrite IH, (decomp_sum _ (S (length g) - 1)) by (subst g; cbn [length]; lia).
  rewrite scal_sum. replace (S (length g) - 1)%nat with (length g) by lia.
  replace (pred (length g)) with (length g - 1)%nat by lia. f_equal; [cbn [nth]; rewrite Nat.sub_0_r; simpl; ring |].
  apply sum_eq. intros k Hk. cbn [nth]. replace (length g - S k)%nat with (length g - 1 - k)%nat by lia. simpl pow. ring.
Qed.

Definition is_zero (f : form) : bool := forallb (Z.eqb 0) f.

Lemma is_zero_value f r s : is_zero f = true -> value f r s = 0.
Proof.
  induction f as [| c f IH]; cbn [is_zero forallb value]; [reflexivity |].
  intros E. apply andb_prop in E as [E1 E2]. apply Z.eqb_eq in E1. subst c.
  unfold is_zero in IH. rewrite (IH E2). ring.
Qed.

(** ** Positive on an interval *)

Lemma value_append c r s : forall f, value (f ++ [c]) r s = r * value f r s + IZR c * s ^ length f.
Proof.
  induction f as [| x f IH]; cbn [app value length]; [simpl; ring |].
  rewrite IH, app_length, Nat.add_1_r. cbn [length]. simpl pow. ring.
Qed.

Lemma value_rev r s : forall f, value (rev f) r s = value f s r.
Proof.
  induction f as [| x f IH]; cbn [rev value]; [reflexivity |].
  rewrite value_append, IH, rev_length. ring.
Qed.

Lemma value_homogeneous k r s : forall f c,
  value (c :: f) (k * r) (k * s) = k ^ length f * value (c :: f) r s.
Proof.
  induction f as [| d f IH]; intros c.
  - cbn [value length]. simpl. ring.
  - specialize (IH d). remember (d :: f) as g. cbn [value length]. rewrite IH. subst g.
    cbn [length]. simpl pow. rewrite !Rpow_mult_distr. ring.
Qed.

(** The form times r + 2s, and 2p r^n besides. *)
Fixpoint times_r_2s (p : Z) (f : form) : form :=
  match f with
  | [] => [(2 * p)%Z]
  | x :: f' => (x + 2 * p)%Z :: times_r_2s x f'
  end.

(** The form with r + 2s in the place of s: the upper half of the interval, times 2^n. *)
Fixpoint half (f : form) : form :=
  match f with
  | [] => []
  | c :: f' =>
      match half f' with
      | [] => [c]
      | x :: g => (c + x)%Z :: times_r_2s x g
      end
  end.

Lemma times_r_2s_value r s : forall f p,
  value (times_r_2s p f) r s = (r + 2 * s) * value f r s + 2 * IZR p * r ^ length f /\
  length (times_r_2s p f) = S (length f).
Proof.
  induction f as [| x f IH]; intros p; cbn [times_r_2s value length].
  - rewrite mult_IZR. simpl. split; [ring | reflexivity].
  - destruct (IH x) as [V L]. rewrite V, L, plus_IZR, mult_IZR. simpl pow. split; [ring | reflexivity].
Qed.

Lemma half_value r s : forall f, value (half f) r s = value f r (r + 2 * s) /\ length (half f) = length f.
Proof.
  induction f as [| c f [IH L]]; cbn [half]; [split; reflexivity |].
  cbn [value length]. rewrite <- IH, <- L.
  destruct (half f) as [| x g]; cbn [value length]; [simpl; split; [ring | reflexivity] |].
  destruct (times_r_2s_value r s g x) as [V L']. rewrite V, L', plus_IZR. simpl pow.
  split; [ring | reflexivity].
Qed.

(** True if the form is positive for all u in [0,1]. *)
Fixpoint is_positive (bisections : nat) (f : form) : bool :=
  (0 <? hd 0 f)%Z && (0 <? last f 0)%Z &&
  (forallb (Z.leb 0) f ||
   match bisections with
   | O => false
   | S n => is_positive n (half f) && is_positive n (half (rev f))
   end).

Lemma value_nonnegative r s : 0 <= r -> 0 <= s -> forall f, forallb (Z.leb 0) f = true ->
  0 <= value f r s.
Proof.
  intros Hr Hs. induction f as [| c f IH]; cbn [forallb value]; intros E; [lra |].
  apply andb_prop in E as [E1 E2]. apply Z.leb_le, IZR_le in E1. specialize (IH E2).
  pose proof (pow_le r (length f) Hr). nra.
Qed.

Lemma value_at_end : forall f, value f 0 1 = IZR (last f 0%Z).
Proof.
  induction f as [| c f IH]; cbn [value last]; [reflexivity |].
  destruct f as [| d f]; [cbn [value length]; simpl; ring |].
  rewrite IH. cbn [length]. simpl pow. ring.
Qed.

Lemma half_is_positive f u : 0 < at_u (2 * u - 1) (half f) -> 0 < at_u u f.
Proof.
  unfold at_u. rewrite (proj1 (half_value _ _ _)). intros H. destruct f as [| c f]; [cbn [value] in H; lra |].
  replace (1 - (2 * u - 1)) with (2 * (1 - u)) in H by ring.
  replace (2 * (1 - u) + 2 * (2 * u - 1)) with (2 * u) in H by ring.
  rewrite value_homogeneous in H. assert (0 < 2 ^ length f) by (apply pow_lt; lra). nra.
Qed.

Theorem is_positive_sound n : forall f u, is_positive n f = true -> 0 <= u <= 1 -> 0 < at_u u f.
Proof.
  induction n as [| n IH]; intros f u E Hu; cbn [is_positive] in E; rewrite !andb_true_iff, orb_true_iff in E;
    destruct E as ((Hhd & Hlast) & Hall); apply Z.ltb_lt in Hhd, Hlast; (destruct f as [| c f]; [discriminate Hhd |]).
  all: assert (Hplain : forallb (Z.leb 0) (c :: f) = true -> 0 < at_u u (c :: f)).
  1,3: unfold at_u; intros E; destruct (Req_dec u 1) as [-> | Hne];
    [ replace (1 - 1) with 0 by ring; rewrite value_at_end; apply IZR_lt; exact Hlast
    | cbn [forallb] in E; apply andb_prop in E as [_ E]; cbn [value];
      pose proof (value_nonnegative (1 - u) u ltac:(lra) ltac:(lra) f E);
      pose proof (pow_lt (1 - u) (length f) ltac:(lra)); apply IZR_lt in Hhd; cbn [hd] in Hhd; nra ].
  all: destruct Hall as [Hall | Hall]; [exact (Hplain Hall) |]; try discriminate Hall.
  apply andb_prop in Hall as [Hup Hdown]. destruct (Rle_dec (1 / 2) u).
  - apply half_is_positive, (IH _ _ Hup). lra.
  - replace (at_u u (c :: f)) with (at_u (1 - u) (rev (c :: f)))
      by (unfold at_u; rewrite value_rev; f_equal; ring). apply half_is_positive, (IH _ _ Hdown). lra.
Qed.

(** ** Zero at a root

    Pseudo-division, from the coefficients of r^n on. *)

(** The coefficients of d·p - c·g·r^k, where p has k coefficients more than g. *)
Fixpoint reduce (d c : Z) (p g : form) : option form :=
  match p, g with
  | _, [] => Some (scale d p)
  | [], _ :: _ => None
  | x :: p', y :: g' => option_map (cons (d * x - c * y)%Z) (reduce d c p' g')
  end.

(** True if g divides p. [steps] has as many elements as p. Where d divides c already, p is not multiplied. *)
Fixpoint divides (steps : list Z) (g p : form) : bool :=
  is_zero p ||
  match steps, p, g with
  | _ :: steps', c :: p', d :: g' =>
      let k := (c / d)%Z in
      match (if (k * d =? c)%Z then reduce 1 k p' g' else reduce d c p' g') with
      | Some rest => divides steps' g rest
      | None => false
      end
  | _, _, _ => false
  end.

Lemma scale_value k r s f : value (scale k f) r s = IZR k * value f r s.
Proof.
  induction f as [| x f IH]; cbn [scale map value]; [ring |].
  unfold scale in IH. rewrite IH, map_length, mult_IZR. ring.
Qed.

Lemma reduce_value d c r s : forall g p rest, reduce d c p g = Some rest -> exists k,
  length p = (length g + k)%nat /\ length rest = length p /\
  value rest r s = IZR d * value p r s - IZR c * r ^ k * value g r s.
Proof.
  induction g as [| y g IH]; intros p rest E.
  - assert (rest = scale d p) as -> by (destruct p; inversion E; reflexivity).
    exists (length p). rewrite scale_value. unfold scale. rewrite map_length. cbn [value length].
    repeat split. ring.
  - destruct p as [| x p]; [discriminate |]. cbn [reduce] in E.
    destruct (reduce d c p g) as [rest' |] eqn:E'; [| discriminate]. inversion E; subst rest.
    destruct (IH _ _ E') as (k & L & L' & V). exists k. cbn [length value].
    rewrite V, L', L, minus_IZR, !mult_IZR, pow_add. repeat split; try lia. ring.
Qed.

Theorem divides_sound r s : forall steps g p, hd 0%Z g <> 0%Z -> value g r s = 0 ->
  divides steps g p = true -> value p r s = 0.
Proof.
  induction steps as [| x steps IH]; intros g p Hg Hroot E; cbn [divides] in E;
    apply orb_prop in E as [E | E]; try (apply is_zero_value; exact E); try discriminate E.
  destruct p as [| c p]; [reflexivity |]. destruct g as [| d g]; [discriminate |].
  cbv zeta in E. cbn [hd] in Hg. assert (Hd : IZR d <> 0) by (intros H; apply Hg; apply eq_IZR; exact H).
  assert (exists d' c', d' <> 0%Z /\ IZR c * IZR d' = IZR c' * IZR d /\
    match reduce d' c' p g with Some rest => divides steps (d :: g) rest | None => false end = true)
    as (d' & c' & Hd' & Ec & E').
  { destruct (_ =? c)%Z eqn:Ek; [exists 1%Z, (c / d)%Z | exists d, c]; repeat split; auto; try lia; try ring.
    apply Z.eqb_eq in Ek. rewrite <- Ek at 1. rewrite mult_IZR. ring. }
  clear E. destruct (reduce d' c' p g) as [rest |] eqn:Er; [| discriminate].
  specialize (IH (d :: g) _ Hg Hroot E'). destruct (reduce_value d' c' r s _ _ _ Er) as (k & L & _ & V).
  cbn [value] in *. rewrite L, pow_add.
  apply (Rmult_eq_reg_l (IZR d')); [| intros H; apply Hd', eq_IZR; exact H].
  assert (IZR d' * value p r s = IZR c' * r ^ k * value g r s) as Hv by lra.
  replace (IZR d' * (IZR c * (r ^ length g * r ^ k) + s * value p r s))
    with (r ^ k * r ^ length g * (IZR c * IZR d') + s * (IZR d' * value p r s)) by ring.
  rewrite Hv, Ec.
  replace (r ^ k * r ^ length g * (IZR c' * IZR d) + s * (IZR c' * r ^ k * value g r s))
    with (IZR c' * r ^ k * (IZR d * r ^ length g + s * value g r s)) by ring.
  rewrite Hroot. ring.
Qed.

(** ** A root between two signs *)

Lemma at_u_continuous f : continuity (fun u => at_u u f).
Proof.
  unfold at_u. induction f as [| c f IH]; cbn [value].
  - apply continuity_const. intros x y. reflexivity.
  - apply (continuity_plus (fun u => IZR c * (1 - u) ^ length f) (fun u => u * value f (1 - u) u)); [reg |].
    apply (continuity_mult (fun u => u)); [reg | exact IH].
Qed.

Definition changes_sign (f : form) : bool := (hd 0 f * last f 0 <? 0)%Z.

Theorem changes_sign_sound f : changes_sign f = true ->
  hd 0%Z f <> 0%Z /\ exists u, 0 <= u <= 1 /\ at_u u f = 0.
Proof.
  unfold changes_sign. intros E. apply Z.ltb_lt in E. split; [intros H; rewrite H in E; lia |].
  destruct (IVT_cor (fun u => at_u u f) 0 1 (at_u_continuous f) ltac:(lra)) as (u & Hu & H0).
  - unfold at_u. rewrite Rminus_0_r. replace (1 - 1) with 0 by ring. rewrite value_at_end.
    assert (value f 1 0 = IZR (hd 0%Z f)) as ->.
    { destruct f as [| c f]; cbn [value hd]; [reflexivity |]. rewrite pow1. ring. }
    rewrite <- mult_IZR. apply IZR_le. lia.
  - exists u. split; assumption.
Qed.
