"""Write the examples beside this file as notebooks into a folder: python3 to_notebooks.py FOLDER."""

import ast
import pathlib
import sys

import nbformat


def notebook_of(script: pathlib.Path) -> nbformat.NotebookNode:
    """Return a notebook of the script's docstring, and of its code with the script's own folder to import from."""
    text = script.read_text()
    module = ast.parse(text)
    code = "\n".join(text.splitlines()[module.body[0].end_lineno :]).strip()
    folder = f"import sys\nsys.argv, __file__ = ['example'], {str(script)!r}\nsys.path.insert(0, {str(script.parent)!r})"
    cells = [nbformat.v4.new_markdown_cell(ast.get_docstring(module))]
    cells += [nbformat.v4.new_code_cell(part) for part in (folder, code)]
    return nbformat.v4.new_notebook(cells=cells)


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    folder = pathlib.Path(sys.argv[1])
    folder.mkdir(parents=True, exist_ok=True)
    for script in sorted(pathlib.Path(__file__).resolve().parent.glob("*.py")):
        if script.name not in ("naive_cubic.py", "to_notebooks.py"):
            nbformat.write(notebook_of(script), folder / f"{script.stem}.ipynb")
