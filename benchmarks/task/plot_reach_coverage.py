"""Draws the curve of bench_reach_coverage: plot_reach_coverage.py LINES.jsonl -o docs/images/reach_coverage.png"""

from __future__ import annotations

import argparse
import json
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
from matplotlib import pyplot as plt


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("lines", type=Path)
    parser.add_argument("-o", "--output", type=Path, required=True)
    options = parser.parse_args()
    rows = [json.loads(line) for line in options.lines.read_text().splitlines()]
    rows = [row for row in rows if row["row"] == "reach coverage"]
    figure, axes = plt.subplots(figsize=(6.4, 4.2))
    styles = {"in_voxel": ("-", "in its voxel"), "near": ("--", "in the neighbourhood"), "exact": (":", "exact, free")}
    for colour, robot in zip(("tab:blue", "tab:orange"), sorted({row["on"] for row in rows}), strict=False):
        mine = sorted((row for row in rows if row["on"] == robot), key=lambda row: row["value"])
        for key, (style, label) in styles.items():
            shares = [100 * row[key] for row in mine]
            axes.plot(
                [row["value"] for row in mine], shares, style, marker="o", ms=3, color=colour, label=f"{robot}, {label}"
            )
    axes.set_xscale("log")
    axes.set_xlabel("samples")
    axes.set_ylabel("of 10,000 reachable poses [%]")
    axes.grid(alpha=0.3)
    axes.legend(fontsize=8)
    figure.tight_layout()
    figure.savefig(options.output, dpi=130)


if __name__ == "__main__":
    main()
