// The visible part: a place and a radius, and exact positions as coordinates relative to them.
//
// A picture shows the ball of a radius around a place. Relative to both, coordinates are computed exactly and then
// truncated to 72 fractional bits; primitives are clipped to the cube around the ball before they are rounded. A
// primitive that is 1e300 times larger than the visible part is therefore as sharp as a small one.

import { nearest } from "./exact.js";

const fractionBits = 72n;
const limit = 1n << fractionBits;
const unit = 2 ** 72;

export class Frame {
  /// \param center a vector, over `d`
  /// \param lgRadius log2 of the radius
  constructor(center, d, lgRadius) {
    this.center = center;
    this.d = d;
    this.lgRadius = lgRadius;
    const whole = Math.floor(lgRadius);
    const front = BigInt(Math.round(2 ** (lgRadius - whole) * 2 ** 52));
    const exponent = BigInt(whole - 52);
    this.up = exponent < 0n ? 1n << -exponent : 1n;
    this.down = exponent < 0n ? front : front << exponent;
  }

  /// A vector over `d` in this frame: integers, whose unit is 2^-72 radii.
  place(vector, d) {
    const bottom = d * this.d * this.down;
    return vector.map((x, k) => (((x * this.d - this.center[k] * d) * this.up) << fractionBits) / bottom);
  }
}

/// Coordinates of a frame as those of the world, rounded to the precision of a screen.
export function worldOf(frame, point) {
  const radius = 2 ** frame.lgRadius;
  const step = 2 ** (Math.floor(frame.lgRadius) - 12);
  return point.map((x, k) => {
    const center = nearest({ n: frame.center[k], d: frame.d });
    return Math.round((center + x * radius) / step) * step;
  });
}

export const toNumbers = (point) => point.map((x) => Number(x) / unit);
const isWithin = (point) => point.every((x) => x >= -limit && x <= limit);

/// A point, as numbers; null if it is not visible.
export const seenPoint = (point) => (isWithin(point) ? toNumbers(point) : null);

/// The visible part of a polygon, or of a segment as one of two points: corners as numbers; empty
/// if it is invisible.
export function clipped(polygon) {
  let points = polygon;
  if (!points.every(isWithin)) {
    for (let axis = 0; axis < 3; ++axis) {
      for (const side of [1n, -1n]) points = clippedBy(points, axis, side);
    }
  }
  return points.map(toNumbers);
}

function clippedBy(points, axis, side) {
  const space = (point) => limit - side * point[axis];
  const result = [];
  const isClosed = points.length > 2;
  points.forEach((point, i) => {
    const here = space(point);
    if (here >= 0n) result.push(point);
    if (i + 1 === points.length && !isClosed) return;
    const next = points[(i + 1) % points.length];
    const there = space(next);
    if ((here < 0n) === (there < 0n) || here === there) return;
    result.push(point.map((x, k) => x + ((next[k] - x) * here) / (here - there)));
  });
  return result;
}
