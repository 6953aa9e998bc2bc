"""Accuracy and time against the size of voxels and the number of points."""

import numpy

import plots
from pose.clouds import judge, of_size, voxel_centroids, write_list
from pose.lab import WAYS, Fit, machine
from pose.published import PROGRAMS
from pose.summaries import cells, good, headings, pair, pair_of, shown, values
from report import table

VOXELS_MM = (0, 2, 5, 10, 15, 20, 30)  # 0: all points
ONE_LEVEL = "[multiscale]\nvoxels_m = []\n"
LEVELLED = ("adaptive", "multiscale", "classic")
KEYS = ("time_ms", "position_mm", "size_percent", "orientation_deg", "iou")
POINTS = (300, 1000, 3000, 10000, 30000)
SEED = 1
VOXEL_TEXT = """\
The dissertation's table of voxel sizes: {count} clear clouds, seed {seed}, thinned by a grid of voxels (a point a
voxel: the centroid) and fitted. `multiscale` here has the one level that is given, as the table has; what its levels from
coarse to fine bring is in its last line. Few points are left in large voxels (last column: median)."""
POINTS_TEXT = """\
{count} clear clouds of at least 3000 points, thinned at random, or thickened by points between neighbours (a sensor of
higher resolution). Times are medians; on a machine with {machine}, one thread. The exponent is the slope of the last
three points in the logarithms: 0 does not depend on the number of points, 1 grows with it. The smoothing takes at most
5000 points."""


def voxel_sizes(lab, report, clouds):
    made = next(made for made in clouds.sets if made.kind == "clear")
    lines = made.lines()[:6 if lab.quick else 30]
    voxels_mm = VOXELS_MM[::3] if lab.quick else VOXELS_MM
    fits = {}
    for voxel_mm in voxels_mm:
        path = write_list(lab.folder / f"voxels-{voxel_mm}", made, lines,
                          lambda points: voxel_centroids(points, 1e-3 * voxel_mm) if voxel_mm else points)
        for way in LEVELLED:
            config = ONE_LEVEL if way == "multiscale" else ""
            fits[way, voxel_mm] = Fit(path, way, lab.repeats(way), config=config)
    fits["levels"] = Fit(fits["multiscale", 0].clouds, "multiscale", lab.repeats("multiscale"))
    poses = lab.fit("voxel sizes", fits.values())
    scores = judge(lab, "voxel sizes", [(name, made, told) for name, told in zip(fits, poses)])
    rows = [[f"`{way}`", f"{voxel_mm} mm" if voxel_mm else "all points", *figures(scores[way, voxel_mm])]
            for way in LEVELLED for voxel_mm in voxels_mm]
    rows.append(["`multiscale`", "30, 23, 16.5 mm, all", *figures(scores["levels"])])
    report.section("Effect of the voxel size", VOXEL_TEXT.format(count=len(lines), seed=made.seed),
                   plot_voxels(report, scores, voxels_mm),
                   table(["", "voxels", *headings(KEYS), "good", "points"], rows))


def figures(scores):
    return [*cells(scores, KEYS), good(scores), f"{numpy.median([score['pose']['points'] for score in scores]):.0f}"]


def plot_voxels(report, scores, voxels_mm):
    figure, axes = plots.panels(3, width=3.8)
    for axis, key, title in zip(axes, ("position_mm", "iou", "time_ms"), ("position error, mm", "IoU", "time, ms")):
        for way in LEVELLED:
            pairs = numpy.array([pair_of(scores[way, voxel_mm], key) for voxel_mm in voxels_mm])
            plots.line(axis, voxels_mm, pairs[:, 0], name=way)
            if key != "time_ms":
                axis.plot(voxels_mm, pairs[:, 1], color=plots.STYLES[way][0], linestyle=":")
        axis.set(title=title, xlabel="voxel, mm (0: all points)")
        if key != "iou":
            axis.set_yscale("log")
            plots.plain_numbers(axis.yaxis, (0.1, 0.3, 1, 3, 10, 30))
    published = PROGRAMS["clear"]["Duncan 2013"][0][1]
    axes[0].axhline(published[0], color=plots.PROGRAMS["Duncan 2013"][0], linestyle="--",
                    label="Duncan 2013, published, median")
    axes[0].set_ylabel("median; dotted: worst 5 %")
    plots.legend_below(figure, axes[0], 4)
    return plots.save(figure, report, "voxels", "Errors and time against the size of voxels")


def number_of_points(lab, report, clouds):
    rng = numpy.random.default_rng(SEED)
    made = next(made for made in clouds.sets if made.kind == "clear")
    truth = made.truth()
    lines = [line for line in made.lines() if truth[line["file"]]["points"] >= 3000][:3 if lab.quick else 12]
    counts = POINTS[:3] if lab.quick else POINTS
    fits = {}
    for count in counts:
        path = write_list(lab.folder / f"points-{count}", made, lines, lambda points: of_size(points, count, rng))
        fits.update({(way, count): Fit(path, way, min(3, lab.repeats(way))) for way in WAYS})
    poses = lab.fit("numbers of points", fits.values())
    times = {name: values(told, "time_ms") for name, told in zip(fits, poses)}
    rows = []
    for way in WAYS:
        medians = [numpy.median(times[way, count]) for count in counts]
        slope = numpy.polyfit(numpy.log(counts[-3:]), numpy.log(medians[-3:]), 1)[0]
        rows.append([f"`{way}`", *(shown(pair(times[way, count])) for count in counts), f"{slope:.2f}"])
    report.section("Time against the number of points",
                   POINTS_TEXT.format(count=len(lines), machine=machine()), plot_points(report, times, counts),
                   table(["time, ms", *(f"{count} points" for count in counts), "exponent"], rows))


def plot_points(report, times, counts):
    figure, (axis,) = plots.panels(1, width=5.5)
    for way in WAYS:
        pairs = numpy.array([pair(times[way, count]) for count in counts])
        plots.line(axis, counts, pairs[:, 0], name=way)
    published = PROGRAMS["clear"]["Duncan 2013"][0][0]
    axis.axhline(published[0], color=plots.PROGRAMS["Duncan 2013"][0], linestyle="--",
                 label="Duncan 2013, published, median of all clear clouds")
    axis.set(xscale="log", yscale="log", xlabel="points", ylabel="time an object, ms")
    plots.plain_numbers(axis.xaxis, counts)
    plots.plain_numbers(axis.yaxis, (0.1, 0.3, 1, 3, 10, 30, 100, 300, 1000))
    plots.legend_below(figure, axis, 2)
    return plots.save(figure, report, "points", "Time against the number of points")
