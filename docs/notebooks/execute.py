#!/usr/bin/env python3
"""Executes the notebooks beside this file and writes them with their results, as notebooks and as Markdown.

    execute.py FOLDER

They run in the top folder of the source tree, with the Python that runs this and the `fisherhill` that PYTHONPATH or an
installation offers it. A cell that fails ends this with its message and status 1. Needs Debian's python3-nbclient,
python3-nbconvert, python3-ipykernel and python3-matplotlib.
"""

import json
import os
import pathlib
import sys
import tempfile

here = pathlib.Path(__file__).resolve().parent


def use_this_python(folder):
    """Makes the kernel `python3` one of the Python that runs this: Debian's is always Debian's Python, not that of an environment."""
    kernel = pathlib.Path(folder) / "kernels/python3"
    kernel.mkdir(parents=True)
    command = [sys.executable, "-m", "ipykernel_launcher", "-f", "{connection_file}"]
    (kernel / "kernel.json").write_text(json.dumps({"argv": command, "display_name": "Python 3", "language": "python"}), encoding="utf-8")
    os.environ["JUPYTER_PATH"] = os.pathsep.join([str(folder), *os.environ.get("JUPYTER_PATH", "").split(os.pathsep)]).rstrip(os.pathsep)


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
    with tempfile.TemporaryDirectory() as kernels:
        use_this_python(kernels)
        return execute(folder, nbclient, nbconvert, nbformat)


def execute(folder, nbclient, nbconvert, nbformat):
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
