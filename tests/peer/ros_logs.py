"""MCAP files that are written here from the specification, and bags that Debian's rosbag writes, give the program the
same drive as CSV; what the program writes is read by others. Usage: ros_logs.py WAYMARK SOURCE_DIR"""
import csv
import math
import os
import re
import struct
import subprocess
import sys
import tempfile

import ros_files as ros

WAYMARK = sys.argv[1]
T0 = 1_700_000_000_000_000_000
STEP = 50_000_000


def run(*arguments, code=0):
    result = subprocess.run([WAYMARK, *arguments], capture_output=True, text=True)
    assert result.returncode == code, (arguments, result.returncode, result.stdout, result.stderr)
    return result


def write(name, data):
    with open(name, "wb" if isinstance(data, bytes) else "w") as file:
        file.write(data)
    return name


def drive():
    """60 s of a figure with both turns, 20 Hz odometry and 1 Hz fixes with errors of fixed pseudo-random numbers."""
    x = y = 0.0
    heading, noise = 0.3, 12345
    motions, fixes = [], []
    for i in range(1201):
        t = T0 + i * STEP
        speed, rate = 8 + 2 * math.sin(i / 100), 0.2 * math.sin(i / 150)
        motions.append((t, speed, rate))
        if i % 20 == 0:
            noise = (noise * 1103515245 + 12345) % 2**31
            east, north = (noise % 1000) / 5000 - 0.1, (noise // 1000 % 1000) / 5000 - 0.1
            lat = round(52.5 + (y + north) / 111_200, 9)
            lon = round(13.4 + (x + east) / (111_200 * math.cos(math.radians(52.5))), 9)
            fixes.append((t, lat, lon, 40.0))
        x += 0.05 * speed * math.cos(heading)
        y += 0.05 * speed * math.sin(heading)
        heading += 0.05 * rate
    return motions, fixes


MOTIONS, FIXES = drive()
COVARIANCE = [2.25, 0, 0, 0, 4.0, 0, 0, 0, 9.0]  # 1.5 m east, 2 m north
YAML = "time: {scale: unix}\nodometry: {file: %s%s}\ngnss: {file: %s%s}\n"


def stamp(ns):
    return "%d.%09d" % divmod(ns, 10**9)


def graph_of(name, odometry, gnss, motion_topic="", fix_topic=""):
    """The graph of a drive without what tells where it came from."""
    write(name + ".yaml", YAML % (odometry, motion_topic, gnss, fix_topic))
    run("convert", name + ".yaml", "-o", name + ".graph", "--modeling", "g2")
    with open(name + ".graph") as file:
        return [line for line in file if not line.startswith("PROVENANCE")]


def csv_graph():
    write("motion.csv", "time,speed,yaw_rate\n" + "".join("%s,%r,%r\n" % (stamp(t), v, w) for t, v, w in MOTIONS))
    write("fixes.csv", "time,latitude,longitude,height,sigma_east,sigma_north,quality\n" + "".join(
        "%s,%r,%r,%r,1.5,2,single\n" % (stamp(t), *place) for t, *place in FIXES))
    return graph_of("csv", "motion.csv", "fixes.csv")


def recording(kind="TwistStamped", encoding="cdr", big=False, **how):
    types = {"TwistStamped": "geometry_msgs/msg/TwistStamped", "Odometry": "nav_msgs/msg/Odometry"}
    file = ros.Mcap([("/camera", "sensor_msgs/msg/Image", "cdr"), ("/fix", "sensor_msgs/msg/NavSatFix", encoding),
                     ("/motion", types[kind], encoding)], **how)
    fixes = dict((t, place) for t, *place in FIXES)
    for t, v, w in MOTIONS:
        log_time = t + 3_000_000  # recorded later than stamped
        file.add(1, log_time, b"picture" * 50)
        if t in fixes:
            fix = (t, *fixes[t], COVARIANCE, 2, 0)
            file.add(2, log_time, ros.fix_json(*fix) if encoding == "json" else ros.fix_cdr(*fix, big=big))
        if encoding == "json":
            file.add(3, log_time, ros.twist_json(t, v, w))
        else:
            file.add(3, log_time, (ros.twist_cdr if kind == "TwistStamped" else ros.odometry_cdr)(t, v, w, big=big))
    return file.bytes()


def check_mcap_in(expected):
    ways = {"plain": {}, "big": {"big": True}, "json": {"encoding": "json"}, "odometry": {"kind": "Odometry"},
            "odometry_big": {"kind": "Odometry", "big": True}, "chunks": {"chunk": 30_000},
            "zstd": {"chunk": 30_000, "compression": "zstd"}, "no_crc": {"chunk": 30_000, "crc": False}}
    try:
        import roslz4
        ways["lz4"] = {"chunk": 30_000, "compression": "lz4", "compress": lambda d: roslz4.compress(d)}
    except ImportError:
        print("roslz4 is not installed: no lz4")
    for name, how in ways.items():
        write(name + ".mcap", recording(**how))
        assert graph_of(name, name + ".mcap", name + ".mcap") == expected, name
    print("MCAP files in %d forms: the graph of the CSV drive" % len(ways))


def check_damage():
    data = recording(chunk=30_000)
    write("cut.mcap", data[:len(data) // 2])
    text = run("inspect", "cut.mcap").stdout
    assert "the file ends within this record; what came before is used" in text, text
    found = int(re.search(r"/fix \(sensor_msgs/msg/NavSatFix\)\s+(\d+)", text).group(1))
    assert 25 <= found <= 35, text  # half of 61
    at = data.rindex(b"picture")
    write("flipped.mcap", data[:at] + b"P" + data[at + 1:])
    text = run("inspect", "flipped.mcap").stdout
    assert "chunk: its checksum is wrong" in text, text
    # Lengths that promise far more than there is.
    for claim in (2**63, 2**40, 2**32):
        write("long.mcap", ros.MAGIC + struct.pack("<BQ", 5, claim) + b"x" * 100)
        write("long.yaml", YAML % ("long.mcap", "", "long.mcap", ""))
        run("convert", "long.yaml", "-o", "long.graph", code=3)
    print("cut, flipped and boasting files: told")


def check_topics():
    file = ros.Mcap([("/a", "sensor_msgs/msg/NavSatFix", "cdr"), ("/b", "sensor_msgs/msg/NavSatFix", "cdr"),
                     ("/motion", "geometry_msgs/msg/TwistStamped", "cdr")])
    for t, *place in FIXES:
        file.add(1, t, ros.fix_cdr(t, *place, COVARIANCE, 2, 0))
        file.add(2, t, ros.fix_cdr(t, *place, COVARIANCE, 2, -1))
    for t, v, w in MOTIONS:
        file.add(3, t, ros.twist_cdr(t, v, w))
    write("two.mcap", file.bytes())
    write("two.yaml", YAML % ("two.mcap", "", "two.mcap", ""))
    error = run("convert", "two.yaml", "-o", "two.graph", code=3).stderr
    assert "several topics fit; state 'topic'; topics: '/a' (" in error and "'/b' (" in error, error
    assert graph_of("one", "two.mcap", "two.mcap", "", ", topic: /a") == csv_graph()
    for topic, words in ((", topic: /c", "there is no topic '/c'; topics: '/a'"),
                         (", topic: /motion", "has the messages that are asked for (NavSatFix)")):
        write("two.yaml", YAML % ("two.mcap", "", "two.mcap", topic))
        error = run("convert", "two.yaml", "-o", "two.graph", code=3).stderr
        assert words in error, error
    print("topics: chosen, listed and named")


def check_inspect():
    text = run("inspect", "plain.mcap").stdout
    for words in ("/fix (sensor_msgs/msg/NavSatFix)", "/motion (geometry_msgs/msg/TwistStamped)", "20.02 Hz",
                  "/camera (sensor_msgs/msg/Image)"):
        assert words in text, (words, text)
    run("init", "plain.mcap", "-o", "proposed.yaml")
    run("convert", "proposed.yaml", "-o", "proposed.graph")
    print("inspect lists topics, types and rates; what init proposes runs")


def check_bag_in(expected):
    import genpy
    import rosbag
    from geometry_msgs.msg import TwistStamped
    from nav_msgs.msg import Odometry
    from sensor_msgs.msg import NavSatFix
    fixes = dict((t, place) for t, *place in FIXES)
    for compression in ("none", "bz2", "lz4"):
        for kind in (TwistStamped, Odometry):
            name = "rosbag_%s_%s" % (compression, kind.__name__)
            with rosbag.Bag(name + ".bag", "w", compression=compression, chunk_threshold=20_000) as bag:
                for t, v, w in MOTIONS:
                    time = genpy.Time(t // 10**9, t % 10**9)
                    if t in fixes:
                        fix = NavSatFix()
                        fix.header.stamp = time
                        fix.latitude, fix.longitude, fix.altitude = fixes[t]
                        fix.position_covariance, fix.position_covariance_type = COVARIANCE, 2
                        bag.write("/fix", fix, time)
                    motion = kind()
                    motion.header.stamp = time
                    twist = motion.twist if kind is TwistStamped else motion.twist.twist
                    twist.linear.x, twist.angular.z = v, w
                    bag.write("/motion", motion, time)
            assert graph_of(name, name + ".bag", name + ".bag") == expected, name
    print("bags of rosbag, 3 compressions, 2 types: the graph of the CSV drive")


def fused():
    write("fuse.yaml", YAML % ("motion.csv", "", "fixes.csv", ""))
    run("run", "fuse.yaml", "--out", "results", "-m", "g2")
    # The graph of `run` has no covariances; the minimum is found again to rounding.
    graph = "fused.graph"
    run("optimize", "results/g2.fused.graph", "-o", graph, "--covariance", "all")
    with open("results/g2.csv") as file:
        return graph, list(csv.DictReader(file))


def check_numbers(rows, stamps, poses, covariances, twists):
    assert len(rows) == len(stamps) > 1000
    compared = 0
    for i, row in enumerate(rows):
        assert stamps[i] == int(row["stamp_ns"]), (i, stamps[i], row)
        x, y, qz, qw = poses[i]
        assert math.dist((x, y), (float(row["x_m"]), float(row["y_m"]))) < 1e-6
        assert abs(math.remainder(2 * math.atan2(qz, qw) - float(row["heading_rad"]), 2 * math.pi)) < 1e-8
        c = covariances[i]
        for at, sigma in ((0, "sigma_x_m"), (7, "sigma_y_m"), (35, "sigma_heading_rad")):
            assert c[at] > 0
            if row[sigma]:  # the table has those of the poses at fixes
                compared += 1
                assert abs(c[at] - float(row[sigma]) ** 2) <= 1e-6 * c[at], (i, at, c[at], row)
        assert c[1] == c[6] and c[5] == c[30] and c[14] == 1e6
    assert compared >= 3 * 60
    # The vehicle moves forwards at 6 .. 10 m/s; the fused motion is within 2 m/s of the odometry.
    for i in range(100, 1000, 100):
        assert abs(twists[i][0] - MOTIONS[i][1]) < 2 and abs(twists[i][1]) < 0.5, (i, twists[i], MOTIONS[i])


def check_mcap_out(graph, rows):
    run("convert", graph, "-o", "fused.mcap")
    with open("fused.mcap", "rb") as file:
        schemas, channels, messages = ros.read_mcap(file.read())
    assert channels == {1: ["/waymark/odometry", "cdr"], 2: ["/waymark/fix", "cdr"]}, channels
    assert schemas[1][0] == "nav_msgs/msg/Odometry" and schemas[2][0] == "sensor_msgs/msg/NavSatFix"
    stamps, poses, covariances, twists, places = [], [], [], [], []
    for channel, time, data in messages:
        reader = ros.CdrReader(data)
        at = reader.get("i") * 10**9 + reader.get("I")
        assert at == time
        frame = reader.text()
        if channel == 2:
            assert (reader.get("b"), reader.get("H")) == (0, 1)
            places.append(reader.get("d", 2))
            continue
        assert (frame, reader.text()) == ("map", "base_link")
        x, y, z, _, _, qz, qw = reader.get("d", 7)
        assert z == 0
        stamps.append(at)
        poses.append((x, y, qz, qw))
        covariances.append(reader.get("d", 36))
        twists.append(reader.get("d", 6))
        assert reader.get("d", 36) == [0] * 36 and reader.at == len(reader.data)
    check_numbers(rows, stamps, poses, covariances, twists)
    assert all(abs(place[0] - float(row["latitude_deg"])) < 1e-10 and abs(place[1] - float(row["longitude_deg"])) < 1e-10
               for place, row in zip(places, rows, strict=True))
    # and by ourselves
    assert "/waymark/odometry (nav_msgs/msg/Odometry)" in run("inspect", "fused.mcap").stdout
    print("MCAP out: %d poses with covariance, read by the specification" % len(stamps))


def check_bag_out(graph, rows):
    import rosbag
    import nav_msgs.msg
    import sensor_msgs.msg
    run("convert", graph, "-o", "fused.bag")
    stamps, poses, covariances, twists, places = [], [], [], [], []
    with rosbag.Bag("fused.bag") as bag:
        topics = bag.get_type_and_topic_info()
        # The definitions are those of ROS: their sums are equal.
        assert topics.msg_types == {"nav_msgs/Odometry": nav_msgs.msg.Odometry._md5sum,
                                    "sensor_msgs/NavSatFix": sensor_msgs.msg.NavSatFix._md5sum}, topics
        assert topics.topics["/waymark/odometry"].message_count == len(rows)
        for topic, message, time in bag.read_messages():
            assert time == message.header.stamp
            if topic == "/waymark/fix":
                places.append((message.latitude, message.longitude))
                continue
            assert (message.header.frame_id, message.child_frame_id) == ("map", "base_link")
            pose, twist = message.pose.pose, message.twist.twist
            stamps.append(time.to_nsec())
            poses.append((pose.position.x, pose.position.y, pose.orientation.z, pose.orientation.w))
            covariances.append(message.pose.covariance)
            twists.append((twist.linear.x, twist.linear.y))
    check_numbers(rows, stamps, poses, covariances, twists)
    assert all(abs(place[0] - float(row["latitude_deg"])) < 1e-10 and abs(place[1] - float(row["longitude_deg"])) < 1e-10
               for place, row in zip(places, rows, strict=True))
    print("bag out: %d poses with covariance, read by rosbag" % len(stamps))


def check_evo(graph, rows):
    """evo's own rules (file_interface): TUM has 8 columns, KITTI 12, split at single blanks, no others."""
    run("convert", graph, "-o", "fused.tum")
    run("convert", graph, "-o", "fused.kitti")
    with open("fused.tum") as file:
        tum = [[float(v) for v in line.rstrip("\n").split(" ")] for line in file if not line.startswith("#")]
    with open("fused.kitti") as file:
        kitti = [[float(v) for v in line.rstrip("\n").split(" ")] for line in file]
    assert len(tum) == len(kitti) == len(rows)
    for t, k, row in zip(tum, kitti, rows):
        assert len(t) == 8 and len(k) == 12
        assert abs(t[0] - float(row["unix_s"])) < 1e-6 and t[1:4] == [k[3], k[7], k[11]]
        heading = 2 * math.atan2(t[6], t[7])
        assert abs(k[0] - math.cos(heading)) < 1e-12 and abs(k[4] - math.sin(heading)) < 1e-12
        # a rotation: its determinant is 1
        assert abs(k[0] * k[5] - k[1] * k[4] - 1) < 1e-12 and k[10] == 1
    print("evo: TUM with Unix time, KITTI with 12 numbers")


def main():
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        expected = csv_graph()
        check_mcap_in(expected)
        check_damage()
        check_topics()
        check_inspect()
        graph, rows = fused()
        check_mcap_out(graph, rows)
        check_evo(graph, rows)
        try:
            import nav_msgs.msg, rosbag, sensor_msgs.msg  # noqa: F401,E401
        except ImportError as error:
            print("SKIPPED: bags: %s" % error)
            return
        check_bag_in(expected)
        check_bag_out(graph, rows)


main()
