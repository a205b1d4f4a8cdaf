#!/usr/bin/env python3
"""Plays the bundled drive as if it were happening now: a receiver on a pseudo-terminal, and the odometry
as lines into a named pipe.

    python3 examples/live/play_drive.py /tmp/receiver /tmp/odometry [SPEED]

The receiver writes GGA, RMC and GST once a second, dated now. The odometry is a table of time (Unix
seconds), speed and yaw rate. SPEED plays faster; the stamps stay those of a real drive.
"""

import csv
import math
import os
import pty
import sys
import time
import tty

DRIVE = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "berlin_potsdamer_platz")


def rows(name):
    with open(os.path.join(DRIVE, name), newline="") as table:
        return list(csv.reader(table))[1:]


def sentence(body):
    checksum = 0
    for character in body:
        checksum ^= ord(character)
    return f"${body}*{checksum:02X}\r\n"


def angle(degrees, digits):
    whole = int(abs(degrees))
    return f"{whole:0{digits}d}{(abs(degrees) - whole) * 60:010.7f}"


def epoch(unix, latitude, longitude, height, sigma):
    clock = time.gmtime(unix)
    stamp = time.strftime("%H%M%S", clock) + f"{unix % 1:.2f}"[1:]
    place = f"{angle(latitude, 2)},N,{angle(longitude, 3)},E"
    return (sentence(f"GPGGA,{stamp},{place},1,09,1.0,{height:.1f},M,0.0,M,,")
            + sentence(f"GPRMC,{stamp},A,{place},,,{time.strftime('%d%m%y', clock)},,,A")
            + sentence(f"GPGST,{stamp},,,,,{sigma:.2f},{sigma:.2f},{2 * sigma:.2f}"))


def main():
    receiver, odometry = sys.argv[1:3]
    speed = float(sys.argv[3]) if len(sys.argv) > 3 else 1.0
    controller, line = pty.openpty()
    tty.setraw(line)
    os.chmod(os.ttyname(line), 0o666)  # gpsd does not stay root
    for path in (receiver, odometry):
        if os.path.lexists(path):
            os.remove(path)
    os.symlink(os.ttyname(line), receiver)
    os.mkfifo(odometry)
    events = [(float(row[0]), 0, row) for row in rows("odometry_50hz.csv")]
    # A fix leaves the receiver a fifth of a second after its time.
    fixes = [row for row in rows("gnss_5hz.csv") if abs(float(row[0]) - round(float(row[0]))) < 1e-6]
    events += [(float(row[0]) + 0.2, 1, row) for row in fixes]
    events.sort(key=lambda event: event[:2])
    with open(odometry, "w", buffering=1) as pipe:  # waits for the reader
        pipe.write("time,speed,yaw_rate\n")
        first = events[0][0]
        begin = time.time()
        for at, is_fix, row in events:
            time.sleep(max(0.0, begin + (at - first) / speed - time.time()))
            now = begin + float(row[0]) - first
            if is_fix:
                sigma = 3.5 if math.isnan(float(row[4])) else float(row[4]) / math.sqrt(2)
                text = epoch(round(now, 2), float(row[1]), float(row[2]), float(row[3]), sigma)
                os.write(controller, text.encode())
            else:
                pipe.write(f"{now:.3f},{row[1]},{row[2]}\n")


if __name__ == "__main__":
    try:
        main()
    except BrokenPipeError:
        pass  # the reader has ended
