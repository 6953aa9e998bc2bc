"""All studies of the segmentation, those for which there is what they need."""

from segmentation import score_studies
from segmentation.pictures import pictures
from segmentation.scenes import EMBEDDED_SEEDS, crowded_scenes, embedded_scenes, real_scenes
from segmentation.scores import Scorer, judge
from segmentation.steadiness import steadiness
from segmentation.time_studies import growth, time_per_step


def run_all(lab, report, tools_folder, data, capture):
    """Whether nothing was left out."""
    scenes = gather(lab, report, data, capture)
    segmented = {name: lab.segment(score_studies.TITLES[name].lower(), some) for name, some in scenes.items()}
    missing = Scorer.what_is_missing(tools_folder)
    if not missing:
        scorer = Scorer(tools_folder)
        judged = {name: judge(lab, scorer, score_studies.TITLES[name].lower(), some)
                  for name, some in segmented.items()}
        score_studies.goals(report, scorer, judged, segmented)
        score_studies.glance(report, scorer, judged, segmented)
        seeds = EMBEDDED_SEEDS[:1] if lab.quick else EMBEDDED_SEEDS
        for name, scores in judged.items():
            score_studies.section(report, scorer, name, scores, segmented[name], seeds=", ".join(map(str, seeds)))
    else:
        report.skip("all scores", missing)
    timed = next(iter(scenes))
    time_per_step(report, score_studies.TITLES[timed].lower(), segmented[timed])
    growth(lab, report)
    watched = steadiness(lab, report)
    pictures(lab, report, scenes, {key: told for some in segmented.values() for key, told in some.items()})
    return not missing and len(scenes) == 3 and watched


def gather(lab, report, data, capture):
    """By set, those that are at hand."""
    scenes = {}
    if (data / "osd").is_dir():
        scenes["real"] = real_scenes(data, lab.quick)
    else:
        report.skip("real scenes", f"they are not in {data}/osd; set BECKON_DATA")
    if capture.is_file():
        scenes["embedded"] = embedded_scenes(capture, lab.folder, lab.quick)
    else:
        report.skip("frames of the embedded scene", f"there is no {capture}; build it, or name it with "
                    "--capture-binary")
    scenes["crowded"] = crowded_scenes(lab.folder, lab.quick)
    return scenes
