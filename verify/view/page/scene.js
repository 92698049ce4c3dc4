// A three-dimensional picture of the ball of radius 1, drawn by three.js, with names as text above
// it.
//
// All pictures of a page have the same viewpoint. Their contents are a list of shapes, each in a
// colour of the page's style; a picture is drawn only after a change.

import * as THREE from "three";

const fieldOfView = 28;
const distance = 1.02 / Math.sin((fieldOfView / 2) * (Math.PI / 180));

/// The object fills this part of the picture, but is not enlarged more than this.
const filledPart = 0.8;
const mostEnlarged = 5;

/// The distance in pixels within which a point is grabbed.
const grabDistance = 18;

/// The common viewpoint of all pictures, and their upward axis.
export class Viewpoint {
  constructor(up) {
    this.up = up;
    this.home();
    this.listeners = [];
  }
  home() {
    this.around = -0.9;
    this.above = 0.42;
  }
  change() {
    for (const listener of this.listeners) listener();
  }
  turn(around, above) {
    this.around += around;
    this.above = Math.max(-1.55, Math.min(1.55, this.above + above));
    this.change();
  }
  /// Changes the upward axis.
  tilt() {
    this.up = (this.up + 1) % 3;
    this.change();
  }
  place(camera) {
    const [x, y, z] = [Math.cos(this.above) * Math.cos(this.around), Math.cos(this.above) * Math.sin(this.around), Math.sin(this.above)];
    // The axes in their cyclic order, so that the picture is turned and not mirrored.
    const turned = (a, b, c) => [[c, a, b], [b, c, a], [a, b, c]][this.up];
    camera.up.set(...turned(0, 0, 1));
    camera.position.set(...turned(x, y, z)).multiplyScalar(distance);
    camera.lookAt(0, 0, 0);
  }
}

const tube = new THREE.CylinderBufferGeometry(1, 1, 1, 10);
const dots = {
  ball: new THREE.SphereBufferGeometry(1, 20, 12),
  box: new THREE.BoxBufferGeometry(1.7, 1.7, 1.7),
  star: new THREE.OctahedronBufferGeometry(1.5),
};
const arrowHead = new THREE.ConeBufferGeometry(1, 2.6, 14);
const up = new THREE.Vector3(0, 1, 0);
const vector = (point) => new THREE.Vector3(...point);

/// A colour of the page's style, as it is at present.
export const styleColor = (name) =>
  new THREE.Color(getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim());

export class Scene {
  /// \param figure an element with a canvas and an element of class "names"
  /// \param zoom called with a factor when the user zooms
  constructor(figure, viewpoint, zoom) {
    this.canvas = figure.querySelector("canvas");
    this.names = figure.querySelector(".names");
    this.viewpoint = viewpoint;
    this.renderer = new THREE.WebGLRenderer({ canvas: this.canvas, antialias: true, alpha: true, preserveDrawingBuffer: true });
    this.renderer.setPixelRatio(Math.min(window.devicePixelRatio || 1, 2));
    this.camera = new THREE.PerspectiveCamera(fieldOfView, 1, distance / 50, distance * 4);
    this.scene = new THREE.Scene();
    this.scene.add(new THREE.AmbientLight(0xffffff, 0.62));
    const sun = new THREE.DirectionalLight(0xffffff, 0.5);
    sun.position.set(0.4, -0.8, 1);
    this.scene.add(sun);
    // The parts that do not depend on the time, and those that do.
    this.still = new THREE.Group();
    this.moving = new THREE.Group();
    this.scene.add(this.still, this.moving);
    this.content = this.moving;
    this.labels = [];
    this.extent = [];
    // The size of the part that is shown, of the whole picture.
    this.part = 1;
    this.zoom = zoom;
    // The object that drags points: begin() returns true if a drag may begin, move(handle, point) moves, end() ends.
    this.drag = null;
    viewpoint.listeners.push(() => this.render());
    new ResizeObserver(() => this.render()).observe(this.canvas);
    this.listen();
    this.listenToPrinter();
  }

  // ---- Contents ---------------------------------------------------------------------------------

  /// Starts the part that does not depend on the time, or the one that does: it replaces the
  /// previous one.
  begin(group) {
    this.content = group;
    for (const child of group.children) {
      if (child.userData.isOwn) child.geometry.dispose();
      child.material.dispose();
    }
    group.remove(...group.children);
    if (group === this.still) return;
    this.names.replaceChildren();
    this.labels = [];
  }

  add(geometry, material, isOwn) {
    const mesh = new THREE.Mesh(geometry, material);
    mesh.userData.isOwn = isOwn;
    this.content.add(mesh);
    return mesh;
  }

  /// A rod from a to b.
  rod(a, b, color, radius = 0.012) {
    const [from, to] = [vector(a), vector(b)];
    const length = from.distanceTo(to);
    if (!(length > 0)) return;
    const mesh = this.add(tube, new THREE.MeshLambertMaterial({ color: styleColor(color) }));
    mesh.position.copy(from).add(to).multiplyScalar(0.5);
    mesh.quaternion.setFromUnitVectors(up, to.sub(from).divideScalar(length));
    mesh.userData.resize = (part) => mesh.scale.set(part * radius, length, part * radius);
  }

  arrow(a, b, color, radius = 0.01) {
    this.rod(a, b, color, radius);
    const head = this.add(arrowHead, new THREE.MeshLambertMaterial({ color: styleColor(color) }));
    head.position.copy(vector(b));
    head.quaternion.setFromUnitVectors(up, vector(b).sub(vector(a)).normalize());
    head.userData.resize = (part) => head.scale.setScalar(part * radius * 2.6);
  }

  dot(point, color, shape = "ball", size = 0.028) {
    const mesh = this.add(dots[shape], new THREE.MeshLambertMaterial({ color: styleColor(color) }));
    mesh.position.set(...point);
    mesh.userData.resize = (part) => mesh.scale.setScalar(part * size);
  }

  /// Thin lines, each a list of points.
  lines(lists, color, opacity = 1, dash = 0) {
    const ends = lists.flatMap((points) => points.slice(1).flatMap((point, i) => [...points[i], ...point]));
    if (ends.length === 0) return;
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", new THREE.BufferAttribute(new Float32Array(ends), 3));
    const look = { color: styleColor(color), transparent: true, opacity, depthWrite: false };
    const material = dash > 0 ? new THREE.LineDashedMaterial({ ...look, dashSize: dash, gapSize: dash })
      : new THREE.LineBasicMaterial(look);
    const lines = new THREE.LineSegments(geometry, material);
    if (dash > 0) lines.computeLineDistances();
    lines.userData.isOwn = true;
    this.content.add(lines);
  }

  /// Plane polygons, convex, seen from both sides.
  surfaces(polygons, color, opacity) {
    const corners = polygons.flatMap((polygon) =>
      polygon.slice(2).flatMap((point, i) => [...polygon[0], ...polygon[i + 1], ...point]));
    if (corners.length === 0) return;
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", new THREE.BufferAttribute(new Float32Array(corners), 3));
    this.add(geometry, new THREE.MeshBasicMaterial({ color: styleColor(color), transparent: true, opacity,
      side: THREE.DoubleSide, depthWrite: false }), true);
  }

  /// A ball or a cube around a point: the points within a distance.
  neighbourhood(center, radius, isBall, color) {
    const geometry = isBall ? new THREE.SphereBufferGeometry(radius, 24, 16)
      : new THREE.BoxBufferGeometry(2 * radius, 2 * radius, 2 * radius);
    const material = new THREE.MeshBasicMaterial({ color: styleColor(color), wireframe: true, transparent: true, opacity: 0.25 });
    this.add(geometry, material, true).position.set(...center);
  }

  /// \param handle the argument of move() if the user drags the point; nothing if it stays
  name(point, text, color, handle = null) {
    const span = document.createElement("span");
    span.textContent = text;
    span.style.color = `var(--${color})`;
    this.names.append(span);
    this.labels.push({ span, point: vector(point), handle });
  }

  /// The points of the object, which is to fill the picture.
  setExtent(points) {
    this.extent = points.map(vector);
    this.aim();
  }

  // ---- Drawing ----------------------------------------------------------------------------------

  /// Adapts the picture to its size on the page. Called for every drawing, because an observer
  /// reports a new size only after the next frame.
  fit() {
    const { clientWidth: width, clientHeight: height } = this.canvas;
    const drawn = this.renderer.getSize(new THREE.Vector2());
    if (width === 0 || height === 0) return;
    if (height === drawn.y && width / height === this.camera.aspect) return;
    this.renderer.setSize(width, height, false);
    this.camera.aspect = width / height;
    // The ball fits the shorter side.
    this.camera.zoom = Math.min(1, width / height);
    this.camera.updateProjectionMatrix();
  }

  render() {
    this.aim();
    this.renderer.render(this.scene, this.camera);
    this.placeNames();
  }

  /// Shows the part of the picture that the object is in. Rods and dots keep their size on the page.
  aim() {
    const { camera } = this;
    this.fit();
    this.viewpoint.place(camera);
    camera.clearViewOffset();
    camera.updateMatrixWorld();
    if (this.extent.length > 0) this.enlarge();
    this.scene.traverse(({ userData: { resize } }) => resize && resize(this.part));
  }

  enlarge() {
    const { camera } = this;
    const seen = this.extent.map((point) => point.clone().project(camera));
    const [across, up] = ["x", "y"].map((axis) => {
      const places = seen.map((point) => point[axis]);
      return { from: Math.min(...places), to: Math.max(...places) };
    });
    const size = Math.max(across.to - across.from, up.to - up.from) / (2 * filledPart);
    const part = Math.max(size, 1 / mostEnlarged);
    this.part = part;
    const { clientWidth: width, clientHeight: height } = this.canvas;
    const x = (1 + (across.from + across.to) / 2 - part) * (width / 2);
    const y = (1 - (up.from + up.to) / 2 - part) * (height / 2);
    camera.setViewOffset(width, height, x, y, part * width, part * height);
  }

  /// Names are placed beside their points, away from the centre of all, or below one another if
  /// they would overlap.
  placeNames() {
    const { clientWidth: width, clientHeight: height } = this.canvas;
    const places = this.labels.map(({ point }) => this.seen(point));
    const across = places.map(({ x }) => x);
    const middle = across.reduce((sum, x) => sum + x / across.length, 0);
    const left = middle - (Math.max(...across) - Math.min(...across)) / 10;
    const taken = [];
    for (const [i, { span }] of this.labels.entries()) {
      const wide = span.offsetWidth + 4;
      const isLeft = places[i].x < left;
      const x = Math.max(2, Math.min(places[i].x + (isLeft ? -9 - span.offsetWidth : 9), width - wide));
      let y = Math.max(2, Math.min(places[i].y - 20, height - 20));
      const overlaps = (other) => Math.abs(other.y - y) < 16 && x < other.x + other.wide && other.x < x + wide;
      for (let i = 0; i < 16 && taken.some(overlaps); ++i) y += 8;
      taken.push({ x, y, wide });
      span.style.transform = `translate(${x}px, ${y}px)`;
    }
  }

  /// Browsers print a WebGL canvas as an empty one: on paper an image of it is placed before it,
  /// with the same size on the screen and on paper.
  listenToPrinter() {
    const place = this.canvas.parentElement, image = document.createElement("img");
    image.alt = "";
    window.addEventListener("beforeprint", () => {
      place.classList.add("printed");
      this.render();
      image.src = this.canvas.toDataURL();
      this.canvas.after(image);
    });
    window.addEventListener("afterprint", () => {
      image.remove();
      place.classList.remove("printed");
      this.render();
    });
  }

  // ---- Input ------------------------------------------------------------------------------------

  /// A point where the canvas shows it, and its depth.
  seen(point) {
    const { x, y, z } = point.clone().project(this.camera);
    return { x: ((x + 1) / 2) * this.canvas.clientWidth, y: ((1 - y) / 2) * this.canvas.clientHeight, depth: z };
  }

  /// The position of a pointer on the canvas.
  placeOf(event) {
    const { left, top } = this.canvas.getBoundingClientRect();
    return [event.clientX - left, event.clientY - top];
  }

  /// The point with a handle next to a place of the canvas; null if none is near.
  grabbed(event) {
    if (this.drag === null || !this.drag.begin()) return null;
    const [x, y] = this.placeOf(event);
    const near = this.labels.filter(({ handle }) => handle !== null)
      .map(({ handle, point }) => ({ handle, ...this.seen(point) }))
      .map((one) => ({ ...one, away: Math.hypot(one.x - x, one.y - y) }))
      .filter(({ away }) => away < grabDistance);
    return near.length === 0 ? null : near.reduce((a, b) => (b.away < a.away ? b : a));
  }

  /// Moves a grabbed point to a place of the canvas, in the plane that faces the viewer.
  moveTo(grabbed, event) {
    const { canvas } = this;
    const [x, y] = this.placeOf(event);
    const place = new THREE.Vector3((2 * x) / canvas.clientWidth - 1, 1 - (2 * y) / canvas.clientHeight, grabbed.depth);
    this.drag.move(grabbed.handle, place.unproject(this.camera).toArray());
  }

  listen() {
    const pointers = new Map();
    const { canvas, viewpoint } = this;
    let grabbed = null;
    const spread = () => {
      const [a, b] = [...pointers.values()];
      return Math.hypot(a.x - b.x, a.y - b.y);
    };
    canvas.addEventListener("pointerdown", (event) => {
      canvas.setPointerCapture(event.pointerId);
      pointers.set(event.pointerId, { x: event.clientX, y: event.clientY });
      grabbed = pointers.size === 1 ? this.grabbed(event) : null;
    });
    canvas.addEventListener("pointermove", (event) => {
      const last = pointers.get(event.pointerId);
      if (last === undefined) return;
      if (grabbed !== null) {
        this.moveTo(grabbed, event);
        return;
      }
      const before = pointers.size === 2 ? spread() : 0;
      pointers.set(event.pointerId, { x: event.clientX, y: event.clientY });
      if (pointers.size === 1) viewpoint.turn((last.x - event.clientX) / 150, (event.clientY - last.y) / 150);
      if (pointers.size === 2 && before > 0) this.zoom(spread() / before);
    });
    for (const end of ["pointerup", "pointercancel"]) {
      canvas.addEventListener(end, (event) => {
        pointers.delete(event.pointerId);
        if (grabbed !== null) this.drag.end();
        grabbed = null;
      });
    }
    canvas.addEventListener("wheel", (event) => {
      // Only with the keyboard's focus, so that a page can be scrolled over its pictures.
      if (document.activeElement !== canvas && !event.ctrlKey) return;
      event.preventDefault();
      this.zoom(2 ** (-event.deltaY / 240));
    }, { passive: false });
    canvas.addEventListener("keydown", (event) => {
      const turns = { ArrowLeft: [-0.1, 0], ArrowRight: [0.1, 0], ArrowUp: [0, 0.1], ArrowDown: [0, -0.1] };
      const zooms = { "+": 1.25, "=": 1.25, "-": 0.8 };
      if (turns[event.key]) viewpoint.turn(...turns[event.key]);
      else if (zooms[event.key]) this.zoom(zooms[event.key]);
      else return;
      event.preventDefault();
      event.stopPropagation();
    });
  }
}

/// True if this browser supports the pictures.
export function canDraw() {
  const canvas = document.createElement("canvas");
  return Boolean(canvas.getContext("webgl2") || canvas.getContext("webgl"));
}
