"""Where the time goes, and how it grows with the image and with the number of objects."""

import numpy

import plots
from pose.lab import machine
from report import table
from segmentation.crowded_tables import make_table
from segmentation.depth_camera import write_frame
from segmentation.lab import PATHS
from segmentation.scenes import Scene

SCALES = (0.5, 1, 2)  # of 640 x 480
COUNTS = (1, 2, 4, 8, 12, 16, 20)
SEED, SCENES = 8301, 4  # of each size and number
RESOLUTION_OBJECTS = 8
STEPS_TEXT = """\
Medians over {scenes} scenes ({what}), ms, on a machine with {machine}. Each is a
median of repeats on warm memory. Reference over fast, scene by scene: {ratio:.0f} (middle half of the scenes: {low:.0f}
to {high:.0f}). Where other programs interrupt most repeats, though few of their steps, the total is longer than the steps
together."""
GROWTH_TEXT = """\
Mixed crowded tables: the same {scenes} tables of {objects} things at each resolution; {scenes} tables of each number of
things, at 640x480. Medians. The exponent is the slope in the logarithms, over the number of pixels."""


def time_per_step(report, what, segmented):
    of = {path: [told for (_, one), told in segmented.items() if one == path and not told.reason] for path in PATHS}
    if not all(of.values()):
        report.skip("time per step", "one of the paths saw no table anywhere")
        return
    steps = {path: {step: float(numpy.median([told.steps_ms.get(step, 0) for told in all_told]))
                    for step in all_told[0].steps_ms} for path, all_told in of.items()}
    totals = {path: [told.total_ms for (_, one), told in segmented.items() if one == path] for path in PATHS}
    low, middle, high = numpy.percentile(numpy.array(totals["reference"]) / totals["fast"], (25, 50, 75))
    parts = [STEPS_TEXT.format(scenes=len(totals["fast"]), what=what, machine=machine(), ratio=middle, low=low,
                               high=high), plot_steps(report, steps, totals)]
    for path in PATHS:
        p50, p95 = numpy.percentile(totals[path], (50, 95))
        parts.append(table([f"`{path}`", *steps[path], "steps together", "total", "total, p95"],
                           [["ms", *(f"{ms:.2f}" for ms in steps[path].values()), f"{sum(steps[path].values()):.1f}",
                             f"**{p50:.1f}**", f"{p95:.1f}"]]))
    report.section("Time per step", *parts)


def plot_steps(report, steps, totals):
    figure, axes = plots.panels(2, width=5.4, height=2.6)
    for axis, path in zip(axes, PATHS):
        names, times = list(steps[path]), list(steps[path].values())
        axis.barh(names[::-1], times[::-1], color=plots.STYLES[path][0])
        for place, ms in enumerate(times[::-1]):
            axis.text(ms, place, f" {ms:.1f}", va="center", fontsize=8)
        axis.set(title=f"{path}: {numpy.median(totals[path]):.1f} ms in all", xlabel="ms", xlim=(0, 1.15 * max(times)))
        axis.grid(axis="y", visible=False)
    return plots.save(figure, report, "steps", "Median time of each step of both paths")


def growth(lab, report):
    folder = lab.folder / "growth"
    folder.mkdir()
    seeds = range(SEED, SEED + (1 if lab.quick else SCENES))
    scales, counts = (SCALES[:2], COUNTS[1:4:2]) if lab.quick else (SCALES, COUNTS)
    sizes = {scale: [mixed(folder, seed, RESOLUTION_OBJECTS, scale) for seed in seeds] for scale in scales}
    numbers = {count: [mixed(folder, seed, count, 1) for seed in seeds] for count in counts}
    by_size = {scale: medians(lab, f"{640 * scale:.0f}x{480 * scale:.0f}", scenes) for scale, scenes in sizes.items()}
    by_number = {count: medians(lab, f"{count} objects", scenes) for count, scenes in numbers.items()}
    rows = []
    for path in PATHS:
        exponent = numpy.polyfit(2 * numpy.log(scales), numpy.log([by_size[scale][path] for scale in scales]), 1)[0]
        rows.append([f"`{path}`", *(f"{by_size[scale][path]:.1f}" for scale in scales), f"{exponent:.2f}"])
    rows.append(["ratio", *(f"{told['reference'] / told['fast']:.0f}" for told in by_size.values()), ""])
    more = [[f"`{path}`", *(f"{told[path]:.1f}" for told in by_number.values())] for path in PATHS]
    more.append(["ratio", *(f"{told['reference'] / told['fast']:.0f}" for told in by_number.values())])
    report.section("Time against resolution and number of objects",
                   GROWTH_TEXT.format(scenes=len(seeds), objects=RESOLUTION_OBJECTS),
                   plot_growth(report, by_size, by_number),
                   table(["ms", *(f"{640 * scale:.0f}x{480 * scale:.0f}" for scale in scales), "exponent"], rows),
                   table(["ms", *(f"{count} objects" for count in counts)], more))


def mixed(folder, seed, count, scale):
    stem = folder / f"{seed}-{count}-{scale}"
    return Scene(stem.name, "mixed", write_frame(stem, make_table("mixed", seed, count, scale)))


def medians(lab, what, scenes):
    segmented = lab.segment(f"time, {what}", scenes)
    return {path: float(numpy.median([told.total_ms for (_, of), told in segmented.items() if of == path]))
            for path in PATHS}


def plot_growth(report, by_size, by_number):
    figure, axes = plots.panels(2, width=4.8, sharey=True)
    for path in PATHS:
        plots.line(axes[0], list(by_size), [told[path] for told in by_size.values()], name=path)
        plots.line(axes[1], list(by_number), [told[path] for told in by_number.values()], name=path)
    axes[0].set(xscale="log", yscale="log", xlabel="pixels", ylabel="time a frame, ms", title="resolution")
    axes[1].set(xlabel="objects", title="number of objects", ylim=(1, None))
    plots.plain_numbers(axes[0].xaxis, list(by_size))
    axes[0].set_xticklabels([f"{640 * scale:.0f}x{480 * scale:.0f}" for scale in by_size])
    plots.plain_numbers(axes[0].yaxis, (1, 3, 10, 30, 100, 300, 1000, 3000))
    plots.legend_below(figure, axes[0], 2)
    return plots.save(figure, report, "growth", "Time of both paths against resolution and number of objects")
