"""Runs programs for the experiments; `beckon-intention`: makes scenarios, lives them, a few processes at a time."""

import json
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor, as_completed
from dataclasses import dataclass
from pathlib import Path


class LabError(Exception):
    """Something that a person can put right; the text says what."""


@dataclass(frozen=True)
class Run:
    """One `beckon-intention evaluate`."""

    scenario: Path
    policy: str = "adaptive"
    queries: str = "all"
    flip: float = 0.0
    seed: int = 1
    more: tuple = ()  # further arguments

    def arguments(self):
        return ["evaluate", "--scenario", str(self.scenario), "--policy", self.policy, "--queries", self.queries,
                "--flip", str(self.flip), "--seed", str(self.seed), *self.more]


class Program:
    """A program that is measured."""

    def __init__(self, binary, folder, quick):
        self.binary = Path(binary)
        self.folder = Path(folder)  # for scratch files
        self.quick = quick  # everything smaller: to see that it works
        if not self.binary.is_file():
            raise LabError(f"there is no {self.binary}; build it with 'make build', or name it with --{self.OPTION}")

    def call(self, arguments):
        done = subprocess.run([self.binary, *arguments], capture_output=True, text=True)
        if done.returncode != 0:
            said = (done.stderr.strip() or done.stdout.strip()).splitlines()
            raise LabError(f"{self.binary.name} {' '.join(arguments)}: {said[-1] if said else done.returncode}")
        return done.stdout


def progress(what, done, total, unit="evaluations"):
    if sys.stdout.isatty():
        print(f"\r{what}: {done}/{total}", end="\n" if done == total else "", flush=True)
    elif done == total:
        print(f"{what}: {total} {unit}", flush=True)


class Lab(Program):
    OPTION = "binary"

    def __init__(self, binary, folder, processes, quick):
        super().__init__(binary, folder, quick)
        self.processes = processes
        self._outcomes = {}
        self._help = {}

    def offers(self, command, option=""):
        """Whether the binary has a subcommand, and an option of it."""
        if command not in self._help:
            done = subprocess.run([self.binary, command, "--help"], capture_output=True, text=True)
            self._help[command] = done.stdout if done.returncode == 0 and f" {command} " in done.stdout else None
        return self._help[command] is not None and option in self._help[command].replace(",", " ")

    def write(self, name, sessions):
        path = self.folder / f"{name}.jsonl"
        path.write_text("".join(json.dumps(session) + "\n" for session in sessions))
        return path

    def simulate(self, kind, users, sessions, seed, repeat=0.0):
        path = self.folder / f"{kind}-{users}x{sessions}-{seed}-{repeat}.jsonl"
        if not path.exists():
            self.call(["simulate", "--kind", kind, "--users", str(users), "--sessions", str(sessions),
                       "--seed", str(seed), "--repeat", str(repeat), "--out", str(path)])
        return path

    def live(self, what, runs, processes=None):
        """Outcomes of each run, one dict a session; runs that were lived before are not lived again."""
        new = [run for run in dict.fromkeys(runs) if run not in self._outcomes]
        with ThreadPoolExecutor(processes or self.processes) as pool:
            pending = {pool.submit(self._evaluate, run, self.folder / f"out-{len(self._outcomes)}-{i}.jsonl"): run
                       for i, run in enumerate(new)}
            try:
                for done, future in enumerate(as_completed(pending), 1):
                    self._outcomes[pending[future]] = future.result()
                    progress(what, done, len(new))
            except BaseException:
                pool.shutdown(cancel_futures=True)
                raise
        return [self._outcomes[run] for run in runs]

    def _evaluate(self, run, out):
        self.call(run.arguments() + ["--jsonl", str(out)])
        with open(out) as file:
            outcomes = [json.loads(line) for line in file]
        out.unlink()
        return outcomes
