// The line of time: the oracle's verdict, the subintervals of a certificate, and the answer of each solver, all
// over the window of time that the slider covers.

import { compare, divide, doubleText, nearest, rational, subtract } from "./exact.js";
import { make } from "./elements.js";
import { distanceText, momentText, verdictText } from "./facts.js";

/// The position of a time in a window, from 0 to 1 if it is inside.
export function positionIn(window, time) {
  const length = subtract(window.to, window.from);
  return nearest(divide(subtract(time, window.from), length));
}

const percent = (x) => `${100 * Math.max(0, Math.min(1, x))}%`;

/// A mark at a time, or at the edge towards it.
function mark(window, time, kind, tip) {
  const at = positionIn(window, time);
  const side = at < 0 ? "before" : at > 1 ? "after" : "";
  const element = make("i", { class: `mark ${kind} ${side}`, title: tip });
  element.style.left = percent(at);
  return element;
}

/// A bar between two times, clipped to the window; null if it is outside.
function bar(window, from, to, kind, tip, text) {
  if (compare(to, window.from) < 0 || compare(from, window.to) > 0) return null;
  const [start, end] = [positionIn(window, from), positionIn(window, to)];
  const element = make("i", { class: `bar ${kind}`, title: tip }, make("span", {}, text));
  element.style.left = percent(start);
  element.style.width = `calc(${percent(end)} - ${percent(start)})`;
  return element;
}

function row(name, tip, track, text, kind = "") {
  return [make("div", { class: `name ${kind}`, title: tip }, name),
    make("div", { class: `track ${kind}` }, ...track), make("div", { class: `said ${kind}` }, ...text)];
}

function oracleRow(window, facts) {
  const { truth, approach } = facts;
  if (truth === null) return row("oracle", "", [], ["not asked: give this query to the tool"]);
  const track = [];
  const text = [make("b", {}, verdictText(facts))];
  if (truth.toi) {
    track.push(mark(window, truth.toi.time, "toi", "time of impact"));
    text.push(` at t = ${momentText(truth.toi)}`);
  } else if (approach) {
    track.push(mark(window, approach.time, "approach", "nearest"));
    text.push(` – nearest at t ≈ ${doubleText(approach.lower)}, distance ${distanceText(approach)}`);
  }
  return row("oracle", "the exact verdict", track, text);
}

const countText = (subintervals) => (subintervals === 1 ? "1 subinterval" : `${subintervals} subintervals`);

function certificateRow(window, certificate, t) {
  const subintervals = certificate.subintervals.map(({ from, to, feature }, i) => {
    const isNow = compare(from, t) <= 0 && compare(t, to) <= 0;
    return bar(window, from, to, `subinterval ${i % 2 ? "odd" : ""} ${isNow ? "now" : ""}`, `separated by ${feature}`, feature);
  });
  const state = certificate.accepted ? "accepted by the checker" : `refused by the checker: ${certificate.reason}`;
  return row("certificate", certificate.given ? "from the file" : "of the oracle", subintervals,
    [`${certificate.claim.replace(/_/g, " ")}, ${countText(certificate.subintervals.length)}, ${state}`],
    certificate.accepted ? "" : "wrong");
}

function answerText(answer) {
  const { verdict, toi_lower: lower, toi_upper: upper, failure, faults } = answer;
  const times = [lower === null ? "" : `from ${doubleText(lower)}`, upper === null ? "" : `to ${doubleText(upper)}`].filter(Boolean).join(" ");
  const said = failure && failure !== verdict ? failure : verdict;
  const wrong = faults.length === 0 ? [] : [" ", make("b", { class: "fault" }, `✗ ${faults.join(", ")}`),
    answer.breaks_promise || answer.promise === "none" ? "" : " (its promise allows it)"];
  return [make("b", {}, said), ` ${times}`, ...wrong];
}

function answerRow(window, answer) {
  const { toi_lower: lower, toi_upper: upper } = answer;
  const isFinite = (x) => x !== null && Number.isFinite(x);
  const track = [];
  if (isFinite(lower) && isFinite(upper) && lower <= upper) {
    track.push(bar(window, rational(lower), rational(upper), "impact", "where it puts the time of impact", ""));
  }
  if (isFinite(lower)) track.push(mark(window, rational(lower), "lower", `not before ${lower}`));
  if (isFinite(upper)) track.push(mark(window, rational(upper), "upper", `not after ${upper}`));
  const tip = `promises ${answer.promise === "none" ? "nothing" : `to be ${answer.promise}`}` +
    (answer.recorded ? "; this answer was recorded" : "");
  return row(answer.solver + (answer.recorded ? " (recorded)" : ""), tip, track, answerText(answer),
    answer.faults.length > 0 ? "wrong" : "");
}

/// Writes the rows below the slider.
export function drawTimeline(parent, facts, window, t) {
  const cells = oracleRow(window, facts);
  if (facts.certificate) cells.push(...certificateRow(window, facts.certificate, t));
  for (const answer of facts.answers) cells.push(...answerRow(window, answer));
  parent.replaceChildren(...cells);
  const now = percent(positionIn(window, t));
  for (const track of parent.querySelectorAll(".track")) {
    const cursor = make("i", { class: "cursor" });
    cursor.style.left = now;
    track.append(cursor);
  }
}
