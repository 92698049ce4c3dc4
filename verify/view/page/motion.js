// A query in motion: the positions of its points at a rational time, its corners, and its nearest
// points, all exact (docs/theory.md, sections 1.1 to 1.3). A straight line is a Bézier curve of degree 1.
//
// A vector is three integers. Vectors of one time have one denominator.

import { absolute, compare, dyadic, squareRoot } from "./exact.js";

export const axes = ["x", "y", "z"];
const names = { "vertex-face": ["v", "f0", "f1", "f2"], "edge-edge": ["ea0", "ea1", "eb0", "eb1"] };

/// The corners: pairs of points, and (u,v).
const cornerPairs = {
  "vertex-face": [[0, 1, 0, 0], [0, 2, 1, 0], [0, 3, 0, 1]],
  "edge-edge": [[0, 2, 0, 0], [1, 2, 1, 0], [1, 3, 1, 1], [0, 3, 0, 1]],
};

/// The primitives, each by its points.
const primitives = { "vertex-face": [[0], [1, 2, 3]], "edge-edge": [[0, 1], [2, 3]] };

export const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
export const minus = (a, b) => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
const plus = (a, b) => [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
export const times = (s, a) => [s * a[0], s * a[1], s * a[2]];
export const cross = (a, b) =>
  [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];

/// The curves of the four points, each a list of control points x, y, z and their weights.
function curvesOf({ coordinates, control, weights }) {
  const lists = control || [0, 1].map((end) =>
    [0, 1, 2, 3].map((i) => coordinates.slice(12 * end + 3 * i, 12 * end + 3 * i + 3)));
  return [0, 1, 2, 3].map((i) => lists.map((list, j) => ({ point: list[i], weight: weights ? weights[j][i] : 1 })));
}

/// The least n ≥ 0 with which all doubles times 2^n are integers, and a double times 2^n.
const shiftFor = (doubles) => BigInt(Math.max(0, ...doubles.map((x) => -dyadic(x).e)));
function shifted(x, shift) {
  const { m, e } = dyadic(x);
  return m << (shift + BigInt(e));
}

/// De Casteljau's algorithm on vectors at t, times the denominator of t to the power of the degree.
function pointAt(control, t) {
  const rest = t.d - t.n;
  let points = control;
  while (points.length > 1) {
    points = points.slice(1).map((next, j) => next.map((x, k) => rest * points[j][k] + t.n * x));
  }
  return points[0];
}

export class Motion {
  /// \param facts those of a query (facts.js), finite, with positive weights
  constructor(facts) {
    const { kind } = facts;
    this.kind = kind;
    this.names = names[kind];
    this.primitives = primitives[kind];
    this.pairs = cornerPairs[kind];
    const curves = curvesOf(facts);
    this.shift = shiftFor(curves.flat().flatMap(({ point }) => point));
    const shiftOfWeights = shiftFor(curves.flat().map(({ weight }) => weight));
    /// The control points of each curve: vectors over 2^shift.
    this.control = curves.map((curve) => curve.map(({ point }) => point.map((x) => shifted(x, this.shift))));
    /// The same, each times its weight, and the weight.
    this.weighted = curves.map((curve, i) => curve.map(({ weight }, j) => {
      const factor = shifted(weight, shiftOfWeights);
      return [...times(factor, this.control[i][j]), factor];
    }));
    /// The weights of each curve as doubles; null if all are 1.
    this.weights = facts.weights ? curves.map((curve) => curve.map(({ weight }) => weight)) : null;
    /// True if points and corners move on straight lines. Differences of rational curves of any degree do not.
    this.isStraight = this.weights === null && curves.every((curve) => curve.length <= 2);
  }

  /// The positions of the points at time t: vectors over `d`.
  at(t) {
    const weighted = this.weighted.map((curve) => pointAt(curve, t));
    const weights = weighted.map(([, , , weight]) => weight);
    // Curves of one degree and the same weights have one denominator.
    const common = [...new Set(weights)].reduce((product, weight) => product * weight);
    return {
      points: weighted.map(([x, y, z, weight]) => times(common / weight, [x, y, z])),
      d: common << this.shift,
    };
  }

  corners({ points }) {
    return this.pairs.map(([a, b]) => minus(points[a], points[b]));
  }

  /// The nearest points of the two primitives: the squared distance as a rational, (u,v), and both points.
  nearest(state) {
    const corners = this.corners(state);
    const found = nearestToOrigin(corners, this.pairs);
    const { u, v, d } = found.place;
    const p = state.points;
    const [a, b] = this.kind === "vertex-face"
      ? [times(d, p[0]), plus(times(d - u - v, p[1]), plus(times(u, p[2]), times(v, p[3])))]
      : [plus(times(d - u, p[0]), times(u, p[1])), plus(times(d - v, p[2]), times(v, p[3]))];
    return {
      squared: { n: found.squared.n, d: found.squared.d * state.d * state.d },
      u: { n: u, d }, v: { n: v, d },
      points: [a, b], d: d * state.d,
    };
  }

  gap(state) {
    return squareRoot(this.nearest(state).squared);
  }
}

/// The point of a polygon of corners nearest to the origin: its squared distance, and (u,v) over one denominator.
///
/// It is a corner, the foot of a perpendicular on a side, or on the polygon's plane: the nearest of
/// these points that is on the polygon.
function nearestToOrigin(corners, pairs) {
  const found = [];
  corners.forEach((w, i) => {
    found.push({ squared: { n: dot(w, w), d: 1n }, place: { u: BigInt(pairs[i][2]), v: BigInt(pairs[i][3]), d: 1n } });
  });
  corners.forEach((w, i) => {
    const j = (i + 1) % corners.length;
    const side = minus(corners[j], w);
    const length = dot(side, side);
    const along = -dot(w, side);
    if (along <= 0n || along >= length) return;
    const mix = (k) => BigInt(pairs[i][k]) * (length - along) + BigInt(pairs[j][k]) * along;
    found.push({ squared: { n: dot(w, w) * length - along * along, d: length },
      place: { u: mix(2), v: mix(3), d: length } });
  });
  const w = corners[0];
  const [a, b] = [minus(corners[1], w), minus(corners[corners.length - 1], w)];
  const normal = cross(a, b);
  const area = dot(normal, normal);
  const isInside = area > 0n && corners.every((one, i) =>
    dot(cross(minus(corners[(i + 1) % corners.length], one), one), normal) <= 0n);
  if (isInside) {
    const height = dot(w, normal);
    found.push({ squared: { n: height * height, d: area },
      place: { u: -dot(cross(w, b), normal), v: -dot(cross(a, w), normal), d: area } });
  }
  return found.reduce((best, one) => (compare(one.squared, best.squared) < 0 ? one : best));
}

/// The direction that a feature of a certificate names, at the corners of some time, as a unit
/// vector of doubles (docs/theory.md, sections 3.2 and 3.3); null if it is 0.
export function directionOf(feature, corners) {
  const words = feature.split(" ");
  const axis = (k) => axes.map((name) => (name === words[k] ? 1n : 0n));
  const sign = words[words.length - 1] === "-" ? -1n : 1n;
  const corner = (k) => corners[Number(words[k])];
  const exact = {
    vertex: () => corner(1),
    edge: () => {
      const side = minus(corner(2), corner(1));
      return minus(times(dot(side, side), corner(1)), times(dot(corner(1), side), side));
    },
    face: () => times(sign, cross(minus(corners[1], corners[0]), minus(corners[2], corners[0]))),
    axis: () => times(sign, axis(1)),
    cross: () => cross(axis(1), minus(corner(3), corner(2))),
  }[words[0]]();
  return unit(exact);
}

function unit(vector) {
  const largest = vector.map(absolute).reduce((a, b) => (a > b ? a : b));
  if (largest === 0n) return null;
  const rounded = vector.map((x) => Number((x << 60n) / largest));
  const length = Math.hypot(...rounded);
  return rounded.map((x) => x / length);
}

/// For a query without truth: a time at which the distance of its primitives is nearly least. It
/// comes from samples, and is used only for the view.
export function likelyNearestTime(motion) {
  const at = (n, d) => ({ t: { n, d }, squared: motion.nearest(motion.at({ n, d })).squared });
  const samples = Array.from({ length: 65 }, (_, i) => at(BigInt(i), 64n));
  let best = samples.reduce((a, b) => (compare(b.squared, a.squared) < 0 ? b : a));
  let step = 128n;
  for (let i = 0; i < 60; ++i, step *= 2n) {
    const middle = { n: best.t.n * (step / best.t.d), d: step };
    for (const n of [middle.n - 1n, middle.n + 1n]) {
      if (n < 0n || n > step) continue;
      const tried = at(n, step);
      if (compare(tried.squared, best.squared) < 0) best = tried;
    }
    if (best.t.d !== step) best = { t: middle, squared: best.squared };
  }
  return best.t;
}
