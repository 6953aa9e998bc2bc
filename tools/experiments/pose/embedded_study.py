"""Objects of the embedded scene: not superquadrics, but their poses are known."""

import json
import subprocess
from dataclasses import dataclass

import numpy

import plots
from lab import LabError
from pose.lab import METHODS, WAYS, Fit
from pose.real_study import KNOWING, radial_distances
from pose.scene_files import positions, read_pcd
from pose.summaries import pair, shown
from report import table

SEED, FRAMES = 7101, 20
FIGURES = {"centre_mm": "centre, mm", "top_mm": "top, mm", "radial_mm": "radial, mm"}
TEXT = """\
{objects} objects of the 11 categories in {frames} frames of the embedded scene (`beckon-capture --render --seed
{seed}`), cut out by its labels, the table as it is. *Centre*: distance from the centre of the fitted superquadric to
that of the true object's bounding box. *Top*: difference of the heights above the table, the truth's being twice that
of its centre. *Radial*: of the visible points. A mug's handle, a bowl's hollow and a bottle's neck are in the truth's
box and are not in the superquadric. *{knowing}*: as whole scenes, with `--labels`."""


@dataclass(frozen=True)
class TrueObject:
    label: int
    category: str
    centre: tuple  # in C, m
    height: float  # of its top above the table, m
    points: numpy.ndarray


def embedded_objects(lab, report, tools, capture):
    if not capture.is_file():
        report.skip("the embedded scene's objects", f"there is no {capture}; build it, or name it with "
                    "--capture-binary")
        return False
    frames = render(lab, capture)
    truth = {path: true_objects(path) for path in frames}
    named = {f"{path.stem}-{thing.label}.xyz": (path, thing) for path in frames for thing in truth[path]}
    clouds = write_clouds(lab.folder / "embedded-clouds", named)
    judged = {}
    fits = {way: Fit(clouds, way, lab.repeats(way)) for way in WAYS}
    for way, poses in zip(fits, lab.fit("embedded scene's objects", fits.values())):
        judged[way] = [judge_object(tools, pose, table_of_frame(named[pose["file"]][0]), named[pose["file"]][1])
                       for pose in poses]
    if lab.offers("--labels"):
        scenes = [Fit(path, "adaptive", lab.repeats("adaptive"), path.with_name(f"{path.stem}_labels.png"),
                      table_of_frame(path)) for path in frames]
        judged[KNOWING] = []
        for path, poses in zip(frames, lab.fit("embedded scenes with their neighbourhood", scenes)):
            things = {thing.label: thing for thing in truth[path]}
            judged[KNOWING] += [judge_object(tools, pose, table_of_frame(path), things[pose["label"]])
                                for pose in poses if pose["label"] in things]
    report.section("Objects of the embedded scene",
                   TEXT.format(objects=len(named), frames=len(frames), seed=SEED, knowing=KNOWING),
                   plot(report, judged), table_by_way(judged),
                   "By category, centre (mm):\n\n" + table_by_category(judged))
    return True


def render(lab, capture):
    folder = lab.folder / "embedded"
    frames = 2 if lab.quick else FRAMES
    done = subprocess.run([capture, "--render", "--seed", str(SEED), "--frames", str(frames), "--out", folder],
                          capture_output=True, text=True)
    if done.returncode != 0:
        raise LabError(f"{capture.name} --render: {(done.stderr.strip() or 'failed').splitlines()[-1]}")
    return sorted(folder.glob("*.pcd"))


def truth_of_frame(path):
    return json.loads(path.with_name(f"{path.stem}_truth.json").read_text())


def table_of_frame(path):
    told = truth_of_frame(path)["table"]
    return (*told["normal"], told["offset_m"])


def true_objects(path):
    from PIL import Image

    labels = numpy.array(Image.open(path.with_name(f"{path.stem}_labels.png")))
    p = positions(read_pcd(path))
    normal, offset = numpy.split(numpy.array(table_of_frame(path)), [3])
    things = []
    for told in truth_of_frame(path)["objects"]:
        centre = numpy.array(told["X_CO"]["position"])
        points = p[(labels == told["label"]) & numpy.isfinite(p).all(-1)]
        things.append(TrueObject(told["label"], told["category"], tuple(centre),
                                 2 * float(normal @ centre + offset[0]), points))
    return things


def write_clouds(folder, named):
    folder.mkdir()
    lines = []
    for name, (path, thing) in named.items():
        numpy.savetxt(folder / name, thing.points, fmt="%.6f")
        lines.append(json.dumps({"file": name, "plane": table_of_frame(path)}) + "\n")
    path = folder / "list.jsonl"
    path.write_text("".join(lines))
    return path


def top_above(tools, pose, plane):
    """Height of the superquadric's highest point over a plane, m: its support function is the norm that is dual to its
    gauge, of the same form with exponents 2 - e."""
    direction = tools.matrix(pose["rotation"]).T @ plane[:3]
    inverse = 1 / numpy.array(pose["semi_axes"])
    e1, e2 = numpy.clip(2 - numpy.array(pose["epsilon"]), 0.02, 1.98)
    reach = float(tools.gauge(direction[None], inverse, e1, e2)[0])
    return float(numpy.dot(plane[:3], pose["position"]) + plane[3] + reach)


def judge_object(tools, pose, plane, thing):
    return {"category": thing.category,
            "centre_mm": 1e3 * float(numpy.linalg.norm(numpy.subtract(pose["position"], thing.centre))),
            "top_mm": 1e3 * abs(top_above(tools, pose, plane) - thing.height),
            "radial_mm": 1e3 * float(numpy.mean(radial_distances(tools, pose, thing.points))),
            "time_ms": pose["time_ms"]}


def of(judged, key):
    return pair([thing[key] for thing in judged])


def table_by_way(judged):
    return table(["", *FIGURES.values(), "time, ms"], [
        [f"`{way}`" if way in WAYS else way, *(shown(of(told, key)) for key in (*FIGURES, "time_ms"))]
        for way, told in judged.items()])


def table_by_category(judged):
    categories = sorted({thing["category"] for thing in judged["adaptive"]})
    rows = []
    for category in categories:
        things = {way: [thing for thing in told if thing["category"] == category] for way, told in judged.items()}
        rows.append([category, len(things["adaptive"]), *(shown(of(told, "centre_mm"), 1) for told in things.values())])
    return table(["", "objects", *(f"`{way}`" if way in WAYS else way for way in judged)], rows)


def plot(report, judged):
    figure, axes = plots.panels(3, width=3.8)
    ways = [way for way in judged if way in (*METHODS, KNOWING)]
    for axis, (key, title) in zip(axes, FIGURES.items()):
        for place, way in enumerate(ways):
            plots.boxes(axis, [[thing[key] for thing in judged[way]]], [place], 0.6, plots.STYLES[way][0], way)
        axis.set(title=title, yscale="log", xticks=[])
        plots.plain_numbers(axis.yaxis, (0.3, 1, 3, 10, 30, 100))
    plots.legend_below(figure, axes[0], 3)
    return plots.save(figure, report, "embedded", "Errors on the embedded scene's objects by method")
