"""Figures of others and the figures to reach. What is ours is measured, never written down here.

DISSERTATION: K. Duncan, "Scene-Dependent Human Intention Recognition for an Assistive Robotic System",
University of South Florida, 2014, and the result files published with it: interactions over four groups of
intentions, 20 sessions each.
REFERENCE: the design's reference figures: the dissertation's network lived again on those four groups (one user
living a group's intentions one after another; group learning in blocks and at random).
TARGETS: what the design demands (must) and hopes for (aim); None: no such figure.
"""

from report import Frame

DISSERTATION = {"mean": 3.02, "session 1": 6.68, "sessions 2-5": 4.15, "sessions 15-20": 1.94,
                "count": 5.67, "random over the scene": 16.63, "random over all": 14.77}

REFERENCE = {"continual": 4.03, "blocks": 3.12, "random": 3.15}

# The published counts that a session of the author's carries along, and the policy each belongs to.
PUBLISHED_KEYS = {"oain": "OAIN", "count": "Count", "random-scene": "RandScn", "random": "Random"}

TARGETS = {  # name: (dissertation and peers, must, aim)
    "published, aof": ("3.02", 1.28, 1.27),
    "published, all": ("3.02", 1.24, 1.22),
    "first session": ("6.7", None, None),
    "sessions 15-20": ("1.94", 1.00, None),
    "continual": ("4.03", 1.29, 1.25),
    "blocks": ("3.12", 1.30, 1.25),
    "random": ("3.15", 2.95, 2.80),
    "simulated 0.0": ("~9.5", 3.28, 3.0),
    "simulated 0.3": ("~9.5", 2.97, 2.6),
    "simulated 0.6": ("~9.5", 2.26, 2.0),
    "oain difference": ("", 0.25, None),
    "wrong 0.05": ("12.7 %", 0.01, 0.002),
    "wrong 0.1": ("26 %", 0.01, 0.002),
    "wrong 0.2": ("57 %", 0.01, 0.002),
    "time": ("", 100, 30),
}

FRAME = Frame(
    title="Experiments",
    head="""\
Made by `make experiments` (some minutes; `tools/experiments/run --help`): the dissertation's evaluation of the
intention network, and ours; [pose](pose/README.md) has the evaluation of the pose fits. Nothing here is written by
hand; the same sources make the same figures, but for times. The author's sessions themselves are not part of this
repository.

Measured: {version}, by `{command}`. Lower is better everywhere; intervals and bands are 95 %.""",
    goals="\"must\" and \"aim\" are the design's. They will be judged on other groups, users and seeds of the "
          "same kinds; here groups 1 and 2 stand for them. Judged at the decimals shown.",
    reference="dissertation, published",
    targets=TARGETS)
