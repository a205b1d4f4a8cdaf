"""MCAP files and messages of ROS, written and read from their specifications alone (mcap.dev/spec; OMG DDSI-RTPS 2.5
chapter 10 for CDR; wiki.ros.org for the types), with nothing of Waymark."""
import json
import struct
import zlib

MAGIC = b"\x89MCAP0\r\n"


class Cdr:
    """A message in CDR: numbers aligned to their size behind 4 bytes that say the order."""

    def __init__(self, big=False):
        self.order = ">" if big else "<"
        self.head = b"\x00\x00\x00\x00" if big else b"\x00\x01\x00\x00"
        self.body = b""

    def put(self, form, *values):
        for value in values:
            size = struct.calcsize(form)
            self.body += b"\0" * (-len(self.body) % size) + struct.pack(self.order + form, value)
        return self

    def text(self, text):
        data = text.encode() + b"\0"
        self.put("I", len(data))
        self.body += data
        return self

    def header(self, stamp_ns, frame):
        return self.put("i", stamp_ns // 10**9).put("I", stamp_ns % 10**9).text(frame)

    def bytes(self):
        return self.head + self.body


def fix_cdr(stamp, lat, lon, height, covariance, kind, status, big=False):
    m = Cdr(big).header(stamp, "gps").put("b", status).put("H", 1)
    return m.put("d", lat, lon, height, *covariance).put("B", kind).bytes()


def twist_cdr(stamp, speed, yaw_rate, big=False):
    return Cdr(big).header(stamp, "base_link").put("d", speed, 0, 0, 0, 0, yaw_rate).bytes()


def odometry_cdr(stamp, speed, yaw_rate, big=False):
    m = Cdr(big).header(stamp, "odom").text("base_link").put("d", 5, 6, 0, 0, 0, 0, 1, *[7.0] * 36)
    return m.put("d", speed, 0, 0, 0, 0, yaw_rate, *[8.0] * 36).bytes()


def imu_cdr(stamp, gyro, big=False):
    m = Cdr(big).header(stamp, "imu").put("d", 0, 0, 0, 1, -1, *[0.0] * 8).put("d", *gyro, *[0.0] * 9)
    return m.put("d", 0, 0, 9.81, *[0.0] * 9).bytes()


def stamp_json(stamp):
    return {"stamp": {"sec": stamp // 10**9, "nanosec": stamp % 10**9}, "frame_id": "x"}


def fix_json(stamp, lat, lon, height, covariance, kind, status):
    return json.dumps({"header": stamp_json(stamp), "status": {"status": status, "service": 1}, "latitude": lat,
                       "longitude": lon, "altitude": height, "position_covariance": covariance,
                       "position_covariance_type": kind}).encode()


def twist_json(stamp, speed, yaw_rate):
    return json.dumps({"header": stamp_json(stamp), "twist": {
        "linear": {"x": speed, "y": 0.0, "z": 0.0}, "angular": {"x": 0.0, "y": 0.0, "z": yaw_rate}}}).encode()


def text(value):
    data = value.encode()
    return struct.pack("<I", len(data)) + data


def record(opcode, content):
    return struct.pack("<BQ", opcode, len(content)) + content


def zstd_frame(data):
    """RFC 8878: a frame of raw blocks, window of 1 MiB."""
    out = struct.pack("<IBB", 0xFD2FB528, 0, 10 << 3)
    for at in range(0, len(data), 100_000):
        block = data[at:at + 100_000]
        out += struct.pack("<I", len(block) << 3 | (at + 100_000 >= len(data)))[:3] + block
    return out


class Mcap:
    """channels: (topic, type, encoding); messages: (channel, log time, bytes)."""

    def __init__(self, channels, chunk=0, compression="", crc=True, compress=None,
                 definition="float64 x\n" * 900):
        self.channels, self.chunk, self.compression, self.crc = channels, chunk, compression, crc
        self.compress = compress or {"": lambda data: data, "zstd": zstd_frame}.get(compression)
        self.out = MAGIC + record(1, text("ros2") + text("hand"))
        self.pending, self.count = b"", 0
        for i, (topic, kind, encoding) in enumerate(channels, 1):
            head = record(3, struct.pack("<H", i) + text(kind) + text("ros2msg") + text(definition))
            head += record(4, struct.pack("<HH", i, i) + text(topic) + text(encoding) + struct.pack("<I", 0))
            if chunk:
                self.pending += head
            else:
                self.out += head

    def add(self, channel, time, data):
        message = record(5, struct.pack("<HIQQ", channel, self.count, time, time) + data)
        self.count += 1
        if not self.chunk:
            self.out += message
            return
        self.pending += message
        if len(self.pending) > self.chunk:
            self.end_chunk()

    def end_chunk(self):
        data, self.pending = self.pending, b""
        packed = self.compress(data)
        crc = zlib.crc32(data) if self.crc else 0
        self.out += record(6, struct.pack("<QQQI", 0, 0, len(data), crc) + text(self.compression) +
                           struct.pack("<Q", len(packed)) + packed)
        self.out += record(7, struct.pack("<HI", 1, 0))  # an index of messages, without any
        self.out += record(0x81, b"private")

    def bytes(self):
        if self.pending:
            self.end_chunk()
        crc = zlib.crc32(self.out) if self.crc else 0
        return self.out + record(15, struct.pack("<I", crc)) + record(2, struct.pack("<QQI", 0, 0, 0)) + MAGIC


def read_mcap(data):
    """Returns (schemas, channels, messages) of a file without chunks; checks magic, CRC and footer."""
    assert data.startswith(MAGIC) and data.endswith(MAGIC)
    at, schemas, channels, messages, footer = len(MAGIC), {}, {}, [], False
    while at < len(data) - len(MAGIC):
        opcode, length = struct.unpack_from("<BQ", data, at)
        body = data[at + 9:at + 9 + length]
        assert len(body) == length
        if opcode in (3, 4):
            ids = 1 if opcode == 3 else 2
            number, texts, place = struct.unpack_from("<H", body)[0], [], 2 * ids
            for _ in range(3 if opcode == 3 else 2):
                size = struct.unpack_from("<I", body, place)[0]
                texts.append(body[place + 4:place + 4 + size].decode())
                place += 4 + size
            (schemas if opcode == 3 else channels)[number] = texts
        elif opcode == 5:
            channel, _, time, _ = struct.unpack_from("<HIQQ", body)
            messages.append((channel, time, body[22:]))
        elif opcode == 15:
            assert struct.unpack("<I", body)[0] == zlib.crc32(data[:at])
        elif opcode == 2:
            footer = True
        at += 9 + length
    assert footer and at == len(data) - len(MAGIC)
    return schemas, channels, messages


class CdrReader:
    def __init__(self, data):
        assert data[:4] == b"\x00\x01\x00\x00"
        self.data, self.at = data[4:], 0

    def get(self, form, count=1):
        size = struct.calcsize(form)
        self.at += -self.at % size
        values = struct.unpack_from("<%d%s" % (count, form), self.data, self.at)
        self.at += count * size
        return values[0] if count == 1 else list(values)

    def text(self):
        size = self.get("I")
        value = self.data[self.at:self.at + size]
        assert value[-1:] == b"\0"
        self.at += size
        return value[:-1].decode()
