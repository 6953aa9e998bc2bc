"""Whether the fits know how sure they may be: calibration of the covariance, and the flag of ambiguity."""

import numpy
from scipy.spatial.transform import Rotation
from scipy.stats import chi2

import plots
from pose.lab import METHODS
from pose.summaries import cells, good, headings, pair, shown
from report import table
from summaries import wilson

REGIONS = (50, 68, 90, 95)
ROUND, SAME = 0.8, 0.05  # a cross-section turns freely from this exponent on, where its axes differ by less
BAND = (85, 95)  # the share that may lie in the 90 % region
CALIBRATION_TEXT = """\
Share of clouds whose true value lies in the region of the given covariance that should hold so many of them (χ², 3
degrees of freedom of the position; 6 of position and rotation vector in the frame of the cloud, for shapes that no turn
leaves as they are, against the nearest of their equal poses). In brackets Wilson's 95 % interval. Clouds that were
flagged as ambiguous or as not converged are counted too. On the clear set the 90 % region has to hold 85-95 %."""
AMBIGUITY_TEXT = """\
How often a fit was flagged as ambiguous (or did not converge), and whether those are the ones that went wrong.
*Confidently wrong*: not good, yet neither flagged nor unconverged. *Best alternative*: position of the nearest to the
truth among the answer and its alternatives, where a fit tells alternatives."""


def position_error(score):
    return numpy.array(score["truth"]["position"]) - score["pose"]["position"]


def turns_freely(truth):
    """Whether some turn by any angle leaves the shape about as it is."""
    a, (e1, e2) = truth["semi_axes"], truth["epsilon"]

    def same(i, j):
        return abs(a[i] - a[j]) < SAME * max(a[i], a[j])

    return e2 >= ROUND and (same(0, 1) or (e1 >= ROUND and (same(1, 2) or same(0, 2))))


def rotation_error(tools, score):
    """w with R_true = Exp(w) R_fitted, for the equal pose that is nearest."""
    fitted, true = tools.matrix(score["pose"]["rotation"]), numpy.array(score["truth"]["rotation"])
    if score["pose"]["epsilon"][1] > 1.4:  # the same shape written with its corners along the axes
        fitted = fitted @ Rotation.from_euler("z", 45, degrees=True).as_matrix()
    vectors = Rotation.from_matrix([true @ turn @ fitted.T for turn in tools.rotations]).as_rotvec()
    return min(vectors, key=numpy.linalg.norm)


def region_of(error, covariance):
    """The smallest region, in %, that holds the true value; nan where there is none, or no sound one."""
    if not covariance.any():
        return numpy.nan
    distance = error @ numpy.linalg.lstsq(covariance, error, rcond=None)[0]
    return 100 * chi2.cdf(distance, len(error)) if distance >= 0 else numpy.nan


def regions(tools, scores):
    """Of position, and of position and rotation where the shape has one."""
    position, pose = [], []
    for score in scores:
        covariance = numpy.array(score["pose"]["covariance"], float).reshape(6, 6)
        error = position_error(score)
        position.append(region_of(error, covariance[:3, :3]))
        if not turns_freely(score["truth"]):
            pose.append(region_of(numpy.concatenate([error, rotation_error(tools, score)]), covariance))
    return numpy.array(position), numpy.array(pose)


def inside(held, percent):
    """Share in the region, as a fraction; what has no region lies in none."""
    return float(numpy.mean(held <= percent))


def calibration(lab, report, tools, scores):
    held = {key: regions(tools, told) for key, told in scores.items()}
    rows = []
    for (kind, way), both in held.items():
        for what, told in zip(("position", "position and rotation"), both):
            rows.append([kind, f"`{way}`", what, len(told), *(share_cell(told, percent) for percent in REGIONS)])
    share = inside(held["clear", "adaptive"][0], 90)
    for side, at_least in (("low", True), ("high", False)):
        report.goal(f"calibration {side}", f"clear set, true positions in the 90 % region, %, "
                    f"{'at least' if at_least else 'at most'}", share, unit=100, digits=1, at_least=at_least)
    report.section("Calibration of the covariance", CALIBRATION_TEXT, plot_calibration(report, held),
                   table(["set", "", "of", "clouds", *(f"{percent} %" for percent in REGIONS)], rows))


def share_cell(held, percent):
    times = int(numpy.sum(held <= percent))
    low, high = wilson(times, len(held))
    return f"{100 * times / max(len(held), 1):.0f} % ({100 * low:.0f}-{100 * high:.0f})"


def plot_calibration(report, held):
    figure, axes = plots.panels(3, width=4, sharey=True)
    percent = numpy.arange(0, 100.1, 1)
    for axis, (kind, place, title) in zip(axes, (("clear", 0, "clear: position"), ("clear", 1, "clear: position and "
                                                 "rotation"), ("hard", 0, "hard: position"))):
        for way in METHODS:
            told = held[kind, way][place]
            shares = [100 * inside(told, region) for region in percent]
            axis.plot(percent, shares, color=plots.STYLES[way][0], label=way)
            marks = [50, 68, 90, 95]
            axis.plot(marks, [100 * inside(told, mark) for mark in marks], plots.STYLES[way][1],
                      color=plots.STYLES[way][0])
        axis.plot((0, 100), (0, 100), linestyle="--", color=plots.BLACK, linewidth=0.8, label="as it should be")
        axis.set(title=title, xlabel="region of the covariance, %", xlim=(0, 100), ylim=(0, 101))
        if kind == "clear":
            axis.plot((90, 90), BAND, color=plots.BLACK, linewidth=3, alpha=0.5, label="to reach at 90 %")
    axes[0].set_ylabel("true values within, %")
    plots.legend_below(figure, axes[0], 3)
    return plots.save(figure, report, "calibration", "Share of true values within regions of the covariance")


def unsure(score):
    return score["pose"]["ambiguous"] or not score["pose"]["converged"]


def ambiguity(lab, report, scores):
    keys = ("position_mm", "iou")
    rows = []
    for (kind, way), told in scores.items():
        flagged, rest = ([score for score in told if unsure(score) == side] for side in (True, False))
        wrong = sum(not score["good"] for score in rest)
        best = [nearest_mm(score) for score in flagged if score["pose"].get("alternatives")]
        rows.append([kind, f"`{way}`", f"{100 * len(flagged) / len(told):.0f} %",
                     *("; ".join(cells(part, keys)) if part else "" for part in (flagged, rest)),
                     *(good(part) for part in (flagged, rest)), f"{100 * wrong / len(told):.1f} %",
                     shown(pair(best)) if best else ""])
    report.section("Ambiguity", AMBIGUITY_TEXT, plot_ambiguity(report, scores),
                   table(["set", "", "flagged", "flagged: " + "; ".join(headings(keys)), "others", "flagged: good",
                          "others: good", "confidently wrong", "best alternative, mm"], rows))


def nearest_mm(score):
    """Of the answer and its alternatives."""
    told = [score["pose"], *score["pose"]["alternatives"]]
    return 1e3 * min(numpy.linalg.norm(numpy.subtract(score["truth"]["position"], shape["position"])) for shape in told)


def plot_ambiguity(report, scores):
    figure, axes = plots.panels(2, width=5, sharey=True)
    for axis, kind in zip(axes, ("clear", "hard")):
        for place, way in enumerate(METHODS):
            told = scores[kind, way]
            groups = [[score["position_mm"] for score in told if unsure(score) == side and not score["failed"]]
                      for side in (False, True)]
            plots.boxes(axis, groups, numpy.arange(2) + 0.2 * (place - 1.5), 0.16, plots.STYLES[way][0], way)
        axis.set(title=kind, yscale="log", xlim=(-0.5, 1.5))
        axis.set_xticks((0, 1), ("not flagged", "flagged"))
        axis.grid(axis="x", visible=False)
        plots.plain_numbers(axis.yaxis, (0.1, 0.3, 1, 3, 10, 30))
    axes[0].set_ylabel("position error, mm")
    plots.legend_below(figure, axes[0], 4)
    return plots.save(figure, report, "ambiguity", "Position error of flagged and other fits by method")
