#include <waymark/tools/inspection/proposal/drive_proposal.hpp>

namespace waymark::inspection {

// A line "# key" is a key that the user can uncomment. Without these "# " the whole text can be
// parsed; a test checks this.
std::string drive_template() {
  return R"(## A drive with all keys of tools/drive/README.md. Uncomment the keys that you need.
## Times are seconds and lengths metres unless a key names another unit.
# name: Somewhere
# folder: logs                     # where relative log names are looked up; default: beside this file
# time:
#   scale: gps                     # gps | utc | unix: the drive's own scale; logs on others are converted
#   from: 10                       # use the odometry from this many seconds after its first stamp ...
#   to: 70                         # ... to this many
# frame:
#   utm_zone: 33N                  # default: zone of the first fix
#   origin: [389600, 5818400]      # easting, northing; default: first fix, rounded to 100 m

odometry:                          # or in parts: `waymark init LOG...` shows how
  file: FILL_IN_odometry.csv
  format: csv                      # a log reader (`waymark info` lists them), or auto
#   separator: ","                 # "," | ";" | tab | blank
#   columns:                       # quantity: column name or 1-based number, or with unit and convention
#     time: t
#     speed: {column: v, unit: km/h}
#     yaw_rate: {column: w, unit: deg/s, convention: cw}
#   time: {scale: gps, week: 2300, offset: 0}
#   speed_delay: 0                 # how late it is stamped; `waymark sync` estimates both
#   yaw_rate_delay: 0
#   rate: 20                       # Hz of the common clock, of odometry in parts
#   gyro: {axis: gravity}          # x | -x | y | -y | z | -z | gravity
#   vehicle: {track_width: 1.55, wheelbase: 2.7, steering_ratio: 15, metres_per_tick: 0.01}
#   model: constant_twist
#   options: {heading_variance_per_s: 1.5e-6}

gnss:                              # or a list of these: several receivers
  file: FILL_IN_gnss.nmea
  format: auto
#   accuracy:
#     meaning: auto                # auto | 95 | 1sigma | drms | cep50
#     default_sigma: 5             # per axis, where the log gives none
#     range_error: 5               # sigma = HDOP times this, where the log gives HDOP only
#     by_quality: {fixed: 0.02, float: 0.4, differential: 1.5, single: 3}
#   antenna: [1.2, 0]              # in the body frame: x forward, y left
#   period: 1                      # keep one fix per period; 0: keep all
#   delay: 0                       # how late the receiver stamps
#   withhold_every: 0              # n: every n-th epoch is kept out, to evaluate against

# truth:
#   file: truth.csv
#   columns: {time: time_s, latitude: latitude_deg, longitude: longitude_deg, heading: heading_rad}
#   reference: [0, 0]              # truth reference point in the body frame
# gate: {enabled: true, max_angle_deg: 1.5, max_displacement_m: 15, chord_s: 1, max_chord_s: 5, min_chord_m: 1}
# gap: {longer_than: 0.5, policy: bridge, noise_factor: 100}
# snap: 0.001
# initial_guess: anchored          # anchored | dead_reckoning
# modeling: correlated             # g1, g2, g3, or {name: g2, loss: "cauchy:1", options: {}}
# calibration: on                  # gyro bias, speed scale and time offset
# noise: estimate                  # estimate | stated
# sensors:
#   - name: heading                # a registered sensor
#     file: compass.csv
#     columns: {heading: {column: hdt, unit: deg, convention: cw_from_north}}
#     options: {sigma_deg: 0.5}
# plugins: []                      # modules to load
)";
}

}  // namespace waymark::inspection
