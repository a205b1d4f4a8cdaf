#!/usr/bin/env python3
"""Fails single calls of the system under the program: tests/faults/README.md.

faults.py PROGRAM SHIM SOURCE_FOLDER [POINTS]   POINTS: tried numbers of call for each command and function; 0: all
"""
import fcntl, os, pathlib, resource, shutil, signal, subprocess, sys, tempfile, time

program, shim, source = map(os.path.abspath, sys.argv[1:4])
points = int(sys.argv[4]) if len(sys.argv) > 4 else 6
drive = pathlib.Path(source) / "examples/berlin_potsdamer_platz"
graph = "GRAPH 1\n" + "".join(f"VERTEX_SE2 {i} {i} 0.1 0\n" for i in range(20)) + "FIX 0\n" + "".join(
    f"EDGE_SE2 {i} {i + 1} 1 0 0 1 0 0 1 0 1\n" for i in range(19))
commands = {
    "optimize": (["optimize", "in.graph", "-o", "out.graph"], "out.graph"),
    "convert": (["convert", "in.graph", "-o", "out.graph", "--format", "g2o"], "out.graph"),
    "check": (["check", "in.graph"], None),
    "doctor": (["doctor", "in.graph"], None),
    "inspect": (["inspect", str(drive / "gnss_5hz.csv")], None),
    "run": (["run", str(drive / "drive.yaml"), "-m", "g1", "-o", "results"], "results/metrics.json"),
}
# The codes of tools/README.md, without 1, which means a defect of the program.
codes = {"write": {0, 5}, "close": {0, 3, 5}, "rename": {0, 5}, "open": {0, 2, 3, 5}, "read": {0, 2, 3}, "malloc": {0, 2, 3, 5},
         "mmap": {0, 2, 3, 5}, "fsync": {0, 5}}
# Neither the program nor every library of a command calls these.
may_be_missing = {"mmap", "fsync"}
old = "what was there before\n"
wrong = []
tried = 0


def run(folder, command, call, number, lasts):
    environment = dict(os.environ, LD_PRELOAD=shim, FAULT_CALL=call, FAULT_NUMBER=str(number), FAULT_SEEN=str(folder / "seen"))
    if lasts:
        environment["FAULT_LASTS"] = "1"
    return subprocess.run([program, *command], cwd=folder, env=environment, capture_output=True, text=True, timeout=120)


def out_of_descriptors(folder, name, command, output):
    """From so few that only the start-up code finds enough, to more than the program needs."""
    global tried
    for most in range(4, 24, 1 if points == 0 else max(1, 20 // points)):
        fresh(folder, output)
        limit = lambda: resource.setrlimit(resource.RLIMIT_NOFILE, (most, most))
        result = subprocess.run([program, *command], cwd=folder, capture_output=True, text=True, timeout=120, preexec_fn=limit)
        tried += 1
        if "error while loading shared libraries" in result.stderr:
            continue  # not the program yet
        place = f"{name}: {most} descriptors: "
        if result.returncode not in {0, 2, 3, 5}:
            wrong.append(place + f"exit code {result.returncode}: {result.stderr.strip()[-200:]}")
        elif result.returncode and "error: " not in result.stderr and "problem: " not in result.stdout:
            wrong.append(place + "no message: " + result.stderr[-200:])


def killed(folder, name, command, output):
    """kill -9 at instants of the whole run. The final name holds the old text or a whole new one, and the next run works."""
    global tried
    fresh(folder, output)
    begin = time.monotonic()
    sound = subprocess.run([program, *command], cwd=folder, capture_output=True)
    took = time.monotonic() - begin
    whole = len((folder / output).read_bytes())
    instants = points if points else 1000
    for i in range(instants):
        fresh(folder, output)
        process = subprocess.Popen([program, *command], cwd=folder, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        time.sleep(took * (i + 0.5) / instants)
        process.kill()
        process.wait()
        tried += 1
        now = (folder / output).read_text()
        if now != old and len(now) < whole * 0.98:
            wrong.append(f"{name}: killed after {took * (i + 0.5) / instants:.4f} s of {took:.4f} s: half an output")
    after = subprocess.run([program, *command], cwd=folder, capture_output=True, text=True)
    if after.returncode != sound.returncode:
        wrong.append(f"{name}: after the kills: exit code {after.returncode}: {after.stderr}")


def two_at_once(folder):
    """A folder that another program writes into is refused, and left as it was; it is free when that one has ended."""
    fresh(folder, None)
    (folder / "results").mkdir()
    command = [program, *commands["run"][0]]
    with open_folder(folder / "results"):
        second = subprocess.run(command, cwd=folder, capture_output=True, text=True)
    if second.returncode != 5 or "another program of Waymark writes into this folder now" not in second.stderr:
        wrong.append(f"two runs into one folder: exit code {second.returncode}: {second.stderr}")
    if list((folder / "results").iterdir()):
        wrong.append("two runs into one folder: the second one wrote")
    # both at the same time: one or both do the work, and what is there is whole
    both = [subprocess.Popen(command, cwd=folder, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True) for _ in range(2)]
    ends = [(process.communicate()[1], process.returncode) for process in both]
    if {code for _, code in ends} - {0, 5} or all(code == 5 for _, code in ends):
        wrong.append(f"two runs at once: {ends}")


class open_folder:
    """Holds the lock of another program."""
    def __init__(self, folder):
        self.descriptor = os.open(folder, os.O_RDONLY | os.O_DIRECTORY)
        fcntl.flock(self.descriptor, fcntl.LOCK_EX)

    def __enter__(self):
        return self

    def __exit__(self, *error):
        os.close(self.descriptor)


def fresh(folder, output):
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir()
    (folder / "in.graph").write_text(graph)
    if output:
        (folder / output).parent.mkdir(exist_ok=True)
        (folder / output).write_text(old)


def judge(folder, name, call, number, lasts, output, result, whole):
    place = f"{name}: {call} number {number}{' and later' if lasts else ''}: "
    if result.returncode < 0:
        wrong.append(place + "signal " + signal.Signals(-result.returncode).name)
    elif "Operating system error" in result.stderr:
        return  # libgfortran, before main
    elif result.returncode not in codes[call]:
        wrong.append(place + f"exit code {result.returncode}: {result.stderr.strip()[-200:]}")
    elif result.returncode != 0 and call != "write" and "error: " not in result.stderr and "problem: " not in result.stdout:
        wrong.append(place + "no message: " + result.stdout[-200:])
    left = [str(p.relative_to(folder)) for p in folder.rglob("*.partial-*")]
    if left:
        wrong.append(place + "left behind: " + ", ".join(left))
    # An output is the old one or a whole new one.
    if output and not (folder / output).read_text() == old and len((folder / output).read_bytes()) < whole * 0.98:
        wrong.append(place + "half an output")


with tempfile.TemporaryDirectory() as scratch:
    folder = pathlib.Path(scratch) / "f"
    for name, (command, output) in commands.items():
        for call in codes:
            fresh(folder, output)
            sound = run(folder, command, call, 0, False)
            if sound.returncode != 0:
                sys.exit(f"{name} fails without a fault: {sound.stderr}")
            count = int((folder / "seen").read_text())
            if count == 0 and (call != "rename" or output) and call not in may_be_missing:
                sys.exit(f"{name}: no call of {call} was seen: does the shim stand before the system's?")
            whole = len((folder / output).read_bytes()) if output else 0
            every = max(1, count // points) if points else 1
            # from the first call to the last, evenly
            numbers = sorted({*range(1, count + 1, every), *([count] if count else [])})
            for number in numbers:
                fresh(folder, output)
                lasts = tried % 2 == 1
                result = run(folder, command, call, number, lasts)
                judge(folder, name, call, number, lasts, output, result, whole)
                tried += 1
            print(f"{name:10} {call:8} {count:8} calls, {len(numbers):5} failed")
        out_of_descriptors(folder, name, command, output)
        if output:
            killed(folder, name, command, output)
    two_at_once(folder)
print(f"{tried} faults")
if wrong:
    sys.exit("\n".join(wrong))
