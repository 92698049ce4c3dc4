// The functions of the module without pointers: for the worker of a page (verify/view/page/live.js), and for node and pages
// as the package touchstone-ccd (touchstone.d.ts). It stands behind what emscripten writes.

/// The double of C's %a; what is no such text as it is.
function doubleOfText(text) {
  const parts = /^(-?)0x([01])(?:\.([0-9a-f]*))?p([-+]\d+)$/.exec(text);
  if (parts === null) return text;
  const [, sign, first, fraction = "", power] = parts;
  let value = Number(BigInt(`0x${first}${fraction.padEnd(13, "0")}`)), exponent = Number(power) - 52;
  for (; exponent < -1000; exponent += 500) value *= 2 ** -500;
  return (sign ? -1 : 1) * value * 2 ** exponent;
}

async function openTouchstone() {
  const code = await createTouchstone();
  const said = (place, change) => {
    const value = JSON.parse(code.UTF8ToString(place), change);
    if (value.error) throw new Error(value.error);
    return value;
  };
  const fault = code.UTF8ToString(code._touchstone_arithmetic_fault());
  if (fault !== "") throw new Error(fault);
  const place = code._malloc(24 * 8);
  const kinds = { vertex_face: 0, edge_edge: 1 };
  const put = ({ kind, coordinates, separation = 0, norm = "l2" }) => {
    const isEdgeEdge = kinds[String(kind).replace("-", "_")];
    if (isEdgeEdge === undefined) throw new TypeError("the kind is neither vertex_face nor edge_edge");
    const numbers = Array.from(coordinates).flat(2);
    if (numbers.length !== 24) throw new TypeError(`there are ${numbers.length} coordinates, not the 24 of a query`);
    if (norm !== "l2" && norm !== "linf") throw new TypeError("the norm is neither l2 nor linf");
    code.HEAPF64.set(numbers, place / 8);
    return [isEdgeEdge, place, separation, norm === "l2" ? 1 : 0];
  };
  return {
    facts: (query) => said(code._touchstone_facts(...put(query), 1)),
    decide(query) {
      const { truth, certificate } = said(code._touchstone_facts(...put(query), 0), (name, value) =>
        (["lower", "upper"].includes(name) ? doubleOfText(value) : value));
      const { collides, toi = null, u = null, v = null } = truth;
      return { collides, toi, u, v, certificate: certificate && certificate.text };
    },
    solve: (query) => said(code._touchstone_solve(...put(query))),
    check(certificate) {
      const { claim, accepted, reason } = said(code.ccall("touchstone_check", "number", ["string"], [certificate]));
      return { claim, accepted, reason };
    },
  };
}

if (typeof module === "object") module.exports = { open: openTouchstone, doubleOfText };
