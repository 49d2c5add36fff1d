"""The package installed by pip, and the template project built against an installed lagroid."""

import os
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

from data import EXAMPLES, ROOT

BUILD = os.environ["LAGROID_BUILD"]


def run(*command: "str | Path", path: "Path | None" = None) -> str:
    """What it prints; its mistakes are raised. `path` is the only place beside Python's own that it imports from."""
    environment = {**os.environ, "PYTHONPATH": str(path or "")}
    found = subprocess.run(
        [str(word) for word in command], capture_output=True, text=True, env=environment, cwd="/", check=False
    )
    if found.returncode != 0:
        raise AssertionError(found.stdout + found.stderr)
    return found.stdout


class Install(unittest.TestCase):
    def test_pip(self) -> None:
        with tempfile.TemporaryDirectory() as folder:
            run(sys.executable, "-m", "pip", "install", "--no-build-isolation", "--no-deps", "--target", folder, ROOT)
            out = run(
                sys.executable,
                "-c",
                f"import lagroid; print(lagroid.__file__, lagroid.run('{EXAMPLES}/kepler.toml').status)",
                path=Path(folder),
            )
            self.assertIn(folder, out)
            self.assertIn("converged", out)
            self.assertIn("lagroid", run(sys.executable, "-m", "pip", "list", "--path", folder))

    def test_template(self) -> None:
        with tempfile.TemporaryDirectory() as folder:
            installed, build = Path(folder) / "installed", Path(folder) / "build"
            for component in ("development", "python"):
                run("cmake", "--install", BUILD, "--prefix", installed, "--component", component)
            run("cmake", "-S", ROOT / "python" / "template", "-B", build, f"-DCMAKE_PREFIX_PATH={installed}",
                f"-DPython_EXECUTABLE={sys.executable}", "-DCMAKE_BUILD_TYPE=Release")  # fmt: skip
            run("cmake", "--build", build)
            packages = next(installed.glob("**/lagroid/__init__.py")).parents[1]
            out = run(
                sys.executable,
                "-c",
                f"import sys; sys.path.append('{build}'); import my_system;"
                "print(my_system.Bead(h=0.05).integrator(momentum=[1.0], object=[0.0]).integrate(100).status)",
                path=packages,
            )
            self.assertEqual(out.strip(), "converged")


if __name__ == "__main__":
    unittest.main()
