"""Figures of others and the figures to reach. What is ours is measured, never written down here.

PROGRAMS: what programs published with their papers reached on clouds of the same generator and on 80 real clusters
(medians, then 95th percentiles; IoU: 5th), one thread:
- K. Duncan et al., "Multi-scale superquadric fitting for efficient shape and pose recovery of unknown objects", ICRA
  2013, his program;
- superquadric-lib, the fit of G. Vezzani et al., ICRA 2017, by Ipopt on 300 points;
- EMS: W. Liu et al., "Robust and accurate superquadric recovery: a probabilistic approach", CVPR 2022, in Python.
TARGETS: what the design demands (must) and hopes for (aim); None: no such figure.
"""

from report import Frame

KEYS = ("time_ms", "position_mm", "size_percent", "orientation_deg", "iou")
PROGRAMS = {  # set: {program: ((median, worst) for each of KEYS, good of 60)}
    "clear": {
        "Duncan 2013": (((368, 3376), (5.1, 22.9), (7.9, 28.9), (3.1, 43), (.76, .38)), 34),
        "Duncan 2013, not smoothed": (((9.9, 230), (5.1, 20.9), (7.6, 23.9), (2.0, 45), (.79, .35)), 39),
        "superquadric-lib": (((185, 263), (6.8, 19.1), (9.2, 16.4), (3.1, 37), (.75, .56)), 38),
        "EMS 2022": (((249, 1240), (5.8, 38.7), (4.9, 42), (.15, 3.9), (.85, .26)), 35),
    },
    "hard": {
        "Duncan 2013": (((214, 3002), (6.5, 18.0), (8.5, 21), (3.3, 42), (.75, .53)), 34),
        "superquadric-lib": (((114, 194), (9.4, 22.6), (11.9, 25), (3.9, 33), (.62, .31)), 17),
        "EMS 2022": (((199, 1026), (9.0, 33.0), (9.7, 46), (1.2, 9.8), (.73, .28)), 30),
    },
}
REAL = {  # program: mean radial distance of all points, and of those that were hidden, mm
    "Duncan 2013": ((2.17, 11.8), (18, 84)),
    "superquadric-lib": ((3.25, 5.9), (16.5, 44)),
    "EMS 2022": ((1.58, 4.4), (7.6, 53)),
}

TARGETS = {  # name: (dissertation's program, must, aim)
    "clear position_mm median": ("5.1", 0.5, 0.25),
    "clear position_mm p95": ("22.9", 1.5, 0.6),
    "hard position_mm median": ("6.5", 2, 1.2),
    "hard position_mm p95": ("18", 6, 4),
    "clear iou median": (".76", 0.97, None),
    "clear iou p5": (".38", 0.93, None),
    "hard iou median": (".75", 0.92, 0.95),
    "hard iou p5": (".53", 0.80, 0.88),
    "real median": ("2.17", 1.5, None),
    "real p95": ("11.8", 3, None),
    "hidden median": ("18", 3, None),
    "hidden p95": ("84", 13, None),
    "time median": ("368", 1.5, 0.5),
    "time p95": ("3376", 3, None),
    "calibration low": ("", 0.85, None),
    "calibration high": ("", 0.95, None),
}

FRAME = Frame(
    title="Experiments with the pose fits",
    head="""\
Made by `make experiments` (some minutes; `tools/experiments/run --only pose`). Nothing here is written by hand; the
same sources make the same figures, but for times. Clouds with a known truth come from a generator, and are judged by
a scorer, that are not part of this repository (`--pose-tools`, `BECKON_POSE_TOOLS`); nor are the real scenes.

Measured: {version}, by `{command}`. Pairs are medians / 95th percentiles, of IoU medians / 5th percentiles. Position,
size and orientation are judged up to the symmetry of the true shape. *Good*: position within 10 mm and IoU above 0.7.
Times are per object, one thread, medians of several fits in one process. Dashed: measured with the published programs,
on clouds of the same kinds.""",
    goals="\"must\" and \"aim\" are the design's. They will be judged on other seeds and scenes of the same kinds. "
          "Judged at the decimals shown.",
    reference="dissertation's program",
    targets=TARGETS)
