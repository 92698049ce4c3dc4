"use strict";
// The page of `touchstone bench`: its rows as pictures of speed against error and of error over the level of difficulty, and as
// a table. All is computed and drawn here, with d3, from the rows in the page (bench_report.hpp names their fields).

const page = (function () {
  // ---- Rows -------------------------------------------------------------------------------------

  /// A number as JSON has it: an infinite one is a word, one that is not known is null.
  const number = (value) => Number(value ?? NaN);

  const share = (count, among) => (among === 0 ? 0 : count / among);

  function read(row) {
    const error = row.toi_error || {};
    const separation = row.min_separation > 0 ? `, d = ${row.min_separation} (${row.norm})` : "";
    return { ...row, place: `${row.source}, ${row.kind}${separation}`, time: number(row.ns_per_query),
      ratio: number(row.ns_per_query) / number(row.certified_ns_per_query),
      falsePositives: share(row.false_positives, row.judged - row.collisions),
      misses: share(row.false_negatives, row.collisions), late: row.late_toi,
      median: number(error.p50), greatest: number(error.max),
      isWrong: row.false_negatives + row.late_toi !== 0 };
  }

  const rows = JSON.parse(document.getElementById("rows").textContent).filter((row) => row.method !== undefined).map(read);
  const slots = new Map(Array.from(new Set(rows.map((row) => row.method)), (method, slot) => [method, slot]));

  // ---- Figures ----------------------------------------------------------------------------------

  /// A point than which no other is as small in both coordinates and smaller in one belongs to the front; by ascending x.
  function paretoFront(points) {
    const beats = (a, b) => a.x <= b.x && a.y <= b.y && (a.x < b.x || a.y < b.y);
    return d3.sort(points.filter((point) => !points.some((other) => beats(other, point))), (point) => point.x);
  }

  const settingOf = (row) => `tolerance ${row.tolerance}, at most ${row.max_checks} checks`;

  /// A panel for each place, a series for each method.
  function panelsOf(chosen, x, y, hasFront) {
    return Array.from(d3.group(chosen, (row) => row.place), ([title, all]) => {
      const known = all.filter((row) => !Number.isNaN(x(row)) && !Number.isNaN(y(row)));
      const series = Array.from(d3.group(known, (row) => row.method), ([name, of]) => ({ name, slot: slots.get(name),
        points: d3.sort(of.map((row) => ({ x: x(row), y: y(row), label: name, open: row.isWrong, tip: settingOf(row) })),
          (point) => point.x) }));
      const safe = series.flatMap((one) => one.points).filter((point) => !point.open);
      return { title, series, front: hasFront ? paretoFront(safe) : [] };
    }).filter((panel) => panel.series.length !== 0);
  }

  const hollow = "Hollow: there the method misses collisions, or gives times of impact after the exact one.";

  function speedFigure(title, yLabel, error) {
    return { title: `Time a query against ${title}`, about: "A point a method; a curve over its tolerances or limits of checks. " +
      `Down and to the left is better. Dashed: the Pareto front of those that miss nothing. ${hollow}`,
    xLabel: "time a query, ns", yLabel, isNamed: true,
    panels: panelsOf(rows.filter((row) => row.level === null), (row) => row.time, error, true) };
  }

  function levelFigure(title, yLabel, value) {
    const of = { title: `${title} over the level of difficulty`, about: hollow, xLabel: "level", yLabel, isNamed: false,
      panels: panelsOf(rows.filter((row) => row.level !== null), (row) => row.level, value, false) };
    const hasData = of.panels.some((panel) => panel.series.some((one) => one.points.some((point) => point.y !== 0)));
    return hasData ? of : { ...of, panels: [] };
  }

  const figures = [
    speedFigure("false positives", "false positives, of the queries that do not collide", (row) => row.falsePositives),
    speedFigure("the median error of the time of impact", "error of the time of impact, median", (row) => row.median),
    speedFigure("the greatest error of the time of impact", "error of the time of impact, greatest", (row) => row.greatest),
    levelFigure("Misses", "false negatives, of the collisions", (row) => row.misses),
    levelFigure("False positives", "false positives, of the queries that do not collide", (row) => row.falsePositives),
    levelFigure("The greatest error of the time of impact", "error of the time of impact, greatest", (row) => row.greatest),
    levelFigure("Time", "time a query, ns", (row) => row.time),
  ].filter((figure) => figure.panels.length !== 0);

  // ---- Words and scales -------------------------------------------------------------------------

  const superscript = (value) => String(value).replace("-", "⁻").replace(/\d/g, (d) => "⁰¹²³⁴⁵⁶⁷⁸⁹"[d]);

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

  const isTime = (label) => label.endsWith(", ns");
  const valueText = (label, value) => (isTime(label) ? timeText(value) : String(value).replace("Infinity", "∞"));
  const nameOf = (label) => label.replace(/, ns$/, "");

  const endBand = 26;  // room for zeros below a logarithmic axis, and for infinite values above it

  /// A scale of levels; or a logarithmic one, where zeros have a place at its lower end and infinite values at its upper end.
  function makeScale(values, range, label) {
    if (label === "level") {
      const scale = d3.scaleLinear().domain([d3.min(values), Math.max(d3.max(values), d3.min(values) + 1)]).range(range);
      return { place: scale, ticks: Array.from(new Set(values)), text: String, ends: [] };
    }
    const text = isTime(label) ? timeText : powerText;
    const direction = Math.sign(range[1] - range[0]);
    const finite = values.filter(Number.isFinite);
    const positive = finite.filter((v) => v > 0);
    const ends = [];
    if (positive.length < finite.length) ends.push([range[0], "0"]);
    if (finite.length < values.length) ends.push([range[1], "∞"]);
    const high = Math.min(Math.ceil(Math.log10(d3.max(positive) || 1)), 308);
    const low = Math.max(Math.min(Math.floor(Math.log10(d3.min(positive) || 1)), high - 1), -323);
    const bottom = positive.length < finite.length ? range[0] + direction * endBand : range[0];
    const top = finite.length < values.length ? range[1] - direction * endBand : range[1];
    const scale = d3.scaleLog().domain([Number(`1e${low}`), Number(`1e${high}`)]).range([bottom, top]);
    const space = Math.abs(top - bottom) / (direction > 0 ? 62 : 26);
    const step = [1, 2, 3, 5, 10, 20, 50, 100].find((one) => (high - low) / one <= space) || 200;
    const ticks = d3.range(Math.ceil(low / step) * step, high + 1, step).map((exponent) => Number(`1e${exponent}`));
    const place = (v) => (v === Infinity ? range[1] : v > 0 ? scale(v) : range[0]);
    return { place, ticks, text, ends };
  }

  // ---- Drawing ----------------------------------------------------------------------------------

  const margin = { top: 10, right: 18, bottom: 44, left: 58 };
  const [width, height] = [440, 317];
  const box = { left: margin.left, right: width - margin.right, top: margin.top, bottom: height - margin.bottom };

  const color = (slot) => `var(--s${slot % 13})`;
  const symbol = (slot, size) => d3.symbol().type(d3.symbols[slot % d3.symbols.length]).size(size)();

  const write = (svg, x, y, text, anchor, kind) =>
    svg.append("text").attr("x", x).attr("y", y).attr("text-anchor", anchor).attr("class", kind).text(text);

  const rule = (svg, x1, y1, x2, y2, kind) =>
    svg.append("line").attr("class", kind).attr("x1", x1).attr("y1", y1).attr("x2", x2).attr("y2", y2);

  function drawAxes(svg, x, y, xLabel) {
    for (const tick of x.ticks) {
      rule(svg, x.place(tick), box.top, x.place(tick), box.bottom, "rule");
      write(svg, x.place(tick), box.bottom + 16, x.text(tick), "middle", "tick");
    }
    for (const [end, text] of x.ends) write(svg, end, box.bottom + 16, text, "middle", "tick");
    write(svg, (box.left + box.right) / 2, box.bottom + 36, nameOf(xLabel), "middle", "axis");
    for (const tick of y.ticks) {
      rule(svg, box.left, y.place(tick), box.right, y.place(tick), "rule");
      write(svg, box.left - 6, y.place(tick) + 4, y.text(tick), "end", "tick");
    }
    for (const [end, text] of y.ends) {
      rule(svg, box.left, end, box.right, end, "rule zero");
      write(svg, box.left - 6, end + 4, text, "end", "tick");
    }
  }

  /// Possible places of a name of some width around a point, the closest first: its box, the anchor of its text, and the end
  /// of a line that leads to it.
  function placesOfName(x, y, wide) {
    const sides = [9, 24, 48, 72].flatMap((dx) => [["start", dx], ["end", -dx - wide]]).concat([["middle", -wide / 2]]);
    const places = d3.cross(d3.range(-90, 91, 15), sides, (dy, [anchor, dx]) => {
      const left = Math.max(box.left, Math.min(x + dx, box.right + margin.right - wide));
      const own = [left, y + dy - 6, left + wide, y + dy + 6];
      const end = [Math.min(Math.max(x, own[0]), own[2]), Math.min(Math.max(y, own[1]), own[3])];
      return { box: own, anchor, end, distance: Math.hypot(end[0] - x, end[1] - y) };
    });
    const rank = ({ anchor, distance }) => distance + (anchor === "middle" ? 4 : 0);
    const isInside = ([, top, , bottom]) => top >= box.top - 10 && bottom <= box.bottom + 2;
    return d3.sort(places.filter((place) => isInside(place.box) && place.distance >= 6), rank);
  }

  /// Places each name beside its point such that it hides no point, no other name and none of the further boxes; a line, which
  /// crosses no other name if possible, leads to a name that is not next to its point.
  function drawNames(svg, names, further) {
    const taken = names.map(({ x, y }) => [x - 9, y - 9, x + 9, y + 9]).concat(further);
    const drawn = [];
    const overlaps = (a, b) => a[0] < b[2] && b[0] < a[2] && a[1] < b[3] && b[1] < a[3];
    for (const { x, y, text } of d3.sort(names, (name) => -name.text.length)) {
      const isFree = ({ box: own }) => !taken.concat(drawn).some((other) => overlaps(own, other));
      const isCrossed = ({ end }) => d3.range(0, 1, 0.05)
        .map((s) => [x + s * (end[0] - x), y + s * (end[1] - y)])
        .some(([px, py]) => drawn.some((other) => overlaps([px, py, px, py], other)));
      const places = placesOfName(x, y, 6.8 * text.length + 2);
      const place = places.find((one) => isFree(one) && !isCrossed(one)) || places.find(isFree) || places[0];
      drawn.push(place.box);
      if (place.distance > 14) rule(svg, x, y, ...place.end, "leader");
      const at = { start: place.box[0], middle: (place.box[0] + place.box[2]) / 2, end: place.box[2] }[place.anchor];
      write(svg, at, place.box[1] + 10, text, place.anchor, "name").style("font-weight", text === "certified" ? 700 : 400);
    }
  }

  /// Draws the front; returns the boxes of its lines.
  function drawFront(svg, front, x, y) {
    if (front.length === 0) return [];
    const corners = [[x.place(front[0].x), box.top]];
    front.forEach((point, i) => {
      if (i > 0) corners.push([x.place(point.x), corners[corners.length - 1][1]]);
      corners.push([x.place(point.x), y.place(point.y)]);
    });
    corners.push([box.right, corners[corners.length - 1][1]]);
    svg.append("path").attr("class", "front").attr("d", d3.line()(corners));
    return d3.pairs(corners, (a, b) => [Math.min(a[0], b[0]) - 1, Math.min(a[1], b[1]) - 1, Math.max(a[0], b[0]) + 1,
      Math.max(a[1], b[1]) + 1]);
  }

  function drawMark(svg, x, y, slot, point, size, tip) {
    svg.append("path").attr("d", symbol(slot, size)).attr("transform", `translate(${x},${y})`)
      .style("stroke", color(slot)).style("stroke-width", point.open ? 1.6 : 0.5)
      .style("fill", point.open ? "var(--paper)" : color(slot)).append("title").text(tip);
  }

  /// Draws a panel of a figure.
  function drawPanel(svg, figure, panel) {
    const points = panel.series.flatMap((series) => series.points);
    const x = makeScale(points.map((point) => point.x), [box.left, box.right], figure.xLabel);
    const y = makeScale(points.map((point) => point.y), [box.bottom, box.top], figure.yLabel);
    drawAxes(svg, x, y, figure.xLabel);
    const front = drawFront(svg, panel.front, x, y);
    const names = [];
    for (const { name, slot, points: of } of panel.series) {
      const places = of.map((point) => [x.place(point.x), y.place(point.y)]);
      if (of.length > 1) {
        svg.append("path").attr("d", d3.line()(places)).attr("fill", "none").style("stroke", color(slot))
          .style("stroke-width", 1.5).style("opacity", 0.7);
      }
      of.forEach((point, i) => drawMark(svg, ...places[i], slot, point, of.length === 1 ? 90 : 30,
        `${name}: ${point.tip}\n${nameOf(figure.xLabel)}: ${valueText(figure.xLabel, point.x)}\n` +
        `${nameOf(figure.yLabel)}: ${valueText(figure.yLabel, point.y)}`));
      if (figure.isNamed) names.push({ x: places[0][0], y: places[0][1], text: name });
    }
    drawNames(svg, names, front);
  }

  const pictureStyle = document.querySelector("style").textContent.split("/* ---- The page")[0];

  /// A figure as a separate SVG file with its style: its panels in two columns.
  function pictureOf(figure) {
    const [gap, head] = [24, 40];
    const across = Math.min(figure.panels.length, 2);
    const wide = across * width + (across + 1) * gap;
    const tall = Math.ceil(figure.panels.length / across) * (height + head + gap / 2) + gap;
    const svg = d3.create("svg").attr("role", "img").attr("aria-label", figure.title).attr("width", wide).attr("height", tall)
      .attr("viewBox", `0 0 ${wide} ${tall}`);
    svg.append("style").text(pictureStyle);
    svg.append("rect").attr("class", "paper").attr("width", wide).attr("height", tall);
    figure.panels.forEach((panel, i) => {
      const left = gap + (i % across) * (width + gap);
      const top = gap / 2 + Math.floor(i / across) * (height + head + gap / 2);
      write(svg, left, top + 16, panel.title, "start", "title");
      write(svg, left, top + 34, `↑ ${nameOf(figure.yLabel)}`, "start", "axis");
      drawPanel(svg.append("svg").attr("x", left).attr("y", top + head).attr("width", width).attr("height", height), figure, panel);
    });
    // Each element is on a separate line, so that two pictures can be compared.
    return new XMLSerializer().serializeToString(svg.node()).replace(/></g, ">\n<") + "\n";
  }

  // ---- The page ---------------------------------------------------------------------------------

  function writeFigure(parent, figure) {
    const section = parent.append("section");
    section.append("h2").text(figure.title);
    section.append("p").text(figure.about);
    if (!figure.isNamed) {
      const legend = section.append("div").attr("class", "legend");
      for (const [name, slot] of slots) {
        const item = legend.append("span");
        item.append("svg").attr("width", 16).attr("height", 14).attr("aria-hidden", "true").append("path")
          .attr("d", symbol(slot, 70)).attr("transform", "translate(8,8)").style("fill", color(slot));
        item.append("span").text(` ${name}`);
      }
    }
    const panels = section.append("div").attr("class", "panels");
    for (const panel of figure.panels) {
      const place = panels.append("div");
      place.append("h3").text(panel.title);
      place.append("div").text(`↑ ${nameOf(figure.yLabel)}`);
      const svg = place.append("svg").attr("viewBox", `0 0 ${width} ${height}`).attr("role", "img")
        .attr("aria-label", `${figure.title}: ${panel.title}`);
      drawPanel(svg, figure, panel);
    }
  }

  const short = (value) => (Number.isNaN(value) ? "–" : String(Number(value.toPrecision(3))));
  const columns = [["queries", (row) => row.place], ["level", (row) => row.level ?? "–"], ["method", (row) => row.method],
    ["tolerance", (row) => row.tolerance], ["checks", (row) => row.max_checks], ["FN", (row) => row.false_negatives],
    ["FP", (row) => row.false_positives], ["late", (row) => row.late], ["ns a query", (row) => short(row.time)],
    ["÷ certified", (row) => short(row.ratio)], ["asked", (row) => row.timed], ["judged", (row) => row.judged],
    ["collide", (row) => row.collisions], ["toi error, max", (row) => short(row.greatest)]];
  const isWord = (name) => ["queries", "method"].includes(name);

  function writeTable(parent) {
    const table = parent.append("div").attr("class", "scroll").attr("tabindex", 0).append("table");
    table.append("thead").append("tr").selectAll("th").data(columns).join("th").attr("scope", "col").text(([name]) => name);
    const body = table.append("tbody");
    for (const row of rows) {
      const line = body.append("tr");
      for (const [name, cell] of columns) {
        const isMissed = name === "FN" && row.false_negatives !== 0;
        line.append("td").attr("class", isMissed ? "missed" : isWord(name) ? "word" : null).text((isMissed ? "✗ " : "") + cell(row));
      }
    }
  }

  const main = d3.select("main");
  main.append("h1").text("Speed and error of solvers");
  main.append("p").text("Methods of continuous collision detection on the same queries, one thread; the truth is the exact oracle’s.");
  for (const figure of figures) writeFigure(main, figure);
  main.append("h2").text("All rows");
  writeTable(main);

  return { figures, pictureOf };
})();
