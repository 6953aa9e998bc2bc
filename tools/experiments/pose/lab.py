"""Runs `beckon-pose` for the experiments: one process at a time, so that its times are worth something."""

import json
import platform
from dataclasses import dataclass
from pathlib import Path

from lab import Program, progress

SMOOTHED = "[multiscale]\nsmooth_m = 0.03\n"
WAYS = {  # name: (method, configuration)
    "adaptive": ("adaptive", ""), "multiscale": ("multiscale", ""), "multiscale, smoothed": ("multiscale", SMOOTHED),
    "classic": ("classic", ""), "hierarchical": ("hierarchical", ""),
}
METHODS = ("adaptive", "multiscale", "classic", "hierarchical")


@dataclass(frozen=True)
class Fit:
    """One `beckon-pose`: a list of clouds, or a scene whose objects are labelled."""

    clouds: Path  # LIST.jsonl; of a scene: its cloud
    way: str = "adaptive"
    repeat: int = 1
    labels: Path = None
    plane: tuple = ()
    config: str = ""  # beside the way's

    def arguments(self, folder):
        method, config = WAYS[self.way]
        source = ["--list", str(self.clouds)]
        if self.labels:
            source = ["--input", str(self.clouds), "--labels", str(self.labels)]
        if self.plane:
            source.append("--plane=" + ",".join(f"{number:.9g}" for number in self.plane))
        if config + self.config:
            path = folder / "config.toml"
            path.write_text(config + self.config)
            source += ["--config", str(path)]
        return [*source, "--method", method, "--repeat", str(self.repeat)]


class PoseLab(Program):
    OPTION = "pose-binary"

    def __init__(self, binary, folder, processes, quick):
        super().__init__(binary, folder, quick)
        self.processes = processes  # for what is not timed
        self._poses = {}
        self._help = self.call(["--help"])

    def offers(self, option):
        return option in self._help.replace(",", " ").split()

    def fit(self, what, fits):
        """Poses of each fit, a list of what `beckon-pose --json` writes; what was fitted before is not fitted again."""
        new = [fit for fit in dict.fromkeys(fits) if fit not in self._poses]
        out = self.folder / "poses.json"
        for done, fit in enumerate(new, 1):
            self.call([*fit.arguments(self.folder), "--json", str(out)])
            self._poses[fit] = json.loads(out.read_text())
            progress(what, done, len(new), "runs")
        return [self._poses[fit] for fit in fits]

    def repeats(self, way):
        """Of timed fits: fewer of those that take long."""
        return 1 if self.quick or way == "multiscale, smoothed" else 3 if way in ("multiscale", "hierarchical") else 5


def machine():
    """The processor's name."""
    for line in Path("/proc/cpuinfo").read_text().splitlines():
        if line.startswith("model name"):
            return line.split(":", 1)[1].strip()
    return platform.processor() or platform.machine()
