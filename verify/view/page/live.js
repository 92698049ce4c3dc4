// The solvers of the tool in the page itself, in WebAssembly (verify/playground), where the page has them.

import { readFacts } from "./facts.js";

/// True if this page has the solvers.
export const isLive = typeof createTouchstone !== "undefined";

/// Starts them. Returns a function from a query, with its label, to its facts; how near a query without a
/// collision comes is said only if asked for.
/// \throws Error if the solvers cannot use this browser's arithmetic.
export async function startLive() {
  const code = await createTouchstone(); // eslint-disable-line no-undef
  const text = (place) => code.UTF8ToString(place);
  const fault = text(code._touchstone_arithmetic_fault());
  if (fault !== "") throw new Error(fault);
  const place = code._malloc(24 * 8);
  return ({ kind, coordinates, min_separation, norm, label }, withApproach = false) => {
    code.HEAPF64.set(coordinates, place / 8);
    const facts = JSON.parse(text(code._touchstone_facts(kind === "edge-edge" ? 1 : 0, place, min_separation,
      norm === "l2" ? 1 : 0, withApproach ? 1 : 0)));
    if (facts.error) throw new Error(facts.error);
    return readFacts({ ...facts, label });
  };
}
