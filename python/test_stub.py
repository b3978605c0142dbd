"""The type stub names exactly what the package has, with the same arguments and docstrings."""

import ast
import unittest

import fisherhill as fh

import stub


def public(names):
    return {name for name in names if not name.startswith("_")}


class Stub(unittest.TestCase):
    def pairs(self):
        """(name, node of the stub, compiled function) of every function and method."""
        for name, node in stub.functions.items():
            yield name, node, getattr(fh, name)
        for cls in stub.classes:
            for name, node in stub.members(cls)[1].items():
                yield f"{cls}.{name}", node, getattr(getattr(fh, cls), name)

    def test_it_names_what_the_package_has(self):
        listed = next(node.value for node in stub.tree.body if isinstance(node, ast.Assign) and node.targets[0].id == "__all__")
        named = {*stub.functions, *stub.classes}
        self.assertGreater(len(named), 10)
        self.assertEqual(public(dir(fh)), named)
        self.assertEqual(fh.__all__, sorted(named))
        self.assertEqual(ast.literal_eval(listed), fh.__all__)

    def test_it_names_the_members_of_classes(self):
        for cls in stub.classes:
            properties, methods = stub.members(cls)
            self.assertEqual(public(dir(getattr(fh, cls))), public({*properties, *methods}), cls)
            for name in properties:
                self.assertIsInstance(getattr(getattr(fh, cls), name), property, f"{cls}.{name}")

    def test_its_arguments_are_those_of_the_compiled_functions(self):
        for name, node, function in self.pairs():
            self.assertEqual(stub.parameters(node), stub.compiled(function)[0], name)

    def test_its_docstrings_are_those_of_the_compiled_functions(self):
        for name, node, function in self.pairs():
            self.assertEqual(ast.get_docstring(node) or "", stub.compiled(function)[1], name)
        for cls, node in stub.classes.items():
            self.assertEqual(ast.get_docstring(node), getattr(fh, cls).__doc__.strip(), cls)
            for name, member in stub.members(cls)[0].items():
                self.assertEqual(ast.get_docstring(member), getattr(getattr(fh, cls), name).__doc__.strip(), f"{cls}.{name}")
        self.assertEqual(ast.get_docstring(stub.tree).split("\n")[0], fh.__doc__)

    def test_docstrings_explain_every_argument_and_every_member_of_a_result(self):
        explained = 0
        for name, node, _ in self.pairs():
            owner = stub.classes[name.split(".")[0]] if name.endswith(".__init__") else node
            text = ast.get_docstring(owner)
            arguments = [one for one, _, _ in stub.parameters(node) if one != "self"]
            self.assertEqual(stub.headings(text, "Parameters"), arguments, name)
            explained += len(arguments)
            returned = getattr(node.returns, "id", None)
            if returned in stub.results:
                self.assertCountEqual(stub.headings(text, "Returns"), stub.results[returned], name)
        self.assertGreater(explained, 50)

    def test_type_checkers_are_told_to_use_it(self):
        self.assertTrue((stub.folder / "py.typed").exists())


if __name__ == "__main__":
    unittest.main()
