"""Every cell of the notebooks runs, with Debian's nbconvert, and says what its text promises."""

import importlib.util
import os
import pathlib
import re
import unittest

from support import ROOT

NEEDED = ("nbconvert", "nbclient", "ipykernel", "matplotlib")
FOLDER = ROOT / "examples/python"


def printed(notebook) -> str:
    outputs = [output for cell in notebook.cells for output in cell.get("outputs", [])]
    return "".join(output.get("text", "") for output in outputs if output.output_type == "stream")


@unittest.skipUnless(all(importlib.util.find_spec(name) for name in NEEDED), "SKIPPED: needs " + ", ".join(NEEDED))
class Notebooks(unittest.TestCase):
    def run_notebook(self, name: str):
        import nbformat
        from nbconvert.preprocessors import ExecutePreprocessor

        notebook = nbformat.read(FOLDER / name, as_version=4)
        nbformat.validate(notebook)
        for cell in notebook.cells:
            self.assertFalse(cell.get("outputs"), "notebooks are stored without outputs")
        ExecutePreprocessor(timeout=300, kernel_name="python3").preprocess(
            notebook, {"metadata": {"path": str(FOLDER)}})
        return notebook

    def test_every_notebook_is_tested(self):
        tested = {"fuse_a_csv.ipynb", "compare_modelings.ipynb", "own_sensor.ipynb"}
        self.assertEqual({path.name for path in FOLDER.glob("*.ipynb")}, tested)

    def test_fuse_a_csv(self):
        notebook = self.run_notebook("fuse_a_csv.ipynb")
        code = [line for line in notebook.cells[1].source.splitlines() if line.strip()]
        self.assertLessEqual(len(code), 12)  # ten, and the two that import
        self.assertIn("8752 poses", printed(notebook))

    def test_compare_modelings(self):
        text = printed(self.run_notebook("compare_modelings.ipynb"))
        told = {name: (float(rmse), float(nees))
                for name, rmse, nees in re.findall(r"(\w+) +rmse +([\d.]+) m +NEES +([\d.]+)", text)}
        raw = float(re.search(r"raw fixes +rmse +([\d.]+)", text).group(1))
        for name in ("g1", "g2", "g3", "correlated"):
            self.assertLess(told[name][0], raw)
        for name in ("g1", "g2", "g3"):
            self.assertGreater(told[name][1], 5 * told["correlated"][1])

    def test_own_sensor(self):
        text = printed(self.run_notebook("own_sensor.ipynb"))
        before, after = map(float, re.search(r": ([\d.]+) m without beacons, ([\d.]+) m with", text).groups())
        self.assertLess(after, 0.7 * before)
        for off, sigma in re.findall(r"off by ([\d.]+) m, sigma ([\d.]+) m", text):
            self.assertLess(float(off), 4 * float(sigma) + 1)


if __name__ == "__main__":
    unittest.main()
