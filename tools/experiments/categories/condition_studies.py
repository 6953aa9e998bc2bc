"""What makes a view hard: how far away it is, how much of it is hidden, how noisy its depth is, which sensor saw it."""

import numpy

import plots
from categories.certainty_studies import STYLES
from categories.depth_noise import KINECT_M_PX, surface_residual
from categories.figures import mean_interval
from categories.sets import SENSORS, WAYS
from report import table

TEXT = """\
Accuracy, dissertation → **default**, of known categories. *Distance*: median depth of the object's pixels. *Seen*:
share of its pixels that no neighbour hides. *Noise*: median over the object of the residual of curved patches (7x7
px) in disparity, as a Kinect's pixels; views that have no such patch are too small for it. Distance, size in the
image and noise go together: these are not causes apart. Means are shown where there are at least {fewest} views; the
plots' bars are 95 % over things."""
WHAT = {  # name: (axis, edges of bins)
    "distance": ("m", (0, 0.6, 0.8, 1.0, 1.2, 9)),
    "seen": ("share", (0, 0.6, 0.75, 0.9, 0.999, 2)),
    "pixels": ("px with depth", (0, 500, 1500, 4000, 10000, 1e9)),
    "noise": ("px of disparity", (0, 0.03, 0.045, 0.06, 0.08, 9)),
}
FEWEST = 12
SETS = {"rendered objects": ("rendered any", "rendered kinect"), "rendered meshes": ("meshes any", "meshes kinect")}


def conditions(report, sets, judged):
    measured = {name: {file: measure(views, file) for file in views.rows} for name, views in sets.by_name.items()}
    told = {}  # set, way: (measurements an object, judged)
    for title, names in SETS.items():
        for way, cues in WAYS.items():
            parts = [(name, judged[name, cues].known()) for name in names if (name, cues) in judged]
            if parts:
                told[title, way] = parts
    parts = [TEXT.format(fewest=FEWEST), plot_conditions(report, told, measured)]
    for what in WHAT:
        parts.append(table([f"{what}, {WHAT[what][0]}", *bin_names(what)], rows_of(told, measured, what)))
    report.section("Distance, hidden parts, noise and sensor", *parts, sensors(sets, judged))


def measure(views, file):
    """One number for each of WHAT; NaN: cannot be told."""
    from PIL import Image

    stem = str(views.folder / file)[:-4]
    depth_m = numpy.array(Image.open(f"{stem}_depth.png")) / 1000.0
    inside = (numpy.array(Image.open(f"{stem}_mask.png")) > 127) & (depth_m > 0)
    if not inside.any():
        return dict.fromkeys(WHAT, numpy.nan)
    disparity = numpy.where(inside, KINECT_M_PX / numpy.where(inside, depth_m, 1), numpy.nan)
    residuals = surface_residual(disparity, 7, step=3, curved=True)
    return {"distance": float(numpy.median(depth_m[inside])),
            "seen": float(views.rows[file].get("visible_share") or numpy.nan), "pixels": int(inside.sum()),
            "noise": float(numpy.median(residuals)) if len(residuals) else numpy.nan}


def bin_names(what):
    edges = WHAT[what][1]
    if what == "seen":
        return [f"< {edges[1]:g}", *(f"{low:g}-{high:g}" for low, high in zip(edges[1:-3], edges[2:-2])),
                f"{edges[-3]:g}-1", "all"]
    return [f"< {edges[1]:g}", *(f"{low:g}-{high:g}" for low, high in zip(edges[1:-2], edges[2:-1])),
            f"> {edges[-2]:g}"]


def split(parts, measured, what):
    """Right or not and products, by bin; and the means of what was measured."""
    values = numpy.array([measured[name][file][what] for name, one in parts for file in one.file])
    right = numpy.concatenate([one.right for _, one in parts])
    place = numpy.where(numpy.isfinite(values), numpy.digitize(values, WHAT[what][1]) - 1, -1)
    for at in range(len(WHAT[what][1]) - 1):
        yield right[place == at], values[place == at], place == at


def rows_of(told, measured, what):
    rows = []
    for title in SETS:
        if (title, "default") not in told:
            continue
        cells = []
        for (old, _, _), (new, _, _) in zip(*(split(told[title, way], measured, what) for way in WAYS)):
            cells.append(f"{old.mean():.2f} → **{new.mean():.2f}** ({len(new)})" if len(new) >= FEWEST else
                         f"- ({len(new)})")
        rows.append([title, *cells])
    return rows


def plot_conditions(report, told, measured):
    figure, axes = plots.panels(len(WHAT), width=3.1, height=3.0, sharey=True)
    for axis, (what, (unit, _)) in zip(axes, WHAT.items()):
        for (title, way), parts in told.items():
            points = []
            for right, values, which in split(parts, measured, what):
                if len(right) >= FEWEST:
                    products = Products(numpy.concatenate([one.product for _, one in parts])[which])
                    points.append((numpy.median(values), right.mean(), *mean_interval(products, right, 200)))
            if points:
                x, mean, low, high = numpy.array(points).T
                colour, marker = STYLES[way]
                axis.errorbar(x, mean, (mean - low, high - mean), color=colour, marker=marker, elinewidth=0.8,
                              linestyle="--" if title == "rendered meshes" else "-", label=f"{title}, {way}")
        axis.set(xlabel=f"{what}, {unit}", ylim=(0, 1.02))
        if what == "pixels":
            axis.set_xscale("log")
    axes[0].set_ylabel("accuracy")
    plots.legend_below(figure, axes[0], 2)
    return plots.save(figure, report, "conditions", "Accuracy against distance, share seen, pixels and noise")


class Products:
    """What a bootstrap over products needs to know."""

    def __init__(self, product):
        self.product = product


def sensors(sets, judged):
    rows = []
    for title, names in SETS.items():
        there = [name for name in names if name in sets.by_name]
        if there:
            rows.append([title, *(" → **".join(f"{judged[name, cues].known().right.mean():.3f}"
                                               for cues in WAYS.values()) + "**" for name in there)])
    return table(["the same things by", *SENSORS.values()], rows)
