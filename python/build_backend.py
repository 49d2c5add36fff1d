"""Builds the wheel of the package lagroid by CMake: what `pip install .` calls (PEP 517). Needs the Debian packages that
the script `lagroid` lists, and python3-wheel.

LAGROID_BUILD names a build tree to take the module from, for which CMake has been run; else build/python is made, which
compiles the library."""

from __future__ import annotations

import os
import subprocess
import sys
import sysconfig
import tempfile
import tomllib
from pathlib import Path
from typing import Any, Optional

from wheel.wheelfile import WheelFile

ROOT = Path(__file__).resolve().parents[1]
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
NAME = f"{PROJECT['name']}-{PROJECT['version']}"
PYTHON = f"cp{sys.version_info.major}{sys.version_info.minor}"
PLATFORM = sysconfig.get_platform().replace("-", "_").replace(".", "_")
TAG = f"{PYTHON}-{PYTHON}-{PLATFORM}"


def _run(*command: str | Path) -> None:
    # pip reads standard output.
    subprocess.run([str(word) for word in command], check=True, stdout=sys.stderr)


def _built() -> Path:
    given = os.environ.get("LAGROID_BUILD")
    build = Path(given) if given else ROOT / "build" / "python"
    if not given:
        _run("cmake", "-S", ROOT, "-B", build, "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release", "-DLAGROID_TESTS=OFF",
             f"-DPython_EXECUTABLE={sys.executable}")  # fmt: skip
    _run("cmake", "--build", build, "--target", "lagroid_python")
    return build


def _metadata() -> str:
    lines = [
        "Metadata-Version: 2.1",
        f"Name: {PROJECT['name']}",
        f"Version: {PROJECT['version']}",
        f"Summary: {PROJECT['description']}",
        f"Requires-Python: {PROJECT['requires-python']}",
        *(f"Requires-Dist: {each}" for each in PROJECT["dependencies"]),
    ]
    for extra, packages in PROJECT["optional-dependencies"].items():
        lines.append(f"Provides-Extra: {extra}")
        lines += [f'Requires-Dist: {each}; extra == "{extra}"' for each in packages]
    return "\n".join(lines) + "\n"


def build_wheel(
    wheel_directory: str, config_settings: Optional[Any] = None, metadata_directory: Optional[str] = None
) -> str:
    build = _built()
    name = f"{NAME}-{TAG}.whl"
    with tempfile.TemporaryDirectory() as prefix:
        _run("cmake", "--install", build, "--component", "python", "--prefix", prefix)
        (package,) = Path(prefix).glob("**/lagroid")
        module = package / f"_lagroid{sysconfig.get_config_var('EXT_SUFFIX')}"
        if not module.exists():
            raise SystemExit(f"{build}: holds no module for {sys.executable}; configure it with its Python_EXECUTABLE")
        with WheelFile(Path(wheel_directory) / name, "w") as wheel:
            for file in sorted(package.iterdir()):
                wheel.write(file, f"lagroid/{file.name}")
            wheel.writestr(f"{NAME}.dist-info/METADATA", _metadata())
            wheel.writestr(
                f"{NAME}.dist-info/WHEEL",
                f"Wheel-Version: 1.0\nGenerator: lagroid\nRoot-Is-Purelib: false\nTag: {TAG}\n",
            )
    return name


def build_sdist(sdist_directory: str, config_settings: Optional[Any] = None) -> str:
    archive = f"{NAME}.tar.gz"
    _run("git", "-C", ROOT, "archive", f"--prefix={NAME}/", "-o", Path(sdist_directory).resolve() / archive, "HEAD")
    return archive
