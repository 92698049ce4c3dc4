// compare_facts.js PACKAGE VIEW.html: the solvers in WebAssembly say of each query on a page of `touchstone view` what this
// machine says: verdict, times, certificate, and the answers of Touchstone's own methods, in all bits; other methods sum in another
// order there, so that of them the names are compared. So do the functions of the package. compare_facts.js --methods: the options of
// view for all these methods.

const fs = require("fs");

const own = ["certified", "tight_inclusion"];
const others = ["accd", "cubic"];

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
  const { open, doubleOfText } = require(require("path").resolve(script));
  const touchstone = await open();
  const all = JSON.parse(/<script type="application\/json" id="queries">(.*?)<\/script>/s.exec(fs.readFileSync(page, "utf8"))[1]);
  let different = 0;
  for (const facts of all) {
    const query = { kind: facts.kind, coordinates: facts.coordinates.map(doubleOfText),
      separation: doubleOfText(facts.min_separation), norm: facts.norm };
    const said = touchstone.facts(query);
    const isSame = compared(said) === compared(facts) && arePublicCallsRight(touchstone, query, facts, doubleOfText);
    if (isSame) continue;
    different += 1;
    console.log(`${facts.label}: ${compared(said)}\nhere ${compared(facts)}`);
  }
  console.log(`playground: ${all.length} queries, ${different} differ`);
  return different === 0 && all.length > 0 ? 0 : 1;
}

/// The functions of the package say what the facts say, and a certificate of another verdict is rejected.
function arePublicCallsRight({ decide, solve, check }, query, { truth, certificate }, double) {
  const decision = decide(query), answer = solve(query);
  const toi = truth.toi && [double(truth.toi.lower), double(truth.toi.upper), truth.toi.exact];
  if (JSON.stringify(decision.toi && [decision.toi.lower, decision.toi.upper, decision.toi.exact]) !== JSON.stringify(toi || null)) return false;
  if (decision.collides !== truth.collides || answer.verdict !== (truth.collides ? "yes" : "no")) return false;
  if (toi && !(answer.toi_lower <= toi[0] && answer.toi_upper >= toi[1])) return false;
  if (certificate === null) return decision.certificate === null;
  const other = decision.certificate.replace(/^claim .*$/m, truth.collides ? "claim no_collision" : "claim collision");
  const isAccepted = (text) => {
    try {
      return check(text).accepted;
    } catch {
      return false;
    }
  };
  return isAccepted(decision.certificate) && !isAccepted(other);
}

if (process.argv[2] === "--methods") console.log([...own, ...others].map((name) => `--method ${name}`).join(" "));
else main(process.argv.slice(2)).then((status) => process.exit(status));
