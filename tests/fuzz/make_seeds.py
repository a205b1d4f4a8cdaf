#!/usr/bin/env python3
"""Seed corpora of the fuzzers: snippets of real logs (shared data) and of hand-made ones.

make_seeds.py SHARED_DATA OUTPUT: one folder per target, one file per snippet of at most 4 KiB, each behind the
bytes that say how it is read (fuzz_input.hpp). Words of a format, as its page lists them, become the dictionary
OUTPUT/TARGET.dict.
"""
import bz2
import gzip
import pathlib
import re
import struct
import sys

SOURCE = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(SOURCE / "tests/peer"))
import ros_files  # noqa: E402

SNIPPET = 4096

# By target: patterns below the shared data. Those of no real sample stand in MADE.
REAL = {
    "csv": ["drives/*/*.csv"],
    "gpsd_json": ["logs/gpsd/*.chk"],
    "candump": ["logs/can/*.log", "drives/aarhus_horsens/candump.log.gz"],
    "nmea": ["logs/nmea/*"],
    "rtklib_pos": ["logs/pos/*.pos", "drives/nagoya/*.pos"],
    "gpx": ["logs/gpx/*.gpx"],
    "ubx": ["logs/ubx/*"],
    "rinex": ["drives/berlin_potsdamer_platz_raw/rover.obs"],
    "dbc": ["logs/can/*.dbc", "drives/aarhus_horsens/*.dbc"],
    "log_file": ["logs/*/*"],
}

OXTS = ("49.01 8.43 112.8 0.03 0.02 1.5 -1.2 5.1 5.2 0.1 0.01 0.2 0.1 9.8 0.2 0.1 9.8 0.01 0.02 0.03 0.01 0.02 "
        "0.03 0.05 0.02 4 11 6 6 6\n")
BESTPOS = ("BESTPOSA,COM1,0,90.5,FINESTEERING,2062,151500.000,02000020,cdba,15564;SOL_COMPUTED,NARROW_INT,"
           "51.15043711386,-114.03067767000,1097.2099,-17.0000,WGS84,0.0123,0.0114,0.0212,\"AAAA\",1.000,0.000,"
           "35,30,30,30,00,06,39,33")
INSPVAX = ("INSPVAXA,COM1,0,73.5,FINESTEERING,1695,309428.000,02000040,4e77,43562;INS_SOLUTION_GOOD,INS_PSRSP,"
           "51.11637873403,-114.03825114994,1063.6093,-16.9000,-0.0845,-0.0464,-0.0127,0.138023492,0.069459386,"
           "90.000923268,0.9428,0.6688,1.4746,0.0430,0.0518,0.0521,0.944295466,0.944567084,1.000131845,3,0")
BESTVEL = ("BESTVELA,COM1,0,90.5,FINESTEERING,2062,151500.000,02000020,10a2,15564;SOL_COMPUTED,DOPPLER_VELOCITY,"
           "0.150,0.000,1.2021,150.0,0.01,0.0")
RTKLIB = ("% GPST latitude(deg) longitude(deg) height(m) Q ns sdn(m) sde(m) sdu(m) sdne(m) sdeu(m) sdun(m) age(s) ratio\n"
          "2068 284261.000 36.082 140.077 70.1 1 10 0.01 0.01 0.02 0.001 0.0 0.0 0.0 99.9\n")


def mcap(encoding, chunk, compression):
    file = ros_files.Mcap([("/fix", "sensor_msgs/msg/NavSatFix", encoding), ("/twist", "geometry_msgs/TwistStamped",
                            encoding), ("/imu", "sensor_msgs/Imu", "cdr"), ("/odom", "nav_msgs/Odometry", "cdr")],
                          chunk=chunk, compression=compression, crc=False, definition="")
    for t in range(3):
        fix = (1_700_000_000_000_000_000 + t, 52.5, 13.4, 40.0, [2.25, 0, 0, 0, 4, 0, 0, 0, 9], 3, 0)
        file.add(1, t, ros_files.fix_json(*fix) if encoding == "json" else ros_files.fix_cdr(*fix, big=t == 1))
        file.add(2, t, ros_files.twist_json(t, 8, 0.1) if encoding == "json" else ros_files.twist_cdr(t, 8, 0.1))
        file.add(3, t, ros_files.imu_cdr(t, (0, 0, 0.1)))
    file.add(4, t, ros_files.odometry_cdr(t, 8, 0.1))
    return file.bytes()


def bag(compression):
    def record(fields, data):
        head = b"".join(struct.pack("<I", len(f)) + f for f in fields)
        return struct.pack("<I", len(head)) + head + struct.pack("<I", len(data)) + data

    def field(name, value):
        return name + b"=" + value
    entry = field(b"type", b"sensor_msgs/NavSatFix")
    fix = struct.pack("<IIII3sbHddd", 1, 1_700_000_000, 5, 3, b"gps", 0, 1, 52.5, 13.4, 40) + struct.pack(
        "<9dB", 2.25, 0, 0, 0, 4, 0, 0, 0, 9, 2)
    records = record([b"op=\x07", field(b"conn", bytes(4)), b"topic=/fix"], struct.pack("<I", len(entry)) + entry)
    records += record([b"op=\x02", field(b"conn", bytes(4)), field(b"time", bytes(8))], fix) * 3
    packed = bz2.compress(records) if compression == b"bz2" else records
    chunk = record([b"op=\x05", field(b"compression", compression), field(b"size", struct.pack("<I", len(records)))],
                   packed)
    return b"#ROSBAG V2.0\n" + record([b"op=\x03", field(b"index_pos", bytes(8))], b" " * 40) + chunk + records


def header(content, label):
    return f"{content:60}{label}\n"


def rinex_observations(version):
    place = header("  6378137.0000        0.0000        0.0000", "APPROX POSITION XYZ")
    if version == 2:
        head = header("     2.11           OBSERVATION DATA    M", "RINEX VERSION / TYPE")
        head += header("     4    C1    L1    S1    D1", "# / TYPES OF OBSERV")
        epoch = " 16  6  6 11  5  {}.0000000  0  4G01E02C03R01\n" + "  22000000.000                  40.000      1000.000\n" * 4
    else:
        head = header("     3.03           OBSERVATION DATA    M", "RINEX VERSION / TYPE")
        head += "".join(header(f"{s}    3 {c} D{c[1:]} S{c[1:]}", "SYS / # / OBS TYPES")
                        for s, c in (("G", "C1C"), ("E", "C1X"), ("C", "C2I"), ("R", "C1C")))
        epoch = "> 2016 06 06 11 05 0{}.0000000  0  4\n" + "".join(
            f"{s}  22000000.000        1000.000          40.000\n" for s in ("G01", "E02", "C03", "R01"))
    event = "                            4  1\n" if version == 2 else "> {:31}4  1\n".format("")
    event += header("antenna", "COMMENT")
    return head + place + header("", "END OF HEADER") + epoch.format(0) + event + epoch.format(1)


def rinex_navigation(version):
    """A satellite of GPS and, in version 3, one of GLONASS."""
    def numbers(begin, values):
        return begin + "".join(f"{value:19.12E}" for value in values) + "\n"
    blank = "   " if version == 2 else "    "
    names = (" 1 16  6  6 11  0  0.0", None) if version == 2 else ("G01 2016 06 06 11 00 00", "R01 2016 06 06 11 00 00")
    text = header(f"     {version}.{'11' if version == 2 else '03'}           NAVIGATION DATA     G", "RINEX VERSION / TYPE")
    text += header("    0.6519E-08  0.2235E-07 -0.5960E-07 -0.1192E-06", "ION ALPHA") + header("", "END OF HEADER")
    text += numbers(names[0], (1e-5, 1e-12, 0))
    for row in ((1, 10, 4e-9, 0.4), (1e-7, 0.005, 1e-5, 5153.7), (126000, 1e-7, 1, 1e-7), (0.96, 170, 0.5, -8e-9),
                (6e-10, 1, 1900, 0), (2, 0, 5e-9, 0), (0, 0, 0, 0)):
        text += numbers(blank, row)
    if names[1]:
        text += numbers(names[1], (1e-5, 0, 0))
        text += numbers(blank, (1e4, 2, 0, 0)) + numbers(blank, (2e4, 1, 0, 5)) + numbers(blank, (1.2e4, -2.5, 0, 0))
    return text


RINEX = [rinex_observations(2), rinex_observations(3), rinex_navigation(2) + "\0" + rinex_observations(2),
         rinex_navigation(3) + "\0" + rinex_observations(3)]

def ubx(key, payload):
    """A frame without its checksum, which one bit of the head makes right."""
    return b"\xb5\x62" + struct.pack(">H", key) + struct.pack("<H", len(payload)) + payload + bytes(2)


def ubx_raw():
    """Five satellites at 2016-06-06 11:05, and a subframe of GPS, a page of Galileo, a subframe of BeiDou."""
    def rawx(second):
        head = struct.pack("<dHbBBBH", second, 1900, 17, 5, 1, 1, 0)
        return ubx(0x0215, head + b"".join(struct.pack("<ddfBBBBHBBBBBB", 2.2e7 + 1e5 * n, 1e8, 100, system, n, 0, 0,
                                                       500, 40, 5, 2, 5, 7, 0)
                                           for system, n in ((0, 1), (0, 2), (2, 3), (3, 14), (0, 5))))

    def sfrbx(system, number, words):
        return ubx(0x0213, struct.pack("<BBBBBBBB", system, number, 0, 0, len(words), 0, 2, 0) + struct.pack(
            f"<{len(words)}I", *words))
    # A subframe 3 of a real receiver, as the tests of pyubx2 list it.
    gps = (583028782, 2463198336, 394902765, 2566867280, 1062207503, 675481840, 616371498, 2740700967, 768066377,
           3045061856)
    return (rawx(126300) + sfrbx(0, 5, gps) + sfrbx(2, 3, (0x01000000, 0, 0, 0, 0x80000000, 0, 0, 0)) +
            sfrbx(3, 14, (0x712 << 19 | 1 << 12,) + (0,) * 9) + rawx(126301))


MADE = {
    "ubx": [ubx_raw()],
    "rinex": [text.encode() for text in RINEX],
    "mcap": [mcap("cdr", 0, ""), mcap("json", 0, ""), mcap("cdr", 500, ""), mcap("cdr", 900, "zstd")],
    "rosbag": [bag(b"none"), bag(b"bz2")],
    "kitti_oxts": [(OXTS * 8).encode()],
    "novatel": ["".join("#%s*00000000\n" % m for m in messages).encode()
                for messages in ([BESTPOS] * 4, [INSPVAX] * 4, [BESTPOS, BESTVEL] * 4)],
    "rtklib_pos": [RTKLIB.encode()],
    "candump": [b"(1.5) can0 0AA#0123456789ABCDEF\n (1.6)  can0  024   [2]  FF FF\n(1.7) can0 123##1AABB\n"
                b"(1.8) can0 003#0011223344556677\n(1.9) can0 007#00112233\n(2.0) can0 002#0011223344\n"
                b"(2.1) can0 0B4#0100002041000000\n(2.2) can0 123#R\n"],
    "asc": [b"date Mon Jul 26 10:14:15.000 am 2021\nbase hex  timestamps absolute\n"
            b"Begin Triggerblock Mon Jul 26 10:14:15.000 am 2021\n   0.000000 Start of measurement\n"
            b"   0.015991 1  0AA             Rx   d 8 01 23 45 67 89 AB CD EF\n   0.02 1  003x  Rx   r\n"
            b"   0.1 CANFD   1 Rx  7E8  Name    1 0 8  8 03 41 0D 24 00 00 00 00\n   0.6 1  ErrorFrame\n"
            b"   0.7 1  003             Rx   d 8 00 11 22 33 44 55 66 77\nEnd TriggerBlock\n",
            b"base dec  timestamps relative\n0.5 1  170             Rx   d 4 1 35 69 103\n" * 3],
    "trc": [head + row * 3 for head, row in (
                (b";$STARTTIME=44403.4265625\n", b" 1) 16 00AA 8 03 41 0D 24 00 00 00 00\n"),
                (b";$FILEVERSION=1.1\n", b" 1) 15.991 Rx 0003 8 03 41 0D 24 00 00 00 00\n"),
                (b";$FILEVERSION=1.3\n", b" 1) 15.991 1 Rx 00AA - 8 03 41 0D 24 00 00 00 00\n"),
                (b";$FILEVERSION=2.1\n;$COLUMNS=N,O,T,B,I,d,R,L,D\n",
                 b" 1 15.991 FD 1 0007 Rx - 9 03 41 0D 24 00 00 00 00 00 00 00 00\n"))],
    "gnss_logger": [b"# Header Description:\n# Fix,Provider,LatitudeDegrees,LongitudeDegrees,AltitudeMeters,SpeedMps,"
                    b"AccuracyMeters,BearingDegrees,UnixTimeMillis\nRaw,1,2\n"
                    b"Fix,GPS,52.27,10.53,120.5,10.0,2.0,90.0,1700000000440\n"
                    b"Fix,FLP,52.27,10.53,120.5,10.0,2.0,90.0,1700000000440\n"],
    "vbo": [b"File created on 26/07/2021 at 10:14:15\n[header]\ntime\n[column names]\nsats time lat long velocity "
            b"heading height\n[data]\n136 101416.00 +03119.09973 -00631.80000 036.000 090.00 +00120.50\n"
            b"000 101417.00 +00000.00000 +00000.00000 000.000 000.00 +00000.00\n"],
    "csv": [b"t,day,north,who\n10:00:00,31.01.2024,front,52 16 12.9 N\n" * 2,
            b"31.01.2024 12:00:00;5216.2147;01031.8;front;3\n" * 2,
            b"time,latitude,longitude,height,accuracy,course,speed,valid\n1.5,48.1,11.5,500,3.5,90,4.5,1\n" * 2,
            b"time;speed;yaw_rate\n1.5;4.25;0.01\n\"1.6\";4.5;-0.02\n",
            b"2024-05-06T07:08:09.5Z,481234567,111234567,500000,3500\n" * 3],
    "geojson_map": [b'{"type":"FeatureCollection","features":[{"type":"Feature","properties":{"highway":"path"},'
                    b'"geometry":{"type":"LineString","coordinates":[[13.1,52.1],[13.2,52.2,40]]}},{"type":"Feature",'
                    b'"geometry":{"type":"Polygon","coordinates":[[[13,52],[13.1,52],[13,52.1],[13,52]]]},'
                    b'"properties":null}]}',
                    b'{"type":"GeometryCollection","geometries":[{"coordinates":[[[1,2],[3,4]]],'
                    b'"type":"MultiLineString"}]}'],
    "gpx": [b'<?xml version="1.0"?><gpx version="1.1" creator="x"><trk><trkseg><trkpt lat="48.1" lon="11.5">'
            b"<ele>500</ele><time>2024-05-06T07:08:09Z</time><fix>3d</fix><hdop>1.2</hdop><speed>3</speed>"
            b"<course>90</course></trkpt></trkseg></trk></gpx>"],
}

GRAPH = ("GRAPH 1\nFRAME utm 32N origin 500000 5800000\nTIME gps\nPROVENANCE program waymark\nLEVER antenna 1 0.5\n"
         "TYPE EDGE_SE2 vertices=VERTEX_SE2,VERTEX_SE2 fields=measured:3 information=3 error=(t, theta)\n"
         "VERTEX_SE2 0 0 0 0\nSTAMP 0 1000000000\nVERTEX_SE2 1 1 0 0.1\nVERTEX_XY 7 2 3\nFIX 0\n"
         "EDGE_SE2 0 1 1 0 0.1 100 0 0 100 0 400\nLOSS huber 1.5\nEDGE_SE2_XY 1 7 1 3 4 0 4\n"
         "EDGE_GNSS_POSITION 0 1 1 0 0 0 1 0 1\nEDGE_PRIOR_SE2 1 1 0 0 1 0 0 1 0 1\n"
         "EDGE_GAUSSIAN_PRIOR 1 1 1 0 0.1 0 0 0 1 0 0 1 0 1\nCOVARIANCE 1 1 0 0 1 0 1\n"
         "GNSS 1 1000000000 1 0 1 0 1 40 - - - - 1 0 0 accepted - - -\n")
G2O = ("VERTEX_SE2 0 0 0 0\nVERTEX_SE2 1 1 0 0\nVERTEX_XY 2 3 1\nPARAMS_SE2OFFSET 0 1 0 0\nFIX 0\n"
       "EDGE_SE2 0 1 1 0 0 100 0 0 100 0 400\nEDGE_SE2_OFFSET 0 1 0 0 1 0 0 100 0 0 100 0 400\n"
       "EDGE_SE2_POINTXY_OFFSET 0 2 0 3 1 4 0 4\nEDGE_BEARING_SE2_XY 0 2 0.3 4\nEDGE_PRIOR_SE2_XY 1 1 0 4 0 4\n")
TORO = ("VERTEX2 0 0 0 0\nVERTEX2 1 1 0 0.1\nVERTEX 2 2 0 0.2\nEDGE2 0 1 1 0 0.1 10 1 20 30 2 3\n"
        "EDGE 1 2 1 0 0.1 0.5 0.1 0.4 0.1 0.02 0.03\n")
METRICS = ('{"schema":"waymark-metrics","version":1,"drive":"d","modelings":[{"name":"g1","fused":{"rmse_m":1.5,'
           '"count":3},"raw":null,"warnings":["w"]}]}')
SUMMARY = ('{"g1":{"termination":"converged","converged":true,"message":"m","iterations":3,"seconds":0.1,'
           '"initial_chi2":10,"final_chi2":1.5,"states":[{"name":"speed_scale","value":1.01,"sigma":0.01}]}}')
# An ELF head of this processor with one section: enough to get behind the first checks.
ELF = (b"\x7fELF\x02\x01\x01" + bytes(9) + struct.pack("<HHIQQQIHHHHHH", 3, 62, 1, 0, 64, 120, 0, 64, 56, 1, 64, 2, 1) +
       struct.pack("<IIQQQQQQ", 1, 5, 0, 0, 0, 300, 300, 4096) + bytes(64) +
       struct.pack("<IIQQQQIIQQ", 1, 11, 2, 0, 64, 48, 1, 1, 8, 24))

# Without a head of bytes; graphs have one byte.
PLAIN = {
    "drive_yaml": [p.read_bytes() for p in sorted(SOURCE.glob("examples/**/*.yaml"))] + [
        b"odometry: {file: o.csv}\ngnss: {file: g.csv}\n",
        b"time: {scale: gps, from: 1, to: 9}\nframe: {utm_zone: 33N, origin: [500000, 5500000]}\n"
        b"odometry: {file: o.csv, speed_delay: 0.1, yaw_rate_delay: 0.2}\n"
        b"gnss: {file: g.csv, antenna: [1, 0.5], period: 1, delay: 0.1, withhold_every: 3}\ntruth: {file: t.csv}\n",
        b"sources:\n  - {kind: relative, name: a, file: a.csv, nodes: true}\n  - {kind: absolute, name: b, file: b.csv}\n"
        b"calibration: {speed_scale: on}\nnoise: {estimate: on}\ngap: {policy: bridge}\nmodeling: g2\n",
        b"odometry: {parts: [{file: a.csv}, {file: b.csv}], track_width: 1.5}\n"
        b"gnss: {file: g.csv, velocity: {file: v.csv}}\nsensors: {type: heading, file: h.csv}\n"],
    "metrics_json": [METRICS.encode()], "summary_json": [SUMMARY.encode()],
    "options": [b"0.5", b"on", b"[1, 2]", b'{x: 1, y: [2, "a b"]}', b"1:2,3:4", b"huber:1.5", b"-1e3"],
    "module": [ELF],
    "tum": [b"# t x y z qx qy qz qw\n1.000000001 1 2 0 0 0 0 1\n2 1.5 2 0 0 0 0.7 0.7\n"],
    "graph": [b"\0" + GRAPH.encode(), b"\1" + GRAPH.encode()], "g2o": [b"\0" + G2O.encode(), b"\1" + G2O.encode()],
    "toro": [b"\0" + TORO.encode()], "covariance": [b"\0" + TORO.encode(), b"\1" + TORO.encode()],
}

# The page that lists the words of a format.
WORDS = {"drive_yaml": "tools/drive/DRIVE_YAML.md", "graph": "formats/README.md", "g2o": "formats/README.md",
         "toro": "formats/README.md", "covariance": "formats/README.md", "metrics_json": "tools/program/JSON.md",
         "summary_json": "tools/program/JSON.md"}


def dictionary(page):
    words = set()
    for code in re.findall(r"`([^`\n]+)`", (SOURCE / page).read_text()):
        words.update(re.findall(r"[A-Za-z_][A-Za-z_0-9]+", code))
    return "".join(f'"{word}"\n' for word in sorted(words)) + '"1e999"\n"nan"\n"5e-324"\n"1e308"\n"\\x1b[2J"\n'


# Stream and pieces; accuracy; week, date, offset, separator; free.
HEADS = {
    "csv": [bytes([s | v << 5 | 4, 8, 0, 0]) for s in range(3) for v in (0, 1, 2, 4, 7)] +
           [bytes([2 << 5 | 5, 8, 4, d]) for d in (2, 12, 34, 21, 0x62, 0xA1, 28, 5)],
    "asc": [bytes([s | v << 5 | 4, 8, 0, 0]) for s in range(4) for v in (0, 3)],
    "trc": [bytes([s | v << 5 | 4, 8, 0, 0]) for s in range(4) for v in (0, 3)],
    "gnss_logger": [bytes([s | 4, 8, 0, 0]) for s in (0, 1)],
    "vbo": [bytes([s | 4, 8, w, 0]) for s in (0, 1) for w in (0, 4)],
    "candump": [bytes([s | v << 5 | 4, 8, 0, 0]) for s in range(4) for v in (0, 3)],
    "dbc": [bytes([s | 4, 8, 0, 0]) for s in range(2)],
    "geojson_map": [b""],
    "ubx": [bytes([s | v << 5 | r | 4, 8 | 32, 2, 0]) for s in (0, 1) for v in (0, 1) for r in (0, 16)] +
           [bytes([3 | v << 5 | 16 | 4, 0, 0, 0]) for v in (2, 3)],
    "rinex": [bytes([v << 5 | 4, 0, 0, 0]) for v in (0, 4)],
    "log_file": [bytes([0, 0, 0]), bytes([1, 0, 0]), bytes([3, 128, 0]), bytes([5, 0, 100]), bytes([9, 0, 0]), bytes([17, 0, 0]), bytes([11, 99, 0]),
                 bytes([21, 0, 120])],
}
DEFAULT_HEADS = [bytes([4, 0, 0, 100]), bytes([16 | 5, 8, 4, 100]), bytes([16, 16 | 8 | 32, 5, 10])]


def snippets(data):
    """Beginning, middle and end, from the begin of a line on."""
    yield data[:SNIPPET]
    for begin in (len(data) // 2, len(data) - SNIPPET):
        if begin > SNIPPET // 2:
            begin = data.find(b"\n", begin) + 1 or begin
            yield data[begin:begin + SNIPPET]


def contents(target, shared):
    for pattern in REAL.get(target, []):
        for path in sorted(shared.glob(pattern)):
            if not path.is_file():
                continue
            opened = gzip.open(path) if path.suffix == ".gz" else open(path, "rb")
            with opened as file:
                yield from snippets(file.read(2 << 20))
    yield from MADE.get(target, [])


def main():
    shared, output = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])
    for target in sorted(set(REAL) | set(MADE)):
        folder = output / target
        folder.mkdir(parents=True, exist_ok=True)
        for i, content in enumerate(contents(target, shared)):
            for k, head in enumerate(HEADS.get(target, DEFAULT_HEADS)):
                (folder / f"seed_{i:03}_{k:02}").write_bytes(head + content)
    for target, texts in PLAIN.items():
        folder = output / target
        folder.mkdir(parents=True, exist_ok=True)
        for i, content in enumerate(texts):
            (folder / f"seed_{i:03}").write_bytes(content)
    for target, page in WORDS.items():
        (output / f"{target}.dict").write_text(dictionary(page))


main()
