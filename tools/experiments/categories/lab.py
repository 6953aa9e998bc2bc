"""Runs `beckon-capture` and `beckon-train` for the experiments: renders sets of views, judges them, learns."""

import csv
import json
import re
import zlib
from concurrent.futures import ThreadPoolExecutor, as_completed
from dataclasses import dataclass
from pathlib import Path

from categories.figures import judged_from
from lab import LabError, Program, progress
from pose.lab import machine


@dataclass(frozen=True, eq=False)
class Views:
    """A folder of views as `beckon-train` takes it, and its manifest by file."""

    title: str
    folder: Path
    rows: dict  # file: a line of manifest.csv


def read_views(title, folder):
    with open(folder / "manifest.csv", newline="") as file:
        return Views(title, folder, {row["file"]: row for row in csv.DictReader(file)})


@dataclass(frozen=True)
class Test:
    """One `beckon-train --test`."""

    views: Views
    cues: str = "all"
    model: Path = None  # None: the one that is judged


class Capture(Program):
    OPTION = "capture-binary"

    def objects(self, title, seed, per_category, views, sensor, meshes=None):
        """Rendered anew; the same seed gives the same views."""
        out = self.folder / re.sub(r"\W+", "-", title)
        more = ["--meshes", str(meshes)] if meshes else []
        self.call(["--render-objects", "--seed", str(seed), "--per-category", str(per_category), "--views", str(views),
                   "--sensor", sensor, "--out", str(out), *more])
        return read_views(title, out)

    def frames(self, seed, count):
        """PCD files, with what is known of them beside."""
        out = self.folder / f"frames-{seed}"
        self.call(["--render", "--seed", str(seed), "--frames", str(count), "--out", str(out)])
        return sorted(out.glob("*.pcd"))


class CategoriesLab(Program):
    OPTION = "train-binary"

    def __init__(self, binary, model, folder, processes, quick):
        super().__init__(binary, folder, quick)
        self.processes = processes  # for what is not timed
        self.model = Path(model)
        self._judged = {}
        if not self.model.is_file():
            raise LabError(f"there is no {self.model}; train one with beckon-train, or name another with --model")

    def said_of_model(self):
        content = self.model.read_bytes()
        return f"{self.model.name} ({len(content) / 1e6:.2f} MB, CRC-32 {zlib.crc32(content):08x}), on {machine()}"

    def cues(self, views):
        """Names of the model's cues."""
        said = self.call(["--test", str(views.folder), "--model", str(self.model)])
        told = re.search(r"longest [\d.]+ ms \((.*) on average\)", said)
        if not told:
            raise LabError(f"{self.binary.name} --test: expected the time of each cue, found none; is it of an older "
                           "version?")
        return [part.rsplit(" ", 1)[0] for part in told[1].split(", ")]

    def judge(self, what, tests):
        """What the model says, of each test; what was judged before is not judged again."""
        new = [test for test in dict.fromkeys(tests) if test not in self._judged]
        with ThreadPoolExecutor(self.processes) as pool:
            pending = {pool.submit(self._test, test, len(self._judged) + i): test for i, test in enumerate(new)}
            try:
                for done, future in enumerate(as_completed(pending), 1):
                    self._judged[pending[future]] = future.result()
                    progress(what, done, len(new), "tests")
            except BaseException:
                pool.shutdown(cancel_futures=True)
                raise
        return [self._judged[test] for test in tests]

    def milliseconds(self, test):
        """Of each view; nothing else of ours runs meanwhile."""
        return self._test(test, "timed").ms

    def _test(self, test, number):
        out = self.folder / f"judged-{number}.jsonl"
        self.call(["--test", str(test.views.folder), "--model", str(test.model or self.model), "--cues", test.cues,
                   "--jsonl", str(out)])
        judged = judged_from([json.loads(line) for line in out.read_text().splitlines()], test.views.rows)
        out.unlink()
        return judged

    def improve(self, name, views, files):
        """The model and what these views add to it."""
        folder, out = self.folder / f"own-{name}", self.folder / f"own-{name}.model"
        select(views, files, folder)
        self.call(["--data", str(folder), "--base", str(self.model), "--model", str(out)])
        return out


def select(views, files, folder):
    """A folder with only these of the views, linked."""
    for file in files:
        (folder / file).parent.mkdir(parents=True, exist_ok=True)
        stem = (views.folder / file).resolve().with_suffix("")
        for ending in (".pcd", "_rgb.png", "_depth.png", "_mask.png"):
            if Path(f"{stem}{ending}").is_file():
                (folder / file).with_name(f"{stem.name}{ending}").symlink_to(f"{stem}{ending}")
    with open(folder / "manifest.csv", "w", newline="") as manifest:
        writer = csv.DictWriter(manifest, list(views.rows[files[0]]), lineterminator="\n")
        writer.writeheader()
        writer.writerows(views.rows[file] for file in files)

