#!/usr/bin/env python3
"""Adds false loop closures to graphs as Suenderhauf's Vertigo does, and prints what the program makes of them.

    vertigo.py PROGRAM FOLDER GRAPH... [--policies random,local,...] [--numbers 10,100,1000] [--sizes 5,10,20]
               [--seeds 1]

PROGRAM is the waymark program, GRAPH a graph of EDGE_SE2 that it reads; files are written below FOLDER. Every false
closure measures the identity with a noise of 0.3 m and 10 degrees and has the information of a right one. Policies:

    random         between any two poses
    local          between poses at most 20 apart
    groups         (i + q, j + q) of one measurement, for q below the size
    local_groups   the same, j at most 20 + size behind i
    places         groups that see another place in the wrong one: their measurements agree on one motion
    local_places   the same, near each other

Of the false closures those that stay are missed; lost are right closures and odometry that are left out. chi2 and the
RMSE of positions are beside those of the optimum without false closures. NUMBER counts closures, not groups.
"""

import argparse
import math
import os
import random
import re
import subprocess
import time

import numpy

LOCAL = 20
NOT_CONVERGED = 4  # exit code
SIGMAS = (0.3, 0.3, math.radians(10))


def run(program, *arguments):
    command = [program, "optimize", *arguments, "--format", "g2o"]
    began = time.time()
    done = subprocess.run(command, capture_output=True, text=True)
    if done.returncode not in (0, NOT_CONVERGED):
        raise SystemExit(" ".join(command) + "\n" + done.stderr)
    return done.stdout + done.stderr, time.time() - began


def read_g2o(path):
    """The lines of vertices and edges, and the poses in the order of their ids."""
    with open(path) as file:
        lines = [line for line in file if line.split()]
    poses = {int(line.split()[1]): tuple(map(float, line.split()[2:5])) for line in lines if line[:6] == "VERTEX"}
    return lines, numpy.array([poses[i] for i in sorted(poses)])


def ends(line):
    return tuple(map(int, line.split()[1:3]))


def is_odometry(pair):
    return abs(pair[0] - pair[1]) == 1


def compose(a, b):
    c, s = math.cos(a[2]), math.sin(a[2])
    return (a[0] + c * b[0] - s * b[1], a[1] + s * b[0] + c * b[1], a[2] + b[2])


def inverse(a):
    c, s = math.cos(a[2]), math.sin(a[2])
    return (-c * a[0] - s * a[1], s * a[0] - c * a[1], -a[2])


def noisy(pose, information, numbers):
    """A pose with noise of the information matrix of a line's last six numbers."""
    a, b, c, d, e, f = information
    root = numpy.linalg.cholesky(numpy.linalg.inv([[a, b, c], [b, d, e], [c, e, f]]))
    return tuple(numpy.add(pose, root @ [numbers.gauss(0, 1) for _ in range(3)]))


def first_pair(policy, poses, size, numbers):
    while True:
        i = numbers.randrange(poses - size)
        is_local = policy.startswith("local")
        reach = LOCAL + (size if size > 1 else 0)
        j = numbers.randrange(i, min(poses - size, i + reach) + 1) if is_local else numbers.randrange(poses - size)
        if abs(j - i) > 1 and j + size <= poses:
            return min(i, j), max(i, j)


def false_closures(policy, number, size, edges, truth, numbers):
    """Lines of false closures, none of them beside another edge."""
    closures = [line for line in edges if not is_odometry(ends(line))]
    taken = {ends(line) for line in edges}
    result = []
    while len(result) < number:
        i, j = first_pair(policy, len(truth), size, numbers)
        wrong = tuple(numbers.gauss(0, sigma) for sigma in SIGMAS)
        for q in range(min(size, number - len(result))):
            pair = (i + q, j + q)
            if pair in taken or pair[::-1] in taken:
                continue
            taken.add(pair)
            information = list(map(float, numbers.choice(closures).split()[6:12]))
            z = wrong
            if policy.endswith("places"):
                of_i = compose(inverse(truth[i]), truth[i + q])
                of_j = compose(inverse(truth[j]), truth[j + q])
                z = noisy(compose(inverse(of_i), compose(wrong, of_j)), information, numbers)
            z = (z[0], z[1], math.remainder(z[2], 2 * math.pi))
            numbers_of_line = " ".join("%.9g" % x for x in (*z, *information))
            result.append("EDGE_SE2 %d %d %s\n" % (*pair, numbers_of_line))
    return result


def chi2_of(text):
    return float(re.search(r"chi2\s+\S+ -> ([-\d.e+]+)", text).group(1))


def measure(program, path, false, truth, best):
    text, seconds = run(program, path, "-o", path + ".out.g2o", "--robust", "gnc", "--outliers", path + ".outliers")
    with open(path + ".outliers") as file:
        out = [ends(line) for line in file if line[:4] == "EDGE"]
    wrong = {ends(line) for line in false}
    lost = [pair for pair in out if pair not in wrong]
    of_odometry = sum(map(is_odometry, lost))
    _, poses = read_g2o(path + ".out.g2o")
    rmse = math.sqrt(numpy.mean(numpy.sum((poses - truth)[:, :2] ** 2, axis=1)))
    return (len(wrong - set(out)), len(lost) - of_odometry, of_odometry, chi2_of(text) / best, rmse, seconds)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("program")
    parser.add_argument("folder")
    parser.add_argument("graphs", nargs="+")
    parser.add_argument("--policies", default="random,local,groups,local_groups,places,local_places")
    parser.add_argument("--numbers", default="10,100,1000")
    parser.add_argument("--sizes", default="5,10,20")
    parser.add_argument("--seeds", default="1")
    options = parser.parse_args()
    os.makedirs(options.folder, exist_ok=True)
    print("%-20s %-13s %4s %6s %4s %7s %8s %8s %8s %8s %6s" % (
        "graph", "policy", "size", "number", "seed", "missed", "closures", "odometry", "chi2", "RMSE m", "s"))
    for graph in options.graphs:
        name = os.path.splitext(os.path.basename(graph))[0]
        clean = os.path.join(options.folder, name)
        run(options.program, graph, "-o", clean + ".given.g2o", "--max-iterations", "0", "--start", "file")
        text, _ = run(options.program, clean + ".given.g2o", "-o", clean + ".optimum.g2o")
        lines, _ = read_g2o(clean + ".given.g2o")
        edges = [line for line in lines if line.startswith("EDGE_SE2 ")]
        _, truth = read_g2o(clean + ".optimum.g2o")
        for policy in options.policies.split(","):
            for size in map(int, options.sizes.split(",") if policy[-1] == "s" else ["1"]):
                for number in map(int, options.numbers.split(",")):
                    for seed in map(int, options.seeds.split(",")):
                        numbers = random.Random("%s %d %d %d" % (policy, size, number, seed))
                        false = false_closures(policy, number, size, edges, truth, numbers)
                        path = "%s.%s.%d.%d.%d.g2o" % (clean, policy, size, number, seed)
                        with open(path, "w") as file:
                            file.writelines(lines + false)
                        row = measure(options.program, path, false, truth, chi2_of(text))
                        print("%-20s %-13s %4d %6d %4d %7d %8d %8d %8.3f %8.3f %6.1f" % (
                            name, policy, size, number, seed, *row), flush=True)


if __name__ == "__main__":
    main()
