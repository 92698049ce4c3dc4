#!/usr/bin/env python3
"""Tests the site in a browser: builds it, and loads every page at 1400 and at 390 px.

No page has an error in the console, scrolls sideways, or asks for anything outside of the site; a table is sorted by a click;
the search finds what users look for.
"""

import argparse
import functools
import http.server
import json
import pathlib
import re
import subprocess
import sys
import tempfile
import threading
import urllib.parse

ROOT = pathlib.Path(__file__).resolve().parents[1]

# What the search finds, each with a page that it must find.
SEARCHED = {"certificate": "exact/CERTIFICATES.html", "self-intersection": "docs/cli.html", "line search": "docs/library.html",
            "false negative": "docs/concepts.html"}

# Loads the pages one after the other in frames of both widths, and writes what it sees into the document.
LOADER = """<!DOCTYPE html><meta charset="utf-8"><body><script>
const pages = PAGES, seen = [];
function load(page, width) {
  return new Promise((done) => {
    const frame = document.createElement("iframe");
    frame.width = width;
    frame.height = 900;
    frame.src = page;
    frame.onload = () => setTimeout(() => done(frame), page.includes("search.html") ? 3000 : 200);
    setTimeout(() => { if (frame.isConnected) { console.error(page + " does not load"); done(frame); } }, 20000);
    document.body.append(frame);
  });
}
(async () => {
  for (const page of pages) {
    for (const width of [1400, 390]) {
      const frame = await load(page, width), page_ = frame.contentDocument;
      const fact = { page, width, wide: page_.documentElement.scrollWidth, title: page_.title };
      const head = page_.querySelector("th.sortable");
      if (head) {
        head.click();
        fact.sorted = head.getAttribute("aria-sort");
      }
      if (page.includes("search.html")) fact.found = [...page_.querySelectorAll("#search-results li a")].map((link) => link.getAttribute("href").split(/[?#]/)[0]);
      seen.push(fact);
      frame.remove();
    }
  }
  const result = document.createElement("pre");
  result.id = "seen";
  result.textContent = JSON.stringify(seen);
  document.body.append(result);
  await fetch("/seen", { method: "POST", body: JSON.stringify(seen) });
})();
</script>"""


class Server(http.server.SimpleHTTPRequestHandler):
    seen, done, missing = None, threading.Event(), []

    def do_POST(self):
        Server.seen = json.loads(self.rfile.read(int(self.headers["Content-Length"])))
        self.send_response(200)
        self.end_headers()
        Server.done.set()

    def log_error(self, form, *arguments):
        Server.missing.append(self.path)

    def log_message(self, form, *arguments):
        pass


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--tool", type=pathlib.Path, default=ROOT / "build/release/touchstone")
    parser.add_argument("--site", type=pathlib.Path, help="a site that is built already")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as name:
        folder, site = pathlib.Path(name), options.site
        if not site:
            if subprocess.run(["/usr/bin/python3", "-c", "import sphinx, myst_parser, breathe, furo"], check=False,
                              capture_output=True).returncode:
                print("MISSING packages of the site (./run site installs them)")
                return 77
            # In the place of the playground, which takes a compiler for WebAssembly.
            (folder / "playground").mkdir()
            (folder / "playground/playground.html").write_text("<!DOCTYPE html><title>playground</title><p id=verdict>free</p>")
            subprocess.run(["/usr/bin/python3", ROOT / "docs/site/build.py", "--tool", options.tool, "--build", folder], check=True)
            site = folder / "site"
        pages = sorted(str(page.relative_to(site)) for page in site.rglob("*.html") if page.name != "loader.html")
        pages += [f"search.html?q={'+'.join(words.split())}" for words in SEARCHED]
        (site / "loader.html").write_text(LOADER.replace("PAGES", json.dumps(pages)))
        server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), functools.partial(Server, directory=str(site)))
        threading.Thread(target=server.serve_forever, daemon=True).start()
        # The proxy does not exist: every access to the network is an error.
        with (folder / "err").open("w") as err:
            browser = subprocess.Popen(
                ["chromium", "--headless", "--no-sandbox", "--disable-gpu", "--use-angle=swiftshader", "--enable-unsafe-swiftshader",
                 "--disable-dev-shm-usage", "--enable-logging=stderr",
                 "--proxy-server=127.0.0.1:9", "--proxy-bypass-list=127.0.0.1", "--window-size=1500,1000",
                 f"--user-data-dir={folder}/profile", "--remote-debugging-port=0",
                 f"http://127.0.0.1:{server.server_port}/loader.html"], stdout=subprocess.DEVNULL, stderr=err)
            Server.done.wait(500)
            browser.terminate()
            browser.wait()
        (site / "loader.html").unlink()
        faults = [line for line in (folder / "err").read_text().splitlines() if ":CONSOLE" in line]
    if Server.seen is None:
        faults.append("the browser did not end")
    for fact in Server.seen or []:
        if fact["wide"] > fact["width"]:
            faults.append(f"{fact['page']} is {fact['wide']} px wide in {fact['width']}")
        words = urllib.parse.unquote_plus(fact["page"].partition("?q=")[2])
        if not fact["title"] or fact.get("sorted", "ascending") != "ascending" or words and SEARCHED[words] not in fact["found"]:
            faults.append(f"{fact}")
    faults += [f"missing: {path}" for path in Server.missing if "favicon" not in path]
    print("\n".join(faults))
    print(f"{len(pages)} pages at 1400 and 390 px: {len(faults)} faults")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
