"""python3 docstrings.py STUB HEADER: writes the docstrings of a type stub as string constants for C++.

The docstring of `replay` becomes `docstrings::replay`, that of a class member `docstrings::Model_write`, and those
of __init__ and __call__ are called `init` and `call`.
"""

import ast
import pathlib
import sys


def docstrings(body, prefix=""):
    """(name, docstring) of every function, class and member that has one."""
    for node in body:
        if not isinstance(node, (ast.FunctionDef, ast.ClassDef)):
            continue
        name = prefix + node.name.strip("_")
        text = ast.get_docstring(node)
        if text:
            yield name, text
        if isinstance(node, ast.ClassDef):
            yield from docstrings(node.body, name + "_")


def header(stub):
    constants = "".join(
        f'inline constexpr char {name}[] = R"doc({text})doc";\n\n' for name, text in docstrings(ast.parse(stub).body)
    )
    return (
        "#pragma once\n\n// Made from the type stub by python/docstrings.py.\n"
        f"namespace python::docstrings {{\n\n{constants}}}  // namespace python::docstrings\n"
    )


if __name__ == "__main__":
    stub, made = map(pathlib.Path, sys.argv[1:])
    made.write_text(header(stub.read_text(encoding="utf-8")), encoding="utf-8")
