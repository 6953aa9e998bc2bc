"""Clouds with a known truth: made by the generator, thinned and thickened here, judged by the scorer."""

import contextlib
import importlib
import io
import json
import os
import signal
import subprocess
import sys
import tempfile
import warnings
from concurrent.futures import ProcessPoolExecutor, ThreadPoolExecutor, as_completed
from dataclasses import dataclass
from pathlib import Path

import numpy

from lab import LabError, progress

GENERATOR, SCORER = "superquadric_clouds", "eval_superquadrics"
JUDGED = ("position_mm", "size_percent", "orientation_deg", "radial_mm", "iou")


class Tools:
    """The generator and the scorer, as programs and as modules."""

    def __init__(self, folder):
        self.folder = Path(folder)
        sys.path.insert(0, str(self.folder))
        self.gauge = importlib.import_module(GENERATOR).gauge
        scorer = importlib.import_module(SCORER)
        self.matrix, self.rotations = scorer.matrix, scorer.ROTATIONS

    @staticmethod
    def are_in(folder):
        return all((Path(folder) / f"{name}.py").is_file() for name in (GENERATOR, SCORER))


@dataclass(frozen=True)
class CloudSet:
    """Clouds of one set and seed, as the generator writes them."""

    kind: str  # clear or hard
    seed: int
    folder: Path

    @property
    def clouds(self):
        return self.folder / "list.jsonl"

    def truth(self):
        return json.loads((self.folder / "truth.json").read_text())

    def lines(self):
        return [json.loads(line) for line in self.clouds.read_text().splitlines()]

    def points(self, name):
        return numpy.loadtxt(self.folder / name)


@dataclass(frozen=True)
class MadeClouds:
    tools: Tools
    sets: list


def make_sets(lab, tools, seeds, count):
    """Clear and hard sets of each seed."""
    sets = [CloudSet(kind, seed, lab.folder / f"{kind}-{seed}") for kind in ("clear", "hard") for seed in seeds]
    program = tools.folder / f"{GENERATOR}.py"

    def make(made):
        done = subprocess.run([sys.executable, "-B", program, made.folder, "--set", made.kind, "--seed",
                               str(made.seed), "--count", str(count)], capture_output=True, text=True)
        if done.returncode != 0:
            raise LabError(f"{program}: {(done.stderr.strip() or 'failed').splitlines()[-1]}")

    with ThreadPoolExecutor(lab.processes) as pool:
        try:
            for done, future in enumerate(as_completed([pool.submit(make, made) for made in sets]), 1):
                future.result()
                progress("clouds", done, len(sets), "sets")
        except BaseException:
            pool.shutdown(cancel_futures=True)
            raise
    return MadeClouds(tools, sets)


def write_list(folder, made, lines, change):
    """The clouds of `lines`, changed: a list of them that keeps names and planes."""
    folder.mkdir(parents=True, exist_ok=True)
    for line in lines:
        numpy.savetxt(folder / line["file"], change(made.points(line["file"])), fmt="%.6f")
    path = folder / "list.jsonl"
    path.write_text("".join(json.dumps(line) + "\n" for line in lines))
    return path


def voxel_centroids(points, voxel_m):
    _, cell = numpy.unique(numpy.floor(points / voxel_m).astype(int), axis=0, return_inverse=True)
    sums = numpy.stack([numpy.bincount(cell, points[:, k]) for k in range(3)], 1)
    return sums / numpy.bincount(cell)[:, None]


def of_size(points, count, rng):
    """As many of the points, or as many points: further ones lie between two neighbours."""
    if count <= len(points):
        return points[rng.choice(len(points), count, replace=False)]
    from scipy.spatial import cKDTree

    _, neighbours = cKDTree(points).query(points, k=7)
    first = rng.integers(0, len(points), count - len(points))
    second = neighbours[first, rng.integers(1, 7, len(first))]
    share = rng.random((len(first), 1))
    return numpy.vstack([points, points[first] * share + points[second] * (1 - share)])


def judge(lab, what, fitted):
    """`fitted`: (name, CloudSet, its poses). Scores by name, a dict a cloud, in order."""
    truths = {made: made.truth() for _, made, _ in fitted}
    jobs = [(name, made, pose, truths[made][Path(pose["file"]).name]) for name, made, poses in fitted for pose in poses]
    judged = [None] * len(jobs)
    with ProcessPoolExecutor(lab.processes, initializer=_leave_interrupts_to_parent) as pool:
        pending = {pool.submit(_judge_one, made.folder, pose, truth): i
                   for i, (_, made, pose, truth) in enumerate(jobs)}
        try:
            for done, future in enumerate(as_completed(pending), 1):
                judged[pending[future]] = future.result()
                progress(f"judging, {what}", done, len(jobs), "fits")
        except BaseException:
            pool.shutdown(cancel_futures=True)
            raise
    scores = {}
    for (name, made, pose, truth), score in zip(jobs, judged):
        scores.setdefault(name, []).append({**score, "set": made.kind, "seed": made.seed, "kind": truth["kind"],
                                            "pose": pose, "truth": truth, "time_ms": pose["time_ms"]})
    return scores


def _leave_interrupts_to_parent():
    signal.signal(signal.SIGINT, signal.SIG_IGN)


def _judge_one(folder, pose, truth):
    """The scorer's word on one cloud; in a process of its own, as the scorer is a program."""
    scorer = importlib.import_module(SCORER)
    shape = numpy.array([*pose["position"], *pose["rotation"], *pose["semi_axes"], *pose["epsilon"]], float)
    if not numpy.isfinite(shape).all() or min(pose["semi_axes"]) <= 0:
        return {**dict.fromkeys(JUDGED, numpy.nan), "good": 0, "failed": 1}
    name = Path(pose["file"]).name
    with tempfile.TemporaryDirectory() as scratch:
        scratch = Path(scratch)
        os.symlink(folder / name, scratch / name)
        (scratch / "truth.json").write_text(json.dumps({name: truth}))
        (scratch / "poses.json").write_text(json.dumps([pose]))
        said = io.StringIO()
        sys.argv = [scorer.__name__, str(scratch), str(scratch / "poses.json")]
        with contextlib.redirect_stdout(said), warnings.catch_warnings():
            warnings.simplefilter("ignore", RuntimeWarning)  # no orientation: the shape is a ball
            scorer.main()
    told = json.loads(said.getvalue())
    return {**{key: told[key]["median"] for key in JUDGED}, "good": told["good"], "failed": told["failed"]}
