// package.js PACKAGE.tgz: npm installs the package from its archive, without a network; its types hold for a program; and its page,
// served as an installed package is, decides a query in Chromium, in real time.

const { execFileSync, spawn } = require("child_process");
const fs = require("fs"), http = require("http"), os = require("os"), path = require("path");

const program = `
import { open, Query } from "touchstone-ccd";
const query: Query = { kind: "edge_edge", coordinates: new Float64Array(24), separation: 0.5, norm: "linf" };
open().then((touchstone) => {
  const time: number = touchstone.decide(query).toi!.lower;
  // @ts-expect-error: a certificate is a text
  const wrong = () => touchstone.check(1);
  console.log(time, touchstone.solve(query).verdict);
});
`;

const folder = fs.mkdtempSync(path.join(os.tmpdir(), "touchstone-"));
const run = (command, ...args) => execFileSync(command, args, { cwd: folder, encoding: "utf8" });

function requireEqual(found, expected) {
  if (found !== expected) throw new Error(`"${found}" is not "${expected}"`);
}

/// What the page says after its input has become the height.
function pageSays(height) {
  const loader = `<meta charset="utf-8"><iframe src="example.html"></iframe><script>
    const frame = document.querySelector("iframe");
    const said = () => frame.contentDocument.getElementById("said").textContent;
    const wait = (isReady) => new Promise((done) => setInterval(() => isReady() && done(), 20));
    frame.onload = async () => {
      await wait(() => said() !== "…");
      const input = frame.contentDocument.getElementById("height"), before = said();
      input.value = "${height}";
      input.dispatchEvent(new Event("input"));
      fetch("/said", { method: "POST", body: before + "|" + said() });
    };</script>`;
  return new Promise((resolve) => {
    let browser;
    const server = http.createServer((request, response) => {
      const name = path.basename(request.url);
      if (request.method === "POST") {
        request.on("data", (data) => { browser.kill(); server.close(); resolve(String(data)); });
        response.end();
      } else if (name === "loader.html") {
        response.writeHead(200, { "Content-Type": "text/html" }).end(loader);
      } else {
        const file = path.join(folder, "node_modules/touchstone-ccd", name);
        response.writeHead(fs.existsSync(file) ? 200 : 404, { "Content-Type": name.endsWith(".js") ? "text/javascript" : "text/html" });
        response.end(fs.existsSync(file) ? fs.readFileSync(file) : "");
      }
    }).listen(0, "127.0.0.1", () => {
      browser = spawn("chromium", ["--headless", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage", "--remote-debugging-port=0",
        `--user-data-dir=${folder}/profile`, `http://127.0.0.1:${server.address().port}/loader.html`], { stdio: "ignore" });
      browser.on("exit", () => server.close());
    });
  });
}

async function main(archive) {
  fs.writeFileSync(path.join(folder, "package.json"), "{}");
  run("npm", "install", "--offline", "--silent", "--no-audit", path.resolve(archive));
  fs.writeFileSync(path.join(folder, "program.ts"), program);
  run("tsc", "--strict", "--target", "es2020", "--module", "commonjs", "program.ts");
  requireEqual(run("node", "program.js"), "0 yes\n");
  requireEqual(await pageSays(-1), "They touch at t = 1/3. The proof is right.|They do not touch. The proof is right.");
  console.log("package: installed, typed, and used by node and by a page");
}

main(process.argv[2]).finally(() => fs.rmSync(folder, { recursive: true, force: true, maxRetries: 5 }));
