"""A recorded run as h5py reads it: names, shapes, attributes, the same numbers as the CSV, finished or not."""
import csv
import json
import os
import signal
import subprocess
import sys
import tempfile
import time

import h5py
import numpy as np

program = sys.argv[1]


def hamel(*arguments):
    subprocess.run([program, "run", *arguments, "--quiet"], check=True)


def text(run, name):
    return bytes(run[name][:]).decode()


TEXTS = ("build", "config", "files", "format", "record", "start")


def as_before(run):
    """The file as hamel wrote it before texts had a checksum: attributes of variable length."""
    for name in TEXTS:
        if name != "record":
            written = text(run, name)
            del run[name]
            run.attrs[name] = "hamel run 1" if name == "format" else written
    del run.attrs["checksum_of_texts"]
    for name, values in run.items():
        if name not in ("record", "resume"):
            for key, value in dict(values.attrs).items():
                del values.attrs[key]
                values.attrs[key] = value.decode()


def equal(actual, expected, what):
    if actual != expected:
        sys.exit(f"{what}: {actual!r} is not {expected!r}")


with tempfile.TemporaryDirectory() as folder:
    os.chdir(folder)
    hamel("rolling_disk", "--until", "50", "-o", "a.h5", "-o", "a.csv", "-o", "a.json")
    with open("a.csv") as rows:
        table = list(csv.reader(line for line in rows if not line.startswith("#")))
    columns = {name: np.array([float(row[j]) for row in table[1:]]) for j, name in enumerate(table[0])}
    with h5py.File("a.h5") as run:
        equal(run.attrs["finished"], 1, "finished")
        record = json.loads(text(run, "record"))
        with open("a.json") as written:
            equal(record, json.load(written), "record")
        equal(record["system"], "rolling_disk", "system")
        equal(json.loads(text(run, "start"))["reason"], "unfinished", "the record at the start")
        seen = []
        for name, values in run.items():
            if name in (*TEXTS, "resume"):
                continue
            names = values.attrs["columns"].decode().split(",")
            seen += names
            for j, column in enumerate(names):
                part = values[:] if len(names) == 1 else values[:, j]
                if not np.array_equal(part, columns[column], equal_nan=True):
                    sys.exit(f"{column} is not that of the CSV")
        equal(sorted(seen), sorted(columns), "columns")
        equal(run["configuration"].shape, (5001, 4), "shape")
        equal(run["t"].attrs["unit"], b"s", "unit of t")
        equal(run["configuration"].attrs["unit"], b"rad,m,m,rad", "units of g")
        equal(run["xi"].attrs["unit"], b"rad/s,m/s,m/s,rad/s", "units of xi")
        equal(run["mu"].attrs["unit"], b"N m s,N s,N s,N m s", "units of mu")
        equal(b"left trivialisation" in run["xi"].attrs["frame"], True, "frame of xi")

    # Events are a table of names, times and states.
    hamel("chaplygin_sleigh", "--until", "6", "--events", "cusp,max(theta,x)=1.5", "-o", "e.h5", "-o", "e.csv", "-o", "e.json")
    with open("e.events.csv") as rows:
        table = list(csv.reader(rows))
    with h5py.File("e.h5") as run:
        events = run["events"][:]
        equal(list(events.dtype.names), table[0], "columns of the events")
        equal([name.decode() for name in events["name"]], [row[0] for row in table[1:]], "names of the events")
        for j, column in enumerate(table[0][1:], 1):
            equal(events[column].tolist(), [float(row[j]) for row in table[1:]], f"{column} of the events")
    with h5py.File("a.h5") as run:
        equal("events" in run, False, "events of a run that watches none")
    hamel("--continue", "e.h5", "-o", "f.json")
    with open("e.json") as first, open("f.json") as second:
        equal(json.load(second)["from"], json.load(first)["until"], "what follows a file with events")
    page = subprocess.run([program, "report", "e.h5", "-o", "e.html"], capture_output=True, text=True)
    equal(page.returncode == 0 or "without the page" in page.stderr, True, "the page of a file with events")

    # A file of before has its page, and the next run begins where it ended.
    with h5py.File("a.h5", "r+") as run:
        as_before(run)
    page = subprocess.run([program, "report", "a.h5", "-o", "a.html"], capture_output=True, text=True)
    equal(page.returncode == 0 or "without the page" in page.stderr, True, "the page of a file of before")
    hamel("--continue", "a.h5", "-o", "c.json")
    with open("c.json") as written:
        equal(json.load(written)["until"], 100.0, "what follows a file of before")

    # While it runs, and when it was killed.
    at_work = subprocess.Popen([program, "run", "rolling_disk", "--until", "1e6", "-o", "b.h5", "--quiet"])
    while not os.path.exists("b.h5.part") or os.path.getsize("b.h5.part") < 5_000_000:
        time.sleep(0.01)
    for moment in ("while it runs", "when it was killed"):
        with h5py.File("b.h5.part", swmr=True) as run:
            equal(run.attrs["finished"], 0, "finished " + moment)
            equal(len(run["t"]) >= 4096, True, "rows " + moment)
            equal(np.all(np.diff(run["t"][:4096]) > 0), True, "times " + moment)
        at_work.send_signal(signal.SIGKILL)
        at_work.wait()
