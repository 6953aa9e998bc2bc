"""Runs `beckon-perception` for the experiments: one process at a time, so that its times are worth something."""

import json
from dataclasses import dataclass
from pathlib import Path

from lab import Program, progress

PATHS = ("fast", "reference")
REPEATS = {"fast": 7, "reference": 3}
QUICK_REPEATS = {"fast": 3, "reference": 1}


@dataclass(frozen=True)
class Segmented:
    """What one path made of one scene; times are medians of several repeats in one process."""

    labels: Path  # 16-bit PNG; absent where there is no table
    objects: int
    reason: str  # why there is no table, else empty
    steps_ms: dict
    total_ms: float


class SegmentationLab(Program):
    OPTION = "perception-binary"

    def __init__(self, binary, folder, processes, quick):
        super().__init__(binary, folder, quick)
        self.processes = processes  # for what is not timed
        (self.folder / "labels").mkdir(exist_ok=True)
        self._segmented = {}

    def segment(self, what, scenes):
        """By scene and path. Both paths see a scene one after the other: a busy machine slows both alike. What was
        segmented before is not segmented again."""
        new = [scene for scene in dict.fromkeys(scenes) if (scene, PATHS[0]) not in self._segmented]
        for done, scene in enumerate(new, 1):
            for path in PATHS:
                self._segmented[scene, path] = self._run(scene, path, len(self._segmented))
            progress(what, done, len(new), "scenes")
        return {(scene, path): self._segmented[scene, path] for scene in scenes for path in PATHS}

    def _run(self, scene, path, number):
        labels, told = self.folder / "labels" / f"{number}.png", self.folder / "told.json"
        self.call(["--input", str(scene.file), "--segmentation", path, "--no-categories", "--labels", str(labels),
                   "--json", str(told), "--repeat", str((QUICK_REPEATS if self.quick else REPEATS)[path])])
        said = json.loads(told.read_text())
        return Segmented(labels, len(said["objects"]), said.get("reason", ""), said["steps_ms"],
                         said["timing_ms"]["segmentation"])
