"""Compares the processor time of waymark.fuse() with that of `waymark run`: the same drive, the same files."""

import os
import resource
import statistics
import subprocess
import sys
import tempfile

from support import DRIVE, PROGRAM


def of_program(drive: str, folder: str) -> float:
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    subprocess.run([PROGRAM, "run", drive, "-o", folder, "--quiet"], check=False)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


CODE = """
import sys, time, warnings
warnings.simplefilter("ignore")
import waymark
before = time.process_time()
result = waymark.fuse(sys.argv[1], out=sys.argv[2] or None, covariances="none")
assert len(result.trajectory) == len(result.trajectory.covariance)  # the arrays are part of the work
print(time.process_time() - before)
"""


def of_python(drive: str, folder: str) -> float:
    """Each call has a process of its own, as the program has: memory that was used before is faster."""
    done = subprocess.run([sys.executable, "-c", CODE, drive, folder], check=True, capture_output=True, text=True)
    return float(done.stdout)


drive = sys.argv[1] if len(sys.argv) > 1 else os.fspath(DRIVE)
ways = {
    "waymark run": lambda folder: of_program(drive, folder),
    "fuse(out=...)": lambda folder: of_python(drive, folder),
    "fuse() without files": lambda folder: of_python(drive, ""),
}
seconds: dict[str, list[float]] = {way: [] for way in ways}
for _ in range(int(sys.argv[2]) if len(sys.argv) > 2 else 10):
    for way, run in ways.items():
        with tempfile.TemporaryDirectory() as folder:
            seconds[way].append(run(folder))
program = statistics.median(seconds["waymark run"])
for way, times in seconds.items():
    median = statistics.median(times)
    print(f"{way:22} {median:7.3f} s  least {min(times):7.3f} s  {100 * (median / program - 1):+6.1f} %")
