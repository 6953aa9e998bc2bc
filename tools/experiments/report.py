"""The report: sections with tables and plots, and the figures to reach beside what was measured, as Markdown."""

from pathlib import Path

from published import TARGETS


HEAD_TEXT = """\
Made by `make experiments` (some minutes; `tools/experiments/run --help`): the dissertation's evaluation of the
intention network, and ours. Nothing here is written by hand; the same sources make the same figures, but for times.
The author's sessions themselves are not part of this repository.

Measured: {version}, by `{command}`. Lower is better everywhere; intervals and bands are 95 %."""


def table(header, rows):
    lines = [header, ["---"] * len(header), *rows]
    return "\n".join("| " + " | ".join(str(cell) for cell in line) + " |" for line in lines)


def verdict(measured, target):
    if target is None:
        return ""
    return f"{target:g}: {'pass' if measured <= target else '**miss**'}"


class Report:
    def __init__(self, folder):
        self.folder = Path(folder)
        self.folder.mkdir(parents=True, exist_ok=True)
        self._goals = []
        self._sections = []
        self._skipped = []

    def goal(self, name, what, measured, shown=None, unit=1):
        """A figure to reach; `unit`: what a target is multiplied by to be shown (100: per cent)."""
        reference, must, aim = TARGETS[name]
        judged = round(measured * unit, 2 if unit == 1 else 3)  # targets have two decimals
        self._goals.append([what, reference, shown or f"{judged:.2f}",
                            verdict(judged, None if must is None else must * unit),
                            verdict(judged, None if aim is None else aim * unit)])

    def section(self, title, *parts):
        self._sections.append("\n\n".join([f"## {title}", *parts]))

    def skip(self, what, why):
        print(f"skipped: {what}: {why}", flush=True)
        self._skipped.append(f"- {what}: {why}")

    def picture(self, name, alt):
        return f"![{alt}]({name}.svg)"

    def write(self, version, command):
        head = ["# Experiments", HEAD_TEXT.format(version=version, command=command)]
        goals = ["## The figures to reach",
                 "\"must\" and \"aim\" are the design's. They will be judged on other groups, users and seeds of the "
                 "same kinds; here groups 1 and 2 stand for them. Judged at the decimals shown.",
                 table(["what", "dissertation, published", "measured", "must", "aim"], self._goals)]
        parts = head + (goals if self._goals else []) + self._sections
        if self._skipped:
            parts += ["## Skipped", "\n".join(self._skipped)]
        (self.folder / "README.md").write_text("\n\n".join(parts) + "\n")
