"""The report: sections with tables and plots, and the figures to reach beside what was measured, as Markdown."""

from dataclasses import dataclass
from pathlib import Path


@dataclass(frozen=True)
class Frame:
    """What one report says around its sections."""

    title: str
    head: str  # with {version} and {command}
    goals: str  # how the figures to reach are judged
    reference: str  # heading of the others' figures
    targets: dict  # name: (others' figure, must, aim); None: no such figure


def table(header, rows):
    lines = [header, ["---"] * len(header), *rows]
    return "\n".join("| " + " | ".join(str(cell) for cell in line) + " |" for line in lines)


def verdict(measured, target, at_least=False):
    if target is None:
        return ""
    reached = measured >= target if at_least else measured <= target
    return f"{'≥ ' if at_least else ''}{target:g}: {'pass' if reached else '**miss**'}"


class Report:
    def __init__(self, folder, frame):
        self.folder = Path(folder)
        self.folder.mkdir(parents=True, exist_ok=True)
        self._frame = frame
        self._goals = []
        self._sections = []
        self._skipped = []

    def goal(self, name, what, measured, shown=None, unit=1, digits=None, at_least=False):
        """A figure to reach; `unit`: what a target is multiplied by to be shown (100: per cent)."""
        reference, must, aim = self._frame.targets[name]
        digits = digits or (2 if unit == 1 else 3)  # targets have two decimals
        judged = round(measured * unit, digits)
        self._goals.append([what, reference, shown or f"{judged:.{digits}f}",
                            verdict(judged, None if must is None else must * unit, at_least),
                            verdict(judged, None if aim is None else aim * unit, at_least)])

    def section(self, title, *parts):
        self._sections.append("\n\n".join([f"## {title}", *parts]))

    def skip(self, what, why):
        print(f"skipped: {what}: {why}", flush=True)
        self._skipped.append(f"- {what}: {why}")

    def picture(self, name, alt):
        return f"![{alt}]({name}.svg)"

    def write(self, version, command):
        head = [f"# {self._frame.title}", self._frame.head.format(version=version, command=command)]
        goals = ["## The figures to reach", self._frame.goals,
                 table(["what", self._frame.reference, "measured", "must", "aim"], self._goals)]
        parts = head + (goals if self._goals else []) + self._sections
        if self._skipped:
            parts += ["## Skipped", "\n".join(self._skipped)]
        (self.folder / "README.md").write_text("\n\n".join(parts) + "\n")
