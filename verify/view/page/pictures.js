// The two pictures of a query: its primitives in motion, and its corners around the origin.
//
// Traces, which do not depend on the time, are computed once for a frame and a window of time; the
// rest is computed for each time.

import { clipped, seenPoint, toNumbers } from "./frame.js";

/// The outlines of a trace: at both ends of the window, and between them.
const ghosts = 13;
/// Parts of a curve between two of them.
const partsOfCurve = 4;

/// Both primitives have a colour; one has round points, the other boxes.
export const looks = [{ color: "s1", shape: "ball" }, { color: "s3", shape: "box" }];

/// The corners of a polygon, with the first repeated.
export const outline = (points) => (points.length > 2 ? [...points, points[0]] : points);
export const sides = (points) => points.slice(1).map((point, i) => [points[i], point]);

/// The times of the traces.
function traceTimes({ isStraight }, { from, to }) {
  const count = (ghosts - 1) * (isStraight ? 1 : partsOfCurve);
  return Array.from({ length: count + 1 }, (_, i) => {
    const [before, after] = [BigInt(count - i), BigInt(i)];
    return { n: from.n * to.d * before + to.n * from.d * after, d: from.d * to.d * BigInt(count) };
  });
}

/// The traces of moving polygons: at each time a list of polygons of exact points.
function traces({ isStraight }, frames) {
  const shapes = frames[0].length;
  const pathFrames = isStraight ? [frames[0], frames[frames.length - 1]] : frames;
  const ghostFrames = frames.filter((_, i) => i % ((frames.length - 1) / (ghosts - 1)) === 0);
  return Array.from({ length: shapes }, (_, k) => {
    const paths = frames[0][k].map((_, i) => sides(pathFrames.map((frame) => frame[k][i])).map(clipped));
    const states = ghostFrames.map((frame) => sides(outline(frame[k])).map(clipped));
    const strips = [];
    for (let i = 1; i < frames.length; ++i) {
      sides(outline(frames[i - 1][k])).forEach(([a, b], s) => {
        const [c, d] = sides(outline(frames[i][k]))[s];
        strips.push(clipped([a, b, d]), clipped([a, d, c]));
      });
    }
    return { paths, ends: [states[0], states[ghosts - 1]], between: states.slice(1, -1), strips };
  });
}

/// \param shapes the polygons at a time, each a list of exact points
function drawTraces(scene, { motion, window }, shapes) {
  const all = traces(motion, traceTimes(motion, window).map((t) => shapes(motion.at(t))));
  scene.begin(scene.still);
  scene.setExtent(all.flatMap(({ paths, ends }) => [...paths.flat(), ...ends.flat()].flat()));
  all.forEach((trace, k) => {
    const { color } = looks[k % 2];
    scene.surfaces(trace.strips, color, 0.05);
    scene.lines(trace.between.flat(), color, 0.16);
    scene.lines(trace.ends.flat(), color, 0.6);
    scene.lines(trace.paths.flat(), color, 0.9, 0.03);
    for (const path of trace.paths) drawArrow(scene, path, color);
  });
}

const difference = ([from, to]) => to.map((x, k) => x - from[k]);
const lengthOf = (segment) => Math.hypot(...difference(segment));

/// A mark at the end of a path of segments, if it is visible.
function drawArrow(scene, path, color) {
  const seen = path.filter((segment) => segment.length === 2 && lengthOf(segment) > 0);
  if (seen.reduce((sum, segment) => sum + lengthOf(segment), 0) < 0.08 * scene.part) return;
  const last = seen[seen.length - 1];
  const [to, step, length] = [last[1], difference(last), lengthOf(last)];
  scene.arrow(to.map((x, k) => x - (0.06 * scene.part * step[k]) / length), to, color, 0.006);
}

/// A surface, with thin lines where the picture cuts it.
function drawSurface(scene, polygon, color) {
  const seen = clipped(polygon);
  scene.surfaces([seen], color, 0.3);
  if (seen.length > 2) scene.lines([outline(seen)], color, 0.5);
}

/// A plane through a place, as a square.
function drawPlane(scene, place, normal, color) {
  const other = Math.abs(normal[2]) < 0.8 ? [0, 0, 1] : [1, 0, 0];
  const turn = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
  const long = turn(normal, other);
  const size = Math.hypot(...long);
  const p = long.map((x) => (0.75 * scene.part * x) / size);
  const q = turn(normal, p);
  const corner = (s, t) => place.map((x, k) => x + s * p[k] + t * q[k]);
  const square = [corner(-1, -1), corner(1, -1), corner(1, 1), corner(-1, 1)];
  scene.surfaces([square], color, 0.13);
  scene.lines([[...square, square[0]]], color, 0.7);
}

/// The hull of some points: its surface, its sides, and the points with their names.
function drawHull(scene, points, { color, shape }, nameOf) {
  if (points.length > 2) drawSurface(scene, points, color);
  for (const side of sides(outline(points))) {
    const seen = clipped(side);
    if (seen.length === 2) scene.rod(...seen, color);
  }
  points.forEach((point, i) => {
    const seen = seenPoint(point);
    if (seen === null) return;
    scene.dot(seen, color, shape, points.length === 1 ? 0.04 : 0.026);
    scene.name(seen, ...nameOf(i));
  });
}

/// The primitives of a query.
export class MotionPicture {
  constructor(scene) {
    this.scene = scene;
  }

  prepare(seen) {
    drawTraces(this.scene, seen, (state) =>
      seen.motion.primitives.map((points) => points.map((i) => seen.frame.place(state.points[i], state.d))));
  }

  draw({ motion, state, near, frame, direction, place, text }) {
    const { scene } = this;
    scene.begin(scene.moving);
    motion.primitives.forEach((indices, k) => {
      const points = indices.map((i) => frame.place(state.points[i], state.d));
      drawHull(scene, points, looks[k], (i) => [motion.names[indices[i]], looks[k].color, indices[i]]);
    });
    this.drawGap(near, frame, direction);
    if (place) {
      const seen = seenPoint(frame.place(place.vector, place.d));
      if (seen) {
        scene.dot(seen, "toi", "star", 0.026);
        scene.name(seen, text, "toi");
      }
    }
    scene.render();
  }

  /// From one nearest point to the other, and a plane between them.
  drawGap(near, frame, direction) {
    const ends = near.points.map((point) => frame.place(point, near.d));
    const seen = clipped(ends);
    if (seen.length === 2) this.scene.lines([seen], "ink", 1, 0.02);
    if (direction === null) return;
    const middle = ends[0].map((x, k) => (x + ends[1][k]) / 2n);
    if (seenPoint(middle)) drawPlane(this.scene, toNumbers(middle), direction, "s5");
  }
}

/// The corners of a query.
export class CornerPicture {
  constructor(scene) {
    this.scene = scene;
  }

  prepare(seen) {
    drawTraces(this.scene, seen, (state) => [seen.motion.corners(state).map((w) => seen.frame.place(w, state.d))]);
  }

  draw({ motion, state, frame, direction, separation, isInside }) {
    const { scene } = this;
    scene.begin(scene.moving);
    const points = motion.corners(state).map((w) => frame.place(w, state.d));
    const { color } = looks[0];
    drawHull(scene, points, { color, shape: "ball" }, (i) => [`w${"₀₁₂₃"[i]}`, color]);
    scene.dot([0, 0, 0], "toi", "star", 0.03);
    scene.name([0, 0, 0], isInside ? "0: contact" : "0", "toi");
    if (direction !== null) {
      drawPlane(scene, [0, 0, 0], direction, "s5");
      scene.arrow([0, 0, 0], direction.map((x) => 0.6 * scene.part * x), "s5");
    }
    if (separation !== null && separation.radius > 1e-3 && separation.radius < 20) {
      scene.neighbourhood([0, 0, 0], separation.radius, separation.isBall, "s5");
    }
    scene.render();
  }
}

