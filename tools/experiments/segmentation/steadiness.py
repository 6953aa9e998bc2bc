"""How steadily objects are shown over the frames of tables on which nothing happens, and how soon it is noticed when
something does: `beckon-bench-steadiness`, which is built beside the program that is measured."""

import json
import subprocess

from report import table

SEEDS = range(101, 113)
FRAMES, SETTLE = 100, 12
LEAST_IOU = 0.95
TEXT = """\
{tables} tables of the embedded scene's objects, {frames} frames each, with noise of their own. *Ids change*: frames that
show other ids than the frame before, and the frame from which on they never do (0: the first). *Outline*, *silhouette*:
least IoU of an object with itself one frame before; *labels*: the same of the pixels that have depth, which
the camera's noise decides. *Centroid*: rms about its mean, of the object that strays most; *table*: rms of
its distance. *Noticed*: frames until an object that was taken away is gone, until one that was put back or moved by 9 cm
is shown where it is (IoU with the truth over .5); **!**: not under the id it had. Outline IoU is at least {least} after
{settle} frames on {steady} of {tables} tables, silhouette IoU on {silhouettes}; no id changes after that on {still}."""


def steadiness(lab, report):
    """Whether it was measured."""
    binary = lab.binary.parent / "beckon-bench-steadiness"
    if not binary.is_file():
        report.skip("identity over frames", f"there is no {binary.name} beside {lab.binary.name}; build it")
        return False
    seeds, frames = (SEEDS[:2], 30) if lab.quick else (SEEDS, FRAMES)
    told = lab.folder / "steadiness.json"
    subprocess.run([binary, "--frames", str(frames), "--settle", str(SETTLE), "--json", told, "--seeds",
                    *map(str, seeds)], check=True, stdout=subprocess.DEVNULL)
    tables = json.loads(told.read_text())["tables"]
    text = TEXT.format(tables=len(tables), frames=frames, least=LEAST_IOU, settle=SETTLE,
                       steady=sum(one["settled"]["least_outline_iou"] >= LEAST_IOU for one in tables),
                       silhouettes=sum(one["settled"]["least_silhouette_iou"] >= LEAST_IOU for one in tables),
                       still=sum(one["settled"]["id_changes"] == 0 for one in tables))
    report.section("Identity over frames", text,
                   table(["seed", "objects", "shown", "ids change", "final from", *of_frames("from the first frame"),
                          *of_frames(f"after {SETTLE} frames"), "centroid, mm", "table, mm", "removed", "put back",
                          "moved"], [row(one) for one in tables]))
    return True


def of_frames(which):
    return [f"outline, {which}", "silhouette", "labels"]


def row(one):
    settled = one["settled"]
    return [one["seed"], one["objects"], one["shown"], one["all"]["id_changes"], one["final_from"],
            *overlaps(one["all"]), *overlaps(settled), f"{1e3 * settled['centroid_m']:.2f}",
            f"{1e3 * settled['table_m']:.3f}", *(noticed(one[what]) for what in ("removed", "put_back", "moved"))]


def overlaps(of):
    outline = f"{of['least_outline_iou']:.3f}"
    return [outline if of["least_outline_iou"] >= LEAST_IOU else f"**{outline}**",
            f"{of['least_silhouette_iou']:.3f}", f"{of['least_labels_iou']:.3f}"]


def noticed(what):
    return ("never" if what["frames"] is None else str(what["frames"])) + ("" if what["right_id"] else " **!**")
