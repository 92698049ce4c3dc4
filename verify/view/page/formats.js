// A query as text, and text as a query: C++, the CSV rows of datasets, and JSON; and the part of an address that
// holds a query.

import { hexadecimalText, parseDouble, rational, rationalText } from "./exact.js";

const rows = (coordinates) => Array.from({ length: 8 }, (_, i) => coordinates.slice(3 * i, 3 * i + 3));
const exactDecimal = (x) => (Object.is(x, -0) ? "-0" : String(x));

export const writers = {
  "C++": ({ kind, coordinates }) => {
    const lines = rows(coordinates).map((row) => `    ${row.map(hexadecimalText).join(", ")}`);
    return `const touchstone::Kind kind = touchstone::Kind::${kind.replace("-", "_")};\n` +
      `const touchstone::Query query{{\n${lines.join(",\n")}}};\n`;
  },
  CSV: ({ coordinates }) => rows(coordinates).map((row) => row.map((x) => {
    const text = rationalText(rational(x));
    return text.includes("/") ? text.replace("/", ",") : `${text},1`;
  }).join(",")).join("\n") + "\n",
  JSON: ({ kind, coordinates, min_separation, norm }) => `${JSON.stringify({
    kind,
    separation: { min_separation, norm },
    coordinates: coordinates.map(hexadecimalText),
  })}\n`,
};

/// "#q=edge_edge,0,0,…": kind and 24 coordinates, and "&d=0.5&norm=l2" with a minimum separation.
export const linkOf = ({ kind, coordinates, min_separation, norm }) =>
  `#q=${[kind.replace("-", "_"), ...coordinates.map(exactDecimal)].join(",")}` +
  (min_separation > 0 ? `&d=${min_separation}&norm=${norm}` : "");

const isKind = (kind) => kind === "vertex-face" || kind === "edge-edge";

/// The kind in a text; null if there is none.
function kindOf(text) {
  const found = /(vertex|edge)[-_](face|edge)/i.exec(text);
  const kind = found && `${found[1]}-${found[2]}`.toLowerCase();
  return isKind(kind) ? kind : null;
}

/// 24 doubles of rationals as text.
function doubles(texts) {
  if (texts.length !== 24) throw new Error(`there are ${texts.length} numbers, not the 24 of a query`);
  return texts.map((text) => {
    const value = parseDouble(text);
    if (Number.isNaN(value)) throw new Error(`“${text.slice(0, 40)}” is no finite number`);
    return value;
  });
}

/// A minimum separation. \throws Error if it is none
function separation(distance, norm) {
  const value = parseDouble(distance);
  if (!(value >= 0) || !["l2", "linf"].includes(norm)) throw new Error("the separation is not a finite distance from 0 with norm linf or l2");
  return { min_separation: value, norm };
}

/// The query in an address; null if it has none. Numbers as parseDouble() takes them.
/// \throws Error with the reason if it is not a query.
export function readLink(hash) {
  const parts = new Map(decodeURIComponent(hash.replace(/^#/, "")).split("&").map((part) => part.split("=")));
  if (!parts.has("q")) return null;
  const [name, ...texts] = parts.get("q").split(",");
  const kind = kindOf(name);
  if (kind === null) throw new Error("the link begins with neither vertex_face nor edge_edge");
  return { kind, coordinates: doubles(texts), ...separation(parts.get("d") || "0", parts.get("norm") || "l2") };
}

const number = String.raw`[-+]?(?:0x[0-9a-f]*(?:\.[0-9a-f]*)?(?:p[-+]?\d+)?|(?:\d+(?:\.\d*)?|\.\d+)(?:e[-+]?\d+)?)`;
/// Numbers and fractions that are not parts of names.
const numberPattern = new RegExp(String.raw`(?<![\w.])${number}(?:/${number})?(?![\w.])`, "gi");

/// Of eight rows of numbers with commas the coordinates: x, y, z, or numerator and denominator of each, without a label; null
/// of other lines.
function ofRows(lines) {
  const rows = lines.map((line) => line.split(",").map((field) => field.replace(/"/g, "").trim()));
  const width = rows.length === 8 ? rows[0].length : 0;
  if (![3, 4, 6, 7].includes(width) || rows.some((row) => row.length !== width)) return null;
  return rows.flatMap((row) => (width < 6 ? row.slice(0, 3) : [0, 2, 4].map((i) => `${row[i]}/${row[i + 1]}`)));
}

/// The limit for the length of a text with a query, whose numbers have a thousand digits at most.
const longest = 1_000_000;

/// The query in a text: { kind (null if unknown), coordinates, min_separation, norm }. Its numbers are those of the first
/// "coordinates" of JSON, else those behind the first brace of code, else all but those of comments.
/// \throws Error with the reason if there is none.
export function readQuery(pasted) {
  if (pasted.length > longest) throw new Error("the text has more than a million characters");
  // The minus sign of typeset documents.
  const text = pasted.replace(/\u2212/g, "-");
  const member = (name, otherwise) => (new RegExp(`"${name}"\\s*:\\s*"?([^\\s",}]+)`).exec(text) || [null, otherwise])[1];
  const found = { kind: kindOf(text), ...separation(member("min_separation", "0"), member("norm", "l2")) };
  const json = /"coordinates"\s*:([^:}]*)/.exec(text);
  const code = text.replace(/\/\/.*|#.*|\/\*[^]*?(?:\*\/|$)/g, "");
  const rows = ofRows(code.split("\n").filter((line) => /^\s*[-+.\d"]/.test(line)));
  const numbers = json ? json[1] : code.slice(Math.max(code.indexOf("{"), 0));
  return { ...found, coordinates: doubles(rows || numbers.match(numberPattern) || []) };
}
