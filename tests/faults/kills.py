#!/usr/bin/env python3
"""kill -9 while old results are written over: tests/faults/README.md.

kills.py PROGRAM SOURCE_FOLDER [INSTANTS [COMMAND]]   INSTANTS: of each command, evenly over its time
"""
import os, pathlib, re, shutil, subprocess, sys, tempfile, time

program, source = map(os.path.abspath, sys.argv[1:3])
instants = int(sys.argv[3]) if len(sys.argv) > 3 else 20
drive = pathlib.Path(source) / "examples/berlin_potsdamer_platz/drive.yaml"
# What writes the old results, and what is killed while it writes the new ones. The two differ in every number.
commands = {
    "run": (["run", str(drive), "-m", "g2", "-o", "out"], ["run", str(drive), "-m", "g1", "-o", "out"]),
    "convert": (["convert", str(drive), "-m", "g2", "-o", "out/drive.graph"],
                ["convert", str(drive), "-m", "g1", "-o", "out/drive.graph"]),
}
if len(sys.argv) > 4:
    commands = {sys.argv[4]: commands[sys.argv[4]]}
wrong = []
killed_early = 0


# Times of the computing differ from run to run: in summaries and in the line of the report on the minimisation.
times = re.compile(rb'(?<=seconds": )[-+.e0-9]+|(?<=iterations, )[-+.e0-9]+(?= s)')


def files(folder):
    return {str(p.relative_to(folder)): times.sub(b"", p.read_bytes()) for p in sorted(folder.rglob("*")) if p.is_file()}


def results_of(command, folder):
    (folder / "out").mkdir(parents=True)
    begin = time.monotonic()
    subprocess.run([program, *command], cwd=folder, check=True, capture_output=True)
    return files(folder / "out"), time.monotonic() - begin


with tempfile.TemporaryDirectory() as scratch:
    scratch = pathlib.Path(scratch)
    for name, (before, command) in commands.items():
        old, _ = results_of(before, scratch / name / "old")
        new, took = results_of(command, scratch / name / "new")
        again, _ = results_of(command, scratch / name / "again")
        wrong += [f"{name}: {file} differs between two sound runs" for file in new if new[file] != again.get(file)]
        replaced = 0
        folder = scratch / name / "now"
        for i in range(instants):
            shutil.rmtree(folder, ignore_errors=True)
            shutil.copytree(scratch / name / "old/out", folder / "out")
            process = subprocess.Popen([program, *command], cwd=folder, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
            time.sleep(took * (i + 0.5) / instants)
            process.kill()
            killed_early += process.wait() < 0
            place = f"{name}: killed after {took * (i + 0.5) / instants:.4f} s of {took:.4f} s: "
            now = {f: text for f, text in files(folder / "out").items() if ".partial-" not in f}
            for file in old.keys() - now.keys():
                wrong.append(place + file + " is gone")
            for file, text in now.items():
                sound = [s[file] for s in (old, new) if file in s]
                if text in sound:
                    replaced += text != old.get(file)
                else:
                    wrong.append(place + file + " is neither the old one nor the new one")
        after = subprocess.run([program, *command], cwd=folder, capture_output=True, text=True)
        if after.returncode:
            wrong.append(f"{name}: after the kills: exit code {after.returncode}: {after.stderr}")
        print(f"{name:8} {len(old):3} files, {instants} kills in {took:.2f} s, {replaced} files were new")
if killed_early == 0:
    sys.exit("nothing was killed")
if wrong:
    sys.exit("\n".join(wrong))
