"""All studies of the fits, those for which there is what they need."""

from pose.certainty_studies import ambiguity, calibration
from pose.clouds import Tools, make_sets
from pose.embedded_study import embedded_objects
from pose.method_studies import side_by_side
from pose.real_study import real_clusters
from pose.size_studies import number_of_points, voxel_sizes

SEEDS = (7101, 7102, 7103)
COUNT = 60  # clouds a set and seed


def run_all(lab, report, tools_folder, data, capture):
    """Whether nothing was left out."""
    if not Tools.are_in(tools_folder):
        report.skip("everything", f"the generator and the scorer of clouds are not in {tools_folder}; set "
                    "BECKON_POSE_TOOLS")
        return False
    tools = Tools(tools_folder)
    clouds = make_sets(lab, tools, SEEDS[:1] if lab.quick else SEEDS, 6 if lab.quick else COUNT)
    scores = side_by_side(lab, report, clouds)
    calibration(lab, report, tools, scores)
    ambiguity(lab, report, scores)
    voxel_sizes(lab, report, clouds)
    number_of_points(lab, report, clouds)
    has_scenes = (data / "osd").is_dir()
    if has_scenes:
        real_clusters(lab, report, tools, data)
    else:
        report.skip("real clusters", f"their scenes are not in {data}/osd; set BECKON_DATA")
    return embedded_objects(lab, report, tools, capture) and has_scenes
