"""The type stub beside the imported package, for tests: its signatures, its docstrings, and what results must hold."""

import ast
import inspect
import pathlib
import types

import numpy as np

import fisherhill

folder = pathlib.Path(fisherhill.__file__).parent
tree = ast.parse((folder / "__init__.pyi").read_text(encoding="utf-8"))


def decorated(node, name):
    return any(isinstance(one, ast.Name) and one.id == name for one in node.decorator_list)


def definitions(body, kind):
    return {node.name: node for node in body if isinstance(node, kind)}


functions = definitions(tree.body, ast.FunctionDef)
classes = {name: node for name, node in definitions(tree.body, ast.ClassDef).items() if not decorated(node, "type_check_only")}
results = {
    name: {one.target.id: one.annotation for one in node.body if isinstance(one, ast.AnnAssign)}
    for name, node in definitions(tree.body, ast.ClassDef).items()
    if decorated(node, "type_check_only")
}


def members(cls):
    """(properties, methods) of a class, by name."""
    defined = definitions(classes[cls].body, ast.FunctionDef)
    properties = {name: node for name, node in defined.items() if decorated(node, "property")}
    return properties, {name: node for name, node in defined.items() if name not in properties}


def parameters(node):
    """[(name, whether by name only, default)] of a function; of no default: ()."""
    def default(value):
        return () if value is None else ast.literal_eval(value)

    plain = node.args.posonlyargs + node.args.args
    defaults = [None] * (len(plain) - len(node.args.defaults)) + node.args.defaults
    return [(arg.arg, False, default(value)) for arg, value in zip(plain, defaults)] + [
        (arg.arg, True, default(value)) for arg, value in zip(node.args.kwonlyargs, node.args.kw_defaults)
    ]


def compiled(function):
    """The same of a compiled function, from the line that pybind11 writes, and the docstring below that line; or of one
    of the package's Python files."""
    if inspect.isfunction(function):
        signature = inspect.signature(function).parameters.values()
        return [
            (one.name, one.kind is one.KEYWORD_ONLY, () if one.default is one.empty else one.default) for one in signature
        ], function.__doc__.strip()
    line, _, text = function.__doc__.partition("\n")
    return parameters(ast.parse(f"def {line}: ...").body[0]), text.strip()


def headings(docstring, section):
    """Names that a section of a NumPy docstring explains."""
    lines = docstring.split("\n")
    if section not in lines:
        return []
    names = []
    for line in lines[lines.index(section) + 2:]:
        if line.startswith("---"):
            return names[:-1]  # the line above is the next section's title
        if line and not line.startswith(" "):
            names += line.split(" : ")[0].split(", ")
    return names


plain = {"float": float, "int": int, "bool": bool, "str": str}


def mistakes(value, annotation, where):
    """What is wrong with a value of the given annotation, one line each."""
    if isinstance(annotation, ast.Constant):
        return [] if value is annotation.value else [f"{where}: {value!r}, must be {annotation.value}"]
    if isinstance(annotation, ast.BinOp):
        left, right = (mistakes(value, one, where) for one in (annotation.left, annotation.right))
        return [] if not left or not right else left + right
    if isinstance(annotation, ast.Subscript):
        return mistakes_inside(value, annotation.value.id, annotation.slice, where)
    name = annotation.id
    if name in results:
        return mistakes_of_result(value, name, where)
    if name == "_Array":
        right = isinstance(value, np.ndarray) and value.dtype == np.float64
    else:
        right = type(value) is (plain.get(name) or getattr(fisherhill, name))
    return [] if right else [f"{where}: {value!r}, must be {name}"]


def bases(name):
    """Of a class of results, as the stub has them."""
    return [base.id for base in definitions(tree.body, ast.ClassDef)[name].bases if isinstance(base, ast.Name)]


def mistakes_inside(value, container, inside, where):
    if container == "Literal":
        choices = ast.literal_eval(inside)
        return [] if value in choices else [f"{where}: {value!r}, must be one of {choices}"]
    if container in ("_Rows", "_PlottedRows"):
        if not isinstance(value, list) or type(value) is list or hasattr(value, "plot") != (container == "_PlottedRows"):
            return [f"{where}: {value!r}, must be a list that is a table"]
    elif type(value).__name__ != container:
        return [f"{where}: {value!r}, must be {container}"]
    if container == "dict":
        key, of = inside.elts
        items = [*((one, key) for one in value), *((one, of) for one in value.values())]
    elif container == "tuple":
        items = list(zip(value, inside.elts, strict=True))
    else:
        items = [(one, inside) for one in value]
    return [line for i, (one, of) in enumerate(items) for line in mistakes(one, of, f"{where}[{i}]")]


def mistakes_of_result(value, name, where):
    expected = name if bases(name) else "SimpleNamespace"
    if not isinstance(value, types.SimpleNamespace) or type(value).__name__ != expected:
        return [f"{where}: {value!r}, must be {expected}"]
    if hasattr(value, "plot") != ("_Plotted" in bases(name)):
        return [f"{where}: {value!r} has plot() if the stub has not"]
    members = vars(value)
    found = [f"{where}.{one}: not in the stub" for one in members if one not in results[name]]
    for one, annotation in results[name].items():
        if one in members:
            found += mistakes(members[one], annotation, f"{where}.{one}")
        else:
            found.append(f"{where}.{one}: missing")
    return found


def check(value, name):
    """Raises AssertionError unless the value is a result as the stub's class `name` has it."""
    found = mistakes(value, ast.Name(name), name)
    assert not found, "\n".join(found)
