#!/usr/bin/env python3
"""Gathers the pages of the documentation site: a folder that sphinx-build reads.

    pages.py SOURCE COMMANDS.json FOLDER [NOTEBOOKS]

The pages of docs/, docs/site/, docs/theory/, docs/decisions/, validation/ and bench/ are taken as they are, the README
in three parts. A link from one to another leads to its page; a link to any other file of the source tree becomes its
name. Pages of the subcommands come from COMMANDS.json (`describe_commands json`), those of the Python module from
its type stub, those of JSON files from docs/schemas.
"""

import ast
import json
import os
import pathlib
import re
import shutil
import sys
import textwrap

README_PARTS = {  # sections of the README, by page
    "tour.md": ["Five minutes"],
    "install.md": ["Two commands", "Installing it"],
    "overview.md": ["What it does", "Compared with other programs", "Where to go next", "Trials", "Limits"],
}
TITLES = {"tour.md": "Five minutes", "install.md": "Installing", "overview.md": "What it does, and what it does not"}
LINK = re.compile(r"(!?\[[^\]]*\])\(([^)\s]+)\)")
FENCE = re.compile(r"^(```|~~~)")


class Wrong(Exception):
    """What cannot become a page, in one line."""


def page_of(source, file):
    """The page of one of the Markdown files that have one, relative to the site."""
    path = file.relative_to(source)
    named = {"README.md": "overview.md", "CHANGELOG.md": "changelog.md", "bench/README.md": "bench.md",
             "validation/README.md": "validation/index.md", "docs/decisions/README.md": "decisions/index.md"}
    if str(path) in named:
        return named[str(path)]
    if path.parts[0] == "validation":  # validation/ankle/README.md
        return f"validation/{path.parent.name}.md" if path.name == "README.md" else str(path)
    return str(path.relative_to("docs/site" if path.parts[1] == "site" else "docs"))


def outside_code(text, change):
    """The text with every line outside of fenced and indented code changed."""
    fenced, lines = False, []
    for line in text.split("\n"):
        if FENCE.match(line):
            fenced = not fenced
        lines.append(line if fenced or line.startswith("    ") else change(line))
    return "\n".join(lines)


class Site:
    def __init__(self, source, folder):
        self.source, self.folder = source, folder
        patterns = ["docs/*.md", "docs/site/*.md", "docs/theory/*.md", "docs/decisions/*.md", "validation/*.md", "validation/*/README.md"]
        self.files = sorted(file for pattern in patterns for file in source.glob(pattern))
        self.files += [source / "bench/README.md", source / "CHANGELOG.md"]
        self.pages = {file: page_of(source, file) for file in self.files + [source / "README.md"]}

    def write(self, page, text):
        path = self.folder / page
        path.parent.mkdir(parents=True, exist_ok=True)
        if path.exists():
            raise Wrong(f"{page}: made twice")
        path.write_text(text, encoding="utf-8")

    def linked(self, file, page, text):
        """The text with links that lead from this page to other pages, pictures and out of the site."""
        def link(match):
            words, target = match.groups()
            if re.match(r"[a-z]+:", target) or target.startswith("#"):
                return match.group(0)
            path, _, anchor = target.partition("#")
            there = pathlib.Path(os.path.normpath(file.parent / path))
            if words.startswith("!"):
                return f"{words}({self.picture(there, page)})"
            if there.is_dir() and (there / "README.md") in self.pages:
                there = there / "README.md"
            to = self.pages.get(there)
            if there == self.source / "README.md" and anchor in ("two-commands", "installing-it", "five-minutes"):
                to = "tour.md" if anchor == "five-minutes" else "install.md"
            if to is None and file.parent == self.source / "docs/site":
                to = path  # a page that is made here
            if to is None:
                if not there.exists():
                    raise Wrong(f"{file}: link to {target}: no such file")
                return f"{words[1:-1]} (`{there.relative_to(self.source)}`)"
            return f"{words}({os.path.relpath(to, pathlib.PurePath(page).parent)}{'#' + anchor if anchor else ''})"
        return outside_code(text, lambda line: LINK.sub(link, line))

    def picture(self, there, page):
        if not there.exists():
            raise Wrong(f"{page}: no picture {there}")
        (self.folder / "pictures").mkdir(exist_ok=True)
        shutil.copy(there, self.folder / "pictures" / there.name)
        return os.path.relpath(f"pictures/{there.name}", pathlib.PurePath(page).parent)

    def markdown(self):
        for file in self.files:
            page = self.pages[file]
            text = self.linked(file, page, file.read_text(encoding="utf-8"))
            if page in ("validation/index.md", "decisions/index.md"):
                folder = page.split("/")[0]
                others = sorted(p for p in self.pages.values() if p.startswith(folder + "/") and p != page)
                text += toctree(others, folder)
            self.write(page, text)
        others = sorted(page for page in self.pages.values() if page.startswith("theory/"))
        self.write("theory/index.md", "# Theory\n\nWhat is computed, and why. Symbols: [notation](../notation.md).\n" + toctree(others, "theory", False))

    def readme(self):
        file = self.source / "README.md"
        sections = dict(re.findall(r"^## (.+?)\n(.*?)(?=^## |\Z)", file.read_text(encoding="utf-8"), re.M | re.S))
        for page, names in README_PARTS.items():
            text = f"# {TITLES[page]}\n\n"
            for name in names:
                if name not in sections:
                    raise Wrong(f"README.md: has no section '{name}'")
                text += sections[name] if len(names) == 1 else f"## {name}\n{sections[name]}"
            self.write(page, self.linked(file, page, text))

    def commands(self, tree):
        names = [command["name"] for command in tree["subcommands"]]
        text = f"# Commands\n\n{tree['purpose']}. `fisherhill SUBCOMMAND --help` prints what stands here.\n\n| subcommand | does |\n|---|---|\n"
        for command in tree["subcommands"]:
            text += f"| [{command['name']}](commands/{command['name']}.md) | {cell(command['purpose'])} |\n"
            self.write(f"commands/{command['name']}.md", command_page(command))
        self.write("commands.md", text + toctree([f"commands/{name}.md" for name in names], ""))

    def python(self):
        stub = self.source / "python/src/fisherhill/__init__.pyi"
        text = stub.read_text(encoding="utf-8")
        tree = ast.parse(text)
        public = next(ast.literal_eval(node.value) for node in tree.body
                      if isinstance(node, ast.Assign) and getattr(node.targets[0], "id", "") == "__all__")
        defined = {node.name: node for node in tree.body if isinstance(node, (ast.ClassDef, ast.FunctionDef))}
        page = f"# Python reference\n\n{prose(ast.get_docstring(tree))}\n\n| | |\n|---|---|\n"
        shown = []
        for name in public:
            node = defined.get(name)
            if node is None:
                continue
            first = (ast.get_docstring(node) or "").split("\n\n")[0]
            page += f"| [{name}]({name}.md) | {cell(plain(first))} |\n"
            self.write(f"python_reference/{name}.md", python_page(name, node, defined))
            shown.append(f"python_reference/{name}.md")
        self.write("python_reference/index.md", page + toctree(shown, "python_reference"))

    def notebooks(self, executed):
        pages = []
        for file in sorted((self.source / "docs/notebooks").glob("*.ipynb")):
            done = executed / f"{file.stem}.md" if executed else None
            if done and done.exists():
                text = done.read_text(encoding="utf-8")
                (self.folder / "notebooks").mkdir(exist_ok=True)
                for picture in executed.glob(f"{file.stem}_*.png"):
                    shutil.copy(picture, self.folder / "notebooks" / picture.name)
            else:
                cells = json.loads(file.read_text(encoding="utf-8"))["cells"]
                text = "\n\n".join("".join(cell["source"]) if cell["cell_type"] == "markdown" else f"```python\n{''.join(cell['source'])}\n```" for cell in cells)
            # long lines of results are broken; objects that have no other text are left out
            lines = [line if not line.startswith("    ") or len(line) < 104 else textwrap.fill(line, 104, initial_indent="    ", subsequent_indent="      ")
                     for line in text.split("\n") if not re.match(r"    (<matplotlib|Text\()", line)]
            page = f"notebooks/{file.stem}.md"
            text = LINK.sub(lambda found: found.group(0) if found.group(1).startswith("!") else self.linked(file, page, found.group(0)), "\n".join(lines))
            self.write(page, text + f"\n\nThis page is `docs/notebooks/{file.name}`.\n")
            pages.append(page)
        order = ["five_minutes", "your_own_emg", "what_can_my_data_know", "what_does_my_model_lack"]
        pages.sort(key=lambda page: order.index(pathlib.PurePath(page).stem) if pathlib.PurePath(page).stem in order else len(order))
        self.write("notebooks/index.md", "# Notebooks\n\nIn Python, with figures. CI executes them.\n" + toctree(pages, "notebooks", False))

    def schemas(self):
        text = "# Results as JSON\n\n`summary.json` of every subcommand, and `verdict.json` of `discover`. The files `docs/schemas/*.schema.json` are JSON Schemas of them; tests hold every result to them.\n"
        for name in ("summary", "verdict"):
            schema = json.loads((self.source / f"docs/schemas/{name}.schema.json").read_text(encoding="utf-8"))
            text += f"\n## {name}.json\n\n{schema.get('description', '')}\n"
            parts = schema.get("definitions", {})
            if "properties" in schema:
                parts = {"": schema, **parts}
            for part, one in parts.items():
                keys = {key: value for key, value in one.get("properties", {}).items() if isinstance(value, dict)}
                if keys:
                    text += (f"\n### {part} in {name}.json\n" if part else "") + "\n| key | type | is |\n|---|---|---|\n"
                    text += "".join(f"| `{key}` | {cell(kind(value))} | {cell(value.get('description', ''))} |\n" for key, value in keys.items())
        self.write("schemas.md", text)


def kind(schema):
    of = schema.get("type", "const" if "const" in schema else schema.get("$ref", "").split("/")[-1])
    return " or ".join(of) if isinstance(of, list) else of


def cell(text):
    return re.sub(r"\s+", " ", str(text)).replace("|", "\\|").strip()


def toctree(pages, folder, hidden=True):
    names = "\n".join(pathlib.PurePath(page).relative_to(folder).with_suffix("").as_posix() for page in pages)
    return f"\n```{{toctree}}\n{':hidden:' if hidden else ':maxdepth: 1'}\n\n{names}\n```\n"


def option_row(option):
    names = ", ".join(f"`{name}`" for name in option["names"])
    value = "\\|".join(option["choices"]) or option["value"]
    if value and option["names"][0].startswith("-"):
        names += f" {value.replace('<', '&lt;')}"
    text = option["description"]
    if option["default"]:
        text += f"; default {option['default']}"
    return f"| {names} | {cell(plain(text))}{'; required' if option['required'] else ''} |\n"


def plain(text):
    """Text in which Markdown and HTML see no marks of their own."""
    return re.sub(r"([*_<>\[\]])", r"\\\1", text)


def command_page(command):
    typed = " ".join(f"{a['names'][0]}{'…' if a['repeats'] else ''}" if a["required"] else f"[{a['names'][0]}{'…' if a['repeats'] else ''}]"
                     for a in command["arguments"])
    text = f"# fisherhill {command['name']}\n\n{command['purpose']}.\n\n```sh\nfisherhill {command['name']} {typed} [options]\n```\n"
    groups = {}
    for option in command["arguments"]:
        groups.setdefault("Arguments", []).append(option)
    for option in command["options"]:
        groups.setdefault(option["group"], []).append(option)
    for name, options in groups.items():
        text += f"\n## {name}\n\n| | |\n|---|---|\n" + "".join(option_row(option) for option in options)
    example = command["example"].partition("\n")[2].strip()
    return text + (f"\n## Example\n\n```sh\n{example}\n```\n" if example else "")


def signature(node):
    """A function as it is called, one argument a line where they are many."""
    named = ast.unparse(node.args).replace("self, ", "").replace("self", "")
    returns = f" -> {ast.unparse(node.returns)}" if node.returns else ""
    if len(named) > 90:
        arguments = node.args
        first, after = len(arguments.args) - len(arguments.defaults), []
        for i, one in enumerate(arguments.args):
            after.append(ast.unparse(one) + (f" = {ast.unparse(arguments.defaults[i - first])}" if i >= first else ""))
        if arguments.kwonlyargs:
            after.append("*")
        after += [ast.unparse(one) + (f" = {ast.unparse(value)}" if value else "") for one, value in zip(arguments.kwonlyargs, arguments.kw_defaults)]
        named = "\n    " + ",\n    ".join(one for one in after if one != "self") + ",\n"
    return f"```python\n{node.name}({named}){returns}\n```\n"


def blocks(lines):
    """(first line, lines that are indented below it), one after the other."""
    found = []
    for line in lines:
        if line.strip() and line[0] != " ":
            found.append((line, []))
        elif found:
            found[-1][1].append(line)
    return found


def dedented(lines):
    own = [len(line) - len(line.lstrip()) for line in lines if line.strip()]
    return [line[min(own):] if line.strip() else "" for line in lines] if own else []


def entries(lines, indent=""):
    """Terms with what is indented below them, as a list; terms below a term as a list in it."""
    text = ""
    for first, below in blocks(lines):
        inner = dedented(below)
        # terms below this one begin where the next line is indented
        nested = next((k for k in range(len(inner) - 1) if inner[k + 1].startswith(" ")), len(inner))
        name, _, of = first.partition(" : ")
        text += f"{indent}- **{plain(name)}**" + (f" : *{plain(of)}*" if of else "") + "\n"
        if any(inner[:nested]):
            text += f"{indent}  <br>" + plain(" ".join(" ".join(inner[:nested]).split())) + "\n"
        if inner[nested:]:
            text += "\n" + entries(inner[nested:], indent + "  ")
    return text


def prose(text):
    """A docstring before its first section: paragraphs, and indented lines as they are."""
    parts = []
    for part in (text or "").split("\n\n"):
        parts.append(part if part.startswith("    ") else plain(part))
    return "\n\n".join(parts)


def docstring(text):
    parts = re.split(r"^(\S[^\n]*)\n-{3,}\n", text or "", flags=re.M)
    made = prose(parts[0].strip("\n")) + "\n"
    for heading, body in zip(parts[1::2], parts[2::2]):
        lines = body.rstrip().split("\n")
        made += f"\n**{heading}**\n\n"
        listed = heading in ("Parameters", "Returns", "Attributes", "Raises")
        made += entries(lines) if listed else prose("\n".join(lines)) + "\n"
    return made


def members(node):
    text = ""
    for one in node.body:
        if isinstance(one, ast.FunctionDef) and not one.name.startswith("_") and ast.get_docstring(one):
            if any(getattr(mark, "id", "") == "property" for mark in one.decorator_list):
                returns = f" : *{plain(ast.unparse(one.returns))}*" if one.returns else ""
                text += f"\n## {one.name}\n\n`{one.name}`{returns}\n\n{docstring(ast.get_docstring(one))}"
            else:
                text += f"\n## {one.name}\n\n{signature(one)}\n{docstring(ast.get_docstring(one))}"
    return text


def python_page(name, node, defined):
    if isinstance(node, ast.ClassDef):
        return f"# {name}\n\n{docstring(ast.get_docstring(node))}{members(node)}"
    text = f"# {name}\n\n{signature(node)}\n{docstring(ast.get_docstring(node))}"
    result = getattr(node.returns, "id", None)
    if result in defined and ast.get_docstring(defined[result]):
        text += f"\n## {result}\n\n{docstring(ast.get_docstring(defined[result]))}"
    return text


def main():
    if len(sys.argv) not in (4, 5):
        print(__doc__, file=sys.stderr)
        return 2
    source, folder = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[3])
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    site = Site(source, folder)
    try:
        site.markdown()
        site.readme()
        site.commands(json.loads(pathlib.Path(sys.argv[2]).read_text(encoding="utf-8")))
        site.python()
        site.notebooks(pathlib.Path(sys.argv[4]) if len(sys.argv) == 5 else None)
        site.schemas()
    except Wrong as wrong:
        print(f"pages.py: {wrong}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
