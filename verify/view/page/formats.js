// A query as text, and text as a query: C++, the CSV rows of datasets, JSON, and the lines `v x y z` of OBJ
// that ipc-toolkit writes; and the part of an address that holds a query.

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
  OBJ: ({ coordinates }) => rows(coordinates).map((row) => `v ${row.map(exactDecimal).join(" ")}\n`).join(""),
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

function fromJson(text) {
  const json = JSON.parse(text);
  const isList = Array.isArray(json) && typeof json[0] === "object" && !Array.isArray(json[0]);
  const one = (Array.isArray(json.findings) ? json.findings[0] : isList ? json[0] : json) || {};
  const list = Array.isArray(one) ? one : one.coordinates;
  if (!Array.isArray(list)) throw new Error("the JSON has no list “coordinates”");
  const numbers = list.flat(2);
  if (numbers.some((x) => typeof x === "object")) throw new Error("“coordinates” holds more than numbers");
  const { min_separation: distance = 0, norm = "l2" } = one.separation || {};
  return { kind: isKind(one.kind) ? one.kind : null, coordinates: doubles(numbers.map(String)),
    ...separation(typeof distance === "object" ? "" : String(distance), norm) };
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

/// Rows of numbers with commas: x, y, z, or numerator and denominator of each, and optionally a
/// label.
function fromRows(lines) {
  const fields = lines.map((line) => line.split(",").map((field) => field.replace(/"/g, "").trim()));
  const width = fields[0].length;
  if (![3, 4, 6, 7].includes(width) || fields.some((row) => row.length !== width)) return null;
  const texts = fields.flatMap((row) => (width < 6 ? row.slice(0, 3)
    : [0, 2, 4].map((i) => `${row[i]}/${row[i + 1]}`)));
  return { coordinates: doubles(texts) };
}

const number = String.raw`[-+]?(?:0x[0-9a-f]*(?:\.[0-9a-f]*)?(?:p[-+]?\d+)?|(?:\d+(?:\.\d*)?|\.\d+)(?:e[-+]?\d+)?)`;
/// Numbers and fractions that are not parts of names.
const numberPattern = new RegExp(String.raw`(?<![\w.])${number}(?:/${number})?(?![\w.])`, "gi");

/// The limit for the length of a text with a query, whose numbers have a thousand digits at most.
const longest = 1_000_000;

/// The query in a text: { kind (null if unknown), coordinates, min_separation, norm }.
/// \throws Error with the reason if there is none.
export function readQuery(pasted) {
  if (pasted.length > longest) throw new Error("the text has more than a million characters");
  // The minus sign of typeset documents.
  const text = pasted.replace(/\u2212/g, "-");
  const contact = { kind: kindOf(text), min_separation: 0, norm: "l2" };
  if (/^\s*[[{]\s*["[{\d-]/.test(text) && /[\]}]\s*$/.test(text)) {
    let query = null;
    try {
      query = fromJson(text);
    } catch (error) {
      if (!(error instanceof SyntaxError)) throw error;
    }
    if (query !== null) return { ...contact, ...query, kind: query.kind || contact.kind };
  }
  const code = text.replace(/\/\/.*|\/\*[^]*?(?:\*\/|$)/g, "");
  const lines = code.split("\n").map((line) => line.trim()).filter((line) => line !== "");
  const vertices = lines.filter((line) => /^v\s/.test(line));
  if (vertices.length > 0) {
    return { ...contact, coordinates: doubles(vertices.flatMap((line) => line.split(/\s+/).slice(1, 4))) };
  }
  const data = lines.filter((line) => /^[-+.\d"]/.test(line));
  const query = data.length === 8 && lines.length <= 9 ? fromRows(data) : null;
  if (query !== null) return { ...contact, ...query };
  const start = code.indexOf("{");
  return { ...contact, coordinates: doubles((start < 0 ? code : code.slice(start)).match(numberPattern) || []) };
}

