// compare_facts.js PLAYGROUND.js VIEW.html: the solvers in WebAssembly say of each query on a page of `touchstone view` what this
// machine says: verdict, times, certificate, and the answers of Touchstone's own methods, in all bits; other methods sum in another
// order there, so that of them the names are compared. compare_facts.js --methods: the options of view for all these methods.

const fs = require("fs");

const own = ["certified", "tight_inclusion", "tight_inclusion_published", "tight_inclusion_float", "tight_inclusion_released"];
const others = ["tccd", "msrf", "accd", "cubic"];

/// The double of C's %a.
function parse(text) {
  const [, sign, first, fraction = "", power] = /^(-?)0x([01])(?:\.([0-9a-f]*))?p([-+]\d+)$/.exec(text);
  let value = Number(BigInt(`0x${first}${fraction.padEnd(13, "0")}`)), exponent = Number(power) - 52;
  for (; exponent < -1000; exponent += 500) value *= 2 ** -500;
  value *= 2 ** exponent;
  return sign ? -value : value;
}

/// What must agree. A certificate's first lines hold the name of its query.
function compared({ truth, certificate, answers }) {
  const { text, ...rest } = certificate || { text: "" };
  const bySolver = answers.filter(({ solver }) => [...own, ...others].includes(solver)).map((answer) =>
     (own.includes(answer.solver) ? answer : answer.solver));
  // Of a rational time, which polynomial has it as a root depends on the order of refinements.
  const toi = truth.toi && { ...truth.toi, polynomial: truth.toi.exact === null ? truth.toi.polynomial : "" };
  return JSON.stringify([{ ...truth, toi }, rest, text.slice(text.indexOf("\npoint ")), bySolver]);
}

async function main([script, page]) {
  const code = await require(require("path").resolve(script))();
  const text = (place) => code.UTF8ToString(place);
  const fault = text(code._touchstone_arithmetic_fault());
  if (fault) throw new Error(fault);
  const place = code._malloc(24 * 8);
  const all = JSON.parse(/<script type="application\/json" id="queries">(.*?)<\/script>/s.exec(fs.readFileSync(page, "utf8"))[1]);
  let different = 0;
  for (const facts of all) {
    code.HEAPF64.set(facts.coordinates.map(parse), place / 8);
    const said = JSON.parse(text(code._touchstone_facts(facts.kind === "edge-edge" ? 1 : 0, place, parse(facts.min_separation),
      facts.norm === "l2" ? 1 : 0, 0)));
    if (!said.error && compared(said) === compared(facts)) continue;
    different += 1;
    console.log(`${facts.label}: ${said.error || `${compared(said)}\nhere ${compared(facts)}`}`);
  }
  console.log(`playground: ${all.length} queries, ${different} differ`);
  return different === 0 && all.length > 0 ? 0 : 1;
}

if (process.argv[2] === "--methods") console.log([...own, ...others].map((name) => `--method ${name}`).join(" "));
else main(process.argv.slice(2)).then((status) => process.exit(status));
