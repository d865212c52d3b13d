"""stability.py STABILITY_JSON FOLDER: a picture NAME.png for each sweep, error against parameter."""
import json
import math
import os
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt

MARKERS = "osD^vPX*"
COLORS = ["#1b7837", "#c51b1b", "#2166ac", "#e08214", "#762a83", "#666666", "#01a0a0", "#b15928"]


def floor_of(sweep):
    """Where exact zeros are drawn: a decade below the least of what is not 0."""
    numbers = [error for method in sweep["methods"] for error in method["errors"]
               if error is not None and error > 0]
    numbers += [number for number in sweep["bounds"] + sweep["limits"] if number]
    return 10 ** (math.floor(math.log10(min(numbers))) - 1) if numbers else 1e-8


def draw(sweep, folder):
    labelled = isinstance(sweep["values"][0], str)
    xs = list(range(len(sweep["values"]))) if labelled else sweep["values"]
    logarithmic = not labelled and min(xs) > 0 and max(xs) / min(xs) > 8
    floor = floor_of(sweep)
    figure, axes = plt.subplots(figsize=(8, 4.5), dpi=110)
    for number, method in enumerate(sweep["methods"]):
        points = [(x, max(error, floor)) for x, error in zip(xs, method["errors"])
                  if error is not None]
        if not points:
            continue
        axes.plot([x for x, _ in points], [y for _, y in points], label=method["name"],
                  marker=MARKERS[number], color=COLORS[number], linewidth=2.2 if number == 0 else 1.4,
                  linestyle="none" if labelled else "-", markersize=6, zorder=10 - number)
    for key, style, label in (("bounds", "--", "bound"), ("limits", ":", "float limit")):
        points = [(x, y) for x, y in zip(xs, sweep[key]) if y]
        if points:
            axes.plot([x for x, _ in points], [y for _, y in points], "k" + style, linewidth=1,
                      label=label)
    axes.axhline(floor, color="#cccccc", linewidth=0.8, zorder=0)
    axes.set_yscale("log")
    axes.text(1.005, floor, "0", transform=axes.get_yaxis_transform(), va="center", color="#888888")
    if logarithmic:
        axes.set_xscale("log")
    if labelled:
        axes.set_ylim(floor / 3, 3)
        axes.set_xticks(xs)
        axes.set_xticklabels(sweep["values"], rotation=25, ha="right", fontsize=8)
    axes.set_xlabel(sweep["parameter"])
    axes.set_ylabel(sweep["error"])
    axes.set_title(sweep["question"], fontsize=10, wrap=True)
    axes.grid(True, which="major", color="#e5e5e5")
    axes.legend(fontsize=8, loc="center left", bbox_to_anchor=(1.03, 0.5), frameon=False)
    figure.tight_layout()
    path = os.path.join(folder, sweep["name"] + ".png")
    figure.savefig(path + ".part", format="png", metadata={"Software": "turner"})
    os.replace(path + ".part", path)
    plt.close(figure)


def main():
    with open(sys.argv[1], encoding="utf-8") as file:
        report = json.load(file)
    for sweep in report["sweeps"]:
        draw(sweep, sys.argv[2])


main()
