// A step: a mesh at the time of a slider, and the colliding pairs by time. Or a mesh at rest, and the pairs that
// intersect.
//
// Both ends of every vertex are on the graphics processor, which computes the positions between, so
// that a slider moves a mesh of any size at the cost of drawing it. For the pictures positions are
// rounded to float relative to the mesh's box; a shown pair is a query of the exact doubles.

import * as THREE from "three";
import { figure, find, make, Player } from "./elements.js";
import { doubleText } from "./exact.js";
import { looks, outline, sides } from "./pictures.js";
import { Scene, styleColor } from "./scene.js";

const listed = 500;
const mostScale = 1e5;

function bytesOf(text) {
  const binary = atob(text);
  const bytes = new Uint8Array(binary.length);
  for (let i = 0; i < binary.length; ++i) bytes[i] = binary.charCodeAt(i);
  return bytes.buffer;
}

/// The vertices of both elements of a pair of a step.
const elementsOf = ({ kind, points }) => {
  const split = kind === "vertex-face" ? 1 : 2;
  return [points.slice(0, split), points.slice(split)];
};

/// The output of the tool (verify/view/step_facts.cpp), with arrays of numbers. A mesh at rest has one array of
/// positions, and its pairs have a place instead of a time: they are in contact all the time.
export function readStep(facts) {
  const isAtRest = facts.after === undefined;
  const before = new Float64Array(bytesOf(facts.before));
  return {
    ...facts,
    isAtRest,
    before,
    after: isAtRest ? before : new Float64Array(bytesOf(facts.after)),
    faces: new Uint32Array(bytesOf(facts.faces)),
    edges: new Uint32Array(bytesOf(facts.edges)),
    pairs: facts.pairs.map((pair) => (isAtRest ? { toi: [0, 0], ...pair } : { elements: elementsOf(pair), ...pair })),
  };
}

/// A pair as a query of exact coordinates.
export function queryOf(step, { kind, name, points, min_separation }) {
  const coordinates = [step.before, step.after].flatMap((ends) =>
    points.flatMap((i) => [ends[3 * i], ends[3 * i + 1], ends[3 * i + 2]]));
  return { kind, coordinates, min_separation, norm: step.norm, label: `${step.label}: ${name}` };
}

// ---- The picture --------------------------------------------------------------------------------

const motion = `
  attribute vec3 next;
  uniform float t;
  vec3 place() { return mix(position, next, t); }`;

const surfaceShaders = {
  vertexShader: `${motion}
    varying vec3 seen;
    void main() {
      vec4 from_here = modelViewMatrix * vec4(place(), 1.0);
      seen = from_here.xyz;
      gl_Position = projectionMatrix * from_here;
    }`,
  fragmentShader: `
    uniform vec3 color;
    varying vec3 seen;
    void main() {
      vec3 normal = normalize(cross(dFdx(seen), dFdy(seen)));
      float light = 0.45 + 0.55 * abs(dot(normal, normalize(vec3(0.3, 0.5, 1.0))));
      gl_FragColor = vec4(color * light, 1.0);
    }`,
};

const markShaders = {
  vertexShader: `${motion}
    uniform float size;
    void main() {
      gl_Position = projectionMatrix * modelViewMatrix * vec4(place(), 1.0);
      gl_PointSize = size;
    }`,
  fragmentShader: `
    uniform vec3 color;
    uniform float hollow;
    void main() {
      vec2 from_middle = abs(2.0 * gl_PointCoord - 1.0);
      float out_there = from_middle.x + from_middle.y;
      if (out_there > 1.0 || out_there < hollow) discard;
      gl_FragColor = vec4(color, 1.0);
    }`,
};

export class StepPicture {
  constructor(scene, step) {
    this.scene = scene;
    this.step = step;
    this.time = { value: 0 };
    this.colors = [];
    this.group = new THREE.Group();
    scene.scene.add(this.group);
    this.measure();
    this.build();
    this.focus = [0, 0, 0];
    this.scale = 1;
    this.place();
  }

  /// Middle and size of the mesh's box at both ends.
  measure() {
    const low = [Infinity, Infinity, Infinity];
    const high = low.map((x) => -x);
    for (const ends of [this.step.before, this.step.after]) {
      ends.forEach((x, i) => {
        if (x < low[i % 3]) low[i % 3] = x;
        if (x > high[i % 3]) high[i % 3] = x;
      });
    }
    this.middle = low.map((x, k) => x / 2 + high[k] / 2);
    this.size = Math.max(...low.map((x, k) => high[k] / 2 - x / 2)) * 1.05 || 1;
  }

  /// A position in units of the picture.
  unit(x, k) {
    return (x - this.middle[k]) / this.size;
  }

  material(shaders, color, uniforms = {}, options = {}) {
    const shade = { value: new THREE.Color() };
    this.colors.push({ shade, color });
    return new THREE.ShaderMaterial({ ...shaders, uniforms: { t: this.time, color: shade, ...uniforms },
      extensions: { derivatives: true }, side: THREE.DoubleSide, ...options });
  }

  build() {
    const { step } = this;
    const attribute = (ends) =>
      new THREE.BufferAttribute(Float32Array.from(ends, (x, i) => this.unit(x, i % 3)), 3);
    const ends = { position: attribute(step.before), next: attribute(step.after) };
    const geometry = (index, own = ends) => {
      const result = new THREE.BufferGeometry();
      for (const name of ["position", "next"]) result.setAttribute(name, own[name]);
      if (index) result.setIndex(new THREE.BufferAttribute(index, 1));
      return result;
    };
    const add = (object) => {
      // Only the graphics processor has the positions of the vertices.
      object.frustumCulled = false;
      this.group.add(object);
      return object;
    };
    const near = { polygonOffset: true, polygonOffsetFactor: -2, polygonOffsetUnits: -2 };
    add(new THREE.Mesh(geometry(step.faces), this.material(surfaceShaders, "mesh")));
    if (step.edges.length > 0) add(new THREE.LineSegments(geometry(step.edges), this.material(markShaders, "ink", this.look(1, -1))));
    const { pairs } = step;
    const elements = pairs.flatMap((pair) => pair.elements);
    const [edges, faces] = [2, 3].map((corners) => elements.filter(({ length }) => length === corners).flat());
    add(new THREE.Mesh(geometry(Uint32Array.from(faces)), this.material(surfaceShaders, "s3", {}, near)));
    add(new THREE.LineSegments(geometry(Uint32Array.from(edges)), this.material(markShaders, "s1", this.look(1, -1), { depthTest: false })));
    // The places of collisions: hollow marks, full after the time of impact; smaller if there are
    // many.
    const size = Math.max(3, 10 * Math.min(1, (200 / pairs.length) ** 0.3));
    const places = this.contactPlaces();
    const contacts = { position: places, next: places };
    const mark = (size, hollow, color) => add(new THREE.Points(geometry(null, contacts),
      this.material(markShaders, color, this.look(size, hollow), { depthTest: false })));
    this.future = mark(size, size > 6 ? 0.55 : -1, "faint");
    this.past = mark(size + 1, -1, "toi");
    this.chosen = mark(22, 0.72, "bad");
    this.chosen.geometry.setDrawRange(0, 0);
    this.chosen.renderOrder = 100;
  }

  look(size, hollow) {
    return { size: { value: size * Math.min(window.devicePixelRatio || 1, 2) }, hollow: { value: hollow } };
  }

  /// The places of contact at its time.
  contactPlaces() {
    const { pairs, isAtRest } = this.step;
    return new THREE.BufferAttribute(Float32Array.from(pairs.flatMap((pair) => (isAtRest ? this.restingPlace(pair) : this.impactPlace(pair)))), 3);
  }

  /// The middle of the points at the place.
  impactPlace({ kind, points, toi: [t], place: [u, v] }) {
    const weights = kind === "vertex-face" ? [0, 1 - u - v, u, v] : [1 - u, u, 0, 0];
    return points.map((i) => this.vertex(i, t))
      .reduce((sum, point, i) => sum.map((x, k) => x + weights[i] * point[k]), [0, 0, 0]);
  }

  /// The middle between both ends of what two elements have in common.
  restingPlace({ place: [from, to] }) {
    return from.map((x, k) => this.unit(x, k) / 2 + this.unit(to[k], k) / 2);
  }

  /// A vertex at a time, in units of the picture.
  vertex(i, t) {
    const { before, after } = this.step;
    return [0, 1, 2].map((k) => this.unit(before[3 * i + k], k) * (1 - t) + this.unit(after[3 * i + k], k) * t);
  }

  /// \param collidedSoFar the number of pairs whose time of impact has passed
  draw(t, collidedSoFar, chosen) {
    this.time.value = t;
    this.past.geometry.setDrawRange(0, collidedSoFar);
    this.future.geometry.setDrawRange(collidedSoFar, Infinity);
    this.chosen.geometry.setDrawRange(chosen === null ? 0 : chosen, chosen === null ? 0 : 1);
    for (const { shade, color } of this.colors) shade.value.copy(styleColor(color));
    this.drawChosen(t, chosen);
    this.scene.render();
  }

  /// The shown pair: its primitives, as in the picture of the query, and its name.
  drawChosen(t, n) {
    const { scene, step } = this;
    scene.begin(scene.moving);
    if (n === null) return;
    const seen = (place) => place.map((x, k) => (x - this.focus[k]) * this.scale);
    const { name, elements, place: [from, to] } = step.pairs[n];
    const primitives = elements.map((corners) => corners.map((i) => seen(this.vertex(i, t))));
    for (const corners of primitives) {
      for (const [a, b] of sides(outline(corners))) scene.rod(a, b, "paper", 0.012);
    }
    primitives.forEach((corners, k) => {
      const { color, shape } = looks[k];
      for (const [a, b] of sides(outline(corners))) scene.rod(a, b, color, 0.006);
      for (const corner of corners) scene.dot(corner, color, shape, 0.01);
    });
    if (step.isAtRest) {
      const [a, b] = [from, to].map((end) => seen(end.map((x, k) => this.unit(x, k))));
      scene.rod(a, b, "bad", 0.011);
      for (const end of [a, b]) scene.dot(end, "bad", "ball", 0.016);
    }
    // Drawn through all parts before it, in this order.
    scene.moving.children.forEach((object, i) => {
      object.material.depthTest = false;
      object.renderOrder = i + 1;
    });
    const place = seen(this.contactPlace(n));
    // Without the numbers of vertices, which are in the list.
    if (Math.hypot(...place) < 1.2) scene.name(place, name.replace(/ \([\d ]*\)/g, ""), "ink");
  }

  // ---- The visible part -------------------------------------------------------------------------

  place() {
    this.group.scale.setScalar(this.scale);
    this.group.position.set(...this.focus.map((x) => -x * this.scale));
  }

  zoom(factor) {
    this.scale = Math.max(0.3, Math.min(mostScale, this.scale * factor));
    this.place();
  }

  contactPlace(n) {
    const places = this.future.geometry.attributes.position.array;
    return [0, 1, 2].map((k) => places[3 * n + k]);
  }

  /// Enlarges a pair, its place in the centre, until it fills the picture.
  fit(n) {
    this.focus = this.contactPlace(n);
    const corners = this.step.pairs[n].elements.flat().map((i) => this.vertex(i, this.step.pairs[n].toi[0]));
    const reach = Math.max(...corners.map((corner) => Math.hypot(...corner.map((x, k) => x - this.focus[k]))));
    this.scale = Math.max(1, Math.min(mostScale, 0.6 / reach));
    this.place();
  }

  all() {
    this.focus = [0, 0, 0];
    this.scale = 1;
    this.place();
  }
}

// ---- The part of the page -----------------------------------------------------------------------

const steps = 4096;

/// \param show called with the number of the chosen pair
export class StepPart {
  constructor(step, viewpoint, canDraw, show) {
    this.step = step;
    // The shown pair, initially the first.
    this.chosen = step.pairs.length > 0 ? 0 : null;
    this.show = show;
    this.player = new Player(() => this.t, (t) => this.setTime(t));
    find("step").append(...this.parts());
    if (canDraw) {
      const figure = find("mesh");
      const scene = new Scene(figure, viewpoint, (factor) => {
        this.picture.zoom(factor);
        this.update();
      });
      this.picture = new StepPicture(scene, step);
    } else {
      find("mesh").replaceChildren(make("p", { class: "warning" }, "This browser has no WebGL, which the picture needs."));
    }
    this.setTime(step.pairs.length > 0 ? step.pairs[0].toi[1] : 0);
  }

  parts() {
    const { step } = this;
    const one = step.isAtRest ? "intersection" : "collision";
    const count = step.total === 1 ? `1 ${one}` : `${step.total} ${one}s`;
    const first = step.pairs.length > 0 && !step.isAtRest ? `, the first at t = ${doubleText(step.pairs[0].toi[0])}` : "";
    const isThick = step.pairs.some((pair) => pair.min_separation > step.min_separation);
    const separation = step.min_separation > 0 || isThick
      ? ` within ${doubleText(step.min_separation)} (${step.norm})${isThick ? " and the thickness of groups" : ""}` : "";
    const elements = `${step.before.length / 3} vertices, ${step.faces.length / 3} faces`;
    return [
      make("h2", {}, step.label),
      make("p", {}, make("strong", { id: "step_verdict" }, `${step.total === 0 ? `No ${one}` : count + first}${separation}.`), ` ${elements}.`),
      make("div", { class: "step" },
        figure("mesh", `The mesh; a diamond at the place of each ${one}${step.isAtRest ? "" : ", full after its time of impact"}`),
        make("div", {},
          make("ol", { id: "pairs", tabindex: "0", "aria-label": step.isAtRest ? "Intersections" : "Collisions, by time" },
            ...step.pairs.slice(0, listed).map((pair, i) => make("li", {}, make("button", { type: "button", onclick: () => this.choose(i) },
              make("span", {}, pair.name), step.isAtRest ? ` ${pair.kind}` : ` t ≈ ${doubleText(Number(pair.toi[0].toPrecision(6)))}`)))),
          step.total > listed ? make("p", {}, `and ${step.total - listed} more`) : null)),
      make("div", { class: "controls" },
        make("button", { type: "button", id: "step_play", hidden: step.isAtRest, onclick: () => this.player.toggle() }, "Play"),
        make("label", { class: "wide", hidden: step.isAtRest }, "time t", make("input", { type: "range", id: "step_time", min: 0, max: steps,
          oninput: (event) => this.setTime(event.target.valueAsNumber / steps) })),
        make("output", { id: "step_now" }),
        make("button", { type: "button", id: "step_all", onclick: () => {
          if (this.picture) this.picture.all();
          this.update();
        } }, "All")),
    ];
  }

  /// The number of pairs whose time of impact has passed.
  get collidedSoFar() {
    const { pairs } = this.step;
    let [low, high] = [0, pairs.length];
    while (low < high) {
      const middle = (low + high) >> 1;
      if (pairs[middle].toi[0] <= this.t) low = middle + 1;
      else high = middle;
    }
    return low;
  }

  setTime(t) {
    this.t = t;
    this.update();
  }

  update() {
    const { collidedSoFar } = this;
    if (this.picture) this.picture.draw(this.t, collidedSoFar, this.chosen);
    find("step_time").value = Math.round(this.t * steps);
    find("step_play").textContent = this.player.isPlaying ? "Stop" : "Play";
    const { pairs, total } = this.step;
    const all = total > pairs.length ? `the first ${pairs.length}` : String(total);
    find("step_now").textContent = this.step.isAtRest ? this.placeText() : `t = ${doubleText(this.t)}, ${collidedSoFar} of ${all} have collided`;
    for (const [i, item] of [...find("pairs").children].entries()) {
      item.classList.toggle("past", i < collidedSoFar);
      item.classList.toggle("chosen", i === this.chosen);
    }
  }

  /// What the elements of the shown pair have in common.
  placeText() {
    if (this.chosen === null) return "";
    const { kind, place } = this.step.pairs[this.chosen];
    const [from, to] = place.map((point) => point.map((x) => doubleText(Number(x.toPrecision(6)))).join(" "));
    return `${kind}: ${from}${from === to ? "" : ` to ${to}`}`;
  }

  choose(n) {
    this.chosen = n;
    if (this.picture) this.picture.fit(n);
    this.setTime(this.step.pairs[n].toi[1]);
    this.show(n);
  }
}
