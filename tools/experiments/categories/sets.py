"""The sets of views that models are judged on: rendered objects, real views, real products' shapes rendered."""

from categories.figures import together
from categories.lab import Test, read_views

# No model is trained on these seeds: the shipped one's are in docs/model.md.
RENDERED_SEED, RENDERED_OBJECTS = 9101, 40  # of each category, two views of each, by each kind of sensor
MESH_SEED, MESH_VIEWS = 9102, 6  # by each kind of sensor
SENSORS = {"any": "any depth camera", "kinect": "Kinect"}
WAYS = {"dissertation": "dissertation", "default": "all"}  # name: --cues
TITLES = {"rendered": "rendered objects", "objects": "real views", "meshes": "rendered meshes"}
POOLED = {"rendered": ["rendered any"], "objects": ["objects"], "meshes": ["meshes any", "meshes kinect"]}
TEXT = """\
- *Rendered objects*: seed {seed}, {objects} objects of each category and {strange} strange things, two views each, as
  any of several depth cameras would see them (`--sensor any`), and the same objects anew by a Kinect (`--sensor
  kinect`). The model was trained on other seeds of the same generator, so that this is its home ground.
- *Real views*: `data/objects`, {real}.
- *Rendered meshes*: `data/meshes` (seed {mesh_seed}), {meshes}: the shapes are real, the depth camera is not.

All real views are of one sensor and one table; a product that fails takes all its views with it."""


class Sets:
    """`by_name`: rendered any, rendered kinect, objects, meshes any, meshes kinect, those that are at hand."""

    def __init__(self, lab, capture, report, data):
        self.by_name = {}
        self.objects = 3 if lab.quick else RENDERED_OBJECTS
        real = None
        if (data / "objects/manifest.csv").is_file():
            real = read_views("real views", data / "objects")
            lab.cues(real)  # a model that is refused is so before everything is rendered
        else:
            report.skip("real views", f"they are not in {data}/objects; set BECKON_DATA")
        for sensor in SENSORS:
            self.by_name[f"rendered {sensor}"] = capture.objects(
                f"rendered objects, {SENSORS[sensor]}", RENDERED_SEED, self.objects, 2, sensor)
        if real:
            self.by_name["objects"] = real
        if (data / "meshes/manifest.csv").is_file():
            for sensor in SENSORS:
                self.by_name[f"meshes {sensor}"] = capture.objects(
                    f"rendered meshes, {SENSORS[sensor]}", MESH_SEED, 0, 2 if lab.quick else MESH_VIEWS, sensor,
                    data / "meshes")
        else:
            report.skip("rendered meshes", f"they are not in {data}/meshes; set BECKON_DATA")

    @property
    def are_whole(self):
        return len(self.by_name) == 2 * len(SENSORS) + 1

    def words(self):
        meshes = counted(self.by_name.get("meshes any"))
        if "meshes any" in self.by_name:
            meshes += " by any depth camera, as many by a Kinect"
        return TEXT.format(seed=RENDERED_SEED, mesh_seed=MESH_SEED, objects=self.objects, strange=2 * self.objects,
                           real=counted(self.by_name.get("objects")), meshes=meshes)

    def judge(self, lab, what, cues, names=None):
        """By name of the set and cues; `names`: not of all sets."""
        tests = {(name, one): Test(views, one) for name, views in self.by_name.items() for one in cues
                 if names is None or name in names}
        return dict(zip(tests, lab.judge(what, list(tests.values()))))


def pooled(judged, cues):
    """The three sets that figures are told of: meshes by both kinds of sensor are one."""
    out = {}
    for name, parts in POOLED.items():
        there = [judged[part, cues] for part in parts if (part, cues) in judged]
        if there:
            out[name] = together(there)
    return out


def counted(views):
    if views is None:
        return "not at hand"
    products = {(row["category"], row.get("product") or row["instance"]) for row in views.rows.values()}
    categories = {row["category"] for row in views.rows.values()}
    return f"{len(views.rows)} views of {len(products)} products of {len(categories)} categories"
