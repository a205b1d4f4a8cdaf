// `waymark live` and gpsd: the real daemon, killed and started again, and one that says strange things.
#include <unistd.h>
#include <cstdlib>

#include <catch2/catch.hpp>

#include "../support/program.hpp"
#include "support/paths.hpp"
#include "support/skip.hpp"

namespace gpsd_program_test {

namespace {

RunResult shell(const std::string& folder, const std::string& text) {
  const std::string file = write_text(folder + "script.sh", "set -u\n" + text);
  RunOptions options;
  options.program = "/bin/bash";
  options.folder = folder;
  return run({file, waymark_test::program_path(), waymark_test::source_dir()}, options);
}

bool has(const char* command) {
  return std::system((std::string("command -v ") + command + " > /dev/null 2>&1").c_str()) == 0;
}

std::string port(int offset) {
  return std::to_string(20000 + 3 * (::getpid() % 9000) + offset);
}

std::string yaml(const std::string& gnss) {
  return "time: {scale: unix}\n"
         "odometry: {file: odometry, format: csv, columns: {time: time, speed: speed, yaw_rate: yaw_rate}}\n"
         "gnss: {file: \"" +
         gnss + "\"}\n";
}

}  // namespace

TEST_CASE("live: a real gpsd that is killed and comes back is heard again") {
  if (!has("gpsd") || !has("python3")) return waymark_test::skip("gpsd or python3 is not installed");
  const std::string folder = fresh_folder();
  write_text(folder + "live.yaml", yaml("gpsd://localhost:" + port(0)));
  const RunResult result = shell(
      folder,
      "python3 $2/examples/live/play_drive.py receiver odometry 6 2> play.log & play=$!\n"
      "for i in $(seq 100); do [ -e receiver ] && break; sleep 0.1; done\n"
      "gpsd -N -n -S " +
          port(0) +
          " $PWD/receiver 2> gpsd.log & daemon=$!\n"
          "sleep 0.3\n"
          "$1 live live.yaml -o json:live.jsonl 2> log & pid=$!\n"
          "sleep 6; kill -9 $daemon; sleep 1\n"
          "gpsd -N -n -S " +
          port(0) +
          " $PWD/receiver 2> gpsd2.log & daemon=$!\n"
          "sleep 8; kill -TERM $pid; wait $pid; echo code $?\n"
          "kill $daemon $play; cat log; grep -c tracking live.jsonl; tail -n 400 live.jsonl | grep -c '\"corrected\":true'\n");
  INFO(result.out << result.err);
  CHECK(contains(result.out, "code 0"));
  CHECK(contains(result.out, "closed by the other side"));  // it was told
  const std::size_t first = result.out.find(": connected");
  REQUIRE(first != std::string::npos);
  CHECK(result.out.find(": connected", first + 1) != std::string::npos);  // and heard again
  CHECK(contains(read_text(folder + "live.jsonl"), "\"state\":\"tracking\""));
}

TEST_CASE("live: a daemon that says strange things does not end the run") {
  if (!has("python3")) return waymark_test::skip("python3 is not installed");
  const std::string folder = fresh_folder();
  write_text(folder + "live.yaml", yaml("gpsd://localhost:" + port(1)));
  write_text(folder + "strange.py", R"(
import json, math, socket, sys, time
server = socket.socket()
server.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
server.bind(("127.0.0.1", int(sys.argv[1])))
server.listen()
pipe = open("odometry", "w", buffering=1)
pipe.write("time,speed,yaw_rate\n")
def iso(t):
    return time.strftime("%Y-%m-%dT%H:%M:%S", time.gmtime(t)) + ".000Z"
begin = 1700000000
for connection in range(2):
    client, _ = server.accept()
    client.recv(1000)
    client.sendall(b'{"class":"VERSION","release":"3.22","proto_major":3,"proto_minor":14}\n')
    client.sendall(b'{"class":"SKY","satellites":[' + b",".join([b'{"PRN":1,"el":10,"az":20,"ss":30,"used":true}'] * 250) + b']}\n')
    client.sendall(b'{"class":"TPV","mode":0}\n{"class":"TPV","mode":1,"time":"2023-11-14T22:13:20.000Z"}\n')
    client.sendall(b'{"class":"TPV","mode":3,"lat":52.0,"lon":13.0}\n\n\x00\xff\n')
    for k in range(40):
        t = begin + 40 * connection + k
        for i in range(10):
            pipe.write(f"{t + i / 10:.1f},10,0.02\n")
        x = 10 * (t - begin)
        heading = 0.02 * (t - begin)
        east = 500 * math.sin(heading); north = 500 * (1 - math.cos(heading))
        client.sendall((json.dumps({"class": "TPV", "device": "/dev/x", "mode": 3, "time": iso(t), "lat": 52 + north / 111000,
            "lon": 13 + east / 68700, "epx": 3.0, "epy": 3.0}) + "\n").encode())
        time.sleep(0.02)
    client.sendall(b'{"class":"TPV","device":"/dev/x","mo')  # and gone
    client.close()
time.sleep(0.5)
)");
  const RunResult result =
      shell(folder,
            "mkfifo odometry\n"
            "python3 strange.py " +
                port(1) +
                " & server=$!\n"
                "sleep 0.3; $1 live live.yaml --noise stated -o json:live.jsonl 2> log & pid=$!\n"
                "wait $server; kill -TERM $pid; wait $pid; echo code $?; cat log\n");
  INFO(result.out << result.err);
  CHECK(contains(result.out, "code 0"));
  const std::string lines = read_text(folder + "live.jsonl");
  CHECK(contains(lines, "\"state\":\"tracking\""));
  CHECK(contains(result.out, "resets 0"));
  CHECK(contains(result.out, "end: tracking"));
}

}  // namespace gpsd_program_test
