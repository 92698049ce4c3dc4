#!/usr/bin/env python3
"""Builds the site: `./run site`.

The pages are the Markdown files of the repository, in their folders, so that their links are valid in both. Beside them
stand the landing page (index.md) and the reference: the help of the programs, the headers (Doxygen, Breathe) and the
package for Python (autodoc). build/playground, if it exists, becomes part of the site.

At the end all links and anchors inside the site are checked, and outside links are listed in outside_links.txt. A page
that loads something from elsewhere is an error.
"""

import argparse
import base64
import html.parser
import io
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import time
import urllib.parse

from PIL import Image

ROOT = pathlib.Path(__file__).resolve().parents[2]
KATEX = pathlib.Path("/usr/share/javascript/katex")
PICTURE = ROOT / "docs/contact.webp"
PAGES = ["docs/**/*.md", "*/README.md", "exact/CERTIFICATES.md", "CONTRIBUTING.md", "CHANGELOG.md"]
HEADERS = [
    ("fast", "Solvers and steps", ["certified", "step", "mesh", "contacts", "tight_inclusion", "broad_phase"]),
    ("exact", "Ground truth and certificates", ["query", "oracle", "number", "polynomial", "algebraic_number", "certificate",
                                                "certificate_text"]),
    ("adapters", "Adapters", ["ipc_toolkit"]),
]


class Problem(Exception):
    """A problem that the user can fix."""


def run(command, **options):
    done = subprocess.run(command, capture_output=True, text=True, check=False, **options)
    if done.returncode != 0:
        raise Problem(f"{' '.join(map(str, command))}: exit status {done.returncode}\n{done.stdout}{done.stderr}")
    return done.stdout + done.stderr


# ---- Sources ---------------------------------------------------------------------------------------------------------


def links_of(text):
    """The files that a Markdown text links to, without code."""
    text = re.sub(r"^```.*?^```", "", text, flags=re.DOTALL | re.MULTILINE)
    for link in re.findall(r"\]\(([^)\s]+)\)", re.sub(r"`[^`]*`", "", text)):
        if not urllib.parse.urlparse(link).scheme and not link.startswith("#"):
            yield link.split("#")[0]


def with_languages(text):
    """The text with a language that Sphinx knows for each fence; it would take one without for Python."""
    lines, is_open = text.split("\n"), False
    for i, line in enumerate(lines):
        if line.startswith("```"):
            lines[i] = "```text" if line in ("```", "```csv", "```mermaid") and not is_open else line
            is_open = not is_open
    return "\n".join(lines)


def stage(source):
    """Copies the pages, and the files that they link to."""
    for pattern in PAGES:
        for page in ROOT.glob(pattern):
            name = page.relative_to(ROOT)
            if name.parts[:2] == ("docs", "site"):
                continue
            text = with_languages(page.read_text())
            copy = source / name
            copy.parent.mkdir(parents=True, exist_ok=True)
            copy.write_text(text)
            for link in links_of(text):
                target = (page.parent / link).resolve()
                if not target.exists() or ROOT not in target.parents:
                    raise Problem(f"{name}: the link {link} leads nowhere")
                if target.is_dir():
                    raise Problem(f"{name}: the link {link} leads to a folder, which a site does not show")
                if target.suffix != ".md":
                    (source / target.relative_to(ROOT)).parent.mkdir(parents=True, exist_ok=True)
                    shutil.copy(target, source / target.relative_to(ROOT))
    here = pathlib.Path(__file__).parent
    for page in [*here.glob("*.md"), *here.glob("reference/*.md")]:
        (source / page.relative_to(here)).parent.mkdir(exist_ok=True)
        shutil.copy(page, source / page.relative_to(here))
    shutil.copy(here / "conf.py", source)
    (source / "static/katex").mkdir(parents=True)
    for name in ("site.css", "site.js"):
        shutil.copy(here / name, source / "static")
    for name in ("katex.min.css", "katex.min.js", "fonts"):
        copy = shutil.copytree if (KATEX / name).is_dir() else shutil.copy
        copy(KATEX / name, source / "static/katex" / name)


def field():
    """The table of README.md that compares solvers."""
    return re.search(r"made by \./run results: compared -->\n\n(\|.*?)\n\n", (ROOT / "README.md").read_text(), re.DOTALL)[1]


def help_page(tool):
    """The help of all programs, as they print it."""
    subcommands = re.findall(r"^  ([a-z]+) ", run([tool, "--help"]).partition("Subcommands:")[2], re.MULTILINE)
    programs = [("touchstone", [tool]), *((f"touchstone {name}", [tool, name]) for name in subcommands),
                *((name, [tool.with_name(name)]) for name in ("touchstone-check", "touchstone-simulate"))]
    lines = ["# All options", "", "What each program prints with `--help`. The subcommands by task: [the command line](../docs/cli.md).", ""]
    for title, command in programs:
        if command[0].exists():
            lines += [f"## {title}", "", "```text", run([*command, "--help"], env=os.environ | {"COLUMNS": "100"}).rstrip(), "```", ""]
    return "\n".join(lines)


def cpp_page():
    lines = ["# C++", "", "The public headers. By example and by task: [the libraries](../docs/library.md).", ""]
    for _, title, headers in HEADERS:
        lines += [f"## {title}", ""]
        for header in headers:
            lines += [f"### touchstone/{header}.hpp", "", "```{eval-rst}", f".. doxygenfile:: touchstone/{header}.hpp",
                      "   :project: touchstone", "```", ""]
    return "\n".join(lines)


def c_page(title, header, text):
    return "\n".join([f"# {title}", "", text, "", "```{eval-rst}", f".. doxygenfile:: touchstone/{header}",
                      "   :project: touchstone", "```"])


def python_page(package):
    lines = ["# Python", "", "By example: [Python](../docs/python.md).", ""]
    if not (package / "touchstone/__init__.py").exists():
        return "\n".join([*lines, "This site was built without the package (`./run python`)."])
    return "\n".join([*lines, "```{eval-rst}", ".. automodule:: touchstone", "   :members:", "   :imported-members:", "```"])


def doxygen(folder):
    """The XML of the public headers for Breathe."""
    headers = " ".join(str(ROOT / name / "include/touchstone") for name in ("fast", "exact", "adapters", "verify"))
    settings = f"""PROJECT_NAME=touchstone
INPUT={headers}
FILE_PATTERNS=*.hpp *.h
STRIP_FROM_PATH={ROOT / 'fast/include'} {ROOT / 'exact/include'} {ROOT / 'adapters/include'} {ROOT / 'verify/include'}
OUTPUT_DIRECTORY={folder}
GENERATE_HTML=NO
GENERATE_LATEX=NO
GENERATE_XML=YES
QUIET=YES
WARNINGS=NO
WARN_IF_DOC_ERROR=NO
WARN_IF_INCOMPLETE_DOC=NO
EXTRACT_ALL=YES
MACRO_EXPANSION=YES
EXPAND_ONLY_PREDEF=YES
PREDEFINED=TOUCHSTONE_API=
"""
    subprocess.run(["doxygen", "-"], input=settings, text=True, check=True, stdout=subprocess.DEVNULL)


# ---- Checks ----------------------------------------------------------------------------------------------------------


class Page(html.parser.HTMLParser):
    """The anchors, the links and the loaded files of a page."""

    def __init__(self, file):
        super().__init__()
        self.ids, self.links, self.loaded = set(), [], []
        self.feed(file.read_text())

    def handle_starttag(self, tag, attributes):
        found = dict(attributes)
        self.ids.update(filter(None, (found.get("id"), found.get("name") if tag == "a" else None)))
        if tag == "a" and found.get("href"):
            self.links.append(found["href"])
        if tag == "link" and found.get("rel") in ("stylesheet", "icon", "preload") and found.get("href"):
            self.loaded.append(found["href"])
        if tag in ("script", "img", "iframe", "source", "video") and found.get("src"):
            self.loaded.append(found["src"])


def check(site):
    """The faults of all links, and the outside links with the pages that have them."""
    pages = {file: Page(file) for file in sorted(site.rglob("*.html"))}
    faults, outside = [], {}
    for file, page in pages.items():
        name = file.relative_to(site)
        for link in page.links + page.loaded:
            address = urllib.parse.urlparse(link)
            if address.scheme in ("data", "javascript", "mailto"):
                continue
            if address.scheme or address.netloc:
                outside.setdefault(link, []).append(str(name))
                if link in page.loaded:
                    faults.append(f"{name}: loads {link} from elsewhere")
                continue
            target = (file.parent / urllib.parse.unquote(address.path)).resolve() if address.path else file
            if not target.is_file():
                faults.append(f"{name}: the link {link} leads nowhere")
            elif address.fragment and target in pages and target.name != "playground.html":
                if urllib.parse.unquote(address.fragment) not in pages[target].ids:
                    faults.append(f"{name}: {link}: no such anchor")
    for file in site.rglob("*.css"):
        if re.search(r"(url\(|@import)\s*[\"']?(https?:|/)", file.read_text()):
            faults.append(f"{file.relative_to(site)}: loads from elsewhere")
    return faults, outside, len(pages)


# ---- The site --------------------------------------------------------------------------------------------------------


def build(options):
    work, site = options.build / "site-source", options.build / "site"
    for folder in (work, site):
        shutil.rmtree(folder, ignore_errors=True)
    source, xml = work / "pages", work / "doxygen"
    xml.mkdir(parents=True)
    stage(source)
    doxygen(xml)
    (source / "reference").mkdir(exist_ok=True)
    package = options.tool.parent / "python"
    for name, text in (("options", help_page(options.tool)), ("cpp", cpp_page()), 
                       ("c", c_page("C", "touchstone.h", "The C interface, by example: [adapters](../adapters/README.md#c).")),
                       ("plugin", c_page("Plugins", "plugin.h", "The interface of solvers under test: [testing](../docs/testing.md).")),
                       ("python", python_page(package))):
        (source / f"reference/{name}.md").write_text(text + "\n")
    index = source / "index.md"
    index.write_text(index.read_text().replace("@@FIELD@@", field()))
    playground = options.build / "playground"
    if playground.is_dir():
        shutil.copytree(playground, site)
    else:
        index.write_text(re.sub(r"<!-- playground -->.*?<!-- end -->\n?", "", index.read_text(), flags=re.DOTALL))
    shutil.copy(PICTURE, source / "static")
    version = run([options.tool, "--version"]).split()[0]
    environment = os.environ | {"TOUCHSTONE_VERSION": version, "TOUCHSTONE_DOXYGEN": str(xml / "xml"),
                                "PYTHONPATH": str(package)}
    said = run([sys.executable, "-m", "sphinx", "-b", "html", "-q", source, site, "-d", work / "doctrees"], env=environment)
    # A namespace is declared in each of its headers, the types in common in both headers in C; Breathe 4.34 gives each
    # enumerator its anchor twice.
    said = re.sub(r".*(Duplicate (C(\+\+)? declaration|ID|explicit target name)|Doxygen .exception commands).*\n(Declaration is .*\n)?", "", said).strip()
    if said:
        raise Problem(said)
    # Debian's Furo has the script of the theme as a module, which no browser loads from a file.
    script = site / "_static/scripts/furo.js"
    run(["esbuild", script, "--bundle", "--minify", "--allow-overwrite", f"--outfile={script}"])
    # Its style imports another from the folder of Debian's web servers.
    style = site / "_static/styles/furo.css"
    text = re.sub(r'@import\s*(?:url\()?["\']?/javascript/([^"\')]+)["\']?\)?;?',
                  lambda found: pathlib.Path("/usr/share/javascript", found[1]).read_text(), style.read_text())
    # It has lost the dark colours of a browser in dark mode, which its style of code and our pictures follow.
    dark = re.search(r'@media not print (\{\s*body\[data-theme="dark"\].*?\} \})', text, re.DOTALL)[1]
    style.write_text(text + "\n@media screen and (prefers-color-scheme: dark) " + dark.replace('="dark"', '="auto"'))
    for rest in (".buildinfo", "objects.inv"):
        (site / rest).unlink(missing_ok=True)
    return site


# A script for the page of `touchstone view`: moves its slider, and leaves the pictures in the document.
RECORDER = """<script>
addEventListener("load", () => {
  const slider = document.querySelector("#time"), canvas = document.querySelector("#motion canvas"), frames = [];
  for (let i = 0; i <= 24; ++i) {
    slider.value = Math.round(slider.max * i / 24);
    slider.dispatchEvent(new Event("input"));
    frames.push(canvas.toDataURL("image/png"));
  }
  document.body.textContent = frames.join(" ");
});
</script></body>"""


def draw_picture(options, work):
    """Draws the moving picture of README.md and of the landing page anew, by the view."""
    page = work / "view.html"
    points = "1 0.4 2.6  0 0 0  4 0 0  0 4 0   1.2 1.4 -1.4  0 0 0.3  4 0 0.6  0 4 0"
    run([options.tool, "view", "--kind", "vertex-face", "--points", points, "--out", page])
    page.write_text(page.read_text().replace("</body>", RECORDER))
    dom = run(["chromium", "--headless", "--no-sandbox", "--disable-gpu", "--use-angle=swiftshader",
               "--enable-unsafe-swiftshader", "--disable-dev-shm-usage", "--window-size=1400,1000",
               "--virtual-time-budget=20000", f"--user-data-dir={work}/profile", "--dump-dom", page.as_uri()])
    found = re.findall(r"data:image/png;base64,([A-Za-z0-9+/=]+)", dom)
    if len(found) < 2:
        raise Problem("the view's page has no moving picture")
    frames = []
    for frame in found:
        drawn = Image.open(io.BytesIO(base64.b64decode(frame))).convert("RGBA")
        frames.append(Image.alpha_composite(Image.new("RGBA", drawn.size, "white"), drawn).convert("RGB"))
    frames[0].save(PICTURE, save_all=True, append_images=frames[1:],
                   duration=[700, *[90] * (len(frames) - 2), 1200], loop=0, quality=80)


def main():
    parser = argparse.ArgumentParser(prog="./run site", description="Builds the site: build/site.")
    parser.add_argument("--tool", type=pathlib.Path, default=ROOT / "build/release/touchstone")
    parser.add_argument("--build", type=pathlib.Path, default=ROOT / "build", help="the folder of site/ and site-source/")
    parser.add_argument("--check", action="store_true", help="only check the links of the site")
    parser.add_argument("--picture", action="store_true", help=f"only draw {PICTURE.relative_to(ROOT)} anew")
    options = parser.parse_args()
    options.tool, options.build = options.tool.resolve(), options.build.resolve()
    begin = time.monotonic()
    if options.picture:
        with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as work:
            draw_picture(options, pathlib.Path(work))
        return 0
    site = options.build / "site" if options.check else build(options)
    faults, outside, pages = check(site)
    (site / "outside_links.txt").write_text("".join(f"{link}\t{', '.join(sorted(set(names)))}\n" for link, names in sorted(outside.items())))
    size = sum(file.stat().st_size for file in site.rglob("*") if file.is_file())
    print("\n".join(faults))
    print(f"{site}: {pages} pages, {size / 1e6:.1f} MB, {len(outside)} outside links (outside_links.txt), {len(faults)} faults, "
          f"{time.monotonic() - begin:.0f} s")
    return 1 if faults else 0


if __name__ == "__main__":
    try:
        sys.exit(main())
    except (Problem, OSError) as problem:
        print(f"./run site: {problem}", file=sys.stderr)
        sys.exit(2)
