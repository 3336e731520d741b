#!/usr/bin/env python3
"""first_view.py: how long who walks through a scene by --serve waits for the first picture after a move.

Use: perf/scripts/first_view.py PROGRAM SCENE.pbrt [WIDTHxHEIGHT [STEPS [program's options ...]]]
Prints the processor, then lines of CSV: scene, state, steps; seconds to the first tiles, to a coarse picture of the whole
view (a quarter of the width and height), to a full one (one sample of each pixel); CPU seconds of all workers to the
coarse one and to the full one; the most memory that the process has had so far, in MB. Times are medians over the steps. The
camera goes to the side by a fiftieth of the distance to what it looks at, as many steps as are asked for (8), each once the
picture before is full. cold: one step from the map as it was traced, no irradiance
computed yet; warm: after the picture itself has had 4 samples a pixel; again: the same steps once more, backwards.
"""
import os, statistics, sys, tempfile, time

sys.dont_write_bytecode = True
sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "tests", "fixtures"))
import page_client

page_client.PATIENCE = 1800
SHARE = 0.02


def cpu_seconds(state):
    return sum(cpu for _, cpu in state["threads"])


def step(run, stood, number):
    """Goes there; seconds to the first tiles, to a coarse picture and to a full one; CPU seconds to those two."""
    asked = run.state()
    before, before_cpu = asked["turn"], cpu_seconds(asked)
    reach = SHARE * number * sum((a - b) ** 2 for a, b in zip(stood["from"], stood["to"])) ** 0.5
    shifted = [x + reach * r for point in ("from", "to") for x, r in zip(stood[point], stood["right"])]
    begun = time.monotonic()
    run.post("/camera", ",".join(repr(x) for x in shifted + stood["up"]).encode())
    first = coarse = None
    while True:
        state = run.state()
        now, worked = time.monotonic() - begun, cpu_seconds(state) - before_cpu
        if state["turn"] > before and state["version"] > 0 and first is None:
            first = now
        if state["turn"] > before + 1 and coarse is None:
            coarse = now, worked
        if state["turn"] > before + 1 and state["samples"]["least"] >= 1:
            return first, coarse[0], now, coarse[1], worked
        time.sleep(0.01)


def processor():
    with open("/proc/cpuinfo") as file:
        models = [line.split(":", 1)[1].strip() for line in file if line.startswith("model name")]
    return f"{models[0] if models else 'an unknown processor'}, {len(os.sched_getaffinity(0))} logical processors"


def most_megabytes(run):
    with open(f"/proc/{run.process.pid}/status") as file:
        return next(int(line.split()[1]) for line in file if line.startswith("VmHWM:")) * 1024 / 1e6


def tell(run, name, state, steps):
    medians = ",".join(f"{statistics.median(values):.2f}" for values in zip(*steps))
    print(f"{name},{state},{len(steps)},{medians},{most_megabytes(run):.0f}", flush=True)


def main(program, scene, size="640x360", steps="8", *options):
    name, count = os.path.basename(os.path.dirname(os.path.abspath(scene))), int(steps)
    print(processor(), flush=True)
    with tempfile.TemporaryDirectory() as folder:
        files = ["--photon-map", os.path.join(folder, "map"), "-o", os.path.join(folder, "a.exr")]
        run = page_client.Program(program, "-q", "--size", size, *files, *options, scene)
        stood = run.until_state(lambda s: s.get("camera"), "a photon map")["camera"]
        tell(run, name, "cold", [step(run, stood, 1)])
        run.post("/return")
        run.until_state(lambda s: s["mode"] == "rendering" and s["samples"]["least"] >= 4, "4 samples a pixel")
        tell(run, name, "warm", [step(run, stood, number) for number in range(1, count + 1)])
        tell(run, name, "again", [step(run, stood, number) for number in range(count, 0, -1)])
        run.post("/return")
        run.post("/stop")
        run.end()


if __name__ == "__main__":
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    main(*sys.argv[1:])
