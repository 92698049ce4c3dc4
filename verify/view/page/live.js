// The solvers of the tool in WebAssembly (verify/playground), where the page has them. They run in workers, so that the page never
// waits: one decides; another finds least distances, which may take seconds, and is ended where another one is asked for.

import { find } from "./elements.js";
import { readFacts } from "./facts.js";

/// True if this page has the solvers.
export const isLive = find("solvers") !== null;

/// The parts of the facts that a worker is asked for (verify/playground/playground.cpp).
export const answersOfSolvers = 1, nearestApproach = 2;

const program = `
const opened = openTouchstone();
opened.then(() => postMessage({}), (error) => postMessage({ error: error.message }));
onmessage = async ({ data }) => {
  const touchstone = await opened;
  try {
    postMessage({ facts: touchstone.facts(data.query, data.parts) });
  } catch (error) {
    postMessage({ error: error.message });
  }
};`;

/// Starts a worker. Returns a function that asks it for these parts of the facts of a query, with its label. The newest question alone
/// is answered: one that waits is forgotten, and so is one that is being answered, if it isEnded. Others have no answer, ever.
/// \throws Error if the solvers cannot use this browser's arithmetic.
export async function startSolvers(parts, isEnded = false) {
  const address = URL.createObjectURL(new Blob([find("solvers").textContent, program], { type: "text/javascript" }));
  let worker, answered, next = null;
  const begin = () => {
    worker = new Worker(address);
    return new Promise((resolve, reject) => {
      answered = { resolve, reject };
      worker.onmessage = ({ data }) => {
        const { resolve: found, reject: failed } = answered;
        answered = null;
        if (next !== null) send();
        if (data.error) failed(new Error(data.error));
        else found(data.facts);
      };
    });
  };
  function send() {
    const { query: { kind, coordinates, min_separation, norm }, ...promise } = next;
    answered = promise;
    next = null;
    worker.postMessage({ query: { kind, coordinates, separation: min_separation, norm }, parts });
  }
  await begin();
  return (query) => new Promise((resolve, reject) => {
    next = { query, resolve: (facts) => resolve(readFacts({ ...facts, label: query.label })), reject };
    if (answered === null) send();
    else if (isEnded) {
      worker.terminate();
      begin();
    }
  });
}
