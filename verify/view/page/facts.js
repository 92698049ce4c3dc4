// The data of the page's queries. The tool writes for each (verify/view/query_facts.cpp):
//
//   label, kind, min_separation, norm, notes
//   coordinates  24; or of a query on curves:
//   control      lists for j = 0 … K of the four points' control points j
//   weights      theirs, if the curves are rational
//   truth        collides, text, toi (with its polynomial), u, v
//   approach     the least distance without a collision: above, at_most, and the time
//   certificate  claim, accepted, reason, subintervals, text, given
//   answers      solver, promise, recorded, verdict, failure, toi_lower, toi_upper, tolerance, faults, breaks_promise
//
// A toi and an approach are lower and upper (doubles), exact (a rational, or null) and time (a rational near
// it). Here texts of doubles become doubles, and texts of rationals rationals.

import { doubleText, parseDouble, parseRational, shortText } from "./exact.js";

const double = (text) => {
  if (text === null || text === undefined) return null;
  if (/Infinity$/.test(text)) return Number(text);
  return parseDouble(text);
};

const enclosure = (facts) => ({ ...facts, lower: double(facts.lower), upper: double(facts.upper) });
const moment = (facts) => ({ ...enclosure(facts), time: parseRational(facts.time) });

function pointsOf({ coordinates, control, weights }) {
  if (coordinates) return { coordinates: coordinates.map(double) };
  return { control: control.map((points) => points.map((point) => point.map(double))),
    ...(weights && { weights: weights.map((list) => list.map(double)) }) };
}

/// Points on curves can be seen; they are neither edited nor written as text.
export const isCurved = (facts) => facts.control !== undefined;

export function readFacts(facts) {
  const { truth, approach, certificate } = facts;
  return {
    ...facts,
    ...pointsOf(facts),
    min_separation: double(facts.min_separation),
    truth: { ...truth, toi: truth.toi ? moment(truth.toi) : null,
      u: truth.u ? enclosure(truth.u) : null, v: truth.v ? enclosure(truth.v) : null },
    approach: approach && { ...moment(approach), above: double(approach.above), at_most: double(approach.at_most) },
    certificate: certificate && { ...certificate, subintervals: certificate.subintervals.map((subinterval) =>
      ({ from: parseRational(subinterval.from), to: parseRational(subinterval.to), feature: subinterval.feature })) },
    answers: facts.answers.map((answer) => ({ ...answer, toi_lower: double(answer.toi_lower),
      toi_upper: double(answer.toi_upper) })),
  };
}

/// A query without answers, from pasted text.
export const withoutAnswer = (query, label) =>
  ({ ...query, label, notes: [], truth: null, approach: null, certificate: null, answers: [] });

/// "0.5", "1/3 ≈ 0.3333333333333333", or "between 0.70710678118654746 and 0.70710678118654757".
export function momentText({ lower, upper, exact }) {
  if (exact === null || exact === undefined) return `between ${doubleText(lower)} and ${doubleText(upper)}`;
  if (lower === upper) return doubleText(lower);
  const value = shortText(parseRational(exact), 17);
  return exact.length < 40 ? `${exact} ≈ ${value}` : `about ${value}`;
}

/// "(u, v) = (0.25, 0.5)"; with nine digits if they are not doubles.
export function placeText({ u, v }) {
  const isExact = [u, v].every(({ lower, upper }) => lower === upper);
  const [first, second] = [u, v].map(({ lower }) => doubleText(isExact ? lower : Number(lower.toPrecision(9))));
  return `(u, v) ${isExact ? "=" : "≈"} (${first}, ${second})`;
}

/// The verdict in a word. Contact means distance ≤ the minimum separation.
export function verdictText({ truth }) {
  if (truth === null) return "not decided";
  return truth.collides ? "collides" : "free";
}

export const distanceText = ({ above, at_most }) =>
  (above === 0 ? `at most ${doubleText(at_most)}` : `between ${doubleText(above)} and ${doubleText(at_most)}`);
