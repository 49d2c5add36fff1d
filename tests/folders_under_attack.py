"""What docs/stability.md promises of files and folders, attacked: kills at random moments, full disks, closed
descriptors, two processes a folder.

    folders_under_attack.py PROGRAM EXAMPLES [--kills N] [--seed N]

Ends with code 1 where a promise is broken, and says which."""

import argparse
import json
import os
import random
import shutil
import signal
import struct
import subprocess
import sys
import tempfile
import time
from pathlib import Path

OBEYED = (0, 4, -signal.SIGINT, -signal.SIGTERM)  # the last two: it came before the command began, or between two guards


class Broken(Exception):
    """A promise is."""


class Command:
    """A command that writes a folder: what it writes whenever it is done, bit by bit the same."""

    def __init__(self, kind, words, same, again=None):
        self.kind, self.words, self.same, self.again = kind, words, same, again or words
        self.expected = {}
        self.seconds = 0.0

    def line(self, program, folder, words=None):
        return [program, *(words or self.words), "--out", str(folder)]


def hdf5_is_whole(data):
    """Whether the file ends where its superblock says."""
    if data[:8] != b"\x89HDF\r\n\x1a\n":
        return False
    end = struct.unpack_from("<Q", data, 40 if data[8] < 2 else 28)[0]
    return end == len(data)


def require_whole(folder):
    """Every file of ours that is there is whole."""
    for file in Path(folder).iterdir():
        if not file.is_file() or file.name == ".lock" or file.name.endswith(".partial"):
            continue
        data = file.read_bytes()
        if file.suffix == ".json" or file.name == ".lagroid":
            json.loads(data)
        elif file.suffix == ".h5" and not hdf5_is_whole(data):
            raise Broken(f"{file}: not whole")
        elif file.suffix == ".csv":
            rows = data.decode().splitlines()
            if not data.endswith(b"\n") or rows[0].count(",") != rows[-1].count(","):
                raise Broken(f"{file}: not whole")
        elif file.suffix == ".svg" and not data.rstrip().endswith(b"</svg>"):
            raise Broken(f"{file}: not whole")
        elif file.suffix == ".png" and not data.endswith(b"IEND\xaeB`\x82"):
            raise Broken(f"{file}: not whole")


def require_tidy(folder):
    """Nothing half-done is left."""
    left = [f.name for f in Path(folder).rglob("*") if ".partial" in f.name or f.name in (".lock", "parts")]
    if left:
        raise Broken(f"{folder}: {left} stayed")


def require_nobody(folder):
    """No process of ours is at work in the folder, a gnuplot least of all."""
    for _ in range(100):
        there = []
        for process in Path("/proc").glob("[0-9]*"):
            try:
                if str(Path(os.readlink(process / "cwd"))).startswith(str(folder)):
                    there.append(process.name)
            except OSError:
                pass
        if not there:
            return
        time.sleep(0.05)
    raise Broken(f"{folder}: processes {there} outlived the one that was killed")


class Attack:
    def __init__(self, program, examples, home, seed):
        self.program, self.examples, self.home = program, examples, Path(home)
        self.random = random.Random(seed)
        self.count = 0
        self.commands = self.make_commands()

    def folder(self):
        self.count += 1
        return self.home / f"folder {self.count}"

    def run(self, line, **options):
        return subprocess.run(line, capture_output=True, text=True, cwd=self.home, timeout=600, **options)

    def make_commands(self):
        kepler = os.path.join(self.examples, "kepler.toml")
        sweep = self.home / "sweep.toml"
        sweep.write_text(
            f'[scene]\nfile = "{kepler}"\ntime.steps = 3000\n[design]\nkind = "grid"\n[[vary]]\n'
            'key = "initial.momentum.1"\nfrom = 1.5\nto = 2.0\ncount = 40\n[run]\npart = 1\n'
        )
        optimum = self.home / "optimum.toml"
        optimum.write_text(
            'problem = "brockett"\ndata.A = {random = "symmetric", rows = 300}\n[parameters]\nweights = [1.0, 2.0, 3.0]\n'
            '[method]\nname = "gradient-descent"\n[stop]\niterations = 100000\nrelative_gradient = 1e-7\n'
        )
        for name, more in (("data.csv", []), ("held.csv", ["--seed", "5", "--duration", "1"])):
            line = [self.program, "trajectories", "--count", "200", *more, "--out", str(self.home / name)]
            subprocess.run(line, check=True, capture_output=True)
        run = ["run", kepler, "--set", "time.steps=30000", "--set", "output.every=10", "--set", "output.checkpoint=500"]
        learn = ["learn", str(self.home / "data.csv"), "--model", "network:4", "--iterations", "10",
                 "--test", str(self.home / "held.csv")]
        return [
            Command("run", run, ["trajectory.h5", "trajectory.csv"]),
            Command("sweep", ["sweep", str(sweep)], ["sweep.h5", "members.csv", "summary.json", "summary.txt"]),
            Command("optimize", ["optimize", str(optimum)], ["result.h5"]),
            Command("learn", learn, ["model.json", "errors.csv"]),
        ]

    def learn_what_is_right(self):
        for command in self.commands:
            folder = self.folder()
            begun = time.monotonic()
            done = self.run(command.line(self.program, folder))
            command.seconds = time.monotonic() - begun
            command.code = done.returncode
            if done.returncode not in (0, 3):
                raise Broken(f"{command.kind}: code {done.returncode}: {done.stderr}")
            require_whole(folder)
            require_tidy(folder)
            command.expected = {name: (folder / name).read_bytes() for name in command.same}
            command.names = sorted(f.name for f in folder.iterdir())

    def require_done(self, command, folder):
        require_whole(folder)
        require_tidy(folder)
        for name, data in command.expected.items():
            if (folder / name).read_bytes() != data:
                raise Broken(f"{folder}/{name}: other bits than those of an unbroken {command.kind}")

    def go_on(self, command, folder, words=None):
        """With what was broken off: as the page says."""
        line = command.line(self.program, folder, words)
        if command.kind == "run" and (folder / "checkpoint" / "state.cbor").exists():
            line = [self.program, "resume", str(folder)]
        done = self.run(line)
        if done.returncode != command.code:
            raise Broken(f"{' '.join(line)}: code {done.returncode}: {done.stderr}")
        self.require_done(command, folder)

    def break_off(self, line, seconds, how):
        with subprocess.Popen(line, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True, cwd=self.home) as job:
            try:
                said = job.communicate(timeout=seconds)[1]
            except subprocess.TimeoutExpired:
                job.send_signal(how)
                said = job.communicate()[1]
        return job.returncode, said

    def kills(self, count, how):
        """`count` in all; some of runs while they are taken up, some at the very end, where files are written."""
        for k in range(count):
            command = self.commands[k % len(self.commands)]
            folder = self.folder()
            at_the_end = self.random.random() < 0.5
            share = self.random.uniform(0.8, 1.1) if at_the_end else self.random.uniform(0, 1)
            for repeated in range(self.random.randrange(1, 4)):
                line = command.line(self.program, folder)
                if repeated and command.kind == "run" and (folder / "checkpoint" / "state.cbor").exists():
                    line = [self.program, "resume", str(folder)]
                code, said = self.break_off(line, share * command.seconds, how)
                if how == signal.SIGKILL:
                    if code not in (0, command.code, -signal.SIGKILL):
                        raise Broken(f"{' '.join(line)}: code {code}: {said}")
                elif code not in (*OBEYED, command.code):
                    raise Broken(f"{' '.join(line)}: code {code} after a signal: {said}")
                require_nobody(folder)
                if folder.exists():
                    require_whole(folder)
            if how != signal.SIGKILL and command.kind in ("optimize", "learn") and folder.exists():
                shutil.rmtree(folder)  # the best so far is a result of its own
            self.go_on(command, folder)
            shutil.rmtree(folder)

    def closed_descriptors(self):
        for command in self.commands:
            for closed in ((0,), (1,), (2,), (0, 1), (1, 2), (0, 1, 2)):
                folder = self.folder()
                line = command.line(self.program, folder)
                redirections = " ".join(f"{fd}<&-" if fd == 0 else f"{fd}>&-" for fd in closed)
                script = f'exec "$@" {redirections}'
                job = subprocess.run(["sh", "-c", script, "sh", *line], cwd=self.home, stdout=subprocess.DEVNULL,
                                     stderr=subprocess.DEVNULL, timeout=600)
                if job.returncode != (3 if 1 in closed else command.code):
                    raise Broken(f"{' '.join(line)} with {redirections}: code {job.returncode}")
                self.require_done(command, folder)
                names = sorted(f.name for f in folder.iterdir())
                if names != command.names:
                    raise Broken(f"{folder}: {names}, not {command.names}")
                shutil.rmtree(folder)

    def two_processes(self, rounds):
        """The same command twice, and two different ones: each works, or is refused and touches nothing."""
        for k in range(rounds):
            one = self.commands[k % len(self.commands)]
            other = self.random.choice(self.commands)
            folder = self.folder()
            jobs = []
            for command in (one, other):
                jobs.append(subprocess.Popen(command.line(self.program, folder), stdout=subprocess.DEVNULL,
                                             stderr=subprocess.PIPE, text=True, cwd=self.home))
                time.sleep(self.random.choice((0, 0, 0.01, 0.3)) * command.seconds)
            ended = [(job.communicate()[1], job.returncode) for job in jobs]
            worked = []
            for command, (said, code) in zip((one, other), ended):
                if code == command.code:
                    worked.append(command)
                elif code != 2 or said.count("lagroid: ") != 1:
                    raise Broken(f"two at a time, {command.kind}: code {code}: {said}")
            if not worked or len({command.kind for command in worked}) > 1:
                raise Broken(f"two at a time: {[c.kind for c in worked]} worked in one folder")
            self.require_done(worked[0], folder)
            shutil.rmtree(folder)

    def full_disks(self):
        """A small disk of memory, then a larger one. Why not, where that is not permitted."""
        disk = self.home / "disk"
        disk.mkdir()
        size = ["mount", "-t", "tmpfs", "-o", "size=4k", "tmpfs", str(disk)]
        if os.geteuid() != 0 or subprocess.run(size, capture_output=True).returncode != 0:
            return "full disks: skipped, a disk of memory (tmpfs) cannot be mounted here"
        try:
            for kilobytes in (4, 8, 12, 16, 24, 40, 64, 100, 160, 240, 400, 640):
                for command in self.commands:
                    subprocess.run(["mount", "-o", f"remount,size={kilobytes}k", str(disk)], check=True)
                    folder = disk / "folder"
                    done = self.run(command.line(self.program, folder))
                    if done.returncode not in (0, 3):
                        raise Broken(f"{command.kind} on {kilobytes} kB: code {done.returncode}: {done.stderr}")
                    if done.returncode == 3 and done.stderr.count("lagroid: ") < 1:
                        raise Broken(f"{command.kind} on {kilobytes} kB says nothing")
                    if folder.exists():
                        require_whole(folder)
                    subprocess.run(["mount", "-o", "remount,size=100m", str(disk)], check=True)
                    self.go_on(command, folder)
                    shutil.rmtree(folder)
                subprocess.run(["mount", "-o", f"remount,size={kilobytes}k", str(disk)], check=True)
                done = self.run([self.program, "trajectories", "--count", "5000", "--out", str(disk / "data.csv")])
                if done.returncode != 3 or (disk / "data.csv").exists():
                    raise Broken(f"trajectories on {kilobytes} kB: code {done.returncode}: {done.stderr}")
        finally:
            subprocess.run(["umount", str(disk)], check=False)
        return "full disks: twelve sizes"


def main():
    options = argparse.ArgumentParser()
    options.add_argument("program")
    options.add_argument("examples")
    options.add_argument("--kills", type=int, default=50)
    options.add_argument("--seed", type=int, default=20261123)
    given = options.parse_args()
    with tempfile.TemporaryDirectory(prefix="lagroid_attack_") as home:
        attack = Attack(os.path.abspath(given.program), os.path.abspath(given.examples), home, given.seed)
        try:
            attack.learn_what_is_right()
            for command in attack.commands:
                print(f"{command.kind}: {command.seconds:.2f} s unbroken, code {command.code}", flush=True)
            attack.kills(given.kills, signal.SIGKILL)
            print(f"{given.kills} kills", flush=True)
            attack.kills(given.kills // 2, signal.SIGINT)
            attack.kills(given.kills // 2, signal.SIGTERM)
            print(f"{given.kills // 2 * 2} interrupts", flush=True)
            attack.closed_descriptors()
            print("closed descriptors", flush=True)
            attack.two_processes(given.kills // 2)
            print("two processes a folder", flush=True)
            print(attack.full_disks(), flush=True)
        except Broken as promise:
            print(f"BROKEN: {promise}")
            return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
