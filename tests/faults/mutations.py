#!/usr/bin/env python3
"""Damages a drive in one place at a time, and counts how the program ends: tests/faults/README.md.

mutations.py PROGRAM SOURCE_FOLDER [DRIVES [SEED]]   DRIVES: damaged drives, half of them in the drive.yaml

Ends with 1 if a run ended by a signal, with a code of no bad input, or after 20 s of computing; or if an error names no file.
"""
import collections, os, pathlib, random, re, resource, subprocess, sys, tempfile

program, source = map(os.path.abspath, sys.argv[1:3])
count = int(sys.argv[3]) if len(sys.argv) > 3 else 200
dice = random.Random(int(sys.argv[4]) if len(sys.argv) > 4 else 1)
bundled = pathlib.Path(source) / "examples/berlin_potsdamer_platz"
LOGS = ("odometry_50hz.csv", "gnss_5hz.csv", "truth_5hz.csv")
# Keys that the bundled drive does not have, over the same logs.
MORE = """
frame: {utm_zone: 33N, origin: [389600, 5818100]}
gate: {enabled: true, max_angle_deg: 60, max_displacement_m: 25, chord_s: 1}
gap: {longer_than: 0.5, policy: bridge, noise_factor: 100}
calibration: {gyro_bias: constant, speed_scale: "off"}
noise: stated
snap: 0.001
"""
NUMBERS = ["0", "-1", "1e300", "-1e300", "1e-300", "nan", "inf", "99999999999999999999", "1e10", "0x10", "1,5", "", "abc", "6e23", "-0.0"]
WORDS = ["null", "~", "[]", "{}", "[1, 2]", "{a: 1}", "'", '"', "*a", "&a 1", "on", "off", "auto", "-", ": :", "\t", "\x1b[2J", "é", "!!binary x"]


def damaged_yaml(text):
    lines = text.splitlines()
    i = dice.choice([k for k, line in enumerate(lines) if line.strip() and not line.startswith("#")])
    line = lines[i]
    kind = dice.choice(["number", "word", "key", "drop", "twice", "swap", "indent", "cut", "byte"])
    if kind == "number":
        lines[i] = re.sub(r"-?\d+(\.\d+)?", lambda m: dice.choice(NUMBERS), line, count=1) if re.search(r"\d", line) else line + " 1"
    elif kind == "word":
        lines[i] = re.sub(r"(:\s+)[^\s,}{#]+", lambda m: m.group(1) + dice.choice(WORDS), line, count=1)
    elif kind == "key":
        lines[i] = re.sub(r"(\w+):", lambda m: m.group(1)[:-1] + dice.choice("xyz_") + ":", line, count=1)
    elif kind == "drop":
        del lines[i]
    elif kind == "twice":
        lines.insert(i, line)
    elif kind == "swap":
        k = dice.randrange(len(lines))
        lines[i], lines[k] = lines[k], lines[i]
    elif kind == "indent":
        lines[i] = dice.choice([" ", "  ", "    ", "\t"]) + line if dice.random() < 0.5 else line.lstrip()
    elif kind == "cut":
        return kind, "\n".join(lines)[:dice.randrange(1, len(text))]
    else:
        at = dice.randrange(len(line))
        lines[i] = line[:at] + dice.choice("{}[]:,#'\"%@`|>&*!?-\x00\x7f") + line[at + dice.randrange(2):]
    return kind, "\n".join(lines) + "\n"


def damaged_log(text):
    lines = text.splitlines()
    i = dice.randrange(len(lines))
    fields = lines[i].split(",")
    field = dice.randrange(len(fields))
    kind = dice.choice(["field", "column", "drop", "header", "swap", "cut", "byte", "fields", "empty", "shift"])
    if kind == "field":
        fields[field] = dice.choice(NUMBERS)
        lines[i] = ",".join(fields)
    elif kind == "column":  # the same everywhere
        value = dice.choice(NUMBERS)
        lines = [lines[0]] + [",".join(f if k != field else value for k, f in enumerate(line.split(","))) for line in lines[1:]]
    elif kind == "drop":
        del lines[i:i + dice.choice([1, 10, 1000, 100000])]
    elif kind == "header":
        lines[0] = lines[0].replace(lines[0].split(",")[field], dice.choice(["x", "", "gps_sow_s", "\x1b[2J"]))
    elif kind == "swap":
        k = dice.randrange(len(lines))
        lines[i], lines[k] = lines[k], lines[i]
    elif kind == "cut":
        return kind, "\n".join(lines)[:dice.randrange(len(text))]
    elif kind == "byte":
        at = dice.randrange(len(lines[i]) + 1)
        lines[i] = lines[i][:at] + dice.choice("\x00;\"',. eE+-\xff") + lines[i][at + dice.randrange(2):]
    elif kind == "fields":
        lines[i] = ",".join(fields[:field] if dice.random() < 0.5 else fields + ["1"] * dice.choice([1, 1000]))
    elif kind == "empty":
        return kind, dice.choice(["", "\n", lines[0], lines[0] + "\n", "\n".join(lines[:2]) + "\n"])
    else:  # all later stamps leap
        leap = dice.choice([-1e5, 1e5, 1e9, 1e18, -10])
        lines[i:] = [re.sub(r"^[\d.]+", lambda m: str(float(m.group()) + leap), line) for line in lines[i:]]
    return kind, "\n".join(lines) + "\n"


def place_of(message):
    """How exactly an error says where: a line, a key of the drive.yaml, a file, or nothing."""
    if re.search(r"\.(yaml|csv):\d+", message):
        return "line"
    if re.search(r"\.yaml: [a-z_]+(\.[a-z_]+)*:", message) or re.search(r"\.csv: (column|'|no column)", message):
        return "key"
    return "file" if re.search(r"\.(yaml|csv)\b", message) else "nothing"


def main():
    ends = collections.Counter()
    places = collections.Counter()
    vague = collections.defaultdict(list)
    defects = []
    texts = {name: "".join((bundled / name).open().readlines()[:1 + (60 * 50 if name.startswith("odometry") else 60 * 5)]) for name in LOGS}
    with tempfile.TemporaryDirectory() as scratch:
        folder = pathlib.Path(scratch)
        for number in range(count):
            drive = (bundled / "drive.yaml").read_text() + (MORE if number % 4 < 2 else "")
            files = dict(texts)
            if number % 2:
                what = dice.choice(LOGS)
                kind, files[what] = damaged_log(texts[what])
            else:
                what = "drive.yaml"
                kind, drive = damaged_yaml(drive)
            files["drive.yaml"] = drive
            for name, text in files.items():
                (folder / name).write_bytes(text.encode("utf-8"))
            done = subprocess.run([program, "run", "drive.yaml", "-m", "g1", "-o", "out", "-q"], cwd=folder, capture_output=True,
                                  preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_CPU, (20, 20)), timeout=300)
            code, error = done.returncode, done.stderr.decode(errors="replace")
            ends[code] += 1
            name = f"{number}: {what}, {kind}: "
            if code not in (0, 2, 3, 4, 5) or "internal error" in error:
                defects.append(f"{name}ended with {code}: {error[-300:]}")
            elif code not in (0, 4):  # 4: a result without a minimum, which says so
                message = next((line for line in error.splitlines() if "error: " in line), error)
                places[place_of(message)] += 1
                if place_of(message) in ("file", "nothing"):
                    # numbers differ from drive to drive
                    vague[place_of(message) + ": " + re.sub(r"-?\d[\d.e+-]*", "N", message)].append(number)
                if place_of(message) == "nothing":
                    defects.append(f"{name}no place: {message}")
    print(f"{count} drives: exit codes", ", ".join(f"{code}: {n}" for code, n in sorted(ends.items(), key=str)))
    print("errors that name", ", ".join(f"a {place}: {n}" if place != "nothing" else f"nothing: {n}" for place, n in sorted(places.items())))
    for message, numbers in sorted(vague.items(), key=lambda item: -len(item[1])):
        print(f"{len(numbers):5}  {message}")
    if defects:
        sys.exit("\n".join(defects))


main()
