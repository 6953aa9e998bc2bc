"""Scenes with a known segmentation: files of real ones, frames of the embedded scene, crowded tables made here."""

import json
import re
import subprocess
from dataclasses import dataclass
from pathlib import Path

import numpy

from lab import LabError
from pose.scene_files import positions, read_pcd
from segmentation.crowded_tables import KINDS, make_table
from segmentation.depth_camera import write_frame

EMBEDDED_SEEDS, EMBEDDED_FRAMES = (8101, 8102, 8103, 8104), 8
CROWDED_SEED, CROWDED_SCENES = 8201, 8  # of each kind
TABLE_BAND_M = 0.015  # unlabelled points this close to the table's plane lie on it
REAL_KINDS = ((17, "boxes"), (25, "stacked boxes"), (33, "occluded"), (45, "cylindric"))  # before this number


@dataclass(frozen=True)
class Scene:
    name: str
    kind: str
    file: Path  # organised PCD; rendered ones have the images and the truth beside it

    def beside(self, ending):
        return self.file.with_name(f"{self.file.stem}_{ending}")

    @property
    def is_real(self):
        return not self.beside("labels.png").is_file()


def real_scenes(data, quick):
    def number(path):
        return int(re.sub(r"\D", "", path.stem) or 0)

    def kind(path):
        return next((kind for end, kind in REAL_KINDS if number(path) < end), "others")

    files = sorted((data / "osd").glob("*.pcd"), key=number)
    return [Scene(path.stem, kind(path), path) for path in (files[::11] if quick else files)]


def embedded_scenes(capture, folder, quick):
    scenes = []
    for seed in EMBEDDED_SEEDS[:1] if quick else EMBEDDED_SEEDS:
        out = folder / f"embedded-{seed}"
        frames = 3 if quick else EMBEDDED_FRAMES
        done = subprocess.run([capture, "--render", "--seed", str(seed), "--frames", str(frames), "--out", out],
                              capture_output=True, text=True)
        if done.returncode != 0:
            raise LabError(f"{capture.name} --render: {(done.stderr.strip() or 'failed').splitlines()[-1]}")
        scenes += [Scene(f"seed {seed}, frame {int(path.stem)}", "embedded", path)
                   for path in sorted(out.glob("*.pcd"))]
    return scenes


def crowded_scenes(folder, quick):
    folder = folder / "crowded"
    folder.mkdir()
    scenes = []
    for kind in KINDS:
        for number in range(1 if quick else CROWDED_SCENES):
            table = make_table(kind, CROWDED_SEED + number)
            scenes.append(Scene(f"{kind} {number + 1}", kind, write_frame(folder / f"{kind}-{number}", table)))
    return scenes


def truth(scene, scorer):
    """Labels and positions a pixel, flat, as the scorer reads its own files: 0 no depth, 1 the table, 10 the room, from
    20 on in tens the objects."""
    if scene.is_real:
        return scorer.load_ground_truth(str(scene.file))
    p = positions(read_pcd(scene.file)).reshape(-1, 3)
    objects = read_labels(scene.beside("labels.png")).ravel().astype(numpy.int32)
    table = json.loads(scene.beside("truth.json").read_text())["table"]
    height = p @ numpy.array(table["normal"]) + table["offset_m"]
    surroundings = numpy.where(numpy.abs(height) < TABLE_BAND_M, 1, 10)
    labels = numpy.where(objects > 0, 10 * (objects + 1), surroundings)
    return numpy.where(numpy.isfinite(p).all(-1), labels, 0), p


def true_objects(scene):
    """Number of each pixel's object, from 1 on; rows x columns."""
    if not scene.is_real:
        return read_labels(scene.beside("labels.png")).astype(int)
    labels = read_pcd(scene.file)["label"].astype(int)
    return numpy.where(labels >= 20, labels // 10 - 1, 0)


def colours(scene):
    """Rows x columns x 3, 0 .. 255."""
    from PIL import Image

    if not scene.is_real:
        return numpy.array(Image.open(scene.beside("rgb.png")).convert("RGB"))
    points = read_pcd(scene.file)
    packed = numpy.ascontiguousarray(points["rgba" if "rgba" in points.dtype.names else "rgb"]).view(numpy.uint32)
    return numpy.stack([packed >> 16 & 255, packed >> 8 & 255, packed & 255], -1).astype(numpy.uint8)


def read_labels(path):
    from PIL import Image

    return numpy.array(Image.open(path))
