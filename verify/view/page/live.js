// The solvers of the tool in WebAssembly (verify/playground), where the page has them. They run in a worker, so that the page never
// waits.

import { find } from "./elements.js";
import { readFacts } from "./facts.js";

/// True if this page has the solvers.
export const isLive = find("solvers") !== null;

const program = `
const opened = openTouchstone();
opened.then(() => postMessage({}), (error) => postMessage({ error: error.message }));
onmessage = async ({ data }) => {
  const touchstone = await opened;
  try {
    postMessage({ facts: touchstone.facts(data) });
  } catch (error) {
    postMessage({ error: error.message });
  }
};`;

/// Starts the worker. Returns a function that asks it for the facts of a query, with its label. The newest question alone is answered:
/// one that waits when another is asked has no answer, ever.
/// \throws Error if the solvers cannot use this browser's arithmetic.
export async function startSolvers() {
  const worker = new Worker(URL.createObjectURL(new Blob([find("solvers").textContent, program], { type: "text/javascript" })));
  let answered, next = null;
  function send() {
    answered = next;
    next = null;
    const { kind, coordinates, min_separation, norm } = answered.query;
    worker.postMessage({ kind, coordinates, separation: min_separation, norm });
  }
  await new Promise((resolve, reject) => {
    answered = { resolve, reject };
    worker.onmessage = ({ data }) => {
      const { resolve: found, reject: failed } = answered;
      answered = null;
      if (next !== null) send();
      if (data.error) failed(new Error(data.error));
      else found(data.facts);
    };
  });
  return (query) => new Promise((resolve, reject) => {
    next = { query, resolve: (facts) => resolve(readFacts({ ...facts, label: query.label })), reject };
    if (answered === null) send();
  });
}
