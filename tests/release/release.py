#!/usr/bin/env python3
"""Everything there is to run of a version: `./lagroid release [--list] [--again PIECE] [PIECE...]`.

How each piece went when it last ran, and on which commit, is kept in docs/verified.json after each piece: work that was cut goes
on with the next one, on another machine too once that file is committed. What a piece prints is in build/release_logs. It ends by
writing docs/verified.md.
"""
import argparse
import datetime
import json
import os
import pathlib
import platform
import signal
import subprocess
import sys
import time

import pieces as declared

hour = 3600  # seconds that a piece may take
page_of_it = "docs/verified.md"
journal_of_it = "docs/verified.json"
but_for_these = ("--", ".", f":!{page_of_it}", f":!{journal_of_it}")


class Release:
    def __init__(self, root=declared.root, pieces=declared.pieces, limit=hour):
        self.root, self.pieces, self.limit = root, {piece.name: piece for piece in pieces}, limit
        self.path = root / journal_of_it
        self.commit = self.commit_here()
        self.journal = json.loads(self.path.read_text()) if self.path.exists() else {}

    def git(self, *words):
        return subprocess.run(["git", *words], cwd=self.root, check=True, capture_output=True, text=True).stdout.strip()

    def commit_here(self):
        """The last commit that changed more than what is written here."""
        return self.git("log", "-1", "--format=%H", *but_for_these)

    def changes(self):
        """What is not as committed, but for that."""
        return self.git("status", "--porcelain", *but_for_these)

    def done(self):
        """What is known of this commit: piece to entry."""
        return {name: entry for name, entry in self.journal.items() if entry["commit"] == self.commit}

    def record(self, name, **entry):
        """Writes the journal whole or not at all."""
        self.journal[name] = {**entry, "commit": self.commit}
        partial = self.path.with_suffix(".partial")
        partial.write_text(json.dumps(self.journal, indent=1, sort_keys=True) + "\n")
        os.replace(partial, self.path)

    def run(self, name):
        """Runs a piece and records how it went."""
        piece, start = self.pieces[name], time.monotonic()
        when = datetime.datetime.now(datetime.timezone.utc).strftime("%Y-%m-%d %H:%M UTC")
        said = piece.lacks() or self.waits(piece)
        result = "not run" if said else "passed"
        if not said:
            result, said = self.carry_out(piece, start + self.limit)
        # Whatever was seen is not true of the commit then.
        changed = self.changes()
        if changed or self.commit_here() != self.commit:
            result, said = "failed", "the sources changed meanwhile: " + " ".join(changed.split())
            if piece.writes and changed:
                self.git("stash", "push", "-u", "-m", f"lagroid release {name}", *but_for_these)
                said += "; git stash has what was written"
        self.record(name, result=result, reason=said, when=when, seconds=round(time.monotonic() - start, 1), **machine(piece.compiler))
        return result

    def waits(self, piece):
        """Why what a piece runs is not there yet."""
        built = not piece.after or self.done().get(piece.after, {}).get("result") == "passed"
        return "" if built else f"{piece.after} has not passed"

    def carry_out(self, piece, until):
        folder = self.root / "build/release_logs"
        folder.mkdir(parents=True, exist_ok=True)
        with open(folder / f"{piece.name}.log", "w", encoding="utf-8") as log:
            for command in piece.commands:
                print(f"$ {command}", file=log, flush=True)
                child = subprocess.Popen(["bash", "-c", command], cwd=self.root, stdin=subprocess.DEVNULL, stdout=log,
                                         stderr=subprocess.STDOUT, start_new_session=True)
                try:
                    code = child.wait(max(0, until - time.monotonic()))
                except subprocess.TimeoutExpired:
                    stop(child)
                    return ("unfinished" if piece.goes_on else "failed"), f"`{command}` was cut after {self.limit} s"
                except BaseException:
                    stop(child)
                    raise
                if code != 0:
                    return "failed", f"`{command}` ended with {code}"
        return "passed", ""

    def missing(self):
        return [name for name in self.pieces if self.done().get(name, {}).get("result") != "passed"]

    def latest(self, name):
        """How a piece went when it last ran: on this commit, or on an earlier one that led to it."""
        entry = self.journal.get(name)
        return entry if entry and self.leads_here(entry["commit"]) else {"result": "not yet"}

    def leads_here(self, commit):
        return subprocess.run(["git", "merge-base", "--is-ancestor", commit, self.commit], cwd=self.root,
                              capture_output=True).returncode == 0

    def table(self):
        rows = []
        for name, piece in self.pieces.items():
            entry = self.done().get(name, {"result": "not yet"})
            rows.append((name, entry["result"], took(entry), entry.get("when", ""), entry.get("reason") or piece.what))
        return rows

    def write_page(self):
        """docs/verified.md: what ran, when, on what, with which result, and what did not run and why."""
        lines = ["<!-- Written by `./lagroid release`. -->", "# What was run", "",
                 f"By `./lagroid release`, up to commit {self.commit}. A row is a piece of the whole, as it went when it",
                 "last ran, and the commit it ran on; what its commands are says `tests/release/pieces.py`.", ""]
        rows = {name: self.latest(name) for name in self.pieces}
        lines += [f"- {each}" for each in sorted({entry["machine"] for entry in rows.values() if "machine" in entry})]
        lines += ["", "| piece | what | compiler | result | took | commit | when | why not |", "|---|---|---|---|---|---|---|---|"]
        for name, entry in rows.items():
            cells = (name, self.pieces[name].what, entry.get("compiler", ""), entry["result"], took(entry),
                     entry.get("commit", "")[:10], entry.get("when", ""), entry.get("reason", "").replace("|", "\\|"))
            lines.append("| " + " | ".join(cells) + " |")
        (self.root / page_of_it).write_text("\n".join(lines) + "\n")


def took(entry):
    return f"{entry['seconds']} s" if entry.get("seconds") and entry["result"] != "not run" else ""


def stop(child):
    """Ends what a piece started, with all that it started."""
    os.killpg(child.pid, signal.SIGTERM)
    try:
        child.wait(10)
    except subprocess.TimeoutExpired:
        os.killpg(child.pid, signal.SIGKILL)
        child.wait()


def machine(name):
    cpu = next((line.split(":")[1].strip() for line in pathlib.Path("/proc/cpuinfo").read_text().splitlines()
                if line.startswith("model name")), platform.machine())
    try:
        compiler = subprocess.run([name, "--version"], capture_output=True, text=True).stdout.split("\n")[0]
    except OSError:
        compiler = f"no {name}"
    return {"machine": f"{cpu}, {os.cpu_count()} processors, {platform.system()} {platform.release()}", "compiler": compiler}


def main(arguments, release=None):
    parser = argparse.ArgumentParser(prog="lagroid release", description="Runs everything there is to run, in pieces.")
    parser.add_argument("pieces", nargs="*", metavar="PIECE", help="these alone")
    parser.add_argument("--list", action="store_true", help="say what the pieces are and how they went, and run nothing")
    parser.add_argument("--again", action="append", default=[], metavar="PIECE", help="run it though it passed")
    asked = parser.parse_args(arguments)
    release = release or Release()
    unknown = [name for name in asked.pieces + asked.again if name not in release.pieces]
    if unknown:
        parser.error(f"no piece \"{unknown[0]}\": {', '.join(release.pieces)}")
    if asked.list:
        for row in release.table():
            print("{:22} {:10} {:>10}  {:20}  {}".format(*row))
        return 0
    changed = release.changes()
    if changed:
        print(f"lagroid: commit first; what is found is said of a commit, and these differ from it:\n{changed}", file=sys.stderr)
        return 2
    wanted = asked.pieces or asked.again or list(release.pieces)
    failed = []
    for name in release.pieces:
        if name in asked.again or (name in wanted and name in release.missing()):
            print(f"lagroid: {name} ...", file=sys.stderr, flush=True)
            result = release.run(name)
            print(f"lagroid: {name}: {result} {release.done()[name]['reason']}", file=sys.stderr, flush=True)
            release.write_page()
            if release.changes():
                print("lagroid: the sources have changed; commit or restore them", file=sys.stderr)
                return 1
        if release.done().get(name, {}).get("result") in ("failed", "unfinished") and (name in wanted or name in asked.again):
            failed.append(name)
    release.write_page()
    if failed:
        print(f"lagroid: not passed: {', '.join(failed)} (build/release_logs)", file=sys.stderr)
    return bool(failed)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
