// The view of a query: time, zoom and window of time.
//
// The place is that of the contact, or of the nearest points. The zoom goes from a radius that
// contains the whole motion to one in which the gap fills the picture; the window of time shrinks
// with it, to the time in which points cross the picture. All of these are chosen in doubles, and
// then treated as exact.

import { absolute, add, compare, log2, multiply, one, rational, shortText, subtract, zero } from "./exact.js";
import { Frame } from "./frame.js";
import { likelyNearestTime, minus, Motion, times } from "./motion.js";
import { positionIn } from "./timeline.js";

/// Steps of the time slider.
export const steps = 4096;

/// The least ratio of the visible part to the gap, with which contact is enlarged.
const leastZoom = 40;
const marginForGap = 1;  // log2 of the radius over the gap

const largest = (vectors) => vectors.flat().reduce((a, b) => {
  const size = b < 0n ? -b : b;
  return size > a ? size : a;
}, 0n);

/// Both ends of the motion and, on curves, times between them.
function timesOf(motion) {
  const parts = motion.isStraight ? 1 : 16;
  return Array.from({ length: parts + 1 }, (_, i) => ({ n: BigInt(i), d: BigInt(parts) }));
}

/// The derivatives of a polynomial curve at its control points, which bound its speed.
const fastest = (control) =>
  control.slice(1).map((point, j) => times(BigInt(control.length - 1), minus(point, control[j])));

/// log2 of n/d; by default of 1.
const lg = (n, d) => (n === 0n ? 0 : log2({ n, d }));

export class Look {
  constructor(facts) {
    this.facts = facts;
    this.motion = new Motion(facts);
    this.star = this.starTime();
    this.zoom = 0;
    this.isFollowing = false;
    this.t = this.star;
    const state = this.motion.at(this.star);
    const near = this.motion.nearest(state);
    this.place = { vector: near.points[0].map((x, k) => x + near.points[1][k]), d: 2n * near.d };
    this.measure(state, near);
    this.reframe();
  }

  starTime() {
    const { truth, approach } = this.facts;
    if (truth && truth.toi) return truth.toi.time;
    return approach ? approach.time : likelyNearestTime(this.motion);
  }

  /// The radii at both ends of the zoom, and the speed of the points, as powers of two.
  measure(state, near) {
    const { motion, place } = this;
    const scale = 1n << motion.shift;
    const away = motion.control.flat().map((point) => point.map((x, k) => x * place.d - place.vector[k] * scale));
    this.lgAll = lg(largest(away), place.d * scale) + 0.35;
    const farthest = timesOf(motion).map((t) => motion.at(t)).map((state) => ({ n: largest(motion.corners(state)), d: state.d }))
      .reduce((a, b) => (compare(b, a) > 0 ? b : a));
    this.lgCorners = lg(farthest.n, farthest.d) + 0.35;
    const speed = largest(motion.control.flatMap(fastest));
    // Unzoomed, the window is all of the time, also if a curve is longer than the picture.
    this.lgSpeed = speed === 0n ? null : Math.min(lg(speed, scale), this.lgAll + 1);
    this.lgEnd = Math.min(this.lgAll, this.lgCorners) - leastZoom;
    if (near.squared.n > 0n && !this.collides()) this.lgEnd = Math.min(log2(near.squared) / 2 + marginForGap, this.lgAll);
  }

  /// True if the gap is 0 at the shown time, or negligible.
  collides() {
    const { truth, min_separation } = this.facts;
    return Boolean(truth && truth.toi && min_separation === 0);
  }

  /// True if the window of time is a single point, without a choice.
  get canZoom() {
    return this.lgEnd < this.lgAll;
  }

  zoomTo(zoom) {
    this.zoom = Math.max(0, Math.min(1, zoom));
    this.isFollowing = false;
    this.reframe();
  }

  /// Zooms in by a factor.
  zoomBy(factor) {
    this.zoomTo(this.zoom + Math.log2(factor) / Math.max(this.lgAll - this.lgEnd, 1));
  }

  follow(isFollowing) {
    this.isFollowing = isFollowing;
    this.reframe();
  }

  setTime(t) {
    this.t = t;
    if (this.isFollowing) this.reframe();
  }

  setStep(k) {
    const { from, to } = this.window;
    const part = { n: BigInt(k), d: BigInt(steps) };
    this.setTime(add(from, multiply(subtract(to, from), part)));
  }

  get step() {
    return Math.round(steps * positionIn(this.window, this.t));
  }

  reframe() {
    const between = (far) => far + (Math.min(this.lgEnd, far) - far) * this.zoom;
    let [lgMotion, lgCorners] = [between(this.lgAll), between(this.lgCorners)];
    let { place } = this;
    this.window = this.isFollowing ? { from: zero, to: one } : this.windowFor(lgMotion);
    if (compare(this.t, this.window.from) < 0 || compare(this.t, this.window.to) > 0) this.t = this.star;
    if (this.isFollowing) {
      const near = this.motion.nearest(this.motion.at(this.t));
      place = { vector: near.points[0].map((x, k) => x + near.points[1][k]), d: 2n * near.d };
      const lgGap = near.squared.n === 0n ? this.lgEnd : Math.max(log2(near.squared) / 2 + marginForGap, this.lgEnd);
      [lgMotion, lgCorners] = [Math.min(lgGap, this.lgAll), Math.min(lgGap, this.lgCorners)];
    }
    this.frame = new Frame(place.vector, place.d, lgMotion);
    this.cornerFrame = new Frame([0n, 0n, 0n], 1n, lgCorners);
  }

  /// The times around the place in which a point crosses the picture a few times.
  windowFor(lgMotion) {
    const lgHalf = this.lgSpeed === null ? 1 : lgMotion + 1 - this.lgSpeed;
    if (lgHalf >= 0) return { from: zero, to: one };
    const whole = Math.floor(lgHalf);
    const half = multiply(rational(2 ** (lgHalf - whole)), { n: 1n, d: 1n << BigInt(-whole) });
    const [from, to] = [subtract(this.star, half), add(this.star, half)];
    return { from: from.n < 0n ? zero : from, to: compare(to, one) > 0 ? one : to };
  }

  /// The subinterval of the certificate at the time.
  get subinterval() {
    const { certificate } = this.facts;
    if (!certificate) return null;
    return certificate.subintervals.find(({ from, to }) => compare(from, this.t) <= 0 && compare(this.t, to) <= 0) || null;
  }

  /// A time as text: a number of digits, and its distance from the time of the place.
  timeText(time, digits) {
    const { truth, approach } = this.facts;
    const name = truth && truth.toi ? "toi" : approach ? "nearest" : "";
    const difference = subtract(time, this.star);
    const sign = difference.n < 0n ? "−" : "+";
    const away = difference.n === 0n ? "" : ` ${sign} ${shortText({ n: absolute(difference.n), d: difference.d }, 4)}`;
    return shortText(time, digits) + (name && ` (${name}${away})`);
  }
}
