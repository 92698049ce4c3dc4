// The page: a list of queries, of which one is shown.

import { add, compare, doubleText, hexadecimalText, log2, nearest, one, parseDouble, rational, rationalText, shortText, zero } from "./exact.js";
import { figure, find, make, Player } from "./elements.js";
import { isCurved, momentText, placeText, readFacts, verdictText, withoutAnswer } from "./facts.js";
import { linkOf, readLink, readQuery, writers } from "./formats.js";
import { worldOf } from "./frame.js";
import { isLive, startSolvers } from "./live.js";
import { Look, steps } from "./look.js";
import { axes, directionOf } from "./motion.js";
import { CornerPicture, MotionPicture } from "./pictures.js";
import { canDraw, Scene, Viewpoint } from "./scene.js";
import { queryOf, readStep, StepPart } from "./step.js";
import { drawTimeline } from "./timeline.js";

const zoomSteps = 1000;
/// log2 of the smallest visible gap, in units of the radius.
const lgSmallest = -5;

const queries = JSON.parse(find("queries").textContent).map(readFacts);
const step = find("step_facts") ? readStep(JSON.parse(find("step_facts").textContent)) : null;
// Meshes mostly have y upwards.
const viewpoint = new Viewpoint(step ? 1 : 2);
let look = null;
let pictures = [];
/// Decides a query in this page; null as long as it cannot.
let decide = null;
/// What the user asks for: its number, of which the newest is shown, and the query, as long as it is not shown.
let turn = 0, wanted = null;
/// The number of the query that the user made.
let edited = null;
let format = "decimal";

// ---- The parts of the page ----------------------------------------------------------------------

/// The button that copies in the format of that name.
const copyId = (name) => `copy_${name.replace(/\+/g, "p")}`;

const button = (id, text, tip, press) => make("button", { type: "button", id, title: tip, onclick: press }, text);

function radios(name, values, chosen, change) {
  return values.map((value) => make("label", {},
    make("input", { type: "radio", name, value, checked: value === chosen, onchange: () => change(value) }), value));
}

function choose(name, value) {
  for (const radio of document.getElementsByName(name)) radio.checked = radio.value === value;
}

const chosen = (name) => document.querySelector(`input[name=${name}]:checked`).value;

function controls() {
  return make("div", { class: "controls" },
    button("play", "Play", "Space", () => player.toggle()),
    button("star", "To contact", "c", goToStar),
    make("label", { class: "wide" }, "Zoom ",
      make("input", { type: "range", id: "zoom", min: 0, max: zoomSteps, value: 0,
        oninput: (event) => zoomTo(event.target.valueAsNumber / zoomSteps) })),
    button("all", "All", "0", () => zoomTo(0)),
    button("enlarge", "Enlarge", "z", () => zoomTo(1)),
    make("label", {}, make("input", { type: "checkbox", id: "follow", onchange: (event) => {
      look.follow(event.target.checked);
      update(true);
    } }), "Follow the gap"),
    button("home", "From the front", "h", () => {
      viewpoint.home();
      viewpoint.change();
    }),
    button("tilt", "Other axis up", "u", () => viewpoint.tilt()));
}

/// The controls that change the query, on a page that decides it at once.
function editor() {
  return make("section", { id: "edit", hidden: true },
    make("div", { class: "choice", role: "radiogroup", "aria-label": "Kind" },
      ...radios("asked_kind", ["vertex-face", "edge-edge"], "vertex-face", (kind) => edit({ kind })),
      make("label", {}, "Minimum separation ", make("input", { id: "distance", type: "text", size: 12, inputmode: "decimal",
        onchange: changeSeparation })),
      ...radios("asked_norm", ["l2", "linf"], "l2", changeSeparation),
      make("label", {}, make("input", { type: "checkbox", id: "move" }), "Drag points in the first picture"),
      button("link", "Copy a link to this query", "", copyLink), make("output", { id: "linked" })),
    make("p", {}, "Points are dragged at t = 0 or t = 1; numbers can be typed into the table below."));
}

function page() {
  find("view").append(
    make("header", {}, make("h1", {}, isLive ? "Touchstone playground" : "Touchstone view"),
      make("nav", { id: "list", hidden: true, "aria-label": "Queries" })),
    make("p", { id: "nothing", hidden: step !== null || queries.length > 0 }, "Nothing was found: this page has no query."),
    make("section", { id: "step", hidden: step === null }),
    make("section", { id: "query", hidden: true },
      make("h2", { id: "label" }), make("p", { id: "sentence" }), make("p", { id: "root", hidden: true }), make("ul", { id: "notes", class: "findings" }),
      make("div", { class: "pictures" },
        figure("motion", "The primitives, and their traces"),
        figure("corners", "The corners: contact where the origin is in their hull")),
      make("div", { class: "timeline", id: "moment" },
        make("label", { class: "name", for: "time" }, "time t"),
        make("div", { class: "slider" }, make("input", { type: "range", id: "time", min: 0, max: steps, step: 1,
          oninput: (event) => {
            look.setStep(event.target.valueAsNumber);
            update(look.isFollowing);
          } })),
        make("output", { id: "now", for: "time", class: "said" })),
      make("div", { class: "timeline", id: "rows" }),
      make("p", { id: "readout" }),
      controls(),
      make("p", { id: "scale" }),
      editor()),
    make("section", { id: "numbers", hidden: true },
      make("h2", {}, "Coordinates"),
      make("div", { class: "choice", role: "radiogroup", "aria-label": "Format of coordinates" },
        ...radios("format", ["decimal", "hexadecimal", "rational"], format, (value) => {
          format = value;
          writeTable();
        })),
      make("div", { class: "scroll", tabindex: "0" }, make("table", { id: "points" }))),
    make("section", { id: "exchange", hidden: step !== null && step.isAtRest },
      make("h2", {}, "Copy and paste"),
      make("p", {}, "Text of another query (C++, rows of CSV, JSON, or 24 numbers), pasted here, is drawn."),
      make("div", { class: "choice" },
        ...Object.keys(writers).map((name) => button(copyId(name), `Copy as ${name}`, "", () => copyText(writers[name](look.facts)))),
        button("copy_certificate", "Copy the certificate", "For touchstone-check", () => copyText(look.facts.certificate.text))),
      make("textarea", { id: "text", rows: 10, spellcheck: "false", "aria-label": "A query as text",
        onpaste: () => setTimeout(draw) }),
      make("div", { class: "choice" },
        ...radios("kind", ["vertex-face", "edge-edge"], "vertex-face", () => {}),
        button("draw", "Draw this text", "", draw), make("output", { id: "drawn" }))));
}

// ---- The query that is shown --------------------------------------------------------------------

function show(index) {
  player.isPlaying = false;
  turn += 1;
  wanted = null;
  look = new Look(queries[index]);
  look.index = index;
  const { facts } = look;
  for (const part of ["query", "numbers"]) find(part).hidden = false;
  find("nothing").hidden = true;
  find("label").textContent = facts.label;
  find("notes").replaceChildren(...facts.notes.map((note) => make("li", {}, note)));
  find("star").textContent = facts.truth && facts.truth.toi ? "To contact" : "To the nearest";
  for (const name of Object.keys(writers)) find(copyId(name)).disabled = isCurved(facts);
  find("edit").hidden = decide === null || isCurved(facts);
  find("enlarge").disabled = find("zoom").disabled = !look.canZoom;
  writeVerdict(facts);
  writeEditor(facts);
  writeList();
  update(true);
}

function writeVerdict(facts) {
  const { truth } = facts;
  const separation = facts.min_separation > 0 ? `, minimum separation ${facts.min_separation} (${facts.norm})` : "";
  const place = truth && truth.u ? `, ${placeText(truth)}` : "";
  const impact = truth && truth.toi ? ` Time of impact: ${momentText(truth.toi)}${place}.` : "";
  find("sentence").replaceChildren(make("strong", {}, `${facts.kind}${separation}: `,
    make("span", { id: "verdict" }, verdictText(facts)), "."), impact);
  const toi = truth && truth.toi;
  find("root").hidden = !toi || typeof toi.exact === "string";
  if (!find("root").hidden) {
    find("root").replaceChildren("The time is the only root of ", make("code", {}, toi.polynomial),
      ` between ${doubleText(toi.lower)} and ${doubleText(toi.upper)}.`);
  }
  find("copy_certificate").disabled = !facts.certificate;
}

function writeList() {
  const list = find("list");
  list.hidden = queries.length < 2 || step !== null;
  list.replaceChildren(...queries.map((facts, i) => make("button", { type: "button", "aria-current": i === look.index && "true",
    onclick: () => show(i) }, make("b", {}, String(i)), ` ${facts.label} `, make("em", {}, badge(facts)))));
  const current = list.querySelector("[aria-current]");
  if (current && !list.hidden) list.scrollTop = current.offsetTop - list.offsetTop - 40;
}

function badge(facts) {
  const wrong = facts.answers.filter((answer) => answer.faults.length > 0).length;
  return verdictText(facts) + (wrong > 0 ? `, ✗ ${wrong}` : "");
}

/// Updates the parts that depend on the time or, if the frame has changed, all parts.
function update(isNewFrame) {
  const { motion, facts, t, window, frame, cornerFrame, place } = look;
  const state = motion.at(t);
  const near = motion.nearest(state);
  const corners = motion.corners(state);
  const { subinterval } = look;
  const direction = subinterval ? directionOf(subinterval.feature, corners) : null;
  const isInside = near.squared.n === 0n;
  const radius = facts.min_separation > 0 ? facts.min_separation * 2 ** -cornerFrame.lgRadius : 0;
  const separation = radius > 0 ? { radius, isBall: facts.norm === "l2" } : null;
  const isContact = Boolean(facts.truth && facts.truth.u);
  pictures.forEach((picture, i) => {
    const own = i === 0 ? frame : cornerFrame;
    if (isNewFrame) picture.prepare({ motion, window, frame: own });
    picture.draw({ motion, state, near, frame: own, direction, separation, isInside, place: isContact ? place : null,
      text: "contact" });
  });
  find("time").value = look.step;
  find("now").textContent = look.timeText(t, 17);
  find("zoom").value = Math.round(look.zoom * zoomSteps);
  find("follow").checked = look.isFollowing;
  find("play").textContent = player.isPlaying ? "Stop" : "Play";
  find("scale").textContent = `Radius seen: ${scaleText(frame.lgRadius)} (corners ${scaleText(cornerFrame.lgRadius)}), ` +
    `times from ${look.timeText(window.from, 6)} to ${look.timeText(window.to, 6)}.`;
  drawTimeline(find("rows"), facts, window, t);
  writeReadout(near, subinterval);
  writeTable(state);
}

const scaleText = (lg) => {
  const ten = lg * Math.log10(2);
  const whole = Math.floor(ten);
  return Math.abs(whole) < 5 ? String(Number((2 ** lg).toPrecision(3))) : `${(10 ** (ten - whole)).toPrecision(3)}e${whole}`;
};

function writeReadout(near, subinterval) {
  const gap = look.motion.gap(look.motion.at(look.t));
  const isTiny = gap.n > 0n && log2(gap) < look.frame.lgRadius + lgSmallest;
  const parts = [gap.n === 0n ? "Contact now" : `Distance now: ${shortText(gap, 9)}${isTiny ? " (too small to be seen here: enlarge)" : ""}`,
    `nearest at (u, v) = (${shortText(near.u, 9)}, ${shortText(near.v, 9)})`];
  if (subinterval) parts.push(`separated by ${subinterval.feature}`);
  find("readout").textContent = `${parts.join("; ")}.`;
}

// ---- Numbers ------------------------------------------------------------------------------------

/// A rational in the chosen format, with ≈ if it is rounded.
function numberText(value) {
  if (format === "rational") return rationalText(value);
  const near = nearest(value);
  const back = Number.isFinite(near) ? rational(near) : null;
  const isExact = back !== null && back.n * value.d === value.n * back.d;
  return (isExact ? "" : "≈ ") + (format === "decimal" ? String(near) : hexadecimalText(near));
}

/// The control points, those of the ends with their time. \param all a list for each curve
function controlGroups(all) {
  const last = all[0].length - 1;
  return all[0].map((_, j) => ({ end: { 0: 0, [last]: 1 }[j], title: { 0: "t = 0", [last]: "t = 1" }[j] || `control ${j}`,
    values: all.map((curve) => curve[j]) }));
}

function writeTable(state = look.motion.at(look.t)) {
  const { motion } = look;
  const isTyping = document.activeElement && document.activeElement.matches("#points input");
  if (isTyping) return;
  const isInput = decide !== null && format !== "rational" && !isCurved(look.facts);
  const code = (value) => make("code", {}, numberText(value));
  const cell = (x, d, end, i, k) => (isInput && end !== undefined
    ? make("input", { type: "text", value: numberText({ n: x, d }), "aria-label": `${axes[k]} of ${motion.names[i]} at t = ${end}`,
      onchange: (event) => typeCoordinate(12 * end + 3 * i + k, event.target) })
    : code({ n: x, d }));
  const weights = motion.weights && controlGroups(motion.weights);
  const weightCell = (group, i) => weights && make("td", {}, weights[group] ? code(rational(weights[group].values[i])) : "");
  const columns = ["point", ...axes, ...(weights ? ["weight"] : [])];
  const groups = [...controlGroups(motion.control).map((group) => ({ ...group, d: 1n << motion.shift })),
    { title: "now", values: state.points, d: state.d }];
  const body = groups.map(({ title, values, d, end }, group) => make("tbody", { id: `at_${title.replace(/[^a-z0-9]+/g, "_")}` },
    make("tr", {}, make("th", { scope: "rowgroup", colspan: columns.length }, title)),
    ...values.map((point, i) => make("tr", {}, make("th", { scope: "row" }, motion.names[i]),
      ...point.map((x, k) => make("td", {}, cell(x, d, end, i, k))), weightCell(group, i)))));
  find("points").replaceChildren(make("thead", {}, make("tr", {}, ...columns.map((name) => make("th", { scope: "col" }, name)))), ...body);
}

// ---- Copy and paste -----------------------------------------------------------------------------

/// \param where the text is if there is no clipboard
function toClipboard(text, said, where) {
  said.textContent = where;
  if (navigator.clipboard) navigator.clipboard.writeText(text).then(() => { said.textContent = "Copied."; }, () => {});
}

function copyText(text) {
  const area = find("text");
  area.value = text;
  area.select();
  choose("kind", look.facts.kind);
  toClipboard(text, find("drawn"), "The text is here.");
}

const isSame = (a, b) => !isCurved(a) && !isCurved(b) && a.kind === b.kind && a.min_separation === b.min_separation &&
  (a.min_separation === 0 || a.norm === b.norm) && a.coordinates.every((x, i) => x === b.coordinates[i]);

/// The number of a query in the list, which it joins if it is new.
function indexOf(query) {
  const index = queries.findIndex((one) => isSame(one, query));
  return index < 0 ? queries.push(query) - 1 : index;
}

/// Shows the query in a text, with its answers if the page contains it.
function draw() {
  const said = find("drawn");
  const fail = (error) => { said.textContent = `Not drawn: ${error.message}.`; };
  try {
    const read = readQuery(find("text").value);
    decided({ ...read, kind: read.kind || chosen("kind") }, "pasted", (facts) => {
      show(indexOf(facts));
      rememberLink();
      said.textContent = decide ? "Decided." : look.facts.truth ? "This page holds its answer." : "Drawn. This page holds no answer to it.";
      find("query").scrollIntoView();
    }, fail);
  } catch (error) {
    fail(error);
  }
}

// ---- Another query, on a page that decides it ---------------------------------------------------

/// Calls found with the query and its answers, if this page decides. Calls nothing if the user asks for another one before.
function decided(query, label, found, failed = (error) => { throw error; }) {
  if (decide === null) {
    found(withoutAnswer(query, label));
    return;
  }
  const mine = turn += 1;
  wanted = query;
  const ifNewest = (call) => (result) => {
    if (mine !== turn) return;
    wanted = null;
    call(result);
  };
  decide({ ...query, label }).then(ifNewest(found), ifNewest(failed));
}

function writeEditor({ kind, min_separation, norm }) {
  choose("asked_kind", kind);
  choose("asked_norm", norm);
  find("distance").value = String(min_separation);
  find("linked").textContent = "";
}

/// Shows the query with this change. \param isKept the pictures keep their place, scale and time
/// \param shown is called when it is shown
function edit(change, isKept = false, shown = () => {}) {
  const { kind, coordinates, min_separation, norm } = wanted || look.facts;
  decided({ kind, coordinates, min_separation, norm, ...change }, "your query", (facts) => {
    if (edited === null) edited = queries.push(facts) - 1;
    else queries[edited] = facts;
    if (isKept) {
      const before = look;
      look = new Look(facts);
      look.index = edited;
      for (const part of ["t", "zoom", "frame", "cornerFrame", "window"]) look[part] = before[part];
      writeVerdict(facts);
      update(true);
    } else {
      show(edited);
      rememberLink();
    }
    shown();
  });
}

function changeSeparation() {
  const min_separation = parseDouble(find("distance").value);
  if (min_separation >= 0) edit({ min_separation, norm: chosen("asked_norm") });
  else find("distance").value = String(look.facts.min_separation);
}

function typeCoordinate(at, input) {
  const value = parseDouble(input.value.replace("≈", ""));
  input.blur();
  if (Number.isNaN(value)) writeTable();
  else edit({ coordinates: (wanted || look.facts).coordinates.map((x, i) => (i === at ? value : x)) });
}

/// Dragging moves the points of the end of the motion that is shown.
const drag = {
  begin() {
    if (decide === null || isCurved(look.facts) || !find("move").checked) return false;
    player.isPlaying = false;
    const end = compare(add(look.t, look.t), one) < 0 ? zero : one;
    look.window = { from: zero, to: one };
    look.t = end;
    update(true);
    return true;
  },
  move(point, place) {
    const first = (look.t.n === 0n ? 0 : 12) + 3 * point;
    const coordinates = [...look.facts.coordinates];
    coordinates.splice(first, 3, ...worldOf(look.frame, place));
    edit({ coordinates }, true);
  },
  end() {
    const { t } = look;
    edit({}, false, () => {
      look.window = { from: zero, to: one };
      look.t = t;
      update(true);
    });
  },
};

const rememberLink = () => decide && history.replaceState(null, "", linkOf(look.facts));

function copyLink() {
  rememberLink();
  toClipboard(location.href, find("linked"), "The link is in the address bar.");
}

/// Shows the query of the address. Returns whether there is one.
function openLink() {
  const said = find("nothing");
  const fail = (error) => {
    said.textContent = `The link holds no query: ${error.message}.`;
    said.hidden = false;
    find("query").hidden = find("numbers").hidden = true;
  };
  try {
    const query = readLink(location.hash);
    if (query === null) return false;
    decided(query, "from the link", (facts) => show(indexOf(facts)), fail);
  } catch (error) {
    fail(error);
  }
  return true;
}

async function goLive() {
  try {
    decide = await startSolvers();
  } catch (error) {
    find("nothing").textContent = `This browser cannot decide queries: ${error.message}.`;
    find("nothing").hidden = false;
  }
  if (!openLink() && queries.length > 0) show(0);
  window.addEventListener("hashchange", openLink);
}

// ---- Time, zoom and keys ------------------------------------------------------------------------

function zoomTo(zoom) {
  look.zoomTo(zoom);
  update(true);
}

function goToStar() {
  look.setTime(look.star);
  update(look.isFollowing);
}

const player = new Player(() => look.step / steps, (position) => {
  look.setStep(Math.round(position * steps));
  update(look.isFollowing);
});

function moveTime(by) {
  look.setStep(Math.max(0, Math.min(steps, look.step + by)));
  update(look.isFollowing);
}

const keys = {
  " ": () => player.toggle(),
  c: goToStar,
  0: () => zoomTo(0),
  z: () => zoomTo(1),
  "+": () => zoomTo(look.zoom + 0.05),
  "-": () => zoomTo(look.zoom - 0.05),
  f: () => find("follow").click(),
  h: () => find("home").click(),
  u: () => viewpoint.tilt(),
  n: () => show((look.index + 1) % queries.length),
  p: () => show((look.index + queries.length - 1) % queries.length),
  ArrowLeft: () => moveTime(-32),
  ArrowRight: () => moveTime(32),
};

function onKey(event) {
  if (look === null) return;
  const isTyping = /^(INPUT|TEXTAREA|BUTTON|SELECT)$/.test(event.target.tagName);
  if (isTyping || event.ctrlKey || event.altKey || event.metaKey || !keys[event.key]) return;
  event.preventDefault();
  keys[event.key]();
}

// ---- Start --------------------------------------------------------------------------------------

function makePictures() {
  if (!canDraw()) {
    document.querySelector(".pictures").replaceChildren(make("p", { class: "warning", id: "no_pictures" },
      "This browser has no WebGL, which the pictures need. All numbers are here."));
    return;
  }
  const zoom = (factor) => {
    look.zoomBy(factor);
    update(true);
  };
  pictures = [new MotionPicture(new Scene(find("motion"), viewpoint, zoom)),
    new CornerPicture(new Scene(find("corners"), viewpoint, zoom))];
  pictures[0].scene.drag = drag;
  for (const query of ["(prefers-color-scheme: dark)", "print"]) {
    matchMedia(query).addEventListener("change", () => {
      if (look !== null) update(true);
      if (stepPart) stepPart.update();
    });
  }
}

/// A pair of the step, with its answers if the page contains it.
function showPair(n) {
  const query = withoutAnswer(queryOf(step, step.pairs[n]), `${step.label}: ${step.pairs[n].name}`);
  show(indexOf(query));
  find("query").scrollIntoView();
}

page();
makePictures();
document.addEventListener("keydown", onKey);
// Elements at rest are no query.
const stepPart = step && new StepPart(step, viewpoint, canDraw(), step.isAtRest ? () => {} : showPair);
if (isLive) goLive();
else if (!openLink() && queries.length > 0) show(0);
