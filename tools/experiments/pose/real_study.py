"""Real clusters, whose truth nobody knows: how near their points the fits are, and how near points that were hidden."""

import json
import re
from dataclasses import dataclass
from pathlib import Path

import numpy

import plots
from pose.lab import METHODS, WAYS, Fit
from pose.published import REAL
from pose.scene_files import fit_plane, positions, read_pcd, write_labels, write_pcd
from pose.summaries import pair, shares, shown, values
from report import table

FEWEST_POINTS = 300
HIDDEN = 0.3
OCCLUDER_M = 0.05  # how much nearer it is
SEED = 101
PICTURED = ("learn3-1", "learn12-1", "learn20-1", "learn27-2", "learn29-1", "learn33-1", "learn36-2", "learn39-1",
            "learn41-1", "learn44-1")  # of all kinds of scene
KNOWING = "adaptive, neighbourhood known"
TEXT = """\
{clusters} clusters of at least {fewest} points from {scenes} real table scenes of the Object Segmentation Database, cut
out by its own labels; the table is a plane fitted to its labels. *Radial*: mean distance of a cluster's points from the
surface along the ray from its centre. *Hidden*: the 30 % of the points farthest along a random direction of the image
are removed, the rest is fitted, and those removed are measured: whether the fit knows what it does not see.
*{knowing}*: the same objects as whole scenes with labels (`--labels`), so that the fit sees what lies beyond each
outline; what is hidden is then hidden behind something {occluder:.0f} cm nearer. Published: on 80 such clusters."""


@dataclass(frozen=True)
class Scene:
    """What is known of a scene, and what of it is hidden."""

    name: str
    p: numpy.ndarray  # rows x columns x 3, m
    objects: numpy.ndarray  # rows x columns; 0 = none
    hidden: numpy.ndarray  # rows x columns, whether hidden
    plane: tuple
    clusters: tuple  # objects that are judged

    def of(self, number, hidden):
        return self.p[(self.objects == number) & (self.hidden == hidden)]


def real_clusters(lab, report, tools, data):
    files = sorted((data / "osd").glob("*.pcd"), key=lambda path: int(re.sub(r"\D", "", path.stem) or 0))
    rng = numpy.random.default_rng(SEED)
    scenes = [read_scene(path, rng) for path in (files[::15] if lab.quick else files)]
    lists = {what: write_clusters(lab.folder / what, scenes, what) for what in ("radial", "hidden")}
    truth = {f"{scene.name}-{number}.xyz": (scene, number) for scene in scenes for number in scene.clusters}
    judged, times = {}, {}
    fits = {(way, what): Fit(path, way, lab.repeats(way)) for way in WAYS for what, path in lists.items()}
    for (way, what), poses in zip(fits, lab.fit("real clusters", fits.values())):
        judged[way, what] = [distance_mm(tools, pose, *truth[pose["file"]], what) for pose in poses]
        times.setdefault(way, pair(values(poses, "time_ms")))
    if lab.offers("--labels"):
        for what in lists:
            judged[KNOWING, what], told = with_neighbourhood(lab, tools, scenes, what)
            times.setdefault(KNOWING, told)
    else:
        report.skip("real clusters with their neighbourhood", "this beckon-pose has no --labels")
    text = TEXT.format(clusters=len(truth), fewest=FEWEST_POINTS, scenes=len(scenes), knowing=KNOWING,
                       occluder=100 * OCCLUDER_M)
    report.section("Real clusters", text, plot(report, judged), table_of(judged, times))
    pictures(lab, report, lists["radial"])
    goals(report, judged)


def pictures(lab, report, clusters):
    """Ten objects as the camera saw them and turned, with their fits and best grasps."""
    lines = [line for line in clusters.read_text().splitlines() if Path(json.loads(line)["file"]).stem in PICTURED]
    if not lines:
        return
    chosen = clusters.with_name("pictured.jsonl")
    chosen.write_text("\n".join(lines) + "\n")
    name = "real-objects.png"
    lab.call(["--list", str(chosen), "--json", str(lab.folder / "pictured.json"),
              "--picture", str(report.folder / name)])
    report.section("Ten of them", "Each as the camera saw it and turned by a quarter about the table's normal, so that "
                   "the side shows that the camera did not see. Made by `beckon-pose --list .. --picture ..`.",
                   f"![Ten real objects with their superquadrics and best grasps]({name})")


def read_scene(path, rng):
    points = read_pcd(path)
    p, labels = positions(points), points["label"]
    sound = numpy.isfinite(p).all(-1)
    objects = numpy.where(sound & (labels >= 20), labels // 10 - 1, 0)
    plane = fit_plane(p[sound & (labels > 0) & (labels < 10)], rng)
    clusters = [number for number in range(1, objects.max() + 1) if (objects == number).sum() >= FEWEST_POINTS]
    v, u = numpy.indices(labels.shape)
    hidden = numpy.zeros(labels.shape, bool)
    for number in clusters:
        angle = rng.uniform(0, 2 * numpy.pi)
        along = u * numpy.cos(angle) + v * numpy.sin(angle)
        hidden |= (objects == number) & (along > numpy.quantile(along[objects == number], 1 - HIDDEN))
    return Scene(path.stem, p, objects, hidden, (*map(float, plane[0]), float(plane[1])), tuple(clusters))


def write_clusters(folder, scenes, what):
    folder.mkdir()
    lines = []
    for scene in scenes:
        for number in scene.clusters:
            name = f"{scene.name}-{number}.xyz"
            seen = scene.of(number, False)
            numpy.savetxt(folder / name, seen if what == "hidden" else numpy.vstack([seen, scene.of(number, True)]),
                          fmt="%.6f")
            lines.append(json.dumps({"file": name, "plane": scene.plane}) + "\n")
    path = folder / "list.jsonl"
    path.write_text("".join(lines))
    return path


def with_neighbourhood(lab, tools, scenes, what):
    fits = {}
    for scene in scenes:
        p, objects = scene.p, scene.objects
        if what == "hidden":
            nearer = 1 - OCCLUDER_M / p[..., 2:]
            p = numpy.where(scene.hidden[..., None], p * nearer, p)
            objects = numpy.where(scene.hidden, 0, objects)
        cloud, labels = (lab.folder / f"{scene.name}-{what}.{kind}" for kind in ("pcd", "png"))
        write_pcd(cloud, p)
        write_labels(labels, objects)
        fits[Fit(cloud, "adaptive", lab.repeats("adaptive"), labels, scene.plane)] = scene
    found = [(scene, pose) for scene, poses in zip(
        fits.values(), lab.fit(f"real scenes with their neighbourhood, {what}", fits)) for pose in poses]
    found = [(scene, pose) for scene, pose in found if pose["label"] in scene.clusters]
    return ([distance_mm(tools, pose, scene, pose["label"], what) for scene, pose in found],
            pair([pose["time_ms"] for _, pose in found]))


def distance_mm(tools, pose, scene, number, what):
    """Mean radial distance |p| |1 - 1/g| of the points that are asked for (P. Whaite, F. Ferrie, PAMI 13, 1991)."""
    points = scene.of(number, True)
    if what == "radial":
        points = numpy.vstack([points, scene.of(number, False)])
    return 1e3 * float(numpy.mean(radial_distances(tools, pose, points)))


def radial_distances(tools, pose, points):
    local = (points - pose["position"]) @ tools.matrix(pose["rotation"])
    gauge = tools.gauge(local, numpy.array(pose["semi_axes"]), *numpy.maximum(pose["epsilon"], 0.02))
    return numpy.linalg.norm(local, axis=1) * numpy.abs(1 - 1 / numpy.maximum(gauge, 1e-9))


def table_of(judged, times):
    rows = [[f"`{way}`" if way in WAYS else way, *(shown(pair(judged[way, what])) for what in ("radial", "hidden")),
             shown(times[way])] for way in dict.fromkeys(way for way, _ in judged)]
    rows += [[f"{program}, published", *(f"{middle:g} / {tail:g}" for middle, tail in figures), ""]
             for program, figures in REAL.items()]
    return table(["", "radial, mm", "hidden, mm", "time, ms"], rows)


def plot(report, judged):
    figure, axes = plots.panels(2, width=5, sharey=True)
    for place, (axis, what) in enumerate(zip(axes, ("radial", "hidden"))):
        for way in dict.fromkeys(way for way, _ in judged):
            if way in (*METHODS, KNOWING):
                axis.step(*shares(judged[way, what]), where="post", color=plots.STYLES[way][0], label=way)
        for program, figures in REAL.items():
            colour, marker = plots.PROGRAMS[program]
            axis.plot(figures[place], (50, 95), linestyle="--", color=colour, marker=marker,
                      label=f"{program}, published: median, p95")
        axis.set(title="all points" if what == "radial" else "hidden points", xscale="log", ylim=(0, 101),
                 xlabel="mean radial distance, mm")
        plots.plain_numbers(axis.xaxis, (0.5, 1, 2, 5, 10, 20, 50, 100))
    axes[0].set_ylabel("clusters with at most this distance, %")
    plots.legend_below(figure, axes[0], 3)
    return plots.save(figure, report, "real", "Distribution of radial distances on real clusters by method")


def goals(report, judged):
    """The figures to reach are of clusters by themselves."""
    for what, words in (("radial", "real clusters, radial, mm"), ("hidden", "real clusters, hidden 30 %, mm")):
        for part, figure in zip(("median", "p95"), pair(judged["adaptive", what])):
            name = f"{'real' if what == 'radial' else what} {part}"
            report.goal(name, f"{words}, {part}", float(figure))
