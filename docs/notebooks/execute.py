#!/usr/bin/env python3
"""Executes the notebooks beside this file and writes them with their results, as notebooks and as Markdown.

    execute.py FOLDER

They run in the top folder of the source tree, with the `fisherhill` that PYTHONPATH or an installation offers. A cell
that fails ends this with its message and status 1. Needs Debian's python3-nbclient, python3-nbconvert,
python3-ipykernel and python3-matplotlib.
"""

import os
import pathlib
import sys

here = pathlib.Path(__file__).resolve().parent


def main():
    if len(sys.argv) != 2:
        print(__doc__, file=sys.stderr)
        return 2
    try:
        import nbclient
        import nbconvert
        import nbformat
    except ImportError as missing:
        print(f"{missing}: apt-get install python3-nbclient python3-nbconvert python3-ipykernel python3-matplotlib", file=sys.stderr)
        return 2
    os.environ["PYDEVD_DISABLE_FILE_VALIDATION"] = "1"  # no warnings of the kernel's debugger
    folder = pathlib.Path(sys.argv[1])
    folder.mkdir(parents=True, exist_ok=True)
    for file in sorted(here.glob("*.ipynb")):
        notebook = nbformat.read(file, as_version=4)
        try:
            nbclient.NotebookClient(notebook, timeout=600, resources={"metadata": {"path": str(here.parents[1])}}).execute()
        except nbclient.exceptions.CellExecutionError as error:
            print(f"{file.name}: {error}", file=sys.stderr)
            return 1
        nbformat.write(notebook, folder / file.name)
        text, found = nbconvert.MarkdownExporter().from_notebook_node(notebook)
        for name, data in found["outputs"].items():
            text = text.replace(f"]({name})", f"]({file.stem}_{name})").replace("![png]", "![Figure]")
            (folder / f"{file.stem}_{name}").write_bytes(data)
        (folder / f"{file.stem}.md").write_text(text, encoding="utf-8")
        print(f"{file.name}: {sum(cell.cell_type == 'code' for cell in notebook.cells)} cells")
    return 0


if __name__ == "__main__":
    sys.exit(main())
