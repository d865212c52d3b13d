"""needs.py DIR: draws DIR/needs.png and DIR/needs.svg from DIR/needs.json."""
import json
import pathlib
import statistics
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt

TIME, SIZE = "#3465a4", "#9a7500"


def main():
    folder = pathlib.Path(sys.argv[1])
    data = json.loads((folder / "needs.json").read_text())
    scenes = sorted(data["scenes"], key=lambda s: s["time_ratio"], reverse=True)
    names = [pathlib.Path(s["scene"]).name.rsplit(".", 1)[0] for s in scenes]
    time = [100 * s["time_ratio"] for s in scenes]
    size = [100 * s["size_ratio"] for s in scenes]
    low = [100 * s["time_ratio_least"] for s in scenes]
    high = [100 * s["time_ratio_most"] for s in scenes]

    plt.rcParams["svg.hashsalt"] = "turner"
    figure, axes = plt.subplots(figsize=(8.5, 1.9 + 0.42 * len(scenes)), constrained_layout=True)
    places = range(len(scenes))
    axes.barh([p + 0.2 for p in places], time, 0.38, color=TIME, label="time to trace")
    axes.errorbar(time, [p + 0.2 for p in places], fmt="none", ecolor="black", elinewidth=0.8,
                  capsize=2, xerr=[[t - l for t, l in zip(time, low)],
                                   [h - t for t, h in zip(time, high)]])
    axes.barh([p - 0.2 for p in places], size, 0.38, color=SIZE, label="SPIR-V bytes")
    for place, t, s in zip(places, time, size):
        for percent, height in ((t, place + 0.2), (s, place - 0.2)):
            axes.annotate(f"{percent:.0f} %", (0, height), (3, 0), va="center", fontsize=7,
                          color="white", weight="bold", textcoords="offset points")
    axes.axvline(100, color="black", linewidth=1)
    axes.set_yticks(list(places), [f"{n} ({s['features']})" for n, s in zip(names, scenes)],
                    fontsize=8)
    axes.set_xlim(0, 1.12 * max([100, *high]))
    axes.set_ylim(-0.6, len(scenes) - 0.4)
    axes.set_xlabel("kernel specialised to the scene, in % of the one with everything",
                    fontsize=9)
    axes.tick_params(axis="x", labelsize=8)
    axes.set_title("What it is worth to leave out what the scene does not ask for\n"
                   f"(in brackets: features the scene needs of {data['features']})", fontsize=10,
                   pad=24)
    axes.legend(loc="lower center", bbox_to_anchor=(0.5, 1.0), ncols=2, fontsize=8,
                frameon=False)
    same = sum(s["same_bytes"] for s in scenes)
    figure.supxlabel(
        f"Time: the median ratio of {data['runs']} pairs of runs, one after the other; whiskers: the "
        f"least and the largest.\n"
        f"Median over scenes: time {statistics.median(time):.0f} %, size "
        f"{statistics.median(size):.0f} %. Same picture to the byte: {same} of {len(scenes)}.\n"
        f"{data['device']}, {data['driver']}, {data['cores']} cores, "
        f"{'/'.join(sorted({s['traversal'] for s in scenes}))}, turner {data['version']}", fontsize=7, x=0.01, ha="left")
    for ending in ("png", "svg"):
        figure.savefig(folder / f"needs.{ending}", dpi=150,
                       metadata={"Date": None} if ending == "svg" else None)


main()
