"""Objects found in the labelled scenes of mOSD: python benchmarks/mapping/segmentation.py [FOLDER] [--verbose]

FOLDER holds learn*.pcd and test*.pcd, also in folders of its own (default: those in the shared data; all 111 are in
PointCloudLibrary/data, segmentation/mOSD). An object is found when a segment has an intersection over union of 0.75 or
more with its points; as that is above a half, no segment finds two objects. Of the others, an object is
under-segmented when less than three quarters of the segment that fits it best belong to it, else over-segmented, and
missed when no segment has a point of it. Disjoint parts of an object have labels of their own in mOSD and count as
objects. All by the defaults of segment_objects, which were chosen on the learn scenes alone.
"""

from __future__ import annotations

import argparse
import re
import time
from collections import Counter
from pathlib import Path
from typing import NamedTuple

import numpy as np

import mmgrasp as mg

ROOT = Path(__file__).resolve().parents[2]
DEFAULT = ROOT.parent / "shared" / "data" / "clouds" / "pcl" / "mOSD"
FOUND = 0.75
FIRST_OBJECT = 10  # labels below: not measured, the table
# mOSD's own groups: number of the first scene.
GROUPS = {
    "learn": {0: "boxes", 17: "stacked boxes", 25: "occluded", 33: "cylindric"},
    "test": {0: "boxes", 16: "stacked boxes", 24: "occluded", 31: "cylindric", 43: "mixed", 55: "complex"},
}


class Scene(NamedTuple):
    path: Path
    split: str
    number: int

    @property
    def group(self) -> str:
        starts = GROUPS[self.split]
        return starts[max(start for start in starts if start <= self.number)]


class Score(NamedTuple):
    scene: Scene
    fates: Counter[str]  # of objects: found, over, under, missed
    overlap: float  # sum over the objects of the best intersection over union
    spurious: int  # segments of which less than half belongs to objects
    seconds: float

    @property
    def objects(self) -> int:
        return sum(self.fates.values())


def scenes(folder: Path) -> list[Scene]:
    found = []
    for path in folder.rglob("*.pcd"):
        name = re.fullmatch(r"(learn|test)(\d+)", path.stem)
        if name:
            found.append(Scene(path, name[1], int(name[2])))
    return sorted(found, key=lambda scene: (scene.split, scene.number))


def fate_of(object_size: int, common: np.ndarray, segment_sizes: np.ndarray) -> tuple[str, float]:
    """What became of an object that has `common` points with each segment, and its best overlap."""
    if not common.any():
        return "missed", 0.0
    overlap = common / (object_size + segment_sizes - common)
    best = int(np.argmax(overlap))
    if overlap[best] >= FOUND:
        return "found", float(overlap[best])
    return ("under" if common[best] < FOUND * segment_sizes[best] else "over"), float(overlap[best])


def score(scene: Scene) -> Score:
    cloud = mg.mapping.read_pcd(scene.path)
    truth = np.asarray(cloud.labels)
    points = cloud.points
    started = time.perf_counter()
    found = mg.mapping.segment_objects(points)
    seconds = time.perf_counter() - started
    sizes = np.array([len(each.indices) for each in found.objects], dtype=int)
    fates: Counter[str] = Counter()
    overlap = 0.0
    for label in np.unique(truth[truth >= FIRST_OBJECT]):
        mine = truth == label
        common = np.bincount(found.labels[mine & (found.labels >= 0)], minlength=len(sizes))
        fate, best = fate_of(int(mine.sum()), common, sizes)
        fates[fate] += 1
        overlap += best
    on_objects = [float((truth[each.indices] >= FIRST_OBJECT).mean()) for each in found.objects]
    return Score(scene, fates, overlap, sum(share < 0.5 for share in on_objects), seconds)


def row(name: str, scores: list[Score]) -> str:
    fates = sum((each.fates for each in scores), Counter[str]())
    objects = sum(fates.values())
    mean = sum(each.overlap for each in scores) / objects
    return (
        f"| {name} | {len(scores)} | {objects} | {fates['found'] / objects:.1%} | {fates['over']} | {fates['under']} | "
        f"{fates['missed']} | {sum(each.spurious for each in scores)} | {mean:.3f} |"
    )


def table(scores: list[Score]) -> str:
    lines = [
        "| scenes | number | objects | found | over-segmented | under-segmented | missed | spurious segments | mean overlap |",
        "|---|---|---|---|---|---|---|---|---|",
    ]
    for split, groups in GROUPS.items():
        of_split = [each for each in scores if each.scene.split == split]
        for group in groups.values():
            of_group = [each for each in of_split if each.scene.group == group]
            if of_group:
                lines.append(row(f"{split}, {group}", of_group))
        if of_split:
            lines.append(row(f"**{split}**", of_split))
    return "\n".join(lines + [row("**all**", scores)])


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path, nargs="?", default=DEFAULT)
    parser.add_argument("--verbose", action="store_true", help="a line for each scene with objects that were not found")
    given = parser.parse_args()
    scores = [score(scene) for scene in scenes(given.folder)]
    if not scores:
        parser.error(f"{given.folder}: no learn*.pcd or test*.pcd in it")
    for each in scores:
        if given.verbose and each.fates["found"] < each.objects:
            print(f"{each.scene.path.stem}: {dict(each.fates)}")
    print(table(scores))
    seconds = sorted(each.seconds for each in scores)
    print(f"\nSegmentation of a scene: median {seconds[len(seconds) // 2]:.2f} s, longest {seconds[-1]:.2f} s.")


if __name__ == "__main__":
    main()
