#include <waymark/tools/drive/logs/memory_log.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string_view>

#include <fmt/format.h>

#include <waymark/core/base/error.hpp>
#include <waymark/core/base/suggest.hpp>
#include <waymark/formats/logs/channels.hpp>
#include <waymark/formats/logs/detail/common/gps_time.hpp>
#include <waymark/formats/logs/detail/common/position_stream.hpp>
#include <waymark/formats/logs/detail/common/quantity.hpp>
#include <waymark/formats/logs/detail/common/table_accuracy.hpp>
#include <waymark/formats/text/hash.hpp>

namespace waymark::drive {
namespace {

constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();

/// The columns of a log, looked up once.
class Columns {
 public:
  Columns(const MemoryLog& log, const std::string& name) : log_(log), name_(name) {
    for (const auto& [column, numbers] : log.columns) {
      if (numbers.size() == log.stamps.size()) continue;
      throw InputError(fmt::format("{}: column '{}' has {} numbers, and there are {} times", name, column,
                                   numbers.size(), log.stamps.size()));
    }
  }

  /// @throws InputError for a column that means nothing, such as a misspelt one
  void require_known(const std::vector<std::string_view>& known) const {
    for (const auto& [column, numbers] : log_.columns) {
      if (std::find(known.begin(), known.end(), column) != known.end()) continue;
      std::string all;
      for (const std::string_view name : known) all.append(all.empty() ? "" : ", ").append(name);
      const std::string hint = did_you_mean(column, known);
      throw InputError(fmt::format("{}: there is no quantity '{}'{}", name_, column,
                                   hint.empty() ? "; known: " + all : hint));
    }
  }
  [[nodiscard]] bool has(std::string_view column) const { return log_.columns.contains(std::string(column)); }
  /// Returns null if there is no such column.
  [[nodiscard]] const double* find(std::string_view column) const {
    const auto found = log_.columns.find(std::string(column));
    return found == log_.columns.end() ? nullptr : found->second.data();
  }
  /// @throws InputError if there is no such column
  [[nodiscard]] const double* required(std::string_view column) const {
    if (const double* numbers = find(column)) return numbers;
    std::string all;
    std::vector<std::string_view> names;
    for (const auto& [known, numbers] : log_.columns) {
      all += (all.empty() ? "" : ", ") + known;
      names.push_back(known);
    }
    throw InputError(fmt::format("{}: there is no column '{}'{}", name_, column,
                                 all.empty() ? "" : "; it has: " + all + did_you_mean(column, names)));
  }

 private:
  const MemoryLog& log_;
  const std::string& name_;
};

double at(const double* column, std::size_t row) {
  return column == nullptr ? kMissing : column[row];
}

std::optional<double> known_at(const double* column, std::size_t row) {
  const double number = at(column, row);
  return std::isfinite(number) ? std::optional(number) : std::nullopt;
}

void take_complete_odometry(const Columns& columns, const std::vector<Stamp>& stamps, LogData& data) {
  columns.require_known({"speed", "yaw_rate"});
  const double* speed = columns.required("speed");
  const double* yaw_rate = columns.required("yaw_rate");
  data.odometry.reserve(stamps.size());
  for (std::size_t i = 0; i < stamps.size(); ++i) data.odometry.push_back({stamps[i], speed[i], yaw_rate[i]});
}

/// Names a reading of a row that no sensor has. Empty: there is none.
std::string garbage_in(const std::vector<SensorColumn>& columns, const std::vector<const double*>& numbers,
                       std::size_t row, const std::vector<formats::Quantity>& quantities) {
  for (std::size_t c = 0; c < columns.size(); ++c) {
    const formats::Quantity& quantity = *formats::find_quantity(quantities, columns[c].name);
    const double number = at(numbers[c], row);
    if (number < quantity.smallest || number > quantity.largest)
      return fmt::format("{}: {:g} is outside {:g} .. {:g}", columns[c].name, number, quantity.smallest,
                         quantity.largest);
  }
  return {};
}

/// Takes rows of readings: the columns of a sensor, or the channels of odometry in parts.
void take_readings(const Columns& columns, const std::string& name, const LogRequest& request,
                   const std::vector<Stamp>& stamps, LogData& data) {
  const std::vector<SensorColumn>& wanted = request.readings;
  std::vector<std::string_view> known;
  for (const SensorColumn& column : wanted) known.push_back(column.name);
  columns.require_known(known);
  std::vector<const double*> numbers;
  for (const SensorColumn& column : wanted)
    numbers.push_back(column.required ? columns.required(column.name) : columns.find(column.name));
  const std::vector<formats::Quantity> quantities = formats::quantities(request);
  data.readings.columns = wanted.size();
  data.readings.values.reserve(stamps.size() * wanted.size());
  for (std::size_t i = 0; i < stamps.size(); ++i) {
    if (const std::string garbage = garbage_in(wanted, numbers, i, quantities);
        request.stream == StreamKind::sensor && !garbage.empty()) {
      add_corrupt(data, name, i + 1, 1, garbage);
      continue;
    }
    data.readings.stamps.push_back(stamps[i]);
    for (const double* column : numbers) data.readings.values.push_back(at(column, i));
  }
}

bool lies_on_earth(double latitude_deg, double longitude_deg) {
  // The comparisons fail for NaN.
  return std::abs(latitude_deg) <= 90 && longitude_deg >= -180 && longitude_deg <= 360;
}

/// The columns of positions: fixes of a receiver, or truth.
class Positions {
 public:
  Positions(const Columns& columns, const std::string& name, const LogRequest& request, LogData& data)
      : latitude_(columns.required("latitude")),
        longitude_(columns.required("longitude")),
        height_(columns.find("height")),
        heading_(columns.find("heading")),
        speed_(columns.find("speed")),
        speed_sigma_(columns.find("speed_accuracy")),
        course_(columns.find("course")),
        course_sigma_(columns.find("course_accuracy")),
        name_(name),
        stream_(name, request, "accuracy") {
    if (stream_.wants_truth()) {
      columns.require_known({"latitude", "longitude", "height", "heading"});
      return;
    }
    columns.require_known({"latitude", "longitude", "height", "sigma", "sigma_east", "sigma_north",
                           "covariance_en_signed_root", "accuracy", "accuracy_east", "accuracy_north",
                           "speed", "speed_accuracy", "course", "course_accuracy"});
    if (const double* sigma = columns.find("sigma")) {
      accuracy_.usual_meaning.reset();
      east_ = north_ = sigma;
      return;
    }
    const auto has = [&](std::string_view quantity) { return columns.has(quantity); };
    accuracy_ = formats::choose_accuracy(has, name, request, data.notes);
    east_ = columns.find(accuracy_.east);
    north_ = columns.find(accuracy_.north);
    covariance_root_ = columns.find(accuracy_.covariance_root);
  }

  void take(std::size_t row, Stamp stamp, LogData& data) {
    GeodeticFix fix;
    fix.stamp = stamp;
    fix.latitude_deg = latitude_[row];
    fix.longitude_deg = longitude_[row];
    fix.height_m = at(height_, row);
    fix.speed_mps = known_at(speed_, row);
    fix.speed_sigma_mps = known_at(speed_sigma_, row);
    fix.course_rad = known_at(course_, row);
    fix.course_sigma_rad = known_at(course_sigma_, row);
    fix.line = row + 1;
    const char* complaint = lies_on_earth(fix.latitude_deg, fix.longitude_deg)
                                ? stream_.add(data, fix,
                                              formats::table_accuracy(at(east_, row), at(north_, row),
                                                                      at(covariance_root_, row), accuracy_),
                                              known_at(heading_, row))
                                : "latitude and longitude are no place in degrees";
    if (complaint != nullptr) add_corrupt(data, name_, row + 1, 1, complaint);
  }

  void finish(LogData& data) const { stream_.finish(data); }

 private:
  const double* latitude_;
  const double* longitude_;
  const double* height_;
  const double* heading_;
  const double* speed_;
  const double* speed_sigma_;
  const double* course_;
  const double* course_sigma_;
  const double* east_ = nullptr;
  const double* north_ = nullptr;
  const double* covariance_root_ = nullptr;
  formats::AccuracyQuantities accuracy_{};
  const std::string& name_;
  formats::PositionStream stream_;
};

std::vector<Stamp> moved(const std::vector<Stamp>& stamps, const LogRequest& request) {
  const std::int64_t offset =
      request.gps_week * formats::kGpsWeekNanoseconds + std::llround(request.time_offset_s * 1e9);
  formats::WeekCount weeks;
  std::vector<Stamp> result = stamps;
  for (Stamp& stamp : result) {
    if (request.time_scale == TimeScale::gps) stamp = weeks.continued(stamp);
    stamp.nanoseconds += offset;
  }
  return result;
}

}  // namespace

LogData read_memory_log(const MemoryLog& log, const std::string& name, const LogRequest& request) {
  LogData data;
  const Columns columns(log, name);
  const std::vector<Stamp> stamps = moved(log.stamps, request);
  data.records = stamps.size();
  if (request.stream == StreamKind::odometry && request.readings.empty()) {
    take_complete_odometry(columns, stamps, data);
  } else if (request.stream == StreamKind::odometry || request.stream == StreamKind::sensor) {
    take_readings(columns, name, request, stamps, data);
  } else {
    Positions positions(columns, name, request, data);
    for (std::size_t i = 0; i < stamps.size(); ++i) positions.take(i, stamps[i], data);
    positions.finish(data);
  }
  require_samples(data, name);
  return data;
}

std::string fingerprint(const MemoryLog& log) {
  formats::Fnv1a64 hash;
  const auto add = [&hash](const auto& numbers) {
    hash.add({reinterpret_cast<const char*>(numbers.data()), numbers.size() * sizeof(numbers.front())});
  };
  add(log.stamps);
  for (const auto& [column, numbers] : log.columns) {
    hash.add(column);
    add(numbers);
  }
  return "fnv1a64:" + hash.hex();
}

}  // namespace waymark::drive
