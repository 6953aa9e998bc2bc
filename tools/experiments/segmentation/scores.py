"""The scorer's word on segmentations, scene by scene and together."""

import importlib
import importlib.util
import signal
import sys
from concurrent.futures import ProcessPoolExecutor, as_completed
from dataclasses import dataclass
from pathlib import Path

import numpy

from lab import progress
from segmentation.lab import PATHS
from segmentation.scenes import read_labels, truth

SCORER = "eval_segmentation"
THRESHOLDS = numpy.round(numpy.arange(0.3, 0.96, 0.05), 2)
SHOWN = ("precision50", "recall50", "f1_50", "precision75", "recall75", "f1_75", "mean_iou")
HEADINGS = ("precision .5", "recall .5", "F1 .5", "precision .75", "recall .75", "F1 .75", "mean IoU", "split",
            "merges / of objects", "missed")


@dataclass(frozen=True)
class Score:
    """Of one path in one scene."""

    counts: dict  # what the scorer adds up over scenes
    ious: list  # of every judged object


class Scorer:
    def __init__(self, folder):
        self.folder = str(folder)
        self.summary = _module(self.folder).summary

    @staticmethod
    def what_is_missing(folder):
        """Why there can be no scores; empty: nothing is missing."""
        if not (Path(folder) / f"{SCORER}.py").is_file():
            return f"the scorer is not in {folder}; set BECKON_SEGMENTATION_TOOLS"
        return "" if importlib.util.find_spec("cv2") else "the scorer needs OpenCV; install python3-opencv"


def judge(lab, scorer, what, segmented):
    """`segmented`: as `SegmentationLab.segment` gives it. Scores by scene and path."""
    scores = {}
    scenes = list(dict.fromkeys(scene for scene, _ in segmented))
    with ProcessPoolExecutor(lab.processes, initializer=_leave_interrupts_to_parent) as pool:
        pending = {pool.submit(_judge_one, scorer.folder, scene, [segmented[scene, path].labels for path in PATHS]):
                   scene for scene in scenes}
        try:
            for done, future in enumerate(as_completed(pending), 1):
                for path, score in zip(PATHS, future.result()):
                    scores[pending[future], path] = score
                progress(f"judging, {what}", done, len(scenes), "scenes")
        except BaseException:
            pool.shutdown(cancel_futures=True)
            raise
    return {key: scores[key] for key in segmented}


def _leave_interrupts_to_parent():
    signal.signal(signal.SIGINT, signal.SIG_IGN)


def _module(folder):
    if folder not in sys.path:
        sys.path.insert(0, folder)
    return importlib.import_module(SCORER)


def _judge_one(folder, scene, predictions):
    scorer = _module(folder)
    labels, p = truth(scene, scorer)
    told = []
    for path in predictions:
        predicted = read_labels(path).ravel() if path.is_file() else numpy.zeros(labels.size, numpy.uint16)
        counts, ious = scorer.score(labels, p, predicted)
        told.append(Score(counts, list(ious.values())))
    return told


def of_path(scores, path, kind=None):
    return [score for (scene, of), score in scores.items() if of == path and kind in (None, scene.kind)]


def cells(scorer, scores):
    """Under HEADINGS, of one path's scores."""
    told = scorer.summary([score.counts for score in scores])
    return [*(f"{told[key]:.3f}" for key in SHOWN), told["over_segmented"],
            f"{told['under_segmented']} / {told['merged_regions']}", told["missed"]]


def curves(scores):
    """Precision, recall and F1 at each of THRESHOLDS."""
    ious = numpy.concatenate([score.ious for score in scores])
    segments = sum(score.counts["segments"] for score in scores)
    hits = (ious[None] >= THRESHOLDS[:, None]).sum(1)
    return hits / max(segments, 1), hits / max(len(ious), 1), 2 * hits / max(segments + len(ious), 1)
