"""What `./lagroid release` runs: pieces in their order, each of less than an hour, or one that goes on where it was cut."""
import dataclasses
import os
import pathlib
import shutil
import socket
import subprocess
import urllib.parse

root = pathlib.Path(__file__).resolve().parents[2]


@dataclasses.dataclass(frozen=True)
class Piece:
    name: str
    what: str
    commands: tuple  # of shell, one after another in the root of the project; the first that fails ends the piece
    lacks: object = lambda: ""  # why it cannot run here, or nothing
    goes_on: bool = False  # a build: what an hour left of it is the next run's
    compiler: str = "g++"
    after: str = ""  # the piece that builds what it runs
    writes: bool = False  # pages, which must come out as they are; else what was written is put aside


def network(address):
    """Why the server of an address is not reached."""
    server = urllib.parse.urlsplit(address)
    try:
        socket.create_connection((server.hostname, server.port or {"http": 80}.get(server.scheme, 443)), 10).close()
    except OSError as error:
        return f"no network: {server.hostname}: {error.strerror or error}"
    return ""


def clean_root():
    if os.geteuid() != 0:
        return "no rights of root, for debootstrap and chroot"
    if not shutil.which("debootstrap"):
        return "no debootstrap"
    return network(os.environ.get("LAGROID_MIRROR", "http://deb.debian.org/debian"))


def docker():
    if not shutil.which("docker"):
        return "no docker"
    if subprocess.run(["docker", "info"], capture_output=True).returncode != 0:
        return "no Docker daemon that answers"
    return network("http://deb.debian.org/debian")


# What nightly tests are pieces of their own, by their names; the others are the piece "nightly".
nightly = {
    "nightly-links": ("links of the documentation to other places", r"^Documentation\.LinksAreAnswered$",
                      lambda: network("https://doi.org")),
    "nightly-headers": ("examples of headers compile", r"^Documentation\.ExamplesOfHeadersCompile$", None),
    "nightly-python": ("the wheel in an environment of its own", r"^Python\.install$", None),
    "nightly-web": ("the laboratory of the browser: build, page, ends as the program's, lessons",
                    r"^Web\.|^Documentation\..*Laborator",
                    lambda: "" if shutil.which("emcc") else "no emscripten (`./lagroid web` installs it)"),
    "consumers": ("projects that use an installation, by find_package and pkg-config", r"^(installed|own_program)_whole$",
                  None),
    "packages": ("packages on a clean Debian, by debootstrap", r"^clean_root$", clean_root),
}


def nightly_piece(name, what, chosen, lacks=None):
    return Piece(name, what, ("cmake --preset nightly", "cmake --build --preset nightly", f"ctest --preset nightly {chosen}"),
                 lacks or (lambda: ""))


def shares(preset, what, count):
    """A build, and its tests dealt out to as many pieces."""
    compiler = "g++" if preset == "debug" else "clang++-14"
    yield Piece(f"{preset}-build", f"{what}: build", (f"cmake --preset {preset}{settings.get(preset, '')}",
                                                    f"cmake --build --preset {preset}"),
                goes_on=True, compiler=compiler)
    for share in range(1, count + 1):
        yield Piece(f"{preset}-{share}", f"{what}: tests, share {share} of {count}",
                    (f"ctest --preset {preset} -I {share},,{count}",), compiler=compiler, after=f"{preset}-build")


settings = {"sanitizers": " -DLAGROID_TEST_LAWS=ON"}
found = "build/release_fuzz"
# Pages that are the same whenever they are made; the others tell times.
pages = ("architecture", "scenes", "stubs", "examples")

pieces = (
    Piece("build", "the program and its tests: build", ("cmake --preset release", "cmake --build --preset release"),
          goes_on=True),
    Piece("ci", "the command of CI", (".ci/run",)),
    Piece("hard", "the hard cases", ("ninja -C build/release hard", "build/release/tests/hard/hard")),
    Piece("nightly-build", "nightly tests: build", ("cmake --preset nightly", "cmake --build --preset nightly"), goes_on=True),
    *(nightly_piece(name, what, f"-R '{names}'", lacks) for name, (what, names, lacks) in nightly.items()),
    *(nightly_piece(f"nightly-{share}", f"other nightly tests, share {share} of 4",
                    f"-E '{'|'.join(names for _, names, _ in nightly.values())}' -I {share},,4") for share in range(1, 5)),
    *shares("sanitizers", "AddressSanitizer and UndefinedBehaviorSanitizer, with the laws", 3),
    *shares("sanitizers-core", "the same without compiled solvers", 1),
    Piece("fuzz", "random scenes, for an hour",
          (f"mkdir -p {found}", "build/sanitizers-core/tests/fuzz_scenes -max_total_time=3500 -timeout=10 -rss_limit_mb=4096 "
           f"-max_len=4096 -dict=tests/data/scene.dict -artifact_prefix={found}/ {found} examples"),
          lambda: "" if (root / "build/sanitizers-core/tests/fuzz_scenes").exists() else "sanitizers-core is not built",
          compiler="clang++-14"),
    *shares("debug", "debug, with composability checks", 2),
    *shares("clang", "clang 14", 2),
    Piece("bench", "kernels by hand agree with the framework", ("./lagroid bench check",)),
    Piece("peers", "other software agrees with the framework", ("./lagroid peers check",)),
    Piece("docs", "the documentation site, without a warning", ("./lagroid docs",)),
    *(Piece(f"pages-{page}", f"docs: `./lagroid pages {page}` changes nothing", (f"./lagroid pages {page}",),
            writes=True)
      for page in pages),
    Piece("docker", "the image of docs/docker", ("docker build -f docs/docker/Dockerfile -t lagroid-release .",
                                                "docker run --rm lagroid-release --version"), docker),
)
