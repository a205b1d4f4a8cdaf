"""The words of the package are true: doctests of docstrings and documents, stubs, types."""

import ast
import doctest
import importlib
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest
import warnings

import numpy as np

import waymark
import waymark._waymark
from support import DRIVE, ROOT

PACKAGE = ROOT / "tools/python"


def names() -> dict[str, object]:
    """What the examples take for granted; the README says so."""
    return {"waymark": waymark, "np": np, "drive": str(DRIVE)}


class Doctests(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        patch = warnings.catch_warnings()
        patch.__enter__()
        self.addCleanup(patch.__exit__, None, None, None)
        warnings.simplefilter("ignore")

    def test_docstrings(self):
        for name in ("waymark", "waymark.fusion", "waymark.graph", "waymark.results", "waymark.errors"):
            with self.subTest(name):
                failed, tried = doctest.testmod(importlib.import_module(name), extraglobs=names())
                self.assertEqual(failed, 0)

    def test_readme(self):
        text = (PACKAGE / "README.md").read_text()
        examples = "\n".join(re.findall(r"```python\n(.*?)```", text, re.DOTALL))
        self.assertGreater(examples.count(">>>"), 20)
        examples = examples.replace('"results"', repr(self.folder.name + "/results"))
        examples = examples.replace('"own.graph"', repr(self.folder.name + "/own.graph"))
        test = doctest.DocTestParser().get_doctest(examples, names(), "README.md", str(PACKAGE / "README.md"), 0)
        runner = doctest.DocTestRunner(optionflags=doctest.ELLIPSIS)
        runner.run(test)
        self.assertEqual(runner.summarize().failed, 0)

    def test_every_public_name_has_a_docstring(self):
        for name in waymark.__all__:
            value = getattr(waymark, name)
            if not isinstance(value, str):
                self.assertTrue(value.__doc__, name)


class Types(unittest.TestCase):
    def test_the_stub_has_the_names_of_the_compiled_module(self):
        tree = ast.parse((PACKAGE / "waymark/_waymark.pyi").read_text())
        stub = {node.name: node for node in tree.body if isinstance(node, (ast.ClassDef, ast.FunctionDef))}
        module = {name for name in vars(waymark._waymark) if not name.startswith("_")} - {"version"}
        self.assertEqual(set(stub), module)
        for name, node in stub.items():
            if isinstance(node, ast.ClassDef):
                told = {member.name for member in node.body if isinstance(member, ast.FunctionDef)}
                real = {member for member in vars(getattr(waymark._waymark, name)) if not member.startswith("_")}
                self.assertEqual(told - {"__init__"}, real, name)

    def test_the_package_says_that_it_is_typed(self):
        self.assertTrue((pathlib.Path(waymark.__file__).parent / "py.typed").exists())

    def test_mypy_finds_nothing(self):
        if shutil.which("mypy") is None:
            self.skipTest("mypy is not installed")
        with tempfile.TemporaryDirectory() as cache:
            done = subprocess.run(["mypy", "--strict", "--ignore-missing-imports", "--cache-dir", cache, "waymark"], cwd=PACKAGE,
                                  capture_output=True, text=True, check=False)
        self.assertEqual(done.returncode, 0, done.stdout)


class Imports(unittest.TestCase):
    def test_pandas_and_matplotlib_are_not_imported(self):
        code = "import sys, waymark; assert not {'pandas', 'matplotlib'} & set(sys.modules)"
        subprocess.run([sys.executable, "-c", code], check=True)


if __name__ == "__main__":
    unittest.main()
