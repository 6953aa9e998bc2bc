"""Whether rendered depth is like real depth: the same measurements in real scenes and in rendered ones."""

import json

import numpy

import plots
from categories.depth_noise import (BRIGHTNESS, KINECT_M_PX, crease, equal_neighbours, no_depth, outlines, raggedness,
                                    real_scene, rendered_scene, surface_residual)
from lab import progress
from report import table

SEED, FRAMES, RESAMPLES = 9301, 45, 1000
TEXT = """\
{real} real scenes (`data/osd`, Kinect) beside {rendered} rendered frames (`beckon-capture --render --seed {seed}`),
and for creases the real views of boxes (`data/objects`) beside {boxes} rendered by a Kinect. Disparity is {constant}
m px over the depth. *Residual*: of a plane within windows on the table, median of windows. *Outline strays*: rms of
the last column of an object against its smoothed self (15 rows, quadratic), where what is behind is farther by 3 cm;
a sharp outline in whole pixels has .29. *No depth beside outline*: share of rows whose outline is followed by pixels
without depth, and the number of those over the step in disparity: where the projector's shadow falls that is about 1.
*Crease*: second difference of disparity at 3 (6) px over that at 12 px, across the top front edge of boxes; a sharp
edge has .25 (.5), less is rounder. *No depth inside*: share of objects' pixels away from outlines, by their
brightness; metal is told by tins, of whatever they are made. In brackets 95 % by bootstrap over scenes (views, for
creases)."""


def depth_noise(lab, capture, report, sets, data):
    """Whether it was measured."""
    if not (data / "osd").is_dir():
        report.skip("depth of real scenes", f"they are not in {data}/osd; set BECKON_DATA")
        return False
    categories = json.loads((data / "osd/categories.json").read_text())
    files = sorted((data / "osd").glob("*.pcd"))[::9 if lab.quick else 1]
    frames = capture.frames(SEED, 4 if lab.quick else FRAMES)
    real = measure_all("real scenes", files, lambda path: real_scene(path, categories))
    rendered = measure_all("rendered frames", frames, rendered_scene)
    boxes = sets.by_name["rendered kinect"]
    for views, told in ((sets.by_name.get("objects"), real), (boxes, rendered)):
        creases(views, told)
    text = TEXT.format(real=len(files), rendered=len(frames), seed=SEED, constant=KINECT_M_PX,
                       boxes=sum(row["category"] == "Box" for row in boxes.rows.values()))
    report.section("Depth, real and rendered", text,
                   table(["", "real", "rendered", "rendered / real"], list(rows(real, rendered))),
                   plot_depth(report, real, rendered))
    return True


def measure_all(what, files, read):
    """By measurement: of each scene a sum and a weight."""
    told = {}
    for done, path in enumerate(files, 1):
        for name, sum_and_weight in measure(read(path)).items():
            told.setdefault(name, []).append(sum_and_weight)
        progress(f"measuring depth, {what}", done, len(files), "scenes")
    return told


def measure(scene):
    told = {}
    disparity = numpy.where(scene.table, scene.disparity_px, numpy.nan)
    for size in (13, 25):
        residuals = surface_residual(disparity, size, step=12)
        if len(residuals):
            told[f"residual within {size}x{size} px, px"] = (numpy.median(residuals), 1)
    for axis, along in ((1, "row"), (0, "column")):
        told[f"neighbours in a {along} of equal depth"] = (equal_neighbours(scene, axis), 1)
    for side, name in ((-1, "left"), (1, "right")):
        found = list(outlines(scene, side))
        squares = numpy.concatenate([raggedness(one) for one in found] or [numpy.empty(0)])
        gaps = numpy.concatenate([one.gaps for one in found] or [numpy.empty(0)])
        told[f"outline strays, {name}, px"] = (squares.sum(), len(squares))
        told[f"no depth beside outline, {name}: rows"] = ((gaps > 0).sum(), len(gaps))
        told[f"no depth beside outline, {name}: px over step"] = (gaps.sum(), sum(one.steps.sum() for one in found))
    told.update(inside(scene))
    return told


def inside(scene):
    told = {f"no depth inside, {name}": (0, 0) for name in (*BRIGHTNESS, "tins")}

    def add(name, lost):
        told[f"no depth inside, {name}"] = tuple(numpy.add(told[f"no depth inside, {name}"], (lost.sum(), lost.size)))

    for number in numpy.unique(scene.objects[scene.objects > 0]):
        grey, lost = no_depth(scene, number)
        for name, (low, high) in BRIGHTNESS.items():
            add(name, lost[(grey >= low) & (grey < high)])
        if scene.categories.get(int(number)) == "Tin":
            add("tins", lost)
    return told


def creases(views, told):
    from PIL import Image

    found = []
    for file, row in views.rows.items() if views else ():
        if row["category"] != "Box":
            continue
        stem = str(views.folder / file)[:-4]
        depth_m = numpy.array(Image.open(f"{stem}_depth.png")) / 1000.0
        whole = (numpy.array(Image.open(f"{stem}_mask.png")) > 127) & (depth_m > 0)
        found.append(crease(numpy.where(whole, KINECT_M_PX / numpy.where(whole, depth_m, 1), numpy.nan)))
    for at, step in enumerate((3, 6)):
        told[f"crease, {step} px over 12 px"] = [(one[at], 1) for one in found if one]


def value(name, scenes):
    sums, weights = numpy.array(scenes, float).T
    mean = sums.sum() / weights.sum() if weights.sum() else numpy.nan
    return numpy.sqrt(mean) if name.startswith("outline strays") else mean


def interval(name, scenes):
    rng = numpy.random.default_rng(SEED)
    drawn = [value(name, [scenes[i] for i in rng.integers(len(scenes), size=len(scenes))]) for _ in range(RESAMPLES)]
    return numpy.nanpercentile(drawn, (2.5, 97.5))


def rows(real, rendered):
    for name in real:
        sides = []
        for told in (real, rendered):
            scenes = told.get(name)
            sides.append((value(name, scenes), *interval(name, scenes)) if scenes else None)
        form = "{:.2%} ({:.2%}-{:.2%})" if name.startswith("no depth inside") else "{:.3f} ({:.3f}-{:.3f})"
        cells = [form.format(*one) if one and numpy.isfinite(one[0]) else "-" for one in sides]
        ratio = sides[1][0] / sides[0][0] if "-" not in cells and sides[0][0] else numpy.nan
        yield [name, *cells, f"{ratio:.2f}" if numpy.isfinite(ratio) else "-"]


def plot_depth(report, real, rendered):
    """Ratios of rendered to real, about 1."""
    names = [name for name in real if real[name] and rendered.get(name) and value(name, real[name]) > 0
             and value(name, rendered[name]) > 0]
    figure, (axis,) = plots.panels(1, width=7.5, height=0.6 + 0.24 * len(names))
    for place, name in enumerate(names[::-1]):
        ratio = value(name, rendered[name]) / value(name, real[name])
        axis.plot(ratio, place, color=plots.BLUE, marker="o")
        axis.plot((1, ratio), (place, place), color=plots.BLUE)
    axis.axvline(1, color=plots.BLACK, linewidth=1)
    axis.set_yticks(range(len(names)), names[::-1], fontsize=8)
    axis.set(xscale="log", xlabel="rendered / real")
    plots.plain_numbers(axis.xaxis, (0.1, 0.2, 0.5, 1, 2, 5, 10))
    return plots.save(figure, report, "depth", "Measurements of rendered depth over those of real depth")
