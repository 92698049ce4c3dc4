"use strict";
// The contents of a report: tables, figures and findings as data, computed from measurements (the JSON of
// `touchstone report`) and published numbers (docs/data/published.json). report_page.js writes and draws them; docs/results.md
// has the same tables.

const report = (function () {
  const none = "–";
  const certified = "certified";

  // ---- Words ------------------------------------------------------------------------------------

  /// A number in as many digits, without zeros at its end: 0.00123, 1.2e-05, 4.1e+20.
  function general(value, digits) {
    if (value === 0 || !Number.isFinite(value)) return String(value).replace("Infinity", "∞");
    const [mantissa, power] = value.toExponential(digits - 1).split("e");
    if (power >= -4 && power < digits) return String(Number(value.toPrecision(digits)));
    return `${Number(mantissa)}e${power[0]}${power.slice(1).padStart(2, "0")}`;
  }

  /// Three digits, more for whole numbers from 1000.
  function short(value) {
    if (Number.isNaN(value)) return none;
    return Math.abs(value) >= 1000 && Math.abs(value) < 1e9 ? value.toFixed(0) : general(value, 3);
  }

  /// "8.3 %": two digits, whole numbers from 100.
  const percent = (share) => `${share < 0.995 ? general(100 * share, 2) : (100 * share).toFixed(0)} %`;

  /// One digit and a power of ten: 1e-08.
  const powerOfTen = (value) => value.toExponential(0).replace(/([+-])(\d)$/, "$10$2");

  const listed = (texts) => (texts.length === 0 ? "none" : texts.join(", "));

  /// A field in the form of RFC 4180; no text is a formula to a spreadsheet.
  function csvField(value) {
    let text = Number.isNaN(value) ? "" : String(value);
    if (text.length > 1 && /^'*[=+@-]/.test(text) && Number.isNaN(Number(text))) text = `'${text}`;
    return /[",]/.test(text) ? `"${text.replaceAll('"', '""')}"` : text;
  }

  const csvOf = (table) => [table.columns, ...table.rows].map((row) => `${row.map(csvField).join(",")}\r\n`).join("");

  /// A table of Markdown; what could be markup is escaped.
  function markdownOf(table) {
    const escaped = (text) => text.replace(/[\\`*[\]<>|~&$]|(?<![\p{L}\p{N}])_|_(?![\p{L}\p{N}])|:(?=\/\/)/gu, "\\$&");
    const line = (texts) => `| ${texts.map(escaped).join(" | ")} |\n`;
    return line(table.columns) + line(table.columns.map(() => "---")) + table.rows.map(line).join("");
  }

  // ---- Measurements -----------------------------------------------------------------------------

  const placeOf = (m) => `${m.group}, ${m.kind}`;
  const ratio = (count, among) => (among === 0 ? 0 : count / among);
  const falsePositiveRate = (m) => ratio(m.false_positives, m.asked - m.collisions);
  const falseNegativeRate = (m) => ratio(m.false_negatives, m.collisions);
  const timeRatio = (m) => m.ns_per_query / m.certified_ns_per_query;

  /// True if it has given an answer that a conservative method must not give.
  const misses = (m) => m.false_negatives + m.late_tois !== 0;

  const ofExperiment = (given, experiment) => given.measurements.filter((m) => m.experiment === experiment);
  const byPlace = (given, experiment) => d3.group(ofExperiment(given, experiment), placeOf);

  // ---- Tables -----------------------------------------------------------------------------------

  const meanings = [
    "µs: processor time a query, all queries in one call, one thread, median of the repetitions of one run in which the " +
      "methods take turns.",
    "÷ certified: the same as a multiple of the certified solver's time on the same queries in the same run.",
    "FN, FP: false negatives (collisions that it missed) and false positives (with their share of the queries that do " +
      "not collide).",
    "late: times of impact above the exact one, and by how much of the step at most.",
    "asked: queries that the method was asked; where they are not all, an evenly spread sample, as large as the time " +
      "allowed. Nothing is extrapolated. A method with * was asked fewer than the others of its table: compare shares, " +
      "not counts.",
    "collide: of those asked, by the oracle, for the separation and norm of the row.",
    "at limit: queries that the method gave up at its limit of checks (1,000,000; IRF and UIRF 100,000) and called a " +
      "collision.",
    "toi error: from the time that the method gives to the exact time of impact, in units of the motion's duration; – " +
      "where it gives none.",
    "published: as printed, for the whole of the published data, on another machine.",
  ];

  const columnsOfCounts = ["FN", "FP", "µs", "÷ certified", "late", "asked", "collide", "at limit"];

  const countedShare = (count, share) => (count === 0 ? "0" : `${count} (${percent(share)})`);

  const countsOf = (m) => [
    String(m.false_negatives), countedShare(m.false_positives, falsePositiveRate(m)), short(m.ns_per_query / 1000),
    short(timeRatio(m)), m.late?.count ? `${m.late.count}, ≤ ${short(m.late.greatest)}` : String(m.late_tois),
    m.asked === m.group_queries ? String(m.asked) : `${m.asked} of ${m.group_queries}`, String(m.collisions),
    String(m.at_limit)];

  /// The place in the published tables that a measurement stands beside.
  const publishedPlace = (m, published) => placeOf({ ...m, group: published.stands_beside[m.group] || m.group });

  /// A table of measurements of one place. \param head columns and cells in front of the counts
  /// \param foot those after them \param numbers of a measurement: the published ones, if there are any
  function tableOf(title, all, head, foot, published, numbers) {
    const size = all.length === 0 ? undefined : published.sizes[publishedPlace(all[0], published)];
    const columns = [...head.map(([name]) => name), ...columnsOfCounts, ...foot.map(([name]) => name)];
    if (size) columns.push(`published (${size}) µs`, "published FP", "published FN");
    const cellsOf = (cells, m) => cells.map(([, cell]) => cell(m));
    return { title, columns, rows: all.map((m) => [...cellsOf(head, m), ...countsOf(m), ...cellsOf(foot, m),
      ...(size ? numbers(m) || [none, none, none] : [])]) };
  }

  /// The paper's table 1, a table for each place.
  function fieldTables(given, published) {
    const error = (which) => (m) => (m.toi_error ? short(m.toi_error[which]) : none);
    return Array.from(byPlace(given, "field"), ([place, all]) => {
      const most = d3.max(all, (m) => m.asked);
      return tableOf(place, all, [["method", (m) => m.method + (m.asked < most ? "*" : "")]],
        [["toi error, median", error("median")], ["toi error, max", error("max")]], published,
        (m) => published.field.numbers[m.method]?.[publishedPlace(m, published)]);
    });
  }

  /// The paper's tables over the minimum separation: of a method beside Tight-Inclusion and the certified solver.
  function separationTables(given, published, method) {
    const rows = [...new Set([method, "tight_inclusion", certified])];
    const head = [["d", (m) => powerOfTen(m.separation.min_separation)], ["method", (m) => m.method],
      ["norm", (m) => (m.separation.norm === "linf" ? "L∞" : "L2")]];
    return Array.from(byPlace(given, "separation")).filter(([, all]) => all.some((m) => m.method === method))
      .map(([place, all]) => {
        const chosen = d3.cross(published.distances, rows, (distance, name) =>
          all.filter((m) => m.method === name && m.separation.min_separation === distance)).flat();
        return tableOf(place, chosen, head, [], published, (m) =>
          published.separation.numbers[m.method]?.[publishedPlace(m, published)]?.[powerOfTen(m.separation.min_separation)]);
      });
  }

  /// The contacts that Tight-Inclusion misses with each filter: contacts at t=1 by scale, and the families in which one
  /// of them misses some.
  function filterTables(given) {
    const tables = new Map();
    const alike = d3.group(ofExperiment(given, "filter"), (m) => JSON.stringify([m.group, m.kind, m.scale]));
    for (const all of alike.values()) {
      const { group, kind, scale, collisions } = all[0];
      const isFamily = Number.isNaN(scale);
      if (isFamily && all.every((m) => m.false_negatives === 0)) continue;
      const title = isFamily ? "built-in families" : group;
      if (!tables.has(title)) {
        tables.set(title, { title, isFamily, rows: [],
          columns: [isFamily ? "family" : "scale", "kind", "collide", ...all.map((m) => `${m.method} FN`)] });
      }
      tables.get(title).rows.push([isFamily ? group : String(scale), kind, String(collisions),
        ...all.map((m) => countedShare(m.false_negatives, falseNegativeRate(m)))]);
    }
    return d3.sort(tables.values(), (table) => Number(table.isFamily));
  }

  // ---- Figures ----------------------------------------------------------------------------------

  const hollow = " Hollow: there the method misses collisions, or gives times of impact after the exact one.";

  /// A figure without panels. Its data are the numbers that are drawn.
  const figure = (id, title, description, form, columns, more) => ({ id, title, description, form, x_label: "", y_label: "",
    x_log: true, x_even: false, y_log: true, panels: [], data: { columns, rows: [] }, ...more });

  const panelOf = (title, caption) => ({ title, caption, powers: true, series: [], front: [] });

  /// The series of that name and role in a panel, made if there is none.
  function seriesOf(panel, name, role, slot) {
    const found = panel.series.find((series) => series.name === name && series.role === role);
    if (found) return found;
    panel.series.push({ name, role, slot, points: [] });
    return panel.series[panel.series.length - 1];
  }

  /// The points than which no other is as small in both coordinates and smaller in one, by ascending x.
  function paretoFront(points) {
    const beats = (a, b) => a.x <= b.x && a.y <= b.y && (a.x < b.x || a.y < b.y);
    return d3.sort(points.filter((point) => !points.some((other) => beats(other, point))), (point) => point.x);
  }

  /// The methods that were asked fewer queries than others, as a sentence.
  function sampleSentence(all) {
    const most = d3.max(all, (m) => m.asked);
    const fewer = all.filter((m) => m.asked !== most).map((m) => `${m.method} (${m.asked})`);
    return fewer.length === 0 ? `All were asked the same ${most} queries.`
      : `Asked fewer of the ${most} queries: ${fewer.join(", ")}.`;
  }

  const sampleOfCurves = (all) => `Queries along a curve: ${
    d3.sort(d3.rollup(all, (of) => of[of.length - 1].asked, (m) => m.method), ([name]) => name)
      .map(([name, count]) => `${name} ${count}`).join(", ")}.`;

  /// Time against an error: a point a method, a curve for those with a tolerance.
  function pointsFigure(given, slots, id, title, yLabel, error) {
    const made = figure(id, title, "A point a method; a curve for those that aim at a tolerance, δ from 1e-8 to 1. Down " +
      `and to the left is better. Dashed: the Pareto front of the methods that miss nothing.${hollow}`, "points",
    ["group", "kind", "method", "tolerance", "ns_per_query", id, "false_negatives", "late_tois", "asked", "at_limit",
      "on_front"], { x_label: "time a query, ns", y_label: yLabel });
    const placed = (all) => all.filter((m) => !Number.isNaN(error(m)) && !Number.isNaN(m.ns_per_query));
    const addRow = (m, onFront) => made.data.rows.push([m.group, m.kind, m.method, m.tolerance, m.ns_per_query, error(m),
      m.false_negatives, m.late_tois, m.asked, m.at_limit, Number(onFront)]);
    const curves = byPlace(given, "tolerance");
    for (const [place, all] of byPlace(given, "field")) {
      const panel = panelOf(place, "");
      for (const m of placed(curves.get(place) || [])) {
        seriesOf(panel, m.method, "curve", slots.get(m.method)).points
          .push({ x: m.ns_per_query, y: error(m), label: `δ = ${powerOfTen(m.tolerance)}`, open: misses(m) });
        addRow(m, false);
      }
      const points = placed(all).map((m) => ({ x: m.ns_per_query, y: error(m), label: m.method, open: misses(m) }));
      for (const point of points) seriesOf(panel, point.label, "point", slots.get(point.label)).points.push(point);
      panel.front = paretoFront(points.filter((point) => !point.open));
      const names = panel.front.map((point) => point.label);
      panel.caption = (names.length === 0 ? "No method here is without a miss. "
        : `On the front of those without a miss: ${names.join(", ")}. `) + sampleSentence(all);
      for (const m of placed(all)) addRow(m, names.includes(m.method));
      made.panels.push(panel);
    }
    return made;
  }

  function timesFigure(given, slots) {
    const made = figure("running_times", "Running times of single queries", "How the times of single calls are spread: " +
      "above each method's line for queries that do not collide, below it for those that do. Heights are square roots of " +
      "shares, so that the rare is seen. One call a query takes longer than its part of a call for many.", "ridges",
    ["group", "kind", "method", "collide", "from_ns", "to_ns", "queries"],
    { x_label: "time of one call, ns", y_label: "share of queries", y_log: false });
    const lowerEnd = (bin) => 10 ** (bin / 8);  // eight bins make a factor of ten
    for (const [place, all] of byPlace(given, "field")) {
      const panel = panelOf(place, "");
      for (const m of all) {
        if (m.no_collision_times.length + m.collision_times.length === 0) continue;
        for (const [role, bins] of [["no_collisions", m.no_collision_times], ["collisions", m.collision_times]]) {
          const series = seriesOf(panel, m.method, role, slots.get(m.method));
          const sum = d3.sum(bins, ([, count]) => count);
          for (const [bin, count] of bins) {
            series.points.push({ x: lowerEnd(bin), y: count / sum, label: "", open: false });
            made.data.rows.push([m.group, m.kind, m.method, Number(role === "collisions"), general(lowerEnd(bin), 6),
              general(lowerEnd(bin + 1), 6), count]);
          }
        }
      }
      made.panels.push(panel);
    }
    return made;
  }

  /// A measure of an experiment over its parameter. \param x, y each the name of a column and its value
  /// \param suffix of a measurement: the name of its series after that of the method
  function linesFigure(given, slots, made, experiment, [xName, x], [yName, y], suffix) {
    made.data.columns = ["group", "kind", "method", "norm", xName, yName, "false_negatives", "asked", "at_limit"];
    for (const [place, all] of byPlace(given, experiment)) {
      const panel = panelOf(place, sampleOfCurves(all));
      for (const m of all.filter((one) => !Number.isNaN(y(one)))) {
        seriesOf(panel, m.method + (suffix ? suffix(m, all) : ""), "curve", slots.get(m.method)).points
          .push({ x: x(m), y: y(m), label: "", open: misses(m) });
        made.data.rows.push([m.group, m.kind, m.method, m.separation.norm, x(m), y(m), m.false_negatives, m.asked,
          m.at_limit]);
      }
      made.panels.push(panel);
    }
    return made;
  }

  function achievedFigure(given, slots) {
    const made = figure("checks_tolerance", "Achieved δ over the maximum number of checks m_I", "The tolerance that " +
      "Tight-Inclusion's collisions claim (asked: 1e-6), the greatest and the median.", "lines",
    ["group", "kind", "method", "max_checks", "collisions_claimed", "achieved_median", "achieved_max"],
    { x_label: "maximum number of checks m_I", y_label: "achieved δ, in units of the coordinates" });
    for (const [place, all] of byPlace(given, "checks")) {
      const panel = panelOf(place, sampleOfCurves(all));
      for (const m of all.filter((one) => one.achieved_tolerance)) {
        const { count, median, max } = m.achieved_tolerance;
        for (const [name, role, y] of [["greatest", "curve", max], ["median", "faint", median]]) {
          seriesOf(panel, name, role, slots.get(m.method)).points.push({ x: m.max_checks, y, label: "", open: false });
        }
        made.data.rows.push([m.group, m.kind, m.method, m.max_checks, count, median, max]);
      }
      made.panels.push(panel);
    }
    return made;
  }

  function stagesFigure(given) {
    const made = figure("stages", "Which stage ends a query of the certified solver", "Share of the queries that each " +
      "stage ends, cheapest first.", "bars", ["group", "kind", "stage", "queries", "asked"],
    { x_label: "share of queries", x_log: false, y_log: false, panels: [panelOf(certified, "")] });
    for (const m of ofExperiment(given, "field")) {
      m.stages.forEach(([stage, queries], i) => {
        const { series } = made.panels[0];
        if (series.length <= i) series.push({ name: stage, role: "stage", slot: i, points: [] });
        series[i].points.push({ x: queries / m.asked, y: 0, label: placeOf(m), open: false });
        made.data.rows.push([m.group, m.kind, stage, queries, m.asked]);
      });
    }
    return made;
  }

  // ---- Maps of stability ------------------------------------------------------------------------

  const counts = { queries: "queries", collisions: "collisions", false_positives: "false positives",
    false_negatives: "false negatives", late_tois: "late times of impact",
    early_upper_tois: "early upper times of impact", beyond_tolerance: "beyond the tolerance", errors: "errors",
    hangs: "of them hangs", undecided: "undecided" };

  const countsInTip = ["false_negatives", "false_positives", "late_tois", "early_upper_tois", "beyond_tolerance", "errors",
    "undecided", "hangs"];

  const letters = { "false negative": "N", "false positive": "P", "late toi": "T", "early toi_upper": "T", error: "E",
    "beyond tolerance": "B", hang: "H", undecided: "U", asymmetry: "A" };

  /// The letter of the worst fault if there is one, and "!" where there are errors or hangs besides.
  function markText(mark) {
    const letter = mark.is_slight ? "t" : letters[mark.worst] || "";
    return letter + (mark.hangs !== 0 || (mark.errors !== 0 && letter !== "E") ? "!" : "");
  }

  /// All numbers of a cell in words.
  function markTip(mark) {
    const lines = [[`${mark.queries} queries, ${mark.collisions} collisions`,
      ...countsInTip.filter((count) => mark[count] !== 0).map((count) => `${mark[count]} ${counts[count]}`)].join(", ")];
    if (mark.toi_error) {
      lines.push(`error of the time of impact: median ${short(mark.toi_error.median)}, greatest ${
        short(mark.toi_error.max)}`);
    }
    if (!Number.isNaN(mark.ns_per_query)) lines.push(`${mark.ns_per_query.toFixed(0)} ns a query`);
    if (!Number.isNaN(mark.checks_per_query)) lines.push(`${mark.checks_per_query.toFixed(1)} checks a query`);
    return lines.join("\n");
  }

  /// A grid for each hardness with a cell a level. \param point of a mark; \param numbers of its row behind the names
  function mapFigure(marks, slots, made, point, numbers) {
    made.data.columns = ["hardness", "measure", "level", "kind", "method", ...made.data.columns];
    for (const mark of marks) {
      let panel = made.panels.find((one) => one.title === mark.hardness);
      if (!panel) made.panels.push(panel = { ...panelOf(mark.hardness, mark.measure), powers: mark.is_power });
      seriesOf(panel, mark.method, mark.kind === "vertex-face" ? "vf" : "ee", slots.get(mark.method)).points
        .push({ x: mark.exponent, ...point(mark) });
      made.data.rows.push([mark.hardness, mark.measure, mark.exponent, mark.kind, mark.method, ...numbers(mark)]);
    }
    for (const panel of made.panels) panel.series = d3.sort(panel.series, (series) => series.slot);
    return made;
  }

  function worstFigure(marks, slots) {
    const names = Object.keys(counts);
    return mapFigure(marks, slots, figure("stability", "Stability: what goes wrong as queries get harder", "A cell a level " +
      "of hardness: the worst that happens at it, and how often, in percent. N: false negatives, of the collisions. T: the " +
      "time of impact excludes the true one, of the collisions (t: late by at most 1e-9). E: errors. B: a yes beyond its " +
      "tolerance, of the misses. Shades: false positives, of the misses, the deeper the more. Pale and empty: every answer " +
      "is right. !: errors or hangs besides. vf: vertex-face. ee: edge-edge.", "marks",
    [...names, "worst", "worst_rate", "ns_per_query"], { x_label: "level", x_log: false, y_log: false }),
    (mark) => ({ y: mark.worst_rate, label: markText(mark), open: mark.worst === "false negative", tip: markTip(mark) }),
    (mark) => [...names.map((count) => mark[count]), mark.worst, mark.worst_rate, mark.ns_per_query]);
  }

  /// A number of each cell, of the methods that give it.
  function numberFigure(marks, slots, id, title, yLabel, value) {
    const giving = new Set(marks.filter((mark) => !Number.isNaN(value(mark))).map((mark) => mark.method));
    return mapFigure(marks.filter((mark) => giving.has(mark.method)), slots, figure(id, title, "A cell a level of hardness, " +
      "the deeper the greater the number. Framed: not known. vf: vertex-face. ee: edge-edge.", "shades", [id],
    { x_label: "level", y_label: yLabel, x_log: false }),
    (mark) => ({ y: value(mark), label: "", open: false }), (mark) => [value(mark)]);
  }

  // ---- All figures ------------------------------------------------------------------------------

  const error = (which) => (m) => (m.toi_error ? m.toi_error[which] : NaN);

  /// The figures that the measurements have data for.
  function figuresOf(given, published) {
    const methods = [...given.measurements, ...given.stability].map((m) => m.method);
    const slots = new Map(Array.from(new Set(methods), (method, slot) => [method, slot]));
    const points = (...of) => pointsFigure(given, slots, ...of);
    const lines = (id, title, description, more, ...of) =>
      linesFigure(given, slots, figure(id, title, description, "lines", [], more), ...of);
    const numbers = (...of) => numberFigure(given.stability, slots, ...of);
    const tolerance = ["tolerance", (m) => m.tolerance];
    const time = ["ns_per_query", (m) => m.ns_per_query];
    const overTolerance = "tolerance δ, in units of the coordinates";
    // A method measured in both norms has a curve for each.
    const normOf = (m, all) => (new Set(all.filter((one) => one.method === m.method).map((one) => one.separation.norm))
      .size < 2 ? "" : m.separation.norm === "linf" ? " (L∞)" : " (L2)");
    const figures = [
      points("speed_false_positives", "Time a query against false positives",
        "false positives, of the queries that do not collide", falsePositiveRate),
      points("speed_toi_median", "Time a query against the median error of the time of impact",
        "error of the time of impact, median", error("median")),
      points("speed_toi_max", "Time a query against the greatest error of the time of impact",
        "error of the time of impact, greatest", error("max")),
      timesFigure(given, slots),
      lines("tolerance_time", "Time over the tolerance δ", "Of the methods that aim at a tolerance.",
        { x_label: overTolerance, y_label: "time a query, ns" }, "tolerance", tolerance, time),
      lines("tolerance_false_positives", "False positives over the tolerance δ",
        "Of the same methods, of the queries that do not collide.", { x_label: overTolerance, y_label: "false positives" },
        "tolerance", tolerance, ["false_positive_rate", falsePositiveRate]),
      lines("separation_time", "Time over the minimum separation d", "Each method in its own norm, the certified solver in " +
        `both; the truth is about the same distance.${hollow}`, { x_label: "minimum separation d, in units of the coordinates",
        y_label: "time a query, ns", x_even: true }, "separation",
      ["min_separation", (m) => m.separation.min_separation], time, normOf),
      lines("checks_early", "Early termination over the maximum number of checks m_I",
        "Share of the queries that Tight-Inclusion gives up at m_I checks, and calls a collision.",
        { x_label: "maximum number of checks m_I", y_label: "share of queries" }, "checks",
        ["max_checks", (m) => m.max_checks], ["share_at_limit", (m) => m.at_limit / m.asked]),
      achievedFigure(given, slots),
      lines("filter_misses", "What Tight-Inclusion misses with each filter, over the scale", published.filters.text,
        { x_label: "greatest coordinate", y_label: "contacts missed, of all", y_log: false }, "filter",
        ["scale", (m) => m.scale], ["false_negative_rate", (m) => (Number.isNaN(m.scale) ? NaN : falseNegativeRate(m))]),
      stagesFigure(given),
      worstFigure(given.stability, slots),
      numbers("stability_toi_median", "Stability: the median error of the time of impact",
        "error of the time of impact, median", error("median")),
      numbers("stability_toi_max", "Stability: the greatest error of the time of impact",
        "error of the time of impact, greatest", error("max")),
      numbers("stability_time", "Stability: the time a query", "time a query, ns", (mark) => mark.ns_per_query),
      numbers("stability_checks", "Stability: the checks a query", "checks a query", (mark) => mark.checks_per_query),
    ];
    for (const one of figures) one.panels = one.panels.filter((panel) => panel.series.length !== 0);
    return figures.filter((one) => one.panels.length !== 0);
  }

  // ---- Findings ---------------------------------------------------------------------------------

  /// From the least to the greatest of some numbers; empty if there are none.
  function rangeText(numbers) {
    const [from, to] = d3.extent(numbers).map((number) => (number === undefined ? "" : short(number)));
    return from === to ? from : `${from} to ${to}`;
  }

  const total = (all, ...fields) => d3.sum(all, (m) => d3.sum(fields, (field) => m[field]));

  function promisesSentence(given) {
    const broken = Array.from(d3.group(given.measurements.filter((m) => !m.keeps_promise), (m) => m.method), ([method, all]) => {
      const latest = d3.max(all, (m) => (m.late ? m.late.greatest : 0));
      const said = [["false_negatives", "missed collisions"],
        ["late_tois", latest > 0 ? `late times, at most by ${short(latest)} of the step` : "late times"],
        ["early_upper_tois", "early upper times"], ["beyond_tolerance", "beyond the tolerance"],
        ...(all[0].promise === "exact" ? [["false_positives", "false positives"]] : []), ["errors", "errors"]]
        .filter(([field]) => total(all, field) !== 0).map(([field, words]) => `${total(all, field)} ${words}`);
      const harm = [total(all, "false_negatives") === 0, -latest, total(all, "false_positives") === 0];
      return { harm, text: `${method} (${said.join(", ")})` };
    });
    if (broken.length === 0) return "Every method kept its promise.";
    const worst = d3.sort(broken, ...[0, 1, 2].map((i) => (one) => Number(one.harm[i])));
    return `Broke its promise: ${listed(worst.map((one) => one.text))}.`;
  }

  /// Sentences on the methods of the experiment "field": queries, misses, methods without a miss, times.
  function fieldSentences(given) {
    const methods = d3.group(ofExperiment(given, "field"), (m) => m.method);
    if (methods.size === 0) return [];
    const groups = Array.from(byPlace(given, "field").values(),
      (all) => d3.greatest(all, (a, b) => a.asked - b.asked || a.collisions - b.collisions));
    const missed = (all) => total(all, "false_negatives", "late_tois");
    const named = (test, text) => listed(Array.from(methods).filter(([, all]) => test(all)).map(text));
    const sentences = [
      `${methods.size} methods were asked up to ${total(groups, "asked")} queries, ${total(groups, "collisions")} of which ` +
        "collide.",
      `No missed collision and no time of impact after the exact one: ${named((all) => missed(all) === 0, ([name]) => name)}. ` +
        `Some: ${named((all) => missed(all) !== 0, ([name, all]) => `${name} (${missed(all)} of ${total(all, "asked")})`)}.`,
      `Right on every query, with no false positive either: ${named((all) => total(all, "false_negatives", "late_tois",
        "early_upper_tois", "false_positives", "errors") === 0, ([name]) => name)}.`];
    const times = (all) => all.map((m) => m.ns_per_query).filter((time) => !Number.isNaN(time));
    const ours = times(methods.get(certified) || []);
    if (ours.length !== 0) {
      const others = Array.from(methods).filter(([name, all]) => name !== certified && missed(all) === 0 && times(all).length !== 0);
      sentences.push(`${certified} takes ${rangeText(ours)} ns a query. As a multiple of that, the others that miss nothing: ${
        listed(others.map(([name, all]) => `${name} ${rangeText(all.map(timeRatio))}`))}.`);
    }
    return sentences;
  }

  function frontsSentence(figures) {
    const panels = figures.filter((one) => one.form === "points").flatMap((one) => one.panels);
    const names = d3.rollup(panels.flatMap((panel) => panel.front), (all) => all.length, (point) => point.label);
    return names.size === 0 ? "" : "On the Pareto front of time against error, among those that miss nothing: " +
      `${listed(d3.sort(names, ([name]) => name).map(([name, count]) => `${name} in ${count}`))} of ${panels.length} panels.`;
  }

  function unaskedSentence(given) {
    const left = d3.group(given.measurements.filter((m) => m.outside + m.left_out !== 0), (m) => m.method);
    return left.size === 0 ? "" : `Not asked: ${listed(d3.sort(left, ([name]) => name).map(([name, all]) =>
      `${name} (${total(all, "outside")} queries outside its promise, ${total(all, "left_out")} for lack of time)`))}.`;
  }

  /// A report opens with them.
  function findingsOf(given, figures) {
    if (given.measurements.length === 0) return [];
    return [promisesSentence(given), ...fieldSentences(given), frontsSentence(figures), unaskedSentence(given)]
      .filter((sentence) => sentence !== "");
  }

  // ---- Contents ---------------------------------------------------------------------------------

  function separationSections(given, published) {
    const of = (method) => separationTables(given, published, method);
    const sections = [
      { id: "table_2", title: "Table 2: MSRF over the minimum separation d", tables: of("msrf") },
      { id: "table_3", title: "Table 3: FPRF over the minimum separation d", tables: of("fprf") }];
    if (sections.every((section) => section.tables.length === 0)) {
      sections.push({ id: "table_2", title: "Table 2: over the minimum separation d", tables: of("tight_inclusion") });
    }
    return sections;
  }

  /// All that a page shows, in its order: the first of the figures stands at the top.
  /// \param page `title`, `about` and `findings`; `tables` at the top; `measurements`
  function contentsOf(page, published) {
    const given = page.measurements;
    const figures = figuresOf(given, published);
    const findings = [...page.findings, ...findingsOf(given, figures)];
    const top = [...page.tables, { id: "table_1", title: "Table 1: all methods", tables: fieldTables(given, published), meanings }];
    const further = [...separationSections(given, published),
      { id: "filters", title: "What Tight-Inclusion misses with each filter", tables: filterTables(given) }]
      .map((section) => ({ ...section, meanings }));
    const filled = (sections) => sections.filter((section) => section.tables.length !== 0);
    const origin = [[" with Touchstone ", given.version], [" on ", given.machine], [", ", given.date]]
      .map(([words, text]) => (text ? words + text : "")).join("");
    return { title: page.title, about: page.about, findings, figures, top: filled(top), further: filled(further), meanings,
      groups: given.groups, command: given.command, origin, interrupted: given.interrupted };
  }

  const numbers = new Set(["ns_per_query", "certified_ns_per_query", "checks_per_query", "tolerance", "scale", "median", "max",
    "greatest"]);

  /// JSON as `touchstone report` writes it: an infinite number is a word, one that is not known is null.
  const parsed = (text) => JSON.parse(text, (key, value) => (numbers.has(key) ? Number(value ?? NaN) : value));

  return { contentsOf, parsed, csvOf, markdownOf };
})();
