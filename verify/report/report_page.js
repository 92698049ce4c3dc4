"use strict";
// Writes and draws a report from the data in the page. Each form of figure is a function that draws one panel into an SVG
// of the available width; all numbers and words come from report.js.

const page = (function () {
  const parsed = (id) => report.parsed(document.getElementById(id).textContent);
  const contents = report.contentsOf(parsed("report"), parsed("published"));
  const { figures } = contents;
  const margin = { top: 10, right: 18, bottom: 44, left: 58 };
  const endBand = 26;  // room for zeros below a logarithmic axis, and for infinite values above any

  const color = (slot) => `var(--s${slot % 13})`;
  const symbol = (slot, size) => d3.symbol().type(d3.symbols[slot % d3.symbols.length]).size(size)();

  // ---- Words and scales -------------------------------------------------------------------------

  const superscript = (number) => String(number).replace("-", "⁻").replace(/\d/g, (d) => "⁰¹²³⁴⁵⁶⁷⁸⁹"[d]);

  function powerText(value) {
    const exponent = Math.round(Math.log10(value));
    if (exponent >= -1 && exponent <= 3) return String(Number(value.toPrecision(1)));
    return "10" + superscript(exponent);
  }

  function timeText(nanoseconds) {
    const units = [[1e9, "s"], [1e6, "ms"], [1e3, "µs"], [1, "ns"]];
    const [size, unit] = units.find(([least]) => nanoseconds >= least * 0.999) || units[3];
    return `${Number((nanoseconds / size).toPrecision(3))} ${unit}`;
  }

  const numberText = (value) => String(value).replace("Infinity", "∞");

  const isTime = (label) => /, ns$/.test(label);
  const axisTitle = (label) => label.replace(/, ns$/, "");

  /// A scale over the values, logarithmic or not. Infinite values have a separate place at the
  /// upper end, and zeros of a logarithmic scale have one at the lower end.
  function makeScale(values, isLog, range, label) {
    const finite = values.filter(Number.isFinite);
    const direction = Math.sign(range[1] - range[0]);
    const hasInfinite = values.includes(Infinity);
    const top = hasInfinite ? range[1] - direction * endBand : range[1];
    const infinite = hasInfinite ? range[1] : null;
    if (!isLog) {
      const scale = d3.scaleLinear().domain([0, d3.max(finite) || 1]).nice().range([range[0], top]);
      const place = (v) => (Number.isFinite(v) ? scale(v) : range[1]);
      return { place, ticks: scale.ticks(5), text: (v) => String(v), zero: null, infinite };
    }
    const text = isTime(label) ? timeText : powerText;
    const positive = finite.filter((v) => v > 0);
    const hasZero = positive.length < finite.length;
    const high = Math.min(Math.ceil(Math.log10(d3.max(positive) || 1)), 308);
    const low = Math.max(Math.min(Math.floor(Math.log10(d3.min(positive) || 1)), high - 1), -323);
    const bottom = hasZero ? range[0] + direction * endBand : range[0];
    const scale = d3.scaleLog().domain([Number(`1e${low}`), Number(`1e${high}`)]).range([bottom, top]);
    const space = Math.abs(top - bottom) / (direction > 0 ? 62 : 26);
    const step = [1, 2, 3, 5, 10, 20, 50, 100].find((one) => (high - low) / one <= space) || 200;
    const exponents = d3.range(Math.ceil(low / step) * step, high + 1, step);
    const ticks = exponents.map((exponent) => Number(`1e${exponent}`));
    const place = (v) => (v === Infinity ? range[1] : v > 0 ? scale(v) : range[0]);
    return { place, ticks, text, zero: hasZero ? range[0] : null, infinite };
  }

  /// A scale with evenly spaced values.
  function makeEvenScale(values, range) {
    const ticks = Array.from(new Set(values)).sort((a, b) => a - b);
    return { place: d3.scalePoint().domain(ticks).range(range), ticks, text: powerText, zero: null, infinite: null };
  }

  // ---- Parts of a drawing -----------------------------------------------------------------------

  let drawings = 0;

  function makeSvg(parent, width, height, title, description) {
    drawings += 1;
    const id = `drawing${drawings}`;
    const svg = d3.select(parent).append("svg")
      .attr("viewBox", `0 0 ${width} ${height}`)
      .attr("role", "img")
      .attr("aria-labelledby", `${id}title ${id}desc`);
    svg.append("title").attr("id", `${id}title`).text(title);
    svg.append("desc").attr("id", `${id}desc`).text(description);
    return svg;
  }

  function write(svg, x, y, text, anchor, kind) {
    return svg.append("text").attr("x", x).attr("y", y).attr("text-anchor", anchor)
      .attr("class", kind).text(text);
  }

  function rule(svg, x1, y1, x2, y2, kind) {
    svg.append("line").attr("class", kind || "rule").attr("x1", x1).attr("y1", y1).attr("x2", x2).attr("y2", y2);
  }

  /// The place of values outside of the scale, with its name.
  const ends = (scale) => [[scale.zero, "0"], [scale.infinite, "∞"]].filter(([end]) => end !== null);

  function drawXAxis(svg, scale, box, label) {
    for (const tick of scale.ticks) {
      const x = scale.place(tick);
      rule(svg, x, box.top, x, box.bottom);
      write(svg, x, box.bottom + 16, scale.text(tick), "middle", "tick");
    }
    for (const [end, text] of ends(scale)) write(svg, end, box.bottom + 16, text, "middle", "tick");
    write(svg, (box.left + box.right) / 2, box.bottom + 36, axisTitle(label), "middle", "axis");
  }

  function drawYAxis(svg, scale, box) {
    for (const tick of scale.ticks) {
      const y = scale.place(tick);
      rule(svg, box.left, y, box.right, y);
      write(svg, box.left - 6, y + 4, scale.text(tick), "end", "tick");
    }
    for (const [end, text] of ends(scale)) {
      rule(svg, box.left, end, box.right, end, "rule zero");
      write(svg, box.left - 6, end + 4, text, "end", "tick");
    }
  }

  function drawMark(svg, x, y, slot, point, size, tip) {
    const mark = svg.append("path").attr("d", symbol(slot, size)).attr("transform", `translate(${x},${y})`)
      .style("stroke", color(slot)).style("stroke-width", point.open ? 1.6 : 0.5)
      .style("fill", point.open ? "var(--paper)" : color(slot));
    mark.append("title").text(tip);
  }

  function drawCurve(svg, points, slot, width, opacity) {
    svg.append("path").attr("d", d3.line()(points)).attr("fill", "none").style("stroke", color(slot))
      .style("stroke-width", width).style("opacity", opacity);
  }

  /// Possible places of a name of some width around a point, within the frame, the closest first:
  /// its box, the anchor of its text, and the end of a line that leads to it.
  function placesOfName(x, y, width, frame) {
    const sides = [9, 24, 48, 72].flatMap((dx) => [["start", dx], ["end", -dx - width]]).concat([["middle", -width / 2]]);
    const places = d3.cross(d3.range(-90, 91, 15), sides, (dy, [anchor, dx]) => {
      const left = Math.max(frame.left, Math.min(x + dx, frame.right + margin.right - width));
      const box = [left, y + dy - 6, left + width, y + dy + 6];
      const end = [Math.min(Math.max(x, box[0]), box[2]), Math.min(Math.max(y, box[1]), box[3])];
      return { box, anchor, end, distance: Math.hypot(end[0] - x, end[1] - y) };
    });
    const rank = ({ anchor, distance }) => distance + (anchor === "middle" ? 4 : 0);
    const isInside = ([, top, , bottom]) => top >= frame.top - 10 && bottom <= frame.bottom + 2;
    return d3.sort(places.filter((place) => isInside(place.box) && place.distance >= 6), rank);
  }

  /// Places each name beside its point such that it hides no point, no other name and none of the
  /// further boxes; a line, which crosses no other name if possible, leads to a name that is not
  /// next to its point.
  function drawNames(svg, names, box, further) {
    const taken = names.map(({ x, y }) => [x - 9, y - 9, x + 9, y + 9]).concat(further);
    const drawn = [];
    const overlaps = (a, b) => a[0] < b[2] && b[0] < a[2] && a[1] < b[3] && b[1] < a[3];
    for (const { x, y, text, strong } of d3.sort(names, (name) => -name.text.length)) {
      const isFree = ({ box: own }) => !taken.concat(drawn).some((other) => overlaps(own, other));
      const isCrossed = ({ end }) => d3.range(0, 1, 0.05)
        .map((s) => [x + s * (end[0] - x), y + s * (end[1] - y)])
        .some(([px, py]) => drawn.some((other) => overlaps([px, py, px, py], other)));
      const places = placesOfName(x, y, 6.8 * text.length + 2, box);
      const place = places.find((one) => isFree(one) && !isCrossed(one)) || places.find(isFree) || places[0];
      drawn.push(place.box);
      if (place.distance > 14) rule(svg, x, y, ...place.end, "leader");
      const at = { start: place.box[0], middle: (place.box[0] + place.box[2]) / 2, end: place.box[2] }[place.anchor];
      write(svg, at, place.box[1] + 10, text, place.anchor, "name").style("font-weight", strong ? 700 : 400);
    }
  }

  function frame(height, width) {
    return { left: margin.left, right: width - margin.right, top: margin.top, bottom: height - margin.bottom };
  }

  // ---- Forms ------------------------------------------------------------------------------------

  const valueText = (label, value) => (isTime(label) ? timeText(value) : numberText(value));
  const pointTip = (figure, series, point) =>
    `${series.name} ${point.label === series.name ? "" : point.label}\n` +
    `${axisTitle(figure.x_label)}: ${valueText(figure.x_label, point.x)}\n` +
    `${axisTitle(figure.y_label)}: ${valueText(figure.y_label, point.y)}`;

  /// True if it is drawn paler, beside another series of the same method.
  const isSecond = (series) => series.role === "faint" || / \(L2\)$/.test(series.name);

  const allPoints = (panel) => panel.series.flatMap((series) => series.points);

  function drawPlane(figure, panel, parent, width) {
    const height = Math.round(Math.max(300, Math.min(width * 0.72, 400)));
    const box = frame(height, width);
    const svg = makeSvg(parent, width, height, `${figure.title}: ${panel.title}`,
      `${figure.description} ${panel.caption}`);
    const points = allPoints(panel);
    const across = points.map((p) => p.x);
    const x = figure.x_even ? makeEvenScale(across, [box.left, box.right])
      : makeScale(across, figure.x_log, [box.left, box.right], figure.x_label);
    const y = makeScale(points.map((p) => p.y), figure.y_log, [box.bottom, box.top], figure.y_label);
    drawXAxis(svg, x, box, figure.x_label);
    drawYAxis(svg, y, box);
    return { svg, box, x, y };
  }

  /// Draws the front; returns the boxes of its lines.
  function drawFront(svg, front, x, y, box) {
    if (front.length === 0) return [];
    const corners = [[x.place(front[0].x), box.top]];
    front.forEach((point, i) => {
      if (i > 0) corners.push([x.place(point.x), corners[corners.length - 1][1]]);
      corners.push([x.place(point.x), y.place(point.y)]);
    });
    corners.push([box.right, corners[corners.length - 1][1]]);
    svg.append("path").attr("class", "front").attr("d", d3.line()(corners));
    return d3.pairs(corners, (a, b) => [Math.min(a[0], b[0]) - 1, Math.min(a[1], b[1]) - 1,
      Math.max(a[0], b[0]) + 1, Math.max(a[1], b[1]) + 1]);
  }

  function drawPoints(figure, panel, parent, width) {
    const { svg, box, x, y } = drawPlane(figure, panel, parent, width);
    const front = drawFront(svg, panel.front, x, y, box);
    const names = [];
    for (const series of panel.series) {
      const places = series.points.map((p) => [x.place(p.x), y.place(p.y)]);
      const isCurve = series.role === "curve";
      if (isCurve) drawCurve(svg, places, series.slot, 1.5, 0.7);
      series.points.forEach((point, i) => {
        drawMark(svg, ...places[i], series.slot, point, isCurve ? 18 : 90, pointTip(figure, series, point));
        if (!isCurve) {
          names.push({ x: places[i][0], y: places[i][1], text: point.label, strong: point.label === "certified" });
        }
      });
    }
    drawNames(svg, names, box, front);
  }

  function drawLines(figure, panel, parent, width) {
    const { svg, x, y } = drawPlane(figure, panel, parent, width);
    for (const series of panel.series) {
      const places = series.points.map((p) => [x.place(p.x), y.place(p.y)]);
      drawCurve(svg, places, series.slot, 2, isSecond(series) ? 0.45 : 1);
      series.points.forEach((point, i) => {
        drawMark(svg, ...places[i], series.slot, point, isSecond(series) ? 16 : 40, pointTip(figure, series, point));
      });
    }
  }

  function drawRidges(figure, panel, parent, width) {
    const names = Array.from(new Set(panel.series.map((series) => series.name)));
    const half = 19;
    const top = 8;
    const height = top + 2 * half * names.length + margin.bottom;
    const left = Math.min(150, 12 + 6.8 * d3.max(names, (name) => name.length));
    const box = { left, right: width - margin.right, top, bottom: height - margin.bottom };
    const svg = makeSvg(parent, width, height, `${figure.title}: ${panel.title}`, figure.description);
    const factor = 10 ** (1 / 8);
    const times = allPoints(panel).flatMap((p) => [p.x, p.x * factor]);
    const x = makeScale(times, true, [box.left, box.right], figure.x_label);
    drawXAxis(svg, x, box, figure.x_label);
    const tallest = d3.max(allPoints(panel), (p) => p.y) || 1;
    for (const series of panel.series) {
      const line = top + half * (2 * names.indexOf(series.name) + 1);
      const sign = series.role === "no_collisions" ? -1 : 1;
      const tone = series.role === "no_collisions" ? "var(--no-collision)" : "var(--collision)";
      for (const point of series.points) {
        const from = x.place(point.x);
        const tall = (half - 2) * Math.sqrt(point.y / tallest);
        svg.append("rect").attr("x", from).attr("width", Math.max(x.place(point.x * factor) - from - 0.5, 1))
          .attr("y", sign < 0 ? line - tall : line).attr("height", tall).style("fill", tone)
          .append("title").text(`${series.name}, ${series.role}\nfrom ${timeText(point.x)}: ` +
            `${(100 * point.y).toPrecision(3)} % of them`);
      }
    }
    names.forEach((name, i) => {
      const line = top + half * (2 * i + 1);
      rule(svg, box.left, line, box.right, line);
      write(svg, box.left - 6, line + 4, name, "end", "name").style("font-size", "11.5px");
    });
  }

  function drawBars(figure, panel, parent, width) {
    const rows = Array.from(new Set(allPoints(panel).map((point) => point.label)));
    const row = 46;
    const height = 8 + row * rows.length + margin.bottom;
    const box = { left: 14, right: width - margin.right, top: 8, bottom: height - margin.bottom };
    const svg = makeSvg(parent, width, height, `${figure.title}: ${panel.title}`, figure.description);
    const scale = d3.scaleLinear().domain([0, 1]).range([box.left, box.right]);
    const ticks = [0, 0.25, 0.5, 0.75, 1];
    const axis = { place: scale, ticks, text: (v) => `${100 * v} %`, zero: null, infinite: null };
    drawXAxis(svg, axis, box, figure.x_label);
    const filled = new Map(rows.map((name) => [name, 0]));
    for (const series of panel.series) {
      for (const point of series.points) {
        const from = filled.get(point.label);
        filled.set(point.label, from + point.x);
        svg.append("rect").attr("x", scale(from)).attr("width", scale(point.x) - scale(0))
          .attr("y", box.top + row * rows.indexOf(point.label) + 18).attr("height", 20)
          .style("fill", color(series.slot + 1)).style("stroke", "var(--paper)")
          .append("title").text(`${series.name}: ${(100 * point.x).toPrecision(3)} %`);
      }
    }
    rows.forEach((name, i) => write(svg, box.left, box.top + row * i + 13, name, "start", "name"));
  }

  // ---- Grids ------------------------------------------------------------------------------------

  const markColors = { N: "var(--bad)", T: "var(--toi)", t: "var(--toi)", E: "var(--error)", B: "var(--beyond)" };

  const shade = (tone, depth) => `rgba(var(--${tone}), ${depth})`;

  function percentText(rate) {
    const value = 100 * rate;
    if (value > 0 && value < 1) return "<1%";
    return `${Math.round(value > 99 && value < 100 ? 99 : value)}%`;
  }

  /// A short text of a number: two digits, or one and a power of ten.
  function shortText(value) {
    if (value === 0 || value === Infinity) return numberText(value);
    if (value >= 0.01 && value < 9950) return String(Number(value.toPrecision(2)));
    return value.toExponential(0).replace("e+", "e");
  }

  function shortTimeText(nanoseconds) {
    const units = [[1e9, "s"], [1e6, "ms"], [1e3, "µs"]];
    const [size, unit] = units.find(([least]) => nanoseconds >= least * 0.995) || [1, "ns"];
    return shortText(nanoseconds / size) + unit;
  }

  const cellText = (figure, value) => (isTime(figure.y_label) ? shortTimeText(value) : shortText(value));

  /// The appearance of a cell: its fill, its texts from the longest to the shortest, and their
  /// colour.
  function markLook(point) {
    if (point.label === "") return { fill: "var(--calm)", texts: [] };
    const kind = point.label[0];
    if (kind === "!") return { fill: "var(--calm)", texts: ["!"], ink: "var(--error)", weight: 700 };
    if (kind !== "P") {
      const percents = percentText(point.y).replace("%", "");
      return { fill: markColors[kind],
        texts: [`${point.label} ${percents}`, point.label + percents, point.label],
        ink: "var(--paper)", weight: 700 };
    }
    const text = percentText(point.y) + point.label.slice(1);
    return { fill: shade("mild", 0.25 + 0.75 * point.y), texts: [text, text.replace("%", "")],
      ink: point.y > 0.5 ? "var(--paper)" : "var(--ink)" };
  }

  /// The least and the greatest of the finite numbers above 0 in a figure.
  const extentOf = (figure) => d3.extent(figure.panels.flatMap(allPoints).map((point) => point.y)
    .filter((y) => y > 0 && Number.isFinite(y)));

  /// The place of a number on the logarithmic scale of its figure: from 0.1 to 1, and less for zero.
  function depthOf(value, [least, greatest]) {
    if (value === 0 || least === undefined) return 0.04;
    if (value === Infinity || greatest === least) return 1;
    return 0.1 + 0.9 * Math.log(value / least) / Math.log(greatest / least);
  }

  function shadeLook(point, figure, extent) {
    if (Number.isNaN(point.y)) return { fill: "none", frame: "var(--line)", texts: [] };
    const depth = depthOf(point.y, extent);
    return { fill: shade("number", depth), ink: depth > 0.5 ? "var(--paper)" : "var(--ink)",
      texts: [cellText(figure, point.y)] };
  }

  const pen = document.createElement("canvas").getContext("2d");
  const widths = new Map();

  /// The width of a cell's text as drawn.
  function widthOf(text, weight) {
    const key = `${weight}${text}`;
    if (!widths.has(key)) {
      pen.font = `${weight} 11px system-ui, "DejaVu Sans", sans-serif`;
      widths.set(key, pen.measureText(text).width);
    }
    return widths.get(key);
  }

  function drawCell(svg, look, x, y, width, height, tip) {
    svg.append("rect").attr("x", x).attr("y", y).attr("width", width).attr("height", height)
      .style("fill", look.fill).style("stroke", look.frame || "none").append("title").text(tip);
    const weight = look.weight || 400;
    const text = look.texts.find((one) => widthOf(one, weight) <= width - 2);
    if (text === undefined) return;
    write(svg, x + width / 2, y + 11.5, text, "middle", "tick cell").style("fill", look.ink)
      .style("font-weight", weight).style("pointer-events", "none");
  }

  const gridTip = (figure, panel, series, point) =>
    `${series.name}, ${series.role === "vf" ? "vertex-face" : "edge-edge"}, ${panel.title} 2${superscript(point.x)}: ` +
    (figure.form === "shades" ? (Number.isNaN(point.y) ? "not known" : valueText(figure.y_label, point.y))
      : point.label === "" ? "nothing wrong" : `${point.label} ${percentText(point.y)}`) +
    (point.tip ? `\n${point.tip}` : "");

  function drawGrid(figure, panel, parent, width) {
    const row = 16;
    const top = 8;
    const left = Math.min(180, 34 + 6.6 * d3.max(panel.series, (series) => series.name.length));
    const levels = Array.from(new Set(allPoints(panel).map((point) => point.x)));
    const cell = (width - left - 4) / levels.length;
    const height = top + row * panel.series.length + 40;
    const svg = makeSvg(parent, width, height, `${figure.title}: ${panel.title}`,
      `${figure.description} ${panel.caption}`);
    const extent = extentOf(figure);
    panel.series.forEach((series, i) => {
      const y = top + row * i;
      if (i === 0 || panel.series[i - 1].name !== series.name) {
        write(svg, left - 26, y + 12, series.name, "end", "name").style("font-size", "11.5px");
      }
      write(svg, left - 6, y + 12, series.role, "end", "tick");
      for (const point of series.points) {
        const look = figure.form === "shades" ? shadeLook(point, figure, extent) : markLook(point);
        drawCell(svg, look, left + cell * levels.indexOf(point.x), y, cell - 1.5, row - 1.5,
          gridTip(figure, panel, series, point));
      }
    });
    const every = cell < 30 ? 2 : 1;
    levels.forEach((level, i) => {
      if (i % every !== 0) return;
      write(svg, left + cell * (i + 0.5), height - 24, panel.powers ? `2${superscript(level)}` : `${level}`, "middle",
        "tick");
    });
    // In the middle, and inside if it is wide.
    const half = 3.1 * panel.caption.length;
    write(svg, Math.min((left + width) / 2, width - half), height - 6, panel.caption, "middle", "axis");
  }

  const forms = { points: drawPoints, lines: drawLines, ridges: drawRidges, bars: drawBars, marks: drawGrid,
    shades: drawGrid };

  /// True if the label of its y axis is above it.
  const hasYCaption = (figure) => figure.y_label !== "" && ![drawRidges, drawGrid].includes(forms[figure.form]);

  // ---- Legends ----------------------------------------------------------------------------------

  const legendsOfForms = {
    ridges: [["var(--no-collision)", "do not collide (above)"], ["var(--collision)", "collide (below)"]],
    marks: [["var(--calm)", "pale and empty: every answer is right"], ["var(--bad)", "N false negatives"], ["var(--toi)", "T time of impact"],
      ["var(--error)", "E errors"], ["var(--beyond)", "B beyond its tolerance"],
      [shade("mild", 0.35), "some false positives"], [shade("mild", 1), "all misses are"],
      ["var(--line)", "! errors or hangs besides"]],
  };

  /// The legend of a figure's colours: tone and name of each, and optionally symbol and opacity.
  function legendOf(figure) {
    if (figure.form in legendsOfForms) return legendsOfForms[figure.form];
    if (figure.form === "shades") {
      const extent = extentOf(figure);
      return extent.filter((one) => one !== undefined)
        .map((value) => [shade("number", depthOf(value, extent)), cellText(figure, value)]);
    }
    const seen = new Map();
    for (const series of figure.panels.flatMap((panel) => panel.series)) {
      if (!seen.has(series.name)) seen.set(series.name, series);
    }
    const isBar = figure.form === "bars";
    return Array.from(seen.values()).sort((a, b) => a.slot - b.slot)
      .map((series) => [color(series.slot + (isBar ? 1 : 0)), series.name,
        isBar ? null : symbol(series.slot, 70), isSecond(series) ? 0.45 : 1]);
  }

  function drawSwatch(svg, x, y, tone, shape, opacity) {
    svg.append("path").attr("d", shape || "M-7,-5H7V5H-7Z").attr("transform", `translate(${x},${y})`)
      .style("fill", tone).style("opacity", opacity || 1);
  }

  /// True if every point of the figure has its name beside it.
  const isNamed = (figure) =>
    figure.panels.every((panel) => panel.series.every((series) => series.role === "point"));

  function drawLegend(figure, element) {
    if (isNamed(figure)) return;
    for (const [tone, name, shape, opacity] of legendOf(figure)) {
      const item = d3.select(element).append("span");
      const svg = item.append("svg").attr("width", 16).attr("height", 14).attr("aria-hidden", "true");
      drawSwatch(svg, 8, 7, tone, shape, opacity);
      item.append("b").style("font-weight", 400).text(name);
    }
  }

  // ---- Pictures ---------------------------------------------------------------------------------

  const pictureStyle = document.querySelector("style").textContent.split("/* ---- The page")[0];

  /// Draws a legend into a picture; returns its height.
  function drawPictureLegend(svg, figure, width) {
    if (isNamed(figure)) return 0;
    let x = 8;
    let y = 10;
    for (const [tone, name, shape, opacity] of legendOf(figure)) {
      const wide = 6.6 * name.length + 34;
      if (x > 8 && x + wide > width) [x, y] = [8, y + 18];
      drawSwatch(svg, x, y, tone, shape, opacity);
      write(svg, x + 13, y + 4, name, "start", "name");
      x += wide;
    }
    return y + 14;
  }

  /// A figure as a separate SVG file with its style: its legend, if the points have no names, and
  /// its panels in two columns.
  function pictureOf(figure) {
    const wide = 440;
    const gap = 24;
    const head = hasYCaption(figure) ? 40 : 24;
    const across = Math.min(figure.panels.length, 2);
    const width = across * wide + (across + 1) * gap;
    const svg = d3.create("svg").attr("role", "img").attr("aria-label", figure.title);
    svg.append("style").text(pictureStyle);
    const paper = svg.append("rect").attr("class", "paper").attr("width", width);
    const inside = svg.append("svg").attr("x", gap).attr("y", gap / 2);
    let bottom = drawPictureLegend(inside, figure, width - 2 * gap);
    let top = bottom;
    const before = drawings;
    drawings = 0;  // so that the names of its parts are always the same
    figure.panels.forEach((panel, i) => {
      const x = (i % across) * (wide + gap);
      if (i % across === 0) top = bottom;
      write(inside, x, top + 16, panel.title, "start", "title");
      if (hasYCaption(figure)) write(inside, x, top + 34, `↑ ${axisTitle(figure.y_label)}`, "start", "axis");
      forms[figure.form](figure, panel, inside.node(), wide);
      const height = Number(inside.node().lastChild.getAttribute("viewBox").split(" ")[3]);
      d3.select(inside.node().lastChild).attr("x", x).attr("y", top + head).attr("width", wide).attr("height", height);
      bottom = Math.max(bottom, top + head + height + gap / 2);
    });
    drawings = before;
    const height = bottom + gap / 2;
    paper.attr("height", height);
    svg.attr("width", width).attr("height", height).attr("viewBox", `0 0 ${width} ${height}`);
    // Each element is on a separate line, so that two pictures can be compared.
    return new XMLSerializer().serializeToString(svg.node()).replace(/></g, ">\n<") + "\n";
  }

  // ---- Tables -----------------------------------------------------------------------------------

  /// The number at the beginning of a cell, after a sign for a fault; NaN if there is none.
  const numberOf = (text) => parseFloat(text.replace(/^✗ /, ""));

  /// Cells without a number are last in both orders.
  function isBefore(a, b, direction) {
    const [x, y] = [numberOf(a), numberOf(b)];
    if (Number.isNaN(x) && Number.isNaN(y)) return direction * a.localeCompare(b);
    if (Number.isNaN(x) || Number.isNaN(y)) return Number.isNaN(x) - Number.isNaN(y);
    return direction * (x - y);
  }

  function sortRows(table, column, direction) {
    const rows = Array.from(table.tBodies[0].rows);
    rows.sort((a, b) => isBefore(a.cells[column].textContent, b.cells[column].textContent, direction));
    table.tBodies[0].append(...rows);
  }

  /// Turns the names of the columns into buttons for sorting: upwards, then downwards.
  function makeSortable(table) {
    const heads = Array.from(table.tHead.rows[0].cells);
    heads.forEach((head, column) => {
      const button = document.createElement("button");
      button.type = "button";
      button.textContent = head.textContent;
      head.replaceChildren(button);
      button.addEventListener("click", () => {
        const direction = head.ariaSort === "ascending" ? -1 : 1;
        heads.forEach((other) => other.removeAttribute("aria-sort"));
        head.ariaSort = direction > 0 ? "ascending" : "descending";
        sortRows(table, column, direction);
      });
    });
  }

  /// True if the column holds false negatives.
  const isMisses = (column) => /(^| )FN$/.test(column);

  /// True if it is a number above 0, or a change from one or to one.
  const isCount = (text) => /^[1-9]|^0 of/.test(text);

  const isWord = (column) => ["method", "norm", "kind"].includes(column);

  function writeTable(parent, table) {
    const element = parent.append("div").attr("class", "scroll").attr("tabindex", 0).append("table")
      .attr("class", isMisses(table.columns[1] || "") ? "misses" : null);
    element.append("caption").text(table.title);
    const head = element.append("thead").append("tr");
    for (const column of table.columns) head.append("th").attr("scope", "col").text(column);
    const body = element.append("tbody");
    for (const texts of table.rows) {
      const row = body.append("tr");
      row.append("th").attr("scope", "row").text(texts[0]);
      texts.slice(1).forEach((text, i) => {
        const column = table.columns[i + 1];
        const isMissed = isMisses(column) && isCount(text);
        row.append("td").attr("class", isMissed ? "missed" : isWord(column) ? "word" : null)
          .text(isMissed ? `✗ ${text}` : text);
      });
    }
    makeSortable(element.node());
  }

  /// Sets the width of the first column in the style, which is the position of the second one.
  function keepColumns(table) {
    table.style.setProperty("--first", `${table.tHead.rows[0].cells[0].offsetWidth}px`);
  }

  // ---- Sections ---------------------------------------------------------------------------------

  const dataUrl = (type, text) => `data:${type};charset=utf-8,${encodeURIComponent(text)}`;

  const writeLink = (line, kind, file, text) =>
    line.append("a").attr("class", kind).attr("download", file).attr("href", "#").text(text);

  /// A line of links to the numbers of a table; it is returned.
  function writeLinks(parent, id, table) {
    const line = parent.append("p").attr("class", "origin");
    writeLink(line, "csv", `${id}.csv`, "CSV").attr("href", dataUrl("text/csv", report.csvOf(table)));
    return line;
  }

  function writeDetails(parent, title, texts) {
    const details = parent.append("details");
    details.append("summary").text(title);
    details.append("ul").selectAll("li").data(texts).join("li").text((text) => text);
  }

  function writeSection(parent, section) {
    const element = parent.append("section").attr("id", section.id);
    element.append("h2").text(section.title);
    section.tables.forEach((table, i) => {
      const id = `${section.id}_${i + 1}`;
      writeTable(element, table);
      writeLink(writeLinks(element, id, table), "markdown", `${id}.md`, "Markdown")
        .attr("href", dataUrl("text/markdown", report.markdownOf(table)));
    });
    if (section.meanings) writeDetails(element, "What the columns mean", section.meanings);
  }

  /// The frame of a figure, with its links; the picture is drawn on demand.
  function writeFigure(parent, figure) {
    const section = parent.append("section").attr("class", "figure").attr("id", figure.id);
    section.append("h2").text(figure.title);
    section.append("p").text(figure.description);
    section.append("div").attr("class", "legend");
    section.append("div").attr("class", "panels");
    const link = writeLink(writeLinks(section, figure.id, figure.data), "svg", `${figure.id}.svg`, "SVG");
    link.on("click", () => link.attr("href", dataUrl("image/svg+xml", pictureOf(figure))));
  }

  function writeOpening(header) {
    header.append("h1").text(contents.title);
    header.append("p").text(contents.about);
    if (contents.interrupted) {
      header.append("p").attr("class", "warning")
        .text("Not all that was asked for is here: the time was over, or the run was interrupted.");
    }
    header.append("ul").attr("class", "findings").selectAll("li").data(contents.findings).join("li").text((text) => text);
  }

  /// The navigation: the origin of the numbers, and their places on the page.
  function writeNavigation(main) {
    main.append("p").text(`Made${contents.origin} by`);
    main.append("pre").attr("class", "command").text(contents.command);
    if (contents.groups.length !== 0) {
      writeDetails(main, "Data", contents.groups.map(({ name, kind, queries, digest }) =>
        `${name}, ${kind}: ${queries} queries, digest ${digest}`));
    }
    const list = main.append("nav").attr("aria-label", "Contents").append("ul");
    for (const { id, title } of [...contents.top, ...figures, ...contents.further]) {
      list.append("li").append("a").attr("href", `#${id}`).text(title);
    }
  }

  function writePage() {
    writeOpening(d3.select("header"));
    const main = d3.select("main");
    figures.slice(0, 1).forEach((figure) => writeFigure(main, figure));
    writeNavigation(main);
    contents.top.forEach((section) => writeSection(main, section));
    figures.slice(1).forEach((figure) => writeFigure(main, figure));
    contents.further.forEach((section) => writeSection(main, section));
  }

  // ---- The page ---------------------------------------------------------------------------------

  function drawFigure(figure) {
    const section = document.getElementById(figure.id);
    const legend = section.querySelector(".legend");
    const panels = section.querySelector(".panels");
    legend.textContent = "";
    panels.textContent = "";
    drawLegend(figure, legend);
    // All have their places before the first is drawn, as their number decides the widths.
    const places = figure.panels.map(() => panels.appendChild(document.createElement("figure")));
    for (const [i, panel] of figure.panels.entries()) {
      const element = places[i];
      const heading = document.createElement("h3");
      heading.textContent = panel.title;
      element.appendChild(heading);
      if (hasYCaption(figure)) {
        const axis = document.createElement("figcaption");
        axis.textContent = `↑ ${axisTitle(figure.y_label)}`;
        element.appendChild(axis);
      }
      forms[figure.form](figure, panel, element, Math.max(element.clientWidth, 280));
      if (panel.caption !== "" && forms[figure.form] !== drawGrid) {
        const caption = document.createElement("figcaption");
        caption.textContent = panel.caption;
        element.appendChild(caption);
      }
    }
  }

  writePage();
  const tables = Array.from(document.querySelectorAll("table"));

  /// Marks a table that is wider than its place.
  function markWide(table) {
    const place = table.parentElement;
    place.classList.toggle("wide", place.scrollWidth > place.clientWidth + 1);
  }

  function drawAll() {
    figures.forEach(drawFigure);
    tables.forEach(keepColumns);
    tables.forEach(markWide);
  }
  drawAll();
  let drawnWidth = window.innerWidth;
  window.addEventListener("resize", () => {
    if (window.innerWidth === drawnWidth) return;
    drawnWidth = window.innerWidth;
    drawAll();
  });

  return { contents, pictureOf };
})();
