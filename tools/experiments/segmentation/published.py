"""Figures of others and the figures to reach. What is ours is measured, never written down here.

Measured with the dissertation's pipeline (PCL: voxels of 2 mm, plane, hull, prism, clusters) on 65 real scenes of the
same database that are not at hand; TARGETS: what the design demands (must) and hopes for (aim) on those.
"""

from report import Frame

TARGETS = {  # name: (dissertation's program, must, aim)
    "f1_50": (".684", 0.95, 0.97),
    "f1_75": (".461", 0.90, 0.93),
    "mean_iou": (".541", 0.91, None),
    "merges": ("65", 10, 5),
    "crowded f1_50": ("", None, None),
    "crowded f1_75": ("", None, None),
    "crowded mean_iou": ("", None, None),
    "ratio": ("", 20, None),
    "time_ms": ("298", None, 5),
}

FRAME = Frame(
    title="Experiments with the segmentation",
    head="""\
Every object on the table, found in a depth image: `fast`, the default, beside `reference`, the dissertation's pipeline.
Made by `make experiments` (some minutes; `tools/experiments/run --only segmentation`). Nothing here is written by hand;
the same sources make the same figures, but for times. The real scenes and the scorer are not part of this repository
(`--data`, `BECKON_DATA`; `--segmentation-tools`, `BECKON_SEGMENTATION_TOOLS`).

Measured: {version}, by `{command}`. Segments are matched one to one to objects by the largest total IoU. *Mean IoU*: of
all objects, 0 for those that are not matched. *Split*: objects that hold several segments. *Merges*: segments that
cover at least half of each of several objects, and how many objects those are. *Missed*: objects of which less than a
tenth is in any segment. Objects lower than 2 cm, or of which fewer than 200 pixels are seen, are not judged. Times are
of one thread.""",
    goals="\"must\" and \"aim\" are the design's. They will be judged on other, harder scenes of the same database, to "
          "which the first column belongs; the crowded tables are made to be harder than the real scenes at hand. "
          "Judged at the decimals shown.",
    reference="dissertation's program",
    targets=TARGETS)
